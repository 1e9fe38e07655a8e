"""Blender to retex: File > Export > retex.

The scene goes to retex-import as a glTF file, by Blender's own exporter. What glTF cannot say goes along: the size and
shape of lights and the camera's lens as custom properties, which become `extras` of glTF nodes (retex-import(1) lists
them), and the world as a picture, which Cycles renders. README.md says how to use it.

Without a window:  blender -b FILE.blend --python retex_export.py -- -o FOLDER [options]
"""
import argparse
import contextlib
import json
import math
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile

import bpy
from bpy.props import BoolProperty, IntProperty, StringProperty

bl_info = {
    "name": "retex",
    "author": "the retex project",
    "version": (1, 0, 0),
    "blender": (3, 4, 0),
    "location": "File > Export > retex; Material properties > retex",
    "description": "Export the scene for retexturing in image space",
    "category": "Import-Export",
}

EXTRAS = "retex"  # the custom property, and the key of glTF extras
WORLD_WIDTH = 2048  # of the sky's picture where the world has no image
MOST_WORLD_WIDTH = 4096


class Failure(Exception):
    """What went wrong, in words for the user."""


def set_for_now(stack, owner, name, value):
    """Set an attribute until the stack ends."""
    before = getattr(owner, name)
    if before != value:
        setattr(owner, name, value)
        stack.callback(setattr, owner, name, before)


# ---- objects ----


def rendered_objects(view_layer):
    """The objects that a render shows: not hidden, in a collection that is not, or in one that is instanced."""
    found = set()

    def walk(layer):
        if layer.exclude or layer.collection.hide_render:
            return
        found.update(o for o in layer.collection.objects if not o.hide_render)
        for child in layer.children:
            walk(child)

    def walk_instances(objects):
        for obj in objects:
            if obj.instance_type == "COLLECTION" and obj.instance_collection:
                inner = {o for o in obj.instance_collection.all_objects if not o.hide_render} - found
                found.update(inner)
                walk_instances(inner)

    walk(view_layer.layer_collection)
    walk_instances(list(found))
    return found


def show_as_rendered(stack, objects):
    """The exporter applies modifiers as the viewport shows them: let it show them as a render does."""
    for obj in objects:
        for modifier in obj.modifiers:
            set_for_now(stack, modifier, "show_viewport", modifier.show_render)
            if modifier.type in {"SUBSURF", "MULTIRES"}:
                set_for_now(stack, modifier, "levels", modifier.render_levels)


NO_MESH = {"VOLUME": "a volume", "CURVES": "hair", "HAIR": "hair", "POINTCLOUD": "a point cloud",
           "GPENCIL": "a grease pencil", "GREASEPENCIL": "a grease pencil"}
RAYS = {"visible_camera": "the camera", "visible_diffuse": "diffuse light", "visible_glossy": "mirrors",
        "visible_transmission": "transmission", "visible_shadow": "shadows", "visible_volume_scatter": "volumes"}


def tell_object(obj, warn):
    """A line for each thing of an object that glTF cannot say, or the exporter does not write."""
    def tell(text):
        warn(f"object '{obj.name}': {text}")

    if obj.type in NO_MESH:
        tell(f"it is {NO_MESH[obj.type]}: it is left out")
    for system in obj.particle_systems if obj.type == "MESH" else ():
        hair = system.settings.type == "HAIR"
        tell(f"its {'hair' if hair else 'particles'} '{system.name}' {'is' if hair else 'are'} left out")
    for modifier in obj.modifiers:
        if modifier.type == "FLUID" and modifier.show_render and modifier.fluid_type == "DOMAIN":
            tell("its smoke or liquid is left out")
    if obj.instance_type in {"VERTS", "FACES"} and obj.children:
        tell("its instances on vertices or faces are left out")
    if obj.type not in {"MESH", "CURVE", "SURFACE", "FONT"}:
        return
    unseen = [what for name, what in RAYS.items() if not getattr(obj, name, True)]
    if unseen:
        tell(f"{', '.join(unseen)} see it too")
    for name, what in (("is_holdout", "holdout"), ("is_shadow_catcher", "shadow catcher")):
        if getattr(obj, name, False):
            tell(f"it is no {what} but an ordinary surface")


MOST_INSTANCES = 100000


def has_instances(obj):
    return any(m.type == "NODES" and m.show_render for m in obj.modifiers)


def add_for_now(stack, scene, mesh, like, matrix):
    """An object with that mesh in the scene, until the stack ends."""
    made = bpy.data.objects.new(like.name, mesh)
    scene.collection.objects.link(made)
    made.matrix_world = matrix
    for slot, its in zip(made.material_slots, like.material_slots):
        if its.link == "OBJECT":
            slot.link, slot.material = "OBJECT", its.material
    stack.callback(bpy.data.objects.remove, made)


