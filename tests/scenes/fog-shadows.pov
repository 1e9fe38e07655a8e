// Light from above on a white floor, seen from above in black fog of distance 20. A light source goes through fog
// undimmed; with media_attenuation it is dimmed over the way from light to floor as well. Seen parallel: with s the
// distance to the light and h = 10 its height, h / s exp(-20 / 20), for the blue light times exp(-s / 20); the mean over
// each pixel, by a sum over 400 x 400 points.
//
// size 3x1  spp 4096  tolerance 3e-3 absolute
// expect 0,0 0.256954 0.256954 0.126191
// expect 1,0 0.341612 0.341612 0.199441
// expect 2,0 0.256954 0.256954 0.126191

#version 3.7;
global_settings { assumed_gamma 1 }

camera { orthographic location 20 * y direction -y right 30 * x up 10 * z }

fog { distance 20 rgb 0 }
plane { y, 0 pigment { rgb 1 } finish { ambient 0 diffuse 1 } }
light_source { 10 * y rgb <1, 1, 0> }
light_source { 10 * y rgb <0, 0, 1> media_attenuation on }
