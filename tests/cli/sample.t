# retex-sample: errors, and that neither a partial file nor a changed old one stays behind.
$ make_set s.exr 48 32
$ cp "$SCENES/textures/brick.jpg" .
$ retex-sample -q s.exr --texture floor=brick.jpg -o a.exr
$ retex-info a.exr | head -n 1
> samples of     3 footprints out of 6, 48 x 32 pixels
$ retex-info --json a.exr | grep -o '"samples":[0-9]\+' # 3 images of 48 x 32 pixels of three floats
> "samples":55296
$ retex-info s.exr | grep share; retex-info --json s.exr | grep -o '"share":[0-9.]*'
>   share        40.00% of the picture
>   share        40.00% of the picture
> "share":0.40000000000000002
> "share":0.40000000000000002
$ make_set lamp.exr 48 32 "lamp:$(printf 'La\033mp')"; retex-info lamp.exr | grep -A1 ^parameter; rm lamp.exr
> parameter La?mp
>   as rendered  1 0.5 2
$ make_set big.exr 320 240
$ retex-info --json big.exr | grep -o '"radiance":[0-9]\+' | tr -d 'a-z":' |
+     awk '{ printf "%.2f MB\n", $1 / 1e6 }' >json
$ retex-info big.exr | awk '$1 == "radiance" { print $2, $3 }' | cmp - json
$ rm big.exr json
$ retex-sample -q - --texture floor=brick.jpg <s.exr >stream.exr; retex-info stream.exr | head -n 1
> layout         paper

