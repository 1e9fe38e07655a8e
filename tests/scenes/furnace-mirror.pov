// A mirror under a coloured sky.
//
// Reflection 0.8, nothing else: L = 0.8 * background on the sphere.
//
// size 65x65  spp 4  tolerance 1e-6 absolute
// expect 32,32 0.4 0.8 1.6
// expect 16,32 0.4 0.8 1.6
// expect 0,0 0.5 1 2

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { location <0, 0, -4> direction z right x up y }

background { rgb <0.5, 1, 2> }
sphere { <0, 0, 0>, 1.5 pigment { rgb 1 } finish { diffuse 0 reflection { 0.8 } } }
