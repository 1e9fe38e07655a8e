"""Models for import-in-blender.sh, Blender's pictures of them, and how far they are from those of retex-render."""
import base64
import json
import math
import struct
import sys

import numpy as np


def quad(uvs):
    return [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [(0, 0, 1)] * 4, uvs, [(0, 1, 2), (0, 2, 3)]


def globe(nu, nv):
    at = [(2 * math.pi * i / nu, math.pi * (j / nv - .5)) for j in range(nv + 1) for i in range(nu + 1)]
    points = [(math.sin(a) * math.cos(b), math.sin(b), -math.cos(a) * math.cos(b)) for a, b in at]
    uvs = [(1 - i / nu, 1 - j / nv) for j in range(nv + 1) for i in range(nu + 1)]
    faces = []
    for j in range(nv):
        for i in range(nu):
            q = j * (nu + 1) + i
            faces += [(q, q + nu + 2, q + 1)] * (j > 0) + [(q, q + nu + 1, q + nu + 2)] * (j < nv - 1)
    return points, points, uvs, faces


def gltf(meshes, nodes, materials, yfov):
    """meshes: of (points, normals, uvs, faces), and the index of a material."""
    data, views, accessors = b'', [], []

    def put(rows, form, component, kind):
        nonlocal data
        packed = b''.join(struct.pack('<' + form, *row) for row in rows)
        views.append({'buffer': 0, 'byteOffset': len(data), 'byteLength': len(packed)})
        data += packed + b'\0' * (-len(packed) % 4)
        accessors.append({'bufferView': len(views) - 1, 'componentType': component, 'type': kind,
                          'count': len(rows) * (3 if kind == 'SCALAR' else 1),
                          'min': np.min(rows, 0).tolist(), 'max': np.max(rows, 0).tolist()})
        if kind == 'SCALAR':
            del accessors[-1]['min'], accessors[-1]['max']
        return len(accessors) - 1

    made = [{'primitives': [{'attributes': {'POSITION': put(p, '3f', 5126, 'VEC3'), 'NORMAL': put(n, '3f', 5126, 'VEC3'),
                                            'TEXCOORD_0': put(uv, '2f', 5126, 'VEC2')},
                             'indices': put(faces, '3H', 5123, 'SCALAR'), 'material': material}]}
            for (p, n, uv, faces), material in meshes]
    return json.dumps({
        'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': list(range(len(nodes)))}], 'nodes': nodes,
        'cameras': [{'type': 'perspective', 'perspective': {'yfov': yfov, 'aspectRatio': 4 / 3, 'znear': .1}}],
        'meshes': made, 'materials': materials, 'textures': [{'source': 0}], 'images': [{'uri': 'bumps.png'}],
        'accessors': accessors, 'bufferViews': views,
        'buffers': [{'byteLength': len(data),
                     'uri': 'data:application/octet-stream;base64,' + base64.b64encode(data).decode()}]})


def write_image(name, pixels, kind):
    import OpenImageIO as oiio
    out = oiio.ImageOutput.create(name)
    out.open(name, oiio.ImageSpec(pixels.shape[1], pixels.shape[0], 3, kind))
    out.write_image(pixels)
    out.close()