$ retex-sample
! retex-sample: error: no set given; - is standard input
= 2
$ retex-sample -q s.exr -o x.exr
! retex-sample: error: no texture given; expected --texture NAME=IMAGE
= 2
$ retex-sample -q s.exr --texture Sofa=brick.jpg -o x.exr
! retex-sample: error: no target is called 'Sofa'; the set has Floor, Wall
= 2
$ retex-sample -q s.exr --texture floor=none.jpg -o x.exr
! retex-sample: error: cannot read none.jpg: No such file or directory
= 2
$ retex-sample -q s.exr --texture floor -o x.exr
! retex-sample: error: texture 'floor': expected NAME=IMAGE, a target and what to put on it
= 2
$ retex-sample -q s.exr --texture:size=3 floor=brick.jpg -o x.exr
! retex-sample: error: no texture option is called 'size'; there are scale, rotate, offset, flip, wrap, repeat, width, colorspace, finish, normal, grout, groutcolor, vary, tiles, at, hue, saturation, gain, gamma, contrast, blur, invert, tint, colorize
= 2
$ retex-sample -q s.exr --texture:scale=0 floor=brick.jpg -o x.exr
! retex-sample: error: texture option scale='0': a scale cannot be 0
= 2
$ retex-sample -q s.exr --texture:wrap=around floor=brick.jpg -o x.exr
! retex-sample: error: texture option wrap='around': expected repeat, mirror, clamp or black, or two of them for u,v
= 2
$ retex-sample -q s.exr --texture:flip=w floor=brick.jpg -o x.exr
! retex-sample: error: texture option flip='w': expected u, v or uv
= 2
$ retex-sample -q s.exr --texture:repeat=tiles floor=brick.jpg -o x.exr
! retex-sample: error: texture option repeat='tiles': expected straight, brick, half-drop, mirror, herringbone, basket or hexagon
= 2
$ retex-sample -q s.exr --texture:repeat=brick:wrap=repeat,clamp floor=brick.jpg -o x.exr
! retex-sample: error: texture options: repeat=brick needs wrap=repeat, the default, on both axes
= 2
$ retex-sample -q s.exr --texture:width=1.2,0 floor=brick.jpg -o x.exr
! retex-sample: error: texture option width='1.2,0': expected one or two lengths above 0, as in width=1.2 or width=60cm,9cm
= 2
$ retex-sample -q s.exr --texture floor=brick.jpg --texture Floor=brick.jpg -o x.exr
! retex-sample: error: target Floor is given two textures
= 2
$ retex-sample -q s.exr --texture 'floor=rgb(1,2' -o x.exr
! retex-sample: error: colour 'rgb(1,2': expected rgb(r,g,b) with three numbers
= 2
$ retex-sample -q s.exr --texture 'floor=rgb(1,nan,2)' -o x.exr
! retex-sample: error: colour 'rgb(1,nan,2)': expected rgb(r,g,b) with three numbers of 0 or more
= 2
# Colours as people write them; a file of such a name is named by its place; misspelt ones.
$ cp brick.jpg tan
$ for c in tan TAN '#d2b48c' 'srgb(0.8235294,0.7058824,0.5490196)' ./tan; do
+     retex-sample s.exr --texture "floor=$c" -o x.exr 2>&1 | sed 's/: 48 x.*//'
+ done
> retex-sample: Floor <- rgb(0.6444797,0.45641103,0.26225066)
> retex-sample: Floor <- rgb(0.6444797,0.45641103,0.26225066)
> retex-sample: Floor <- rgb(0.6444797,0.45641103,0.26225066)
> retex-sample: Floor <- rgb(0.64447963,0.4564111,0.26225066)
> retex-sample: Floor <- ./tan
$ rm tan x.exr
$ for c in rde oka '#ff88' 'srgb(255,0,0)'; do retex-sample -q s.exr --texture "floor=$c" -o x.exr; echo $?; done
> 2
> 2
> 2
> 2
! retex-sample: error: cannot read rde: No such file or directory; is red meant?
! retex-sample: error: cannot read oka: No such file or directory
! retex-sample: error: colour '#ff88': expected #rgb or #rrggbb with hexadecimal digits
! retex-sample: error: colour 'srgb(255,0,0)': expected srgb(r,g,b) with three numbers from 0 to 1
$ retex-sample -q none.exr --texture floor=brick.jpg -o x.exr
! retex-sample: error: cannot read none.exr: No such file or directory
= 2
$ echo text >text.jpg
$ retex-sample -q s.exr --texture floor=text.jpg -o x.exr 2>err
= 2
$ grep -c 'retex-sample: error: text.jpg' err
> 1
$ head -c 30000 s.exr | retex-sample -q - --texture floor=brick.jpg -o x.exr 2>err
= 2
$ grep -c 'error: standard input: part .* is damaged' err
> 1
$ retex-sample -q s.exr --texture floor=brick.jpg -o nowhere/x.exr
! retex-sample: error: cannot write nowhere/x.exr: No such file or directory
= 2
$ retex-sample -q s.exr --texture floor=brick.jpg -o /dev/full
! retex-sample: error: cannot write /dev/full: No space left on device
= 2
$ retex-sample -q s.exr --texture floor=brick.jpg >/dev/full
! retex-sample: error: cannot write standard output: No space left on device
= 2
$ { sleep 0.3; retex-sample -q s.exr --texture floor=brick.jpg; echo $? >&2; } | :
! 141

# Nothing of all that was left, and an old file is whole after a failure.
$ rm err text.jpg; ls -A
> a.exr
> brick.jpg
> s.exr
> stream.exr
$ cp a.exr old.exr
$ head -c 30000 s.exr >cut.exr
$ retex-sample -q cut.exr --texture floor=brick.jpg -o old.exr 2>/dev/null
= 2
$ cmp a.exr old.exr
$ ls -A
> a.exr
> brick.jpg
> cut.exr
> old.exr
> s.exr
> stream.exr

# The same bits whatever the number of threads.
$ for n in 1 2 7; do retex-sample -q s.exr --threads $n --texture:scale=3:rotate=20 wall=brick.jpg -o $n.exr; done
$ cmp 1.exr 2.exr
$ cmp 1.exr 7.exr

# One target after another along a pipe is the same as both at once.
$ make_set two.exr && retex-sample -q two.exr --texture 'Floor=rgb(.8,0,0)' |
+     retex-sample -q - --texture 'Wall=rgb(0,.5,0)' | retex-combine -q - -o one-by-one.exr
$ retex-combine -q two.exr --texture 'Floor=rgb(.8,0,0)' --texture 'Wall=rgb(0,.5,0)' -o both.exr &&
+     retex-diff --fail-abs 1e-6 one-by-one.exr both.exr >out

