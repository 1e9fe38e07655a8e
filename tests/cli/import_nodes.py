"""Writes models into the current folder, for import_nodes.t: the cards of import_models.py as instances of one node, nodes
that are hidden, and materials with what is not taken."""
import json
import struct
import sys

sys.dont_write_bytecode = True
from import_models import MATERIAL, buffer, changed, gltf, with_views, write
from import_compressed import encode, filtered

FLOAT, BYTE, SHORT = 5126, 5120, 5122
HALF = .5**.5
TURNS = [(0, 0, 0, 1), (0, HALF, 0, HALF)]
# The node is twice as large: what the instances have is halved.
PLACES = struct.pack('<6f', 0, 0, 0, .625, 0, -.125)
SIZES = struct.pack('<6f', *[.5] * 6)


def instanced(rotations, kind, meshopt=None):
    """Both cards by a node; rotations are of floats or integers, or compressed."""
    scene = dict(gltf(MATERIAL), extensionsUsed=['EXT_mesh_gpu_instancing'])
    first = with_views(scene, buffer, PLACES, rotations, SIZES)
    scene['accessors'] += [
        {'bufferView': first, 'componentType': FLOAT, 'count': 2, 'type': 'VEC3'},
        {'bufferView': first + 1, 'componentType': kind, 'count': 2, 'type': 'VEC4', 'normalized': kind != FLOAT},
        {'bufferView': first + 2, 'componentType': FLOAT, 'count': 2, 'type': 'VEC3'}]
    if meshopt:
        scene['bufferViews'][first + 1] = dict(scene['bufferViews'][first + 1], extensions={
            'EXT_meshopt_compression': dict(scene['bufferViews'][first + 1], byteStride=8, count=2, mode='ATTRIBUTES',
                                            filter=meshopt)})
    scene['nodes'][0] = {'mesh': 0, 'name': 'cards', 'scale': [2, 2, 2], 'extensions': {
        'EXT_mesh_gpu_instancing': {'attributes': {'TRANSLATION': 4, 'ROTATION': 5, 'SCALE': 6}}}}
    scene['nodes'][1] = {'name': 'nothing'}
    return scene


write('instances.gltf', json.dumps(instanced(b''.join(struct.pack('<4f', *q) for q in TURNS), FLOAT)))
write('instances_words.gltf', json.dumps(instanced(
    b''.join(struct.pack('<4h', *(round(32767 * x) for x in q)) for q in TURNS), SHORT)))
write('instances_bytes.gltf', json.dumps(instanced(  # of a length that is not 1
    b''.join(struct.pack('<4b', *(round(80 * x) for x in q)) for q in TURNS), BYTE)))
write('instances_packed.gltf', json.dumps(instanced(
    encode('ATTRIBUTES', filtered('Quat', TURNS, 8, 16), 2, 8), SHORT, 'QUATERNION')))
whole = instanced(b''.join(struct.pack('<4f', *q) for q in TURNS), FLOAT)
changed('instances_uneven.gltf', whole, 'accessors', 5, count=1)
changed('instances_beyond.gltf', whole, 'accessors', 5, count=9)
changed('instances_many.gltf', whole, 'accessors', 4, count=300000)
changed('instances_child.gltf', whole, 'nodes', 1, children=[3])  # what would be the first instance
many = json.loads(json.dumps(whole))
many['accessors'] += [{'componentType': FLOAT, 'count': 200000, 'type': 'VEC3'}]  # zeros take no bytes
many['nodes'][0]['extensions']['EXT_mesh_gpu_instancing']['attributes'] = {'TRANSLATION': 7}
many['nodes'][1] = many['nodes'][0]
write('instances_sum.gltf', json.dumps(many))
scene = instanced(struct.pack('<8f', 0, 0, 0, float('nan'), *TURNS[1]), FLOAT)
write('instances_nan.gltf', json.dumps(scene))

# ---- hidden ----

HIDDEN = {'KHR_node_visibility': {'visible': False}}
light = {'KHR_lights_punctual': {'light': 0}}
scene = dict(gltf(MATERIAL), extensions={'KHR_lights_punctual': {'lights': [{'type': 'point', 'intensity': 9}]}})
scene['nodes'] += [
    {'mesh': 0, 'translation': [.5, 0, 1], 'extensions': HIDDEN, 'children': [4, 5]},
    {'mesh': 0, 'extensions': {'KHR_node_visibility': {'visible': True}}, 'children': [6]},
    {'name': 'watchman', 'camera': 0},
    {'name': 'off', 'extensions': light},
    {'name': 'on', 'extensions': dict(light, KHR_node_visibility={'visible': True}), 'translation': [1, 2, 3]},
    {'name': 'off_too', 'extensions': dict(light, **HIDDEN)}]
