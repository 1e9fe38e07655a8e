# Folders of textures as they are downloaded: the base colour is the texture, to the bit, in every tool.
$ make_set s.exr 48 32
$ mkdir -p oak/textures Wood
$ cp "$SCENES/textures/brick.jpg" oak/textures/oak_diff_2k.jpg
$ cp "$SCENES/textures/fans.jpg" oak/textures/oak_diff_1k.jpg
$ cp oak/textures/oak_diff_1k.jpg Wood/Wood_2K-JPG_Color.jpg
$ touch oak/oak.blend oak/textures/oak_rough_2k.jpg oak/textures/oak_nor_gl_2k.jpg Wood/Wood_2K-JPG_Opacity.jpg
$ for f in oak oak/ ./oak//; do
+     retex-combine -q s.exr --texture:scale=2 floor=$f -o a.exr
+     retex-combine -q s.exr --texture:scale=2 floor=oak/textures/oak_diff_2k.jpg -o b.exr
+     cmp a.exr b.exr
+ done
! retex-combine: warning: oak: roughness and normal maps are not used
! retex-combine: warning: oak: roughness and normal maps are not used
! retex-combine: warning: ./oak: roughness and normal maps are not used
$ retex-combine -q s.exr --texture:scale=2 floor=Wood -o c.exr
! retex-combine: warning: Wood: the opacity map is not used
$ cmp -s a.exr c.exr || echo another
> another
$ retex-sample s.exr --texture floor=oak -o sa.exr 2>&1 | sed 's/, [0-9.]* s$//'
> retex-sample: warning: oak: roughness and normal maps are not used
> retex-sample: Floor <- oak: 48 x 32
$ retex-sample -q s.exr --texture floor=oak/textures/oak_diff_2k.jpg -o sb.exr
$ retex-diff -q sa.exr sb.exr --fail-abs 0
$ for s in sa sb; do retex-combine -q s.exr $s.exr -o $s.p.exr; done
$ cmp sa.p.exr sb.p.exr

# A table, in which each folder is told once; the manifest has the checksum of the file.
$ printf '%s\n' output,floor,Wall a.png,oak,Wood b.png,:scale=2\ oak,oak c.png,oak, >t.csv
$ sed 's#oak#oak/textures/oak_diff_2k.jpg#g; s#Wood#Wood/Wood_2K-JPG_Color.jpg#; s/\([abc]\).png/\1w.png/' t.csv >w.csv
$ retex-combine -q s.exr --batch t.csv --manifest m
! retex-combine: warning: oak: roughness and normal maps are not used; and 1 more warning, which -q hides
$ retex-combine -q s.exr --batch w.csv
$ for k in a b c; do cmp $k.png ${k}w.png; done
$ grep -c "oak $(/usr/bin/python3 -c 'import sys, zlib; print("%08x" % zlib.crc32(open(sys.argv[1], "rb").read()))' oak/textures/oak_diff_2k.jpg) " m
> 3
$ retex-combine s.exr --batch t.csv --manifest m --verify
> 3 of 3 pictures good
$ cp oak/textures/oak_diff_1k.jpg oak/textures/oak_diff_4k.jpg
$ retex-combine s.exr --batch t.csv --manifest m --verify
> a.png: stale: its row or an image of it has changed
> b.png: stale: its row or an image of it has changed
> c.png: stale: its row or an image of it has changed
> 0 of 3 pictures good; 3 stale
= 1
$ retex-combine -q s.exr --batch t.csv --manifest m --resume
! retex-combine: warning: oak: roughness and normal maps are not used; and 1 more warning, which -q hides
$ rm oak/textures/oak_diff_4k.jpg
$ for k in a b c; do cmp -s $k.png ${k}w.png || echo $k; done
> a
> b
> c

# However many slashes are behind its name, it is one image.
$ printf '%s\n' output,floor,Wall sa.png,oak/,Wood b.png,:scale=2\ ./oak//,./oak c.png,oak, >t2.csv
$ retex-combine -q s.exr --batch t2.csv --manifest m2
! retex-combine: warning: oak: roughness and normal maps are not used; and 2 more warnings, which -q hides
$ cmp sa.png aw.png
$ cmp b.png bw.png
$ cmp c.png cw.png
$ grep -c '/ ' m2
> 0
= 1

