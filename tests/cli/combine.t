# retex-combine: three ways to the same picture, errors, and what stays behind.
$ make_set s.exr 48 32
$ cp "$SCENES/textures/brick.jpg" .
$ retex-combine -q s.exr --texture floor=brick.jpg -o fused.exr
$ retex-sample -q s.exr --texture floor=brick.jpg -o a.exr
$ retex-combine -q s.exr a.exr -o files.exr
$ retex-diff -q fused.exr files.exr
$ retex-sample -q s.exr --texture floor=brick.jpg | retex-combine -q - -o pipe.exr
$ cmp pipe.exr files.exr
$ retex-combine -q s.exr --texture floor=brick.jpg >out.exr
$ retex-diff -q out.exr fused.exr
$ retex-combine -q s.exr -o original.exr
$ retex-diff -q original.exr fused.exr --fail-psnr 60
= 1
$ for f in x.png x.jpg x.tif x.hdr x.exr; do
+     retex-combine -q s.exr --texture floor=brick.jpg -o $f && retex-diff -q $f fused.exr --fail-psnr 20 || echo $f
+ done
# --depth 16: a PNG as fine as a TIFF of 16 bits, and finer than one of 8; --depth 8 is PNG's default.
$ for d in 8 16; do
+     for f in png tif; do retex-combine -q s.exr --texture floor=brick.jpg --depth $d -o d$d.$f; done
+     oiiotool --info d$d.png d$d.tif | sed 's/ *: */: /; s/  */ /g'
+ done
> d8.png: 48 x 32, 3 channel, uint8 png
> d8.tif: 48 x 32, 3 channel, uint8 tiff
> d16.png: 48 x 32, 3 channel, uint16 png
> d16.tif: 48 x 32, 3 channel, uint16 tiff
$ cmp d8.png x.png
$ retex-diff -q d16.png d16.tif --fail-abs 0
$ retex-diff -q d16.png fused.exr --fail-psnr 90
$ retex-diff -q d8.png fused.exr --fail-psnr 62
= 1
$ rm d8.* d16.*
# TIFF is as OpenImageIO writes it, but for the time and the length of strips: into a pipe it writes. It is not loaded
# otherwise. Pictures of several strips, and one smaller than a strip; files are the same each time.
$ make_set tall.exr 70 200
% # The TIFF of SET with OPTION… by both: as_theirs SET OPTION…
% as_theirs() {
%     mkfifo f.tif
%     cat f.tif >theirs.tif &
%     retex-combine -q "$@" -o f.tif
%     wait
%     rm f.tif
%     RETEX_BRIDGE=/nowhere retex-combine -q --threads 3 "$@" -o ours.tif
%     RETEX_BRIDGE=/nowhere retex-combine -q --threads 1 "$@" -o again.tif
%     cmp ours.tif again.tif
%     oiiotool --diff ours.tif theirs.tif | tail -1
%     for f in ours theirs; do oiiotool --info -v $f.tif | grep -v "DateTime\|RowsPerStrip\|$f" >$f.txt; done
%     cmp ours.txt theirs.txt && grep -c ColorSpace ours.txt
% }
$ for set in s tall; do
+     as_theirs $set.exr --depth 8 --view Standard
+     as_theirs $set.exr --depth 16 --view Filmic
+ done | sort | uniq -c | sed 's/^ *//'
> 4 2
> 4 PASS
$ rm tall.exr
$ for f in sgi jp2 dpx; do
+     retex-combine -q s.exr --depth 16 -o d16.$f
+     oiiotool --info d16.$f | sed 's/ *: */: /; s/  */ /g'
+ done
> d16.sgi: 48 x 32, 3 channel, uint16 sgi
> d16.jp2: 48 x 32, 3 channel, uint16 jpeg2000
> d16.dpx: 48 x 32, 3 channel, uint16 dpx
$ rm d16.*
$ retex-combine -q s.exr --depth 12 -o y.png
! retex-combine: error: --depth: expected 8 or 16, not '12'
= 2
$ for f in jpg exr hdr webp bmp; do retex-combine -q s.exr --depth 16 -o y.$f; done
! retex-combine: error: y.jpg: this format has 8 bits; try .png or .tif
! retex-combine: error: y.exr: this format keeps floats: it has no depth to choose
! retex-combine: error: y.hdr: this format keeps floats: it has no depth to choose
! retex-combine: error: y.webp: this format has 8 bits; try .png or .tif
! retex-combine: error: y.bmp: this format has 8 bits; try .png or .tif
= 2
$ ls y.*
! ls: cannot access 'y.*': No such file or directory
= 2
# --quality is that of the JPEG: smaller files, farther from the picture; 95 where it is not given.
$ for q in 20 60 95; do retex-combine -q s.exr --texture floor=brick.jpg --quality $q -o q$q.jpg; done
$ cmp q95.jpg x.jpg
$ test $(stat -c %s q20.jpg) -lt $(stat -c %s q60.jpg) && test $(stat -c %s q60.jpg) -lt $(stat -c %s q95.jpg) &&
+     echo larger
> larger
$ rm q*.jpg
# A pack without loss gives the same.
$ retex-pack -q --lossless s.exr -o s.retex
$ retex-combine -q s.retex --texture floor=brick.jpg -o pack.exr
$ cmp pack.exr fused.exr

