// An area light over a Lambertian plane.
//
// Camera: from above, orthographic, 4 by 4: pixel (i, j) of n by n sees x = 4 (i + 0.5) / n - 2, z = 2 - 4 (j + 0.5) / n.
// Three by five points of a 1 by 2 grid at height 1, each a fifteenth of the light: L = albedo * c * mean of h / d. The middle
// of the grid stands for no more than its own point.
//
// size 65x65  spp 256  tolerance 4e-3 relative
// expect 32,32 0.635977 0.357737 0.0953966
// expect 10,32 0.44821 0.252118 0.0672316
// expect 50,50 0.429843 0.241786 0.0644764
// expect 0,0 0.273771 0.153996 0.0410657
// expect 64,20 0.338221 0.190249 0.0507331

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 5, 0> direction -y right 4 * x up 4 * z }

plane { y, 0 pigment { rgb <0.8, 0.5, 0.2> } }
light_source { <0, 1, 0> rgb <1, 0.9, 0.6> area_light x, 2 * z, 3, 5 area_illumination on }
