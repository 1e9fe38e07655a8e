// A spot light straight down on a Lambertian plane.
//
// Camera: from above, orthographic, 4 by 4: pixel (i, j) of n by n sees x = 4 (i + 0.5) / n - 2, z = 2 - 4 (j + 0.5) / n.
// With a the angle off the axis: L = albedo * c * cos a * cos(a)^tightness * s, where s rises from 0 at the falloff angle to 1
// at the radius as (3 - 2 t) t^2 of t = (cos a - cos falloff) / (cos radius - cos falloff). Height 2, radius 20, falloff 35.
//
// size 65x65  spp 16  tolerance 3e-3 absolute
// expect 32,32 0.8 0.45 0.12
// expect 40,32 0.776812 0.436957 0.116522
// expect 48,32 0.512805 0.288453 0.0769207
// expect 50,40 0.146883 0.0826217 0.0220325
// expect 54,32 0.0104312 0.00586753 0.00156467
// expect 0,0 0 0 0

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 5, 0> direction -y right 4 * x up 4 * z }

plane { y, 0 pigment { rgb <0.8, 0.5, 0.2> } }
light_source { <0, 2, 0> rgb <1, 0.9, 0.6> spotlight point_at <0, 0, 0> radius 20 falloff 35 tightness 0 }
