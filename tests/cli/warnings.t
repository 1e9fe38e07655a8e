# What a scene warns of is printed with -q too; what it only tells, with -v alone.
% head='#version 3.7; global_settings { assumed_gamma 1 } camera { location -4*z look_at 0 }'
% lamp='light_source { -9*z rgb 1 }'
% ball='sphere { 0, 1 pigment { rgb 1 } }'
% # Render NAME.pov of the lines, with the options in $options: try NAME LINE…
% try() {
%     name=$1
%     shift
%     printf '%s\n' "$@" >$name.pov
%     retex-render -q --size 8x6 --spp 1 $name.pov -o $name.exr $options
% }
$ cat >w.pov <<'END'
+ camera { location -4*z }
+ light_source { -9*z rgb 1 }
+ #warning "mind the step"
+ #debug "here\n"
+ #declare A = 1/0;
+ sphere { 0, 1 scale <1,0,1> pigment { rgb 1 } }
+ END
$ for q in -q '' -v -qv; do retex-render $q --size 8x6 --spp 1 w.pov -o w.exr 2>&1 | grep -v Mpaths; done
> retex-render: w.pov:3: warning: mind the step
> retex-render: w.pov:5: warning: division by zero
> retex-render: w.pov:6: warning: scale by 0 is taken as scale by 1
> retex-render: w.pov:3: warning: mind the step
> retex-render: w.pov:5: warning: division by zero
> retex-render: w.pov:6: warning: scale by 0 is taken as scale by 1
> retex-render: w.pov:3: warning: mind the step
> retex-render: here
> retex-render: w.pov:5: warning: division by zero
> retex-render: w.pov:6: warning: scale by 0 is taken as scale by 1
> retex-render: w.pov:3: warning: mind the step
> retex-render: here
> retex-render: w.pov:5: warning: division by zero
> retex-render: w.pov:6: warning: scale by 0 is taken as scale by 1

# A scene in which nothing gives light.
$ try dark "$head" "$ball"
! retex-render: dark.pov: warning: no light source, nothing that shines and no sky: the picture will be black; weak `ambient`, or ambient beside radiosity, gives light with --ambient only
$ options=--plain try dark2 "$head" 'sphere { 0, 1 pigment { rgb 1 } finish { ambient 0 } }'
! retex-render: dark2.pov: warning: no light source, nothing that shines and no sky: the picture will be black
$ options=--plain try inner \
+     "$head" 'sphere { 0, 1 texture { pigment { rgb 1 } } interior_texture { pigment { rgb 1 } finish { emission 1 } } }'
$ try black "$head" 'light_source { -9*z rgb 0 }' "$ball"
! retex-render: black.pov: warning: its light sources are black, nothing shines and there is no sky: the picture will be black; weak `ambient`, or ambient beside radiosity, gives light with --ambient only
$ try empty "$head" "$lamp"
! retex-render: empty.pov: warning: no object and no sky: the picture will be black
$ try sky "$head" 'sky_sphere { pigment { rgb 0 } }' "$ball"
! retex-render: sky.pov: warning: no light source, nothing that shines and no sky: the picture will be black; weak `ambient`, or ambient beside radiosity, gives light with --ambient only
$ options=--ambient try ambient "$head" 'sphere { 0, 1 pigment { rgb 1 } finish { ambient 0 } }'
! retex-render: ambient.pov: warning: no light source, nothing that shines and no sky: the picture will be black
$ retex-render -q --size 8x6 --spp 1 --trace-pixel 4,3,0 dark.pov 2>&1 >trace | wc -l
> 1

# And some in which something does: a light, what shines, on either side and on one face of a mesh; the sky, all of it
# or a part, the background; ambient, where that is a lamp or asked for.
$ try a "$head" "$lamp" "$ball"
$ try b "$head" 'sphere { 0, 1 pigment { rgb 1 } finish { emission 0.1 } }'
$ try c "$head" "$ball" 'sphere { 0, 9 pigment { rgb 1 } interior_texture { pigment { rgb 1 } finish { emission 1 } } }'
$ try d "$head" 'background { rgb <0,0,0.1> }' "$ball"
$ try e "$head" 'sky_sphere { pigment { gradient y color_map { [0.99 rgb 0] [0.99 rgb 1] } } }' "$ball"
$ try f "$head" 'sphere { 0, 1 pigment { rgb 1 } finish { ambient 1 diffuse 0 } }'
$ options=--ambient try g "$head" "$ball"
$ try h "$head" '#declare T = texture { pigment { rgb 1 } finish { emission 1 } }' \
+     'mesh { triangle { <-1,-1,0>, <1,-1,0>, <0,1,0> } triangle { <-1,-1,0>, <1,-1,0>, <0,-2,0> texture { T } } }'
$ retex-render -q --list-targets --size 8x6 dark.pov
