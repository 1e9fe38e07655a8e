// A parallel light over a Lambertian plane.
//
// Camera: from above, orthographic, 4 by 4: pixel (i, j) of n by n sees x = 4 (i + 0.5) / n - 2, z = 2 - 4 (j + 0.5) / n.
// From 60 degrees off the normal: L = albedo * c * 0.5 everywhere.
//
// size 65x65  spp 4  tolerance 1e-6 relative
// expect 32,32 0.4 0.225 0.06
// expect 10,32 0.4 0.225 0.06
// expect 50,50 0.4 0.225 0.06
// expect 0,0 0.4 0.225 0.06
// expect 64,20 0.4 0.225 0.06

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 5, 0> direction -y right 4 * x up 4 * z }

plane { y, 0 pigment { rgb <0.8, 0.5, 0.2> } }
light_source { <30 * sqrt(3), 30, 0> rgb <1, 0.9, 0.6> parallel point_at <0, 0, 0> }
