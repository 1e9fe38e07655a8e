// A furnished room by day, with a lamp lit. Targets: Floor, Wall (the wall behind the sofa).
//
//   retex-render living-room.pov -t floor -t wall -o living-room.exr
//   povray living-room.pov +W640 +H360        (in this folder, so that shapes.inc and textures/ are found)
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
    texture { pigment { rgb 1 } finish { emission Sky_Radiance diffuse 0 } }
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
object {
  Panel(<-1.2, 0.3, Front + 0.001>, 2.8 * x, 2.1 * y)
  texture { pigment { rgb 1 } finish { emission Garden_Radiance diffuse 0 } }
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
  object { Curtain(0.42, 2.5, 5, 0.035) translate <Left + 0.16, 2.55, Window_At[1] - 0.38> }
  object { Curtain(0.42, 2.5, 5, 0.035) translate <Left + 0.16, 2.55, Window_At[1] + Window_Width - 0.04> }
  texture { Curtain_Cloth }
}
cylinder { <Left + 0.16, 2.57, Front + 0.1>, <Left + 0.16, 2.57, Back - 0.2>, 0.014 texture { Brass } }

// ---- the sofa ----

#macro Sofa(Width, Seats)
  #local Inner = Width - 0.44;
  union {
    union {
      object { Cushion(<Width / 2 - 0.04, 0.13, 0.44>, 0.15, 0.12) translate 0.22 * y }
      object { Cushion(<Width / 2 - 0.03, 0.34, 0.13>, 0.35, 0.3) translate <0, 0.47, 0.36> }
      #for (Side, -1, 1, 2)
        object { Cushion(<0.11, 0.25, 0.45>, 0.45, 0.3) translate <Side * (Width / 2 - 0.11), 0.37, 0> }
      #end
      #for (I, 0, Seats - 1)
        #local Middle = (I + 0.5) * Inner / Seats - Inner / 2;
        object { Cushion(<Inner / Seats / 2 + 0.005, 0.09, 0.38>, 0.45, 0.22) translate <Middle, 0.41, -0.07> }
        object { Cushion(<Inner / Seats / 2 - 0.005, 0.20, 0.11>, 0.6, 0.5) rotate x * 13 translate <Middle, 0.66, 0.20> }
      #end
      Fabric(Sofa_Color)
    }
    #for (Side_X, -1, 1, 2)
      #for (Side_Z, -1, 1, 2)
        cone { <Side_X * (Width / 2 - 0.12), 0, Side_Z * 0.34>, 0.016, <Side_X * (Width / 2 - 0.14), 0.12, Side_Z * 0.32>, 0.028 }
      #end
    #end
    Varnished(Walnut)
  }
#end

// A thrown cushion: pinched at the edges, standing on one.
#macro Throw(Color, Size)
  object { Cushion(<Size / 2, 0.085, Size / 2>, 1.15, 0.38) rotate x * -90 Fabric(Color) }
#end

union {
  object { Sofa(2.3, 3) }
  object { Throw(<0.62, 0.38, 0.08>, 0.46) rotate <16, -14, 6> translate <-0.72, 0.70, 0.03> }
  object { Throw(<0.08, 0.24, 0.26>, 0.42) rotate <20, 22, -5> translate <-0.46, 0.67, -0.07> }
  object { Throw(<0.52, 0.16, 0.09>, 0.45) rotate <15, 16, -7> translate <0.76, 0.70, 0.03> }
  translate <-0.25, 0, 1.98>
}

// The armchair, turned to the table.
object { Sofa(1.02, 1) rotate y * 68 translate <1.62, 0, 0.42> }

// ---- the rug and the table ----

#declare Rug_Size = <2.4, 0.012, 1.6>;
box {
  <0, 0, 0>, <1, 1, 1>
  texture { pigment { image_map { jpeg "textures/rug.jpg" interpolate 2 } rotate x * 90 } }
  scale Rug_Size
  translate -Rug_Size * <0.5, 0, 0.5>
  rotate y * -3
  translate <-0.15, 0, 0.55>
}

