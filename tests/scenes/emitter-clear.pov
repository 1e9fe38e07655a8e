// An emitting disc that is half clear, over a Lambertian plane.
//
// Camera: from above, orthographic, 4 by 4: pixel (i, j) of n by n sees x = 4 (i + 0.5) / n - 2, z = 2 - 4 (j + 0.5) / n.
// What is not there does not shine: L = albedo * e * F / 2 with the disc's form factor F, see emitter-disc.
//
// size 65x65  spp 1024  tolerance 4e-3 relative
// expect 32,32 0.288 0.135 0.036
// expect 10,32 0.0662601 0.0310594 0.00828251
// expect 50,50 0.0449344 0.021063 0.0056168
// expect 0,0 0.00653955 0.00306542 0.000817444
// expect 64,20 0.0177858 0.0083371 0.00222323

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 0.5, 0> direction -y right 4 * x up 4 * z }

plane { y, 0 pigment { rgb <0.8, 0.5, 0.2> } }
disc { <0, 1, 0>, y, 0.75 pigment { rgbt <1, 1, 1, 0.5> } finish { diffuse 0 emission <2, 1.5, 1> } }
