#!/bin/sh
# retex-info --blender: Blender's compositor rebuilds a retexture from the layers of a set, by its own nodes. Its Map UV
# filters by how far neighbours lie apart, which says nothing in the outermost pixels and along seams of a texture that
# repeats: the former are cut off. Where the texture is smooth, what is left is what the graph leaves out; else it is also
# Blender's own filtering.
set -u
. tests/lib/tap.sh
if ! command -v blender >/dev/null; then
    skip "a graph of Blender's nodes" "Blender is not installed"
    finish
    exit
fi
cd "$work" || exit 1
cat >textures.py <<'END'
import numpy, OpenImageIO as oiio
x = (numpy.arange(256) + 0.5) / 256
u, v = numpy.meshgrid(x, x[::-1])
t = 2 * numpy.pi
for name, planes in (
    ("smooth", [0.5 + 0.4 * numpy.sin(3 * u + 1), 0.2 + 0.6 * v * u, 0.5 + 0.3 * numpy.cos(4 * v)]),
    ("periodic", [0.5 + 0.4 * numpy.sin(t * u), 0.5 + 0.3 * numpy.cos(t * v), 0.5 + 0.2 * numpy.sin(t * (u + v))]),
    ("plain", [0 * u + 0.75, 0 * u + 0.5, 0 * u + 0.125]),
):
    image = oiio.ImageBuf(oiio.ImageSpec(256, 256, 3, oiio.FLOAT))
    image.set_pixels(oiio.ROI(0, 256, 0, 256), numpy.ascontiguousarray(numpy.stack(planes, -1), numpy.float32))
    image.write(name + ".exr")
END
/usr/bin/python3 textures.py
cat >tiles.pov <<'END'
camera { location <0, 3, -3> look_at 0 } light_source { <2, 5, -3>, 1 } background { rgb .3 }
#declare F = texture { pigment { image_map { exr "smooth.exr" } rotate 90*x scale 2 } finish { diffuse .7 } }
plane { y, 0 texture { F } } sphere { <0, .6, 0>, .6 pigment { rgb 1 } }
END
retex-render -q -t Floor --layout paper --size 160x120 --spp 64 --denoise "$scenes/cornell-box/cornell-box.pov" -o room.exr
retex-render -q -t F --layout paper --size 160x120 --spp 64 --denoise tiles.pov -o tiles.exr
# blender_and_retex SET TARGET TEXTURE: one picture by each, also without the two outermost pixels.
blender_and_retex() {
    retex-info "$1.exr" --layers "$1-layers.exr" --blender -o "$1.py"
    blender -b --factory-startup -noaudio --python "$1.py" -- "$3" blender.exr >log 2>&1 || sed 's/^/# /' log
    retex-combine -q "$1.exr" --texture "$2=$3" -o retex.exr
    for by in blender retex; do oiiotool "$by.exr" --cut 156x116+2+2 -o "$by-inside.exr"; done
}
blender_and_retex room Floor plain.exr
same blender.exr retex.exr 60 "a colour, whole"
blender_and_retex room Floor smooth.exr
same blender-inside.exr retex-inside.exr 52 "a smooth texture"
blender_and_retex room Floor "$scenes/textures/terrazzo.jpg"
same blender-inside.exr retex-inside.exr 41 "terrazzo" 1e-2
blender_and_retex tiles F periodic.exr
same blender-inside.exr retex-inside.exr 32 "a smooth texture that repeats" 1e-2
finish
