// A point light over a Lambertian plane, behind a pane of the extension's clear finish.
//
// Camera: from above, orthographic, 4 by 4: pixel (i, j) of n by n sees x = 4 (i + 0.5) / n - 2, z = 2 - 4 (j + 0.5) / n.
// As window, but each face tints by the pigment: L = albedo * c * cos a (1 - R)^2 pigment^2.
//
// size 65x65  spp 16  tolerance 5e-3 relative
// expect 32,32 0.6125 0.272222 0.0408333
// expect 10,32 0.448857 0.199492 0.0299238
// expect 50,50 0.414822 0.184365 0.0276548
// expect 0,0 0.259876 0.1155 0.0173251
// expect 64,20 0.337656 0.150069 0.0225104

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 5, 0> direction -y right 4 * x up 4 * z }

plane { y, 0 pigment { rgb <0.008, 0.005, 0.002> } }
light_source { <0, 1.5, 0> rgb <100, 90, 60> }
box {
  <-9, 1, -9>, <9, 1.1, 9>
  pigment { rgb <0.9, 0.8, 0.6> }
  finish { retex { roughness 0 ior 1.4 transmission 1 } }
  no_image
}
