"""Blender's Cryptomatte nodes take the file of retex-render --mattes: the matte of a name, as they give it.

Run by mattes-in-blender.sh inside Blender; the arguments are the folder, in which mattes.exr is, and KIND/NAME=FILE, each
of which becomes an EXR of floats.
"""
import os
import sys

import bpy

folder, *wanted = sys.argv[sys.argv.index("--") + 1:]
scene = bpy.context.scene
scene.use_nodes = True
scene.frame_set(1)
scene.view_settings.view_transform = "Standard"
tree = scene.node_tree
tree.nodes.clear()
image = bpy.data.images.load(os.path.join(folder, "mattes.exr"))
scene.render.resolution_x, scene.render.resolution_y = 96, 72
scene.render.resolution_percentage = 100
layers = tree.nodes.new("CompositorNodeImage")
layers.image = image


def save(socket, name):
    """The socket's pixels, as an EXR of floats."""
    output = tree.nodes.new("CompositorNodeOutputFile")
    output.base_path = folder
    output.format.file_format = "OPEN_EXR"
    output.format.color_depth = "32"
    output.format.color_mode = "RGBA"
    output.file_slots[0].path = name
    tree.links.new(socket, output.inputs[0])


for text in wanted:
    what, name = text.split("=")
    kind, slash, of = what.partition("/")
    if not slash:
        save(layers.outputs[what], name)
        continue
    node = tree.nodes.new("CompositorNodeCryptomatteV2")
    node.source = "IMAGE"
    node.image = image
    kinds = [item.identifier for item in node.bl_rna.properties["layer_name"].enum_items]
    try:
        node.layer_name = kind
    except TypeError as error:
        print("MATTE error", error, kinds)
        continue
    node.matte_id = of
    save(node.outputs["Matte"], name)
bpy.ops.render.render()
print("MATTE done", len(wanted), image.type)
