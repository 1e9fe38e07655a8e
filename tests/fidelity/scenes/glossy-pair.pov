// Two sheets that stand like an open book, one of coated paint, one of metal: each shows the other, and itself in the
// other. Targets: Left, Right.
//
//   retex-render glossy-pair.pov -t left -t right -o glossy-pair.exr
//   povray glossy-pair.pov +W320 +H240    (in this folder, so that textures/ is found)
//
// One unit is a metre. x to the right, y up, z into the picture.

#version 3.7;

global_settings { assumed_gamma 1 max_trace_level 12 }
#default { finish { ambient 0 diffuse 1 } }

camera {
  location <0, 1.25, -3.6>
  right x * 4/3
  up y
  angle 44
  look_at <0, 0.72, 0>
}

// One metre a repeat, by the sheets' own coordinates.
#declare Left = texture {
  pigment {
    uv_mapping
    image_map { jpeg "textures/left.jpg" interpolate 2 }
  }
  finish {
    diffuse 0.8 reflection { 0.05, 0.6 fresnel on }
    #ifdef (Retex) retex { metallic 0 roughness 0.2 ior 1.9 } #end
  }
}
#declare Right = texture {
  pigment {
    uv_mapping
    image_map { jpeg "textures/right.jpg" interpolate 2 }
  }
  finish {
    diffuse 0.3 reflection { 0.6 metallic }
    #ifdef (Retex) retex { metallic 1 roughness 0.22 } #end
  }
}
#declare Ground = texture { pigment { rgb 0.45 } }

plane { y, 0 texture { Ground } }

// A sheet 1.7 wide and 1.5 high from the z axis to the right, facing -z.
#declare Wide = 1.7; #declare High = 1.5;
#macro Sheet()
  mesh2 {
    vertex_vectors { 4, <0, 0, 0>, <Wide, 0, 0>, <Wide, High, 0>, <0, High, 0> }
    uv_vectors { 4, <0, 0>, <Wide, 0>, <Wide, High>, <0, High> }
    face_indices { 2, <0, 2, 1>, <0, 3, 2> }
    uv_indices { 2, <0, 2, 1>, <0, 3, 2> }
  }
#end
#declare Half_angle = 31; // of the book, from its middle
object { Sheet() texture { Right } rotate y * (90 - Half_angle) translate <0.01, 0.01, 0.9> }
object { Sheet() texture { Left } translate -Wide * x rotate y * (Half_angle - 90) translate <-0.01, 0.01, 0.9> }

sphere { <0, 0.22, 0.05>, 0.22 texture { pigment { rgb 0.75 } } }

// A lamp above, and the bright room behind the camera.
#declare Lamp_Radiance = <15, 14.2, 13>;
object {
  polygon { 5, <-0.7, 2.8, -1.4>, <0.7, 2.8, -1.4>, <0.7, 2.8, 0>, <-0.7, 2.8, 0>, <-0.7, 2.8, -1.4> }
  texture { pigment { rgb 1 } finish { emission Lamp_Radiance diffuse 0 } }
}
background { rgb <0.42, 0.44, 0.47> }
#ifndef (Retex)
  light_source {
    <0, 2.79, -0.7>
    rgb Lamp_Radiance * pow(1.4, 2) / (2 * pi * 0.04)
    fade_distance 0.2 fade_power 2
    area_light 1.4 * x, 1.4 * z, 5, 5 adaptive 1 jitter
  }
#end
