// A small room with all that light may meet between surfaces: fog, haze and smoke, a flame, stained air, glass that
// disperses, and skin. With -D Clear=1 there is neither fog nor haze. With -D Fog=1 there is fog, and no medium but, with
// -D Far=1, one that nothing meets.
#version 3.7;
global_settings { assumed_gamma 1 mm_per_unit 100 subsurface {} }

camera { location <0, 1.2, -3.5> look_at <0, 0.9, 0> angle 55 }
light_source { <-1.5, 2.7, -1>, rgb 0.7 media_attenuation on }
box { <-0.4, 2.98, -0.4>, <0.4, 2.99, 0.4> pigment { rgb 1 } finish { ambient 0 diffuse 0 emission 6 } }

#declare Floor = texture { pigment { checker rgb 0.7, rgb <0.3, 0.5, 0.2> } finish { ambient 0 diffuse 0.8 } }
#declare Wall = texture { pigment { rgb <0.6, 0.55, 0.5> } finish { ambient 0 diffuse 0.8 } }
plane { y, 0 texture { Floor } }
plane { -z, -2 texture { Wall } }
plane { x, -2 texture { Wall } }
plane { -x, -2 texture { Wall } }
plane { -y, -3 pigment { rgb 0.8 } finish { ambient 0 diffuse 0.8 } }

#ifndef (Clear)
fog { distance 20 rgb <0.3, 0.35, 0.4> }
#end
#ifdef (Far)
sphere { 500 * z, 0.1 pigment { rgbt 1 } hollow interior { media { absorption 1 } } }
#end
#ifndef (Fog)
#ifndef (Clear)
media { scattering { 5, 0.05 eccentricity 0.4 } absorption 0.01 }
#end
sphere {
  0, 0.5
  pigment { rgbt 1 }
  hollow
  interior {
    media { scattering { 1, <1, 1.4, 2> } absorption 0.3 density { spherical scale 0.5 } }
    media { emission <2, 1, 0.3> density { spherical density_map { [0.3 rgb 0] [1 rgb 1] } scale 0.5 } }
  }
  translate <-0.7, 0.7, 0.2>
}
box { <-1.6, 0, 0>, <-1.2, 1.6, 0.6> pigment { rgbt 1 } hollow interior { media { absorption <0.4, 0.9, 1.6> } } }
#end
sphere {
  <0.5, 0.5, -0.2>, 0.45
  pigment { rgbt 1 }
  finish { ambient 0 diffuse 0 reflection { 0, 1 fresnel } conserve_energy }
  interior { ior 1.5 dispersion 1.15 }
}
sphere {
  <1.3, 0.6, 0.4>, 0.5
  texture { Wall finish { diffuse 0.8 specular 0.2 subsurface { translucency <6, 3, 2> } } }
}
