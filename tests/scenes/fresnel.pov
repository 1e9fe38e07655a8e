// Reflection of a white sky in smooth glass.
//
// Camera: looking straight down from height 2 with right = up = 4 at distance 2, so pixels see the plane where the other scenes do.
// Below the surface all is black. cos a = 2 / sqrt(x^2 + z^2 + 4), and L = F(a) of ior 1.5, the mean of both polarisations.
//
// size 65x65  spp 256  tolerance 5e-3 absolute
// expect 32,32 0.04 0.04 0.04
// expect 10,32 0.0427111 0.0427111 0.0427111
// expect 50,50 0.0445286 0.0445286 0.0445286
// expect 0,0 0.0677138 0.0677138 0.0677138
// expect 64,20 0.0520174 0.0520174 0.0520174

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { location <0, 2, 0> direction -2 * y right 4 * x up 4 * z }

background { rgb 1 }
plane {
  y, 0
  pigment { rgbt 1 }
  finish { diffuse 0 reflection { 0, 1 fresnel on } conserve_energy }
  interior { ior 1.5 }
}
plane { y, -1 pigment { rgb 0 } finish { diffuse 0 } }
