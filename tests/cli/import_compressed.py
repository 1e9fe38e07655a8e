"""Writes models into the current folder, for import_compressed.t: the card of import_models.py, compressed."""
import base64
import copy
import ctypes
import json
import os
import struct
import sys

sys.dont_write_bytecode = True
from import_models import MATERIAL, buffer, changed, glb, gltf, positions, uvs, with_extension, with_views, write

# ---- by Draco: its own encoder made the data of the card's vertices ----

DRACO = {
    # positions and UV of floats, of 14 bits each
    'floats': ('RFJBQ08CAgEBAAAABAIBAgAAAR//ARH/AREC/wAAAAAAAQAJAwAAAgEDCQIAAQIBAQEAAwMBMAEQAwAogpgAAAAAAP8/AAAAAAAAAAAA'
               'AAAAAAAAAIA/DgEBAQADAwEgASADAPCDpgAAAAAA/z8AAAAAAAAAAAAAAACAPw4='),
    # positions of floats, a first set of UV that is .25 everywhere, a second one, and colours (128, 255, 64) of bytes
    'sets': ('RFJBQ08CAgEAAAACBAEAAQIAAgMBBAAJAwAAAwkCAAEDCQIAAgICAwADAAAAAQAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAIA/'
               'AAAAAAAAAAAAAIA/AAAAAAAAgD4AAIA+AACAPgAAgD4AAIA+AACAPgAAgD4AAIA+AAAAAAAAgD8AAIA/AACAPwAAgD8AAAAAAAAAAAAA'
               'AAAAAQEBAYEBWTVVBf/3VQUEZhyPgEAAAAD/AAAA'),
    # positions, UV and normals of 16, 8 and 8 bits
    'integers': ('RFJBQ08CAgEBAAAABAICAgAAAR//ARH/ARH/ARED/wAAAAAAAQAAAQADAwAAAQEDAgIAAQEBAQEDAAIBAQEBAAMDATABEAMAKIKYAAAA'
               'AAD/fwAAAQEBAAMDASABIAMA8IOmAAAAAAD/AAAAAAEBAAIDAUABAAQAAAAAAH8AAAA='),
}
FLOAT, UBYTE, BYTE, USHORT, SHORT, UINT = 5126, 5121, 5120, 5123, 5122, 5125


def draco(blob, index_type, attributes, material=MATERIAL):
    """Attributes: name, type of numbers, number of them, whether they are normalized; their order is that of the data."""
    scene = dict(with_extension('KHR_draco_mesh_compression', True), materials=[material])
    first = with_views(scene, buffer, base64.b64decode(blob))
    del scene['accessors'][3]
    scene['accessors'] = [{'componentType': index_type, 'count': 6, 'type': 'SCALAR'}]
    primitive = scene['meshes'][0]['primitives'][0] = {'indices': 0, 'material': 0, 'attributes': {}, 'extensions': {
        'KHR_draco_mesh_compression': {'bufferView': first, 'attributes': {}}}}
    for i, (name, kind, width, normalized) in enumerate(attributes):
        primitive['attributes'][name] = len(scene['accessors'])
        primitive['extensions']['KHR_draco_mesh_compression']['attributes'][name] = i
        scene['accessors'].append({'componentType': kind, 'count': 4, 'type': 'VEC%d' % width, 'normalized': normalized})
    return scene


PLAIN = [('POSITION', FLOAT, 3, False), ('TEXCOORD_0', FLOAT, 2, False)]
for name, kind in ('bytes', UBYTE), ('words', USHORT), ('longs', UINT):
    write('draco_%s.gltf' % name, json.dumps(draco(DRACO['floats'], kind, PLAIN)))
strip = draco(DRACO['floats'], UINT, PLAIN)
strip['meshes'][0]['primitives'][0]['mode'] = 5
strip['meshes'] += [dict(strip['meshes'][0], name='again')]  # data that two primitives share
strip['nodes'][1]['mesh'] = 1
write('draco_strip.gltf', json.dumps(strip))
strip['meshes'][0]['primitives'][0]['mode'] = strip['meshes'][1]['primitives'][0]['mode'] = 6
write('draco_fan.gltf', json.dumps(strip))
write('draco_integers.gltf', json.dumps(draco(DRACO['integers'], UINT, [
    ('POSITION', SHORT, 3, True), ('TEXCOORD_0', UBYTE, 2, True), ('NORMAL', BYTE, 3, True)])))
sets = [('POSITION', FLOAT, 3, False), ('TEXCOORD_0', FLOAT, 2, False), ('TEXCOORD_1', FLOAT, 2, False),
        ('COLOR_0', UBYTE, 3, True)]
