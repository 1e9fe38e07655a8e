"""For blender-features.sh, run by Blender: scenes of one feature each. -- FOLDER SAMPLES NAME… writes NAME.blend and
Cycles' picture of it, NAME.exr, of the names in `features`; without names it prints them."""
import math
import os
import sys

import bpy
import numpy as np

arguments = sys.argv[sys.argv.index("--") + 1:]
features = {}


def feature(function):
    features[function.__name__] = function
    return function


def image(name, pixels, color=True, alpha=None):
    height, width = pixels.shape[:2]
    made = bpy.data.images.new(name, width, height, alpha=alpha is not None)
    alpha = np.ones((height, width)) if alpha is None else alpha
    made.pixels.foreach_set(np.dstack([pixels, alpha]).astype(np.float32).ravel())
    made.filepath_raw, made.file_format = os.path.join(arguments[0], f"{name}.png"), "PNG"
    made.save()
    bpy.data.images.remove(made)
    made = bpy.data.images.load(os.path.join(arguments[0], f"{name}.png"))
    if not color:
        made.colorspace_settings.name = "Non-Color"
    return made


def checks(name="checks", color=(.7, .3, .15)):
    y, x = np.mgrid[0:512, 0:512] // 64
    odd = ((x + y) % 2)[:, :, None]
    return image(name, odd * np.array(color) + (1 - odd) * np.array((.85, .8, .7)))


def material(name, shader_type=None, **inputs):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    if shader_type:
        other = made.node_tree.nodes.new(shader_type)
        made.node_tree.links.new(other.outputs[0], made.node_tree.nodes["Material Output"].inputs["Surface"])
        made.node_tree.nodes.remove(shader)
        shader = other
    for key, value in inputs.items():
        shader.inputs[key.replace("_", " ")].default_value = value
    return made


def shader_of(made):
    return next(n for n in made.node_tree.nodes if n.type == "BSDF_PRINCIPLED")


def textured(name, picture, into="Base Color", **inputs):
    made = material(name, **inputs)
    node = made.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = picture
    made.node_tree.links.new(node.outputs["Color"], shader_of(made).inputs[into])
    return made, node


def add(operator, its, **arguments_of):
    operator(**arguments_of)
    made = bpy.context.object
    if its:
        made.data.materials.append(its)
    return made


def ball(its, location=(0, .3, .8), radius=.8):
    made = add(bpy.ops.mesh.primitive_uv_sphere_add, its, radius=radius, location=location, segments=64, ring_count=32)
    bpy.ops.object.shade_smooth()
    return made


def cube(its, location=(0, .3, .6), size=1.2, rotation=(0, 0, .5)):
    return add(bpy.ops.mesh.primitive_cube_add, its, size=size, location=location, rotation=rotation)


def link(data, name, location, rotation=(0, 0, 0)):
    obj = bpy.data.objects.new(name, data)
    obj.location, obj.rotation_euler = location, rotation
    bpy.context.scene.collection.objects.link(obj)
    return obj


def lamp(kind, energy, location, rotation=(0, 0, 0), **values):
    data = bpy.data.lights.new(kind.lower(), kind)
    data.energy = energy
    for key, value in values.items():
        setattr(data, key, value)
    return link(data, kind.lower(), location, rotation)


RED = {"Base_Color": (.6, .1, .08, 1), "Roughness": .5}


# ---- surfaces ----

@feature
def principled():
    ball(material("paint", Base_Color=(.1, .3, .6, 1), Roughness=.25), (-.8, .3, .7), .7)
    ball(material("steel", Base_Color=(.7, .6, .5, 1), Metallic=1, Roughness=.3), (.8, .3, .7), .7)


@feature
def glass():
    ball(material("glass", Transmission=1, Roughness=0, IOR=1.5))


@feature
def image_and_mapping():
    made, node = textured("tiles", checks())
    tree = made.node_tree
    uv, mapping = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeMapping")
    mapping.inputs["Scale"].default_value, mapping.inputs["Rotation"].default_value = (2, 3, 1), (0, 0, .4)
    tree.links.new(uv.outputs["UV"], mapping.inputs[0])
    tree.links.new(mapping.outputs[0], node.inputs[0])
    cube(made)


@feature
def vertex_colors():
    made = cube(material("colored", Roughness=.7))
    layer = made.data.color_attributes.new("Color", "BYTE_COLOR", "CORNER")
    for k, value in enumerate(layer.data):
        value.color = ((.8, .2, .1, 1), (.1, .6, .2, 1), (.1, .2, .8, 1), (.8, .8, .2, 1))[k % 4]
    tree = made.data.materials[0].node_tree
    node = tree.nodes.new("ShaderNodeVertexColor")
    node.layer_name = "Color"
    tree.links.new(node.outputs["Color"], shader_of(made.data.materials[0]).inputs["Base Color"])


