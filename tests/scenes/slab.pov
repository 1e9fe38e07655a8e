// A white sky below, seen through a pane of glass.
//
// Camera: looking straight down from height 2 with right = up = 4 at distance 2, so pixels see the plane where the other scenes do.
// Above the horizon the sky is black. With R = F(a) at either face and all reflections between them, L = (1 - R) / (1 + R).
//
// size 65x65  spp 256  tolerance 1e-2 absolute
// expect 32,32 0.923077 0.923077 0.923077
// expect 10,32 0.918077 0.918077 0.918077
// expect 50,50 0.914739 0.914739 0.914739
// expect 0,0 0.873161 0.873161 0.873161
// expect 64,20 0.901109 0.901109 0.901109

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { location <0, 2, 0> direction -2 * y right 4 * x up 4 * z }

sky_sphere { pigment { gradient y color_map { [0.5 rgb 1] [0.5 rgb 0] } scale 2 translate -y } }
box {
  <-1000, -0.1, -1000>, <1000, 0, 1000>
  pigment { rgbt 1 }
  finish { diffuse 0 reflection { 0, 1 fresnel on } conserve_energy }
  interior { ior 1.5 }
}
