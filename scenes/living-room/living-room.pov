// A furnished room by day, with a lamp lit. Targets: Floor, Wall (the wall behind the sofa).
//
//   retex-render living-room.pov -t floor -t wall -o living-room.exr
//   povray living-room.pov +W640 +H360        (in this folder, so that the .inc files and textures/ are found)
//
// One unit is a metre. x to the right, y up, z into the picture; the windows are in the left wall.

#version 3.7;

global_settings {
  assumed_gamma 1
  max_trace_level 12
  radiosity { pretrace_start 0.08 pretrace_end 0.01 count 250 error_bound 0.5 recursion_limit 3 nearest_count 8 }
}
#default { finish { ambient 0 diffuse 1 } }

#include "shapes.inc"

camera {
  location <-0.75, 1.32, -2.95>
  right x * 16/9
  up y
  angle 70
  look_at <-0.14, 0.86, 1>
}

// ---- materials ----

// Two metres a repeat; the boards run along z.
#declare Floor = texture {
  pigment {
    image_map { jpeg "textures/oak-planks.jpg" interpolate 2 }
    rotate x * 90
    scale 2
  }
  finish {
    diffuse 0.9 reflection { 0, 0.25 fresnel on }
    #ifdef (Retex) retex { metallic 0 roughness 0.35 ior 1.5 } #end
  }
}
// One metre a repeat, by the wall's own coordinates.
#declare Wall = texture {
  pigment {
    uv_mapping
    image_map { jpeg "textures/linen.jpg" interpolate 2 }
  }
}

#declare Paint   = texture { pigment { rgb <0.74, 0.72, 0.68> } }
#declare Ceiling = texture { pigment { rgb 0.80 } }
#declare Trim    = texture {
  pigment { rgb 0.78 }
  finish { #ifdef (Retex) retex { roughness 0.4 ior 1.5 } #end }
}
#macro Fabric(Color) texture { pigment { rgb Color } } #end
#macro Varnished(Color)
  texture {
    pigment { rgb Color }
    finish { diffuse 0.95 #ifdef (Retex) retex { roughness 0.35 ior 1.5 } #end }
  }
#end
#macro Glazed(Color)
  texture {
    pigment { rgb Color }
    finish { diffuse 0.9 reflection { 0, 0.6 fresnel on } #ifdef (Retex) retex { roughness 0.12 ior 1.5 } #end }
  }
#end
#declare Brass = texture {
  pigment { rgb <0.80, 0.58, 0.28> }
  finish { diffuse 0.2 reflection { 0.6 metallic } #ifdef (Retex) retex { metallic 1 roughness 0.35 } #end }
}
#declare Mirror = texture { pigment { rgb 0.95 } finish { diffuse 0 reflection { 0.92 } } }
#declare Glass = material {
  texture { pigment { rgbt 1 } finish { diffuse 0 reflection { 0, 1 fresnel on } conserve_energy } }
  interior { ior 1.5 }
}
#declare Blue_Glass = material {
  texture { pigment { rgbf <0.72, 0.90, 0.96, 1> } finish { diffuse 0 reflection { 0, 1 fresnel on } conserve_energy } }
  interior { ior 1.5 }
}
#declare Walnut = <0.20, 0.105, 0.055>;
#declare Oak    = <0.46, 0.30, 0.16>;
#declare Sofa_Color = <0.40, 0.41, 0.42>;

// ---- the room: x -3..3, y 0..2.8, z -4..2.6 ----

#declare Left = -3; #declare Right = 3; #declare Front = -4; #declare Back = 2.6; #declare High = 2.8;

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

object { Panel(<Left, High, Front>, (Right - Left) * x, (Back - Front) * z) texture { Ceiling } }
object { Panel(<Right, 0, Front>, (Back - Front) * z, High * y) texture { Paint } }
object { Panel(<Left, 0, Front>, (Right - Left) * x, High * y) texture { Paint } }

// Two windows: the left wall is what remains about them.
#declare Sill = 0.45; #declare Lintel = 2.35;
#declare Window_Width = 2.1;
#declare Window_At = array[2] { -3.35, -0.40 };
#declare Reveal = 0.10; // how deep the panes lie in the wall

union {
  object { Panel(<Left, 0, Front>, (Back - Front) * z, Sill * y) }
  object { Panel(<Left, Lintel, Front>, (Back - Front) * z, (High - Lintel) * y) }
  #declare From = Front;
  #for (I, 0, 1)
    object { Panel(<Left, Sill, From>, (Window_At[I] - From) * z, (Lintel - Sill) * y) }
    #declare From = Window_At[I] + Window_Width;
  #end
  object { Panel(<Left, Sill, From>, (Back - From) * z, (Lintel - Sill) * y) }
  texture { Paint }
}

