// A metal sphere of the extension block retex under a white sky.
//
// Roughness 0: a mirror of Schlick's reflectance F = a + (1 - a) (1 - cos)^5 with a the pigment, L = F.
// POV-Ray does not know the block: this scene is not for it.
//
// size 65x65  spp 4  tolerance 2e-5 absolute
// expect 32,32 1 0.6 0.2
// expect 20,32 1 0.600012 0.200024
// expect 45,40 1 0.600153 0.200306
// expect 0,0 1 1 1

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { location <0, 0, -4> direction z right x up y }

background { rgb 1 }
sphere {
  <0, 0, 0>, 1.5
  pigment { rgb <1, 0.6, 0.2> }
  finish { #ifdef (Retex) retex { metallic 1 roughness 0 } #end }
}