# What a pipe carries is compressed, the set's images as its file has them. Streams and sets without compression, which
# pipes had before, are the same to whoever reads them.
$ make_set large.exr 400 300
$ retex-sample -q large.exr --texture floor=brick.jpg -o samples.exr
$ retex-sample -q large.exr --texture floor=brick.jpg >stream.exr
$ retex-info --check stream.exr
> stream.exr: ok
$ [ $(wc -c <stream.exr) -lt $(cat large.exr samples.exr | wc -c) ] && echo smaller
> smaller
$ make_plain stream.exr plain.exr
$ make_plain large.exr plain-set.exr
$ retex-sample -q plain-set.exr --texture floor=brick.jpg >from-plain.exr
$ retex-combine -q large.exr --texture floor=brick.jpg -o fused.exr
$ for f in stream plain from-plain; do
+     retex-combine -q - -o out.exr <$f.exr
+     cmp out.exr fused.exr && echo same
+ done
> same
> same
> same
$ retex-sample -q large.exr --texture floor=brick.jpg --texture wall=brick.jpg | retex-combine -q - -o both.exr
$ for f in stream plain; do
+     retex-sample -q - --texture wall=brick.jpg <$f.exr | retex-combine -q - -o out.exr
+     cmp out.exr both.exr && echo same
+ done
> same
> same
$ for n in 1 2 7; do retex-sample -q large.exr --threads $n --texture:scale=3:rotate=20 wall=brick.jpg >$n.exr; done
$ cmp 1.exr 2.exr
$ cmp 1.exr 7.exr
# Parts of floats that the renderer rounded are compressed by PXR24, others by ZIP.
$ ln -s "$SCENES" scenes
$ retex-render -q --size 64x48 --spp 4 -t floor scenes/cornell-box/cornell-box.pov -o r.exr
$ rm scenes
$ retex-sample -q r.exr --texture floor=brick.jpg >rs.exr
$ retex-info --check rs.exr
> rs.exr: ok
$ retex-combine -q rs.exr -o out.exr
$ retex-combine -q r.exr --texture floor=brick.jpg -o fused.exr
$ cmp out.exr fused.exr && echo same
> same
$ rm r.exr rs.exr
# Copied chunks are not looked at; the reader of the pipe compares their checksums.
$ at=$(($(wc -c <large.exr) - 700000))
+ cp large.exr bad.exr
+ printf 'XYZW' | dd of=bad.exr bs=1 seek=$at conv=notrunc 2>/dev/null
$ retex-sample -q bad.exr --texture floor=brick.jpg >bad-stream.exr
$ retex-combine -q - -o x.exr <bad-stream.exr
! retex-combine: error: standard input: part t1_cross3 is damaged or truncated
= 2
$ ls x.exr
! ls: cannot access 'x.exr': No such file or directory
= 2
$ head -c -700000 large.exr >cut.exr; retex-sample -q cut.exr --texture floor=brick.jpg | wc -c
> 0
! retex-sample: error: cut.exr: part t1_cross3 is damaged or truncated
$ rm large.exr plain.exr plain-set.exr from-plain.exr bad.exr cut.exr bad-stream.exr [127].exr both.exr

