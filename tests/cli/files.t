# No output replaces an input or another output: refused before the work, whatever the files are called.
$ make_set s.exr 48 32
$ retex-pack -q s.exr -o s.retex
$ cp "$SCENES/textures/brick.jpg" t.jpg
$ cp t.jpg u.jpg

# A room that includes a file, and has an image.
$ echo 'sphere{0,1}' >part.inc
$ cat >room.pov <<'END'
+ #include "part.inc"
+ camera{location -4*z look_at 0}
+ light_source{<0,5,-5>,1}
+ #declare F=texture{pigment{image_map{jpeg "t.jpg"}}}
+ plane{y,-1 texture{F}}
+ END
$ retex-render -q --size 24x16 --spp 4 -t F room.pov -o c.exr
$ retex-sample -q s.exr --texture floor=t.jpg -o a.exr
$ ln t.jpg hard.jpg
$ ln -s t.jpg soft.jpg
$ ln -s s.exr set.retex
$ ln -s later.png dangling.png
$ mkdir sub
% # The files are what must not change.
% keep() { md5sum * 2>/dev/null >../sums || true; }
% # Each command fails, and no file is another, or a new one: try COMMAND…
% try() {
%     r='retex-render -q --size 24x16 --spp 2' c='retex-combine -q'
%     for x; do eval "$x" && echo "DONE: $x"; done
%     md5sum * 2>/dev/null | diff ../sums -
% }
$ keep

# The scene, what it includes, and its images.
$ try '$r room.pov -o room.pov' '$r room.pov -o x.exr --stats room.pov' \
+     '$r room.pov -o x.exr --stats ./sub/../room.pov'
! retex-render: error: room.pov: the output would replace the scene
! retex-render: error: room.pov: --stats would replace the scene
! retex-render: error: ./sub/../room.pov: --stats would replace the scene, room.pov
$ try '$r room.pov -o x.exr --stats part.inc' '$r --plain room.pov -o t.jpg' '$r --plain room.pov -o soft.jpg' \
+     '$r --plain room.pov -o hard.jpg' '$r room.pov -o x.exr --stats t.jpg' \
+     '$r room.pov --trace-pixel 1,1,0 >>part.inc' '$r --list-targets room.pov >>room.pov'
! retex-render: error: part.inc: --stats would replace a file that the scene reads
! retex-render: error: t.jpg: the output would replace a file that the scene reads
! retex-render: error: soft.jpg: the output would replace a file that the scene reads, t.jpg
! retex-render: error: hard.jpg: the output would replace a file that the scene reads, t.jpg
! retex-render: error: t.jpg: --stats would replace a file that the scene reads
! retex-render: error: standard output: the answer would replace a file that the scene reads, part.inc
! retex-render: error: standard output: the answer would replace the scene, room.pov
$ try '$r room.pov --aov-dir sub -o sub/beauty.exr' \
+     'ln -s ../t.jpg sub/uv.png; $r room.pov --aov-dir sub -o x.exr; e=$?; rm sub/uv.png; test $e = 0'
! retex-render: error: sub/beauty.exr: the output and the file of --aov-dir are the same file
! retex-render: error: sub/uv.png: the file of --aov-dir would replace a file that the scene reads, t.jpg

# Textures, sets and tables of retex-render.
$ try '$r --replace F=u.jpg room.pov -o u.jpg' '$r --replace F=u.jpg room.pov -o x.exr --stats u.jpg' \
+     "\$r --replace F='s.retex?Floor=u.jpg' room.pov -o s.retex" \
+     '$r --control c.exr --replace F=u.jpg room.pov -o c.exr' \
+     '$r --control c.exr --replace F=u.jpg room.pov -o x.exr --stats c.exr'
! retex-render: error: u.jpg: the output would replace the texture
! retex-render: error: u.jpg: --stats would replace the texture
! retex-render: error: s.retex: the output would replace the texture
! retex-render: error: c.exr: the output would replace the set of --control
! retex-render: error: c.exr: --stats would replace the set of --control

