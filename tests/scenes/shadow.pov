// A sphere between a point light and a plane.
//
// Camera: from above, orthographic, 4 by 4: pixel (i, j) of n by n sees x = 4 (i + 0.5) / n - 2, z = 2 - 4 (j + 0.5) / n.
// The camera is below the sphere. Radius 0.5, halfway up to the light at height h = 4: L = 0 within 4 tan(asin(0.25)) = 1.0328 of
// the middle, elsewhere albedo * c * h / d.
//
// size 65x65  spp 4  tolerance 6e-4 relative
// expect 32,32 0 0 0
// expect 32,44 0 0 0
// expect 32,60 0.73473 0.413286 0.11021
// expect 5,5 0.689786 0.388005 0.103468

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 1, 0> direction -y right 4 * x up 4 * z }

plane { y, 0 pigment { rgb <0.8, 0.5, 0.2> } }
sphere { <0, 2, 0>, 0.5 pigment { rgb 1 } }
light_source { <0, 4, 0> rgb <1, 0.9, 0.6> }
