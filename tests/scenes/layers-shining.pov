// Layers and averages of textures that shine, seen straight on: pixel (i, 0) sees the middle of the square i.
//
// A layer of colour c, filter f and transmit t over what shines with b is seen as c e (1 - f - t) + (f c + t) b, where e is
// its own emission. With b = <.2,.4,.8>, the squares have
//   0 to 2: c = <1,.5,.25>; t = .5; f = .5; f = .3 and t = .2
//   3: on the last one a layer <.5,.9,.7> of f = .4 and t = .3
//   4, 5: as 0 and 1, but the upper layer has e = .5: other finishes, so that one layer is chosen at random
//   6: the average of b, with weight 1, and white of e = .5, with weight 3
//   7: a pane of a layer <.9,.6,.3> of f = .5 and t = .2 over a clear one <.4,.8,1> of f = .6 and t = .4, before white
//   8: the second of a list of textures
//
// size 9x1  spp 4096  tolerance 6e-3 absolute
// expect 0,0 0.6 0.45 0.525
// expect 1,0 0.6 0.35 0.225
// expect 2,0 0.6 0.39 0.345
// expect 3,0 0.45 0.5274 0.4101
// expect 4,0 0.35 0.325 0.4625
// expect 5,0 0.35 0.225 0.1625
// expect 6,0 0.425 0.475 0.575
// expect 7,0 0.686 0.62 0.44
// expect 8,0 0.15 0.3 0.45

#version 3.7;
global_settings { assumed_gamma 1 }
#default { finish { ambient 0 diffuse 0 emission 1 } }

camera { orthographic location <0, 0, -10> direction z right 9 * x up y }

#macro Square(I) box { <I - 4.5, -1, 0>, <I - 3.5, 1, 1> #end
#declare Lower = texture { pigment { rgb <0.2, 0.4, 0.8> } }
#declare Half = finish { emission 0.5 }

Square(0) texture { Lower } texture { pigment { rgbt <1, 0.5, 0.25, 0.5> } } }
Square(1) texture { Lower } texture { pigment { rgbf <1, 0.5, 0.25, 0.5> } } }
Square(2) texture { Lower } texture { pigment { rgbft <1, 0.5, 0.25, 0.3, 0.2> } } }
Square(3)
    texture { Lower }
    texture { pigment { rgbft <1, 0.5, 0.25, 0.3, 0.2> } }
    texture { pigment { rgbft <0.5, 0.9, 0.7, 0.4, 0.3> } }
}
Square(4) texture { Lower } texture { pigment { rgbt <1, 0.5, 0.25, 0.5> } finish { Half } } }
Square(5) texture { Lower } texture { pigment { rgbf <1, 0.5, 0.25, 0.5> } finish { Half } } }
Square(6) texture { average texture_map { [1 Lower] [3 pigment { rgb 1 } finish { Half }] } } }
Square(7) pigment { rgb 1 } }
polygon {
    5, <2.5, -1>, <3.5, -1>, <3.5, 1>, <2.5, 1>, <2.5, -1>
    texture { pigment { rgbft <0.4, 0.8, 1, 0.6, 0.4> } }
    texture { pigment { rgbft <0.9, 0.6, 0.3, 0.5, 0.2> } }
    translate -2 * z
}
Square(8) texture { checker texture { Lower } texture { pigment { rgb <0.3, 0.6, 0.9> } finish { Half } } scale 20 translate <-26, -10, -10> } }
