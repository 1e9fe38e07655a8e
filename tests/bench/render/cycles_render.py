"""What scenes.py wrote, rendered by Cycles: blender -b -P cycles_render.py -- SCENE.npz SIZE SAMPLES SEED OUT.exr

Prints a line of JSON: wall and processor seconds of rendering with that many samples, and with one, which stand for
all that is done once. Nothing is clamped, blurred, denoised or sampled adaptively, so that the picture is that of a
plain path tracer.
"""
import json
import math
import os
import resource
import sys
import time

import bpy
import mathutils
import numpy as np

MAX_BOUNCES, THREADS = 8, 2


def settings(scene, size):
    cycles = scene.cycles
    scene.render.engine = "CYCLES"
    cycles.device = "CPU"
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    for kind in ("max", "diffuse", "glossy", "transmission", "transparent_max"):
        setattr(cycles, kind + "_bounces", MAX_BOUNCES)
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.pixel_filter_type = "BOX"
    if hasattr(cycles, "use_auto_tile"):
        cycles.use_auto_tile = False
    render = scene.render
    render.threads_mode, render.threads = "FIXED", THREADS
    render.resolution_x = render.resolution_y = size
    render.resolution_percentage = 100
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"


def material(name, wanted, folder):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    nodes.clear()
    if wanted["glass"]:
        shader = nodes.new("ShaderNodeBsdfGlass")
        shader.inputs["IOR"].default_value, shader.inputs["Roughness"].default_value = wanted["glass"], 0
    elif wanted["mirror"]:
        shader = nodes.new("ShaderNodeBsdfGlossy")
        shader.inputs["Color"].default_value, shader.inputs["Roughness"].default_value = (*wanted["mirror"], 1), 0
    else:
        shader = nodes.new("ShaderNodeBsdfDiffuse")
        if wanted["texture"]:
            texture = nodes.new("ShaderNodeTexImage")
            texture.image = bpy.data.images.load(os.path.join(folder, wanted["texture"]))
            colour = texture.outputs["Color"]
            if wanted["diffuse"] != 1:
                factor = nodes.new("ShaderNodeVectorMath")
                factor.operation, factor.inputs["Scale"].default_value = "SCALE", wanted["diffuse"]
                links.new(colour, factor.inputs[0])
                colour = factor.outputs[0]
            links.new(colour, shader.inputs["Color"])
        else:
            shader.inputs["Color"].default_value = (*(wanted["diffuse"] * c for c in wanted["colour"]), 1)
    links.new(shader.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return made


def mesh(scene, arrays, surface):
    made = bpy.data.meshes.new("mesh")
    made.from_pydata(arrays["vertices"].tolist(), [], arrays["faces"].tolist())
    if "uvs" in arrays:
        made.uv_layers.new().data.foreach_set("uv", arrays["uvs"][arrays["faces"].ravel()].ravel())
    if "normals" in arrays:
        made.polygons.foreach_set("use_smooth", [True] * len(made.polygons))
        made.normals_split_custom_set_from_vertices(arrays["normals"].tolist())
        if hasattr(made, "use_auto_smooth"):
            made.use_auto_smooth = True
    made.materials.append(surface)
    scene.collection.objects.link(bpy.data.objects.new("mesh", made))


def light(scene, wanted):
    lamp = bpy.data.lights.new("lamp", "AREA")
    lamp.shape, lamp.size, lamp.size_y, lamp.energy = "RECTANGLE", wanted["x"], wanted["y"], wanted["watts"]
    holder = bpy.data.objects.new("lamp", lamp)
    holder.location = wanted["centre"]
    scene.collection.objects.link(holder)


def sky(scene, path):
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    nodes.clear()
    texture, shader = nodes.new("ShaderNodeTexEnvironment"), nodes.new("ShaderNodeBackground")
    texture.image = bpy.data.images.load(path)
    links.new(texture.outputs["Color"], shader.inputs["Color"])
    links.new(shader.outputs[0], nodes.new("ShaderNodeOutputWorld").inputs["Surface"])
    scene.world = world


def camera(scene, wanted):
    lens = bpy.data.cameras.new("camera")
    lens.angle = math.radians(wanted["angle"])
    holder = bpy.data.objects.new("camera", lens)
    holder.location = wanted["location"]
    holder.rotation_euler = mathutils.Vector(wanted["direction"]).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(holder)
    scene.camera = holder


def load(scene, path):
    data = np.load(path)
    header = json.loads(str(data["header"]))
    surfaces = {name: material(name, m, os.path.dirname(path)) for name, m in header["materials"].items()}
    for i, name in enumerate(header["meshes"]):
        keys = ("vertices", "normals", "uvs", "faces")
        mesh(scene, {k: data[f"{i}-{k}"] for k in keys if f"{i}-{k}" in data}, surfaces[name])
    if header["light"]:
        light(scene, header["light"])
    if header["sky"]:
        sky(scene, os.path.join(os.path.dirname(path), header["sky"]))
    camera(scene, header["camera"])


def timed(scene, samples):
    def spent():
        used = resource.getrusage(resource.RUSAGE_SELF)
        return np.array([time.monotonic(), used.ru_utime + used.ru_stime])
    scene.cycles.samples = samples
    began = spent()
    bpy.ops.render.render(write_still=True)
    return [round(s, 4) for s in spent() - began]


def main(path, size, samples, seed, out):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    settings(scene, int(size))
    load(scene, os.path.abspath(path))
    scene.cycles.seed = int(seed)
    scene.render.filepath = os.path.abspath(out)
    timed(scene, 1)  # starts what is started once
    once, whole = timed(scene, 1), timed(scene, int(samples))
    print("RESULT " + json.dumps({"wall": whole[0], "cpu": whole[1], "wall_once": once[0], "cpu_once": once[1],
                                  "paths": int(size) ** 2 * int(samples)}))


main(*sys.argv[sys.argv.index("--") + 1:])
