"""For blender-scenes.sh, run by Blender: bumps by heights, rendered by Cycles, and a scene with things that glTF cannot say."""
import math
import os
import sys

import bpy
import numpy as np

what, work = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene


def image(name, pixels, ending="jpg"):
    height, width = pixels.shape[:2]
    made = bpy.data.images.new(name, width, height)
    made.pixels.foreach_set(np.dstack([pixels, np.ones((height, width))]).astype(np.float32).ravel())
    made.filepath_raw, made.file_format = os.path.join(work, f"{name}.{ending}"), {"jpg": "JPEG", "png": "PNG"}[ending]
    made.save()
    bpy.data.images.remove(made)
    return bpy.data.images.load(os.path.join(work, f"{name}.{ending}"))


def material(name, **inputs):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    for key, value in inputs.items():
        shader.inputs[key.replace("_", " ")].default_value = value
    return made, made.node_tree, shader


def add(operator, its, **arguments):
    operator(**arguments)
    bpy.context.object.data.materials.append(its)
    return bpy.context.object


def link(data, name, location, rotation=(0, 0, 0)):
    obj = bpy.data.objects.new(name, data)
    obj.location, obj.rotation_euler = location, rotation
    scene.collection.objects.link(obj)
    return obj


def set_up(samples):
    scene.render.engine, scene.cycles.samples = "CYCLES", samples
    scene.cycles.use_denoising = scene.cycles.use_adaptive_sampling = False
    scene.cycles.sample_clamp_direct = scene.cycles.sample_clamp_indirect = scene.cycles.blur_glossy = 0
    scene.cycles.max_bounces = scene.cycles.diffuse_bounces = scene.cycles.glossy_bounces = 16
    scene.cycles.pixel_filter_type = "BOX"
    scene.view_settings.view_transform = "Standard"
    scene.render.resolution_x, scene.render.resolution_y = 160, 120
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.render.image_settings.color_mode = "RGB"
    camera = bpy.data.cameras.new("eye")
    camera.lens = 40
    scene.camera = link(camera, "eye", (0, -4.5, 2.2), (math.radians(68), 0, 0))
    lamp = bpy.data.lights.new("lamp", "POINT")
    lamp.energy, lamp.shadow_soft_size = 150, .3
    link(lamp, "lamp", (-1.5, -2, 2.5))
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = (.3, .35, .4, 1)


def render(name):
    scene.render.filepath = os.path.join(work, name)
    bpy.ops.render.render(write_still=True)


def bumps():
    """A colour's JPEG behind Height of a floor and a ball; and grey numbers as displacement of a wall."""
    y, x = np.mgrid[0:512, 0:512] / 512 * 2 * np.pi
    rise = .5 + .25 * np.sin(4 * x) * np.sin(3 * y) + .12 * np.sin(9 * x + 5 * y)
    wood = image("wood", np.dstack([rise, .7 * rise + .05, .4 * rise]))
    dents = image("dents", np.dstack([.5 + .4 * np.sin(6 * x) * np.sin(5 * y)] * 3), "png")
    dents.colorspace_settings.name = "Non-Color"
    plank, tree, shader = material("Wand gr\u00fcn", Roughness=.35)
    picture, bump = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeBump")
    picture.image = wood
    bump.inputs["Strength"].default_value, bump.inputs["Distance"].default_value = .7, .3
    tree.links.new(picture.outputs["Color"], shader.inputs["Base Color"])
    tree.links.new(picture.outputs["Color"], bump.inputs["Height"])
    tree.links.new(bump.outputs[0], shader.inputs["Normal"])
    wall, tree, shader = material("wall", Roughness=.6, Base_Color=(.6, .4, .3, 1))
    picture, moved = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeDisplacement")
    picture.image, moved.inputs["Scale"].default_value = dents, .15
    tree.links.new(picture.outputs["Color"], moved.inputs["Height"])
    tree.links.new(moved.outputs[0], tree.nodes["Material Output"].inputs["Displacement"])
    add(bpy.ops.mesh.primitive_plane_add, plank, size=4)
    add(bpy.ops.mesh.primitive_plane_add, wall, size=4, location=(0, 2, 1), rotation=(math.pi / 2, 0, 0))
    add(bpy.ops.mesh.primitive_uv_sphere_add, plank, radius=.7, location=(0, .4, .7), segments=64, ring_count=32)
    bpy.ops.object.shade_smooth()
    set_up(8)
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(work, "bumps.blend"))
    render("a.exr")
    scene.cycles.seed = 7
    render("b.exr")
    scene.cycles.samples = 256
    render("cycles.exr")
    for its in plank, wall:
        for made in list(its.node_tree.links):
            if made.to_socket.name in {"Normal", "Displacement"}:
                its.node_tree.links.remove(made)
    render("flat.exr")


