// An emitting disc with another texture behind, over a Lambertian plane.
//
// Camera: from above, orthographic, 4 by 4: pixel (i, j) of n by n sees x = 4 (i + 0.5) / n - 2, z = }2 - 4 (j + 0.5) / n.
// The disc's back, which has a texture of its own, looks down. L = albedo * e * F / 4 with the disc/ form factor F, see
// emitter-disc.
//
// size 65x65  spp 1024  tolerance 4e-3 relative
// expect 32,32 0.144 0.0675 0.018
// expect 10,32 0.0331301 0.0155297 0.00414126
// expect 50,50 0.0224672 0.0105315 0.0028084
// expect 0,0 0.00326978 0.00153271 0.000408722
// expect 64,20 0.00889291 0.00416855 0.00111161

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 0.5, 0> direction -y right 4 * x up 4 * z }

plane { y, 0 pigment { rgb <0.8, 0.5, 0.2> } }
disc {
  <0, 1, 0>, y, 0.75
  texture { pigment { rgb 1 } finish { diffuse 0 emission <2, 1.5, 1> } }
  interior_texture { pigment { rgb 0.25 } finish { diffuse 0 emission <2, 1.5, 1> } }
}
