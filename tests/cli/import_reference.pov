// What the models of import_models.py show, as POV-Ray says it: an image lies from <0,0> to <1,1>, seen from -z.
#version 3.7;
global_settings { assumed_gamma 1 }
#default { finish { ambient 0 diffuse 0.96 } }
camera { location <0.75, 0.5, -2.5> right x * 4/3 up y angle degrees(2 * atan(tan(0.3) * 4/3)) look_at <0.75, 0.5, 0> }
background { rgb 0.5 }
#declare Letter = texture { pigment { image_map { png "F.png" interpolate 2 } } }
#declare Card = polygon { 5, <0, 0>, <1, 0>, <1, 1>, <0, 1>, <0, 0> texture { Letter } }
object { Card }
object { Card rotate -90 * y translate <1.25, 0, 0.25> }
