# The plugins in Python: ImageInput, ImageBuf, and several threads at once.
$ skip-unless /usr/bin/python3 -c 'import OpenImageIO, numpy'
$ make_set s.exr footprints
$ retex-pack -q s.exr -o room.retex
! retex-pack: warning: the set cannot be made compact and takes more room: its footprints are of another form than those of layout footprints
$ cp "$SCENES/textures/brick.jpg" .
$ cp -r "$SCENES/cornell-box/." .
$ mv cornell-box.pov box.pov
$ cp "$TESTS/pictures.py" .
% pictures() { /usr/bin/python3 pictures.py "$@"; }
$ pictures open room.retex
> 48x32, 48 subimages
$ pictures open 'room.retex?Floor=brick.jpg'
> 48x32, 1 subimages
$ retex-combine -q room.retex --texture:scale=2 Floor=brick.jpg -o x.pfm
$ pictures same 'room.retex?Floor=brick.jpg&Floor.scale=2' x.pfm
> same
$ retex-combine -q room.retex -o x.pfm
$ pictures same room.retex x.pfm
> same
$ retex-combine -q room.retex -o x.pfm
$ pictures same 'room.retex?Floor=brick.jpg' x.pfm | sed 's/[0-9.]*$/N/'
> they differ by up to N
$ retex-render -q --plain --spp 2 --size 32x24 box.pov -o x.pfm
$ pictures same 'box.pov?spp=2&size=32x24' x.pfm
> same
$ pictures buffer room.retex
> 48x32, 48 subimages
$ pictures buffer 'room.retex?Wall=rgb(1,0,0)'
> 48x32, 1 subimages
$ pictures buffer 'box.pov?spp=1&size=16x12'
> 16x12, 1 subimages

# What cannot be opened.
$ pictures open 'room.retex?Wal=rgb(1,0,0)'
> cannot read: no target is called 'Wal'; the set has Floor, Wall; is Wall meant?
$ pictures open none.retex
> cannot open: cannot read none.retex: No such file or directory
$ head -c 9000 room.retex >cut.retex
$ pictures open cut.retex
> cannot open: cut.retex: the pack is damaged or truncated: its directory is missing
$ head -c 9000 brick.jpg >cut.jpg
$ pictures open 'room.retex?Wall=cut.jpg'
> cannot read: cut.jpg: cannot read: the file is truncated (--accept-damaged reads it)

# Several threads at once.
$ pictures threads room.retex 'room.retex?Floor=brick.jpg' \
+     'room.retex?Floor=brick.jpg&Wall=room.retex' 'box.pov?spp=1&size=16x12' 'box.pov?spp=1&size=16x12&targets=Floor'
> 5 of 5

# However often it is opened, it is rendered once; oiiotool opens it many times.
$ RETEX_OIIO_DEBUG=1 pictures renders 'box.pov?spp=1&size=16x12&targets=Floor'
> 1 of 1, renders: 1
$ RETEX_OIIO_DEBUG=1 pictures renders 'box.pov?spp=1&size=16x12'
> 1 of 1, renders: 1
$ RETEX_OIIO_DEBUG=1 oiiotool 'box.pov?spp=1&size=16x12&targets=Floor' --dup --add -o x.exr \
+     --echo "{TOP.'retex:renders'}"
> 1

# Names that differ in an option are pictures of their own, in one process too.
$ for o in 'Floor=rgb(1,0,0) Floor=rgb(0,1,0)' 'Floor=brick.jpg Floor=brick.jpg&Floor.scale=2'; do
+     set -- $o
+     pictures same "room.retex?$1" "room.retex?$2" | grep -cx same
+ done
> 0
> 0
= 1
$ for o in 'spp=1 spp=2' 'spp=1 spp=1&seed=3' 'spp=1 spp=1'; do
+     set -- $o
+     pictures same "box.pov?size=16x12&$1" "box.pov?size=16x12&$2" | grep -cx same
+ done
> 0
> 0
> 1

# What changes on disk is made again, and only then.
$ cp brick.jpg t.jpg
$ pictures changes 'room.retex?Floor=t.jpg' "$SCENES/textures/fans.jpg" t.jpg
> yes
$ pictures changes 'room.retex?Floor=t.jpg' brick.jpg u.jpg
> no
$ make_set s2.exr 48 32 2 footprints
$ retex-pack -q s2.exr -o other.retex
! retex-pack: warning: the set cannot be made compact and takes more room: its footprints are of another form than those of layout footprints
$ pictures changes room.retex other.retex room.retex
> yes
$ cat >c.pov <<'END'
+ camera { location -3*z }
+ light_source { -9*z rgb 1 }
+ sphere { 0, 1 pigment { rgb 1 } }
+ END
$ cp c.pov d.pov
$ echo 'background { rgb 1 }' >>d.pov
$ pictures changes 'c.pov?spp=1&size=8x6' d.pov c.pov
> yes