def realize(stack, context, objects, warn):
    """What the exporter has no objects for becomes some: instances by geometry nodes, and metaballs."""
    for obj in objects:
        if obj.type == "META":
            set_for_now(stack, obj.data, "resolution", obj.data.render_resolution)
    graph = context.evaluated_depsgraph_get()
    graph.update()
    wanted, counts = [], {}
    for instance in graph.object_instances:
        parent = instance.parent.original if instance.is_instance and instance.parent else None
        if parent in objects and has_instances(parent) and instance.object.type == "MESH":
            counts[parent] = counts.get(parent, 0) + 1
            if counts[parent] <= MOST_INSTANCES:
                wanted.append((instance.object.data.name, instance.object.original, parent,
                               instance.matrix_world.copy()))
    meshes = {}
    for instance in graph.object_instances:  # meshes of generated objects live as long as the loop's step
        if instance.is_instance and instance.object.type == "MESH" and instance.parent and \
                instance.parent.original in counts and instance.object.data.name not in meshes:
            meshes[instance.object.data.name] = instance.object.data.copy()
    balls = [(obj, bpy.data.meshes.new_from_object(obj.evaluated_get(graph))) for obj in objects if obj.type == "META"]
    for mesh in [*meshes.values(), *(mesh for _, mesh in balls)]:
        stack.callback(bpy.data.meshes.remove, mesh)
    for name, like, parent, matrix in wanted:
        if counts[parent] <= MOST_INSTANCES:
            add_for_now(stack, context.scene, meshes[name], like, matrix)
    for obj, mesh in balls:
        if mesh.polygons:  # of several that melt together, the first has them
            add_for_now(stack, context.scene, mesh, obj, obj.matrix_world)
    for parent, count in counts.items():
        if count > MOST_INSTANCES:
            warn(f"object '{parent.name}': its {count} instances by geometry nodes are left out: they are too many")


def mend_colors_of_corners(stack):
    """Blender 3.4's exporter takes colours of corners by the numbers of vertices."""
    import numpy as np
    try:
        from io_scene_gltf2.blender.exp import gltf2_blender_gather_primitives_extract as extract
        creator, name = extract.PrimitiveCreator, "_PrimitiveCreator__get_color_attribute"
        exporters = getattr(creator, name)
    except (ImportError, AttributeError):
        return

    def get_color_attribute(self, attribute):
        exporters(self, attribute)
        if attribute["blender_domain"] != "CORNER":
            return
        layers = self.blender_mesh.color_attributes
        colors = np.empty(4 * len(self.blender_mesh.loops), np.float32)
        layers[layers.render_color_index].data.foreach_get("color", colors)
        for k in range(4):
            self.dots[attribute["gltf_attribute_name"] + str(k)] = colors[k::4]

    set_for_now(stack, creator, name, get_color_attribute)


def tell_scene(scene, warn):
    """What Cycles does to all of the picture."""
    render, view = scene.render, scene.view_settings
    cycles = getattr(scene, "cycles", None)
    if render.engine != "CYCLES":
        warn(f"the scene is set up for {render.engine.replace('BLENDER_', '').title()}; retex renders as Cycles does")
    if view.view_transform not in {"Standard", "Raw"} or view.look != "None" or view.exposure or view.gamma != 1:
        warn(f"the view transform {view.view_transform} is left out: the picture is plain sRGB")
    world = scene.world
    output = world.node_tree.get_output_node("CYCLES") if world and world.use_nodes and world.node_tree else None
    for is_there, what in (
            (cycles and cycles.film_exposure != 1, "the exposure of the film"),
            (render.use_motion_blur, "motion blur"),
            (render.film_transparent, "the transparency of the film"),
            (render.use_compositing and scene.use_nodes, "compositing"),
            (render.use_freestyle, "Freestyle"),
            (render.use_border, "the render region"),
            (render.pixel_aspect_x != render.pixel_aspect_y, "the aspect of pixels"),
            (output and output.inputs["Volume"].is_linked, "the volume of the world")):
        if is_there:
            warn(f"{what} is left out")


# ---- lights and cameras ----


def emission_factor(light):
    """What the light's nodes multiply its colour by."""
    if not light.use_nodes or not light.node_tree:
        return (1, 1, 1)
    for node in light.node_tree.nodes:
        if node.type == "EMISSION" and not node.inputs["Color"].is_linked and not node.inputs["Strength"].is_linked:
            strength = node.inputs["Strength"].default_value
            return tuple(strength * c for c in node.inputs["Color"].default_value[:3])
    return (1, 1, 1)


def is_portal(obj):
    """It guides Cycles to the world's light, and gives none."""
    return obj.type == "LIGHT" and getattr(getattr(obj.data, "cycles", None), "is_portal", False)


def area_of(obj):
    """Width and height of an area light, without the object's scale."""
    light = obj.data
    return (light.size, light.size_y if light.shape in {"RECTANGLE", "ELLIPSE"} else light.size)


def light_extras(obj):
    """A light as Cycles sees it: intensity in W/sr, irradiance of the sun in W/m2, radiance of an area."""
    light = obj.data
    color = [a * b * light.energy for a, b in zip(light.color, emission_factor(light))]
    extras = {}
    if light.type == "AREA":
        width, height = area_of(obj)
        scale = obj.matrix_world.to_scale()
        area = abs(width * scale.x * height * scale.y)
        is_ellipse = light.shape in {"DISK", "ELLIPSE"}
        area *= math.pi / 4 if is_ellipse else 1
        extras["shape"] = "ellipse" if is_ellipse else "rectangle"
        extras["size"] = [width, height]
        extras["radiance"] = [c / (4 * area) if area > 0 else 0 for c in color]
    elif light.type == "SUN":
        extras["intensity"] = color
        extras["angle"] = light.angle
    else:
        extras["intensity"] = [c / (4 * math.pi) for c in color]
        extras["radius"] = light.shadow_soft_size
    if light.type == "SPOT":
        outer = math.cos(light.spot_size / 2)
        extras["inner"] = math.acos(outer + (1 - outer) * light.spot_blend)
        if bpy.app.version < (4, 0, 0):
            extras["tightness"] = 1  # Cycles dims by the cosine
    return extras


