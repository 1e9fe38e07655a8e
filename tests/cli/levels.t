# Levels of packs: smaller sets beside the set, for small pictures.
$ ln -s "$SCENES/textures" textures
$ ln -s "$SCENES/cornell-box/textures/encaustic-tiles.jpg" tiles.jpg
$ retex-render -q --denoise --size 486x60 --spp 16 --lamps each -t Floor -t Left -DGlass=1 -DLamps=1 "$TESTS/../golden/room.pov" \
+     -o s.exr
$ retex-pack -q s.exr --levels -o l.retex
$ retex-pack -q s.exr -o n.retex
$ retex-info l.retex | grep ^level | sed 's/[0-9]* bytes/N bytes/'
> level 1/3      162 x 20 pixels, N bytes
$ retex-info --json l.retex >l.json
$ python3 - <<'END'
+ import json
+ levels = json.load(open("l.json"))["levels"]
+ print([(level["scale"], level["width"], level["height"], level["bytes"] > 1000) for level in levels])
+ END
> [(3, 162, 20, True)]
$ retex-info --json n.retex | grep -c levels
> 0
= 1

# All else is as without them, and a level is a pack of its own.
$ python3 - <<'END'
+ import zipfile
+ l, n = zipfile.ZipFile("l.retex"), zipfile.ZipFile("n.retex")
+ print([k for k in l.namelist() if k not in n.namelist()], [k for k in n.namelist() if l.read(k) != n.read(k)])
+ open("l3.retex", "wb").write(l.read("level-3.retex"))
+ END
> ['level-3.retex'] ['manifest.json']
$ retex-info --check l3.retex
> l3.retex: ok
$ retex-info l3.retex | grep -E '^(size|samples|level)'
> size           162 x 20 pixels, box filter
> samples        144 a pixel, seed 0
$ for f in l n; do retex-combine -q $f.retex --texture Floor=tiles.jpg -o $f.exr; done
$ cmp l.exr n.exr
$ retex-pack -q --unpack l.retex --level 3 -o u.exr
$ retex-pack -q --unpack l3.retex -o v.exr
$ cmp u.exr v.exr
$ retex-pack -q --unpack l.retex -o u.exr
$ retex-info u.exr | grep ^size
> size           486 x 60 pixels, box filter

# Pictures of it are those of the whole set, averaged: with textures, with one lamp, and with colours; each to at least so
# many dB, for its quality is up to 20 less than the pack's.
$ cat >edits <<'END'
+ 46 --texture Floor=textures/brick.jpg
+ 46 --texture:scale=3 Floor=tiles.jpg --texture Left=textures/damask.jpg
+ 37 --texture Floor=tiles.jpg --solo light1
+ 46 --texture Left=red
+ 47
+ END
$ while read -r least t; do
+     retex-combine -q l.retex $t -o a.exr
+     retex-combine -q l3.retex $t -o b.exr
+     oiiotool a.exr --resize:filter=box 162x20 -o c.exr
+     retex-diff -q c.exr b.exr --fail-psnr $least
+ done <edits

# Small pictures and parts of them are made of the smallest set that serves, and the server makes the same.
% combine() { retex-combine -v l.retex --texture Floor=tan "$@"; }
$ for o in '--size 162x' '--size 81x10 --crop 0,0,243,30' '--size 40x' '--size 161x' '--size 80x10 --crop 1,0,240,30' \
+     ''; do
+     echo "$o: $(combine $o -o a.exr 2>&1 | grep 'made of')"
+ done
> --size 162x: retex-combine: made of the level of 162 x 20 pixels
> --size 81x10 --crop 0,0,243,30: retex-combine: made of the level of 162 x 20 pixels
> --size 40x: retex-combine: made of the level of 162 x 20 pixels
> --size 161x:
> --size 80x10 --crop 1,0,240,30:
> :
$ retex-pack -q --unpack l.retex --level 3 -o u.exr
$ retex-combine -q u.exr --texture Floor=tan -o a.exr
$ combine --size 162x -o b.exr 2>log
$ retex-diff -q a.exr b.exr --fail-psnr 55
$ mkdir rooms
$ cp l.retex rooms
$ python3 "$TESTS/serve.py" levels
> levels

# A lossless pack has levels of quality 90.
$ retex-pack -q s.exr --lossless --levels -o x.retex
$ retex-pack -q --unpack x.retex -o back.exr
$ cmp s.exr back.exr
$ retex-info --check x.retex
> x.retex: ok
$ unzip -qp x.retex level-3.retex >x3.retex
$ unzip -qp x3.retex manifest.json | grep -o '"quality":[0-9]*'
> "quality":90

# What is refused.
$ make_set p.exr 486 60
$ retex-pack -q p.exr --levels -o y.retex
! retex-pack: error: the set cannot be reduced: it is not of layout footprints
= 2
$ test -e y.retex
= 1
$ retex-pack --levels l.retex -o y.retex
! retex-pack: error: the set cannot be reduced: its images have several sizes, as those of packs have
= 2
$ test -e y.retex
= 1
$ retex-render -q --size 48x32 --spp 2 -t Floor "$TESTS/../golden/room.pov" -o r.exr
$ retex-pack r.exr --levels -o y.retex 2>&1 | grep -v bytes
> retex-pack: warning: the set has no levels: that of a third would be less than 160 pixels wide
$ retex-info y.retex | grep -c ^level
> 0
= 1
$ retex-pack --unpack l.retex --level 4 -o y.exr
! retex-pack: error: --level: l.retex has no set that is 4 times smaller
= 2
$ retex-pack --unpack n.retex --level 3 -o y.exr
! retex-pack: error: --level: n.retex has no set that is 3 times smaller
= 2
$ retex-pack --unpack l.retex --levels -o y.exr
! retex-pack: error: --levels is of packing; --unpack takes --level
= 2
$ retex-pack s.exr --level 3 -o y.retex
! retex-pack: error: --level is of --unpack
= 2
$ retex-pack --unpack - --level 3 -o y.exr <l.retex
! retex-pack: error: --level reads the pack twice: it must be a file
= 2

# A damaged level: told by --check, and where it is read; the whole set stays readable.
$ for what in byte other none; do
+     python3 "$TESTS/levels.py" $what d.retex
+     retex-info --check d.retex
+     echo $?
+     retex-pack -q --unpack d.retex --level 3 -o d.exr
+     echo $?
+ done
> 1
> 2
> 1
> 2
> 1
> 2
! retex-info: error: the pack is damaged: the checksum is wrong of 'level-3.retex'
! retex-pack: error: d.retex: level-3.retex: the pack is damaged: the checksum is wrong of part 'dep_Left_sharp'
! retex-info: error: the pack is damaged: it has another set as 'level-3.retex'
! retex-pack: error: the pack is damaged: it has another set as 'level-3.retex'
! retex-info: error: d.retex: the pack is damaged: it lacks 'level-3.retex'
! retex-pack: error: d.retex: the pack is damaged: it lacks 'level-3.retex'
$ test -e d.exr
= 1