# Rendering again, and its table.
$ room="--size 32x24 --spp 2 $SCENES/cornell-box/cornell-box.pov"
+ retex-render -q $room --replace floor=Wood -o ra.exr
+ retex-render -q $room --replace floor=Wood/Wood_2K-JPG_Color.jpg -o rb.exr
+ cmp ra.exr rb.exr
+ printf 'output,floor\nrc.exr,Wood\n' >v.csv
+ retex-render -q $room --variants v.csv
! retex-render: warning: Wood: the opacity map is not used
! retex-render: warning: Wood: the opacity map is not used
$ cmp rc.exr rb.exr

# The picture must not replace the file that is read; others of the folder it may.
$ retex-combine -q s.exr --texture floor=oak -o oak/textures/oak_diff_2k.jpg
! retex-combine: error: oak/textures/oak_diff_2k.jpg: the output would replace the texture
= 2
$ retex-combine -q s.exr --texture floor=Wood -o oak/textures/oak_diff_1k.jpg
! retex-combine: warning: Wood: the opacity map is not used
$ printf 'output,floor\noak/textures/oak_diff_2k.jpg,oak\n' | retex-combine -q s.exr --batch -
! retex-combine: error: standard input:2: oak/textures/oak_diff_2k.jpg: the output of the table's line 2 would replace the texture
= 2

# Refused, before any work: no base colour, two of them, one that is none; tables name the line.
$ mkdir none maps two text
$ touch maps/oak_rough_2k.jpg maps/oak_arm_2k.jpg two/oak_col_1.png two/oak_col_2.png
$ echo text >text/color.png
$ for f in none maps two; do
+     retex-combine -q s.exr --texture floor=$f/ -o x.exr
+     retex-sample -q s.exr --texture floor=$f -o x.exr
+ done
! retex-combine: error: none: a folder without a base colour, such as wood_diff_2k.jpg or wood_Color.png; it has no files
! retex-sample: error: none: a folder without a base colour, such as wood_diff_2k.jpg or wood_Color.png; it has no files
! retex-combine: error: maps: a folder without a base colour, such as wood_diff_2k.jpg or wood_Color.png; it has roughness, metalness and ambient occlusion maps
! retex-sample: error: maps: a folder without a base colour, such as wood_diff_2k.jpg or wood_Color.png; it has roughness, metalness and ambient occlusion maps
! retex-combine: error: two: a folder with several base colours, such as oak_col_1.png and oak_col_2.png: name one of them
! retex-sample: error: two: a folder with several base colours, such as oak_col_1.png and oak_col_2.png: name one of them
= 2
$ retex-render -q none.pov --replace floor=two -o x.exr
! retex-render: error: two: a folder with several base colours, such as oak_col_1.png and oak_col_2.png: name one of them
= 2
$ retex-combine -q s.exr --texture floor=text -o x.exr 2>&1 | cut -c 1-39
> retex-combine: error: text/color.png: c
$ printf 'output,floor\nx.png,oak\ny.png,none\n' | retex-combine -q s.exr --batch -
! retex-combine: error: standard input:3: none: a folder without a base colour, such as wood_diff_2k.jpg or wood_Color.png; it has no files
= 2
$ ls x.* y.*
! ls: cannot access 'x.*': No such file or directory
! ls: cannot access 'y.*': No such file or directory
= 2

# Safe access reads them too, but not devices.
$ rm two/*
$ mkfifo two/color.png
$ retex-combine -q --safe s.exr --texture floor=two -o x.exr
! retex-combine: error: two: a folder without a base colour, such as wood_diff_2k.jpg or wood_Color.png; it has no files
= 2
$ ln -s /dev/zero maps/color.png
$ retex-combine -q --safe s.exr --texture floor=maps -o x.exr
! retex-combine: error: maps/color.png is a folder, a device or a pipe: only files are read (--safe)
= 2
$ retex-combine -q --safe s.exr --texture floor=oak -o x.exr
! retex-combine: warning: oak: roughness and normal maps are not used