def camera_extras(obj, scene):
    """What moves and opens the lens."""
    camera, extras = obj.data, {}
    frame = camera.view_frame(scene=scene)
    low = [min(corner[k] for corner in frame) for k in range(2)]
    high = [max(corner[k] for corner in frame) for k in range(2)]
    shift = [(low[k] + high[k]) / 2 / (high[k] - low[k]) for k in range(2)]
    if max(abs(s) for s in shift) > 1e-6:
        extras["shift"] = shift
    if camera.dof.use_dof and camera.type == "PERSP":
        focus = camera.dof.focus_distance
        if camera.dof.focus_object:
            focus = -(obj.matrix_world.normalized().inverted() @ camera.dof.focus_object.matrix_world.translation).z
        extras["lens_radius"] = camera.lens / 1000 / (2 * camera.dof.aperture_fstop)
        extras["focus_distance"] = focus
    return extras


def tell_light(obj, warn):
    light, cycles = obj.data, getattr(obj.data, "cycles", None)
    nodes = light.node_tree.nodes if light.use_nodes and light.node_tree else ()
    others = sorted({n.bl_label for n in nodes if n.type not in {"EMISSION", "OUTPUT_LIGHT", "FRAME", "REROUTE"}})
    for is_there, what in (
            (light.type == "AREA" and light.spread < math.pi - 1e-3, "its spread is"),
            (others, f"of its nodes, {', '.join(others)} is"),
            (cycles and not getattr(cycles, "cast_shadow", True), "that it casts no shadow is"),
            (light.type == "SPOT" and light.use_square, "its square shape is"),
            (any(not getattr(obj, name, True) for name in RAYS if name != "visible_camera"), "its ray visibility is")):
        if is_there:
            warn(f"light '{obj.name}': {what} left out")


def tell_camera(obj, warn):
    camera = obj.data
    if camera.type == "PANO":
        warn(f"camera '{obj.name}': it is panoramic: it is left out")
    if camera.dof.use_dof and camera.type == "ORTHO":
        warn(f"camera '{obj.name}': its depth of field is left out")
    elif camera.dof.use_dof and (camera.dof.aperture_blades or camera.dof.aperture_ratio != 1):
        warn(f"camera '{obj.name}': its lens is round, without blades")


def tell_extras(stack, scene, objects, warn):
    """Give lights and cameras the custom property that the exporter writes as extras."""
    for obj in objects:
        if obj.type == "LIGHT":
            extras = light_extras(obj)
            tell_light(obj, warn)
        elif obj.type == "CAMERA":
            extras = camera_extras(obj, scene)
            tell_camera(obj, warn)
        else:
            continue
        if extras:
            obj[EXTRAS] = extras
            stack.callback(obj.pop, EXTRAS, None)


# ---- materials ----


def used_materials(objects):
    found = {}
    for obj in objects:
        for slot in getattr(obj, "material_slots", ()):
            if slot.material:
                found[slot.material.name] = slot.material
    return found


def surface_link(material):
    """The link into the active output's surface, or None."""
    output = material.node_tree.get_output_node("CYCLES") if material.use_nodes and material.node_tree else None
    links = output.inputs["Surface"].links if output else ()
    return links[0] if links else None


# Shaders that a Principled one can say: what its sockets get. A name takes the socket of that name, with its link.
SAME_AS_PRINCIPLED = {
    "BSDF_DIFFUSE": {"Base Color": "Color", "Roughness": 0.5, "Specular": 0.0},  # 0.5 is next to Lambert
    "BSDF_GLOSSY": {"Base Color": "Color", "Roughness": "Roughness", "Metallic": 1.0},
    "BSDF_ANISOTROPIC": {"Base Color": "Color", "Roughness": "Roughness", "Metallic": 1.0},
    "BSDF_GLASS": {"Base Color": "Color", "Roughness": "Roughness", "IOR": "IOR", "Transmission": 1.0},
    "EMISSION": {"Base Color": (0, 0, 0, 1), "Specular": 0.0, "Emission": "Color", "Emission Strength": "Strength"},
}
NEW_NAMES = {"Specular": "Specular IOR Level", "Transmission": "Transmission Weight", "Emission": "Emission Color"}


def socket_of(node, name):
    """Blender 4 has renamed some."""
    return node.inputs.get(name) or node.inputs.get(NEW_NAMES.get(name, ""))


def copy_socket(tree, source, to):
    if source.is_linked:
        tree.links.new(source.links[0].from_socket, to)
    else:
        to.default_value = source.default_value


def make_principled(stack, material, link):
    """Put a Principled shader in the place of a simple one."""
    tree, node, to = material.node_tree, link.from_node, link.to_socket
    shader, before = tree.nodes.new("ShaderNodeBsdfPrincipled"), link.from_socket
    for name, value in SAME_AS_PRINCIPLED[node.type].items():
        socket = socket_of(shader, name)
        if isinstance(value, str):
            copy_socket(tree, node.inputs[value], socket)
        else:
            socket.default_value = value
    if "Normal" in node.inputs and node.inputs["Normal"].is_linked:
        copy_socket(tree, node.inputs["Normal"], shader.inputs["Normal"])
    tree.links.new(shader.outputs[0], to)

    def undo():
        tree.links.new(before, to)
        tree.nodes.remove(shader)

    stack.callback(undo)


