// White smoke under a white sky: scattering without absorption, of all orders, shows nothing. Its density varies in one
// ball and is the same in the other.
//
// size 9x5  spp 64  tolerance 1e-6 absolute
// expect 2,2 1 1 1
// expect 6,2 1 1 1
// expect 1,2 1 1 1
// expect 4,2 1 1 1

#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 256 }

camera { location -10 * z direction 2 * z right 1.8 * x up y }

background { rgb 1 }
sphere {
  <-2, 0, 0>, 1.6
  pigment { rgbt 1 }
  hollow
  interior { media { scattering { 5, 0.9 eccentricity 0.5 } } }
}
sphere {
  <2, 0, 0>, 1.6
  pigment { rgbt 1 }
  hollow
  interior { media { scattering { 4, 0.9 } density { spherical scale 1.6 } } }
}
