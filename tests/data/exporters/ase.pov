#include "colors.inc"
#include "finish.inc"

global_settings {assumed_gamma 1 max_trace_level 6}
background {color White transmit 1.0}
camera {orthographic
  right -10.39*x up 7.51*y
  direction 1.00*z
  location <0,0,50.00> look_at <0,0,0>}


light_source {<  2.00,   3.00,  40.00> color White
  area_light <0.70, 0, 0>, <0, 0.70, 0>, 3, 3
  adaptive 1 jitter}
// no fog
#declare simple = finish {phong 0.7}
#declare pale = finish {ambient 0.5 diffuse 0.85 roughness 0.001 specular 0.200 }
#declare intermediate = finish {ambient 0.3 diffuse 0.6 specular 0.1 roughness 0.04}
#declare vmd = finish {ambient 0.0 diffuse 0.65 phong 0.1 phong_size 40.0 specular 0.5 }
#declare jmol = finish {ambient 0.2 diffuse 0.6 specular 1 roughness 0.001 metallic}
#declare ase2 = finish {ambient 0.05 brilliance 3 diffuse 0.6 metallic specular 0.7 roughness 0.04 reflection 0.15}
#declare ase3 = finish {ambient 0.15 brilliance 2 diffuse 0.6 metallic specular 1.0 roughness 0.001 reflection 0.0}
#declare glass = finish {ambient 0.05 diffuse 0.3 specular 1.0 roughness 0.001}
#declare glass2 = finish {ambient 0.01 diffuse 0.3 specular 1.0 reflection 0.25 roughness 0.001}
#declare Rcell = 0.050;
#declare Rbond = 0.100;

#macro atom(LOC, R, COL, TRANS, FIN)
  sphere{LOC, R texture{pigment{color COL transmit TRANS} finish{FIN}}}
#end
#macro constrain(LOC, R, COL, TRANS FIN)
union{torus{R, Rcell rotate 45*z texture{pigment{color COL transmit TRANS} finish{FIN}}}
     torus{R, Rcell rotate -45*z texture{pigment{color COL transmit TRANS} finish{FIN}}}
     translate LOC}
#end

cylinder {< -4.95,  -2.57,  -6.35>, <  2.63,  -2.57,  -9.11>, Rcell pigment {Black}}
cylinder {< -4.58,   3.58,  -5.33>, <  3.00,   3.58,  -8.09>, Rcell pigment {Black}}
cylinder {< -2.63,   2.57,   0.01>, <  4.95,   2.57,  -2.74>, Rcell pigment {Black}}
cylinder {< -3.00,  -3.58,  -1.01>, <  4.58,  -3.58,  -3.76>, Rcell pigment {Black}}
cylinder {< -4.95,  -2.57,  -6.35>, < -4.58,   3.58,  -5.33>, Rcell pigment {Black}}
cylinder {<  2.63,  -2.57,  -9.11>, <  3.00,   3.58,  -8.09>, Rcell pigment {Black}}
cylinder {<  4.58,  -3.58,  -3.76>, <  4.95,   2.57,  -2.74>, Rcell pigment {Black}}
cylinder {< -3.00,  -3.58,  -1.01>, < -2.63,   2.57,   0.01>, Rcell pigment {Black}}
cylinder {< -4.95,  -2.57,  -6.35>, < -3.00,  -3.58,  -1.01>, Rcell pigment {Black}}
cylinder {<  2.63,  -2.57,  -9.11>, <  4.58,  -3.58,  -3.76>, Rcell pigment {Black}}
cylinder {<  3.00,   3.58,  -8.09>, <  4.95,   2.57,  -2.74>, Rcell pigment {Black}}
cylinder {< -4.58,   3.58,  -5.33>, < -2.63,   2.57,   0.01>, Rcell pigment {Black}}
atom(<  0.99,  -0.48,  -5.00>, 0.76, rgb <0.56, 0.56, 0.56>, 0.0, jmol) // #0
atom(< -0.05,   0.47,  -4.44>, 0.76, rgb <0.56, 0.56, 0.56>, 0.0, jmol) // #1
atom(< -1.22,  -0.31,  -4.16>, 0.66, rgb <1.00, 0.05, 0.05>, 0.0, jmol) // #2
atom(< -1.89,   0.29,  -3.80>, 0.31, rgb <1.00, 1.00, 1.00>, 0.0, jmol) // #3
atom(<  0.33,   0.95,  -3.53>, 0.31, rgb <1.00, 1.00, 1.00>, 0.0, jmol) // #4
atom(< -0.27,   1.26,  -5.17>, 0.31, rgb <1.00, 1.00, 1.00>, 0.0, jmol) // #5
atom(<  1.91,   0.06,  -5.23>, 0.31, rgb <1.00, 1.00, 1.00>, 0.0, jmol) // #6
atom(<  1.21,  -1.26,  -4.27>, 0.31, rgb <1.00, 1.00, 1.00>, 0.0, jmol) // #7
atom(<  0.62,  -0.95,  -5.91>, 0.31, rgb <1.00, 1.00, 1.00>, 0.0, jmol) // #8

// no constraints
