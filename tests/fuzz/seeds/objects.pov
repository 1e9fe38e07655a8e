// Every kind of object, light and camera setting that is rendered.
#version 3.7;
global_settings { assumed_gamma 1 ambient_light 1 }
#default { texture { pigment { rgb 0.7 } finish { ambient 0 diffuse 0.8 } } }
camera { orthographic location <0, 3, -9> direction z right 8 * x up 6 * y sky y look_at <0, 1, 0> rotate 5 * y }
background { rgb <0.1, 0.2, 0.3> }
rainbow { direction <1, -1, 2> angle 40 width 8 arc_angle 160 falloff_angle 90 jitter 0.1 up y distance 50
  color_map { [0 rgbf <1, 0.5, 1, 0.8>] [1 rgbt <1, 0.2, 0.2, 0.6>] } }
sky_sphere { pigment { gradient y color_map { [0 rgb 1] [0.5 rgb <0, 0, 1>] [1 rgb 0.2] } } rotate 20 * x emission 0.5 }
light_source { <5, 8, -5>, rgb <1, 0.9, 0.8> 
  spotlight point_at 0 radius 20 falloff 30 tightness 5 fade_distance 4 fade_power 2 }
light_source { <-5, 8, -5>, rgb 0.4
  area_light x, z, 3, 2 circular orient jitter adaptive 1 parallel point_at y }
light_source { <0, 4, 2>, 1 retex { ies "lamp.ies" turn 30 } point_at 0 }
light_source { y * 5, 1
  cylinder point_at 0 radius 1 falloff 2 looks_like { sphere { 0, 0.2 pigment { rgb 1 } } } shadowless }
plane { y, -1 }
sphere { <0, 1, 0>, 1 scale <1, 2, 1> rotate z * 30
  interior { ior 1.5 fade_distance 1 fade_power 2 fade_color rgb 0.5 } }
box { -1, 1 translate 3 * x uv_mapping pigment { image_map { jpeg "textures/oak-planks.jpg" interpolate 2 once } } }
cylinder { 0, 2 * y, 0.5 open translate -3 * x no_shadow }
cone { 0, 1, 2 * y, 0.2 translate <-2, 0, 2> hollow }
torus { 1, 0.25 rotate 90 * x no_image }
disc { <0, 3, 0>, y, 1, 0.5 no_reflection }
triangle { 0, x, y }
smooth_triangle { 0, -z, x, <0.1, 0, -1>, y, <0, 0.1, -1> translate 2 }
polygon { 10, <0, 0>, <2, 0>, <2, 2>, <0, 2>, <0, 0>, <0.5, 0.5>, <1, 0.5>, <1, 1>, <0.5, 1>, <0.5, 0.5> rotate 90 * x }
#declare Leaf = texture { pigment { rgbft <0.2, 0.8, 0.1, 0.3, 0.1> } }
mesh {
  triangle { 0, x, y uv_vectors <0, 0>, <1, 0>, <0, 1> texture { Leaf } }
  smooth_triangle { x, z, y, z, x + y, z uv_vectors <1, 0>, <0, 1>, <1, 1> }
  inside_vector y translate -1
}
mesh2 {
  vertex_vectors { 4, 0, x, y, x + y } normal_vectors { 2, z, -z } uv_vectors { 3, <0, 0>, <1, 0>, <0, 1> }
  texture_list { 2, texture { Leaf }, texture { pigment { rgb 1 } } }
  face_indices { 2, <0, 1, 2>, 0, <1, 2, 3>, 1, 0, 1 }
  normal_indices { 2, <0, 0, 1>, <1, 1, 0> } uv_indices { 2, <0, 1, 2>, <2, 1, 0> }
  uv_mapping translate z
}
#declare Ball = sphere { 0, 0.3 texture { Leaf } }
union { object { Ball } object { Ball translate x } box { 0, 0.2 inverse }
  finish { emission 1 } bounded_by { box { -2, 2 } } }
sphere { 4 * y, 0.3 pigment { rgb 1 } finish { ambient 2 diffuse 0 } }
#declare Noise = function { internal(76) }
#declare Ridges = function { internal(59) }
#declare Bumps = function(a, b, c) { sqrt(a*a + b*b + c*c) - 1 + .3*Noise(a*3, b*3, c*3) - .1*sum(i, 1, 3, sin(i*a)) }
isosurface { function { Bumps(x, y, z) } contained_by { sphere { 0, 1.5 } } max_gradient 4 accuracy .01 }
isosurface { function { select(x - .2, y, z, Ridges(x, y, z, .9, 2, 3, .8, 2, 1)) } threshold .1 contained_by { box { -1, <1, 2, 1> } }
    evaluate 1, 1.2, .9 open max_trace 3 all_intersections translate 2*x }
difference { isosurface { function { x*x + y*y - .5 } } box { 0, 2 } }
parametric { function { sin(u)*cos(v) } function { sin(u)*sin(v) } function { cos(u) } <0, 0>, <pi, 2*pi>
    contained_by { box { -1, <1, 1, .7> } } accuracy .01 precompute 5 x, y, z }
#declare Low = min_extent(intersection { sphere { 0, 1 } plane { y, .5 } });