#declare Table_High = 0.42;
#declare Table = union {
  object { Cushion(<0.62, 0.018, 0.34>, 0.15, 0.12) translate (Table_High - 0.018) * y }
  box { <-0.50, 0.13, -0.24>, <0.50, 0.15, 0.24> }
  #for (Side_X, -1, 1, 2)
    #for (Side_Z, -1, 1, 2)
      cone { <Side_X * 0.55, 0, Side_Z * 0.28>, 0.014, <Side_X * 0.50, Table_High - 0.03, Side_Z * 0.24>, 0.026 }
    #end
  #end
  Varnished(Oak)
}

// Glasses: outside, rim and inside in one profile, so that the glass has its thickness.
#declare Carafe = Lathe(array[18] {
  <0, 0>, <0.040, 0>, <0.062, 0.004>, <0.074, 0.025>, <0.076, 0.060>, <0.064, 0.115>, <0.040, 0.160>, <0.031, 0.195>,
  <0.038, 0.240>, <0.0365, 0.242>, <0.035, 0.240>, <0.028, 0.195>, <0.037, 0.159>, <0.061, 0.114>, <0.073, 0.060>,
  <0.070, 0.027>, <0.058, 0.010>, <0, 0.008> }, 4, 48)
#declare Tumbler = Lathe(array[13] {
  <0, 0>, <0.022, 0>, <0.029, 0.002>, <0.032, 0.012>, <0.035, 0.050>, <0.039, 0.098>, <0.038, 0.100>, <0.037, 0.098>,
  <0.033, 0.050>, <0.0305, 0.020>, <0.027, 0.012>, <0.018, 0.010>, <0, 0.010> }, 4, 40)
#declare Bowl = Lathe(array[12] {
  <0, 0>, <0.045, 0>, <0.055, 0.004>, <0.060, 0.014>, <0.105, 0.048>, <0.128, 0.080>, <0.126, 0.082>, <0.123, 0.080>,
  <0.100, 0.051>, <0.055, 0.020>, <0.03, 0.016>, <0, 0.016> }, 4, 48)
#declare Vase = Lathe(array[14] {
  <0, 0>, <0.050, 0>, <0.062, 0.006>, <0.085, 0.060>, <0.098, 0.120>, <0.080, 0.190>, <0.042, 0.250>, <0.048, 0.290>,
  <0.045, 0.292>, <0.040, 0.288>, <0.036, 0.250>, <0.074, 0.188>, <0.080, 0.060>, <0, 0.012> }, 4, 48)

union {
  object { Table }
  union {
    object { Carafe material { Blue_Glass } scale 1.25 translate <-0.30, 0, 0.08> }
    object { Tumbler material { Glass } scale 1.15 translate <-0.12, 0, -0.05> }
    object { Tumbler material { Glass } scale 1.15 translate <-0.36, 0, -0.15> }
    object { Bowl Glazed(<0.72, 0.70, 0.64>) translate <0.14, 0, 0.07> }
    sphere { <0.115, 0.063, 0.075>, 0.037 Glazed(<0.72, 0.26, 0.03>) }
    sphere { <0.185, 0.062, 0.055>, 0.035 Glazed(<0.66, 0.30, 0.03>) }
    sphere { <0.150, 0.066, 0.125>, 0.036 Glazed(<0.50, 0.46, 0.06>) }
    box { <-0.12, 0, -0.085>, <0.12, 0.028, 0.085> Varnished(<0.09, 0.16, 0.24>) rotate y * 17 translate <0.40, 0, -0.06> }
    box { <-0.105, 0.028, -0.075>, <0.105, 0.050, 0.075> Varnished(<0.55, 0.20, 0.11>) rotate y * 5 translate <0.40, 0, -0.06> }
    translate (Table_High + 0.0005) * y
  }
  rotate y * -4
  translate <-0.22, 0.012, 0.62>
}

