// Inside a sphere that emits and reflects.
//
// Emission 0.5, albedo 0.5, seen from within: L = 0.5 (1 + 0.5 + 0.25 + …) = 1. Paths of 16 segments miss 0.5^16.
//
// size 65x65  spp 8192  tolerance 1e-2 absolute
// expect 32,32 1 1 1
// expect 5,50 1 1 1
// expect 60,10 1 1 1

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { location <0.5, 0.3, -1> direction z right 2 * x up 2 * y }

sphere { <0, 0, 0>, 3 pigment { rgb 1 } finish { diffuse 0.5 emission 0.5 } }