# --refer: the stream names the set, from whatever folder; pictures are the same. One tool more, packs, and files of samples.
$ mkdir r r/sub
$ cp two.exr brick.jpg r
$ cd r
+ retex-combine -q two.exr --texture floor=brick.jpg -o fused.exr
+ cd sub
+ retex-sample -q ../two.exr --refer --texture floor=../brick.jpg >refer.exr
+ (
+     cd /
+     retex-combine -q - -o "$OLDPWD/out.exr"
+ ) <refer.exr
+ cmp out.exr ../fused.exr && echo same
+ retex-info refer.exr | head -2 | sed "s|${PWD%/sub}|THERE|"
+ retex-combine -q refer.exr -o out.exr
+ cmp out.exr ../fused.exr && echo same
> same
> samples of     3 footprints out of 6, 48 x 32 pixels
> of the set     THERE/two.exr
> same
$ cd r
+ retex-info --json sub/refer.exr | grep -o '"set":{[^}]*}' | sed "s|$PWD|HERE|" >told
+ sum=$(grep -a -o '"retex":[0-9]*,"crc32":"[0-9a-f]*"' two.exr | head -1 | cut -d, -f2)
+ echo "\"set\":{\"path\":\"HERE/two.exr\",\"bytes\":$(wc -c <two.exr),$sum}" | cmp - told && echo right
> right
$ cd r
+ retex-combine -q two.exr --texture floor=brick.jpg --texture wall=brick.jpg -o both.exr
+ for o in --refer -q; do
+     retex-sample -q two.exr --refer --texture floor=brick.jpg |
+         retex-sample -q - $o --texture wall=brick.jpg >then.exr
+     retex-info then.exr | grep -c 'of the set'
+     retex-combine -q - -o out.exr <then.exr
+     cmp out.exr both.exr && echo same
+ done
> 1
> same
> 0
> same
$ cd r
+ retex-pack -q --lossless two.exr -o two.retex
+ retex-sample -q two.retex --refer --texture floor=brick.jpg | retex-combine -q - -o out.exr
+ retex-combine -q two.retex --texture floor=brick.jpg -o pack.exr
+ cmp out.exr pack.exr && echo same
> same
# What is refused: another set, of another size or only of another content; a set that is gone, or no file; standard
# input, and a stream that carries its set; an output that is the set.
$ cd r
+ for n in A B; do
+     make_set $n.exr 48 32 lamp:$n
+     make_plain $n.exr $n-plain.exr
+ done
+ cmp -s A-plain.exr B-plain.exr || stat -c %s A-plain.exr B-plain.exr | uniq | wc -l
+ cp A-plain.exr set.exr
+ retex-sample -q set.exr --refer --texture floor=brick.jpg >to-set.exr
+ retex-combine -q to-set.exr -o a.exr && rm a.exr
+ for f in B-plain A; do
+     cp $f.exr set.exr
+     retex-combine -q to-set.exr -o x.exr 2>&1 | sed "s|$PWD|HERE|"
+ done
> 1
> retex-combine: error: HERE/set.exr is not the set that the samples were made for: it has changed
> retex-combine: error: HERE/set.exr is not the set that the samples were made for: it has changed
$ cd r
+ rm set.exr
+ retex-combine -q to-set.exr -o x.exr 2>&1 | sed "s|$PWD|HERE|"
+ mkfifo set.exr
+ retex-combine -q to-set.exr -o x.exr 2>&1 | sed "s|$PWD|HERE|"
+ retex-sample -q - --refer --texture floor=brick.jpg <two.exr
+ retex-sample -q two.exr --texture floor=brick.jpg | retex-sample -q - --refer --texture wall=brick.jpg
> retex-combine: error: cannot read HERE/set.exr: No such file or directory
> retex-combine: error: HERE/set.exr, the set that the samples name, is no regular file
! retex-sample: error: standard input cannot be referred to: it is no file
! retex-sample: error: standard input is a stream that carries its set: --refer needs the set's file
= 2
$ cd r
+ cp two.exr kept.exr
+ retex-combine -q sub/refer.exr -o two.exr 2>&1 | sed "s|$PWD|HERE|"
+ cmp two.exr kept.exr
+ ls x.exr
> retex-combine: error: two.exr: the output would replace the set, HERE/two.exr
! ls: cannot access 'x.exr': No such file or directory
= 2
# --safe: in the current folder or the samples', or below.
$ cd r
+ retex-combine --safe -q - -o x.exr <sub/refer.exr && echo read
+ cd sub
+ retex-combine --safe -q - -o x.exr <refer.exr 2>&1 | sed "s|${PWD%/sub}|THERE|"
+ RETEX_SAFE=1 retex-combine -q refer.exr -o x.exr 2>&1 | sed "s|${PWD%/sub}|THERE|"
+ retex-sample --safe -q - --texture wall=../brick.jpg -o x.exr <refer.exr 2>&1 | sed "s|${PWD%/sub}|THERE|"
+ ls x.exr
+ cp refer.exr ..
+ retex-combine --safe -q ../refer.exr -o x.exr && echo read
> read
> retex-combine: error: THERE/two.exr is outside the folders that may be read (--safe)
> retex-combine: error: THERE/two.exr is outside the folders that may be read (--safe)
> retex-sample: error: THERE/two.exr is outside the folders that may be read (--safe)
> read
! ls: cannot access 'x.exr': No such file or directory