second = dict(MATERIAL, pbrMetallicRoughness={'baseColorTexture': {'index': 0, 'texCoord': 1}, 'metallicFactor': 0})
write('draco_sets.gltf', json.dumps(draco(DRACO['sets'], UINT, sets, second)))
tint = dict(second, pbrMetallicRoughness=dict(second['pbrMetallicRoughness'], baseColorFactor=[128 / 255, 1, 64 / 255, 1]))
write('tint.gltf', json.dumps(gltf(tint, second_uv=True)))
# Damaged: data that end early, are not there, are of other attributes or of none, lie beyond their buffer.
blob = base64.b64decode(DRACO['floats'])
write('draco_short.gltf', json.dumps(draco(base64.b64encode(blob[:70]), UINT, PLAIN)))
whole = draco(DRACO['floats'], UINT, PLAIN)
path = 'meshes', 0, 'primitives', 0, 'extensions', 'KHR_draco_mesh_compression'
changed('draco_lost.gltf', whole, *path, bufferView=99)
changed('draco_other.gltf', whole, *path, attributes={'POSITION': 0, 'TEXCOORD_0': 7})
changed('draco_beyond.gltf', whole, 'bufferViews', 3, byteLength=len(blob) + 9999)
changed('draco_type.gltf', whole, 'accessors', 2, type='MAT2')

# ---- by meshoptimizer's own encoder ----

library = ctypes.CDLL('libmeshoptimizer.so')
for of_all in library.meshopt_encodeVertexBuffer, library.meshopt_encodeIndexBuffer, library.meshopt_encodeIndexSequence:
    of_all.restype = ctypes.c_size_t
library.meshopt_encodeVertexVersion(0)


def encode(mode, data, count, stride):
    data, to = bytes(data), ctypes.create_string_buffer(65536)
    size = ctypes.c_size_t
    if mode == 'ATTRIBUTES':
        length = library.meshopt_encodeVertexBuffer(to, size(65536), data, size(count), size(stride))
    else:
        call = library.meshopt_encodeIndexBuffer if mode == 'TRIANGLES' else library.meshopt_encodeIndexSequence
        length = call(to, size(65536), struct.pack('<%dI' % count, *data), size(count))
    return to.raw[:length]


def filtered(name, numbers, stride, bits):
    """Elements of floats, as the filter stores them."""
    to, count = ctypes.create_string_buffer(4096), len(numbers)
    flat = [x for element in numbers for x in element]
    values = (ctypes.c_float * len(flat))(*flat)
    getattr(library, 'meshopt_encodeFilter' + name)(to, ctypes.c_size_t(count), ctypes.c_size_t(stride), bits, values)
    return to.raw[:count * stride]


def meshopt(attributes, index_mode='TRIANGLES', index_type=USHORT, extension='EXT_meshopt_compression'):
    """A .glb whose views are all compressed, their fallback a buffer that is not there. Attributes: name, bytes, stride,
    filter, and what its accessor has."""
    scene, data, at = with_extension(extension, True), b'', 0
    scene.update(accessors=[], bufferViews=[])
    primitive = scene['meshes'][0]['primitives'][0] = {'material': 0, 'attributes': {}}

    def add(mode, elements, count, stride, filter_name, accessor, target):
        nonlocal data, at
        stream = encode(mode, elements, count, stride)
        view = {'buffer': 1, 'byteOffset': at, 'byteLength': count * stride, 'extensions': {extension: {
            'buffer': 0, 'byteOffset': len(data), 'byteLength': len(stream), 'byteStride': stride, 'count': count,
            'mode': mode}}}
        if filter_name:
            view['extensions'][extension]['filter'] = filter_name
        if mode == 'ATTRIBUTES':
            view['byteStride'] = stride
        data += stream + b'\0' * (-len(stream) % 4)
        at += (count * stride + 3) // 4 * 4
        scene['bufferViews'].append(view)
        scene['accessors'].append(dict({'bufferView': len(scene['accessors']), 'count': count}, **accessor))
        target[0][target[1]] = len(scene['accessors']) - 1

    for name, elements, stride, filter_name, accessor in attributes:
        add('ATTRIBUTES', elements, 4, stride, filter_name, accessor, (primitive['attributes'], name))
    add(index_mode, [0, 1, 2, 0, 2, 3], 6, 2 if index_type == USHORT else 4, None,
        {'componentType': index_type, 'type': 'SCALAR'}, (primitive, 'indices'))
    scene['buffers'] = [{'byteLength': len(data)},
                        {'byteLength': at, 'extensions': {extension: {'fallback': True}}}]
    return scene, data