def prepare_material(stack, material, warn):
    link = surface_link(material)
    if not material.use_nodes:
        return
    if link and link.from_node.type in SAME_AS_PRINCIPLED:
        make_principled(stack, material, link)
    elif not link or link.from_node.type != "BSDF_PRINCIPLED":
        shader = link.from_node.bl_label if link else "nothing"
        warn(f"material '{material.name}': its surface is {shader}, not a Principled BSDF: it may look different")
        return
    shader = surface_link(material).from_node
    transmission, ior = socket_of(shader, "Transmission"), shader.inputs["IOR"]
    if bpy.app.version < (4, 0, 0) and not (transmission.is_linked or transmission.default_value or ior.is_linked):
        set_for_now(stack, ior, "default_value", 1.5)  # Specular alone is the reflectance, which glTF's index is of
    coat = shader.inputs.get("Clearcoat")  # before Blender 4, where 1 is a quarter of a coat
    if coat and coat.is_linked:
        warn(f"material '{material.name}': its clear coat comes from nodes: it is four times as strong")
    elif coat:
        set_for_now(stack, coat, "default_value", coat.default_value / 4)
    alpha = shader.inputs["Alpha"]
    if (alpha.is_linked or alpha.default_value < 1) and getattr(material, "blend_method", "") == "OPAQUE":
        set_for_now(stack, material, "blend_method", "BLEND")  # Cycles knows no blend modes
    encode_images(stack, shader)
    take_bumps(stack, material, shader, warn)
    tell_sockets(material, shader, warn)


# glTF decodes images of colours as sRGB and takes others as numbers, whatever a file's nodes say.
AS_NUMBERS = {"Raw", "Non-Color", "Linear", "Linear Rec.709"}
IS_COLOR = {"Base Color": True, "Emission": True, "Roughness": False, "Metallic": False, "Transmission": False}


def image_nodes(socket, depth=0):
    for link in socket.links if depth < 16 else ():
        if link.from_node.type == "TEX_IMAGE" and link.from_node.image:
            yield link.from_node
        for inner in link.from_node.inputs:
            yield from image_nodes(inner, depth + 1)


def encoded_copy(stack, image, is_color):
    """The image with the numbers that glTF needs to mean the same: encoded as sRGB, or decoded."""
    import numpy as np
    width, height = image.size
    pixels = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(pixels)
    rgb = pixels.reshape(-1, 4)[:, :3]
    if is_color:
        rgb[:] = np.where(rgb <= .0031308, 12.92 * rgb, 1.055 * np.maximum(rgb, 1e-6)**(1 / 2.4) - .055)
    else:
        rgb[:] = np.where(rgb <= .04045, rgb / 12.92, ((rgb + .055) / 1.055)**2.4)
    made = bpy.data.images.new(image.name + " for glTF", width, height, alpha=True)
    stack.callback(bpy.data.images.remove, made)
    made.colorspace_settings.name = "sRGB" if is_color else "Non-Color"
    made.pixels.foreach_set(pixels)
    made.pack()
    return made


def encode_images(stack, shader):
    copies = {}
    for name, is_color in IS_COLOR.items():
        socket = socket_of(shader, name)
        for node in image_nodes(socket) if socket else ():
            image = node.image
            if image.is_float or (image.colorspace_settings.name in AS_NUMBERS) != is_color:
                continue
            key = (image.name, is_color)
            if key not in copies:
                copies[key] = encoded_copy(stack, image, is_color)
            set_for_now(stack, node, "image", copies[key])


# ---- bumps ----


def unlink(stack, tree, socket):
    """Take the links of a socket away until the stack ends."""
    for link in list(socket.links):
        stack.callback(tree.links.new, link.from_socket, socket)
        tree.links.remove(link)


def behind(socket):
    """The socket that a link comes from, through nodes that change nothing; or None."""
    while socket.is_linked:
        source = socket.links[0].from_socket
        if source.node.type not in {"REROUTE", "RGBTOBW"}:  # Blender takes the luminance of colours as heights
            return source
        socket = source.node.inputs[0]
    return None


def heights_image(socket, tell):
    """The node of the image that a socket takes heights from, or None, which is told."""
    source = behind(socket)
    if source and source.node.type == "TEX_IMAGE" and source.node.image and source.name == "Color":
        return source.node
    if socket.is_linked:
        what = f"are made by {source.node.bl_label}" if source else "are not there"
        tell(f"its bumps {what}, not by an image alone: they are left out")
    return None


def number_of(socket, tell):
    if socket.is_linked:
        tell(f"its bumps' {socket.name} comes from nodes: {socket.default_value:g} is taken")
    return socket.default_value


def bump_of(node, tell):
    """The image of a Bump node, its distance and strength; or None."""
    image = heights_image(node.inputs["Height"], tell)
    if node.inputs["Normal"].is_linked:
        tell("bumps upon bumps or a normal map: those below are left out")
    distance = number_of(node.inputs["Distance"], tell) * (-1 if node.invert else 1)
    return image and (image, distance, min(max(number_of(node.inputs["Strength"], tell), 0), 1))


