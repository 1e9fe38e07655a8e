# retex-try: from a model to a page, by the other tools, and nothing left where that fails.
% room() { # scale of the floor
%     printf 'v %s\n' '0 0 0' '4 0 0' '4 0 4' '0 0 4' '0 3 4' '4 3 4' "$@"
%     printf 'vt %s\n' '0 0' '4 0' '4 4' '0 4'
% }
% try() { retex-try --camera 2,1.5,3:2,1,-4 --size 96x72 --spp 4 "$@"; }
% left() { ls -A | grep -e '\.......$' -e '^none' || true; } # temporary folders
$ cp "$SCENES/textures/brick.jpg" "a floor.jpg" && cp "$SCENES/living-room/textures/oak-planks.jpg" oak.jpg
$ { room; printf 'usemtl Floor\nf 4/1 3/2 2/3 1/4\nusemtl Wall\nf 4/1 5/4 6/3 3/2\n'; } >"it's a room.obj"
$ { room; printf 'o Plate\nusemtl Plate\nf 3/2 4/1 1/4 2/3\n'; } >"plate.obj"

# The commands that it prints make the same page from the same files, by themselves.
$ try "it's a room.obj" "a floor.jpg" oak.jpg -o page/ >road.sh 2>said
$ grep -v '^ ' road.sh
> # 1 of 5: A scene of the model, with a view and light.
> retex-import --camera=2,1.5,3:2,1,-4 -o room -- 'it'\''s a room.obj'
>
> # 2 of 5: What can get another texture.
> retex-render --list-targets -- room/room.pov
>
> # 3 of 5: A set: the light of the room, which is the same for all textures.
> retex-render -t Floor -t Wall --size=96x72 --spp=4 --denoise -o room.exr -- room/room.pov
>
> # 4 of 5: A picture with the new textures, and a preset, which says how they lie.
> retex-combine --texture:width=1m 'Floor=a floor.jpg' --texture:width=1m Wall=oak.jpg --save-preset=look.json -o room.jpg -- room.exr
>
> # 5 of 5: A web page, in which visitors choose others.
> retex-pack --preset=look.json --web page -- room.exr
$ ls page/index.html && mkdir again && cp *.obj *.jpg again && (cd again && sh -e ../road.sh >list 2>../said) && diff -r page again/page
> page/index.html
$ grep -c Floor again/list
> 1
$ sed -n 's/.*"edit": //p' page/look.json | grep -o -e 'Floor=[a-z_/]*' -e 'Wall=[a-z_/]*' -e '[FW][a-z]*.width=[0-9a-z]*'
> Floor=textures/a_floor
> Floor.width=1m
> Wall=textures/oak
> Wall.width=1m
$ left

# Without a picture for the wall, it is a target all the same; --keep keeps what led to the page.
$ try -q "it's a room.obj" tan -o page -f --keep made --width 60cm && ls made
> look.json
> room
> room.exr
> room.jpg
$ retex-info made/room.exr --json | grep -o '"name":"[FW][a-z]*"' | sort -u
> "name":"Floor"
> "name":"Wall"
$ grep -o 'Floor[=.][a-z0-9=]*' page/look.json
> Floor=rgb
> Floor.width=0
$ ls page/textures 2>/dev/null
= 2

# Size and samples are by the time: less of it, fewer samples, at the least size and number of them.
$ for time in 900 1; do
+     try -o none --time $time plate.obj oak.jpg -t Floor=Plate --size 96x72 --spp 2 -q && rm -r none
+     retex-try --camera 2,3,1:2,0,-2 plate.obj oak.jpg -t Floor=Plate -o none --size 64x48 --time $time 2>/dev/null |
+         sed -n 's/.*--size=\([0-9x]*\) --spp=\([0-9]*\) --denoise.*/\1 \2/p' | awk '{ print $1, $2 < 256 ? "fewer" : $2 }'
+     rm -r none
+ done
> 64x48 256
> 64x48 fewer
$ retex-try --camera 2,3,1:2,0,-2 plate.obj oak.jpg -t Floor=Plate -o none --spp 2 --time 1 2>/dev/null |
+     sed -n 's/.*--size=\([0-9x]*\) --spp=\([0-9]*\) --denoise.*/\1 \2/p'
> 640x480 2
$ rm -r none

