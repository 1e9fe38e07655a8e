// The Cornell box with a tiled floor. Target: Floor.
//
//   retex-render cornell-box.pov -t floor -o cornell-box.exr
//   povray cornell-box.pov +W400 +H400        (in this folder, so that textures/ is found)
//
// One unit is a metre. x to the right, y up, z into the picture.

#version 3.7;

global_settings {
  assumed_gamma 1
  radiosity { pretrace_start 0.08 pretrace_end 0.01 count 200 error_bound 0.4 recursion_limit 4 nearest_count 8 }
}
#default { finish { ambient 0 diffuse 1 } }

// From above the middle, so that much of the floor shows, but looking straight ahead, so that upright edges stay upright:
// the picture is the box's open side and a little more.
#declare Eye = <0, 1.5, -4.1>;
camera {
  location Eye
  direction <0, 1, -1> - Eye
  right 2.04 * x
  up 2.04 * y
}

// ---- materials ----

#declare White = texture { pigment { rgb 0.73 } }
#declare Red   = texture { pigment { rgb <0.63, 0.06, 0.05> } }
#declare Green = texture { pigment { rgb <0.14, 0.45, 0.09> } }

// Eight tiles a repeat: six from wall to wall.
#declare Floor = texture {
  pigment {
    image_map { jpeg "textures/encaustic-tiles.jpg" interpolate 2 }
    rotate x * 90
    scale 8 / 3
    translate <-1, 0, -1>
  }
}

// ---- the box: x -1..1, y 0..2, z -1..1, open towards the camera ----

// A parallelogram from one corner along two edges.
#macro Panel(Corner, Edge_1, Edge_2)
  polygon { 5, Corner, Corner + Edge_1, Corner + Edge_1 + Edge_2, Corner + Edge_2, Corner }
#end

object { Panel(<-1, 0, -1>, 2 * z, 2 * x) texture { Floor } }
object { Panel(<-1, 0, 1>, 2 * y, 2 * x) texture { White } }
object { Panel(<-1, 0, -1>, 2 * y, 2 * z) texture { Red } }
object { Panel(<1, 0, -1>, 2 * z, 2 * y) texture { Green } }

// The ceiling leaves an opening that the lamp fills.
#declare Half = 0.3;
union {
  object { Panel(<-1, 2, -1>, 2 * x, (1 - Half) * z) }
  object { Panel(<-1, 2, Half>, 2 * x, (1 - Half) * z) }
  object { Panel(<-1, 2, -Half>, (1 - Half) * x, 2 * Half * z) }
  object { Panel(<Half, 2, -Half>, (1 - Half) * x, 2 * Half * z) }
  texture { White }
}

#declare Lamp_Radiance = <20, 17, 12.4>;
#declare Lamp = texture { pigment { rgb 1 } finish { emission Lamp_Radiance diffuse 0 } }
object {
  Panel(<-Half, 2, -Half>, 2 * Half * x, 2 * Half * z)
  texture { Lamp }
  #ifndef (Retex) no_radiosity #end
}

// POV-Ray's emitters light only through radiosity, which finds small ones badly: there an area light of the same power
// stands in. A renderer that samples emitters leaves it out.
#ifndef (Retex)
  #declare Fade = 0.1;
  light_source {
    <0, 1.995, 0>
    rgb Lamp_Radiance * pow(2 * Half, 2) / (2 * pi * Fade * Fade)
    fade_distance Fade fade_power 2
    area_light 2 * Half * x, 2 * Half * z, 7, 7 adaptive 1 jitter area_illumination on
  }
#end

// ---- two blocks ----

box { <-0.28, 0, -0.28>, <0.28, 1.15, 0.28> texture { White } rotate y * 18 translate <-0.38, 0, 0.36> }
box { <-0.26, 0, -0.26>, <0.26, 0.5, 0.26> texture { White } rotate y * -20 translate <0.40, 0, -0.16> }
