// A little of everything: a target seen, through glass and in a mirror, a lamp, a shape that shines, a mesh.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1, -3> look_at 0 }
light_source { <-2, 4, -3> rgb 1 }
#declare F = texture { pigment { checker rgb .3 rgb .8 } finish { diffuse .8 reflection .2 } }
plane { y, -1 texture { F } }
sphere { 0, .7 pigment { rgbt 1 } interior { ior 1.5 } }
sphere { <1.2, 0, 1>, .6 pigment { rgb .5 } finish { emission 2 } }
box { <-2, -1, 0>, <-1, 0, 1> texture { F } }
mesh { triangle { <-1, -1, 2>, <1, -1, 2>, <0, 1, 2> } pigment { rgb .6 } }
