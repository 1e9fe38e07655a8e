// Glass on a floor of marble tiles, and a mirror: the floor is seen directly, through glass, in the mirror, and in the
// caustics that the lamp throws on it. Target: Floor.
//
//   retex-render glass-caustics.pov -t floor -o glass-caustics.exr
//   povray glass-caustics.pov +W400 +H300     (in this folder, so that textures/ is found)
//
// One unit is a decimetre. x to the right, y up, z into the picture.

#version 3.7;

global_settings {
  assumed_gamma 1
  max_trace_level 12
  radiosity { pretrace_start 0.08 pretrace_end 0.01 count 150 error_bound 0.5 recursion_limit 2 nearest_count 8 }
  #ifndef (Retex) photons { count 200000 max_trace_level 12 } #end
}
#default { finish { ambient 0 diffuse 1 } }

camera {
  location <0.3, 4.6, -9.2>
  right x * 4/3
  up y
  angle 40
  look_at <0.2, 0.85, 0.35>
}

// ---- materials ----

// Sixteen tiles a repeat, four by four; a tile is ten centimetres.
#declare Floor = texture {
  pigment {
    image_map { jpeg "textures/marble-tiles.jpg" interpolate 2 }
    rotate x * 90
    scale 4
    rotate y * 27
  }
  finish {
    diffuse 0.9
    #ifdef (Retex) retex { metallic 0 roughness 0.25 ior 1.5 } #end
  }
}

#declare Wall_Paint = texture { pigment { rgb <0.50, 0.53, 0.55> } }

#declare Glass_Finish = finish { diffuse 0 reflection { 0, 1 fresnel on } conserve_energy }
#declare Clear_Glass = material {
  texture { pigment { rgbt 1 } finish { Glass_Finish } }
  interior { ior 1.5 }
}
#declare Amber_Glass = material {
  texture { pigment { rgbf <1.0, 0.72, 0.28, 1> } finish { Glass_Finish } }
  interior { ior 1.5 }
}
// Thick panes are green from the iron in them: what passes fades with the way it goes.
#declare Pane_Glass = material {
  texture { pigment { rgbt 1 } finish { Glass_Finish } }
  interior { ior 1.52 fade_power 1001 fade_distance 1.4 fade_color rgb <0.55, 0.93, 0.84> }
}
#declare Mirror = texture { pigment { rgb 0.95 } finish { diffuse 0 reflection { 0.93 } } }
#declare Brass = texture {
  pigment { rgb <0.89, 0.66, 0.31> }
  finish {
    diffuse 0.1 reflection { 0.8 metallic } metallic
    #ifdef (Retex) retex { metallic 1 roughness 0.3 } #end
  }
}
#declare Frame_Wood = texture { pigment { rgb <0.10, 0.055, 0.03> } }

// What POV-Ray's photons need to know of glass.
#macro Glass_Photons()
  #ifndef (Retex) photons { target reflection on refraction on } #end
#end

// ---- a body of revolution ----

// A point on the curve through the control points Points[0..Last] (Catmull and Rom's), at T from 0 to Last.
#macro Curve(Points, Last, T)
  #local I = min(floor(T), Last - 1);
  #local S = T - I;
  #local P_0 = Points[max(I - 1, 0)];
  #local P_1 = Points[I];
  #local P_2 = Points[I + 1];
  #local P_3 = Points[min(I + 2, Last)];
  (0.5 * (2 * P_1 + (P_2 - P_0) * S + (2 * P_0 - 5 * P_1 + 4 * P_2 - P_3) * S * S
    + (3 * P_1 - P_0 - 3 * P_2 + P_3) * S * S * S))
#end

// A closed mesh about the y axis. Points are <radius, height>, from the axis below, up the outside, over the rim and down
// the inside to the axis: so the normals look out of the glass. Steps a control point, Sides about.
#macro Lathe(Points, Steps, Sides)
  #local Last = dimension_size(Points, 1) - 1;
  #local Rings = Last * Steps;
  mesh2 {
    vertex_vectors {
      (Rings + 1) * Sides
      #for (K, 0, Rings)
        #local P = Curve(Points, Last, K / Steps);
        #local R = (K = 0 | K = Rings ? 0 : max(P.u, 0.0001));
        #for (A, 0, Sides - 1)
          #local Turn = 2 * pi * A / Sides;
          <R * cos(Turn), P.v, R * sin(Turn)>
        #end
      #end
    }
    normal_vectors {
      (Rings + 1) * Sides
      #for (K, 0, Rings)
        #local Along = Curve(Points, Last, min(K / Steps + 0.02, Last)) - Curve(Points, Last, max(K / Steps - 0.02, 0));
        #local Out = vnormalize(<Along.v, -Along.u, 0>);
        #if (K = 0) #local Out = -y; #end
        #if (K = Rings) #local Out = y; #end
        #for (A, 0, Sides - 1)
          #local Turn = 2 * pi * A / Sides;
          <Out.x * cos(Turn), Out.y, Out.x * sin(Turn)>
        #end
      #end
    }
    face_indices {
      (2 * Rings - 2) * Sides
      #for (K, 0, Rings - 1)
        #for (A, 0, Sides - 1)
          #local B = mod(A + 1, Sides);
          #if (K > 0) <K * Sides + A, (K + 1) * Sides + A, K * Sides + B> #end
          #if (K < Rings - 1) <K * Sides + B, (K + 1) * Sides + A, (K + 1) * Sides + B> #end
        #end
      #end
    }
    inside_vector y
  }