# Tables: what a row writes, no other row reads or writes, whatever its name.
$ cat >v1 <<'END'
+ output,F
+ x.png,u.jpg
+ u.jpg,t.jpg
+ END
$ cat >v2 <<'END'
+ output,F
+ x.png,u.jpg
+ sub/x.png,u.jpg
+ sub/../x.png,t.jpg
+ END
$ cat >v3 <<'END'
+ output,F
+ x.png,u.jpg
+ t.jpg,u.jpg
+ END
$ cat >v4 <<'END'
+ output,F
+ x.png,u.jpg
+ room.pov,u.jpg
+ END
$ cat >v5 <<'END'
+ output,F
+ x.png,u.jpg
+ dangling.png,u.jpg
+ later.png,u.jpg
+ END
$ cat >v6.png <<'END'
+ output,F
+ x.png,u.jpg
+ v6.png,u.jpg
+ END
$ cat >v7 <<'END'
+ output,F
+ x.png,u.jpg
+ y.png,x.png
+ END
$ keep
$ for k in 1 2 3 4 5 6.png 7; do try "\$r --variants v$k room.pov"; done
! retex-render: error: v1:3: u.jpg: the output of the table's line 3 would replace the texture
! retex-render: error: v2:4: sub/../x.png: the output of the table's line 2 and the output of the table's line 4 are the same file
! retex-render: error: t.jpg: the output of the table's line 3 would replace a file that the scene reads
! retex-render: error: v4:3: room.pov: the output of the table's line 3 would replace the scene
! retex-render: error: v4:3: room.pov: no picture format that can be written has the ending .pov; these have: .png .jpg .pfm .tif .exr .hdr .bmp .tga .webp .avif .jxl .heic .jp2 .j2k .dpx .gif .ppm .pnm .sgi .ico .iff .rla .fits
! retex-render: error: v5:4: later.png: the output of the table's line 3 and the output of the table's line 4 are the same file
! retex-render: error: v6.png:3: v6.png: the output of the table's line 3 would replace the table
! retex-render: error: v7:2: x.png: the output of the table's line 2 would replace the texture
! retex-render: error: v7:3: cannot read x.png: No such file or directory
$ for k in 1 2 6.png 7; do sed s/,F/,floor/\;s/v6/w6/ v$k >w$k; done
$ keep
$ for k in 1 2 6.png 7; do try "\$c s.exr --batch w$k"; done
! retex-combine: error: w1:3: u.jpg: the output of the table's line 3 would replace the texture
! retex-combine: error: w2:4: sub/../x.png: the output of the table's line 2 and the output of the table's line 4 are the same file
! retex-combine: error: w6.png:3: w6.png: the output of the table's line 3 would replace the table
! retex-combine: error: w7:2: x.png: the output of the table's line 2 would replace the texture
! retex-combine: error: w7:3: cannot read x.png: No such file or directory
$ try '$c s.exr --batch - <w6.png' "printf 'output\ns.exr\n' | \$c s.exr --batch -" \
+     "printf 'output\na.exr\n' | \$c s.exr a.exr --batch -"
! retex-combine: error: standard input:3: w6.png: the output of the table's line 3 would replace the table, standard input
! retex-combine: error: standard input:2: s.exr: the output of the table's line 2 would replace the set
! retex-combine: error: standard input:2: a.exr: the output of the table's line 2 would replace the samples
# With 17 rows the last one is of another lot.
$ {
+     printf 'output,F\n'
+     seq -f 'x%g.png,t.jpg' 16
+     echo u.jpg,u.jpg
+ } >v8
$ keep
$ try '$r --variants v8 room.pov'
! retex-render: error: v8:18: u.jpg: the output of the table's line 18 would replace the texture

# Rows kept.
$ try '$r room.pov --resume -o x.exr --stats x.exr.partial' '$r --resume room.pov -o room.pov'
! retex-render: error: x.exr.partial: --stats and the file of finished rows are the same file
! retex-render: error: room.pov: the output would replace the scene
$ cp u.jpg x.png.partial
$ keep
$ try '$r --replace F=x.png.partial --resume room.pov -o x.png'
! retex-render: error: x.png.partial: the file of finished rows would replace the texture
$ rm x.png.partial
$ keep