def left_out():
    """One of each thing that is told."""
    checks = image("checks", np.indices((16, 16, 3)).sum(0) % 2 * .6 + .2, "png")
    plain, tree, shader = material("plain", Subsurface=.1, Anisotropic=.5, Sheen=.2, Transmission_Roughness=.1)
    picture, ramp, noise, bump = (tree.nodes.new("ShaderNode" + kind) for kind in (
        "TexImage", "ValToRGB", "TexNoise", "Bump"))
    picture.image, picture.projection = checks, "BOX"
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(coordinates.outputs["Generated"], picture.inputs["Vector"])
    tree.links.new(picture.outputs["Color"], ramp.inputs[0])
    tree.links.new(ramp.outputs[0], shader.inputs["Base Color"])
    tree.links.new(noise.outputs[0], shader.inputs["Roughness"])
    tree.links.new(noise.outputs[0], shader.inputs["Specular"])
    tree.links.new(noise.outputs[0], bump.inputs["Height"])
    tree.links.new(bump.outputs[0], shader.inputs["Normal"])
    smoke = tree.nodes.new("ShaderNodeVolumePrincipled")
    tree.links.new(smoke.outputs[0], tree.nodes["Material Output"].inputs["Volume"])
    colored, tree, shader = material("colored")
    picture = tree.nodes.new("ShaderNodeTexImage")
    picture.image = checks
    tree.links.new(picture.outputs["Color"], shader.inputs["Normal"])  # no normals, but a colour
    floor = add(bpy.ops.mesh.primitive_plane_add, plain, size=4)
    floor.modifiers.new("grass", "PARTICLE_SYSTEM").particle_system.settings.type = "HAIR"
    floor.modifiers.new("dust", "PARTICLE_SYSTEM")
    floor.visible_glossy, floor.is_shadow_catcher = False, True
    cube = add(bpy.ops.mesh.primitive_cube_add, colored, size=.5, location=(1, 0, .5))
    cube.instance_type = "FACES"
    child = add(bpy.ops.mesh.primitive_cube_add, colored, size=.1)
    child.parent = cube
    link(bpy.data.metaballs.new("blob"), "blob", (0, 0, 1)).data.elements.new()
    link(bpy.data.volumes.new("cloud"), "cloud", (0, 0, 1))
    set_up(1)
    area = bpy.data.lights.new("window", "AREA")
    area.spread, area.use_nodes = 1, True
    tree = area.node_tree
    tree.links.new(tree.nodes.new("ShaderNodeLightFalloff").outputs[0], tree.nodes["Emission"].inputs["Strength"])
    link(area, "window", (0, 0, 3))
    portal = bpy.data.lights.new("portal", "AREA")
    portal.cycles.is_portal = True
    link(portal, "portal", (0, 0, 4))
    pano = bpy.data.cameras.new("pano")
    pano.type = "PANO"
    link(pano, "pano", (0, 0, 2))
    scene.view_settings.view_transform = "Filmic"
    scene.render.use_motion_blur = scene.render.film_transparent = True
    scene.cycles.film_exposure = 2
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(work, "left-out.blend"))


{"bumps": bumps, "left-out": left_out}[what]()
