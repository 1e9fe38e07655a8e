// The living room with more lamps: Lamps of them, 0 to 13, beside the three that the room has. Targets: Floor, Wall.
//
//   retex-render -I scenes/living-room -D Lamps=5 lamps-living-room.pov -t Floor -t Wall --lamps each -o room.exr
//
// A pendant, a spotlight, a candle in a glass, a strip under the window sills, and nine bulbs on the back wall.

#include "living-room.pov"

#ifndef (Lamps) #declare Lamps = 13; #end

#macro Glowing(Radiance) texture { pigment { rgb 1 } finish { emission Radiance diffuse 0 } } #end

#if (Lamps >= 1)
  #declare Pendant = sphere { <.4, 2.2, .6>, .12 Glowing(<9, 7, 4.5>) }
  object { Pendant }
#end
#if (Lamps >= 2)
  #declare Spot = light_source { <1.6, 2.7, 1.2> rgb <2.2, 2, 1.7> spotlight point_at <1.9, 1.2, 2.6> radius 14 falloff 24 }
  light_source { Spot }
#end
#if (Lamps >= 3)
  #declare Candle = sphere { <-.2, .56, .35>, .025 Glowing(<60, 34, 12>) }
  object { Candle }
  difference {
    cylinder { <-.2, .48, .35>, <-.2, .66, .35>, .05 }
    cylinder { <-.2, .49, .35>, <-.2, .67, .35>, .046 }
    material { Glass }
  }
#end
#if (Lamps >= 4)
  #declare Strip = box { <Left + .1, .38, -3.2>, <Left + .12, .4, 1.6> Glowing(<3, 4, 6>) }
  object { Strip }
#end
#macro Wall_Bulb(At) sphere { <-2.4 + .6 * At, 2.5, Back - .08>, .04 Glowing(<14, 10, 6>) } #end
#if (Lamps >= 5) #declare Bulb_1 = Wall_Bulb(0) object { Bulb_1 } #end
#if (Lamps >= 6) #declare Bulb_2 = Wall_Bulb(1) object { Bulb_2 } #end
#if (Lamps >= 7) #declare Bulb_3 = Wall_Bulb(2) object { Bulb_3 } #end
#if (Lamps >= 8) #declare Bulb_4 = Wall_Bulb(3) object { Bulb_4 } #end
#if (Lamps >= 9) #declare Bulb_5 = Wall_Bulb(4) object { Bulb_5 } #end
#if (Lamps >= 10) #declare Bulb_6 = Wall_Bulb(5) object { Bulb_6 } #end
#if (Lamps >= 11) #declare Bulb_7 = Wall_Bulb(6) object { Bulb_7 } #end
#if (Lamps >= 12) #declare Bulb_8 = Wall_Bulb(7) object { Bulb_8 } #end
#if (Lamps >= 13) #declare Bulb_9 = Wall_Bulb(8) object { Bulb_9 } #end
