// A globe on a table before a mirror, a metal ball beside it. Target: Globe.
//
//   retex-render globe.pov -t globe -o globe.exr
//   povray globe.pov +W320 +H240          (in this folder, so that textures/ is found)
//
// One unit is a decimetre. x to the right, y up, z into the picture.

#version 3.7;

global_settings { assumed_gamma 1 max_trace_level 8 }
#default { finish { ambient 0 diffuse 1 } }

camera {
  location <0.2, 4.4, -10.5>
  right x * 4/3
  up y
  angle 38
  look_at <0.15, 1.95, 0>
}

// The sphere's own coordinates: u once about, v from pole to pole. Where u goes from 1 to 0 looks at the camera.
#declare Globe = texture {
  pigment {
    uv_mapping
    image_map { jpeg "textures/globe.jpg" interpolate 2 }
  }
  finish { diffuse 0.95 #ifdef (Retex) retex { roughness 0.3 ior 1.5 } #end }
}
#declare Steel = texture {
  pigment { rgb <0.75, 0.74, 0.72> }
  finish { diffuse 0.1 reflection { 0.7 metallic } #ifdef (Retex) retex { metallic 1 roughness 0.2 } #end }
}
#declare Brass = texture {
  pigment { rgb <0.83, 0.61, 0.30> }
  finish { diffuse 0.2 reflection { 0.6 metallic } #ifdef (Retex) retex { metallic 1 roughness 0.5 } #end }
}
#declare Mirror = texture { pigment { rgb 0.95 } finish { diffuse 0 reflection { 0.92 } } }
#declare Table  = texture { pigment { rgb <0.34, 0.20, 0.11> } }
#declare Paint  = texture { pigment { rgb <0.45, 0.47, 0.48> } }

box { <-7, -0.3, -4.5>, <7, 0, 4.4> texture { Table } }
plane { z, 0 inverse translate 4.5 * z texture { Paint } }
background { rgb <0.30, 0.32, 0.35> }

union {
  sphere { 0, 1.7 texture { Globe } rotate y * 90 rotate z * -23.4 }
  union {
    torus { 1.85, 0.06 rotate x * 90 }
    cylinder { <0, -1.95, 0>, <0, -1.80, 0>, 0.10 }
    cone { <0, -2.25, 0>, 0.9, <0, -1.95, 0>, 0.18 }
    texture { Brass }
  }
  translate <-1.15, 2.25, 0.2>
}
sphere { <1.75, 1.05, -0.9>, 1.05 texture { Steel } }

// The mirror leans on the wall and shows the globe's back.
union {
  box { <-1.9, 0, 0>, <1.9, 4.6, 0.08> texture { Mirror } }
  box { <-2.05, 0, 0.02>, <2.05, 4.75, 0.1> texture { Table } }
  rotate x * 6
  rotate y * 16
  translate <2.1, 0, 3.0>
}

#declare Lamp_Radiance = <5.6, 5.2, 4.6>;
#declare Lamp_Place = transform { rotate x * -25 rotate z * 24 translate <-4.5, 9, -4> }
object {
  polygon { 5, <-3, 0, -3>, <3, 0, -3>, <3, 0, 3>, <-3, 0, 3>, <-3, 0, -3> }
  texture { pigment { rgb 1 } finish { emission Lamp_Radiance diffuse 0 } }
  transform { Lamp_Place }
}
#ifndef (Retex)
  light_source {
    <0, -0.05, 0>
    rgb Lamp_Radiance * pow(6, 2) / (2 * pi)
    fade_distance 1 fade_power 2
    area_light 6 * x, 6 * z, 5, 5 adaptive 1 jitter
    transform { Lamp_Place }
  }
#end