// ---- the lamp ----

#declare Lamp_Radiance = <15, 10, 5.4>;
#declare Shade_Radiance = <1.7, 1.15, 0.64>;
union {
  cylinder { <0, 0, 0>, <0, 0.022, 0>, 0.15 texture { Brass } }
  cylinder { <0, 0.022, 0>, <0, 1.42, 0>, 0.011 texture { Brass } }
  sphere {
    <0, 1.50, 0>, 0.1
    texture { pigment { rgb 1 } finish { emission Lamp_Radiance diffuse 0 } }
    #ifndef (Retex) no_shadow no_radiosity #end
  }
  cone { // the shade glows with what comes through it
    <0, 1.36, 0>, 0.23, <0, 1.68, 0>, 0.155 open
    texture { pigment { rgb <0.80, 0.74, 0.62> } finish { diffuse 0.6 emission Shade_Radiance } }
  }
  torus { 0.23, 0.005 texture { Brass } translate 1.36 * y }
  torus { 0.155, 0.005 texture { Brass } translate 1.68 * y }
  #ifndef (Retex)
    light_source {
      <0, 1.5, 0> rgb Lamp_Radiance * pi * pow(0.1, 2) / (2 * pi * 0.0025) fade_distance 0.05 fade_power 2
    }
  #end
  translate <1.22, 0, 2.12>
}

// ---- the bookshelf ----

#declare Shelf_Width = 1.15; #declare Shelf_High = 2.05; #declare Shelf_Deep = 0.32; #declare Shelves = 5;
#declare Book_Colors = array[10] {
  <0.42, 0.09, 0.07>, <0.08, 0.15, 0.28>, <0.62, 0.52, 0.36>, <0.10, 0.22, 0.15>, <0.68, 0.42, 0.10>,
  <0.24, 0.10, 0.16>, <0.55, 0.55, 0.52>, <0.10, 0.10, 0.11>, <0.16, 0.32, 0.36>, <0.60, 0.28, 0.16>
}
#declare Chance = seed(7);

// Books from X to End, each as wide, high and deep as chance has it; the last may lean.
#macro Books(X, End, Room)
  #local At = X;
  #while (At < End - 0.05)
    #local Thick = 0.018 + 0.030 * rand(Chance);
    #local Tall = Room * (0.66 + 0.26 * rand(Chance));
    #local Deep = 0.17 + 0.07 * rand(Chance);
    #local Color = Book_Colors[floor(9.999 * rand(Chance))] * (0.75 + 0.5 * rand(Chance));
    box { <0, 0, -Deep>, <Thick, Tall, 0> Varnished(Color) translate <At, 0, Shelf_Deep - 0.03> }
    #local At = At + Thick + 0.001 + 0.002 * rand(Chance);
  #end
#end

#declare Bookshelf = union {
  box { <0, 0, 0>, <0.025, Shelf_High, Shelf_Deep> }
  box { <Shelf_Width - 0.025, 0, 0>, <Shelf_Width, Shelf_High, Shelf_Deep> }
  box { <0.025, 0.06, Shelf_Deep - 0.012>, <Shelf_Width - 0.025, Shelf_High, Shelf_Deep> }
  box { <0.025, 0, 0.03>, <Shelf_Width - 0.025, 0.06, 0.05> }
  #for (I, 0, Shelves)
    #declare Y = 0.06 + (Shelf_High - 0.085) * I / Shelves;
    box { <0.025, Y, 0>, <Shelf_Width - 0.025, Y + 0.025, Shelf_Deep - 0.012> }
  #end
  #declare Room = (Shelf_High - 0.085) / Shelves - 0.025;
  #for (I, 0, Shelves - 1)
    union {
      #switch (I)
        #case (0) Books(0.03, 1.10, Room) #break
        #case (1) Books(0.03, 0.62, Room) object { Bowl Glazed(<0.10, 0.24, 0.30>) scale 1.1 translate <0.86, 0, 0.15> } #break
        #case (2) Books(0.42, 1.11, Room) object { Vase Glazed(<0.58, 0.22, 0.12>) scale 0.95 translate <0.21, 0, 0.16> } #break
        #case (3) Books(0.03, 0.80, Room) sphere { <0.96, 0.11, 0.15>, 0.11 texture { Brass } } #break
        #else Books(0.25, 0.95, Room)
      #end
      translate (0.085 + (Shelf_High - 0.085) * I / Shelves) * y
    }
  #end
  Varnished(Walnut)
}
object { Bookshelf translate <1.68, 0, Back - 0.02 - Shelf_Deep> }

