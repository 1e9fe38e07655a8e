// A floor with a texture of sharp edges, a ball of rough metal that mirrors it, a clear mirror, and a ball that is a
// target itself: what pages show limits with. Targets: Floor, Ball.
#version 3.7;
global_settings { assumed_gamma 1 }
#default { finish { ambient 0 diffuse 1 } }
camera { location <0, 2.2, -5.2> right 16/9*x up y angle 44 look_at <0, 0.75, 0> }
#declare Floor = texture {
  pigment { image_map { jpeg "scenes/textures/travertine.jpg" interpolate 2 } rotate 90*x scale 2 }
  finish { diffuse 0.9 }
}
#declare Ball = texture {
  uv_mapping
  pigment { image_map { jpeg "scenes/textures/travertine.jpg" interpolate 2 } scale <0.25, 0.5, 1> }
}
plane { y, 0 texture { Floor } }
sphere { <-1.6, 0.9, 0.4>, 0.9 texture {
  pigment { rgb <0.9, 0.88, 0.85> }
  finish { diffuse 0.1 reflection { 0.8 metallic } metallic
    #ifdef (Retex) retex { metallic 1 roughness 0.35 } #end }
} }
sphere { <0.2, 0.6, -0.6>, 0.6 texture { pigment { rgb 0.9 } finish { diffuse 0 reflection 0.9 } } }
sphere { 0, 0.9 rotate -60*x translate <1.75, 0.9, 0.3> texture { Ball } }
sphere { 0, 0.6 translate <-2.5, 5.5, -2> texture { pigment { rgb 1 } finish { emission <30, 28, 25> diffuse 0 } } }
sky_sphere { pigment { rgb <0.35, 0.4, 0.48> } }