#declare Sky_Radiance = <5.0, 5.6, 6.3>;
#declare Daylight = texture { pigment { rgb 1 } finish { emission Sky_Radiance diffuse 0 } }
#macro Window(Z)
  // Reveals, frame and glazing bars; behind them the bright sky.
  union {
    object { Panel(<Left, Sill, Z>, -Reveal * x, Window_Width * z) }
    object { Panel(<Left, Lintel, Z>, -Reveal * x, Window_Width * z) }
    object { Panel(<Left, Sill, Z>, -Reveal * x, (Lintel - Sill) * y) }
    object { Panel(<Left, Sill, Z + Window_Width>, -Reveal * x, (Lintel - Sill) * y) }
    box { <Left - 0.02, Sill - 0.04, Z - 0.06>, <Left + 0.10, Sill, Z + Window_Width + 0.06> }
    #local Outside = Left - Reveal + 0.001;
    #for (I, 0, 2)
      #local Bar = Z + 0.025 + (Window_Width - 0.05) * I / 2;
      box { <Outside, Sill, Bar - 0.025>, <Outside + 0.035, Lintel, Bar + 0.025> }
    #end
    #for (I, 0, 2)
      #local Bar = Sill + 0.025 + (Lintel - Sill - 0.05) * I / 2;
      box { <Outside, Bar - 0.025, Z>, <Outside + 0.035, Bar + 0.025, Z + Window_Width> }
    #end
    texture { Trim }
  }
  object {
    Panel(<Left - Reveal, Sill, Z>, (Lintel - Sill) * y, Window_Width * z)
    texture { Daylight }
    #ifndef (Retex) no_radiosity #end
  }
  #ifndef (Retex) // POV-Ray's stand-in for the panel, of about the same power, on the room's side of the bars
    light_source {
      <Left - 0.04, (Sill + Lintel) / 2, Z + Window_Width / 2>
      rgb Sky_Radiance * Window_Width * (Lintel - Sill) / (2 * pi * 0.25)
      fade_distance 0.5 fade_power 2
      area_light (Lintel - Sill) * y, Window_Width * z, 5, 5 adaptive 1 jitter area_illumination on
    }
  #end
#end
Window(Window_At[0])
Window(Window_At[1])

// A third behind the camera, where a garden takes some of the light.
#declare Garden_Radiance = <2.8, 3.1, 3.2>;
#declare Garden = texture { pigment { rgb 1 } finish { emission Garden_Radiance diffuse 0 } }
object {
  Panel(<-1.2, 0.3, Front + 0.001>, 2.8 * x, 2.1 * y)
  texture { Garden }
  #ifndef (Retex) no_radiosity #end
}
#ifndef (Retex)
  light_source {
    <0.2, 1.35, Front + 0.01>
    rgb Garden_Radiance * 2.8 * 2.1 / (2 * pi * 0.25)
    fade_distance 0.5 fade_power 2
    area_light 2.8 * x, 2.1 * y, 5, 5 adaptive 1 jitter area_illumination on
  }
#end

// Skirting boards.
#macro Skirting(From, To)
  box { From, To + 0.11 * y texture { Trim } }
#end
object { Skirting(<Left, 0, Back - 0.018>, <Right, 0, Back>) }
object { Skirting(<Right - 0.018, 0, Front>, <Right, 0, Back>) }
object { Skirting(<Left, 0, Front>, <Left + 0.018, 0, Back>) }

// Curtains at the window's ends, on a pole.
#declare Curtain_Cloth = Fabric(<0.70, 0.66, 0.58>)
union {
  object { Curtain(0.46, 2.5, 6, 0.042) translate <Left + 0.16, 2.53, Window_At[1] - 0.42> }
  object { Curtain(0.46, 2.5, 6, 0.042) translate <Left + 0.16, 2.53, Window_At[1] + Window_Width - 0.04> }
  texture { Curtain_Cloth }
}
union {
  cylinder { <0, 0, Front + 0.1>, <0, 0, Back - 0.2>, 0.014 }
  sphere { <0, 0, Back - 0.2>, 0.026 }
  #for (I, 0, 6)
    torus { 0.022, 0.003 rotate x * 90 translate <0, -0.008, Window_At[1] + Window_Width - 0.02 + 0.07 * I> }
  #end
  texture { Brass }
  translate <Left + 0.16, 2.57, 0>
}

#declare Chance = seed(7);
#include "furniture.inc"
#include "bookshelf.inc"
#include "plants.inc"
