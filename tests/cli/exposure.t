# retex_exposure of a scene: pictures and sets have its light times 2^exposure, and so has what is made of them.
% scene() {
%     echo "global_settings { assumed_gamma 1 retex_exposure $1 }
%           camera { location <0, 1, -4> look_at <0, 0.5, 0> angle 60 }
%           light_source { <2, 4, -3>, 1 }
%           #declare Lamp = texture { pigment { rgb 1 } finish { emission 2 diffuse 0 } }
%           #declare Floor = texture { pigment { rgb 0.5 } finish { diffuse 0.8 } }
%           #declare Shiny = finish { diffuse 0.6 specular albedo 0.2 roughness 0.05 }
%           mesh { triangle { <-9, 0, -9>, <-9, 0, 9>, <9, 0, 0> } texture { Floor } }
%           sphere { <0, 0.6, 0>, 0.6 pigment { rgb <0.8, 0.2, 0.1> } finish { diffuse 0.8 } }
%           sphere { <-2, 1, 0>, 0.2 texture { Lamp } }
%           sky_sphere { pigment { rgb 0.3 } } fog { distance 40 color rgb 0.4 }" >e$1.pov
%     shift
% }
% both() {
%     for e in 0 -2; do scene $e && retex-render -q --size 64x48 --spp 8 e$e.pov "$@" -o e$e.exr; done
% }
$ both --plain
$ oiiotool e0.exr --mulc 0.25 -o expected.exr
$ retex-diff -q --fail-psnr 110 expected.exr e-2.exr
$ both -t Floor --lamp Lamp --finish Floor=original,Shiny
$ retex-combine -q e0.exr --texture Floor=#80c040 --light Lamp=3 --finish Floor=Shiny --exposure -2 -o expected.exr
$ retex-combine -q e-2.exr --texture Floor=#80c040 --light Lamp=3 --finish Floor=Shiny -o actual.exr
$ retex-diff -q --fail-psnr 110 expected.exr actual.exr
$ for e in 0 -2; do retex-render -q --size 64x48 --spp 8 --replace Floor=#80c040 e$e.pov --plain -o r$e.exr; done
$ oiiotool r0.exr --mulc 0.25 -o expected.exr
$ retex-diff -q --fail-psnr 110 expected.exr r-2.exr

# Pictures of several textures share their paths; light of a face on a matte surface is apart for each.
$ printf '%s\n' output,Floor vE-a.exr,#80c040 vE-b.exr,#c03030 >rows.csv
$ for e in 0 -2; do
+     sed "s/E/$e/" rows.csv >r.csv
+     sed "s/fog.*//" e$e.pov >clear.pov
+     retex-render -q --size 64x48 --spp 8 clear.pov --variants r.csv
+ done
$ for v in a b; do
+     oiiotool v0-$v.exr --mulc 0.25 -o expected.exr
+     retex-diff -q --fail-psnr 110 expected.exr v-2-$v.exr
+ done

# The set says so, and a pack of it does; light that was cut stays the same share.
$ retex-pack -q e-2.exr -o e.retex
$ retex-info e.retex | grep exposure
> exposure       -2 stops, of the scene
$ retex-info e0.exr | grep -c exposure
> 0
= 1
$ scene 31
$ retex-render -q e31.pov -o e.exr
! retex-render: error: e31.pov:1:50: retex_exposure 31: an exposure is -30 to 30 stops
= 2
