// A room whose sun has a slider: five suns, of which one shines at a time. Target: Floor.
//
//   retex-render docs/suns.pov -t Floor --lamps each --denoise -o suns.exr
//   retex-combine suns.exr --solo Sun_16 --light Sun_16=2 --light sky=20 -o four-o-clock.jpg
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1.5, -3.4> right x*4/3 angle 68 look_at <.2, 1, 1> }
background { rgb <.25, .32, .45> }

#declare Floor = texture { pigment { checker rgb <.55, .36, .2> rgb <.68, .48, .3> scale .4 } }
#declare Plaster = texture { pigment { rgb <.8, .78, .74> } }
plane { y, 0 texture { Floor } }
difference { // the room, with two windows in the left wall
  box { <-3.2, 0, -3.7>, <3, 2.9, 3> }
  box { <-3, -.1, -3.5>, <2.8, 2.7, 2.8> }
  box { <-4, .7, -1.8>, <-2, 2.3, -.3> }
  box { <-4, .7, .5>, <-2, 2.3, 2> }
  texture { Plaster }
}
box { <.6, .7, .6>, <1.9, .76, 1.8> pigment { rgb <.3, .18, .1> } }
cylinder { <1.25, 0, 1.2>, <1.25, .7, 1.2>, .06 pigment { rgb .2 } }
sphere { <1.25, .92, 1.2>, .16 pigment { rgb <.8, .25, .15> } finish { reflection .04 } }

// The sun of an hour: higher and whiter at noon, lower and redder in the evening; the windows look to the west.
#macro Sun(Hour)
  #local Height = 62 - 10*(Hour - 13);
  light_source {
    vrotate(-100*x, <0, 0, -Height>) + <0, 0, 12*(16 - Hour)>
    rgb <2.4, 2.4 - .14*(Hour - 12), 2.3 - .3*(Hour - 12)> parallel point_at 0
  }
#end
#declare Sun_14 = Sun(14) light_source { Sun_14 }
#declare Sun_15 = Sun(15) light_source { Sun_15 }
#declare Sun_16 = Sun(16) light_source { Sun_16 }
#declare Sun_17 = Sun(17) light_source { Sun_17 }
#declare Sun_18 = Sun(18) light_source { Sun_18 }
