"""For blender-export.sh, run by Blender: builds a room, renders it by Cycles, saves it, and opens it again for the add-on."""
import math
import os
import sys

import bpy

work = sys.argv[sys.argv.index("--") + 1]
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene


def image(name, width, height, pixel, is_float=False):
    made = bpy.data.images.new(name, width, height, float_buffer=is_float)
    made.pixels = [x for row in range(height) for column in range(width)
                   for x in (*pixel(column / width, row / height), 1)]
    made.filepath_raw = os.path.join(work, name + (".exr" if is_float else ".png"))
    made.file_format = "OPEN_EXR" if is_float else "PNG"
    made.save()
    made.pack()
    return made


def principled(name, color, picture=None, **inputs):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    shader = tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*color, 1)
    for key, value in inputs.items():
        shader.inputs[key.replace("_", " ")].default_value = value
    if picture:
        node = tree.nodes.new("ShaderNodeTexImage")
        node.image = picture
        tree.links.new(node.outputs["Color"], shader.inputs["Base Color"])
    return material


def diffuse(name, color):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.remove(tree.nodes["Principled BSDF"])
    shader = tree.nodes.new("ShaderNodeBsdfDiffuse")
    shader.inputs["Color"].default_value = (*color, 1)
    tree.links.new(shader.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    return material


def add(operator, material, **arguments):
    operator(**arguments)
    bpy.context.object.data.materials.append(material)
    return bpy.context.object


def link(data, location, rotation=(0, 0, 0)):
    obj = bpy.data.objects.new(data.name, data)
    obj.location, obj.rotation_euler = location, rotation
    scene.collection.objects.link(obj)
    return obj


def light(kind, **settings):
    data = bpy.data.lights.new(kind.title(), kind)
    for key, value in settings.items():
        setattr(data, key, value)
    return data


checks = image("checks", 256, 256, lambda u, v: (.7, .6, .5) if (u < .5) == (v < .5) else (.2, .25, .3))
sky = image("sky", 64, 32, lambda u, v: (1.5 * u, .5, 1.5 * (1 - u)) if v > .5 else (.2, .2, .2), True)
numbers = image("numbers", 8, 8, lambda u, v: (.7, .7, .7))
numbers.colorspace_settings.name = "Non-Color"  # linear, while images of glTF are sRGB
mesh = bpy.ops.mesh
add(mesh.primitive_plane_add, principled("floor 1", (1, 1, 1), checks, Roughness=.6), size=10)
add(mesh.primitive_plane_add, diffuse("wall", (.6, .3, .2)), size=10, location=(0, 3, 0), rotation=(math.pi / 2, 0, 0))
add(mesh.primitive_cube_add, principled("box", (.2, .5, .3), Specular=0, Roughness=1), size=1, location=(1.2, .5, .5))
# a cube for the viewport, a ball in the render
ball = add(mesh.primitive_cube_add, principled("ball", (1, 1, 1), numbers, Roughness=.4), size=1.6, location=(-1, 0, .6))
rounded = ball.modifiers.new("round", "SUBSURF")
rounded.levels, rounded.render_levels = 0, 3
metal = add(mesh.primitive_uv_sphere_add, principled("metal", (.9, .7, .3), Metallic=1, Roughness=.3), radius=.35,
            location=(.2, -1, .35))
bpy.ops.object.shade_smooth()
add(mesh.primitive_uv_sphere_add, principled("lacquer", (.02, .02, .02), Specular=0, Roughness=1, Clearcoat=1,
                                             Clearcoat_Roughness=.3), radius=.5, location=(1.4, -1.6, .5))
bpy.ops.object.shade_smooth()
hidden = add(mesh.primitive_cube_add, metal.data.materials[0], size=1, location=(0, -2, 1))
hidden.hide_render = True
aside = bpy.data.collections.new("aside")
scene.collection.children.link(aside)
away = add(mesh.primitive_cube_add, metal.data.materials[0], size=1, location=(.5, -2, .5))
scene.collection.objects.unlink(away)
aside.objects.link(away)
bpy.context.view_layer.layer_collection.children["aside"].exclude = True

area = link(light("AREA", energy=60, shape="RECTANGLE", size=1.5, size_y=.5), (-1, -1, 3), (.3, -.2, .3))
area.scale = (1, 1.4, 1)
link(light("SPOT", energy=150, shadow_soft_size=.1, spot_size=1, spot_blend=.4), (1.5, -2.5, 3), (.6, .2, 0))
link(light("SUN", energy=.3, angle=.1), (0, 0, 5), (.6, .3, 0))
lamp = light("POINT", energy=20, shadow_soft_size=.1)
link(lamp, (2, -1, 1))
link(lamp, (-2, -1, 1))  # the same light twice
scene.world = bpy.data.worlds.new("world")
scene.world.use_nodes = True
tree = scene.world.node_tree
picture, mapping = tree.nodes.new("ShaderNodeTexEnvironment"), tree.nodes.new("ShaderNodeMapping")
picture.image = sky
mapping.inputs["Rotation"].default_value = (0, 0, 1.1)
tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs["Generated"], mapping.inputs["Vector"])
tree.links.new(mapping.outputs[0], picture.inputs[0])
tree.links.new(picture.outputs[0], tree.nodes["Background"].inputs["Color"])
tree.nodes["Background"].inputs["Strength"].default_value = .4

camera = bpy.data.cameras.new("eye")
scene.camera = link(camera, (.5, -6, 2.2), (math.radians(76), 0, math.radians(5)))
camera.lens, camera.shift_x, camera.shift_y = 32, .06, -.05
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 192, 144, 50
scene.render.engine = "CYCLES"
scene.cycles.samples = 256
scene.cycles.use_denoising = scene.cycles.use_adaptive_sampling = False
scene.cycles.sample_clamp_direct = scene.cycles.sample_clamp_indirect = 0
scene.cycles.blur_glossy = 0
scene.cycles.max_bounces = scene.cycles.diffuse_bounces = scene.cycles.glossy_bounces = 16
scene.render.image_settings.file_format = "OPEN_EXR"
scene.render.image_settings.color_depth = "32"
scene.render.filepath = os.path.join(work, "cycles.exr")
bpy.ops.wm.save_as_mainfile(filepath=os.path.join(work, "room.blend"))
bpy.ops.render.render(write_still=True)
