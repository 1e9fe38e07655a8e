// A little of every part of the language core.
#version 3.7;
#include "colors.inc"
#declare A = array[2][3] { { 1, 2, 3 }, { 4, -0.5, 1e3 } }
#declare N = array[2] { "text", "more" }
#declare F = function(a, b) { select(a - b, sin(a), max(a, b, 2)) * sum(i, 1, 4, pow(i, b)) }
#declare S = spline { cubic_spline -1, x, 0, y, 1, <1, 2, 3>, 2, 4 * z }
#macro Swap(P, Q) #local T = P; #declare P = Q; #declare Q = T; #end
#macro Tower(N) #if (N > 0) sphere { N * y, 1 / N } Tower(N - 1) #end #end
#local I = 0;
#while (I < 4)
  #switch (I)
    #case (0) #debug "none\n"
    #range (1, 2) #debug concat("some ", str(I, 3, 2)) #break
    #else #warning "more"
  #end
  #declare I = I + 1;
#end
#for (J, 3, 1, -1) #declare B = array[2] { J, J + 1 } #end
#declare U = 1; #declare V = 2; Swap(U, V)
#fopen W "values.txt" write
#write (W, U, ",", <1, 2, 3>, ",\"word\",", V, "\n")
#fclose W
#fopen R "values.txt" read
#ifdef (R) #read (R, C, D, E) #else #error "no file" #end
#fclose R
#declare Q = seed(12);
#declare L = (rand(Q) < 0.5 & defined(U) | V != 2 ? vlength(<1, 2, 3>) : vdot(x, y));
#ifndef (Missing) #undef L #elseif (1) #end
#debug concat(substr("hello", 2, 3), strupr("b"), chr(65), vstr(3, vaxis_rotate(x, y, 90), ",", 0, 2), datetime(0))
#declare M = strcmp("a", "b") + val("1e2") + asc("x") + strlen("four") + F(1, 2) + S(0.5).y + A[1][0];
#declare Parsed = transform { rotate <10, 20, 30> scale 2 matrix <1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0> inverse }
#declare G = function { transform { Parsed } }
camera { location <0, 2, -8> right x * 4 / 3 up y angle 50 look_at y }
light_source { <4, 6, -3>, rgb 1 }
union { Tower(5) pigment { rgb <M / 1000, G(1, 2, 3).x, 0.2> } transform { Parsed } }
