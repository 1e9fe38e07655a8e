# retex{ metallic_map roughness_map }: numbers of a finish that vary over a surface.
$ cat >head.inc <<'END'
+ #version 3.7;
+ global_settings { assumed_gamma 1 }
+ camera { location <.5, .5, -2> right x up y angle 30 look_at <.5, .5, 0> }
+ sky_sphere { pigment { gradient y color_map { [0 rgb .2] [.6 rgb 1] [1 rgb <1, .5, 2>] } } }
+ #declare M = mesh2 { vertex_vectors { 4, <0,0,0>, <1,0,0>, <1,1,0>, <0,1,0> }
+     uv_vectors { 4, <0,0>, <1,0>, <1,1>, <0,1> } face_indices { 2, <0,1,2>, <0,2,3> } }
+ END
$ cat >maps.pov <<'END'
+ #include "head.inc"
+ #declare Card = texture { pigment { rgb <.8,.3,.1> }
+     finish { retex { metallic .9 metallic_map { checker rgb 1 rgb 0 scale .5 } roughness .8
+     roughness_map { gradient x color_map { [0 rgb 0] [1 rgb 1] } } } } }
+ object { M texture { Card } }
+ object { M rotate 90 * x texture { Card } }
+ END

# At the middle of each quarter, and in the middle of the left and right half: .8 u, and .9 or 0.
$ retex-render -q --plain --spp 1 --size 2x2 --aov metallic,roughness maps.pov -o aov.exr
$ for p in roughness metallic; do
+     oiiotool -q aov.exr --subimage $p -o $p.exr
+     make_values $p.exr 0,0 1,0 0,1 1,1
+ done
> 0.185640618 0.185640618 0.185640618
> 0.614359319 0.614359319 0.614359319
> 0.185640618 0.185640618 0.185640618
> 0.614359319 0.614359319 0.614359319
> 0 0 0
> 0.899999976 0.899999976 0.899999976
> 0.899999976 0.899999976 0.899999976
> 0 0 0

# The map stays with the UV of an object that is moved and turned, and is the mesh's own in each copy.
$ cat >turned.pov <<'END'
+ #include "head.inc"
+ #declare Card = texture { pigment { rgb .5 }
+     finish { retex { roughness .8 roughness_map { gradient x color_map { [0 rgb 0] [1 rgb 1] } } } } }
+ object { M texture { Card } rotate 90 * z translate x }
+ END
$ retex-render -q --plain --spp 1 --size 2x2 --aov roughness turned.pov -o aov.exr
$ oiiotool -q aov.exr --subimage roughness -o roughness.exr
$ make_values roughness.exr 0,0 1,0 0,1 1,1
> 0.614359319 0.614359319 0.614359319
> 0.614359319 0.614359319 0.614359319
> 0.185640618 0.185640618 0.185640618
> 0.185640618 0.185640618 0.185640618

# A constant map is the number itself.
$ cat >constant.pov <<'END'
+ #include "head.inc"
+ #declare Card = texture { pigment { rgb <.8,.3,.1> }
+     finish { retex { metallic .8 metallic_map { rgb .5 } roughness 1 roughness_map { rgb .3 } } } }
+ object { M texture { Card } }
+ END
$ sed 's/retex {.*/retex { metallic .4 roughness .3 } } }/' constant.pov >number.pov
$ for s in constant number; do retex-render -q --plain --spp 4 --size 24x24 $s.pov -o $s.exr; done
$ retex-diff -q --fail-abs 1e-6 constant.exr number.exr

# So is one of transmission.
$ cat >constant.pov <<'END'
+ #include "head.inc"
+ #declare Card = texture { pigment { rgb <.8,.3,.1> }
+     finish { retex { transmission .8 transmission_map { rgb .5 } ior 1.3 roughness .4 } } }
+ object { M texture { Card } }
+ END
$ sed 's/retex {.*/retex { transmission .4 ior 1.3 roughness .4 } } }/' constant.pov >number.pov
$ for s in constant number; do retex-render -q --plain --spp 4 --size 24x24 $s.pov -o $s.exr; done
$ retex-diff -q --fail-abs 1e-6 constant.exr number.exr

# emission_map stands in for the pigment: what shines keeps its colour. A card that is lit by it tells the same light as
# by a lamp of that colour.
$ cat >glow.pov <<'END'
+ #include "head.inc"
+ object { M texture { pigment { rgb <0,1,0> }
+     finish { emission 4 retex { ior 1 emission_map { checker rgb <1,.5,.25> rgb 0 scale .5 } } } } }
+ END
$ sed -i '/^sky_sphere/d' head.inc
$ retex-render -q --plain --spp 1 --size 2x2 glow.pov -o glow.exr
$ make_values glow.exr 0,0 0,1
> 0 0 0
> 4 2 1
$ cat >lamp.pov <<'END'
+ #include "head.inc"
+ object { M rotate 90*x texture { pigment { rgb .8 } } }
+ object { M texture { pigment { rgb 0 } finish { emission 4 retex { ior 1 emission_map { rgb <1,.5,.25> } } } } }
+ END
$ sed 's/pigment { rgb 0 } finish.*/pigment { rgb <1,.5,.25> } finish { emission 4 diffuse 0 } } }/' lamp.pov >other.pov
$ sed -i 's/location <.5, .5, -2>/location <.5, 1.5, -2>/' head.inc
$ for s in lamp other; do retex-render -q --plain --spp 64 --size 24x24 $s.pov -o $s.exr; done
$ retex-diff -q --fail-psnr 45 lamp.exr other.exr

# A card that shines by a map takes a new texture, and keeps its own.
$ cat >card.pov <<'END'
+ #include "head.inc"
+ object { M rotate 90*x texture { pigment { rgb .8 } } }
+ #declare Card = texture { pigment { rgb .7 }
+     finish { emission 2 retex { emission_map { checker rgb <1,.5,.25> rgb .1 scale .25 } } } }
+ object { M texture { Card } }
+ END
$ retex-render -q --spp 64 --size 24x24 -t Card card.pov -o set.exr
$ retex-combine -q set.exr --texture 'Card=rgb(.1,.5,.9)' -o new.exr
$ retex-render -q --spp 64 --size 24x24 -t Card --replace 'Card=rgb(.1,.5,.9)' card.pov -o truth.exr
$ retex-diff -q --fail-psnr 65 new.exr truth.exr
$ retex-render -q --plain --spp 64 --size 24x24 -t Card card.pov -o plain.exr
$ retex-combine -q set.exr -o own.exr
$ retex-diff -q --fail-psnr 80 own.exr plain.exr
$ sed -i 's/^camera/sky_sphere { pigment { rgb 1 } }\n&/' head.inc

# A constant texture is exact: what a map makes of metallic and roughness is no matter of the target's colour.
$ retex-render -q --spp 64 --size 32x32 -t Card maps.pov -o set.exr
$ retex-combine -q set.exr --texture 'Card=rgb(.1,.5,.9)' -o new.exr
$ retex-render -q --spp 64 --size 32x32 -t Card --replace 'Card=rgb(.1,.5,.9)' maps.pov -o truth.exr
$ retex-diff -q --fail-psnr 65 new.exr truth.exr

# What is not a map.
$ cat >bad.pov <<'END'
+ #include "head.inc"
+ object { M texture { pigment { rgb 1 } finish { retex { roughness_map .5 } } } }
+ END
$ retex-render -q --plain bad.pov -o bad.exr
! retex-render: error: bad.pov:2:71: expected `{`, found `0.5`
= 2