def displacement_bump(material, tell):
    """The same of a material's displacement, which Cycles shows as bumps unless it is told to move the surface."""
    output = material.node_tree.get_output_node("CYCLES")
    source = behind(output.inputs["Displacement"]) if output else None
    if not source:
        return None
    if getattr(getattr(material, "cycles", None), "displacement_method", "BUMP") != "BUMP":
        tell("its displacement is shown as bumps: the surface is not moved")
    if source.node.type != "DISPLACEMENT":
        tell(f"its displacement is made by {source.node.bl_label}: it is left out")
        return None
    image = heights_image(source.node.inputs["Height"], tell)
    return image and (image, number_of(source.node.inputs["Scale"], tell), 1)


def show_heights(stack, material, shader, image, distance, strength):
    """The exporter writes the image behind a Normal Map node as that of normals. A custom property, which becomes
    extras of the material, says that it has heights."""
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeNormalMap")
    stack.callback(tree.nodes.remove, node)
    tree.links.new(image.outputs["Color"], node.inputs["Color"])
    tree.links.new(node.outputs[0], shader.inputs["Normal"])
    numbers = image.image.colorspace_settings.name in AS_NUMBERS
    material[EXTRAS] = {"bump": {"distance": distance, "strength": strength, "numbers": numbers}}
    stack.callback(material.pop, EXTRAS, None)


def take_bumps(stack, material, shader, warn):
    """Normals of a Principled shader: the exporter would take any image behind them as a normal map."""
    def tell(text):
        warn(f"material '{material.name}': {text}")

    tree, bump = material.node_tree, None
    for name in ("Normal", "Clearcoat Normal", "Coat Normal"):
        socket = shader.inputs.get(name)
        source = behind(socket) if socket else None
        if not source or (source.node.type == "NORMAL_MAP" and source.node.space == "TANGENT"):
            continue
        if name == "Normal" and source.node.type == "BUMP":
            bump = bump_of(source.node, tell)
        else:
            tell(f"its {name} is made by {source.node.bl_label}: it is left out")
        unlink(stack, tree, socket)
    if not shader.inputs["Normal"].is_linked and not bump:
        bump = displacement_bump(material, tell)
    if bump:
        show_heights(stack, material, shader, *bump)


# ---- what glTF takes none of ----


# Sockets of a Principled shader with which glTF can have images; of others it takes numbers, or nothing.
TAKES_IMAGES = {"Base Color", "Roughness", "Metallic", "Alpha", "Emission", "Emission Color", "Transmission",
                "Transmission Weight", "Clearcoat", "Coat Weight", "Clearcoat Roughness", "Coat Roughness"}
NOT_TAKEN = {"Subsurface": "subsurface scattering", "Subsurface Weight": "subsurface scattering", "Sheen": "sheen",
             "Sheen Weight": "sheen", "Anisotropic": "anisotropy", "Transmission Roughness": "roughness of transmission",
             "Thin Film Thickness": "thin film"}
BUMP_SOCKETS = {"Normal", "Clearcoat Normal", "Coat Normal"}
# Nodes that glTF, or the exporter, can say between an image and a shader.
KEEPS_IMAGES = {"TEX_IMAGE", "REROUTE", "VERTEX_COLOR", "ATTRIBUTE", "RGB", "VALUE", "SEPRGB", "SEPARATE_COLOR", "MAPPING",
                "TEX_COORD", "UVMAP", "GROUP"}
MULTIPLIES = {"MIX_RGB": "blend_type", "MIX": "blend_type", "MATH": "operation"}


def nodes_behind(socket):
    """All nodes that a socket's value comes from."""
    found, todo = [], [link.from_node for link in socket.links]
    while todo:
        node = todo.pop()
        if node not in found:
            found.append(node)
            todo += [link.from_node for inner in node.inputs for link in inner.links]
    return found


def changes_images(node):
    if node.type in MULTIPLIES:
        return getattr(node, MULTIPLIES[node.type]) != "MULTIPLY"
    return node.type not in KEEPS_IMAGES


def tell_image(node, tell):
    """What is left out of an image, or of how it lies on the surface."""
    image = node.image
    if image.source == "FILE" and not image.packed_file and not image.has_data and not image.size[0]:
        tell(f"the image '{image.name}' is missing")
    if image.source in {"SEQUENCE", "MOVIE", "TILED"}:
        tell(f"of the image '{image.name}' one frame or tile is taken")
    if node.projection != "FLAT":
        tell(f"the image '{image.name}' lies on UV, not by projection {node.projection.title()}")
    for other in nodes_behind(node.inputs["Vector"]):
        outputs = {o.name for o in other.outputs if o.is_linked}
        if other.type == "TEX_COORD" and outputs - {"UV"}:
            tell(f"the image '{image.name}' lies on UV, not on coordinates {' and '.join(sorted(outputs - {'UV'}))}")
        elif other.type not in {"TEX_COORD", "UVMAP", "MAPPING", "REROUTE"}:
            tell(f"the image '{image.name}' lies on UV without the node {other.bl_label}")


