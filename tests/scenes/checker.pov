// Checker and gradient, on what emits.
//
// Camera: from above, orthographic, 4 by 4: pixel (i, j) of n by n sees x = 4 (i + 0.5) / n - 2, z = 2 - 4 (j + 0.5) / n.
// L is the pigment. Left (x < 0): cells of 0.5 in x and z, at y = 0.25 of the cell: (1, 0.5, 0) where the sum of the cell's
// whole numbers is even, (0, 0.5, 1) where it is odd. Right: from (0, 0, 1) at x = 0 to (1, 0, 0) at x = 1, then again.
//
// size 65x65  spp 16  tolerance 2e-3 absolute
// expect 4,4 0 0.5 1
// expect 12,4 1 0.5 0
// expect 20,20 0 0.5 1
// expect 28,37 1 0.5 0
// expect 40,10 0.492308 0 0.507692
// expect 60,50 0.723077 0 0.276923

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 5, 0> direction -y right 4 * x up 4 * z }

#declare Shown = finish { diffuse 0 emission 1 }
polygon {
  5, <-2, 0.125, -2>, <0, 0.125, -2>, <0, 0.125, 2>, <-2, 0.125, 2>, <-2, 0.125, -2>
  pigment { checker rgb <1, 0.5, 0> rgb <0, 0.5, 1> scale 0.5 }
  finish { Shown }
}
polygon {
  5, <0, 0, -2>, <2, 0, -2>, <2, 0, 2>, <0, 0, 2>, <0, 0, -2>
  pigment { gradient x color_map { [0 rgb <0, 0, 1>] [1 rgb <1, 0, 0>] } }
  finish { Shown }
}
