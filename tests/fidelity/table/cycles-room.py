"""For imported-rooms.sh: Blender's own picture of the opened file. SIZE SPP THREADS FILE.exr"""
import sys

import bpy

size, samples, threads, path = sys.argv[sys.argv.index("--") + 1:]
scene = bpy.context.scene
render, cycles = scene.render, scene.cycles
render.engine = "CYCLES"
render.resolution_x, render.resolution_y = map(int, size.split("x"))
render.resolution_percentage = 100
render.threads_mode, render.threads = ("FIXED", int(threads)) if int(threads) else ("AUTO", 0)
cycles.samples = int(samples)
cycles.use_denoising = cycles.use_adaptive_sampling = False
cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = 16
render.image_settings.file_format = "OPEN_EXR"
render.image_settings.color_depth = "32"
render.use_file_extension = False
render.filepath = path
bpy.ops.render.render(write_still=True)