// ---- on the walls ----

// A frame of four strips about Width by Height, of the given thickness, facing -z.
#macro Frame(Width, Height, Strip, Deep)
  union {
    box { <-Width / 2 - Strip, -Height / 2 - Strip, -Deep>, <Width / 2 + Strip, -Height / 2, 0> }
    box { <-Width / 2 - Strip, Height / 2, -Deep>, <Width / 2 + Strip, Height / 2 + Strip, 0> }
    box { <-Width / 2 - Strip, -Height / 2, -Deep>, <-Width / 2, Height / 2, 0> }
    box { <Width / 2, -Height / 2, -Deep>, <Width / 2 + Strip, Height / 2, 0> }
  }
#end

// The painting over the sofa, in a white mount.
union {
  box {
    <0, 0, 0>, <1, 1, 1>
    texture { pigment { image_map { jpeg "textures/painting.jpg" interpolate 2 } } }
    translate <-0.5, -0.5, 0> scale <0.88, 0.66, 0.008> translate -0.020 * z
  }
  box { <-0.53, -0.42, -0.014>, <0.53, 0.42, 0> texture { pigment { rgb 0.80 } } }
  object { Frame(1.06, 0.84, 0.025, 0.035) Varnished(Walnut * 0.5) }
  translate <-0.55, 1.72, Back - 0.001>
}

// A tall mirror on the right wall.
union {
  box { <-0.38, -0.85, -0.012>, <0.38, 0.85, 0> texture { Mirror } }
  object { Frame(0.76, 1.70, 0.035, 0.030) texture { Brass } }
  rotate y * 90
  translate <Right - 0.001, 1.12, 1.25>
}

// ---- the plant in the corner ----

#declare Pot = Lathe(array[11] {
  <0, 0>, <0.12, 0>, <0.14, 0.01>, <0.17, 0.18>, <0.19, 0.34>, <0.185, 0.35>, <0.175, 0.34>, <0.165, 0.31>, <0.12, 0.30>,
  <0.05, 0.30>, <0, 0.30> }, 3, 40)
union {
  object { Pot Glazed(<0.62, 0.60, 0.56>) }
  cylinder { <0, 0.28, 0>, <0, 0.312, 0>, 0.163 texture { pigment { rgb <0.05, 0.035, 0.025> } } }
  #for (I, 0, 37)
    #declare Up = I / 37;
    #declare Stem = 0.32 + 0.75 * Up;
    object {
      Leaf(0.42 - 0.14 * Up + 0.10 * rand(Chance), 0.105 + 0.04 * rand(Chance), 25 + 50 * Up + 12 * rand(Chance), 75 + 45 * rand(Chance))
      texture {
        pigment { rgb <0.06, 0.17, 0.045> * (0.8 + 0.5 * rand(Chance)) }
        finish { #ifdef (Retex) retex { roughness 0.4 ior 1.45 } #end }
      }
      translate 0.02 * x
      rotate y * (137.5 * I)
      translate Stem * y
    }
  #end
  cylinder { <0, 0.30, 0>, <0, 1.08, 0>, 0.014 texture { pigment { rgb <0.16, 0.14, 0.06> } } }
  translate <-2.42, 0, 2.0>
}
