// A sheet lit from behind.
//
// Camera: from above, orthographic, 4 by 4: pixel (i, j) of n by n sees x = 4 (i + 0.5) / n - 2, z = 2 - 4 (j + 0.5) / n.
// L = albedo * c * 0.4 cos(a)^brilliance, the light 1.5 behind the sheet, brilliance 3.
//
// size 65x65  spp 64  tolerance 1.5e-3 relative
// expect 32,32 0.32 0.18 0.048
// expect 10,32 0.130909 0.0736365 0.0196364
// expect 50,50 0.105859 0.0595457 0.0158788
// expect 0,0 0.0341232 0.0191943 0.00511848
// expect 64,20 0.0626503 0.0352408 0.00939754

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 5, 0> direction -y right 4 * x up 4 * z }

disc { 0, y, 9 pigment { rgb <0.8, 0.5, 0.2> } finish { diffuse 0.6, 0.4 brilliance 3 } }
light_source { <0, -1.5, 0> rgb <1, 0.9, 0.6> }
