// A room, open towards the camera, for golden pictures. Every wall and object may be a target. The originals are grey, so
// that the colours of a retexture come from its textures alone. -D says what there is beside matte walls:
//   Gloss=R    floor and ceiling have a coat of roughness R
//   Metal=M    ball and block are metal by M, 0 to 1, and rough
//   Glass=1    a glass ball before the floor, and a mirror in place of the right wall
//   Lamps=1    two point lights beside the lamp, a red one and a blue one

#version 3.7;
global_settings { assumed_gamma 1 }
#default { finish { ambient 0 diffuse 1 } }

#declare Eye = <0, 1, -2.9>;
camera { location Eye direction <0, 0.95, 0> - Eye right 3 * x up 3 * y }

#macro Panel(Corner, Edge_1, Edge_2)
  polygon { 5, Corner, Corner + Edge_1, Corner + Edge_1 + Edge_2, Corner + Edge_2, Corner }
#end
#macro Coat()
  finish { diffuse 1 #ifdef (Gloss) retex { metallic 0 roughness Gloss ior 1.5 } #end }
#end
#macro Half_Metal()
  finish { diffuse 1 #ifdef (Metal) retex { metallic Metal roughness 0.3 ior 1.5 } #end }
#end

#declare Floor   = texture { pigment { rgb 0.6 } Coat() }
#declare Ceiling = texture { pigment { rgb 0.6 } Coat() }
#declare Left    = texture { pigment { rgb 0.5 } }
#declare Right   = texture { pigment { rgb 0.5 } }
#declare Back    = texture { pigment { rgb 0.7 } }
#declare Ball    = texture { pigment { rgb 0.5 } Half_Metal() }
#declare Block   = texture { pigment { rgb 0.4 } Half_Metal() }
#declare Lid     = texture { pigment { rgb 0.5 } }

object { Panel(<-1, 0, -1>, 2 * z, 2 * x) texture { Floor } }
object { Panel(<-1, 2, -1>, 2 * x, 2 * z) texture { Ceiling } }
object { Panel(<-1, 0, -1>, 2 * y, 2 * z) texture { Left } }
#ifdef (Glass)
  object { Panel(<1, 0, -1>, 2 * z, 2 * y) pigment { rgb 1 } finish { diffuse 0 reflection 0.9 } }
  sphere { <0.35, 0.45, -0.55>, 0.32 pigment { rgbf 1 } finish { diffuse 0 reflection { 0 1 fresnel } } interior { ior 1.5 } }
#else
  object { Panel(<1, 0, -1>, 2 * z, 2 * y) texture { Right } }
#end
object { Panel(<-1, 0, 1>, 2 * y, 2 * x) texture { Back } }
sphere { 0, 0.4 rotate y * 40 translate <-0.45, 0.4, 0.1> texture { Ball } }
box { <-0.25, 0, -0.25>, <0.25, 0.9, 0.25> rotate y * 25 translate <0.5, 0, 0.45> texture { Block } }
object { Panel(<0.2, 0.93, 0.15>, 0.6 * z, 0.6 * x) texture { Lid } }

object {
  Panel(<-0.3, 1.7, -0.3>, 0.6 * x, 0.6 * z)
  texture { pigment { rgb 1 } finish { emission 6 diffuse 0 } }
}
#ifdef (Lamps)
  light_source { <-0.8, 1.5, -0.8> rgb <0.6, 0.1, 0.05> }
  light_source { <0.8, 1.2, -0.7> rgb <0.05, 0.15, 0.7> }
#end
