// Pigments, finishes, layers and what is only reported.
#version 3.7;
global_settings { mm_per_unit 5 subsurface { samples 9, 9 radiosity off } }
camera { location <0, 2, -6> look_at 0 angle 60 }
light_source { <3, 5, -4>, rgb 1 }
#declare Glass = material {
  texture { pigment { rgbf <1, 1, 1, 0.9> } 
    finish { specular albedo 0.5 roughness 0.01 reflection { 0.1, 1 fresnel on } conserve_energy } }
  interior { ior 1.5 dispersion 1.05 dispersion_samples 9 }
}
#declare Metal = texture { pigment { rgb <1, 0.8, 0.2> }
  finish { phong 0.7 phong_size 40 metallic reflection { 0.3 falloff 2 exponent 0.5 metallic 1 } brilliance 2 }
}
#declare Wood = pigment { wood turbulence 0.2 octaves 3 lambda 2
  color_map { [0.1 rgb 1] [0.9 rgbt <1, 0, 0, 0.5>] } warp { black_hole 0, 1 } scale 0.3 }
#declare Physical = finish { diffuse 0.7 emission 0.1
  #ifdef (Retex) retex { metallic 0.5 roughness 0.4 ior 1.4 specular_tint 0.5 transmission 0.2 } #end
}
sphere { 0, 1 material { Glass } }
sphere { 2 * x, 1 texture { Metal rotate 30 * z } interior_texture { pigment { rgb 0.1 } } }
sphere { -2 * x, 1 pigment { Wood } normal { bumps 0.5 scale 0.1 } finish { Physical } }
plane { y, -1 texture { pigment { checker rgb 1, rgb <0, 0, 0.5> scale 0.5 translate 0.1 }
  finish { diffuse albedo 0.6, 0.2 crand 0.01 } } }
box { -0.5, 0.5 translate <0, 1.5, 0>
  texture { pigment { image_map { jpeg "textures/linen.jpg" gamma 2.2 map_type 1 filter all 0.3 transmit all 0.1 } } }
  texture { pigment { gradient x + y frequency 3 phase 0.2 sine_wave color_map { [0 rgbt 1] [1 rgb <1, 0, 0>] } } } }
sphere { <0, 1, 3>, 1 texture { checker texture { Metal }, texture { pigment { rgb 1 } } scale 0.4 } }
sphere { <3, 1, 3>, 1 texture { granite texture_map { [0 Metal] [1 pigment { rgb 0 }] } } }
sphere { <-3, 1, 3>, 1 pigment { bozo pigment_map { [0.2 Wood] [0.8 rgb x] } }
  finish { irid { 0.3 thickness 0.2 } subsurface { translucency 0.1 } } }
fog { distance 50 rgb 0.8 fog_type 2 fog_alt 1 fog_offset 0 }
media { scattering { 1, 0.1 } }
#declare Smoke = density { spherical turbulence 0.3 density_map { [0 rgb 0] [0.5 bozo scale 0.2] [1 rgb <1, 2, 3>] } }
sphere {
  0, 1
  pigment { rgbt 1 }
  hollow
  interior {
    media { scattering { 5, <1, 2, 3> eccentricity 0.4 extinction 0.5 } absorption 0.1 density { Smoke } rotate 20 * y }
    media { emission rgb <0.3, 0.2, 0.1> method 3 intervals 1 samples 2, 8 confidence 0.9 }
  }
  scale 0.5
}
