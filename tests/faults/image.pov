// A surface with an image, and a light source with a light distribution.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1, -3> look_at 0 }
light_source { <-2, 4, -3> rgb 1 retex { ies "lamp.ies" } point_at 0 }
plane { y, -1 pigment { image_map { png "t.png" } } }
sphere { 0, .7 pigment { rgb .7 } }
