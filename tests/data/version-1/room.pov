// What the files of tests/data/version-1 were rendered from: two targets that see each other, glass, two lamps.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1, -3.2> look_at <0, 0.8, 0> angle 50 right 1.5*x }
#declare Lamp = light_source { <0, 1.9, -0.5>, rgb 1.4 area_light 0.6*x, 0.6*z, 2, 2 fade_distance 1 fade_power 2 }
#declare Sun = light_source { <-30, 50, -40>, rgb <0.8, 0.7, 0.5> parallel point_at 0 }
light_source { Lamp }
light_source { Sun }
sky_sphere { pigment { gradient y color_map { [0 rgb 0.3] [1 rgb <0.5, 0.6, 0.9>] } } }
#declare Floor = texture { pigment { checker rgb <0.7, 0.3, 0.2>, rgb <0.2, 0.4, 0.6> scale 0.4 }
    finish { retex { metallic 0.5 roughness 0.3 } } }
#declare Wall = texture { pigment { rgb <0.3, 0.7, 0.4> } finish { retex { roughness 0.9 } } }
box { <-1.5, -0.1, -1>, <1.5, 0, 1.5> texture { Floor } }
box { <-1.5, 0, 1.5>, <1.5, 2, 1.6> texture { Wall } }
box { <-1.6, 0, -1>, <-1.5, 2, 1.5> texture { Wall } }
sphere { <0.5, 0.45, 0.3>, 0.45 pigment { rgbf 1 } finish { reflection { 0, 1 fresnel } conserve_energy } interior { ior 1.5 } }
