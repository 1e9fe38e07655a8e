// A slanted cylinder light that fades, on a Lambertian plane.
//
// Camera: from above, orthographic, 4 by 4: pixel (i, j) of n by n sees x = 4 (i + 0.5) / n - 2, z = 2 - 4 (j + 0.5) / n.
// The light is parallel. At distance r off the axis and q = 1 - r / falloff: L = albedo * c * cos a * q^tightness * s * fade, where
// cos a is the axis' and s = (3 - 2 t) t^2 of t = q / (1 - radius / falloff) beyond the radius, else 1. It fades by the distance s
// along the axis from the plane of the light: fade = 2 / (1 + (s / 2)^2).
//
// size 65x65  spp 64  tolerance 3e-3 absolute
// expect 32,32 0.592614 0.333345 0.0888921
// expect 40,30 0.63941 0.359668 0.0959115
// expect 50,36 0.486564 0.273692 0.0729847
// expect 20,32 0.374894 0.210878 0.0562341
// expect 34,45 0.404152 0.227336 0.0606228
// expect 0,0 0 0 0

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 5, 0> direction -y right 4 * x up 4 * z }

plane { y, 0 pigment { rgb <0.8, 0.5, 0.2> } }
light_source { <1, 2, 0.5> rgb <1, 0.9, 0.6> cylinder point_at <0.2, 0, 0.1> radius 0.9 falloff 1.6 tightness 0.5 fade_distance 2 fade_power 2 }
