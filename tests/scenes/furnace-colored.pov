// A coloured sphere under a coloured sky.
//
// Convex, so that light is reflected once: L = albedo * background on it, background beside it.
//
// size 65x65  spp 64  tolerance 1e-6 absolute
// expect 32,32 0.4 0.5 0.4
// expect 16,32 0.4 0.5 0.4
// expect 45,40 0.4 0.5 0.4
// expect 0,0 0.5 1 2

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { location <0, 0, -4> direction z right x up y }

background { rgb <0.5, 1, 2> }
sphere { <0, 0, 0>, 1.5 pigment { rgb <0.8, 0.5, 0.2> } }
