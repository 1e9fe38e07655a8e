// A glass sphere under a white sky.
//
// Smooth, clear, ior 1.5: what is not reflected goes through, and out again with the factor of the way in undone. L = 1.
//
// size 65x65  spp 256  tolerance 1e-6 absolute
// expect 32,32 1 1 1
// expect 16,32 1 1 1
// expect 45,40 1 1 1
// expect 0,0 1 1 1

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { location <0, 0, -4> direction z right x up y }

background { rgb 1 }
sphere {
  <0, 0, 0>, 1.5
  pigment { rgbt 1 }
  finish { diffuse 0 reflection { 0, 1 fresnel on } conserve_energy }
  interior { ior 1.5 }
}
