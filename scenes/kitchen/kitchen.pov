// A modern kitchen by day, its lamps lit. Targets: Floor, Wall (the tiled wall behind hob and sink).
//
//   retex-render kitchen.pov -t floor -t wall -o kitchen.exr
//   povray kitchen.pov +W640 +H480        (in this folder, so that the .inc files and textures/ are found)
//
// One unit is a metre. x to the right, y up, z into the picture; the window is in the left wall.

#version 3.7;

global_settings {
  assumed_gamma 1
  max_trace_level 12
  radiosity { pretrace_start 0.08 pretrace_end 0.01 count 250 error_bound 0.5 recursion_limit 3 nearest_count 8 }
}
#default { finish { ambient 0 diffuse 1 } }

#include "shapes.inc"

camera {
  location <-1.50, 1.46, -3.50>
  right x * 4/3
  up y
  angle 58
  look_at <0.20, 0.98, 1.5>
}

// ---- materials ----

// Two metres a repeat.
#declare Floor = texture {
  pigment {
    image_map { jpeg "textures/octagon-tiles.jpg" interpolate 2 }
    rotate x * 90
    scale 2
    translate <0.12, 0, 0.1>
  }
  finish {
    diffuse 0.92 reflection { 0, 0.3 fresnel on }
    #ifdef (Retex) retex { metallic 0 roughness 0.3 ior 1.5 } #end
  }
}
// One metre a repeat, by the wall's own coordinates.
#declare Wall = texture {
  pigment {
    uv_mapping
    image_map { jpeg "textures/zellige.jpg" interpolate 2 }
  }
  finish {
    diffuse 0.92 reflection { 0, 0.4 fresnel on }
    #ifdef (Retex) retex { metallic 0 roughness 0.25 ior 1.5 } #end
  }
}

#declare Paint = texture { pigment { rgb <0.76, 0.74, 0.70> } }
#macro Lacquer(Color, Rough)
  texture {
    pigment { rgb Color }
    finish { diffuse 0.95 #ifdef (Retex) retex { roughness Rough ior 1.5 } #end }
  }
#end
#macro Glazed(Color)
  texture {
    pigment { rgb Color }
    finish { diffuse 0.9 reflection { 0, 0.6 fresnel on } #ifdef (Retex) retex { roughness 0.14 ior 1.5 } #end }
  }
#end
#macro Metal(Color, Rough)
  texture {
    pigment { rgb Color }
    finish { diffuse 0.2 reflection { 0.65 metallic } #ifdef (Retex) retex { metallic 1 roughness Rough } #end }
  }
#end
#declare Cabinet = Lacquer(<0.66, 0.645, 0.61>, 0.4)
#declare Oak     = Lacquer(<0.47, 0.30, 0.16>, 0.45)
#declare Walnut  = Lacquer(<0.22, 0.115, 0.06>, 0.4)
#declare Quartz  = Lacquer(<0.70, 0.69, 0.67>, 0.4)
#declare Black   = Lacquer(<0.022, 0.022, 0.024>, 0.35)
#declare Black_Glass = Lacquer(<0.012, 0.012, 0.013>, 0.08)
#declare Steel   = Metal(<0.66, 0.66, 0.65>, 0.28)
#declare Polished_Steel = Metal(<0.72, 0.71, 0.69>, 0.22)
#declare Brass   = Metal(<0.83, 0.61, 0.30>, 0.3)
#declare Copper  = Metal(<0.90, 0.50, 0.33>, 0.22)
#declare Chrome  = texture { pigment { rgb 0.9 } finish { diffuse 0 reflection { 0.88 } } }
#declare Glass_Finish = finish { diffuse 0 reflection { 0, 1 fresnel on } conserve_energy }
#declare Glass = material {
  texture { pigment { rgbt 1 } finish { Glass_Finish } }
  interior { ior 1.5 }
}
#declare Bottle_Glass = material {
  texture { pigment { rgbf <0.62, 0.86, 0.55, 1> } finish { Glass_Finish } }
  interior { ior 1.5 }
}
#declare Amber_Glass = material {
  texture { pigment { rgbf <0.95, 0.66, 0.30, 1> } finish { Glass_Finish } }
  interior { ior 1.5 }
}
#declare Chance = seed(11);

// ---- the room: x -2.6..2.6, y 0..2.7, z -4.2..2.4 ----

#declare Left = -2.6; #declare Right = 2.6; #declare Front = -4.2; #declare Back = 2.4; #declare High = 2.7;

// A parallelogram from one corner along two edges.
#macro Panel(Corner, Edge_1, Edge_2)
  polygon { 5, Corner, Corner + Edge_1, Corner + Edge_1 + Edge_2, Corner + Edge_2, Corner }
#end

object { Panel(<Left, 0, Front>, (Back - Front) * z, (Right - Left) * x) texture { Floor } }

