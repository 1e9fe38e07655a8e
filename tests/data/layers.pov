// Two targets that blend in a texture_map, on the floor; a target that is a filter layer over another one, on the sphere
// and the box; glass in front. The light comes from a source and from the sky.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 2.2, -4> look_at <0, 0.6, 0> angle 45 }
light_source { <3, 5, -4> rgb 0.8 }
background { rgb 0.15 }

#declare Lower = texture { pigment { checker rgb <0.8, 0.7, 0.2> rgb <0.2, 0.3, 0.8> scale 0.4 } finish { diffuse 0.8 } }
#declare Upper =
    texture {
        pigment { gradient x color_map { [0 rgb <0.7, 0.2, 0.1>] [1 rgb <0.2, 0.7, 0.3>] } scale 0.7 }
        finish { diffuse 0.6 phong 0.4 }
    }
#declare Glaze = texture { pigment { checker rgbf <0.9, 0.8, 0.5, 0.6> rgbft <0.4, 0.9, 0.8, 0.5, 0.2> scale 0.3 } }

plane { y, 0 texture { gradient x texture_map { [0.1 Lower] [0.9 Upper] } triangle_wave scale 3 } }
sphere { <0.8, 0.7, 0>, 0.7 texture { Lower } texture { Glaze } }
box { <-1.6, 0, -0.4>, <-0.4, 1, 0.5> texture { Lower } texture { Glaze scale 2 } }
sphere { <0, 0.3, -1>, 0.3 pigment { rgbf <1, 0.9, 0.9, 0.7> } finish { reflection 0.1 } interior { ior 1.3 } }
