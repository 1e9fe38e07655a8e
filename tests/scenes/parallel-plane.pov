// A parallel light with a disc behind it.
//
// Camera: from above, orthographic, 4 by 4: pixel (i, j) of n by n sees x = 4 (i + 0.5) / n - 2, z = 2 - 4 (j + 0.5) / n.
// L = albedo * c * cos a everywhere, tan a = 1 / 2: what lies behind the plane of the light throws no shadow.
//
// size 65x65  spp 4  tolerance 1e-5 relative
// expect 32,32 0.715542 0.402492 0.107331
// expect 10,32 0.715542 0.402492 0.107331
// expect 50,50 0.715542 0.402492 0.107331
// expect 0,0 0.715542 0.402492 0.107331
// expect 64,20 0.715542 0.402492 0.107331

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 5, 0> direction -y right 4 * x up 4 * z }

plane { y, 0 pigment { rgb <0.8, 0.5, 0.2> } }
light_source { <0, 2, 0> rgb <1, 0.9, 0.6> parallel point_at <1, 0, 0> }
disc { <0, 6, 0>, y, 9 pigment { rgb 0 } no_image }
