// A ground inside of a box that fades light.
//
// Camera: from above, orthographic, 4 by 4: pixel (i, j) of n by n sees x = 4 (i + 0.5) / n - 2, z = 2 - 4 (j + 0.5) / n.
// The camera looks straight down; the ground is 0.5 under the box's upper face, and the box goes deeper: L = e t with
// t = exp(-(1 - fade_color) 0.5 / 0.4).
//
// size 65x65  spp 16  tolerance 1e-5 relative
// expect 32,32 0.264749 0.160578 0.110364
// expect 10,32 0.264749 0.160578 0.110364
// expect 50,50 0.264749 0.160578 0.110364
// expect 0,0 0.264749 0.160578 0.110364
// expect 64,20 0.264749 0.160578 0.110364

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 5, 0> direction -y right 4 * x up 4 * z }

box { <-9, -1, -9>, <9, 0.5, 9> pigment { rgbt 1 } finish { diffuse 0 } interior { fade_power 1001 fade_distance 0.4 fade_color rgb <0.9, 0.5, 0.2> } }
disc { 0, y, 8 pigment { rgb 0.3 } finish { diffuse 0 emission 1 } }