def kind(component, width, **more):
    return dict({'componentType': component, 'type': 'VEC%d' % width}, **more)


float3, float2 = kind(FLOAT, 3, min=[0, 0, 0], max=[1, 1, 0]), kind(FLOAT, 2)
raw = [('POSITION', buffer[:48], 12, None, float3), ('TEXCOORD_0', buffer[48:80], 8, None, float2)]
scene, data = meshopt(raw)
write('meshopt.glb', glb(scene, data))
write('meshopt_sequence.glb', glb(*meshopt(raw, 'INDICES', UINT)))
write('meshopt_exponential.glb', glb(*meshopt([
    ('POSITION', filtered('Exp', positions, 12, 15), 12, 'EXPONENTIAL', float3),
    ('TEXCOORD_0', filtered('Exp', uvs, 8, 15), 8, 'EXPONENTIAL', float2)])))
shorts = b''.join(struct.pack('<4h', *(32767 * x for x in p), 0) for p in positions)
words = b''.join(struct.pack('<2H', *(65535 * x for x in uv)) for uv in uvs)
write('meshopt_integers.glb', glb(*meshopt([
    ('POSITION', shorts, 8, 'NONE', kind(SHORT, 3, normalized=True)),
    ('TEXCOORD_0', words, 4, None, kind(USHORT, 2, normalized=True))])))
# Normals that lean, as floats, and as the filter stores them in bytes and in words.
leaning = [(-.6, 0, .8), (.6, 0, .8), (0, .6, .8), (0, -.28, .96)]
floats = b''.join(struct.pack('<3f', *n) for n in leaning)
for name, attribute in (('floats', ('NORMAL', floats, 12, None, kind(FLOAT, 3))),
                        ('bytes', ('NORMAL', filtered('Oct', [n + (0,) for n in leaning], 4, 8), 4, 'OCTAHEDRAL',
                                   kind(BYTE, 3, normalized=True))),
                        ('words', ('NORMAL', filtered('Oct', [n + (0,) for n in leaning], 8, 16), 8, 'OCTAHEDRAL',
                                   kind(SHORT, 3, normalized=True)))):
    write('normals_%s.glb' % name, glb(*meshopt(raw + [attribute])))
# One of the two is a view as any other, and what stands in for the compressed ones is there.
mixed = copy.deepcopy(scene)
mixed['buffers'][1].update(uri=gltf(MATERIAL)['buffers'][0]['uri'], byteLength=92)
mixed['bufferViews'][1] = {'buffer': 1, 'byteOffset': 48, 'byteLength': 32}
write('meshopt_mixed.glb', glb(mixed, data))

# Each of these has some bytes of its binary chunk changed, at places that are the same each time.
whole = draco(DRACO['integers'], UINT, [('POSITION', SHORT, 3, True), ('TEXCOORD_0', UBYTE, 2, True),
                                        ('NORMAL', BYTE, 3, True)])
of_draco = base64.b64decode(DRACO['integers'])
whole['bufferViews'], whole['buffers'] = [{'buffer': 0, 'byteLength': len(of_draco)}], [{'byteLength': len(of_draco)}]
whole['meshes'][0]['primitives'][0]['extensions']['KHR_draco_mesh_compression']['bufferView'] = 0
os.makedirs('flips', exist_ok=True)
state = 1
for name, file, size in (('draco', glb(whole, of_draco), len(of_draco)), ('meshopt', glb(scene, data), len(data))):
    for number in range(40):
        damaged = bytearray(file)
        for _ in range(1 + number % 3):
            state = state * 1103515245 + 12345 & 0x7fffffff
            damaged[len(file) - 1 - state // 256 % size] ^= 1 << state // 8 % 8
        write('flips/%s_%d.glb' % (name, number), bytes(damaged))

# Damaged.
write('meshopt_newer.glb', glb(*meshopt(raw, extension='KHR_meshopt_compression')))
write('meshopt_version.glb', glb(scene, b'\xa1' + data[1:]))
write('meshopt_short.glb', glb(scene, data[:40]))


def wrong(name, view, **to):
    other = copy.deepcopy(scene)
    other['bufferViews'][view]['extensions']['EXT_meshopt_compression'].update(to)
    write('meshopt_%s.glb' % name, glb(other, data))


wrong('huge', 0, count=4000000000)
wrong('stride', 0, byteStride=6)
wrong('wide', 0, byteStride=260)
wrong('mode', 0, mode='POINTS')
wrong('filter', 0, filter='OCTAHEDRAL')
wrong('third', 2, count=5)
wrong('inverse', 0, byteOffset=-1)
wrong('buffer', 0, buffer=1)
