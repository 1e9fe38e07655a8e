# Pictures of every format are read as they were by a build that did not look for damage, and damaged ones are refused
# where their format lets anybody know. shares.txt has how many of each, and why. No library prints anything itself.
$ /usr/bin/python3 "$TESTS/pictures.py" whole | grep -v '^# '
> read
$ /usr/bin/python3 "$TESTS/pictures.py" pixels
> refused
$ /usr/bin/python3 "$TESTS/pictures.py" damaged 123456789 2 1
> jpeg True True
$ wc -l <shares.txt
> 23
$ /usr/bin/python3 "$TESTS/pictures.py" accepted 258 1 2
> pictures
$ make_digests -a damaged/dpx-10@cut-5.dpx damaged/zfile@cut-5.zfile
> damaged/dpx-10@cut-5.dpx refused -3 cannot read: the file is truncated
> damaged/zfile@cut-5.zfile refused -3 cannot read: the file is truncated

# A JPEG that is cut in half with one byte too many, and one with zeros in its coded data: refused by name, or read
# with a warning.
$ cp whole/jpeg-baseline.jpg full.jpg
$ {
+     head -c 1800 full.jpg
+     printf 'x\377\331'
+ } >cut.jpg
$ cp full.jpg zeros.jpg
$ dd if=/dev/zero of=zeros.jpg bs=1 seek=1500 count=40 conv=notrunc 2>/dev/null
$ make_set s.exr 48 32
$ for f in full cut zeros; do
+     retex-combine -q s.exr --texture Floor=$f.jpg -o $f.exr
+     echo $f $?
+ done
> full 0
> cut 2
> zeros 2
! retex-combine: error: cut.jpg: cannot read: the file is damaged: Corrupt JPEG data: premature end of data segment (--accept-damaged reads it)
! retex-combine: error: zeros.jpg: cannot read: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9 (--accept-damaged reads it)
$ ls cut.exr zeros.exr 2>/dev/null
= 2
$ retex-combine -q --accept-damaged s.exr --texture Floor=zeros.jpg -o zeros.exr
! retex-combine: warning: zeros.jpg: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9; it is read as far as possible
$ RETEX_ACCEPT_DAMAGED=1 retex-combine -q s.exr --texture Floor=cut.jpg -o cut.exr
! retex-combine: warning: cut.jpg: the file is damaged: Corrupt JPEG data: premature end of data segment; it is read as far as possible
$ RETEX_ACCEPT_DAMAGED=0 retex-combine -q s.exr --texture Floor=cut.jpg -o no.exr
! retex-combine: error: cut.jpg: cannot read: the file is damaged: Corrupt JPEG data: premature end of data segment (--accept-damaged reads it)
= 2
$ retex-diff -q full.exr zeros.exr >/dev/null
= 1
$ ls *.exr
> cut.exr
> full.exr
> s.exr
> zeros.exr
$ retex-combine -q --safe s.exr --texture Floor=zeros.jpg -o no.exr
! retex-combine: error: zeros.jpg: cannot read: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9 (--accept-damaged reads it)
= 2
$ retex-combine -q --safe --accept-damaged s.exr --texture Floor=zeros.jpg -o zeros2.exr
! retex-combine: warning: zeros.jpg: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9; it is read as far as possible
$ cmp zeros.exr zeros2.exr
$ cat >t.csv <<'END'
+ output,Floor
+ a.png,full.jpg
+ b.png,zeros.jpg
+ END
$ retex-combine -q s.exr --batch t.csv --keep-going
! retex-combine: error: t.csv:3: zeros.jpg: cannot read: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9 (--accept-damaged reads it)
! retex-combine: error: 1 of 2 pictures failed
= 2
$ ls *.png
> a.png
$ retex-sample -q s.exr --texture Floor=zeros.jpg -o no.exr
! retex-sample: error: zeros.jpg: cannot read: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9 (--accept-damaged reads it)
= 2
$ retex-diff -q full.jpg zeros.jpg
! retex-diff: error: zeros.jpg: cannot read: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9 (--accept-damaged reads it)
= 2
$ retex-diff -q --accept-damaged full.jpg zeros.jpg | head -1
! retex-diff: warning: zeros.jpg: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9; it is read as far as possible