@feature
def masked_alpha():
    y, x = np.mgrid[0:256, 0:256]
    holes = (((x % 64 - 32)**2 + (y % 64 - 32)**2) > 400).astype(np.float32)
    made, node = textured("screen", image("screen", np.full((256, 256, 3), .4), alpha=holes), Roughness=.8)
    made.node_tree.links.new(node.outputs["Alpha"], shader_of(made).inputs["Alpha"])
    made.blend_method = "CLIP"
    add(bpy.ops.mesh.primitive_plane_add, made, size=1.8, location=(0, .3, .9), rotation=(math.pi / 2, 0, .3))


@feature
def bump():
    y, x = np.mgrid[0:512, 0:512] / 512 * 2 * np.pi
    heights = image("dents", np.dstack([.5 + .4 * np.sin(6 * x) * np.sin(5 * y)] * 3), False)
    made = material("dented", **RED)
    tree = made.node_tree
    picture, node = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeBump")
    picture.image = heights
    node.inputs["Strength"].default_value, node.inputs["Distance"].default_value = .5, .1
    tree.links.new(picture.outputs["Color"], node.inputs["Height"])
    tree.links.new(node.outputs[0], shader_of(made).inputs["Normal"])
    ball(made)


@feature
def displacement():
    y, x = np.mgrid[0:512, 0:512] / 512 * 2 * np.pi
    made = material("waves", **RED)
    tree = made.node_tree
    picture, node = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeDisplacement")
    picture.image = image("waves", np.dstack([.5 + .4 * np.sin(4 * x) * np.sin(3 * y)] * 3), False)
    node.inputs["Scale"].default_value = .08
    tree.links.new(picture.outputs["Color"], node.inputs["Height"])
    tree.links.new(node.outputs[0], tree.nodes["Material Output"].inputs["Displacement"])
    made.cycles.displacement_method = "BUMP"
    ball(made)


@feature
def emission():
    ball(material("glow", Emission=(1, .6, .3, 1), Emission_Strength=4, Base_Color=(.1, .1, .1, 1)), (0, .3, .5), .5)


# ---- shapes ----

@feature
def modifiers():
    made = cube(material("rounded", **RED), size=1)
    bevel = made.modifiers.new("bevel", "BEVEL")
    bevel.width, bevel.segments = .15, 4
    array = made.modifiers.new("array", "ARRAY")
    array.count, array.relative_offset_displace = 3, (-.6, .9, .1)
    made.modifiers.new("smooth", "SUBSURF").render_levels = 2


@feature
def geometry_nodes():
    pebble = ball(material("pebble", **RED), (8, 0, 0), .12)
    made = add(bpy.ops.mesh.primitive_grid_add, None, x_subdivisions=5, y_subdivisions=5, size=2, location=(0, .3, .15))
    tree = bpy.data.node_groups.new("scatter", "GeometryNodeTree")
    tree.inputs.new("NodeSocketGeometry", "Geometry")
    tree.outputs.new("NodeSocketGeometry", "Geometry")
    begin, end = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    points, what = tree.nodes.new("GeometryNodeInstanceOnPoints"), tree.nodes.new("GeometryNodeObjectInfo")
    what.inputs[0].default_value = pebble
    tree.links.new(begin.outputs[0], points.inputs["Points"])
    tree.links.new(what.outputs["Geometry"], points.inputs["Instance"])
    tree.links.new(points.outputs[0], end.inputs[0])
    made.modifiers.new("scatter", "NODES").node_group = tree


@feature
def collection_instances():
    inner = bpy.data.collections.new("pair")
    for place in (-.3, .3):
        made = cube(material("part", **RED), (place, 0, .3), .4)
        bpy.context.scene.collection.objects.unlink(made)
        inner.objects.link(made)
    for k in range(3):
        empty = link(None, f"copy{k}", (k - 1, .4 * k, .1), (0, 0, .5 * k))
        empty.instance_type, empty.instance_collection = "COLLECTION", inner


@feature
def curves():
    data = bpy.data.curves.new("pipe", "CURVE")
    data.dimensions, data.bevel_depth, data.bevel_resolution = "3D", .12, 6
    spline = data.splines.new("BEZIER")
    spline.bezier_points.add(2)
    for point, place in zip(spline.bezier_points, ((-1.2, .3, .3), (0, .3, 1.4), (1.2, .3, .3))):
        point.co, point.handle_left_type, point.handle_right_type = place, "AUTO", "AUTO"
    data.materials.append(material("pipe", **RED))
    link(data, "pipe", (0, 0, 0))


@feature
def text():
    data = bpy.data.curves.new("word", "FONT")
    data.body, data.extrude, data.size, data.align_x = "retex", .1, .9, "CENTER"
    data.materials.append(material("letters", **RED))
    link(data, "word", (0, .3, .1), (math.pi / 2, 0, 0))


