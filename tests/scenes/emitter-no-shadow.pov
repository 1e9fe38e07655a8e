// An emitting box that throws no shadow, over a Lambertian plane.
//
// Camera: from above, orthographic, 4 by 4: pixel (i, j) of n by n sees x = 4 (i + 0.5) / n - 2, z = 2 - 4 (j + 0.5) / n.
// The camera is below it. Its sides are too low to count: it shines as the rectangle of emitter-mesh, at height 0.9, and its
// other faces are behind that one though no shadow says so. So it is with a black sphere in the way, which throws none.
//
// size 65x65  spp 1024  tolerance 8e-3 relative
// expect 32,32 0.46642 0.218634 0.0583025
// expect 10,32 0.0644267 0.0302 0.00805333
// expect 50,50 0.0816177 0.0382583 0.0102022
// expect 0,0 0.00543655 0.00254838 0.000679568
// expect 64,20 0.0238678 0.011188 0.00298347

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 0.5, 0> direction -y right 4 * x up 4 * z }

plane { y, 0 pigment { rgb <0.8, 0.5, 0.2> } }
box { <-0.5, 0.9, -0.6>, <0.8, 0.9001, 0.3> no_shadow pigment { rgb 1 } finish { diffuse 0 emission <2, 1.5, 1> } }
sphere { <0, 0.7, 0>, 0.15 pigment { rgb 0 } no_shadow }
