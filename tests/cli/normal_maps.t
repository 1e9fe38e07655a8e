# normal { retex_normal_map }: a normal map on a target that is glossy.
$ cat >maps.pov <<'END'
+ #version 3.7;
+ global_settings { assumed_gamma 1 }
+ camera { location <.5, 1.5, -2> right x up y angle 35 look_at <.5, .4, .2> }
+ sky_sphere { pigment { gradient y color_map { [0 rgb .2] [.6 rgb 1] [1 rgb <1, .5, 2>] } } }
+ light_source { <-2, 3, -3> rgb 1 }
+ #declare M = mesh2 { vertex_vectors { 4, <0,0,0>, <1,0,0>, <1,1,0>, <0,1,0> }
+     normal_vectors { 4, -z, -z, -z, -z } uv_vectors { 4, <0,0>, <1,0>, <1,1>, <0,1> }
+     face_indices { 2, <0,1,2>, <0,2,3> } }
+ #declare Bumps = normal { retex_normal_map { checker rgb <.8,.4,.85> rgb <.3,.6,.9> scale 1/8 } }
+ #declare Card = texture { pigment { checker rgb <.8,.3,.1> rgb <.9,.8,.7> scale .25 } normal { Bumps }
+     finish { retex { metallic .5 roughness .4 } } }
+ object { M texture { Card } }
+ object { M rotate 90*x texture { Card } }
+ object { M rotate -90*y translate <1,0,-.5> texture { pigment { rgb .6 } normal { Bumps } } }
+ END

# A set is the plain picture, and with a new texture the one that is rendered anew; threads make no difference.
$ retex-render -q --size 48x48 --spp 16 -t Card maps.pov -o set.exr
$ retex-combine -q set.exr -o own.exr
$ retex-render -q --size 48x48 --spp 16 --plain --threads 1 -t Card maps.pov -o plain.exr
$ retex-diff -q own.exr plain.exr --fail-psnr 80
$ retex-combine -q set.exr --texture 'Card=rgb(.2,.5,.8)' -o new.exr
$ retex-render -q --size 48x48 --spp 16 --plain --replace 'Card=rgb(.2,.5,.8)' -t Card maps.pov -o again.exr
$ retex-diff -q new.exr again.exr --fail-psnr 50
$ retex-render -q --size 48x48 --spp 2 --plain --threads 1 maps.pov -o 1.exr
$ retex-render -q --size 48x48 --spp 2 --plain --threads 7 maps.pov -o 7.exr
$ cmp 1.exr 7.exr

# Without the map the picture is another one.
$ sed 's/normal { Bumps }//' maps.pov >smooth.pov
$ retex-render -q --size 48x48 --spp 16 --plain smooth.pov -o smooth.exr
$ retex-diff -q smooth.exr plain.exr --fail-psnr 30
= 1

# A white furnace: a white card with bumps, in light that is the same everywhere, is not seen.
$ cat >furnace.pov <<'END'
+ #version 3.7;
+ global_settings { assumed_gamma 1 }
+ camera { location <.5, .5, -2> right x up y angle 20 look_at <.5, .5, 0> }
+ sky_sphere { pigment { rgb 1 } }
+ mesh2 { vertex_vectors { 4, <0,0,0>, <1,0,0>, <1,1,0>, <0,1,0> } uv_vectors { 4, <0,0>, <1,0>, <1,1>, <0,1> }
+     face_indices { 2, <0,1,2>, <0,2,3> } rotate 60*y translate .3*x pigment { rgb 1 } finish { diffuse 1 }
+     normal { retex_normal_map { checker rgb <.8,.4,.85> rgb <.3,.6,.9> scale 1/8 } } }
+ END
$ retex-render -q --size 8x8 --spp 256 --plain furnace.pov -o furnace.exr
$ make_values furnace.exr 4,4 | awk '{ print ($1 > .985 && $1 < 1.015) }'
> 1

