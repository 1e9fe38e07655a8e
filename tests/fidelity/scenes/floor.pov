// A floor of even light, seen from above, or at a grazing angle to beyond 15 units: View is "above" or "grazing".
#version 3.7;
global_settings { assumed_gamma 1 }
#ifndef (View) #declare View = "above"; #end
#declare Floor = texture { pigment { rgb 0.5 } finish { diffuse 1 ambient 0 } };
plane { z, 0 texture { Floor } }
#if (strcmp(View, "above") = 0)
    camera { orthographic location <2, 1.5, -5> look_at <2, 1.5, 0> right 16/9*3*x up 3*y }
#else
    camera { location <2, -1, -0.6> look_at <2, 2, 0> angle 60 right 16/9*x up y sky -z }
#end
light_source { <2, 1.5, -1000000> rgb 1 parallel point_at <2, 1.5, 0> }