# What cannot be, is told before anything is made.
$ try none.obj oak.jpg -o none
! retex-try: error: cannot read none.obj: No such file or directory
= 2
$ try plate.obj none.jpg -o none
! retex-try: error: cannot read none.jpg: No such file or directory
= 2
$ try plate.obj road.sh -o none
! retex-try: error: road.sh: cannot read: OpenImageIO could not find a format reader for "road.sh". Is it a file format that OpenImageIO doesn't know about?
= 2
$ try plate.obj -o none
! retex-try: error: no picture of a floor given; try --help
= 2
$ try plate.obj oak.jpg
! retex-try: error: no output: give a folder to make, -o page
= 2
$ try plate.obj oak.jpg -o page
! retex-try: error: page exists; --force writes into it
= 2
$ try plate.obj oak.jpg -o none --keep made
! retex-try: error: made exists
= 2
$ try plate.obj oak.jpg -o ..
! retex-try: error: -o ..: expected the name of a folder to make
= 2
$ try plate.obj oak.jpg -o none/page
! retex-try: error: cannot make the folder none/page: No such file or directory
= 2
$ try plate.obj oak.jpg -o none --width wide
! retex-try: error: --width: expected a length such as 60cm, 2ft or 1.2, which are metres, not 'wide'
= 2
$ try plate.obj oak.jpg -o none --size 5
! retex-try: error: --size: expected WxH, 16x16 to 16384x16384, not '5'
= 2

# A command that fails ends it, with what that has said.
$ try -q road.sh oak.jpg -o none 2>said
= 2
$ sed "s|$PWD/||" said
> retex-import: error: road.sh: Validation failed: aiScene::mNumMeshes is 0. At least one mesh must be there
$ try -q plate.obj oak.jpg -o none
! retex-try: error: no floor is seen: choose another view, --camera inside or X,Y,Z:X,Y,Z, or say what the floor is, -t Floor=NAME; seen are Mesh_Plate, Plate
= 2
$ try -q plate.obj oak.jpg oak.jpg -o none -t Floor=Plate
! retex-try: error: no wall is seen: leave out oak.jpg, choose another view, --camera inside or X,Y,Z:X,Y,Z, or say what the wall is, -t Wall=NAME; seen are Mesh_Plate, Plate
= 2
$ mkdir bin && cp "$(command -v retex-try)" bin && bin/retex-try -q plate.obj oak.jpg -o none
! retex-try: error: there is no retex-import beside retex-try
= 2
$ left

# Where the first view shows no floor, the next one that does is taken.
$ for tool in render combine pack; do ln -s "$(command -v retex-$tool)" bin; done; ln -s "$(dirname "$(command -v retex)")/../lib" lib
$ cat >bin/retex-import <<'END'
+ #!/bin/sh
+ mkdir room
+ cat >room/room.pov <<'SCENE'
+ #declare View_2 = camera { location y look_at y + z angle 10 }
+ #declare View_3 = camera { location y look_at z }
+ camera { location y look_at 2 * y }
+ light_source { 9 * y 1 }
+ #declare Floor = texture { pigment { color rgb .5 } }
+ plane { y, 0 texture { Floor } clipped_by { box { -9, 9 } } }
+ SCENE
+ END
$ chmod +x bin/retex-import && bin/retex-try plate.obj tan -o none --size 32x24 --spp 2 2>/dev/null | grep -e '^# ' -e ' -t '
> # 1 of 5: A scene of the model, with a view and light.
> # 2 of 5: What can get another texture.
> # 3 of 6: What can get another texture.
> # 4 of 7: What can get another texture.
> # 5 of 7: A set: the light of the room, which is the same for all textures.
> retex-render -t Floor --camera=View_3 --size=32x24 --spp=2 --denoise -o room.exr -- room/room.pov
> # 6 of 7: A picture with the new textures, and a preset, which says how they lie.
> # 7 of 7: A web page, in which visitors choose others.
$ rm -r none

# Ended by a signal it leaves nothing, and says so once; in a folder that is there, the old room stays.
$ cat >end <<'END'
+ signal=$1
+ shift
+ env --default-signal=INT,TERM,HUP "$@" >none.log &
+ tool=$!
+ until grep -q "$AFTER" none.log 2>/dev/null || ! kill -0 $tool 2>/dev/null; do sleep 0.05; done
+ sleep ${LATER-0.3}
+ kill -$signal $tool
+ wait $tool 2>/dev/null
+ echo $?
+ rm none.log
+ END
$ cp -r page before && for s in INT TERM; do
+     AFTER=denoise sh end $s retex-try plate.obj oak.jpg --camera 2,3,1:2,0,-2 -t Floor=Plate -o none --size 640x480 --spp 60000 2>said
+     grep -v -e '^retex-import' -e '^retex-render: 640' said
+ done
> 130
> retex-try: error: ended by SIGINT
> 143
> retex-try: error: ended by SIGTERM
$ left
$ AFTER=retex-pack LATER=0.05 sh end TERM retex-try plate.obj oak.jpg --camera 2,3,1:2,0,-2 -t Floor=Plate -o page -f --size 640x480 --spp 2 2>said
> 143
$ grep try said
> retex-try: error: ended by SIGTERM
$ left && cmp page/room.json before/room.json