# The same map by retex_normal_map and by normal=: in either order of corners, without normals of a mesh, and with such that
# point to the viewer or away.
$ oiiotool -q --pattern constant:color=.7,.6,.9 16x16 3 --fill:color=.35,.5,.9 16x8+0+0 -d uint8 -o bumps.png
$ oiiotool -q --pattern constant:color=.5,.5,.5 8x8 3 -d uint8 -o grey.png
$ cat >sides.pov <<'END'
+ #version 3.7;
+ global_settings { assumed_gamma 1 radiosity {} }
+ camera { location <0, 0, -3> look_at 0 angle 40 right x up y }
+ light_source { <3, 1.5, -3> rgb 1 }
+ #declare Card = texture { uv_mapping pigment { image_map { png "grey.png" } } finish { ambient 0 diffuse 1 }
+     #ifdef (Bumps) normal { retex_normal_map { image_map { png "bumps.png" gamma 1 interpolate 2 } } } #end }
+ mesh2 { vertex_vectors { 4, <-1,-1,0>, <1,-1,0>, <1,1,0>, <-1,1,0> }
+     #if (Side) normal_vectors { 4, Side*z, Side*z, Side*z, Side*z } #end
+     uv_vectors { 4, <0,0>, <1,0>, <1,1>, <0,1> } face_indices { 2, #if (Turned) <0,2,1>, <0,3,2> #else <0,1,2>, <0,2,3> #end }
+     texture { Card } }
+ END
$ for turned in 0 1; do for side in 0 -1 1; do
+     of="-q --size 48x48 --spp 4 --plain -t Card --finish Card=normals -D Turned=$turned -D Side=$side sides.pov"
+     retex-render $of -D Bumps=1 -o own-$turned$side.exr
+     retex-render $of --replace:normal=bumps.png Card=grey.png -o laid.exr
+     retex-diff -q own-$turned$side.exr laid.exr --fail-psnr 50 || echo $turned $side
+ done; done
$ retex-diff -q own-00.exr own-10.exr --fail-psnr 100
$ retex-diff -q own-00.exr own-01.exr --fail-psnr 20
= 1

# What is not a map.
$ echo 'sphere { 0, 1 normal { retex_normal_map .5 } }' >bad.pov
$ retex-render bad.pov -o x.exr
! retex-render: error: bad.pov:1:41: expected `{`, found `0.5`
= 2

# Heights: a step of .1 in the middle of a card, which is as wide as the picture, is a slope over one of its N pixels:
# N / 10.
$ cat >step.pov <<'END'
+ #version 3.7;
+ global_settings { assumed_gamma 1 }
+ camera { orthographic location <.5, .5, -2> right x up y look_at <.5, .5, 0> }
+ sky_sphere { pigment { rgb 1 } }
+ mesh2 { vertex_vectors { 4, <0,0,0>, <1,0,0>, <1,1,0>, <0,1,0> } uv_vectors { 4, <0,0>, <1,0>, <1,1>, <0,1> }
+     face_indices { 2, <0,1,2>, <0,2,3> } pigment { rgb 1 }
+     normal { retex_height_map { gradient x color_map { [0 rgb 0] [.5 rgb 0] [.5 rgb 1] [1 rgb 1] } } .1 } }
+ END
$ for n in 5 15 25; do
+     retex-render -q --size ${n}x$n --spp 1 --plain --aov normal step.pov -o step.exr
+     oiiotool -q step.exr --subimage normal -o step.exr
+     make_values step.exr $((n / 2)),1 | awk '{ printf "%.4f\n", $1 / $3 }'
+     make_values step.exr 1,1
+ done
> 0.5000
> 0 0 -1
> 1.5000
> 0 0 -1
> 2.5000
> 0 0 -1
$ printf '%s\n' 'plane { z, 0 normal { retex_height_map { rgb 1 } 1 strength 2 } }' >strong.pov
$ retex-render strong.pov -o x.exr
! retex-render: error: strong.pov:1:61: strength must lie between 0 and 1, not 2
= 2
