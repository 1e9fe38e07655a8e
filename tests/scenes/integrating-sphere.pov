// A point light in the middle of a hollow Lambertian sphere.
//
// Every point gets irradiance pi c directly and pi L from the rest of the sphere, all of it alike: L = a c + a L, so
// L = c a / (1 - a) = c (a + a^2 + a^3 + …), the n-th term being the light of n reflections. a = (0.6, 0.5, 0.3), c = 1.
// Target: Floor. With a constant b in place of a the set gives L' = c (b + b^2 + b^3 + …), see tests/fidelity/further.sh.
// Paths of 16 segments, the last one to the light, have 15 terms. The values below have 16, which the tolerance allows.
//
// size 65x65  spp 16384  tolerance 1.5e-3 relative
// expect 32,32 1.49958 0.999985 0.428571
// expect 5,50 1.49958 0.999985 0.428571
// expect 60,10 1.49958 0.999985 0.428571

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { location <0.5, 0.3, -1> direction z right 2 * x up 2 * y }

#declare Floor = texture { pigment { rgb <0.6, 0.5, 0.3> } }
sphere { <0, 0, 0>, 3 texture { Floor } }
light_source { <0, 0, 0> rgb 1 }
