# Pictures of every format are read as they were by a build that did not look for damage, and damaged ones are refused
# where their format lets anybody know. shares.txt has how many of each, and why. No library prints anything itself.
$ /usr/bin/python3 "$TESTS/pictures.py" whole | grep -v '^# '
> read
$ /usr/bin/python3 "$TESTS/pictures.py" pixels
> refused
$ /usr/bin/python3 "$TESTS/pictures.py" damaged 2 1; wc -l <shares.txt
> jpeg True True
> 23
$ /usr/bin/python3 "$TESTS/pictures.py" accepted 1 2

# A JPEG that is cut in half with one byte too many, and one with zeros in its coded data: refused by name, or read with a
# warning.
$ cp whole/jpeg-baseline.jpg full.jpg; { head -c 1800 full.jpg; printf 'x\377\331'; } >cut.jpg; cp full.jpg zeros.jpg; dd if=/dev/zero of=zeros.jpg bs=1 seek=1500 count=40 conv=notrunc 2>/dev/null; make_set s.exr 48 32
$ for f in full cut zeros; do retex-combine -q s.exr --texture Floor=$f.jpg -o $f.exr; echo $f $?; done; ls cut.exr zeros.exr 2>/dev/null
> full 0
> cut 2
> zeros 2
! retex-combine: error: cut.jpg: cannot read: the file is damaged: Corrupt JPEG data: premature end of data segment (--accept-damaged reads it)
! retex-combine: error: zeros.jpg: cannot read: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9 (--accept-damaged reads it)
= 2
$ retex-combine -q --accept-damaged s.exr --texture Floor=zeros.jpg -o zeros.exr; RETEX_ACCEPT_DAMAGED=1 retex-combine -q s.exr --texture Floor=cut.jpg -o cut.exr; RETEX_ACCEPT_DAMAGED=0 retex-combine -q s.exr --texture Floor=cut.jpg -o no.exr; retex-diff -q full.exr zeros.exr >/dev/null; ls *.exr
> cut.exr
> full.exr
> s.exr
> zeros.exr
! retex-combine: warning: zeros.jpg: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9; it is read as far as possible
! retex-combine: warning: cut.jpg: the file is damaged: Corrupt JPEG data: premature end of data segment; it is read as far as possible
! retex-combine: error: cut.jpg: cannot read: the file is damaged: Corrupt JPEG data: premature end of data segment (--accept-damaged reads it)
$ retex-combine -q --safe s.exr --texture Floor=zeros.jpg -o no.exr; retex-combine -q --safe --accept-damaged s.exr --texture Floor=zeros.jpg -o zeros2.exr; cmp zeros.exr zeros2.exr
! retex-combine: error: zeros.jpg: cannot read: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9 (--accept-damaged reads it)
! retex-combine: warning: zeros.jpg: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9; it is read as far as possible
$ printf 'output,Floor\na.png,full.jpg\nb.png,zeros.jpg\n' >t.csv; retex-combine -q s.exr --batch t.csv --keep-going; ls *.png
> a.png
! retex-combine: error: t.csv:3: zeros.jpg: cannot read: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9 (--accept-damaged reads it)
! retex-combine: error: 1 of 2 pictures failed
$ retex-sample -q s.exr --texture Floor=zeros.jpg -o no.exr; retex-diff -q full.jpg zeros.jpg; retex-diff -q --accept-damaged full.jpg zeros.jpg | head -1
! retex-sample: error: zeros.jpg: cannot read: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9 (--accept-damaged reads it)
! retex-diff: error: zeros.jpg: cannot read: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9 (--accept-damaged reads it)
! retex-diff: warning: zeros.jpg: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9; it is read as far as possible

# In scenes: textures, bumps, heights, and numbers of palettes.
$ scene() { echo "camera { location -3*z look_at 0 } light_source { -9*z, 1 } $1"; }; for p in 'box { -1, 1 pigment { image_map { jpeg "zeros.jpg" } } }' 'box { -1, 1 normal { bump_map { jpeg "zeros.jpg" } } }' 'height_field { jpeg "zeros.jpg" }' 'box { -1, 1 texture { material_map { jpeg "zeros.jpg" texture { pigment { rgb 1 } } } } }'; do scene "$p" >m.pov; retex-render -q --size 8x6 --spp 1 m.pov -o no.exr; retex-render -q --size 8x6 --spp 1 --accept-damaged m.pov -o m.exr; done; ls no.exr 2>/dev/null
! retex-render: error: m.pov:2:1: m.pov:1: image_map: zeros.jpg: cannot read: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9 (--accept-damaged reads it)
! retex-render: m.pov:1: warning: image_map: zeros.jpg: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9; it is read as far as possible
! retex-render: error: m.pov:2:1: bump_map: zeros.jpg: cannot read: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9 (--accept-damaged reads it)
! retex-render: m.pov:2: warning: zeros.jpg: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9; it is read as far as possible
! retex-render: error: m.pov:1:81: height_field: zeros.jpg: cannot read: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9 (--accept-damaged reads it)
! retex-render: m.pov:1: warning: zeros.jpg: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9; it is read as far as possible
! retex-render: error: m.pov:1:145: material_map: zeros.jpg: cannot read: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9 (--accept-damaged reads it)
! retex-render: m.pov:1: warning: zeros.jpg: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9; it is read as far as possible
= 2
$ export PYTHONPATH=$TESTS/../lib; /usr/bin/python3 -Bc "import make_pictures as m; open('p.png', 'wb').write(m.png(3, 8, damage=True)); open('q.png', 'wb').write(m.png(2, 8, True, damage=True))"; head -c 700 whole/gif.gif >p.gif; for f in png:p.png gif:p.gif; do echo "camera { location -3*z look_at 0 } height_field { ${f%:*} \"${f#*:}\" }" >m.pov; retex-render -q --size 8x6 --spp 1 m.pov -o no.exr; done; retex-combine -q s.exr --texture Floor=q.png -o no.exr; retex-combine -q s.exr --texture Floor=p.png -o no.exr; ls no.exr 2>/dev/null
! retex-render: error: m.pov:1:55: `p.png`: IDAT: incorrect data check
! retex-render: error: m.pov:1:55: `p.gif`: it has no picture, or ends early
! retex-combine: error: q.png: cannot read: the file is damaged: IDAT: incorrect data check
! retex-combine: error: p.png: cannot read: the file is damaged: IDAT: incorrect data check
= 2

# A model's picture.
$ printf 'newmtl m\nmap_Kd zeros.jpg\n' >m.mtl; printf 'mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n' >m.obj; retex-import -q m.obj -o i 2>&1 | grep zeros; retex-import -q --accept-damaged m.obj -o j 2>&1 | grep zeros | sed 's|/.*/||'; ls j/textures
> retex-import: warning: the image `zeros.jpg` cannot be read: cannot read: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9 (--accept-damaged reads it)
> retex-import: warning: zeros.jpg: the file is damaged: Corrupt JPEG data: 34 extraneous bytes before marker 0xd9; it is read as far as possible
> Zeros.jpg

# What is written has the format that the ending of its name says, or is refused.
$ /usr/bin/python3 "$TESTS/pictures.py" endings
> written
