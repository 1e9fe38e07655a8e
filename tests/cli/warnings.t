# What a scene warns of is printed with -q too; what it only tells, with -v alone.
$ v='#version 3.7; global_settings { assumed_gamma 1 }'; c='camera { location -4*z look_at 0 }'; l='light_source { -9*z rgb 1 }'; s='sphere { 0, 1 pigment { rgb 1 } }'; for x in "v=\"$v\"" "c=\"$c\"" "l=\"$l\"" "s=\"$s\""; do echo "$x"; done >words; echo '. ./words; n=$1; shift; for x; do eval "echo \"$x\""; done >$n.pov; retex-render -q --size 8x6 --spp 1 $n.pov -o $n.exr $o' >try
$ printf 'camera { location -4*z }\nlight_source { -9*z rgb 1 }\n#warning "mind the step"\n#debug "here\\n"\n#declare A = 1/0;\nsphere { 0, 1 scale <1,0,1> pigment { rgb 1 } }\n' >w.pov; for q in -q '' -v -qv; do retex-render $q --size 8x6 --spp 1 w.pov -o w.exr 2>&1 | grep -v Mpaths; done
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
$ sh try dark '$v $c $s'
! retex-render: dark.pov: warning: no light source, nothing that shines and no sky: the picture will be black; weak `ambient`, or ambient beside radiosity, gives light with --ambient only
$ o=--plain sh try dark2 '$v $c sphere { 0, 1 pigment { rgb 1 } finish { ambient 0 } }'
! retex-render: dark2.pov: warning: no light source, nothing that shines and no sky: the picture will be black
$ o=--plain sh try inner '$v $c sphere { 0, 1 texture { pigment { rgb 1 } } interior_texture { pigment { rgb 1 } finish { emission 1 } } }'
$ sh try black '$v $c light_source { -9*z rgb 0 } $s'
! retex-render: black.pov: warning: its light sources are black, nothing shines and there is no sky: the picture will be black; weak `ambient`, or ambient beside radiosity, gives light with --ambient only
$ sh try empty '$v $c $l'
! retex-render: empty.pov: warning: no object and no sky: the picture will be black
$ sh try sky '$v $c sky_sphere { pigment { rgb 0 } } $s'
! retex-render: sky.pov: warning: no light source, nothing that shines and no sky: the picture will be black; weak `ambient`, or ambient beside radiosity, gives light with --ambient only
$ o=--ambient sh try ambient '$v $c sphere { 0, 1 pigment { rgb 1 } finish { ambient 0 } }'
! retex-render: ambient.pov: warning: no light source, nothing that shines and no sky: the picture will be black
$ retex-render -q --size 8x6 --spp 1 --trace-pixel 4,3,0 dark.pov 2>&1 >trace | wc -l
> 1

# And some in which something does: a light, what shines, on either side and on one face of a mesh; the sky, all of it or a
# part, the background; ambient, where that is a lamp or asked for.
$ sh try a '$v $c $l $s'; sh try b '$v $c sphere { 0, 1 pigment { rgb 1 } finish { emission 0.1 } }'; sh try c '$v $c $s sphere { 0, 9 pigment { rgb 1 } interior_texture { pigment { rgb 1 } finish { emission 1 } } }'; sh try d '$v $c background { rgb <0,0,0.1> } $s'; sh try e '$v $c sky_sphere { pigment { gradient y color_map { [0.99 rgb 0] [0.99 rgb 1] } } } $s'; sh try f '$v $c sphere { 0, 1 pigment { rgb 1 } finish { ambient 1 diffuse 0 } }'; o=--ambient sh try g '$v $c $s'; sh try h '#declare T = texture { pigment { rgb 1 } finish { emission 1 } } $v $c mesh { triangle { <-1,-1,0>, <1,-1,0>, <0,1,0> } triangle { <-1,-1,0>, <1,-1,0>, <0,-2,0> texture { T } } }'
$ retex-render -q --list-targets --size 8x6 dark.pov
