// Layers and averages of textures under a parallel light that makes a matte surface as bright as its albedo times its
// diffuse. Seen straight on: pixel (i, 0) sees the middle of the square i.
//
// With b = <.2,.4,.8> of diffuse .8, the squares have
//   0, 1: above it c = <1,.5,.25> of diffuse .5, with transmit .5, and with filter .5
//   2: the average of b, with weight 1, and white of diffuse .5, with weight 3
//   3: white of diffuse 1 in the shadow of a pane that the camera does not see: of a layer <.9,.6,.3> of filter .5 and
//      transmit .2 over a clear one <.4,.8,1> of filter .6 and transmit .4
//   4: under varnish that mirrors .3, with filter .7 and transmit .3 of white: b of diffuse .8 times .7; the lamp in this
//      box is hidden by b
//
// size 5x1  spp 4096  tolerance 6e-3 absolute
// expect 0,0 0.33 0.285 0.3825
// expect 1,0 0.33 0.205 0.1425
// expect 2,0 0.415 0.455 0.535
// expect 3,0 0.416 0.44 0.35
// expect 4,0 0.112 0.224 0.448

#version 3.7;
global_settings { assumed_gamma 1 }
#default { finish { ambient 0 diffuse 0.5 } }

camera { orthographic location <0, 0, -10> direction z right 5 * x up y }
light_source { <-10, 0, -10>, rgb sqrt(2) parallel point_at 0 }

#macro Square(I) box { <I - 2.5, -1, 0>, <I - 1.5, 1, 1> #end
#declare Lower = texture { pigment { rgb <0.2, 0.4, 0.8> } finish { diffuse 0.8 } }

Square(0) texture { Lower } texture { pigment { rgbt <1, 0.5, 0.25, 0.5> } } }
Square(1) texture { Lower } texture { pigment { rgbf <1, 0.5, 0.25, 0.5> } } }
Square(2) texture { average texture_map { [1 Lower] [3 pigment { rgb 1 }] } } }
Square(3) pigment { rgb 1 } finish { diffuse 1 } }
polygon {
    5, <0.5, -0.6>, <1.5, -0.6>, <1.5, 0.6>, <0.5, 0.6>, <0.5, -0.6>
    texture { pigment { rgbft <0.4, 0.8, 1, 0.6, 0.4> } }
    texture { pigment { rgbft <0.9, 0.6, 0.3, 0.5, 0.2> } }
    translate <-4, 0, -4> no_image
}
Square(4) texture { Lower } texture { pigment { rgbft <1, 1, 1, 0.7, 0.3> } finish { diffuse 0 reflection 0.3 } } }
polygon {
    5, <1.7, -0.8>, <2.3, -0.8>, <2.3, 0.8>, <1.7, 0.8>, <1.7, -0.8>
    pigment { rgb 1 } finish { diffuse 0 emission 0.5 } translate 0.5 * z
}
