"""Models for import_exposure.t: a floor of 10 x 10 m with a square above it that shines, of some size and strength, or with a
lamp; and the mean radiance of a picture."""
import json
import struct
import sys

import numpy as np
import OpenImageIO as oiio


def square(size, height, up):
    """Its corners, in an order by which it faces up or down."""
    h = size / 2
    corners = [(-h, height, h), (h, height, h), (h, height, -h), (-h, height, -h)]
    return b''.join(struct.pack('<3f', *c) for c in (corners if up else corners[::-1]))


def write(name, size=None, strength=0, intensity=None, camera=(-.13, 0, 0, .9915), cone=None):
    data = square(10, 0, True) + square(size or 1, 2, False) + struct.pack('<6H', 0, 1, 2, 0, 2, 3)
    nodes = [{'mesh': 0}]
    model = {'asset': {'version': '2.0'}, 'scenes': [{'nodes': [0]}], 'nodes': nodes,
             'buffers': [{'byteLength': len(data), 'uri': name + '.bin'}],
             'bufferViews': [{'buffer': 0, 'byteOffset': 0, 'byteLength': 48},
                             {'buffer': 0, 'byteOffset': 48, 'byteLength': 48},
                             {'buffer': 0, 'byteOffset': 96, 'byteLength': 12}],
             'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 4, 'type': 'VEC3'},
                           {'bufferView': 1, 'componentType': 5126, 'count': 4, 'type': 'VEC3'},
                           {'bufferView': 2, 'componentType': 5123, 'count': 6, 'type': 'SCALAR'}],
             'materials': [{'name': 'Floor', 'pbrMetallicRoughness': {'baseColorFactor': [.5, .5, .5, 1]}},
                           {'name': 'Shines', 'emissiveFactor': [1, 1, 1],
                            'extensions': {'KHR_materials_emissive_strength': {'emissiveStrength': strength}}}],
             'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'indices': 2, 'material': 0}]},
                        {'primitives': [{'attributes': {'POSITION': 1}, 'indices': 2, 'material': 1}]}]}
    used = ['KHR_materials_emissive_strength']
    if size:
        nodes.append({'mesh': 1})
    if intensity is not None:
        used.append('KHR_lights_punctual')
        nodes.append({'translation': [0, 2, 0], 'extensions': {'KHR_lights_punctual': {'light': 0}}})
        light = {'type': 'point', 'intensity': intensity}
        if cone:
            light = {'type': 'spot', 'intensity': intensity, 'spot': {'outerConeAngle': cone}}
            nodes[-1]['rotation'] = [-.5**.5, 0, 0, .5**.5]
        model['extensions'] = {'KHR_lights_punctual': {'lights': [light]}}
    if camera:
        nodes.append({'translation': [0, 4, 12], 'rotation': camera, 'camera': 0})
        model['cameras'] = [{'type': 'perspective', 'perspective': {'yfov': .8, 'znear': .1}}]
    model['scenes'][0]['nodes'] = list(range(len(nodes)))
    model['extensionsUsed'] = used
    with open(name + '.bin', 'wb') as out:
        out.write(data)
    with open(name + '.gltf', 'w', encoding='ascii') as out:
        json.dump(model, out)


def write_room(name, eye=2.5, is_open=False, grey=.4):
    """A room of 6 x 6 m, 3 m high, whose far wall has an opening of half of it, before the eye; or without the wall that
    is before that."""
    x, z, y, w, low, high = 3, 3, 3, 2.2, .6, 2.6
    quads = [[(-x, 0, z), (x, 0, z), (x, 0, -z), (-x, 0, -z)], [(-x, y, -z), (x, y, -z), (x, y, z), (-x, y, z)],
             [(-x, 0, z), (-x, 0, -z), (-x, y, -z), (-x, y, z)], [(x, 0, -z), (x, 0, z), (x, y, z), (x, y, -z)],
             [(x, 0, z), (-x, 0, z), (-x, y, z), (x, y, z)]]
    if is_open:
        quads[-1], low, high = [(-x, 0, -z), (x, 0, -z), (x, y, -z), (-x, y, -z)], 0, 0
    for a, b, c, d in ((-x, x, 0, low), (-x, x, high, y), (-x, -w, low, high), (w, x, low, high)):
        quads.append([(a, c, -z), (b, c, -z), (b, d, -z), (a, d, -z)])
    corners = b''.join(struct.pack('<3f', *c) for quad in quads for c in quad)
    indices = b''.join(struct.pack('<6H', *(4 * k + i for i in (0, 1, 2, 0, 2, 3))) for k in range(len(quads)))
    model = {'asset': {'version': '2.0'}, 'scenes': [{'nodes': [0, 1]}],
             'nodes': [{'mesh': 0}, {'translation': [0, 1.5, eye], 'camera': 0}],
             'cameras': [{'type': 'perspective', 'perspective': {'yfov': 1, 'znear': .1}}],
             'buffers': [{'byteLength': len(corners) + len(indices), 'uri': name + '.bin'}],
             'bufferViews': [{'buffer': 0, 'byteOffset': 0, 'byteLength': len(corners)},
                             {'buffer': 0, 'byteOffset': len(corners), 'byteLength': len(indices)}],
             'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 4 * len(quads), 'type': 'VEC3'},
                           {'bufferView': 1, 'componentType': 5123, 'count': 6 * len(quads), 'type': 'SCALAR'}],
             'materials': [{'pbrMetallicRoughness': {'baseColorFactor': [grey, grey, grey, 1]}, 'doubleSided': True}],
             'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'indices': 1, 'material': 0}]}]}
    with open(name + '.bin', 'wb') as out:
        out.write(corners + indices)
    with open(name + '.gltf', 'w', encoding='ascii') as out:
        json.dump(model, out)


def luminance(path):
    return oiio.ImageBuf(path).get_pixels(oiio.FLOAT)[..., :3] @ [.2126, .7152, .0722]


def judge(path):
    """By the log-average of what is not black, as the background is."""
    picture = luminance(path)
    seen = picture[picture > 0]
    mean = np.exp2(np.mean(np.log2(np.maximum(seen, np.quantile(seen, .9) / 256)))) if len(seen) else 0
    white = ', white' if np.sum(seen > .89) > .12 * len(seen) else ''
    return ('black' if mean < 1 / 500 else 'as a floor' if .12 < mean < .6 else 'light') + white


def judge_range(path):
    """Whether nine tenths are within 5 and 95 % of the range of sRGB, and the middle is neither dark nor white."""
    picture = luminance(path)
    lit = np.mean((picture > .0039) & (picture < .89))
    return 'within the range' if lit > .9 and .05 < np.median(picture) < .5 else f'{round(10 * lit)} tenths within the range'


if len(sys.argv) > 2 and sys.argv[1] == 'size':
    print(oiio.ImageBuf(sys.argv[2]).spec().width, 'pixels wide')
elif len(sys.argv) > 2:
    print(judge_range(sys.argv[2]))
elif len(sys.argv) > 1:
    print(judge(sys.argv[1]))
else:
    write_room('room')
    write_room('stage', 10, True)
    write_room('dark_stage', 14, True, .12)
    write('speck', .02, 3)
    write('panel', 2, 20)
    write('out', intensity=0)
    write('lamp', intensity=683 * 20)
    write('pale', intensity=220)
    write('dim', intensity=.5)
    write('bright', intensity=683 * 1e5)
    write('label', 1, .5)
    write('framed', intensity=683 * 20, camera=None)
    write('spot', intensity=683 * 20, cone=.15)
    write('blind', intensity=683 * 20, camera=(0, 1, 0, 0))
