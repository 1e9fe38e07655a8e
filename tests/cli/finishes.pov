// A room whose floor and wall have several finishes, for finishes.t.
#version 3.7;
global_settings { assumed_gamma 1 radiosity {} }
camera { location <0, 1.2, -3.2> look_at <0, 0.7, 0> angle 55 }
#declare Gloss = finish { diffuse 0.6 reflection { 0.1, 0.8 fresnel } conserve_energy }
#declare Dull = finish { diffuse 0.5 specular 0.3 roughness 0.02 }
#declare Shiny = finish { emission 1 }
#ifdef (Retex)
  #declare Coated = finish { retex { roughness 0.5 clearcoat 1 clearcoat_roughness 0 } }
  #declare Smooth = finish { retex { roughness 0 ior 1.5 } }
  #declare Glass = finish { retex { transmission 1 } }
#end
#ifndef (Floor_Finish) #declare Floor_Finish = 0; #end
#declare Floor = texture {
  pigment { checker rgb <0.7, 0.3, 0.2>, rgb <0.8, 0.75, 0.6> scale 0.5 }
  #switch (Floor_Finish)
    #case (1) finish { Gloss } #break
    #case (2) finish { Coated } #break
    #case (3) finish { retex { roughness 0.08 } } #break
    #else finish { diffuse 0.8 }
  #end
}
#declare Wall = texture { pigment { rgb <0.3, 0.5, 0.7> } finish { diffuse 0.9 } }
#declare Pane = texture { pigment { rgbt <0.9, 0.9, 0.9, 0.6> } finish { diffuse 0.5 } }
plane { y, 0 texture { Floor } }
plane { -z, -2 texture { Wall } }
plane { x, -2 texture { pigment { rgb <0.8, 0.2, 0.2> } finish { diffuse 0.8 } } }
box { <1, 0, 0>, <1.8, 1.2, 0.8> texture { pigment { rgb 0.8 } finish { diffuse 0.8 } } }
box { <-1.6, 0, 0.4>, <-1.5, 0.7, 1> texture { Pane } }
sphere { <0, 0.5, 0.4>, 0.5 texture { pigment { rgb 0.9 } finish { reflection 0.8 diffuse 0.1 } } }
#declare Lamp = light_source { <1.5, 3, -1> rgb 1.2 area_light 0.6 * x, 0.6 * z, 3, 3 }
light_source { Lamp }
#declare Panel = box {
  <-1.2, 2.2, -0.2>, <-0.6, 2.25, 0.6> texture { pigment { rgb 1 } finish { emission 6 diffuse 0 } }
}
object { Panel }
