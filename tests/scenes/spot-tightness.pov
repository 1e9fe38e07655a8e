// A spot light straight down on a Lambertian plane, tightness 8.
//
// Camera: from above, orthographic, 4 by 4: pixel (i, j) of n by n sees x = 4 (i + 0.5) / n - 2, z = 2 - 4 (j + 0.5) / n.
// With a the angle off the axis: L = albedo * c * cos a * cos(a)^tightness * s, where s rises from 0 at the falloff angle to 1
// at the radius as (3 - 2 t) t^2 of t = (cos a - cos falloff) / (cos radius - cos falloff). Height 2, radius 20, falloff 35.
//
// size 65x65  spp 16  tolerance 2e-3 absolute
// expect 32,32 0.8 0.45 0.12
// expect 40,32 0.613936 0.345339 0.0920904
// expect 48,32 0.215255 0.121081 0.0322882
// expect 50,40 0.0420213 0.023637 0.00630319
// expect 54,32 0.00230693 0.00129765 0.00034604
// expect 0,0 0 0 0

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 5, 0> direction -y right 4 * x up 4 * z }

plane { y, 0 pigment { rgb <0.8, 0.5, 0.2> } }
light_source { <0, 2, 0> rgb <1, 0.9, 0.6> spotlight point_at <0, 0, 0> radius 20 falloff 35 tightness 8 }