# In scenes: textures, bumps, heights, and numbers of palettes.
% scene() { echo "camera { location -3*z look_at 0 } light_source { -9*z, 1 } $1"; }
$ for p in 'box { -1, 1 pigment { image_map { jpeg "zeros.jpg" } } }' \
+     'box { -1, 1 normal { bump_map { jpeg "zeros.jpg" } } }' 'height_field { jpeg "zeros.jpg" }' \
+     'box { -1, 1 texture { material_map { jpeg "zeros.jpg" texture { pigment { rgb 1 } } } } }'; do
+     scene "$p" >m.pov
+     retex-render -q --size 8x6 --spp 1 m.pov -o no.exr
+     retex-render -q --size 8x6 --spp 1 --accept-damaged m.pov -o m.exr
+ done
! retex-render: error: m.pov:2:1: m.pov:1: image_map: zeros.jpg: cannot read: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9 (--accept-damaged reads it)
! retex-render: m.pov:1: warning: image_map: zeros.jpg: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9; it is read as far as possible
! retex-render: error: m.pov:2:1: bump_map: zeros.jpg: cannot read: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9 (--accept-damaged reads it)
! retex-render: m.pov:2: warning: zeros.jpg: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9; it is read as far as possible
! retex-render: error: m.pov:1:81: height_field: zeros.jpg: cannot read: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9 (--accept-damaged reads it)
! retex-render: m.pov:1: warning: zeros.jpg: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9; it is read as far as possible
! retex-render: error: m.pov:1:145: material_map: zeros.jpg: cannot read: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9 (--accept-damaged reads it)
! retex-render: m.pov:1: warning: zeros.jpg: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9; it is read as far as possible
$ ls no.exr 2>/dev/null
= 2
$ PYTHONPATH=$TESTS/../lib /usr/bin/python3 -B - <<'END'
+ import make_pictures
+ open("p.png", "wb").write(make_pictures.png(3, 8, damage=True))
+ open("q.png", "wb").write(make_pictures.png(2, 8, True, damage=True))
+ END
$ head -c 700 whole/gif.gif >p.gif
$ for f in png:p.png gif:p.gif; do
+     echo "camera { location -3*z look_at 0 } height_field { ${f%:*} \"${f#*:}\" }" >m.pov
+     retex-render -q --size 8x6 --spp 1 m.pov -o no.exr
+ done
! retex-render: error: m.pov:1:55: `p.png`: IDAT: incorrect data check
! retex-render: error: m.pov:1:55: `p.gif`: it has no picture, or ends early
= 2
$ retex-combine -q s.exr --texture Floor=q.png -o no.exr
! retex-combine: error: q.png: cannot read: the file is damaged: IDAT: incorrect data check
= 2
$ retex-combine -q s.exr --texture Floor=p.png -o no.exr
! retex-combine: error: p.png: cannot read: the file is damaged: IDAT: incorrect data check
= 2
$ ls no.exr 2>/dev/null
= 2

# A model's picture.
$ printf 'newmtl m\nmap_Kd zeros.jpg\n' >m.mtl
$ cat >m.obj <<'END'
+ mtllib m.mtl
+ v 0 0 0
+ v 1 0 0
+ v 0 1 0
+ vt 0 0
+ vt 1 0
+ vt 0 1
+ usemtl m
+ f 1/1 2/2 3/3
+ END
$ retex-import -q m.obj -o i 2>&1 | grep zeros
> retex-import: warning: the image `zeros.jpg` cannot be read: cannot read: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9 (--accept-damaged reads it)
$ retex-import -q --accept-damaged m.obj -o j 2>&1 | grep zeros | sed 's|/.*/||'
> retex-import: warning: zeros.jpg: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9; it is read as far as possible
$ ls j/textures
> Zeros.jpg

# What is written has the format that the ending of its name says, or is refused.
$ /usr/bin/python3 "$TESTS/pictures.py" endings
> written

# OpenEXR makes room for an attribute before it reads it, here 1.7 GB for a file of 500 bytes, and is not asked. Files
# of one part and of two that OpenImageIO reads, for the names of their channels, are the same picture.
$ cp "$TESTS/../data/long_attribute.exr" long.exr
$ echo 'plane { y, 0 pigment { image_map { "long.exr" } } }' >m.pov
$ retex-render -q --size 8x6 --spp 1 --accept-damaged m.pov -o no.exr
! retex-render: error: m.pov:2:1: m.pov:1: image_map: long.exr: cannot read: its header is damaged or truncated
= 2
$ for f in one two; do
+     oiiotool -q --pattern constant:color=.5,.25,.125 8x8 3 --chnames X,V,Z $([ $f = one ] || echo --dup --siappend) -o $f.exr
+     echo "background { 1 } plane { z, 1 pigment { image_map { \"$f.exr\" } } }" >m.pov
+     retex-render -q --plain --size 8x6 --spp 1 --aov albedo m.pov -o of_$f.exr
+ done
$ retex-diff -q --part albedo --fail-abs 0 of_one.exr of_two.exr >/dev/null

# OpenEXR reads channels up to the last, and a float of four bytes, whatever length is told: here 55 + 1, and so much
# that the attribute after it is in it. What follows would be taken for something else.
% # A picture with the EXR $1, whose last attribute $2 tells the length $3.
% render_told() {
%     /usr/bin/python3 "$TESTS/pictures.py" tell $1.exr $2 $3 told.exr
%     echo 'background { 1 } plane { z, 1 pigment { image_map { "told.exr" } } }' >m.pov
%     retex-render -q --size 8x6 --spp 1 --accept-damaged m.pov -o told_set.exr && echo read
% }
$ render_told one channels 55
> read
$ render_told one pixelAspectRatio 4
> read
$ render_told one channels 56
! retex-render: error: m.pov:2:1: m.pov:1: image_map: told.exr: cannot read: its header is damaged or truncated
= 2
$ render_told two channels 56
! retex-render: error: m.pov:2:1: m.pov:1: image_map: told.exr: cannot read: its header is damaged or truncated
= 2
$ render_told one pixelAspectRatio 39
! retex-render: error: m.pov:2:1: m.pov:1: image_map: told.exr: cannot read: its header is damaged or truncated
= 2