def models():
    y, x = np.mgrid[0:128, 0:128] / 128 * 2 * np.pi
    normals = np.stack([.5 * np.cos(2 * x + y), .4 * np.sin(y - x), np.ones_like(x)], -1)
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    write_image('bumps.png', np.round((normals * .5 + .5) * 255).astype(np.uint8), 'uint8')
    sky = np.full((128, 256, 3), .05, 'f')
    sky[20:50, 20:70] = 4, .1, .1
    sky[20:50, 150:200] = .1, 4, .1
    sky[80:110, 90:120] = .1, .1, 4
    write_image('sky.hdr', sky, 'float')
    square = [(0, 1), (1, 1), (1, 0), (0, 0)]
    cards = [quad(square), quad([(1 - u, v) for u, v in square]), quad([(0, 1), (.3, .2), (1.1, 0), (.4, .9)])]
    bumpy = {'name': 'bumpy', 'normalTexture': {'index': 0, 'scale': .8},
             'pbrMetallicRoughness': {'metallicFactor': 0, 'roughnessFactor': 1}}
    nodes = [{'mesh': i, 'translation': [-2.2 + 2.2 * (i % 3), 1.1 - 2.2 * (i // 3), 0]} for i in range(4)]
    nodes.append({'mesh': 0, 'translation': [0, -1.1, 0], 'rotation': [0, math.sin(.4), 0, math.cos(.4)]})
    nodes.append({'camera': 0, 'translation': [0, 0, 12]})
    with open('bumps.gltf', 'w') as out:
        out.write(gltf([(m, 0) for m in cards + [globe(32, 16)]], nodes, [bumpy], 2 * math.atan(.2)))
    finishes = [{'pbrMetallicRoughness': {'metallicFactor': m, 'roughnessFactor': 1 - m}} for m in (1, 0)]
    nodes = [{'mesh': 0, 'translation': [-1.1, 0, 0]}, {'mesh': 1, 'translation': [1.1, 0, 0]},
             {'camera': 0, 'translation': [0, 0, 6]}]
    with open('sky.gltf', 'w') as out:
        out.write(gltf([(globe(48, 24), 0), (globe(48, 24), 1)], nodes, finishes, 1.2))


def blender():
    import bpy
    np.bool, np.int, np.float, np.object = bool, int, float, object  # Blender's importer is older than numpy
    for name in 'bumps', 'sky':
        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.ops.import_scene.gltf(filepath=name + '.gltf')
        scene = bpy.context.scene
        scene.camera = [o for o in scene.objects if o.type == 'CAMERA'][0]
        scene.render.engine, scene.cycles.pixel_filter_type = 'CYCLES', 'BOX'
        scene.cycles.samples, scene.cycles.use_denoising = {'bumps': 16, 'sky': 64}[name], False
        scene.cycles.use_adaptive_sampling = False
        scene.render.resolution_x, scene.render.resolution_y = 160, 120
        scene.world = bpy.data.worlds.new('sky')
        scene.world.use_nodes = True
        nodes = scene.world.node_tree.nodes
        scene.view_layers[0].use_pass_normal = True
        scene.render.image_settings.file_format = 'OPEN_EXR'
        if name == 'sky':
            picture = nodes.new('ShaderNodeTexEnvironment')
            picture.image = bpy.data.images.load('//sky.hdr' if bpy.data.filepath else 'sky.hdr')
            scene.world.node_tree.links.new(picture.outputs[0], nodes['Background'].inputs[0])
        else:
            scene.render.image_settings.file_format = 'OPEN_EXR_MULTILAYER'
        scene.render.image_settings.color_depth = '32'
        scene.render.filepath = {'bumps': 'normal_blender.exr', 'sky': 'sky_blender.exr'}[name]
        bpy.ops.render.render(write_still=True)


def channels(name, *endings):
    """Those channels, of the first part that has them."""
    import OpenImageIO as oiio
    picture = oiio.ImageInput.open(name)
    part = 0
    while picture.seek_subimage(part, 0):
        names = picture.spec().channelnames
        found = [i for e in endings for i, n in enumerate(names) if n.endswith(e)]
        if len(found) >= len(endings):
            return picture.read_image(part, 0, 0, len(names), 'float')[..., found[:len(endings)]]
        part += 1
    raise SystemExit(name + ': no such channels')


def compare():
    theirs = channels('normal_blender.exr', 'Normal.X', 'Normal.Z', 'Normal.Y')  # z is up there
    ours = channels('normal.exr', 'normal.R', 'normal.G', 'normal.B')
    theirs = theirs / np.maximum(np.linalg.norm(theirs, axis=-1, keepdims=True), 1e-9)
    angles = np.degrees(np.arccos(np.clip((theirs * ours).sum(-1), -1, 1)))
    for name, x0, y0, x1, y1 in (('plain', 4, 11, 47, 54), ('mirrored', 59, 11, 102, 54), ('sheared', 114, 11, 157, 46),
                                 ('globe', 11, 71, 41, 101), ('turned', 64, 71, 78, 109)):
        print(name, angles[y0:y1, x0:x1].mean())
    theirs, ours = channels('sky_blender.exr', 'R', 'G', 'B'), channels('sky.exr', 'R', 'G', 'B')
    print('sky', np.abs(theirs - ours).mean() / theirs.mean())


{'models': models, 'blender': blender, 'compare': compare}[sys.argv[-1]]()
