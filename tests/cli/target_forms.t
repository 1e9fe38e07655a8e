# The forms that a target that is pointed at can have, which of them are refused, and how --list-targets offers them.
$ python3 "$TESTS/face_rooms.py"
% render() { retex-render -q --size 96x72 "$@"; }
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
% ball() { retex-render -q --size 8x6 --spp 1 "$@" ball.pov -o b.exr; }
$ ball -t A=@4:3/flat
! retex-render: error: target `#1/flat:1`: a sphere has no flat faces; of meshes, boxes, planes and discs faces can be targets: #1, or @X:Y/object, takes all of it
= 2
$ ball -t A=#1/level:1
! retex-render: error: target `#1/level:1`: a sphere has no flat faces; of meshes, boxes, planes and discs faces can be targets: #1, or @X:Y/object, takes all of it
= 2
$ ball -t A=#1:uv=round
! retex-render: error: target `A`: uv=round is none of planar, box, cylinder and model
= 2
$ ball -t A=#1:uv=
! retex-render: error: target `A`: uv= is none of planar, box, cylinder and model
= 2
$ ball -t A:uv=box
! retex-render: error: no target `A`: the scene uses no declared texture or object
= 2
$ ball -t A=#1:uv=box,#1
! retex-render: error: target `#1:uv=box`: expected #N, an object's number, or #N.K, one of its textures; or #N/material, #N/flat:FACE, #N/level:FACE
= 2
$ ball -l A=@4:3/flat
! retex-render: error: lamp `#1/flat:1`: a lamp is a whole object or material, not some of its faces
= 2
$ ball -l A=@4:3/wall
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
# In the sheet the surfaces of a line have shades of one hue.
$ /usr/bin/python3 "$TESTS/sheet_hues.py" sheet.exr
> 2 shades of one hue
