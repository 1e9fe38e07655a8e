// The point light with fade_distance and fade_power.
//
// Camera: from above, orthographic, 4 by 4: pixel (i, j) of n by n sees x = 4 (i + 0.5) / n - 2, z = 2 - 4 (j + 0.5) / n.
// L = albedo * c * h / d * 2 / (1 + (d / fade_distance)^fade_power), h = 1.5, fade_distance = 1.2, fade_power = 2.
//
// size 65x65  spp 4096  tolerance 6e-4 relative
// expect 32,32 0.539399 0.303412 0.0809099
// expect 10,32 0.200486 0.112774 0.030073
// expect 50,50 0.393505 0.221347 0.0590258
// expect 0,0 0.0644807 0.0362704 0.00967211
// expect 64,20 0.218175 0.122724 0.0327263

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 5, 0> direction -y right 4 * x up 4 * z }

plane { y, 0 pigment { rgb <0.8, 0.5, 0.2> } }
light_source { <0.5, 1.5, -0.25> rgb <1, 0.9, 0.6> fade_distance 1.2 fade_power 2 }
