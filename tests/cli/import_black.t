# retex-import: a model whose light is next to none says that its picture is black, and the renderer agrees.
% mean() { /usr/bin/python3 $TESTS/import_black.py "$@"; }
$ mean

# Of the speck: 3 x .0004 m2 x .5 / 140 m2, half of the surface of the bounds.
$ for m in speck out panel lamp label; do
+     retex-import $m.gltf -o $m 2>&1 | grep -o -e 'warning.*' -e 'soft sky'
+     retex-render -q --plain --spp 64 --size 32x24 $m/$m.pov -o $m.exr && echo $m: $(mean $m.exr)
+ done
> warning: the picture will be black, or nearly so: what shines in the model is too faint or too small, what it lights is about 4e-06 of white; --sky FILE lights it
> speck: black
> warning: the picture will be black, or nearly so: the lights of the model are; --sky FILE lights it
> out: black
> panel: light
> lamp: light
> soft sky
> label: light
! retex-render: out/out.pov: warning: its light sources are black, nothing shines and there is no sky: the picture will be black

# A sky is what the line says.
$ cp "$SCENES/textures/brick.jpg" sky.jpg
$ for m in speck out; do
+     retex-import $m.gltf -f --sky sky.jpg -o $m 2>&1 | grep -c black
+     retex-render -q --plain --spp 4 --size 32x24 $m/$m.pov -o $m.exr && echo $m: $(mean $m.exr)
+ done
> 0
> speck: light
> 0
> out: light
