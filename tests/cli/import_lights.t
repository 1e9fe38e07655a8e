# retex-import: lights and lenses of glTF files with what extras say of them, against closed forms.
% judge() { /usr/bin/python3 $TESTS/import_lights.py "$@"; }
$ judge
$ for m in shared ball watts spot sun area ellipse away; do
+     retex-import --exposure 0 -q $m.gltf -o $m &&
+         retex-render -q --plain --spp 64 --size 32x32 $m/$m.pov -o $m.exr &&
+         judge $m $m.exr
+ done
> shared as expected
> ball as expected
> watts as expected
> spot as expected
> sun as expected
> area as expected
> ellipse as expected
> away as expected

# Lengths of lights scale with the scene: it looks the same.
$ for m in ball area; do
+     retex-import --exposure 0 -q --scale 10 $m.gltf -o big-$m &&
+         retex-render -q --plain --spp 64 --size 32x32 big-$m/big-$m.pov -o big-$m.exr &&
+         judge $m big-$m.exr
+ done
> ball as expected
> area as expected

# Falloff of Collada's lights; that scales too.
$ for m in even squared shifted slow; do
+     for s in 1 10; do
+         retex-import --exposure 0 -q --scale $s $m.dae -o $m-$s &&
+             retex-render -q --plain --spp 4 --size 32x32 $m-$s/$m-$s.pov -o $m-$s.exr && judge $m $m-$s.exr
+     done
+ done
> even as expected
> even as expected
> squared as expected
> squared as expected
> shifted as expected
> shifted as expected
> slow as expected
> slow as expected

# An area light is in no light's way: the ceiling above it is lit by all of the floor.
$ for m in empty behind; do
+     retex-import --exposure 0 -q $m.gltf -o $m &&
+         retex-render -q --plain --spp 64 --size 32x32 $m/$m.pov -o $m.exr
+ done
$ judge behind behind.exr empty.exr
> behind as expected

# The window of a shifted lens lies a quarter of its width to the right, and half of its height further down, towards
# the viewer: 4 * 2 tan .3 * .25 is .62, and .5 is 1.24.
$ retex-import --exposure 0 -q lens.gltf -o lens &&
+     retex-render -q --plain --spp 4 --size 32x32 --aov position lens/lens.pov -o lens.exr &&
+     judge position lens.exr
> 0.62 0.00 -1.24
$ grep aperture lens/lens.pov
>   aperture 0.2
$ grep -c 'focal_point <0, 1,' lens/lens.pov
> 1

# Lights shine where POV-Ray can be told so; the others are surfaces that shine, unseen by the camera.
$ grep -h -o '^light_source.*falloff 45' spot/spot.pov
> light_source { <1, 2, 0>, rgb <7957.75, 7957.75, 7957.75> spotlight radius 11.459 falloff 45
$ grep -h -o 'texture { pig.*no_shadow' area/area.pov
> texture { pigment { rgb 1 } finish { diffuse 0 emission rgb <1000, 1000, 1000> } } interior_texture { pigment { rgbt 1 } finish { diffuse 0 } } no_reflection no_image no_shadow
