// Three point lights of different colours and heights over a Lambertian plane: their light adds up.
//
// Camera: from above, orthographic, 4 by 4: pixel (i, j) of n by n sees x = 4 (i + 0.5) / n - 2, z = 2 - 4 (j + 0.5) / n.
// Irradiance pi c cos each, no falloff: L = albedo * sum of c * h / d with h a light's height, d its distance.
//
// size 65x65  spp 16384  tolerance 3e-4 relative
// expect 32,32 0.940363 0.586902 0.30781
// expect 10,32 0.69398 0.505869 0.262975
// expect 50,50 0.81444 0.478329 0.266561
// expect 0,0 0.492375 0.393384 0.20419
// expect 64,20 0.664954 0.395021 0.233381

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 5, 0> direction -y right 4 * x up 4 * z }

plane { y, 0 pigment { rgb <0.8, 0.5, 0.2> } }
light_source { <0.5, 1.5, -0.25> rgb <1, 0.9, 0.6> }
light_source { <-1.5, 0.75, 1> rgb <0.1, 0.6, 0.2> }
light_source { <0, 3, 0> rgb <0.2, 0.1, 0.9> }
