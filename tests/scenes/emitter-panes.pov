// An emitting disc over a Lambertian plane, behind 24 sheets.
//
// Camera: from above, orthographic, 4 by 4: pixel (i, j) of n by n sees x = 4 (i + 0.5) / n - 2, z = 2 - 4 (j + 0.5) / n.
// Each sheet lets 0.97 pass: L = albedo * e * F * 0.97^24 with the disc's form factor F, see emitter-disc. Shadow rays and
// paths both go through, and the sheets are so large that a hit on them is good to 1e-5 only.
//
// size 65x65  spp 1024  tolerance 4e-3 relative
// expect 32,32 0.277296 0.129983 0.034662
// expect 10,32 0.0637975 0.0299051 0.00797469
// expect 50,50 0.0432644 0.0202802 0.00540805
// expect 0,0 0.00629651 0.00295149 0.000787063
// expect 64,20 0.0171248 0.00802725 0.0021406

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { ambient 0 diffuse 1 } }

camera { orthographic location <0, 0.5, 0> direction -y right 4 * x up 4 * z }

plane { y, 0 pigment { rgb <0.8, 0.5, 0.2> } }
disc { <0, 1, 0>, y, 0.75 pigment { rgb 1 } finish { diffuse 0 emission <2, 1.5, 1> } }
#for (I, 1, 24)
  mesh {
    triangle { <-300, 0, -300>, <300, 0, -300>, <0, 0, 300> }
    translate (0.5 + 0.01 * I) * y
    pigment { rgbt <0, 0, 0, 0.97> } finish { diffuse 0 }
  }
#end
