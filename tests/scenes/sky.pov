// A sky, seen directly.
//
// Camera along z with right = up = 2 at distance 1: d = normalised <2 (i + 0.5) / n - 1, 1 - 2 (j + 0.5) / n, 1>.
// The gradient runs from y = -1 to y = 1: with t = (d.y + 1) / 2, L = (t, 0.25, 1 - t).
//
// size 65x65  spp 16  tolerance 2e-4 absolute
// expect 32,32 0.5 0.25 0.5
// expect 10,32 0.5 0.25 0.5
// expect 50,50 0.28199 0.25 0.71801
// expect 0,0 0.787172 0.25 0.212828
// expect 64,20 0.627221 0.25 0.372779

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { location 0 direction z right 2 * x up 2 * y }

sky_sphere { pigment { gradient y color_map { [0 rgb <0, 0.25, 1>] [1 rgb <1, 0.25, 0>] } scale 2 translate -y } }