#end

// ---- the room ----

plane { y, 0 texture { Floor } }
plane { z, 0 inverse translate 5.4 * z texture { Wall_Paint } }

// The skirting board.
box { <-40, 0, 5.28>, <40, 0.7, 5.4> texture { pigment { rgb 0.75 } } }

// Dim light from all about, brighter from above.
sky_sphere {
  pigment {
    gradient y
    color_map { [0 rgb <0.20, 0.21, 0.23>] [0.35 rgb <0.32, 0.34, 0.38>] [1 rgb <0.40, 0.43, 0.48>] }
  }
}

// The lamp: a panel above, to the left and behind. Large, for a path that leaves the floor through glass must find it.
#declare Lamp_Radiance = <7.6, 6.8, 5.6>;
#declare Lamp = texture { pigment { rgb 1 } finish { emission Lamp_Radiance diffuse 0 } }
#declare Lamp_Half = 3.4;
#declare Lamp_Place = transform { rotate x * 22 rotate z * 28 translate <-6.5, 11, 2.2> }
object {
  polygon {
    5, <-Lamp_Half, 0, -Lamp_Half>, <Lamp_Half, 0, -Lamp_Half>, <Lamp_Half, 0, Lamp_Half>, <-Lamp_Half, 0, Lamp_Half>,
    <-Lamp_Half, 0, -Lamp_Half>
  }
  texture { Lamp }
  transform { Lamp_Place }
  #ifndef (Retex) no_shadow no_radiosity #end
}
#ifndef (Retex) // POV-Ray's stand-in for it, of the same power; see the Cornell box
  light_source {
    <0, -0.05, 0>
    rgb Lamp_Radiance * pow(2 * Lamp_Half, 2) / (2 * pi)
    fade_distance 1 fade_power 2
    area_light 2 * Lamp_Half * x, 2 * Lamp_Half * z, 5, 5 adaptive 1 jitter
    photons { reflection on refraction on area_light }
    transform { Lamp_Place }
  }
#end

// ---- what stands on the floor ----

sphere { <0, 0, 0>, 1.05 material { Clear_Glass } translate <-1.75, 1.05, 0.55> Glass_Photons() }

#declare Wine_Profile = array[24] {
  <0.00, 0.00>, <0.45, 0.00>, <0.80, 0.02>, <0.84, 0.06>, <0.70, 0.11>, <0.30, 0.20>, <0.11, 0.36>, <0.085, 0.80>,
  <0.10, 1.30>, <0.30, 1.52>, <0.66, 1.78>, <0.87, 2.20>, <0.86, 2.70>, <0.72, 3.18>, <0.695, 3.215>, <0.67, 3.18>,
  <0.80, 2.70>, <0.81, 2.20>, <0.61, 1.84>, <0.42, 1.70>, <0.26, 1.62>, <0.14, 1.58>, <0.06, 1.565>, <0.00, 1.56>
}
object { Lathe(Wine_Profile, 4, 64) material { Clear_Glass } translate <1.25, 0.002, 0.55> Glass_Photons() }

box { <-0.9, 0, -0.28>, <0.9, 1.15, 0.28> material { Pane_Glass } rotate y * -24 translate <2.75, 0.002, -0.35> Glass_Photons() }

torus { 0.62, 0.24 material { Amber_Glass } translate <-0.15, 0.242, -1.55> Glass_Photons() }

// A solid cone, cut flat above.
cone { <0, 0, 0>, 0.55, <0, 0.95, 0>, 0.2 material { Clear_Glass } translate <1.6, 0.002, -2.1> Glass_Photons() }

sphere { <0, 0, 0>, 0.38 texture { Brass } translate <-0.35, 0.38, 1.75> }

// The mirror leans against the wall.
union {
  box { <-2.6, 0.15, 0>, <2.6, 3.35, 0.06> texture { Mirror } }
  box { <-2.75, 0, -0.06>, <2.75, 0.15, 0.1> }
  box { <-2.75, 3.35, -0.06>, <2.75, 3.5, 0.1> }
  box { <-2.75, 0.15, -0.06>, <-2.6, 3.35, 0.1> }
  box { <2.6, 0.15, -0.06>, <2.75, 3.35, 0.1> }
  texture { Frame_Wood }
  rotate x * 2
  translate <0.6, 0.02, 5.0>
}
