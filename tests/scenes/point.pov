// One point light over a Lambertian plane.
//
// Camera: from above, orthographic, 4 by 4: pixel (i, j) of n by n sees x = 4 (i + 0.5) / n - 2, z = 2 - 4 (j + 0.5) / n.
// Irradiance pi c cos, no falloff: L = albedo * c * h / d with h = 1.5 the light's height, d its distance.
//
// size 65x65  spp 4096  tolerance 3e-4 relative
// expect 32,32 0.749634 0.421669 0.112445
// expect 10,32 0.500467 0.281513 0.0750701
// expect 50,50 0.655149 0.368521 0.0982723
// expect 0,0 0.329391 0.185282 0.0494086
// expect 64,20 0.517083 0.290859 0.0775625

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 5, 0> direction -y right 4 * x up 4 * z }

plane { y, 0 pigment { rgb <0.8, 0.5, 0.2> } }
light_source { <0.5, 1.5, -0.25> rgb <1, 0.9, 0.6> }
