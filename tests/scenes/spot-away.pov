// A wide spotlight over a Lambertian plane that shines away from it: nothing is lit.
//
// size 65x65  spp 16  tolerance 1e-6 absolute
// expect 32,32 0 0 0
// expect 10,32 0 0 0
// expect 50,50 0 0 0

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 5, 0> direction -y right 4 * x up 4 * z }

plane { y, 0 pigment { rgb 1 } }
light_source { <0.5, 1.5, -0.25> rgb 1 spotlight radius 60 falloff 80 tightness 0 point_at <0.5, 3, -0.25> }
