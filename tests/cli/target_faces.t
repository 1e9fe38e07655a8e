# Rooms as people find them: one image on all of one mesh. What is pointed at is compared with the same room in which
# it is an object of its own, with UV that are right by construction.
$ python3 "$TESTS/face_rooms.py"
$ cp "$SCENES/textures/fans.jpg" .
$ oiiotool --create 8x8 4 -o clear.png
% render() { retex-render -q --size 96x72 "$@"; }
% # FILE is as near to OTHER as DECIBELS say; else what is wrong is said: near DECIBELS FILE OTHER WHAT.
% near() { retex-diff -q --fail-psnr $1 $2 $3 || echo $room: $4; }
% # ROOM's target is retextured as that of the room which is right by construction: as_right ROOM TARGET OPTIONS.
% as_right() {
%     room=$1 target=$2 options=$3
%     render --spp 48 -t "A=$target" $room.pov -o $room.exr
%     render --spp 48 -t A=Right $room-right.pov -o right.exr
%     for s in $room right; do retex-combine -q $s.exr --texture$options A=fans.jpg -o $s-new.exr; done
%     near 60 $room-new.exr right-new.exr 'other than the right one'
%     render --spp 48 -t "A=$target" --replace$options A=fans.jpg $room.pov -o again.exr
%     near 42 $room-new.exr again.exr 'other than rendered again'
%     retex-combine -q $room.exr -o old.exr
%     render --spp 48 --plain $room.pov -o plain.exr
%     near 75 old.exr plain.exr 'the original is lost'
%     retex-combine -q $room.exr --texture A=clear.png -o old.exr
%     near 60 old.exr plain.exr 'the original is another below a clear texture'
% }
$ as_right room @48:66/flat :width=90cm
$ retex-info room.exr | grep -E '^  (idents|size|original) '
>   idents       #1/flat:1
>   size         1 x 1 scene units a unit of u and of v
$ as_right crate @32:44/object:uv=box :width=60cm
$ retex-info crate.exr | grep -E '^  idents '
>   idents       #2:uv=box
$ as_right pillar @52:42/object:uv=cylinder :width=60cm
# Without the projection, or with all that the image covers, it is another picture.
$ render --spp 8 -t A=@48:66/flat --replace A=fans.jpg room.pov -o flat.exr
$ for t in @48:66/flat:uv=model @48:66; do
+     render --spp 8 -t A=$t --replace A=fans.jpg room.pov -o other.exr
+     retex-diff -q --fail-psnr 30 flat.exr other.exr || echo $t
+ done
> @48:66/flat:uv=model
> @48:66
# Every pixel of a floor names it alike, at any size, so that it resumes a render; another target does not.
$ render --spp 4 -t A=@48:66/flat room.pov -o whole.exr
$ (ulimit -f 300; render --spp 4 -t A=@48:66/flat --threads 1 --resume room.pov -o resumed.exr)
! retex-render: error: cannot write resumed.exr.partial: File too large
= 2
$ render --spp 4 -t A=@48:66 --resume room.pov -o resumed.exr
! retex-render: error: resumed.exr.partial is of another render: other options, another scene or build
= 2
$ render --spp 4 -t A=@30:60/flat --resume room.pov -o resumed.exr
$ cmp whole.exr resumed.exr
$ retex-render -q --size 48x36 --spp 1 -t A=@40:33/flat room.pov -o small.exr
$ for s in whole small; do
+     retex-info $s.exr | awk '/^  idents/ { i = $2 } /^  share/ { print i, int(($2 + 5) / 10) }'
+ done
> #1/flat:1 4
> #1/flat:1 4
# A set tells its targets with their UV: --control renders them again.
$ render --spp 32 --control-data biased -t A=@32:44/object:uv=box crate.pov -o control.exr
$ render --spp 32 --control control.exr --replace A=fans.jpg crate.pov -o near.exr
$ render --spp 32 -t 'A=#2:uv=box' --replace A=fans.jpg crate.pov -o truth.exr
$ retex-diff -q --fail-psnr 38 near.exr truth.exr
# Finishes, the other layout and masks know the target as well.
% # Both rooms, rendered with the options; and whether their pictures with the texture and an edit are one.
% both() {
%     render --spp 8 -t A=@48:66/flat "$@" room.pov -o room.exr
%     render --spp 8 -t A=Right "$@" room-right.pov -o room-right.exr
% }
% same() {
%     for n in room room-right; do retex-combine -q $n.exr --texture A=fans.jpg "$@" -o $n-new.exr; done
%     retex-diff -q --fail-psnr 70 room-new.exr room-right-new.exr
% }
$ both --finish A=original,polished
$ same --finish A=polished
$ both --layout paper
$ same
$ render --spp 8 -t A=@48:66/flat --mattes m.exr room.pov -o b.exr
$ oiiotool m.exr --ch mask_A.R -o room-mask.exr
$ render --spp 8 -t A=Right --mattes m.exr room-right.pov -o b.exr
$ oiiotool m.exr --ch mask_A.R -o room-right-mask.exr
$ retex-diff --fail-abs 0 room-mask.exr room-right-mask.exr >/dev/null
# A table renders what --replace does.
$ printf 'output,A\na.exr,fans.jpg\n' >table.csv
$ render --spp 4 -t A=@48:66/flat --variants table.csv room.pov
$ render --spp 4 -t A=@48:66/flat --replace A=fans.jpg room.pov -o b.exr
$ retex-diff --fail-abs 0 a.exr b.exr >/dev/null
# Boards are a floor of many objects. They have one material with the wall behind; one is flat by itself.
$ for t in @20:60 @20:60/object @20:60/flat @20:60/level @60:60/level; do
+     render --spp 1 -t A=$t boards.pov -o b.exr
+     retex-info b.exr | awk '/^  idents/ { i = $2 } /^  share/ { print i, $2 }'
+ done
> #1/material 99.51%
> #4 7.64%
> #4/flat:4 7.64%
> #4/level:4 45.75%
> #6/level:4 45.75%
# A material that is made of another is that one; where all are of one, it is all of them.
$ cat >woods.pov <<'END'
+ #version 3.7; camera { orthographic location -5*z right 4*x up 4*y direction z }
+ light_source { -9*z rgb 1 }
+ #declare Wood = texture { pigment { rgb .5 } }
+ #declare Oak = texture { Wood }
+ box { <-2,-2,0>, <-1,2,1> texture { Oak } }
+ box { <-1,-2,0>, <0,2,1> texture { Oak } }
+ box { <0,-2,0>, <2,2,1> texture { Wood } }
+ END
$ for x in 1 7; do
+     retex-render -q --size 8x8 --spp 1 -t A=@$x:4 woods.pov -o b.exr
+     retex-info b.exr | awk '/^  idents/ { i = $2 } /^  share/ { print i, $2 }'
+ done
> #1/material 50.00%
> #3/material 100.00%
# What a target's UV are is told where the model's are not taken, and nobody said so.
$ retex-render --size 8x6 --spp 1 -t A=@4:5/flat -t B=@4:1/level:uv=box -t 'C=#1' room.pov -o b.exr 2>&1 | grep UV
> retex-render: target `A` is faces: a planar projection gives it UV; `:uv=` after it chooses another one
# What cannot be.
$ printf 'camera { location -5*z } light_source { -9 rgb 1 } sphere { 0, 1 pigment { rgb 1 } finish { emission 1 } }' \
+     >ball.pov
$ for o in '-t A=@4:3/flat' '-t A=#1/level:1' '-t A=#1:uv=round' '-t A=#1:uv=' '-t A:uv=box' '-t A=#1:uv=box,#1' \
+     '-l A=@4:3/flat' '-l A=@4:3/wall'; do
+     retex-render -q --size 8x6 --spp 1 $o ball.pov -o b.exr
+ done
! retex-render: error: target `#1/flat:1`: a sphere has no flat faces; of meshes, boxes, planes and discs faces can be targets: #1, or @X:Y/object, takes all of it
! retex-render: error: target `#1/level:1`: a sphere has no flat faces; of meshes, boxes, planes and discs faces can be targets: #1, or @X:Y/object, takes all of it
! retex-render: error: target `A`: uv=round is none of planar, box, cylinder and model
! retex-render: error: target `A`: uv= is none of planar, box, cylinder and model
! retex-render: error: no target `A`: the scene uses no declared texture or object
! retex-render: error: target `#1:uv=box`: expected #N, an object's number, or #N.K, one of its textures; or #N/material, #N/flat:FACE, #N/level:FACE
! retex-render: error: lamp `#1/flat:1`: a lamp is a whole object or material, not some of its faces
! retex-render: error: target `@4:3/wall`: expected @X:Y, a pixel of the picture, or @X:Y:Z, a point of the scene; or after either /material, /object, /flat or /level
= 2
# The list has what each form takes, and tells an atlas and baked light.
$ for s in room boards; do
+     echo $s:
+     retex-render -q -v --list-targets --size 96x72 $s.pov 2>/dev/null | awk '$2 ~ "/" || /;/ || NR == 1'
+ done
> room:
> 100.00%  Atlas
> 100.00%  #1          mesh       room.pov:5; one image serves faces of 2 directions: @X:Y/flat or /level takes fewer
>  50.52%  #1/flat:9   flat       room.pov:5
>  40.26%  #1/flat:1   flat       room.pov:5
>   6.79%  #1/flat:19  flat       room.pov:5
>   1.45%  #1/flat:27  flat       room.pov:5
> boards:
>  99.51%  #1/material        material   boards.pov:6
>  45.75%  #4/level:4         level      boards.pov:9
>   2.30%  #11/flat:5         flat       boards.pov:16
>   1.22%  #11/flat:4         flat       boards.pov:16
$ cat >baked.pov <<'END'
+ #version 3.7; camera { orthographic location -5*z right 4*x up 4*y direction z }
+ #declare Baked = texture { pigment { image_map { ppm "atlas.ppm" } } finish { emission 1 diffuse 0 } }
+ box { -1, 1 texture { Baked } }
+ disc { <1.5,0,0>, z, .3 texture { Baked } }
+ END
$ retex-render -q -v --list-targets=sheet.exr --size 40x40 baked.pov 2>/dev/null
>  27.00%  Baked
>  27.00%  #1/material  material   Baked; it only shines, light is baked into its image: so would a new texture
>  27.00%  *atlas.ppm   image      baked.pov:3
>  25.00%  #1           box        baked.pov:3
>   2.00%  #2           disc       baked.pov:4
$ oiiotool --dumpdata sheet.exr |
+     awk '/Pixel/ && $4 != $5 && !colours[$4, $5, $6]++ { print sprintf("%.2f %.2f", $4 / $5, $6 / $5) }' | sort |
+     uniq -c | awk '{ print $1, "shades of one hue" }'
> 2 shades of one hue
