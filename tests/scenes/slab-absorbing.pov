// A white sky below, seen through a tinted pane.
//
// Camera: looking straight down from height 2 with right = up = 4 at distance 2, so pixels see the plane where the other scenes do.
// fade_power 1001 is exponential: what passes a way s is t = exp(-(1 - fade_color) s / fade_distance), here s = 0.1 / cos b with
// b the angle inside; with all reflections between the faces L = (1 - R)^2 t / (1 - R^2 t^2).
//
// size 65x65  spp 256  tolerance 1e-2 absolute
// expect 32,32 0.755352 0.339111 0.18608
// expect 10,32 0.739533 0.311859 0.16329
// expect 50,50 0.734022 0.304875 0.157836
// expect 0,0 0.687101 0.264666 0.129601
// expect 64,20 0.716378 0.286882 0.144545

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { location <0, 2, 0> direction -2 * y right 4 * x up 4 * z }

sky_sphere { pigment { gradient y color_map { [0.5 rgb 1] [0.5 rgb 0] } scale 2 translate -y } }
box {
  <-1000, -0.1, -1000>, <1000, 0, 1000>
  pigment { rgbt 1 }
  finish { diffuse 0 reflection { 0, 1 fresnel on } conserve_energy }
  interior { ior 1.5 fade_power 1001 fade_distance 0.05 fade_color rgb <0.9, 0.5, 0.2> }
}
