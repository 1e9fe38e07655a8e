// Fog of distance 10 before a shining wall, 10 units away; seen parallel. A solid box of clear glass, 4 long, has no fog
// in it, a hollow one has; of one with a hole of 2 the hole has.
// With T = exp(-d / 10) it is T wall + (1 - T) fog; d is 10, 6, 10, 8, 10.
//
// size 5x1  spp 16  tolerance 6e-4 absolute
// expect 0,0 0.420728 0.410364 0.716060
// expect 1,0 0.529287 0.464643 0.625594
// expect 2,0 0.420728 0.410364 0.716060
// expect 3,0 0.469597 0.434799 0.675336
// expect 4,0 0.420728 0.410364 0.716060

#version 3.7;
global_settings { assumed_gamma 1 }

camera { orthographic location 0 direction z right 50 * x up 10 * y }

fog { distance 10 rgb <0.2, 0.3, 0.9> }
plane { -z, -10 pigment { rgb <0.8, 0.6, 0.4> } finish { ambient 0 diffuse 0 emission 1 } }
box { <-15, -5, 3>, <-5, 5, 7> pigment { rgbt 1 } }
box { <-5, -5, 3>, <5, 5, 7> pigment { rgbt 1 } hollow }
difference {
  box { <5, -5, 3>, <15, 5, 7> }
  box { <4, -6, 4>, <16, 6, 6> }
  pigment { rgbt 1 }
}
