"""Read a render's AOVs through Blender's compositor and say how far they are from what the file holds.

Run by uv-in-blender.sh inside Blender; the argument is the folder with room.exr and aov/uv.exr.
"""
import os
import subprocess
import sys

import bpy
import numpy

folder = sys.argv[sys.argv.index("--") + 1]
SIZE = 64


def pixels(image):
    """Rows from the top."""
    values = numpy.empty(len(image.pixels), numpy.float32)
    image.pixels.foreach_get(values)
    return values.reshape(image.size[1], image.size[0], -1)[::-1]


def stored(part, letters):
    """What the file holds, by OpenImageIO from outside of Blender: it writes floats of the part."""
    raw = os.path.join(folder, part + ".raw")
    code = (
        "import OpenImageIO as o, numpy, sys\n"
        "f = o.ImageInput.open(sys.argv[1]); n = 0\n"
        "while f.spec(n, 0).getattribute('oiio:subimagename') != sys.argv[2]: n += 1\n"
        "s = f.spec(n, 0); p = f.read_image(n, 0, 0, s.nchannels, o.FLOAT)\n"
        "c = [s.channelnames.index(sys.argv[2] + '.' + l) for l in sys.argv[3]]\n"
        "numpy.ascontiguousarray(p[..., c], numpy.float32).tofile(sys.argv[4])\n"
    )
    subprocess.run(["/usr/bin/python3", "-c", code, os.path.join(folder, "room.exr"), part, letters, raw], check=True)
    return numpy.fromfile(raw, numpy.float32).reshape(SIZE, SIZE, -1)


def composite(tree, socket, name):
    """The socket's pixels, by way of an EXR of floats."""
    output = tree.nodes.new("CompositorNodeOutputFile")
    output.base_path = folder
    output.format.file_format = "OPEN_EXR"
    output.format.color_depth = "32"
    output.format.color_mode = "RGBA"
    output.file_slots[0].path = name
    tree.links.new(socket, output.inputs[0])


scene = bpy.context.scene
scene.use_nodes = True
scene.frame_set(1)
scene.render.resolution_x = scene.render.resolution_y = SIZE
scene.render.resolution_percentage = 100
scene.view_settings.view_transform = "Standard"
tree = scene.node_tree
tree.nodes.clear()

room = tree.nodes.new("CompositorNodeImage")
room.image = bpy.data.images.load(os.path.join(folder, "room.exr"))
places = numpy.zeros((256, 256, 4), numpy.float32)
places[..., 0] = (numpy.arange(256) + 0.5)[None, :] / 256
places[..., 1] = (numpy.arange(256) + 0.5)[:, None] / 256
places[..., 3] = 1
image = bpy.data.images.new("places", 256, 256, alpha=True, float_buffer=True)
image.colorspace_settings.name = "Non-Color"
image.pixels.foreach_set(places.ravel())
source = tree.nodes.new("CompositorNodeImage")
source.image = image
map_uv = tree.nodes.new("CompositorNodeMapUV")
tree.links.new(source.outputs[0], map_uv.inputs[0])
tree.links.new(room.outputs["uv"], map_uv.inputs[1])
composite(tree, room.outputs["uv"], "pass")
composite(tree, room.outputs["depth"], "depth")
composite(tree, map_uv.outputs[0], "map")
bpy.ops.render.render()

uv, depth = stored("uv", "UVA"), stored("depth", "R")[..., 0]
hit = uv[..., 2] == 1
found = {}
for name in ("pass", "depth", "map"):
    image = bpy.data.images.load(os.path.join(folder, name + "0001.exr"))
    image.colorspace_settings.name = "Non-Color"
    found[name] = pixels(image)
plain = bpy.data.images.load(os.path.join(folder, "aov", "uv.exr"))
plain.colorspace_settings.name = "Non-Color"
# The image covers 0 to 1, and Map UV filters it by how fast uv changes: at edges of surfaces, where it jumps, the result is
# of neither side.
inside = hit & (found["map"][..., 3] > 0.999)
for axis in (0, 1):
    for shift in (-2, -1, 1, 2):
        inside &= numpy.abs(numpy.roll(uv, shift, axis) - uv).max(axis=2) < 0.15
print("UV pass", float(numpy.abs(found["pass"][..., :3] - uv)[hit].max()), "over", int(hit.sum()))
print("UV depth", float((numpy.abs(found["depth"][..., 0] - depth) / depth)[hit].max()))
off = numpy.abs(found["map"][..., :2] - uv[..., :2])[inside]
print("UV map", float(off.max()) if inside.sum() > 200 else 1e9, "over", int(inside.sum()))
print("UV file", float(numpy.abs(pixels(plain)[..., :2] - uv[..., :2])[hit].max()))