# JPEG, PNG and EXR need no OpenImageIO; the others say so.
$ for f in x.jpg x.png x.exr; do RETEX_BRIDGE=none.so retex-combine -q s.exr -o $f || echo $f; done
$ RETEX_BRIDGE=none.so retex-combine -q s.exr -o x.bmp 2>&1 | cut -d: -f1-4
> retex-combine: error: x.bmp: this needs OpenImageIO, which cannot be loaded

# Several pictures with the set read once.
$ cat >batch.csv <<'END'
+ output,Floor,Wall
+ one.png,brick.jpg,
+ two.png,"rgb(0.1,0.2,0.3)",brick.jpg
+ END
$ retex-combine -q s.exr --batch batch.csv
$ ls one.png two.png
> one.png
> two.png

# --cross leaves out terms of more hits: each choice is another picture, and 3 is the default.
$ for c in 0 2 3; do retex-combine -q s.exr --texture floor=brick.jpg --cross $c -o c$c.exr; done
$ cmp c3.exr fused.exr
$ cmp -s c0.exr c2.exr || echo 0 is not 2
> 0 is not 2
$ cmp -s c2.exr c3.exr || echo 2 is not 3
> 2 is not 3

# What is refused, and what cannot be read or written: one line, and no file.
$ retex-combine
! retex-combine: error: no set given; - is standard input
= 2
$ retex-combine -q s.exr --texture Sofa=brick.jpg -o y.exr
! retex-combine: error: no target is called 'Sofa'; the set has Floor, Wall
= 2
$ retex-combine -q s.exr --texture floor=none.jpg -o y.exr
! retex-combine: error: cannot read none.jpg: No such file or directory
= 2
$ retex-combine -q s.exr -o y.xyz
! retex-combine: error: y.xyz: no picture format that can be written has the ending .xyz; these have: .png .jpg .pfm .tif .exr .hdr .bmp .tga .webp .avif .jxl .heic .jp2 .j2k .dpx .gif .ppm .pnm .sgi .ico .iff .rla .fits
= 2
$ retex-combine -q s.exr -o nowhere/y.png
! retex-combine: error: cannot write nowhere/y.png: No such file or directory
= 2
$ retex-combine -q none.exr -o y.png
! retex-combine: error: cannot read none.exr: No such file or directory
= 2
$ make_set other.exr 32 32
$ retex-combine -q other.exr a.exr -o y.exr
! retex-combine: error: the samples have 48 x 32 pixels, the set 32 x 32
= 2
$ make_picture p.exr
$ retex-combine -q p.exr -o y.exr 2>err
= 2
$ grep -c 'retex-combine: error: .*p.exr' err
> 1
$ retex-sample -q s.exr --texture floor=brick.jpg 2>/dev/null | head -c 20000 | retex-combine -q - -o y.png 2>err
= 2
$ grep -c 'error: standard input.*damaged' err
> 1
$ retex-combine -q s.exr -o /dev/full
! retex-combine: error: cannot write /dev/full: No space left on device
= 2
$ retex-combine -q s.exr >/dev/full
! retex-combine: error: cannot write standard output: No space left on device
= 2
$ { sleep 0.3; retex-combine -q s.exr; echo $? >&2; } | :
! 141
$ ls y.*
! ls: cannot access 'y.*': No such file or directory
= 2