# A texture that is cut off or damaged is refused, in one line; so is a name that promises another format.
$ head -c 20000 brick.jpg >cut.jpg; retex-sample -q two.exr --texture floor=cut.jpg -o x.exr
! retex-sample: error: cut.jpg: cannot read: the file is truncated (--accept-damaged reads it)
= 2
$ make_picture p.png; head -c 400 p.png >cut.png; retex-sample -q two.exr --texture floor=cut.png -o x.exr
! retex-sample: error: cut.png: cannot read: the file is truncated
= 2
$ cp p.png bad.png
$ printf 'XX' | dd of=bad.png bs=1 seek=300 conv=notrunc 2>/dev/null
$ retex-sample -q two.exr --texture floor=bad.png -o x.exr
! retex-sample: error: bad.png: cannot read: the file is damaged: a checksum is wrong
= 2
$ retex-sample -q two.exr --texture floor=brick.jpg -o x.png
! retex-sample: error: x.png: samples are an OpenEXR file, .exr; pictures are made by retex-combine
= 2
$ retex-sample -q two.exr --texture floor=brick.jpg -o brick.jpg
! retex-sample: error: brick.jpg: the output would replace the texture
= 2
$ ls x.*
! ls: cannot access 'x.*': No such file or directory
= 2

# Little of a set and its samples is in memory, whatever their size: here 94 megabytes of samples, and 240 that
# go through a pipe; the first 64 of these are kept there.
$ make_set big.exr 1024 1280
$ set -- --threads 2 --texture floor=brick.jpg --texture 'Wall=rgb(1,.5,.2)'
+ make_peak file retex-sample -q big.exr "$@" -o big-samples.exr
+ make_peak both retex-combine -q --threads 2 big.exr big-samples.exr -o both.exr
+ make_peak in retex-sample -q big.exr "$@" | make_peak out retex-combine -q --threads 2 - -o pipe.exr
+ cmp both.exr pipe.exr
+ for f in file both in out; do awk '{ print ($1 < 100 ? "little" : $1) }' $f; done
> little
> little
> little
> little

# A temporary file that can hold no more is said, and nothing is left behind.
$ mkdir full
$ sh -c 'trap "" XFSZ; ulimit -f 8; retex-sample -q big.exr --texture floor=brick.jpg -o full/x.exr'
! retex-sample: error: cannot write a temporary file in full: File too large
= 2
$ ls -A full
$ sh -c 'trap "" XFSZ; ulimit -f 8; TMPDIR=full retex-sample -q big.exr --texture floor=brick.jpg -o - | wc -c'
> 0
! retex-sample: error: cannot write a temporary file in full: File too large
$ ls -A full
$ retex-sample -q big.exr --texture floor=brick.jpg 2>err |
+     sh -c 'trap "" XFSZ; ulimit -f 8; TMPDIR=full retex-combine -q - -o full/x.jpg'
! retex-combine: error: cannot write a temporary file in full: File too large
= 2
$ ls -A full

# A width is in scene units along each axis: where a unit of u spans 2 of them and one of v 3, width=1,.5 is scale=2,6.
$ cp "$SCENES/textures/brick.jpg" .
$ cat >wide.pov <<'END'
+ camera { location <1, 1.5, -4> look_at <1, 1.5, 0> } light_source { <1, 1, -5> rgb 1 }
+ #declare Wide = mesh2 {
+     vertex_vectors { 4, <0,0,0>, <2,0,0>, <2,3,0>, <0,3,0> }
+     uv_vectors { 4, <0,0>, <1,0>, <1,1>, <0,1> }
+     face_indices { 2, <0,1,2>, <0,2,3> }
+     uv_mapping
+     pigment { rgb 1 }
+ }
+ object { Wide }
+ END
$ retex-render -q --size 32x24 --spp 4 -t Wide wide.pov -o wide.exr
$ for spec in width=1,.5 scale=2,6; do
+     retex-sample -q wide.exr --texture:$spec Wide=brick.jpg | retex-combine -q - -o $spec.exr
+ done
$ retex-diff -q width=1,.5.exr scale=2,6.exr --fail-psnr 80
