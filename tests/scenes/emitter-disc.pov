// An emitting disc over a Lambertian plane.
//
// Camera: from above, orthographic, 4 by 4: pixel (i, j) of n by n sees x = 4 (i + 0.5) / n - 2, z = 2 - 4 (j + 0.5) / n.
// The camera is below the disc. Radiance e, radius R = 0.75, height h = 1; at distance r from the axis the form factor is
// F = (1 - (r^2 + h^2 - R^2) / sqrt((r^2 + h^2 + R^2)^2 - 4 r^2 R^2)) / 2, and L = albedo * e * F.
//
// size 65x65  spp 1024  tolerance 4e-3 relative
// expect 32,32 0.576 0.27 0.072
// expect 10,32 0.13252 0.0621188 0.016565
// expect 50,50 0.0898689 0.042126 0.0112336
// expect 0,0 0.0130791 0.00613083 0.00163489
// expect 64,20 0.0355716 0.0166742 0.00444645

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 0.5, 0> direction -y right 4 * x up 4 * z }

plane { y, 0 pigment { rgb <0.8, 0.5, 0.2> } }
disc { <0, 1, 0>, y, 0.75 pigment { rgb 1 } finish { diffuse 0 emission <2, 1.5, 1> } }
