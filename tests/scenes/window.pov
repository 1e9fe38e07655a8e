// A point light over a Lambertian plane, behind a tinted pane.
//
// Camera: from above, orthographic, 4 by 4: pixel (i, j) of n by n sees x = 4 (i + 0.5) / n - 2, z = 2 - 4 (j + 0.5) / n.
// Light sources shine straight through glass, less what it reflects and what fades on the way: with a the angle off the normal,
// h = 1.5, L = albedo * c * cos a (1 - R)^2 t, R Fresnel's reflectance for a, and t = exp(-(1 - fade_color) 0.1 / cos a / 0.2).
// Angles run up to 62 degrees: what comes in through the one face goes out through the other, and is never totally reflected.
// The plane is dark, for what it sends to the pane comes back in part.
//
// size 65x65  spp 16  tolerance 5e-3 relative
// expect 32,32 0.701322 0.322984 0.074132
// expect 10,32 0.503889 0.216497 0.0471701
// expect 50,50 0.462796 0.19495 0.0418503
// expect 0,0 0.277661 0.10244 0.0199096
// expect 64,20 0.370012 0.147487 0.0303761

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 5, 0> direction -y right 4 * x up 4 * z }

plane { y, 0 pigment { rgb <0.008, 0.005, 0.002> } }
light_source { <0, 1.5, 0> rgb <100, 90, 60> }
box {
  <-9, 1, -9>, <9, 1.1, 9>
  pigment { rgbt 1 }
  finish { diffuse 0 reflection { 0, 1 fresnel on } conserve_energy }
  interior { ior 1.5 fade_power 1001 fade_distance 0.2 fade_color rgb <0.9, 0.5, 0.2> }
  no_image
}