@feature
def metaballs():
    data = bpy.data.metaballs.new("drops")
    data.render_resolution = data.resolution = .06
    for place in ((-.4, .3, .6), (.4, .3, .6), (0, .3, 1.1)):
        data.elements.new().co, data.elements[-1].radius = place, .8
    data.materials.append(material("drops", **RED))
    link(data, "drops", (0, 0, 0))


@feature
def hair():
    made = ball(material("skin", **RED))
    made.modifiers.new("fur", "PARTICLE_SYSTEM")
    settings = made.particle_systems[0].settings
    settings.type, settings.count, settings.hair_length = "HAIR", 300, .3


# ---- light ----

@feature
def point_light():
    ball(material("red", **RED))
    lamp("POINT", 120, (1.5, -1, 2), shadow_soft_size=.4, color=(1, .8, .6))


@feature
def spot():
    ball(material("red", **RED))
    lamp("SPOT", 400, (1.5, -1.5, 3), (.6, .3, .4), spot_size=.7, spot_blend=.4, shadow_soft_size=.1)


@feature
def sun():
    ball(material("red", **RED))
    lamp("SUN", 3, (0, 0, 4), (.7, .3, 0), angle=.05)


@feature
def area_shapes():
    ball(material("red", **RED))
    lamp("AREA", 60, (-1.5, -1, 2), (.6, -.6, 0), shape="DISK", size=.8)
    lamp("AREA", 60, (1.5, -1, 2), (.6, .6, 0), shape="ELLIPSE", size=1.2, size_y=.4)


@feature
def ies():
    path = os.path.join(arguments[0], "beam.ies")
    with open(path, "w", encoding="ascii") as out:
        out.write("IESNA:LM-63-1995\nTILT=NONE\n1 1000 1 7 1 1 2 0 0 0\n1 1 1\n0 15 30 45 60 75 90\n0\n"
                  "1000 900 600 200 50 10 0\n")
    ball(material("red", **RED))
    obj = lamp("POINT", 40, (1, -1, 2.2), shadow_soft_size=.05)
    obj.data.use_nodes = True
    tree = obj.data.node_tree
    node = tree.nodes.new("ShaderNodeTexIES")
    node.mode, node.filepath = "EXTERNAL", path
    tree.links.new(node.outputs[0], next(n for n in tree.nodes if n.type == "EMISSION").inputs["Strength"])


@feature
def world_image():
    ball(material("red", **RED))
    y, x = np.mgrid[0:128, 0:256] / 128
    sky = np.dstack([.2 + .5 * y, .3 + .4 * y, .6 + .1 * x])
    sky[90:110, 40:70] = 1
    nodes = bpy.context.scene.world.node_tree
    node = nodes.nodes.new("ShaderNodeTexEnvironment")
    node.image = image("sky", sky)
    nodes.links.new(node.outputs[0], nodes.nodes["Background"].inputs[0])


# ---- camera and picture ----

@feature
def depth_of_field():
    ball(material("red", **RED), (-.7, -.8, .5), .5)
    ball(material("blue", Base_Color=(.1, .2, .6, 1)), (.9, 1.5, .5), .5)
    camera = bpy.context.scene.camera.data
    camera.dof.use_dof, camera.dof.focus_distance, camera.dof.aperture_fstop = True, 3.9, .4


@feature
def shifted_lens():
    cube(material("red", **RED))
    camera = bpy.context.scene.camera.data
    camera.shift_x, camera.shift_y = .12, -.08


@feature
def view_transform():
    ball(material("red", **RED))
    bpy.context.scene.view_settings.view_transform = "Filmic"


def set_up(samples):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.samples = "CYCLES", samples
    scene.cycles.use_denoising = scene.cycles.use_adaptive_sampling = False
    scene.cycles.sample_clamp_direct = scene.cycles.sample_clamp_indirect = scene.cycles.blur_glossy = 0
    scene.cycles.max_bounces = scene.cycles.diffuse_bounces = scene.cycles.glossy_bounces = 16
    scene.cycles.transmission_bounces = 16
    scene.cycles.pixel_filter_type = "BOX"
    scene.view_settings.view_transform = "Standard"
    scene.render.resolution_x, scene.render.resolution_y = 160, 120
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.render.image_settings.color_mode = "RGB"
    camera = bpy.data.cameras.new("eye")
    camera.lens = 40
    scene.camera = link(camera, "eye", (0, -4.5, 2.2), (math.radians(70), 0, 0))
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = (.4, .45, .5, 1)
    add(bpy.ops.mesh.primitive_plane_add, material("floor", Base_Color=(.5, .5, .45, 1), Roughness=1), size=9)


if len(arguments) < 3:
    print("\n".join(f"feature {name}" for name in features))
for name in arguments[2:]:
    set_up(int(arguments[1]))
    features[name]()
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(arguments[0], f"{name}.blend"))
    bpy.context.scene.render.filepath = os.path.join(arguments[0], f"{name}.exr")
    bpy.ops.render.render(write_still=True)
