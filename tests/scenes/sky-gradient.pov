// A Lambertian plane under a sky whose radiance grows with height.
//
// The sky is that of sky.pov: with mu = d.y, L = ((1 + mu) / 2, 0.25, (1 - mu) / 2). A white plane facing it has the
// radiance 1 / pi times the integral of L mu over the upper half of the sphere:
//     red 2 * integral of (1 + mu) / 2 mu = 1/2 + 1/3 = 5/6, green 1/4, blue 1/2 - 1/3 = 1/6, times albedo.
//
// size 65x65  spp 4096  tolerance 2e-5 relative
// expect 32,32 0.666667 0.125 0.0333333
// expect 10,32 0.666667 0.125 0.0333333
// expect 64,0 0.666667 0.125 0.0333333

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 5, 0> direction -y right 4 * x up 4 * z }

sky_sphere { pigment { gradient y color_map { [0 rgb <0, 0.25, 1>] [1 rgb <1, 0.25, 0>] } scale 2 translate -y } }
plane { y, 0 pigment { rgb <0.8, 0.5, 0.2> } }
