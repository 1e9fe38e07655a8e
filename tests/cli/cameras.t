# What cameras see: pixels of small pictures.
% # The pixels of NAME.pov: pixels NAME X,Y…
% pixels() {
%     name=$1
%     shift
%     retex-render -q --plain --size 8x8 --spp 256 $name.pov -o $name.exr
%     make_values $name.exr "$@" | awk '{ printf "%.2f\n", $1 }'
% }

# A fisheye has no rays beyond its circle.
$ cat >round.pov <<'END'
+ #version 3.7; global_settings { assumed_gamma 1 }
+ background { rgb 1 }
+ camera { fisheye right x up y angle 90 }
+ END
$ pixels round 0,0 4,4
> 0.00
> 1.00
! retex-render: round.pov: warning: no object in the scene

# Rays of a limited length go on as far as they like after a bounce: they see a bright plane that is further off.
$ cat >mesh.pov <<'END'
+ #version 3.7; global_settings { assumed_gamma 1 }
+ camera {
+     mesh_camera { 1 0 5
+         mesh {
+             #for (Y, 0, 7) #for (X, 0, 7) triangle { <X, -Y, -3>, <X, 1 - Y, -3>, <X + 1, -Y, -3> } #end #end
+         }
+     }
+ }
+ plane { z, 0 pigment { rgb 0.5 } finish { diffuse 1 } }
+ plane { z, -20 pigment { rgb 1 } finish { emission 1 diffuse 0 } }
+ END
$ pixels mesh 4,4
> 0.50

# Each sample of a pixel takes its own way through the lens: of a disc, 2.6 % and 58 % are beyond the edge.
$ cat >lens.pov <<'END'
+ #version 3.7; global_settings { assumed_gamma 1 }
+ camera { location -2*z direction z right x up y aperture 4 blur_samples 9 focal_point -z }
+ plane { z, 0
+     pigment { gradient x color_map { [0.5 rgb 0][0.5 rgb 1] } scale 20 translate -10*x }
+     finish { emission 1 diffuse 0 }
+ }
+ END
$ pixels lens 0,4 4,4 7,4
> 0.03
> 0.58
> 0.97

# A view that cannot be shown is an error that says how to render all the same.
$ cat >own.pov <<'END'
+ #version 3.7; camera { user_defined { location { function { 0 } } } }
+ light_source { <0, 0, -9> rgb 1 }
+ sphere { 4 * z, 1 pigment { rgb 1 } }
+ END
% render() { retex-render -q --size 8x6 --spp 1 own.pov -o own.exr "$@"; }
$ render
! retex-render: error: own.pov:1:24: `user_defined` is not supported yet; with --lenient, a perspective camera is used
= 2
$ render --strict
! retex-render: error: own.pov:1:24: `user_defined` is not supported yet
= 2
$ render --strict --lenient
! retex-render: error: own.pov:1:24: `user_defined` is not supported yet
= 2
$ render --lenient
! retex-render: own.pov:1: warning: `user_defined` is not supported yet: a perspective camera is used
