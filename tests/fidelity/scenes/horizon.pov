// Paving to the horizon under a clear sky, a few things on it, one of them a mirror ball. Target: Ground.
//
//   retex-render horizon.pov -t ground -o horizon.exr
//   povray horizon.pov +W320 +H240        (in this folder, so that textures/ is found)
//
// One unit is a metre. x to the right, y up, z into the picture.

#version 3.7;

global_settings { assumed_gamma 1 max_trace_level 8 }
#default { finish { ambient 0 diffuse 1 } }

camera {
  location <0, 1.5, -7>
  right x * 4/3
  up y
  angle 50
  look_at <0, 1.15, 0>
}

// Four metres a repeat, along the ground as far as one sees.
#declare Ground = texture {
  pigment {
    image_map { jpeg "textures/ground.jpg" interpolate 2 }
    rotate x * 90
    scale 4
    rotate y * 11
  }
}
#declare Chalk  = texture { pigment { rgb <0.72, 0.68, 0.60> } }
#declare Clay   = texture { pigment { rgb <0.55, 0.20, 0.10> } }
#declare Mirror = texture { pigment { rgb 0.95 } finish { diffuse 0 reflection { 0.92 } } }

plane { y, 0 texture { Ground } }

sky_sphere {
  pigment {
    gradient y
    color_map { [0 rgb <0.62, 0.68, 0.74>] [0.25 rgb <0.36, 0.50, 0.72>] [1 rgb <0.16, 0.29, 0.58>] }
  }
}
light_source { <-60, 55, -40> rgb <1.7, 1.55, 1.3> parallel point_at <0, 0, 0> }

sphere { <0.95, 1.1, 0.4>, 1.1 texture { Mirror } }
box { <-0.55, 0, -0.55>, <0.55, 1.3, 0.55> texture { Chalk } rotate y * 32 translate <-1.9, 0, 0.6> }
cone { <0, 0, 0>, 0.5, <0, 1.2, 0>, 0 texture { Clay } translate <-0.75, 0, -1.9> }
#for (I, 0, 7) // a row of columns into the distance
  cylinder { <-4.5, 0, 0>, <-4.5, 3.2, 0>, 0.28 texture { Chalk } translate (6 + 7 * I) * z }
  cylinder { <5.5, 0, 0>, <5.5, 3.2, 0>, 0.28 texture { Chalk } translate (4 + 7 * I) * z }
#end
