/*

POVxtl-Persistence of Vision Ray Tracer
Crystal Structure Drawing Program V5.5

Copyright 1996, 1997, 2000-2011 by Larry Finger, Martin Kroeker, and Brian Toby
   (all rights reserved).

Scene file created from bucky.str 
with command line options: -b   7.36   8.50  14.16 -o  0.00  0.00  0.00 
-p  0.03  0.06 -0.10  0.10  0.20  0.30 -v -18.00  0.00  0.00 -m  0.80
*/

#if (version>3.65)
#version 3.6;
#end

#include "colors.inc"
#include "chars.inc"

default {
        finish {
                ambient  0.70
                diffuse  0.30
                specular  0.08
                roughness  0.01
               }
        }

camera{
 location< 0.000000 ,-0.000000, 189.837570>
 up <0, 0.1, 0>
 right <-0.1, 0, 0>
 look_at <0.000000,-0.000000,0>
}
background{color White}
light_source {< 0, 0, 118.648483>
color red 4.0 green 4.0 blue 4.0
}
object{
 union{

#declare xrot = -18.0;
#declare yrot =   0.0;
#declare zrot =   0.0;
#declare xmove =   0.0;
#declare ymove =   0.0;

 /* Sphere for c    at  0.04908  0.00000  0.24510 */ 
 sphere{< 0.69497, -0.00000,  3.47062>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.00000  0.24510  0.04908 */ 
 sphere{<-0.00000,  3.47062,  0.69497>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.24510  0.04908  0.00000 */ 
 sphere{< 3.47062,  0.69497,  0.00000>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.04908  0.00000  0.24510 */ 
 sphere{<-0.69497, -0.00000,  3.47062>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.24510 -0.04908  0.00000 */ 
 sphere{< 3.47062, -0.69497,  0.00000>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.00000  0.24510 -0.04908 */ 
 sphere{<-0.00000,  3.47062, -0.69497>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.24510 -0.04908  0.00000 */ 
 sphere{<-3.47062, -0.69497,  0.00000>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.04908  0.00000 -0.24510 */ 
 sphere{<-0.69497,  0.00000, -3.47062>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.24510  0.04908  0.00000 */ 
 sphere{<-3.47062,  0.69497,  0.00000>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.00000 -0.24510 -0.04908 */ 
 sphere{< 0.00000, -3.47062, -0.69497>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.00000 -0.24510  0.04908 */ 
 sphere{< 0.00000, -3.47062,  0.69497>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.04908  0.00000 -0.24510 */ 
 sphere{< 0.69497,  0.00000, -3.47062>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.10028  0.08284  0.21346 */ 
 sphere{< 1.41996,  1.17301,  3.02259>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.08284  0.21346  0.10028 */ 
 sphere{< 1.17301,  3.02259,  1.41996>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.21346  0.10028  0.08284 */ 
 sphere{< 3.02259,  1.41996,  1.17301>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.10028 -0.08284  0.21346 */ 
 sphere{<-1.41996, -1.17301,  3.02259>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.08284  0.21346 -0.10028 */ 
 sphere{<-1.17301,  3.02259, -1.41996>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.10028  0.08284  0.21346 */ 
 sphere{<-1.41996,  1.17301,  3.02259>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.08284  0.21346  0.10028 */ 
 sphere{<-1.17301,  3.02259,  1.41996>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.21346 -0.10028 -0.08284 */ 
 sphere{< 3.02259, -1.41996, -1.17301>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.10028 -0.08284  0.21346 */ 
 sphere{< 1.41996, -1.17301,  3.02259>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.21346 -0.10028  0.08284 */ 
 sphere{< 3.02259, -1.41996,  1.17301>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.08284  0.21346 -0.10028 */ 
 sphere{< 1.17301,  3.02259, -1.41996>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.21346  0.10028 -0.08284 */ 
 sphere{< 3.02259,  1.41996, -1.17301>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.08284 -0.21346  0.10028 */ 
 sphere{<-1.17301, -3.02259,  1.41996>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.21346 -0.10028  0.08284 */ 
 sphere{<-3.02259, -1.41996,  1.17301>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.10028  0.08284 -0.21346 */ 
 sphere{<-1.41996,  1.17301, -3.02259>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.21346  0.10028 -0.08284 */ 
 sphere{<-3.02259,  1.41996, -1.17301>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.21346  0.10028  0.08284 */ 
 sphere{<-3.02259,  1.41996,  1.17301>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.10028 -0.08284 -0.21346 */ 
 sphere{< 1.41996, -1.17301, -3.02259>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.08284 -0.21346 -0.10028 */ 
 sphere{< 1.17301, -3.02259, -1.41996>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.08284 -0.21346  0.10028 */ 
 sphere{< 1.17301, -3.02259,  1.41996>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.10028  0.08284 -0.21346 */ 
 sphere{< 1.41996,  1.17301, -3.02259>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.10028 -0.08284 -0.21346 */ 
 sphere{<-1.41996, -1.17301, -3.02259>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.08284 -0.21346 -0.10028 */ 
 sphere{<-1.17301, -3.02259, -1.41996>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.21346 -0.10028 -0.08284 */ 
 sphere{<-3.02259, -1.41996, -1.17301>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.18313  0.05120  0.16226 */ 
 sphere{< 2.59312,  0.72499,  2.29760>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.05120  0.16226  0.18313 */ 
 sphere{< 0.72499,  2.29760,  2.59312>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.16226  0.18313  0.05120 */ 
 sphere{< 2.29760,  2.59312,  0.72499>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.18313 -0.05120  0.16226 */ 
 sphere{<-2.59312, -0.72499,  2.29760>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.05120 -0.16226  0.18313 */ 
 sphere{<-0.72499, -2.29760,  2.59312>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.05120  0.16226 -0.18313 */ 
 sphere{<-0.72499,  2.29760, -2.59312>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.16226  0.18313 -0.05120 */ 
 sphere{<-2.29760,  2.59312, -0.72499>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.18313  0.05120  0.16226 */ 
 sphere{<-2.59312,  0.72499,  2.29760>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.05120  0.16226  0.18313 */ 
 sphere{<-0.72499,  2.29760,  2.59312>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.16226  0.18313  0.05120 */ 
 sphere{<-2.29760,  2.59312,  0.72499>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.18313 -0.05120 -0.16226 */ 
 sphere{< 2.59312, -0.72499, -2.29760>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.16226 -0.18313 -0.05120 */ 
 sphere{< 2.29760, -2.59312, -0.72499>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.18313 -0.05120  0.16226 */ 
 sphere{< 2.59312, -0.72499,  2.29760>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.05120 -0.16226  0.18313 */ 
 sphere{< 0.72499, -2.29760,  2.59312>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.16226 -0.18313  0.05120 */ 
 sphere{< 2.29760, -2.59312,  0.72499>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.18313  0.05120 -0.16226 */ 
 sphere{< 2.59312,  0.72499, -2.29760>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.05120  0.16226 -0.18313 */ 
 sphere{< 0.72499,  2.29760, -2.59312>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.16226  0.18313 -0.05120 */ 
 sphere{< 2.29760,  2.59312, -0.72499>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.16226 -0.18313  0.05120 */ 
 sphere{<-2.29760, -2.59312,  0.72499>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.18313  0.05120 -0.16226 */ 
 sphere{<-2.59312,  0.72499, -2.29760>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at  0.05120 -0.16226 -0.18313 */ 
 sphere{< 0.72499, -2.29760, -2.59312>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.18313 -0.05120 -0.16226 */ 
 sphere{<-2.59312, -0.72499, -2.29760>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.05120 -0.16226 -0.18313 */ 
 sphere{<-0.72499, -2.29760, -2.59312>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Sphere for c    at -0.16226 -0.18313 -0.05120 */ 
 sphere{<-2.29760, -2.59312, -0.72499>,  0.40000
  texture{pigment{color Red  }}
   finish{phong  1.00 phong_size 30.00}
 }
 /* Bond: c   0.04908  0.00000  0.24510 TO c  -0.04908  0.00000  0.24510*/
 cylinder{< 0.69497, -0.00000,  3.47062>, <-0.69497, -0.00000,  3.47062>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.04908  0.00000  0.24510 TO c   0.10028  0.08284  0.21346*/
 cylinder{< 0.69497, -0.00000,  3.47062>, < 1.41996,  1.17301,  3.02259>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.04908  0.00000  0.24510 TO c   0.10028 -0.08284  0.21346*/
 cylinder{< 0.69497, -0.00000,  3.47062>, < 1.41996, -1.17301,  3.02259>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.00000  0.24510  0.04908 TO c   0.00000  0.24510 -0.04908*/
 cylinder{<-0.00000,  3.47062,  0.69497>, <-0.00000,  3.47062, -0.69497>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.00000  0.24510  0.04908 TO c   0.08284  0.21346  0.10028*/
 cylinder{<-0.00000,  3.47062,  0.69497>, < 1.17301,  3.02259,  1.41996>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.00000  0.24510  0.04908 TO c  -0.08284  0.21346  0.10028*/
 cylinder{<-0.00000,  3.47062,  0.69497>, <-1.17301,  3.02259,  1.41996>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.24510  0.04908  0.00000 TO c   0.24510 -0.04908  0.00000*/
 cylinder{< 3.47062,  0.69497,  0.00000>, < 3.47062, -0.69497,  0.00000>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.24510  0.04908  0.00000 TO c   0.21346  0.10028  0.08284*/
 cylinder{< 3.47062,  0.69497,  0.00000>, < 3.02259,  1.41996,  1.17301>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.24510  0.04908  0.00000 TO c   0.21346  0.10028 -0.08284*/
 cylinder{< 3.47062,  0.69497,  0.00000>, < 3.02259,  1.41996, -1.17301>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.04908  0.00000  0.24510 TO c  -0.10028 -0.08284  0.21346*/
 cylinder{<-0.69497, -0.00000,  3.47062>, <-1.41996, -1.17301,  3.02259>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.04908  0.00000  0.24510 TO c  -0.10028  0.08284  0.21346*/
 cylinder{<-0.69497, -0.00000,  3.47062>, <-1.41996,  1.17301,  3.02259>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.24510 -0.04908  0.00000 TO c   0.21346 -0.10028 -0.08284*/
 cylinder{< 3.47062, -0.69497,  0.00000>, < 3.02259, -1.41996, -1.17301>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.24510 -0.04908  0.00000 TO c   0.21346 -0.10028  0.08284*/
 cylinder{< 3.47062, -0.69497,  0.00000>, < 3.02259, -1.41996,  1.17301>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.00000  0.24510 -0.04908 TO c  -0.08284  0.21346 -0.10028*/
 cylinder{<-0.00000,  3.47062, -0.69497>, <-1.17301,  3.02259, -1.41996>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.00000  0.24510 -0.04908 TO c   0.08284  0.21346 -0.10028*/
 cylinder{<-0.00000,  3.47062, -0.69497>, < 1.17301,  3.02259, -1.41996>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.24510 -0.04908  0.00000 TO c  -0.24510  0.04908  0.00000*/
 cylinder{<-3.47062, -0.69497,  0.00000>, <-3.47062,  0.69497,  0.00000>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.24510 -0.04908  0.00000 TO c  -0.21346 -0.10028  0.08284*/
 cylinder{<-3.47062, -0.69497,  0.00000>, <-3.02259, -1.41996,  1.17301>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.24510 -0.04908  0.00000 TO c  -0.21346 -0.10028 -0.08284*/
 cylinder{<-3.47062, -0.69497,  0.00000>, <-3.02259, -1.41996, -1.17301>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.04908  0.00000 -0.24510 TO c   0.04908  0.00000 -0.24510*/
 cylinder{<-0.69497,  0.00000, -3.47062>, < 0.69497,  0.00000, -3.47062>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.04908  0.00000 -0.24510 TO c  -0.10028  0.08284 -0.21346*/
 cylinder{<-0.69497,  0.00000, -3.47062>, <-1.41996,  1.17301, -3.02259>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.04908  0.00000 -0.24510 TO c  -0.10028 -0.08284 -0.21346*/
 cylinder{<-0.69497,  0.00000, -3.47062>, <-1.41996, -1.17301, -3.02259>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.24510  0.04908  0.00000 TO c  -0.21346  0.10028 -0.08284*/
 cylinder{<-3.47062,  0.69497,  0.00000>, <-3.02259,  1.41996, -1.17301>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.24510  0.04908  0.00000 TO c  -0.21346  0.10028  0.08284*/
 cylinder{<-3.47062,  0.69497,  0.00000>, <-3.02259,  1.41996,  1.17301>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.00000 -0.24510 -0.04908 TO c   0.00000 -0.24510  0.04908*/
 cylinder{< 0.00000, -3.47062, -0.69497>, < 0.00000, -3.47062,  0.69497>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.00000 -0.24510 -0.04908 TO c   0.08284 -0.21346 -0.10028*/
 cylinder{< 0.00000, -3.47062, -0.69497>, < 1.17301, -3.02259, -1.41996>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.00000 -0.24510 -0.04908 TO c  -0.08284 -0.21346 -0.10028*/
 cylinder{< 0.00000, -3.47062, -0.69497>, <-1.17301, -3.02259, -1.41996>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.00000 -0.24510  0.04908 TO c  -0.08284 -0.21346  0.10028*/
 cylinder{< 0.00000, -3.47062,  0.69497>, <-1.17301, -3.02259,  1.41996>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.00000 -0.24510  0.04908 TO c   0.08284 -0.21346  0.10028*/
 cylinder{< 0.00000, -3.47062,  0.69497>, < 1.17301, -3.02259,  1.41996>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.04908  0.00000 -0.24510 TO c   0.10028 -0.08284 -0.21346*/
 cylinder{< 0.69497,  0.00000, -3.47062>, < 1.41996, -1.17301, -3.02259>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.04908  0.00000 -0.24510 TO c   0.10028  0.08284 -0.21346*/
 cylinder{< 0.69497,  0.00000, -3.47062>, < 1.41996,  1.17301, -3.02259>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.10028  0.08284  0.21346 TO c   0.18313  0.05120  0.16226*/
 cylinder{< 1.41996,  1.17301,  3.02259>, < 2.59312,  0.72499,  2.29760>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.10028  0.08284  0.21346 TO c   0.05120  0.16226  0.18313*/
 cylinder{< 1.41996,  1.17301,  3.02259>, < 0.72499,  2.29760,  2.59312>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.08284  0.21346  0.10028 TO c   0.05120  0.16226  0.18313*/
 cylinder{< 1.17301,  3.02259,  1.41996>, < 0.72499,  2.29760,  2.59312>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.08284  0.21346  0.10028 TO c   0.16226  0.18313  0.05120*/
 cylinder{< 1.17301,  3.02259,  1.41996>, < 2.29760,  2.59312,  0.72499>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.21346  0.10028  0.08284 TO c   0.18313  0.05120  0.16226*/
 cylinder{< 3.02259,  1.41996,  1.17301>, < 2.59312,  0.72499,  2.29760>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.21346  0.10028  0.08284 TO c   0.16226  0.18313  0.05120*/
 cylinder{< 3.02259,  1.41996,  1.17301>, < 2.29760,  2.59312,  0.72499>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.10028 -0.08284  0.21346 TO c  -0.18313 -0.05120  0.16226*/
 cylinder{<-1.41996, -1.17301,  3.02259>, <-2.59312, -0.72499,  2.29760>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.10028 -0.08284  0.21346 TO c  -0.05120 -0.16226  0.18313*/
 cylinder{<-1.41996, -1.17301,  3.02259>, <-0.72499, -2.29760,  2.59312>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.08284  0.21346 -0.10028 TO c  -0.05120  0.16226 -0.18313*/
 cylinder{<-1.17301,  3.02259, -1.41996>, <-0.72499,  2.29760, -2.59312>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.08284  0.21346 -0.10028 TO c  -0.16226  0.18313 -0.05120*/
 cylinder{<-1.17301,  3.02259, -1.41996>, <-2.29760,  2.59312, -0.72499>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.10028  0.08284  0.21346 TO c  -0.18313  0.05120  0.16226*/
 cylinder{<-1.41996,  1.17301,  3.02259>, <-2.59312,  0.72499,  2.29760>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.10028  0.08284  0.21346 TO c  -0.05120  0.16226  0.18313*/
 cylinder{<-1.41996,  1.17301,  3.02259>, <-0.72499,  2.29760,  2.59312>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.08284  0.21346  0.10028 TO c  -0.05120  0.16226  0.18313*/
 cylinder{<-1.17301,  3.02259,  1.41996>, <-0.72499,  2.29760,  2.59312>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.08284  0.21346  0.10028 TO c  -0.16226  0.18313  0.05120*/
 cylinder{<-1.17301,  3.02259,  1.41996>, <-2.29760,  2.59312,  0.72499>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.21346 -0.10028 -0.08284 TO c   0.18313 -0.05120 -0.16226*/
 cylinder{< 3.02259, -1.41996, -1.17301>, < 2.59312, -0.72499, -2.29760>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.21346 -0.10028 -0.08284 TO c   0.16226 -0.18313 -0.05120*/
 cylinder{< 3.02259, -1.41996, -1.17301>, < 2.29760, -2.59312, -0.72499>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.10028 -0.08284  0.21346 TO c   0.18313 -0.05120  0.16226*/
 cylinder{< 1.41996, -1.17301,  3.02259>, < 2.59312, -0.72499,  2.29760>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.10028 -0.08284  0.21346 TO c   0.05120 -0.16226  0.18313*/
 cylinder{< 1.41996, -1.17301,  3.02259>, < 0.72499, -2.29760,  2.59312>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.21346 -0.10028  0.08284 TO c   0.18313 -0.05120  0.16226*/
 cylinder{< 3.02259, -1.41996,  1.17301>, < 2.59312, -0.72499,  2.29760>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.21346 -0.10028  0.08284 TO c   0.16226 -0.18313  0.05120*/
 cylinder{< 3.02259, -1.41996,  1.17301>, < 2.29760, -2.59312,  0.72499>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.08284  0.21346 -0.10028 TO c   0.05120  0.16226 -0.18313*/
 cylinder{< 1.17301,  3.02259, -1.41996>, < 0.72499,  2.29760, -2.59312>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.08284  0.21346 -0.10028 TO c   0.16226  0.18313 -0.05120*/
 cylinder{< 1.17301,  3.02259, -1.41996>, < 2.29760,  2.59312, -0.72499>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.21346  0.10028 -0.08284 TO c   0.18313  0.05120 -0.16226*/
 cylinder{< 3.02259,  1.41996, -1.17301>, < 2.59312,  0.72499, -2.29760>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.21346  0.10028 -0.08284 TO c   0.16226  0.18313 -0.05120*/
 cylinder{< 3.02259,  1.41996, -1.17301>, < 2.29760,  2.59312, -0.72499>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.08284 -0.21346  0.10028 TO c  -0.05120 -0.16226  0.18313*/
 cylinder{<-1.17301, -3.02259,  1.41996>, <-0.72499, -2.29760,  2.59312>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.08284 -0.21346  0.10028 TO c  -0.16226 -0.18313  0.05120*/
 cylinder{<-1.17301, -3.02259,  1.41996>, <-2.29760, -2.59312,  0.72499>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.21346 -0.10028  0.08284 TO c  -0.18313 -0.05120  0.16226*/
 cylinder{<-3.02259, -1.41996,  1.17301>, <-2.59312, -0.72499,  2.29760>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.21346 -0.10028  0.08284 TO c  -0.16226 -0.18313  0.05120*/
 cylinder{<-3.02259, -1.41996,  1.17301>, <-2.29760, -2.59312,  0.72499>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.10028  0.08284 -0.21346 TO c  -0.05120  0.16226 -0.18313*/
 cylinder{<-1.41996,  1.17301, -3.02259>, <-0.72499,  2.29760, -2.59312>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.10028  0.08284 -0.21346 TO c  -0.18313  0.05120 -0.16226*/
 cylinder{<-1.41996,  1.17301, -3.02259>, <-2.59312,  0.72499, -2.29760>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.21346  0.10028 -0.08284 TO c  -0.16226  0.18313 -0.05120*/
 cylinder{<-3.02259,  1.41996, -1.17301>, <-2.29760,  2.59312, -0.72499>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.21346  0.10028 -0.08284 TO c  -0.18313  0.05120 -0.16226*/
 cylinder{<-3.02259,  1.41996, -1.17301>, <-2.59312,  0.72499, -2.29760>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.21346  0.10028  0.08284 TO c  -0.18313  0.05120  0.16226*/
 cylinder{<-3.02259,  1.41996,  1.17301>, <-2.59312,  0.72499,  2.29760>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.21346  0.10028  0.08284 TO c  -0.16226  0.18313  0.05120*/
 cylinder{<-3.02259,  1.41996,  1.17301>, <-2.29760,  2.59312,  0.72499>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.10028 -0.08284 -0.21346 TO c   0.18313 -0.05120 -0.16226*/
 cylinder{< 1.41996, -1.17301, -3.02259>, < 2.59312, -0.72499, -2.29760>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.10028 -0.08284 -0.21346 TO c   0.05120 -0.16226 -0.18313*/
 cylinder{< 1.41996, -1.17301, -3.02259>, < 0.72499, -2.29760, -2.59312>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.08284 -0.21346 -0.10028 TO c   0.16226 -0.18313 -0.05120*/
 cylinder{< 1.17301, -3.02259, -1.41996>, < 2.29760, -2.59312, -0.72499>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.08284 -0.21346 -0.10028 TO c   0.05120 -0.16226 -0.18313*/
 cylinder{< 1.17301, -3.02259, -1.41996>, < 0.72499, -2.29760, -2.59312>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.08284 -0.21346  0.10028 TO c   0.05120 -0.16226  0.18313*/
 cylinder{< 1.17301, -3.02259,  1.41996>, < 0.72499, -2.29760,  2.59312>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.08284 -0.21346  0.10028 TO c   0.16226 -0.18313  0.05120*/
 cylinder{< 1.17301, -3.02259,  1.41996>, < 2.29760, -2.59312,  0.72499>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.10028  0.08284 -0.21346 TO c   0.18313  0.05120 -0.16226*/
 cylinder{< 1.41996,  1.17301, -3.02259>, < 2.59312,  0.72499, -2.29760>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.10028  0.08284 -0.21346 TO c   0.05120  0.16226 -0.18313*/
 cylinder{< 1.41996,  1.17301, -3.02259>, < 0.72499,  2.29760, -2.59312>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.10028 -0.08284 -0.21346 TO c  -0.18313 -0.05120 -0.16226*/
 cylinder{<-1.41996, -1.17301, -3.02259>, <-2.59312, -0.72499, -2.29760>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.10028 -0.08284 -0.21346 TO c  -0.05120 -0.16226 -0.18313*/
 cylinder{<-1.41996, -1.17301, -3.02259>, <-0.72499, -2.29760, -2.59312>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.08284 -0.21346 -0.10028 TO c  -0.05120 -0.16226 -0.18313*/
 cylinder{<-1.17301, -3.02259, -1.41996>, <-0.72499, -2.29760, -2.59312>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.08284 -0.21346 -0.10028 TO c  -0.16226 -0.18313 -0.05120*/
 cylinder{<-1.17301, -3.02259, -1.41996>, <-2.29760, -2.59312, -0.72499>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.21346 -0.10028 -0.08284 TO c  -0.18313 -0.05120 -0.16226*/
 cylinder{<-3.02259, -1.41996, -1.17301>, <-2.59312, -0.72499, -2.29760>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.21346 -0.10028 -0.08284 TO c  -0.16226 -0.18313 -0.05120*/
 cylinder{<-3.02259, -1.41996, -1.17301>, <-2.29760, -2.59312, -0.72499>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.18313  0.05120  0.16226 TO c   0.18313 -0.05120  0.16226*/
 cylinder{< 2.59312,  0.72499,  2.29760>, < 2.59312, -0.72499,  2.29760>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.05120  0.16226  0.18313 TO c  -0.05120  0.16226  0.18313*/
 cylinder{< 0.72499,  2.29760,  2.59312>, <-0.72499,  2.29760,  2.59312>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.16226  0.18313  0.05120 TO c   0.16226  0.18313 -0.05120*/
 cylinder{< 2.29760,  2.59312,  0.72499>, < 2.29760,  2.59312, -0.72499>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.18313 -0.05120  0.16226 TO c  -0.18313  0.05120  0.16226*/
 cylinder{<-2.59312, -0.72499,  2.29760>, <-2.59312,  0.72499,  2.29760>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.05120 -0.16226  0.18313 TO c   0.05120 -0.16226  0.18313*/
 cylinder{<-0.72499, -2.29760,  2.59312>, < 0.72499, -2.29760,  2.59312>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.05120  0.16226 -0.18313 TO c   0.05120  0.16226 -0.18313*/
 cylinder{<-0.72499,  2.29760, -2.59312>, < 0.72499,  2.29760, -2.59312>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.16226  0.18313 -0.05120 TO c  -0.16226  0.18313  0.05120*/
 cylinder{<-2.29760,  2.59312, -0.72499>, <-2.29760,  2.59312,  0.72499>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.18313 -0.05120 -0.16226 TO c   0.18313  0.05120 -0.16226*/
 cylinder{< 2.59312, -0.72499, -2.29760>, < 2.59312,  0.72499, -2.29760>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.16226 -0.18313 -0.05120 TO c   0.16226 -0.18313  0.05120*/
 cylinder{< 2.29760, -2.59312, -0.72499>, < 2.29760, -2.59312,  0.72499>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.16226 -0.18313  0.05120 TO c  -0.16226 -0.18313 -0.05120*/
 cylinder{<-2.29760, -2.59312,  0.72499>, <-2.29760, -2.59312, -0.72499>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c  -0.18313  0.05120 -0.16226 TO c  -0.18313 -0.05120 -0.16226*/
 cylinder{<-2.59312,  0.72499, -2.29760>, <-2.59312, -0.72499, -2.29760>,  0.10000 
  texture{pigment{color Gray80  }}
 }
 /* Bond: c   0.05120 -0.16226 -0.18313 TO c  -0.05120 -0.16226 -0.18313*/
 cylinder{< 0.72499, -2.29760, -2.59312>, <-0.72499, -2.29760, -2.59312>,  0.10000 
  texture{pigment{color Gray80  }}
 }
/* Labels */
  text { ttf "crystal.ttf","o" 0.15,0
    scale <0.53,0.53,0.53>
    rotate <0, 0, -zrot>
    rotate <0, -yrot, 0>
    rotate <-xrot,0, 0>
    translate <-0.49560,-0.49560,-0.49560> pigment{color Black}
  }
/* Labels */
  text { ttf "crystal.ttf","a" 0.15,0
    scale <0.53,0.53,0.53>
    rotate <0, 0, -zrot>
    rotate <0, -yrot, 0>
    rotate <-xrot,0, 0>
    translate <14.65560, 0.00000, 0.00000> pigment{color Black}
  }
/* Labels */
  text { ttf "crystal.ttf","b" 0.15,0
    scale <0.53,0.53,0.53>
    rotate <0, 0, -zrot>
    rotate <0, -yrot, 0>
    rotate <-xrot,0, 0>
    translate <-0.00000,14.65560, 0.00000> pigment{color Black}
  }
/* Labels */
  text { ttf "crystal.ttf","c" 0.15,0
    scale <0.53,0.53,0.53>
    rotate <0, 0, -zrot>
    rotate <0, -yrot, 0>
    rotate <-xrot,0, 0>
    translate <-0.00000,-0.00000,14.65560> pigment{color Black}
  }
 }
rotate <xrot, 0, 0>
rotate <0, yrot, 0>
rotate <0, 0, zrot>
translate <xmove, ymove, 0>
}
