// What mattes are tried on. -D Emit="NAME" makes a black scene in which what has this name, of an object or of a texture,
// shines with 1: the picture is the matte. -D Lens=1: a camera with depth of field.
#version 3.7;
global_settings { assumed_gamma 1 }
camera {
    location <0, 1.6, -5> look_at <0, .9, 0> right 4/3*x angle 52
    #ifdef (Lens) aperture .4 focal_point <0, .8, 0> #end
}
#ifndef (Emit)
light_source { <3, 6, -5>, 1 }
background { rgb <.2, .3, .5> }
#end

#macro Value(Name)
    #ifdef (Emit) #if (strcmp(Emit, Name) = 0) 1 #else 0 #end #else 0 #end
#end
// A pigment for the object Object with the texture Texture: as said, or shining.
#macro Painted(Object, Texture, Colour)
    #ifdef (Emit)
        pigment { rgb max(Value(Object), Value(Texture)) transmit Colour.transmit }
        finish { emission 1 diffuse 0 }
    #else
        pigment { color Colour }
    #end
#end

#declare Floor = texture { Painted("Ground", "Floor", rgb <.8, .5, .3>) }
#declare Ground = plane { y, 0 texture { Floor } }
object { Ground }
#declare Wall = texture { Painted("Back", "Wall", rgb <.3, .6, .3>) }
#declare Back = plane { z, 3 texture { Wall } }
object { Back }

// One name, two textures, one of them on the cut faces.
#declare Shell = texture { Painted("Cut", "Shell", rgb <.7, .7, .2>) }
#declare Core = texture { Painted("Cut", "Core", rgb <.7, .1, .1>) }
#declare Cut = difference { box { <-2.1, .01, -.3>, <-1.3, .9, .5> texture { Shell } } sphere { <-1.3, .9, -.3>, .45 texture { Core } } }
object { Cut }

// Two copies of one name; a shape without any, in front of one of them.
#declare Twin = sphere { 0, .3 texture { Painted("Twin", "", rgb .6) } }
object { Twin translate <-.8, .31, -1> }
object { Twin translate <-.45, .31, -.5> }
sphere { <-.95, .2, -1.5>, .15 pigment { rgb Value("lone") } finish { emission 1 diffuse 0 } }

// Clear surfaces that do not refract: by a half, and with holes.
#declare Gauze = texture { Painted("Veil", "Gauze", rgbt <.9, .2, .2, .6>) }
#declare Veil = disc { <-.2, 1.9, -1>, -z, .5 texture { Gauze } }
object { Veil }
#declare Lattice = texture {
    #ifdef (Emit)
        pigment { checker rgb max(Value("Grid"), Value("Lattice")) rgbt 1 scale .21 } finish { emission 1 diffuse 0 }
    #else
        pigment { checker rgb <.2, .3, .8> rgbt 1 scale .21 }
    #end
}
#declare Grid = disc { <1.1, 2, -.5>, -z, .5 texture { Lattice } }
object { Grid }

// Two textures that change into each other.
#declare Rust = texture { Painted("Pole", "Rust", rgb <.5, .2, .1>) }
#declare Steel = texture { Painted("Pole", "Steel", rgb .7) }
#declare Pole = cylinder { <-2.3, .01, 1>, <-2.3, 3, 1>, .2 texture { gradient y texture_map { [.3 Rust] [.7 Steel] } scale 2 } }
object { Pole }

// Glass and a mirror; -D Direct=1: black, so that the picture is what is seen directly.
#ifdef (Direct)
#declare Glass = material { texture { pigment { rgb 0 } finish { diffuse 0 } } }
#declare Polished = texture { pigment { rgb 0 } finish { diffuse 0 } }
#else
#declare Glass = material { texture { pigment { rgbt 1 } finish { diffuse 0 reflection { 0, 1 fresnel } } } interior { ior 1.5 } }
#declare Polished = texture { pigment { rgb 0 } finish { diffuse 0 reflection 1 } }
#end
#declare Pane = box { <.1, .06, -.9>, <.9, 1.3, -.8> rotate 15*y material { Glass } }
object { Pane }
#declare Ball = sphere { <1.9, .5, 0>, .45 texture { Polished } }
object { Ball }
