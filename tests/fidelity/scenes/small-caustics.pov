// A small room with caustics: a glass ball and a mirror ball under a point light and an area light. Few paths find what
// the balls reflect and refract of the lamps, so that single pixels are far too bright. Thin bars are detail that a
// filter must keep.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 12 }
camera { location <0, 1.5, -4.2> look_at <0, .8, 0> angle 50 right x*4/3 }

#declare Matte = finish { ambient 0 diffuse .8 }
#declare Tiles = texture { pigment { checker rgb <.8, .7, .6> rgb <.35, .3, .25> scale .5 } finish { Matte } }

plane { y, 0 texture { Tiles } }
plane { -z, -2 pigment { rgb <.7, .75, .8> } finish { Matte } }
sphere { // glass
  <-.8, .6, .2>, .6
  pigment { rgbf 1 }
  finish { ambient 0 diffuse 0 reflection { 0, 1 fresnel } }
  interior { ior 1.5 }
}
sphere { // mirror
  <.85, .6, .4>, .6
  pigment { rgb .9 }
  finish { ambient 0 diffuse 0 reflection .9 }
}
#declare I = 0;
#while (I < 8)
  cylinder { <-1.4 + I * .4, 0, 1.2>, <-1.4 + I * .4, 2.2, 1.2>, .03 pigment { rgb .3 } finish { Matte } }
  #declare I = I + 1;
#end

light_source { <-1.5, 4, -2> rgb <3, 2.7, 2.3> fade_power 2 fade_distance 1 }
light_source {
  <2.5, 3.5, -1> rgb <4, 4.3, 5>
  area_light <.8, 0, 0>, <0, 0, .8>, 4, 4 adaptive 1 jitter
  fade_power 2 fade_distance 1
}
