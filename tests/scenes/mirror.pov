// A sky in a level mirror.
//
// Camera: looking straight down from height 2 with right = up = 4 at distance 2, so pixels see the plane where the other scenes do.
// The reflected ray rises by d.y = 2 / sqrt(x^2 + z^2 + 4): with t = (d.y + 1) / 2, L = 0.8 (t, 0.25, 1 - t).
//
// size 65x65  spp 16  tolerance 1e-4 absolute
// expect 32,32 0.8 0.2 0
// expect 10,32 0.731244 0.2 0.0687562
// expect 50,50 0.714903 0.2 0.0850971
// expect 0,0 0.633327 0.2 0.166673
// expect 64,20 0.675646 0.2 0.124354

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { location <0, 2, 0> direction -2 * y right 4 * x up 4 * z }

sky_sphere { pigment { gradient y color_map { [0 rgb <0, 0.25, 1>] [1 rgb <1, 0.25, 0>] } scale 2 translate -y } }
plane { y, 0 pigment { rgb 1 } finish { diffuse 0 reflection { 0.8 } } }
