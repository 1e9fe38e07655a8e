// An emitting box over a Lambertian plane.
//
// Camera: from above, orthographic, 4 by 4: pixel (i, j) of n by n sees x = 4 (i + 0.5) / n - 2, z = 2 - 4 (j + 0.5) / n.
// The camera is below it. Radiance e; the box hovers over the middle of the plane: from straight below only its underside is
// seen, a square of 1 at height 0.8, F as in emitter-polygon.pov. Named pixels lie under the box only: elsewhere its sides add.
//
// size 65x65  spp 16384  tolerance 8e-3 relative
// expect 32,32 0.526203 0.246657 0.0657753
// expect 28,36 0.444318 0.208274 0.0555397
// expect 38,27 0.380947 0.178569 0.0476184

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 0.5, 0> direction -y right 4 * x up 4 * z }

plane { y, 0 pigment { rgb <0.8, 0.5, 0.2> } }
box { <-0.5, 0.8, -0.5>, <0.5, 1.8, 0.5> pigment { rgb 1 } finish { diffuse 0 emission <2, 1.5, 1> } }
