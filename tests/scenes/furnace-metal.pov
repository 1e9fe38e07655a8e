// A metal sphere of the extension block retex under a white sky.
//
// Metallic 1: L is the directional albedo of a GGX microfacet mirror, alpha = roughness^2 = 0.25, Smith's height-correlated
// masking, reflectance a + (1 - a) (1 - h.i)^5 with a the pigment; light is lost to the second bounce that the model leaves out.
// By quadrature over the half vector, as there is no closed form. (With uncorrelated masking it is a little darker.)
// POV-Ray does not know the block: this scene is not for it.
//
// size 65x65  spp 1024  tolerance 5e-4 absolute
// expect 32,32 0.915812 0.549498 0.183184
// expect 20,32 0.905023 0.543224 0.181426
// expect 45,40 0.896463 0.538541 0.180618
// expect 0,0 1 1 1

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { location <0, 0, -4> direction z right x up y }

background { rgb 1 }
sphere {
  <0, 0, 0>, 1.5
  pigment { rgb <1, 0.6, 0.2> }
  finish { #ifdef (Retex) retex { metallic 1 roughness 0.5 } #end }
}
