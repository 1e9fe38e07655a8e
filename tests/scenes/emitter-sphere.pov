// An emitting sphere over a Lambertian plane.
//
// Camera: from above, orthographic, 4 by 4: pixel (i, j) of n by n sees x = 4 (i + 0.5) / n - 2, z = 2 - 4 (j + 0.5) / n.
// The camera is below the sphere. Radiance e, radius R = 0.4, centre at height h = 1, d away: F = (R / d)^2 h / d, all of the
// sphere being above the horizon, and L = albedo * e * F.
//
// size 65x65  spp 1024  tolerance 1e-2 relative
// expect 32,32 0.256 0.12 0.032
// expect 10,32 0.05369 0.0251672 0.00671125
// expect 50,50 0.0398807 0.0186941 0.00498509
// expect 0,0 0.009881 0.00463172 0.00123512
// expect 64,20 0.0202702 0.00950164 0.00253377

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 0.5, 0> direction -y right 4 * x up 4 * z }

plane { y, 0 pigment { rgb <0.8, 0.5, 0.2> } }
sphere { <0, 1, 0>, 0.4 pigment { rgb 1 } finish { diffuse 0 emission <2, 1.5, 1> } }
