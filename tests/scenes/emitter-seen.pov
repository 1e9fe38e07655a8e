// What emits is seen as bright as it is.
//
// Emission times pigment, from either side, whatever the distance: L = emission * pigment on the sphere, 0 beside it.
//
// size 65x65  spp 1  tolerance 1e-6 absolute
// expect 32,32 2 1 1
// expect 50,40 2 1 1
// expect 0,0 0 0 0

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 5, 0> direction -y right 4 * x up 4 * z }

sphere { <0, 0, 0>, 1.5 pigment { rgb <1, 0.5, 0.25> } finish { diffuse 0 emission <2, 2, 4> } }
