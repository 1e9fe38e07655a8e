// A matte box inside a sphere that shines in two layers and reflects nothing.
//
// The upper layer <.6,.2,.4> lets .25 pass of the lower one, <.4,.8,.4> of emission 2: the sphere shines with
// E = .75 <.6,.2,.4> + .25 * 2 <.4,.8,.4> = <.65,.55,.5>, and the box, of albedo .5, with half of it wherever it is seen.
// Direct-light samples, which choose a layer for themselves, and paths that meet the sphere must agree.
//
// size 5x5  spp 4096  tolerance 6e-3 absolute
// expect 2,2 0.325 0.275 0.25
// expect 0,0 0.65 0.55 0.5
// expect 2,0 0.65 0.55 0.5

#version 3.7;
global_settings { assumed_gamma 1 }
#default { finish { ambient 0 diffuse 1 } }

camera { location <0, 0, -4> look_at 0 angle 60 right x up y }

sphere {
    0, 5
    texture { pigment { rgb <0.4, 0.8, 0.4> } finish { diffuse 0 emission 2 } }
    texture { pigment { rgbt <0.6, 0.2, 0.4, 0.25> } finish { diffuse 0 emission 1 } }
}
box { -0.7, 0.7 pigment { rgb 0.5 } rotate <20, 30, 0> }
