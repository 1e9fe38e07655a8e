"""Scenes for coat-in-blender.sh, Blender's pictures of them, and how far they are from those of retex-render: a coated sphere
under a white sky, and beside a square that shines. In Blender the coat is a glossy lobe, mixed with the base by Fresnel's
factor."""
import os
import sys

BASE = (.6, .3, .1)
CASES = {'smooth': 0, 'rough': .4}  # roughness of the coat
SQUARE = [(-3, 1, -1), (-1, 3, -1), (-1, 3, -3), (-3, 1, -3)]  # y up, z away from the camera
SHINE = 8
SIZE, SAMPLES = 96, 128


def scene(coat, lit):
    corners = ', '.join('<%g,%g,%g>' % p for p in SQUARE + SQUARE[:1])
    return '''#version 3.7;
global_settings { assumed_gamma 1 }
camera { orthographic location -10*z right x*2 up y*2 look_at 0 }
sky_sphere { pigment { rgb %g } }
sphere { 0, 1 pigment { rgb <%g,%g,%g> } finish { #ifdef (Retex) retex {
  metallic 0 roughness 1 ior 1 clearcoat 1 clearcoat_roughness %g } #end } }
%s
''' % (0.2 if lit else 1, *BASE, coat,
       'polygon { 5, %s pigment { rgb 1 } finish { diffuse 0 emission %g } }' % (corners, SHINE) if lit else '')


def blender(name, coat, lit):
    import bpy
    bpy.ops.wm.read_factory_settings(use_empty=True)
    s = bpy.context.scene
    s.render.engine, s.cycles.samples, s.cycles.use_adaptive_sampling = 'CYCLES', SAMPLES, False
    s.cycles.use_denoising = False
    s.render.threads_mode, s.render.threads = 'FIXED', 2
    s.render.resolution_x = s.render.resolution_y = SIZE
    s.render.image_settings.file_format, s.render.image_settings.color_depth = 'OPEN_EXR', '32'
    s.render.filepath = os.path.join(os.getcwd(), name + '.exr')
    s.world = bpy.data.worlds.new('w')
    s.world.use_nodes = True
    s.world.node_tree.nodes['Background'].inputs[0].default_value = (*[0.2 if lit else 1] * 3, 1)
    camera = bpy.data.cameras.new('c')
    camera.type, camera.ortho_scale = 'ORTHO', 2
    s.camera = bpy.data.objects.new('c', camera)
    s.collection.objects.link(s.camera)
    s.camera.location, s.camera.rotation_euler = (0, -10, 0), (3.14159265 / 2, 0, 0)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=256, ring_count=128, radius=1)
    sphere = bpy.context.object
    bpy.ops.object.shade_smooth()
    material = bpy.data.materials.new('m')
    material.use_nodes = True
    sphere.data.materials.append(material)
    tree = material.node_tree
    base, out = tree.nodes['Principled BSDF'], tree.nodes['Material Output']
    for key, value in (('Base Color', (*BASE, 1)), ('Roughness', 1), ('Metallic', 0), ('Specular', 0)):
        base.inputs[key].default_value = value
    glossy, fresnel, mix = (tree.nodes.new('ShaderNode' + kind) for kind in ('BsdfGlossy', 'Fresnel', 'MixShader'))
    glossy.distribution, glossy.inputs['Roughness'].default_value = 'GGX', coat
    glossy.inputs['Color'].default_value, fresnel.inputs['IOR'].default_value = (1, 1, 1, 1), 1.5
    for k, node in enumerate((fresnel, base, glossy)):
        tree.links.new(node.outputs[0], mix.inputs[k])
    tree.links.new(mix.outputs[0], out.inputs[0])
    if lit:
        mesh = bpy.data.meshes.new('l')
        mesh.from_pydata([(x, z, y) for x, y, z in SQUARE], [], [(0, 1, 2, 3)])
        light = bpy.data.materials.new('l')
        light.use_nodes = True
        shine = light.node_tree.nodes.new('ShaderNodeEmission')
        shine.inputs['Strength'].default_value = SHINE
        light.node_tree.links.new(shine.outputs[0], light.node_tree.nodes['Material Output'].inputs[0])
        mesh.materials.append(light)
        s.collection.objects.link(bpy.data.objects.new('l', mesh))
    bpy.ops.render.render(write_still=True)


def compare(name):
    """The largest difference of the means of three rings, over them; the rim is left out."""
    import numpy as np
    import OpenImageIO as oiio
    a, b = (oiio.ImageBuf(f).get_pixels(oiio.FLOAT)[:, :, :3].astype(float) for f in (name + '.exr', name + '-r.exr'))
    y, x = (np.mgrid[:SIZE, :SIZE] + .5) / SIZE * 2 - 1
    r = np.hypot(x, y)
    worst = 0
    for low, high in ((0, .5), (.5, .75), (.75, .9)):
        ring = (r >= low) & (r < high)
        worst = max(worst, np.max(np.abs(b[ring].mean(0) / a[ring].mean(0) - 1)))
    print(name, worst)


for case, coat in CASES.items():
    for lit in (0, 1):
        name = case + ('-lit' if lit else '')
        if sys.argv[-1] == 'scenes':
            with open(name + '.pov', 'w') as file:
                file.write(scene(coat, lit))
        elif sys.argv[-1] == 'blender':
            blender(name, coat, lit)
        else:
            compare(name)
