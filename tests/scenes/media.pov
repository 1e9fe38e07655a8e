// Media seen parallel before a shining wall, 20 units away: Beer's law, uniform emission, and both in glass boxes.
// From the left: clear; absorption a over 4 units, exp(-4 a); emission e and absorption a, wall exp(-4 a) +
// (1 - exp(-4 a)) e / a; a density that rises from 0 to 1 over the 4 units, exp(-2 a); the second one within a box that
// is not hollow, where no media are.
//
// size 5x1  spp 16384  tolerance 3e-3 absolute
// expect 0,0 0.8 0.6 0.4
// expect 1,0 0.536256 0.269597 0.080759
// expect 2,0 0.701096 0.820268 0.479810
// expect 3,0 0.654985 0.402192 0.179732
// expect 4,0 0.8 0.6 0.4

#version 3.7;
global_settings { assumed_gamma 1 }

camera { orthographic location 0 direction z right 50 * x up 10 * y }

#declare Absorbing = media { absorption <0.1, 0.2, 0.4> }
#declare Glass = box { <-5, -5, 8>, <5, 5, 12> pigment { rgbt 1 } hollow }
plane { -z, -20 hollow pigment { rgb <0.8, 0.6, 0.4> } finish { ambient 0 diffuse 0 emission 1 } }
object { Glass interior { media { Absorbing } } translate -10 * x }
object { Glass interior { media { Absorbing emission <0.05, 0.2, 0.2> samples 3, 5 intervals 2 } } }
object {
  Glass
  interior { media { Absorbing density { gradient z density_map { [0 rgb 0] [1 rgb 1] } scale 4 } } }
  translate 10 * x
}
object { Glass interior { media { Absorbing } } translate 20 * x }
box { <15.001, -5, 6>, <25, 5, 14> pigment { rgbt 1 } }
