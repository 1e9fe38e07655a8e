// A floor and a wall with bumps as targets, behind a mirror and a glass ball with bumps.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1.5, -4> look_at <0, .6, 0> angle 60 }
#declare Floor = texture {
    pigment { checker rgb .2 rgb .8 }
    finish { diffuse .8 ambient 0 specular .2 roughness .02 }
    normal { bumps .6 scale .15 }
}
#declare Wall = texture {
    pigment { rgb <.7, .6, .5> } finish { diffuse .8 ambient 0 }
    normal { gradient x .4 triangle_wave scale .3 }
}
light_source { <3, 6, -4>, rgb .8 }
sphere { <-2, 4, -2>, .6 pigment { rgb 1 } finish { emission 6 diffuse 0 ambient 0 } }
plane { y, 0 texture { Floor } }
plane { -z, -2 texture { Wall } }
sphere { <-.8, .6, 0>, .6 pigment { rgb .9 } finish { diffuse .1 ambient 0 reflection .8 } normal { bumps .3 scale .2 } }
sphere { <.8, .6, 0>, .6
    pigment { rgbf .95 } finish { diffuse 0 ambient 0 reflection { 0, 1 fresnel } conserve_energy }
    normal { bumps .3 scale .3 } interior { ior 1.5 }
}