# retex-combine, retex-sample, retex-denoise and retex-pack.
$ try '$c s.exr -o s.exr' '$c s.exr a.exr -o a.exr' '$c s.exr a.exr -o s.exr' \
+     '$c s.exr --texture floor=t.jpg -o soft.jpg' '$c s.exr --texture floor=t.jpg --error x.png -o x.png' \
+     '$c s.exr --texture floor=t.jpg --error t.jpg -o x.png' '$c - <s.exr -o s.exr' '$c s.exr >>s.exr' \
+     '$c s.exr --texture floor=t.jpg --error - >>x.png; e=$?; rm -f x.png; test $e = 0'
! retex-combine: error: s.exr: the output would replace the set
! retex-combine: error: a.exr: the output would replace the samples
! retex-combine: error: s.exr: the output would replace the set
! retex-combine: error: soft.jpg: the output would replace the texture, t.jpg
! retex-combine: error: x.png: the output and --error are the same file
! retex-combine: error: t.jpg: --error would replace the texture
! retex-combine: error: s.exr: the output would replace the set, standard input
! retex-combine: error: standard output: the output would replace the set, s.exr
! retex-combine: error: the output and --error cannot both be standard output
$ try 'retex-sample s.exr --texture floor=t.jpg -o s.exr' 'retex-sample - --texture floor=t.jpg <s.exr -o s.exr' \
+     'cp t.jpg tex; retex-sample s.exr --texture floor=tex -o tex; e=$?; rm tex; test $e = 0'
! retex-sample: error: s.exr: the output would replace the set
! retex-sample: error: s.exr: the output would replace the set, standard input
! retex-sample: error: tex: the output would replace the texture
$ try 'retex-denoise c.exr -o c.exr' 'retex-denoise - <c.exr >>c.exr' \
+     'cp s.retex p.retex; ln -s p.retex q.exr; retex-denoise p.retex -o q.exr; e=$?; rm p.retex q.exr; test $e = 0'
! retex-denoise: error: c.exr: the output would replace the set
! retex-denoise: error: standard output: the output would replace the set, standard input
! retex-denoise: error: q.exr: the output would replace the set, p.retex
$ try 'retex-pack s.exr -o set.retex' 'retex-pack s.exr -o x.retex --stats s.exr' \
+     'retex-pack s.exr -o x.retex --stats x.retex' 'retex-pack s.exr -o x.retex --stats ./sub/../x.retex' \
+     'ln -s s.retex unpacked.exr; retex-pack --unpack s.retex -o unpacked.exr; e=$?; rm unpacked.exr; test $e = 0'
! retex-pack: error: set.retex: the output would replace the set, s.exr
! retex-pack: error: s.exr: --stats would replace the set
! retex-pack: error: x.retex: the output and --stats are the same file
! retex-pack: error: ./sub/../x.retex: the output and --stats are the same file
! retex-pack: error: unpacked.exr: the output would replace the pack, s.retex
$ try 'retex-info s.exr >>s.exr' 'retex-diff s.exr c.exr >>c.exr' 'retex-diff - - <s.exr' \
+     'retex-info s.exr -o s.exr' 'retex-info --check soft.jpg -o t.jpg' 'retex-info - -o s.exr <s.exr' \
+     'retex-diff s.exr c.exr -o ./sub/../c.exr' 'retex-diff s.exr - -o s.retex <s.retex'
! retex-info: error: standard output: the answer would replace the set, s.exr
! retex-diff: error: standard output: the answer would replace B, c.exr
! retex-diff: error: A and B cannot both be standard input
! retex-info: error: s.exr: the answer would replace the set
! retex-info: error: t.jpg: the answer would replace the set, soft.jpg
! retex-info: error: s.exr: the answer would replace the set, standard input
! retex-diff: error: ./sub/../c.exr: the answer would replace B, c.exr
! retex-diff: error: s.retex: the answer would replace B, standard input

# Standard input and output can be one thing each.
$ try '$r room.pov -o - --stats - >/dev/null' '$c - - -o x.png <s.exr' '$c s.exr - --batch - </dev/null' \
+     '$c - --batch - <s.exr'
! retex-render: error: the output and --stats cannot both be standard output
! retex-combine: error: the set and the samples cannot both be standard input
! retex-combine: error: the samples and the table cannot both be standard input
! retex-combine: error: the set and the table cannot both be standard input
$ touch config.png
$ keep
$ export OCIO=config.png
+ try '$c s.exr -o config.png'
! retex-combine: error: config.png: the output would replace the OpenColorIO configuration
$ rm config.png

# Devices may be everything at once, and a file may be read twice.
$ retex-render -q --size 24x16 --spp 2 room.pov -o /dev/null --stats /dev/null
$ retex-diff -q s.exr s.exr
$ retex-render -q --plain --size 24x16 --spp 2 --replace F=t.jpg room.pov -o x.png
$ retex-combine -q s.exr --texture floor=t.jpg --texture wall=t.jpg -o x.png
$ cat >b.csv <<'END'
+ output,floor
+ x.png,t.jpg
+ y.png,t.jpg
+ link.png,soft.jpg
+ END
$ retex-combine -q s.exr --batch b.csv
$ mkfifo pipe
$ cat pipe >/dev/null &
+ retex-combine -q s.exr -o - >pipe

# An output that is there already is replaced; a checkpoint is an input and an output.
$ retex-combine -q s.exr -o x.png
$ retex-render -q --resume --size 24x16 --spp 2 room.pov -o c.exr
$ retex-render -q --resume --size 24x16 --spp 2 room.pov -o c.exr