def tell_sockets(material, shader, warn):
    """A line for each input that the picture lacks, or has otherwise."""
    told = set()

    def tell(text):
        if text not in told:
            told.add(text)
            warn(f"material '{material.name}': {text}")

    for name, what in NOT_TAKEN.items():
        socket = shader.inputs.get(name)
        if socket and (socket.is_linked or socket.default_value > 0):
            tell(f"{what} is left out")
    for socket in shader.inputs.values():
        if not socket.is_linked or socket.name in NOT_TAKEN:
            continue
        nodes = nodes_behind(socket)
        for node in nodes:
            if node.type == "TEX_IMAGE" and node.image:
                tell_image(node, tell)
        if socket.name in BUMP_SOCKETS:
            continue
        if socket.name not in TAKES_IMAGES:
            tell(f"{socket.name} comes from nodes; glTF takes none of it")
        elif not any(node.type in {"TEX_IMAGE", "VERTEX_COLOR", "RGB", "VALUE"} for node in nodes):
            tell(f"{socket.name} comes from nodes without an image; glTF takes none of it")
        else:
            changing = sorted({node.bl_label for node in nodes if changes_images(node)})
            if changing:
                tell(f"{socket.name}: {', '.join(changing)} is left out, the image is taken as it is")


def tell_material(material, warn):
    output = material.node_tree.get_output_node("CYCLES") if material.use_nodes and material.node_tree else None
    if output and output.inputs["Volume"].is_linked:
        warn(f"material '{material.name}': its volume is left out")


def ticked_targets(materials):
    """The names of targets, each once."""
    return sorted({m.retex_target_name or m.name for m in materials if m.retex_target})


def uses_vertex_colors(materials):
    return any(node.type in {"VERTEX_COLOR", "ATTRIBUTE"}
               for m in materials if m.use_nodes and m.node_tree for node in m.node_tree.nodes)


def identifier(name):
    """The name that retex-import gives a material."""
    words = "_".join(re.findall(r"[A-Za-z0-9]+", name))[:48].rstrip("_") or "Material"
    if words[0].isdigit():
        words = "Material_" + words
    return words[0].upper() + words[1:]


def identifiers(names):
    """The same of several, in their order: no two are the same, whatever the case."""
    taken, found = {}, []
    for name in names:
        made = first = identifier(name)
        number = taken.get(first.lower(), 2)
        while made.lower() in taken:
            made, number = f"{first[:52]}_{number}", number + 1
            taken[first.lower()] = number
        taken[made.lower()] = 2
        found.append(made)
    return found


def material_identifiers(glb):
    """Of each material of the file, by the name that Blender has."""
    with open(glb, "rb") as file:
        text = json.loads(file.read(struct.unpack("<5I", file.read(20))[3]))
    names = [material["name"] for material in text.get("materials", ())]
    return dict(reversed(list(zip(names, identifiers(names)))))


def target_name(name):
    """Without what the name of a target cannot have."""
    legal = "".join(c if c.isalnum() or c in " _-.+()" or ord(c) > 160 else "_" for c in name).strip().lstrip(".")
    return legal.encode()[:127].decode(errors="ignore") or "target"


# ---- the world ----


def world_images(tree):
    for node in tree.nodes:
        if node.type == "TEX_ENVIRONMENT" and node.image:
            yield node.image
        elif node.type == "GROUP" and node.node_tree:
            yield from world_images(node.node_tree)


def world_is_black(world):
    if not world:
        return True
    if not world.use_nodes or not world.node_tree:
        return max(world.color) <= 0
    for node in world.node_tree.nodes:
        if node.type == "BACKGROUND" and node.outputs[0].is_linked:
            strength, color = node.inputs["Strength"], node.inputs["Color"]
            if (strength.is_linked or strength.default_value > 0) and (
                    color.is_linked or max(color.default_value[:3]) > 0):
                return False
        elif node.type == "GROUP":
            return False
    return True


def world_width(world):
    if not world.use_nodes or not world.node_tree:
        return 16
    tree = world.node_tree
    widths = [image.size[0] for image in world_images(tree)]
    if widths:
        return min(max(max(widths), 16), MOST_WORLD_WIDTH)
    return WORLD_WIDTH if any(n.type.startswith("TEX_") or n.type == "GROUP" for n in tree.nodes) else 16


def render_world(world, path):
    """A picture of the world, twice as wide as high, as --sky of retex-import takes it: Cycles renders it."""
    scene = bpy.data.scenes.new("retex world")
    camera = bpy.data.cameras.new("retex world")
    eye = bpy.data.objects.new("retex world", camera)
    try:
        scene.world = world
        scene.collection.objects.link(eye)
        scene.camera = eye
        eye.rotation_euler = (math.pi / 2, 0, -math.pi / 2)
        scene.render.engine = "CYCLES"
        camera.type = "PANO"
        panorama = camera if hasattr(camera, "panorama_type") else camera.cycles
        panorama.panorama_type = "EQUIRECTANGULAR"
        scene.cycles.samples = 16
        scene.cycles.use_denoising = False
        scene.cycles.use_adaptive_sampling = False
        scene.cycles.film_exposure = 1
        scene.render.film_transparent = False
        scene.render.resolution_x = world_width(world)
        scene.render.resolution_y = scene.render.resolution_x // 2
        scene.render.resolution_percentage = 100
        scene.render.image_settings.file_format = "OPEN_EXR"
        scene.render.image_settings.color_depth = "32"
        scene.render.image_settings.color_mode = "RGB"
        scene.render.use_file_extension = False
        scene.render.filepath = path
        bpy.ops.render.render(write_still=True, scene=scene.name)
    finally:
        bpy.data.scenes.remove(scene)
        bpy.data.cameras.remove(camera)