mesh2 {
  vertex_vectors { 4, <Left, 0, Back>, <Right, 0, Back>, <Right, High, Back>, <Left, High, Back> }
  uv_vectors { 4, <0, 0>, <Right - Left, 0>, <Right - Left, High>, <0, High> }
  face_indices { 2, <0, 2, 1>, <0, 3, 2> }
  uv_indices { 2, <0, 2, 1>, <0, 3, 2> }
  texture { Wall }
}

object { Panel(<Left, High, Front>, (Right - Left) * x, (Back - Front) * z) texture { pigment { rgb 0.82 } } }
object { Panel(<Right, 0, Front>, (Back - Front) * z, High * y) texture { Paint } }
object { Panel(<Left, 0, Front>, (Right - Left) * x, High * y) texture { Paint } }

// The window: the left wall is what remains about it.
#declare Sill = 0.92; #declare Lintel = 2.30;
#declare Window_From = -0.55; #declare Window_To = 1.60;
#declare Reveal = 0.12;
union {
  object { Panel(<Left, 0, Front>, (Back - Front) * z, Sill * y) }
  object { Panel(<Left, Lintel, Front>, (Back - Front) * z, (High - Lintel) * y) }
  object { Panel(<Left, Sill, Front>, (Window_From - Front) * z, (Lintel - Sill) * y) }
  object { Panel(<Left, Sill, Window_To>, (Back - Window_To) * z, (Lintel - Sill) * y) }
  texture { Paint }
}
union { // reveals, frame and bars
  object { Panel(<Left, Sill, Window_From>, -Reveal * x, (Window_To - Window_From) * z) }
  object { Panel(<Left, Lintel, Window_From>, -Reveal * x, (Window_To - Window_From) * z) }
  object { Panel(<Left, Sill, Window_From>, -Reveal * x, (Lintel - Sill) * y) }
  object { Panel(<Left, Sill, Window_To>, -Reveal * x, (Lintel - Sill) * y) }
  box { <Left - 0.02, Sill - 0.03, Window_From - 0.05>, <Left + 0.14, Sill, Window_To + 0.05> }
  #declare Outside = Left - Reveal + 0.001;
  #for (I, 0, 2)
    #declare At = Window_From + 0.025 + (Window_To - Window_From - 0.05) * I / 2;
    box { <Outside, Sill, At - 0.025>, <Outside + 0.05, Lintel, At + 0.025> }
  #end
  #for (I, 0, 1)
    #declare At = Sill + 0.025 + (Lintel - Sill - 0.05) * I;
    box { <Outside, At - 0.025, Window_From>, <Outside + 0.05, At + 0.025, Window_To> }
  #end
  Lacquer(<0.78, 0.78, 0.77>, 0.4)
}

// The sky is a panel in the opening, which lets the sun pass: that is a light of its own.
#declare Sky_Radiance = <3.5, 3.9, 4.4>;
#declare Daylight = texture { pigment { rgb 1 } finish { emission Sky_Radiance diffuse 0 } }
object {
  Panel(<Left - Reveal, Sill, Window_From>, (Lintel - Sill) * y, (Window_To - Window_From) * z)
  texture { Daylight }
  no_shadow
  #ifndef (Retex) no_radiosity #end
}
#declare Sun = light_source {
  <-30, 25, -7>
  rgb <2.0, 1.75, 1.38>
  area_light 0.35 * z, vnormalize(<25, 30, 0>) * 0.35, 4, 4 adaptive 1 area_illumination on
  // Far enough to be parallel; a cone just wider than the window: so that no light is looked for where none can come.
  spotlight point_at <Left, (Sill + Lintel) / 2, (Window_From + Window_To) / 2> radius 1.75 falloff 1.9 tightness 0
}
light_source { Sun }
#ifndef (Retex) // POV-Ray's stand-in for the sky's panel, of about the same power, on the room's side of the bars
  light_source {
    <Left - 0.04, (Sill + Lintel) / 2, (Window_From + Window_To) / 2>
    rgb Sky_Radiance * (Window_To - Window_From) * (Lintel - Sill) / (2 * pi * 0.25)
    fade_distance 0.5 fade_power 2
    area_light (Lintel - Sill) * y, (Window_To - Window_From) * z, 5, 5 adaptive 1 jitter area_illumination on
  }
#end

// A glass door behind the camera, where a garden takes some of the light.
#declare Garden_Radiance = <1.7, 1.85, 1.8>;
#declare Garden = texture { pigment { rgb 1 } finish { emission Garden_Radiance diffuse 0 } }
object {
  Panel(<-0.9, 0.05, Front + 0.001>, 2.6 * x, 2.2 * y)
  texture { Garden }
  #ifndef (Retex) no_radiosity #end
}
#ifndef (Retex)
  light_source {
    <0.4, 1.15, Front + 0.01>
    rgb Garden_Radiance * 2.6 * 2.2 / (2 * pi * 0.25)
    fade_distance 0.5 fade_power 2
    area_light 2.6 * x, 2.2 * y, 5, 5 adaptive 1 jitter area_illumination on
  }
#end

#include "cabinets.inc"
#include "things.inc"
#include "table.inc"