# An old picture is whole after a failure.
$ echo old >old.png
$ retex-combine -q none.exr -o old.png 2>/dev/null
= 2
$ cat old.png
> old
$ echo old >old.exr
$ head -c 30000 s.exr >cut.exr
$ retex-combine -q cut.exr -o old.exr 2>/dev/null
= 2
$ cat old.exr
> old
$ ls -A | grep -i 'tmp\|^\.[^.]'
= 1

# The same bits whatever the number of threads.
$ for n in 1 2 7; do retex-combine -q s.exr --threads $n --texture:scale=3:rotate=20 wall=brick.jpg -o $n.exr; done
$ cmp 1.exr 2.exr
$ cmp 1.exr 7.exr

# A batch keeps no more of a set and its samples than --memory says, here 94 megabytes of samples.
$ make_set big.exr 1024 1280
$ retex-sample -q big.exr --texture floor=brick.jpg --texture 'Wall=rgb(1,.5,.2)' -o big-samples.exr
$ cat >big.csv <<'END'
+ output
+ row1.png
+ row2.png
+ END
$ make_peak batch retex-combine -q --threads 2 --memory 64 big.exr big-samples.exr --batch big.csv
$ awk '{ print ($1 < 64 ? "little" : $1) }' batch
> little
$ cp row1.png few.png
$ retex-combine -q big.exr big-samples.exr --batch big.csv
$ cmp row1.png row2.png
$ cmp few.png row1.png
$ rm big* row?.png few.png

# The picture must not replace what it is made of; the name is looked at before the work.
$ retex-combine -q s.exr --texture floor=brick.jpg -o brick.jpg
! retex-combine: error: brick.jpg: the output would replace the texture
= 2
$ printf 'output,floor\nbrick.jpg,brick.jpg\n' | retex-combine -q s.exr --batch -
! retex-combine: error: standard input:2: brick.jpg: the output of the table's line 2 would replace the texture
= 2
$ retex-combine -q s.exr -o noending
! retex-combine: error: noending: cannot tell the picture's format: the name has no ending, such as .png or .exr
= 2
$ printf 'output,floor\nnoending,brick.jpg\n' | retex-combine -q s.exr --batch -
! retex-combine: error: standard input:2: noending: cannot tell the picture's format: the name has no ending, such as .png or .exr
= 2
$ retex-combine -q s.exr a.exr --batch - - </dev/null
! retex-combine: error: one set and its samples are enough; what is '-'?
= 2
$ retex-combine -q s.exr - --batch - </dev/null
! retex-combine: error: the samples and the table cannot both be standard input
= 2
$ retex-combine -q s.exr --view Raw -o y.exr
! retex-combine: warning: an OpenEXR file stays scene-linear: --display and --view do nothing; --colorspace would

# A killed run leaves nothing behind, at whatever moment.
$ mkdir killed
$ for f in p.png p.exr p.jp2; do
+     for t in .05 .1 .15 .2 .25 .3 .4; do
+         rm -f killed/$f
+         timeout --foreground -s KILL $t retex-combine -q s.exr -o killed/$f || true
+     done
+ done >/dev/null 2>&1
$ rm -f killed/p.*
$ ls -A killed

# Nothing came down the pipe.
$ retex-combine -q - -o y.png </dev/null
! retex-combine: error: standard input is not a set: it is empty
= 2

# A scene without targets is a picture: it can be developed, packed and made smaller like one that could be retextured.
$ echo 'camera { location -3*z look_at 0 } light_source { -9*z, 1 } sphere { 0, 1 pigment { rgb <.8,.4,.2> } }' >p.pov
$ retex-render -q --size 16x12 --spp 4 p.pov -o plain.exr
$ retex-render -q --size 16x12 --spp 4 --target 'S=#1' p.pov -o whole.exr
$ retex-combine -q plain.exr -o plain-is.exr
$ retex-combine -q whole.exr -o whole-is.exr
$ retex-diff -q plain-is.exr whole-is.exr --fail-psnr 50
$ retex-combine -q - -o stream.exr <plain.exr
$ retex-diff -q stream.exr plain-is.exr --fail-abs 0 || echo the stream differs
$ retex-combine -q --size 8x6 --exposure 1 plain.exr -o small-is.exr
$ oiiotool --stats small-is.exr | grep -c 'Avg: 0.000'
> 0
= 1