# ---- the export ----


def export_gltf(path, **more):
    wanted = {
        "filepath": path, "export_format": "GLB", "use_active_scene": True, "use_renderable": True,
        "use_selection": False, "use_visible": False, "export_apply": True, "export_cameras": True,
        "export_lights": True, "export_extras": True, "export_yup": True, "export_animations": False,
        "export_skins": False, "export_morph": False, "export_import_convert_lighting_mode": "SPEC",
        "export_vertex_color": "MATERIAL", **more,
    }
    known = bpy.ops.export_scene.gltf.get_rna_type().properties.keys()
    bpy.ops.export_scene.gltf(**{key: value for key, value in wanted.items() if key in known})


@contextlib.contextmanager
def without_chatter():
    """Blender's exporter and Cycles print to the process's own streams. What they print is shown if they fail."""
    sys.stdout.flush()
    sys.stderr.flush()
    kept = {number: os.dup(number) for number in (1, 2)}
    failed = True
    with tempfile.TemporaryFile() as said:
        try:
            for number in kept:
                os.dup2(said.fileno(), number)
            yield
            failed = False
        finally:
            sys.stdout.flush()
            sys.stderr.flush()
            for number, copy in kept.items():
                os.dup2(copy, number)
                os.close(copy)
            if failed:
                said.seek(0)
                os.write(2, said.read())


def tool(name):
    addon = bpy.context.preferences.addons.get(__name__)
    folder = addon.preferences.folder if addon and addon.preferences else ""
    found = shutil.which(name, path=bpy.path.abspath(folder)) if folder else shutil.which(name)
    if not found:
        raise Failure(f"{name} is not found: set the folder of retex's programs in the add-on's preferences, or PATH")
    return found


def run(command, tell):
    done = subprocess.run(command, capture_output=True, text=True)
    for line in done.stderr.splitlines():
        tell(line)
    if done.returncode:
        raise Failure(done.stderr.strip().splitlines()[-1] if done.stderr.strip() else f"{command[0]} failed")


def picture_size(scene):
    render = scene.render
    return [max(1, int(n * render.resolution_percentage / 100)) for n in (render.resolution_x, render.resolution_y)]


class Export:
    """One export of the active scene into a folder."""

    def __init__(self, context, folder, tell, keep_glb=False, verbose=False):
        self.context, self.scene, self.tell, self.keep_glb = context, context.scene, tell, keep_glb
        self.quiet = contextlib.nullcontext if verbose else without_chatter
        self.folder = os.path.abspath(folder)
        self.name = os.path.basename(self.folder)
        self.targets = []  # (name, identifier)

    def warn(self, text):
        self.tell("warning: " + text)

    def write_gltf(self, path):
        """Export what is rendered; all that is changed for it is changed back."""
        objects = rendered_objects(self.context.view_layer)
        materials = used_materials(objects)
        with contextlib.ExitStack() as stack:
            tell_scene(self.scene, self.warn)
            for obj in sorted(objects, key=lambda o: o.name):
                tell_object(obj, self.warn)
            for obj in self.scene.objects:
                if (obj not in objects or is_portal(obj)) and not obj.hide_render:
                    set_for_now(stack, obj, "hide_render", True)
            show_as_rendered(stack, objects)
            tell_extras(stack, self.scene, objects, self.warn)
            for material in materials.values():
                tell_material(material, self.warn)
                prepare_material(stack, material, self.warn)
            realize(stack, self.context, objects, self.warn)
            mend_colors_of_corners(stack)
            with self.quiet():
                export_gltf(path, export_colors=uses_vertex_colors(materials.values()))
        known = material_identifiers(path)
        self.targets = [(target_name(m.retex_target_name or m.name), known.get(m.name, identifier(m.name)))
                        for m in materials.values() if m.retex_target]

    def write(self):
        """Make FOLDER/NAME.pov. Returns its path."""
        importer = tool("retex-import")
        if not self.name:
            raise Failure("no folder to export to")
        with tempfile.TemporaryDirectory(prefix="retex-") as work:
            glb, sky = os.path.join(work, self.name + ".glb"), os.path.join(work, self.name + "-world.exr")
            self.write_gltf(glb)
            command = [importer, "--force", "--partial", "-o", self.folder, glb]
            if self.scene.camera:
                command += ["--camera", self.scene.camera.name]
            if not world_is_black(self.scene.world):
                with self.quiet():
                    render_world(self.scene.world, sky)
                command += ["--sky", sky]
            run(command, self.tell)
            if self.keep_glb:
                shutil.copy(glb, self.folder)
        scene = os.path.join(self.folder, self.name + ".pov")
        self.check_targets(scene)
        return scene

    def check_targets(self, scene):
        with open(scene, encoding="utf-8", errors="replace") as text:
            declared = set(re.findall(r"^#declare (\w+) = (?:texture|material)", text.read(), re.M))
        for name, ident in self.targets:
            if ident not in declared:
                self.warn(f"target {name}: the scene has no material {ident}")
        self.targets = [t for t in self.targets if t[1] in declared]

    def render_command(self, scene, samples):
        width, height = picture_size(self.scene)
        command = [tool("retex-render"), "--size", f"{width}x{height}", "--spp", str(samples), scene]
        for name in dict(self.targets):  # materials of one name are one target
            command += ["-t", name + "=" + ",".join(ident for other, ident in self.targets if other == name)]
        return command + ["-o", os.path.join(self.folder, self.name + ".exr")]

    def render(self, scene, samples):
        """Make the set, for retex-combine."""
        if not self.targets:
            self.warn("no material is ticked as a target: the picture can have no other textures")
        run(self.render_command(scene, samples), self.tell)