scene['scenes'][0]['nodes'] += [3, 7, 8]
scene['extensionsUsed'] = ['KHR_node_visibility', 'KHR_lights_punctual']
write('hidden.gltf', json.dumps(scene))
changed('hidden_circle.gltf', scene, 'nodes', 4, children=[3])
changed('hidden_all.gltf', dict(scene, scenes=[{'nodes': [3]}]), 'nodes', 3)

# ---- flat ones ----

changed('flat.gltf', gltf(MATERIAL), 'nodes', 0, scale=[1, 1, 0])
changed('line.gltf', gltf(MATERIAL), 'nodes', 0, scale=[1, 0, 0])

# ---- accessors without a view, which are 0 ----

scene = gltf(MATERIAL)
scene['accessors'] += [{'componentType': 5121, 'count': 4, 'type': 'VEC4'},
                       {'componentType': 5126, 'count': 4, 'type': 'VEC4'}, {'componentType': 5126, 'count': 1, 'type': 'MAT4'}]
scene['meshes'][0]['primitives'][0]['attributes'].update(JOINTS_0=4, WEIGHTS_0=5)
scene['skins'] = [{'joints': [1], 'inverseBindMatrices': 6}]
scene['nodes'][0]['skin'] = 0
write('zeros.gltf', json.dumps(scene))

# ---- points and lines ----

changed('points.gltf', gltf(MATERIAL), 'meshes', 0, 'primitives', 0, mode=0)
scene = gltf(MATERIAL)
scene['meshes'][0]['primitives'] += [dict(scene['meshes'][0]['primitives'][0], mode=1)]
write('lines.gltf', json.dumps(scene))

# ---- what materials do without ----


def with_materials(name, materials):
    scene = gltf(materials[0])
    scene['materials'] = [dict(material, pbrMetallicRoughness={'metallicFactor': 0}) for material in materials]
    scene['extensionsUsed'] = sorted({e for m in materials for e in m['extensions']}) + ['EXT_mesh_features']
    write(name + '.gltf', json.dumps(scene))


with_materials('without', [
    {'name': 'pan', 'extensions': {'KHR_materials_anisotropy': {'anisotropyStrength': .6}}},
    {'name': 'soap', 'extensions': {'KHR_materials_iridescence': {'iridescenceFactor': 1},
                                    'KHR_materials_diffuse_transmission': {'diffuseTransmissionFactor': .5}}},
    {'name': 'plain', 'extensions': {'KHR_materials_anisotropy': {'anisotropyRotation': 1},
                                     'KHR_materials_iridescence': {'iridescenceFactor': 0}}},
    {'extensions': {'KHR_materials_sheen': {}, 'EXT_materials_\x1bfur': {}}}])
with_materials('without_many', [{'name': 'pan %d' % i, 'extensions': {
    'KHR_materials_anisotropy': {'anisotropyStrength': 1}}} for i in range(20)])

# More extensions than are told, behind as many that are taken; and glass that absorbs light.
scene = gltf({'name': 'wood'})
scene['extensionsUsed'] = ['KHR_materials_ior'] * 20 + ['EXT_unknown_%d' % i for i in range(18)]
write('extensions.gltf', json.dumps(scene))
scene = gltf({})
scene['materials'] = [{'name': 'glass', 'pbrMetallicRoughness': {'metallicFactor': 0, 'roughnessFactor': 0}, 'extensions': {
    'KHR_materials_transmission': {'transmissionFactor': 1}, 'KHR_materials_ior': {'ior': 1.5},
    'KHR_materials_volume': {'thicknessFactor': 1, 'attenuationDistance': 2, 'attenuationColor': [.25, .5, .8]}}}]
scene['extensionsUsed'] = list(scene['materials'][0]['extensions'])
write('absorbs.gltf', json.dumps(scene))

# Smooth, of which one mirrors nothing; and more nodes below one than there was room for at first.
scene = gltf({})
scene['materials'] = [{'pbrMetallicRoughness': {'metallicFactor': 0, 'roughnessFactor': 0},
                       'extensions': {'KHR_materials_specular': {'specularFactor': factor}}} for factor in (0, 1)]
scene['extensionsUsed'] = ['KHR_materials_specular']
scene['meshes'] = [{'primitives': [dict(scene['meshes'][0]['primitives'][0], material=k)]} for k in range(2)]
first = len(scene['nodes'])
scene['nodes'] += [{'mesh': k % 2, 'translation': [0, 0, k]} for k in range(5000)]
scene['nodes'].append({'children': list(range(first, first + 5000))})
scene['scenes'] = [{'nodes': [len(scene['nodes']) - 1]}]
write('wide.gltf', json.dumps(scene))
