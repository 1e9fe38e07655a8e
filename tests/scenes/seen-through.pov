// What mirrors do not show, and what the camera does not see, behind a pane that bends light.
//
// Camera: from above, orthographic, 4 by 4: pixel (i, j) of n by n sees x = 4 (i + 0.5) / n - 2, z = 2 - 4 (j + 0.5) / n.
// The pane is so thin and bends so little that L is the disc's emission, 0.3, to half a percent: the disc below the pane that only
// mirrors leave out is seen, the one that the camera leaves out is not, and rays that go on in the pane are still the camera's.
//
// size 65x65  spp 256  tolerance 1e-6 absolute
// expect 32,32 0.3 0.2 0.1
// expect 10,32 0.3 0.2 0.1
// expect 50,50 0.3 0.2 0.1
// expect 0,0 0.3 0.2 0.1
// expect 64,20 0.3 0.2 0.1

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 5, 0> direction -y right 4 * x up 4 * z }

box { <-9, 1, -9>, <9, 1.001, 9> pigment { rgbt 1 } finish { diffuse 0 } interior { ior 1.01 } }
disc { <0, 0.8, 0>, y, 9 pigment { rgb 0 } no_image }
disc { <0, 0.5, 0>, y, 9 pigment { rgb <0.3, 0.2, 0.1> } finish { diffuse 0 emission 1 } no_reflection }
disc { <0, 0.2, 0>, y, 9 pigment { rgb 1 } finish { diffuse 0 emission 1 } }