# ---- in Blender's window ----


TOOLS_FOLDER = StringProperty(name="Folder of retex-import and retex-render", subtype="DIR_PATH",
                              description="Empty: they are found by PATH")
OUTPUT_FOLDER = StringProperty(name="Folder", subtype="FILE_PATH")
RENDER = BoolProperty(name="Render", description="Also render the set, by retex-render", default=False)
SAMPLES = IntProperty(name="Samples", description="Paths a pixel", default=64, min=1, max=1 << 20)
KEEP_GLB = BoolProperty(name="Keep the glTF file", default=False)


class RetexPreferences(bpy.types.AddonPreferences):
    bl_idname = __name__
    folder: TOOLS_FOLDER

    def draw(self, _context):
        self.layout.prop(self, "folder")


class EXPORT_SCENE_OT_retex(bpy.types.Operator):
    """Export the scene as a folder for retex"""
    bl_idname = "export_scene.retex"
    bl_label = "Export retex"

    filepath: OUTPUT_FOLDER
    render: RENDER
    samples: SAMPLES
    keep_glb: KEEP_GLB

    def invoke(self, context, _event):
        if not self.filepath:
            self.filepath = os.path.splitext(context.blend_data.filepath or "untitled")[0] + "-retex"
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def draw(self, context):
        """Beside the file browser: what will be done."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        names = ticked_targets(used_materials(rendered_objects(context.view_layer)).values())
        box = layout.box()
        box.label(text="Targets", icon="MATERIAL")
        for name in names:
            box.label(text=name)
        if not names:
            box.label(text="None: tick them in the")
            box.label(text="materials' panel retex")
        layout.prop(self, "render")
        column = layout.column()
        column.enabled = self.render
        column.prop(self, "samples")
        layout.prop(self, "keep_glb")

    def execute(self, context):
        def tell(line):
            self.report({"WARNING" if "warning:" in line else "INFO"}, line)

        try:
            export = Export(context, bpy.path.abspath(self.filepath), tell, self.keep_glb)
            scene = export.write()
            if self.render:
                export.render(scene, self.samples)
        except (Failure, OSError) as failure:
            self.report({"ERROR"}, str(failure))
            return {"CANCELLED"}
        return {"FINISHED"}


class MATERIAL_PT_retex(bpy.types.Panel):
    """Whether the material is a target of retexturing"""
    bl_label = "retex"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "material"

    @classmethod
    def poll(cls, context):
        return context.material is not None

    def draw(self, context):
        layout, material = self.layout, context.material
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.prop(material, "retex_target")
        row = layout.row()
        row.enabled = material.retex_target
        row.prop(material, "retex_target_name")


CLASSES = (RetexPreferences, EXPORT_SCENE_OT_retex, MATERIAL_PT_retex)


def menu_entry(self, _context):
    self.layout.operator(EXPORT_SCENE_OT_retex.bl_idname, text="retex (folder)")


def register_properties():
    bpy.types.Material.retex_target = BoolProperty(
        name="Target", description="Its texture can be replaced in the rendered picture", default=False)
    bpy.types.Material.retex_target_name = StringProperty(
        name="Name", description="Name of the target; empty: the material's. Materials of the same name are one target")


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    register_properties()
    bpy.types.TOPBAR_MT_file_export.append(menu_entry)


def unregister():
    bpy.types.TOPBAR_MT_file_export.remove(menu_entry)
    del bpy.types.Material.retex_target, bpy.types.Material.retex_target_name
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)


# ---- without a window ----


def parse(args):
    parser = argparse.ArgumentParser(prog="retex_export.py", description="Export the opened scene for retex.")
    parser.add_argument("-o", "--output", metavar="FOLDER", required=True, help="the folder to make")
    parser.add_argument("-t", "--target", metavar="MATERIAL", action="append", default=[],
                        help="tick this material as a target; repeatable")
    parser.add_argument("--render", action="store_true", help="also render the set, FOLDER/NAME.exr")
    parser.add_argument("--spp", metavar="N", type=int, default=64, help="paths a pixel; default 64")
    parser.add_argument("--keep-glb", action="store_true", help="leave the glTF file in the folder")
    parser.add_argument("-v", "--verbose", action="store_true", help="also show what Blender's own exporter prints")
    return parser.parse_args(args)


def main(args):
    options = parse(args)
    if not hasattr(bpy.types.Material, "retex_target"):
        register_properties()
    try:
        for name in options.target:
            if name not in bpy.data.materials:
                raise Failure(f"-t {name}: there is no material of that name")
            bpy.data.materials[name].retex_target = True
        export = Export(bpy.context, options.output, lambda line: print(line, file=sys.stderr), options.keep_glb,
                        options.verbose)
        scene = export.write()
        if options.render:
            export.render(scene, options.spp)
    except (Failure, OSError) as failure:
        print(f"retex_export: error: {failure}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    code = main(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else ["--help"])
    sys.stdout.flush()
    if code:
        sys.exit(code)
