"""Writes models into the current folder, for import.t: a card with the letter F facing the viewer, and the same card again
as a side wall to the right, going away from the viewer; and damaged ones."""
import base64
import json
import math
import os
import struct
import zlib


def chunk(kind, data):
    return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))


def png(width, height, pixel, channels):
    rows = b''.join(b'\0' + b''.join(bytes(pixel(x, y)) for x in range(width)) for y in range(height))
    head = struct.pack('>IIBBBBB', width, height, 8, {3: 2, 4: 6}[channels], 0, 0, 0)
    return b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', head) + chunk(b'IDAT', zlib.compress(rows)) + chunk(b'IEND', b'')


def letter(x, y):
    if 3 <= x < 6 and 2 <= y < 14 or 3 <= x < 13 and 2 <= y < 5 or 3 <= x < 10 and 7 <= y < 9:
        return 180, 20, 30
    return (30, 40, 180) if y == 15 else (20, 120, 40) if x == 0 else (235, 225, 200)


def write(name, data):
    with open(name, 'wb') as out:
        out.write(data if isinstance(data, bytes) else data.encode())


F = png(16, 16, letter, 3)
write('F.png', F)
# opaque in the left half only; colours below the right half too
half = png(16, 16, lambda x, y: letter(x, y) + ((255 if x < 8 else 100),), 4)
positions = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
uvs = [(0, 1), (1, 1), (1, 0), (0, 0)]  # of glTF: v down
faces = [(0, 1, 2), (0, 2, 3)]
buffer = (b''.join(struct.pack('<3f', *p) for p in positions) + b''.join(struct.pack('<2f', *p) for p in uvs) +
          b''.join(struct.pack('<3H', *f) for f in faces))
MATERIAL = {'name': 'wood', 'pbrMetallicRoughness': {'baseColorTexture': {'index': 0}, 'metallicFactor': 0}}


def gltf(material, image=F, nodes=None, buffer_uri=None, second_uv=False, buffer=buffer):
    attributes = {'POSITION': 0, 'TEXCOORD_0': 1}
    if second_uv:
        attributes = {'POSITION': 0, 'TEXCOORD_0': 3, 'TEXCOORD_1': 1}
    return {
        'asset': {'version': '2.0'},
        'scene': 0,
        'scenes': [{'nodes': list(range(len(nodes))) if nodes else [0, 1, 2]}],
        'nodes': nodes or [
            {'mesh': 0, 'name': 'front'},
            # a quarter turn to the left about y: x becomes -z
            {'mesh': 0, 'name': 'side', 'rotation': [0, .5**.5, 0, .5**.5], 'translation': [1.25, 0, -.25]},
            {'camera': 0, 'translation': [.75, .5, 2.5]}],
        'cameras': [{'type': 'perspective', 'perspective': {'yfov': .6, 'aspectRatio': 4 / 3, 'znear': .1}}],
        'meshes': [{'name': 'card', 'primitives': [{'attributes': attributes, 'indices': 2, 'material': 0}]}],
        'materials': [material],
        'textures': [{'source': 0}],
        'images': [image if isinstance(image, dict) else
                   {'uri': 'data:image/png;base64,' + base64.b64encode(image).decode()}],
        'accessors': [
            {'bufferView': 0, 'componentType': 5126, 'count': 4, 'type': 'VEC3', 'min': [0, 0, 0], 'max': [1, 1, 0]},
            {'bufferView': 1, 'componentType': 5126, 'count': 4, 'type': 'VEC2'},
            {'bufferView': 2, 'componentType': 5123, 'count': 6, 'type': 'SCALAR'},
            {'bufferView': 0, 'componentType': 5126, 'count': 4, 'type': 'VEC2'}],
        'bufferViews': [{'buffer': 0, 'byteOffset': 0, 'byteLength': 48},
                        {'buffer': 0, 'byteOffset': 48, 'byteLength': 32},
                        {'buffer': 0, 'byteOffset': 80, 'byteLength': 12}],
        'buffers': [{'byteLength': len(buffer), 'uri': buffer_uri or
                     'data:application/octet-stream;base64,' + base64.b64encode(buffer).decode()}],
    }


def glb(scene, data):
    text = json.dumps(scene).encode()
    text += b' ' * (-len(text) % 4)
    data += b'\0' * (-len(data) % 4)
    body = struct.pack('<II', len(text), 0x4e4f534a) + text + struct.pack('<II', len(data), 0x004e4942) + data
    return struct.pack('<III', 0x46546c67, 2, 12 + len(body)) + body


write('card.gltf', json.dumps(gltf(MATERIAL)))
inside = gltf(MATERIAL, {'bufferView': 3, 'mimeType': 'image/png'})
inside['bufferViews'].append({'buffer': 0, 'byteOffset': 92, 'byteLength': len(F)})
inside['buffers'] = [{'byteLength': 92 + len(F)}]
card = glb(inside, buffer + F)
write('card.glb', card)
second = {'index': 0, 'texCoord': 2}
for name, sets in ('uv_turned', ('TEXCOORD_2', 'TEXCOORD_0', 'TEXCOORD_1')), ('uv_gap', ('TEXCOORD_2', 'TEXCOORD_0')):
    model = gltf(dict(MATERIAL, pbrMetallicRoughness={'baseColorTexture': second, 'metallicFactor': 0}), second_uv=True)
    of = model['meshes'][0]['primitives'][0]['attributes']
    model['meshes'][0]['primitives'][0]['attributes'] = dict(
        [(s, of['TEXCOORD_1' if s == 'TEXCOORD_2' else 'TEXCOORD_0']) for s in sets], POSITION=0)
    write(name + '.gltf', json.dumps(model))
write('second.gltf', json.dumps(gltf(dict(MATERIAL, pbrMetallicRoughness={
    'baseColorTexture': {'index': 0, 'texCoord': 1}, 'metallicFactor': 0}), second_uv=True)))
turned = dict(MATERIAL, pbrMetallicRoughness={'metallicFactor': 0, 'baseColorTexture': {
    'index': 0, 'extensions': {'KHR_texture_transform': {'offset': [.25, .5], 'rotation': .5, 'scale': [2, 3]}}}})
write('turned.gltf', json.dumps(dict(gltf(turned), extensionsUsed=['KHR_texture_transform'])))
# The same by the definition: scaled, turned counter-clockwise as seen with v down, moved.
c, s = math.cos(.5), math.sin(.5)
moved = [(.25 + c * 2 * u + s * 3 * v, .5 - s * 2 * u + c * 3 * v) for u, v in uvs]
write('turned_uv.gltf', json.dumps(gltf(MATERIAL, buffer=buffer[:48] + b''.join(
    struct.pack('<2f', *uv) for uv in moved) + buffer[80:])))
write('masked.gltf', json.dumps(gltf(dict(MATERIAL, alphaMode='MASK'), half)))
write('opaque.gltf', json.dumps(gltf(MATERIAL, half)))
write('tinted.gltf', json.dumps(gltf(dict(MATERIAL, pbrMetallicRoughness={
    'baseColorTexture': {'index': 0}, 'baseColorFactor': [.5, 1, .25, 1], 'metallicFactor': 0}))))


def encoded(code, factor):
    x = code / 255
    x = (x / 12.92 if x <= .04045 else ((x + .055) / 1.055)**2.4) * factor
    return round(255 * (12.92 * x if x <= .0031308 else 1.055 * x**(1 / 2.4) - .055))


write('tinted_image.gltf', json.dumps(gltf(MATERIAL, png(16, 16, lambda x, y: [
    encoded(code, factor) for code, factor in zip(letter(x, y), (.5, 1, .25))], 3))))
write('glowing.gltf', json.dumps(dict(gltf({
    'name': 'lamp', 'pbrMetallicRoughness': {'baseColorFactor': [0, 0, 0, 1]}, 'emissiveFactor': [1, .5, .25],
    'extensions': {'KHR_materials_emissive_strength': {'emissiveStrength': 4}}}),
    extensionsUsed=['KHR_materials_emissive_strength'])))

write('screen.gltf', json.dumps(gltf({
    'name': 'screen', 'emissiveTexture': {'index': 0}, 'emissiveFactor': [.5, .5, .5],
    'pbrMetallicRoughness': {'baseColorFactor': [.2, .2, .2, 1], 'metallicFactor': 0, 'roughnessFactor': .25}})))

# The same card in other formats; both are placed, for these have no instances.
side = [(1.25, y, -.25 - x) for x, y, _ in positions]
obj = 'mtllib card.mtl\n' + ''.join('v %g %g %g\n' % p for p in positions + side)
obj += ''.join('vt %g %g\n' % (u, 1 - v) for u, v in uvs) + 'usemtl wood\n'
obj += ''.join('f %s\n' % ' '.join('%d/%d' % (4 * k + i + 1, i + 1) for i in range(4)) for k in range(2))
write('card.obj', obj)
write('card.mtl', 'newmtl wood\nKd 0.3 0.3 0.3\nmap_Kd F.png\n')
# z up: y of the card is z
ply = 'ply\nformat ascii 1.0\nelement vertex 8\n' + ''.join('property float %s\n' % a for a in 'xyz')
ply += ''.join('property uchar %s\n' % a for a in ('red', 'green', 'blue'))
ply += 'element face 4\nproperty list uchar int vertex_indices\nend_header\n'
ply += ''.join('%g %g %g %d 128 0\n' % (x, -z, y, 255 if y else 0) for x, y, z in positions + side)
ply += ''.join('3 %d %d %d\n' % tuple(4 * k + i for i in f) for k in range(2) for f in faces)
write('card.ply', ply)
stl = b'\0' * 80 + struct.pack('<I', 4)
for k in range(2):
    for f in faces:
        corners = [(positions + side)[4 * k + i] for i in f]
        stl += struct.pack('<12fH', 0, 0, 1, *[c for x, y, z in corners for c in (x, -z, y)], 0)
write('card.stl', stl)
write('card.dae', '''<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>Y_UP</up_axis></asset>
<library_images><image id="i"><init_from>F.png</init_from></image></library_images>
<library_effects><effect id="e"><profile_COMMON>
<newparam sid="s"><surface type="2D"><init_from>i</init_from></surface></newparam>
<newparam sid="t"><sampler2D><source>s</source></sampler2D></newparam>
<technique sid="c"><lambert><diffuse><texture texture="t" texcoord="UV"/></diffuse></lambert></technique>
</profile_COMMON></effect></library_effects>
<library_materials><material id="m" name="wood"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g" name="card"><mesh>
<source id="p"><float_array id="pa" count="12">%s</float_array><technique_common>
<accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<source id="u"><float_array id="ua" count="8">%s</float_array><technique_common>
<accessor source="#ua" count="4" stride="2"><param name="S" type="float"/><param name="T" type="float"/></accessor>
</technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="2" material="w"><input semantic="VERTEX" source="#v" offset="0"/>
<input semantic="TEXCOORD" source="#u" offset="1" set="0"/><p>%s</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="S">
%s</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#S"/></scene></COLLADA>
''' % (' '.join('%g %g %g' % p for p in positions), ' '.join('%g %g' % (u, 1 - v) for u, v in uvs),
       ' '.join('%d %d' % (i, i) for f in faces for i in f),
       ''.join('<node id="%s"><matrix>%s</matrix><instance_geometry url="#g"><bind_material><technique_common>'
               '<instance_material symbol="w" target="#m"/></technique_common></bind_material></instance_geometry>'
               '</node>\n' % n for n in (('a', '1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1'),
                                         ('b', '0 0 1 1.25 0 1 0 0 -1 0 0 -0.25 0 0 0 1')))))

# An image of opacity that is missing, and one that is no image.
for name, image in (('holes', 'gone.png'), ('holes_torn', 'card.mtl')):
    write(name + '.obj', obj.replace('card.mtl', name + '.mtl'))
    write(name + '.mtl', 'newmtl wood\nKd 1 1 1\nmap_Kd F.png\nmap_d %s\n' % image)

# An ambient light that shines, and one that is black.
with open('card.dae', encoding='utf-8') as dae:
    card_dae = dae.read()
for name, color in ('ambient', '.2 .1 0'), ('black', '0 0 0'):
    write(name + '.dae', card_dae.replace('<library_visual_scenes>', (
        '<library_lights><light id="l"><technique_common><ambient><color>%s</color></ambient></technique_common></light>'
        '</library_lights><library_visual_scenes>') % color).replace(
            '</visual_scene>', '<node id="n"><instance_light url="#l"/></node></visual_scene>'))


def tds(kind, *inside):
    data = b''.join(inside)
    return struct.pack('<HI', kind, 6 + len(data)) + data


def tds_file(*objects):
    return tds(0x4d4d, tds(2, struct.pack('<I', 3)), *objects)


def tds_cards(name, corners):
    """A mesh of rectangles, of four corners each."""
    indices = [struct.pack('<4H', *(k + i for i in f), 7) for k in range(0, len(corners), 4) for f in faces]
    return tds(0x4000, name + b'\0', tds(
        0x4100, tds(0x4110, struct.pack('<H', len(corners)), *(struct.pack('<3f', *p) for p in corners)),
        tds(0x4120, struct.pack('<H', len(indices)), *indices)))


# 3DS, z up: the card, and the reference's camera, whose lens is 2400 by its angle in degrees.
corners = [(x, -z, y) for x, y, z in positions + side]
angle = math.degrees(2 * math.atan(math.tan(.3) * 4 / 3))
studio = tds_file(tds(
    0x3d3d, tds_cards(b'Card', corners),
    tds(0x4000, b'Eye\0', tds(0x4700, struct.pack('<8f', .75, -2.5, .5, .75, 0, .5, 0, 2400 / angle)))),
    tds(0xb000, *(tds(kind, tds(0xb010, name + struct.pack('<HHH', 0, 0, 0xffff)), tds(
        0xb020, struct.pack('<HII', 0, 0, 0), struct.pack('<IIH', 1, 0, 0), struct.pack('<3f', *at)))
        for kind, name, at in ((0xb002, b'Card\0', (0, 0, 0)), (0xb003, b'Eye\0', (.75, -2.5, .5))))))
write('card.3ds', studio)

# A camera that looks along (2, 3, -6) / 7, rolled by a quarter.
write('rolled.3ds', tds_file(tds(
    0x3d3d, tds_cards(b'Card', corners[:4]),
    tds(0x4000, b'Eye\0', tds(0x4700, struct.pack('<8f', 0, 0, 0, 2, 3, -6, 90, 50))))))

# A bulb twice as bright as its colour, and a spot that looks from (-4, 0, 5) to (-4, 3, 1), its cones of 30 and 50 degrees.
corners = [(-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0)]
write('lights.3ds', tds_file(tds(
    0x3d3d, tds_cards(b'Floor', corners),
    tds(0x4000, b'Bulb\0', tds(0x4600, struct.pack('<3f', 1, 2, 3), tds(0x10, struct.pack('<3f', 1, .5, .25)),
                                tds(0x465b, struct.pack('<f', 2)))),
    tds(0x4000, b'Lamp\0', tds(0x4600, struct.pack('<3f', -4, 0, 5), tds(0x10, struct.pack('<3f', .25, .5, 1)),
                                tds(0x4610, struct.pack('<5f', -4, 3, 1, 30, 50)))))))

# UV of 16 and of 8 bits, each element on four bytes, and positions of 16 bits by KHR_mesh_quantization.


def integers(uv_type, uv_bytes, uv_stride, short_positions=False):
    data = (b''.join(struct.pack('<3hxx', *(32767 * a for a in p)) for p in positions) if short_positions else
            buffer[:48]) + uv_bytes + buffer[80:]
    scene = gltf(MATERIAL, buffer=data)
    size = 32 if short_positions else 48
    scene['bufferViews'] = [{'buffer': 0, 'byteLength': size}, {'buffer': 0, 'byteOffset': size, 'byteLength': 16},
                            {'buffer': 0, 'byteOffset': size + 16, 'byteLength': 12}]
    scene['bufferViews'][1]['byteStride'] = uv_stride
    scene['accessors'][1].update(componentType=uv_type, normalized=True)
    if short_positions:
        scene['bufferViews'][0]['byteStride'] = 8
        scene['accessors'][0].update(componentType=5122, normalized=True, max=[32767, 32767, 0])
        scene['extensionsUsed'] = scene['extensionsRequired'] = ['KHR_mesh_quantization']
    return scene, data


words = b''.join(struct.pack('<2H', 65535 * u, 65535 * v) for u, v in uvs)
octets = b''.join(struct.pack('<2Bxx', 255 * u, 255 * v) for u, v in uvs)
scene, data = integers(5123, words, 4)
write('words.bin', data)
scene['buffers'][0]['uri'] = 'words.bin'
write('words.gltf', json.dumps(scene))
scene, data = integers(5121, octets, 4, True)
write('quantized.gltf', json.dumps(scene))
del scene['buffers'][0]['uri']
write('quantized.glb', glb(scene, data))
scene['bufferViews'][1]['byteLength'] = 13
write('beyond.glb', glb(scene, data))

# Roughness is .75 times green, which rises with u; metallic is blue, in the upper half.
numbers = png(16, 16, lambda x, y: (0, 16 * x, 255 if y < 8 else 0), 3)
varying = gltf({'name': 'steel', 'pbrMetallicRoughness': {
    'metallicRoughnessTexture': {'index': 0}, 'roughnessFactor': .75}}, numbers)
write('varying.gltf', json.dumps(varying))

# Normals that lean to the left and down, in glTF by half; a ramp of heights.
write('leaning.png', png(16, 16, lambda x, y: (64, 96, 230), 3))
bumpy = gltf({'name': 'bumpy', 'normalTexture': {'index': 0, 'scale': .5}, 'pbrMetallicRoughness': {'metallicFactor': 0}},
             {'uri': 'leaning.png'})
write('bumpy.gltf', json.dumps(bumpy))
write('ramp.png', png(256, 256, lambda x, y: (x,) * 3, 3))
for name, bump in (('ramp_numbers', {'distance': .3, 'numbers': True}), ('ramp_colors', {'distance': .3}),
                   ('ramp_weak', {'distance': -.6, 'strength': .5, 'numbers': 1}), ('ramp_none', {'distance': 0})):
    write(name + '.gltf', json.dumps(gltf(
        {'name': 'bumpy', 'normalTexture': {'index': 0}, 'pbrMetallicRoughness': {'metallicFactor': 0},
         'extras': {'retex': {'bump': bump}}}, {'uri': 'ramp.png'})))
for name, image in (('bumpy', 'leaning.png'), ('ramp', '-bm 30 ramp.png')):
    write(name + '.obj', obj.replace('card.mtl', name + '.mtl'))
    write(name + '.mtl', 'newmtl wood\nKd 0.3 0.3 0.3\nmap_Bump %s\n' % image)

# The same numbers and normals, on the second set of UV, and the colours' image on the first.
both = {'baseColorTexture': {'index': 0}, 'metallicRoughnessTexture': {'index': 0, 'texCoord': 1}, 'roughnessFactor': .75}
write('varying_second.gltf', json.dumps(gltf({'name': 'steel', 'pbrMetallicRoughness': both}, numbers, second_uv=True)))
write('bumpy_second.gltf', json.dumps(gltf({
    'name': 'bumpy', 'normalTexture': {'index': 0, 'scale': .5, 'texCoord': 1},
    'pbrMetallicRoughness': {'baseColorTexture': {'index': 0}, 'metallicFactor': 0}},
    {'uri': 'leaning.png'}, second_uv=True)))

# Colours of vertices over an image.
colored = gltf(MATERIAL, buffer=buffer + struct.pack('<12f', *(.5, 1, .25) * 4))
colored['accessors'].append({'bufferView': 3, 'componentType': 5126, 'count': 4, 'type': 'VEC3'})
colored['bufferViews'].append({'buffer': 0, 'byteOffset': 92, 'byteLength': 48})
colored['meshes'][0]['primitives'][0]['attributes']['COLOR_0'] = 4
write('colored.gltf', json.dumps(colored))

# A coat whose weight varies with its image's red, and sheen.
write('coated.gltf', json.dumps(dict(gltf({'name': 'silk', 'pbrMetallicRoughness': {'metallicFactor': 0}, 'extensions': {
    'KHR_materials_clearcoat': {
        'clearcoatFactor': .5, 'clearcoatTexture': {'index': 0}, 'clearcoatRoughnessFactor': .25,
        'clearcoatNormalTexture': {'index': 0, 'scale': .5}},
    'KHR_materials_sheen': {'sheenColorFactor': [.5, .25, .125], 'sheenRoughnessFactor': .75}}}),
    extensionsUsed=['KHR_materials_clearcoat', 'KHR_materials_sheen'])))

# Glass with dispersion; sheen whose roughness is half its image's alpha; what is left out.
write('prism.gltf', json.dumps(dict(gltf({
    'name': 'flint', 'pbrMetallicRoughness': {'roughnessFactor': 0, 'metallicFactor': 0},
    'extensions': {'KHR_materials_transmission': {'transmissionFactor': 1}, 'KHR_materials_ior': {'ior': 1.6},
                   'KHR_materials_dispersion': {'dispersion': .55}}}),
    extensionsUsed=['KHR_materials_transmission', 'KHR_materials_ior', 'KHR_materials_dispersion'])))
write('velvet.gltf', json.dumps(dict(gltf({
    'name': 'velvet', 'pbrMetallicRoughness': {'metallicFactor': 0}, 'extensions': {
    'KHR_materials_sheen': {'sheenColorFactor': [.5, .5, .5], 'sheenRoughnessFactor': .5,
                            'sheenRoughnessTexture': {'index': 0}},
    'KHR_materials_specular': {'specularColorTexture': {'index': 0}},
    'KHR_materials_iridescence': {'iridescenceFactor': 1}}}, half),
    extensionsUsed=['KHR_materials_sheen', 'KHR_materials_specular', 'KHR_materials_iridescence',
                    'EXT_mesh_gpu_instancing', 'X\u001b[31m', 7])))

# ---- what glTF files may have, and Assimp would misread ----


def with_views(scene, data, *pieces):
    """More buffer views at the end of the one buffer; returns the number of the first."""
    first = len(scene['bufferViews'])
    for piece in pieces:
        scene['bufferViews'].append({'buffer': 0, 'byteOffset': len(data), 'byteLength': len(piece)})
        data += piece + b'\0' * (-len(piece) % 4)
    scene['buffers'] = [{'byteLength': len(data),
                         'uri': 'data:application/octet-stream;base64,' + base64.b64encode(data).decode()}]
    return first


def changed(name, scene, *path, **to):
    """Write a copy in which what the path leads to has other values."""
    scene = at = json.loads(json.dumps(scene))
    for key in path:
        at = at[key]
    at.update(to)
    write(name, json.dumps(scene))


def with_extension(extension, required, **of):
    scene = dict(gltf(MATERIAL), extensionsUsed=[extension], **of)
    return dict(scene, extensionsRequired=[extension]) if required else scene


# Sparse accessors: all elements of one without a view, of integers and of floats; one element of another.
whole = struct.pack('<8H', *(65535 * a for uv in uvs for a in uv))
scene, data = integers(5123, whole, 4)
first = with_views(scene, data, bytes(range(4)), whole)
del scene['accessors'][1]['bufferView']
scene['accessors'][1]['sparse'] = {'count': 4, 'indices': {'bufferView': first, 'componentType': 5121},
                                   'values': {'bufferView': first + 1}}
write('sparse_words.gltf', json.dumps(scene))
changed('sparse_beyond.gltf', scene, 'accessors', 1, count=3)
scene = gltf(MATERIAL)
first = with_views(scene, buffer[:56] + b'\x12\x34\x56\x40' * 2 + buffer[64:], struct.pack('<I', 1), buffer[56:64])
scene['accessors'][1]['sparse'] = {'count': 1, 'indices': {'bufferView': first, 'componentType': 5125},
                                   'values': {'bufferView': first + 1}}
write('sparse.gltf', json.dumps(scene))
# Strides that are zero, written with a point, or larger than the buffer; a type that UV cannot have.
scene, data = integers(5123, words, 4)
changed('stride_zero.gltf', scene, 'bufferViews', 1, byteStride=0)
changed('stride_point.gltf', scene, 'bufferViews', 1, byteStride=4.0)
changed('stride_huge.gltf', scene, 'bufferViews', 1, byteStride=2**31)
changed('longs.gltf', scene, 'accessors', 1, componentType=5125)


def morphed(of_nodes):
    """The card at the weights -0.5 and 0.25 of two morph targets, which move its vertices and normals."""
    scene, moves = gltf(MATERIAL), ((.5, -1, 2), (3, 1, -5))
    vectors = [[(x + .5 * moves[0][k] - .25 * moves[1][k]) for k, x in enumerate(p)] for p in positions]
    vectors += [(0, .75, .25)] * 4
    for move, turn in zip(moves, ((0, .5, -.5), (0, -2, 2))):
        vectors += [move] * 4 + [turn] * 4
    data = buffer + b''.join(struct.pack('<3f', *v) for v in vectors)
    for k in range(6):
        scene['bufferViews'].append({'buffer': 0, 'byteOffset': len(buffer) + 48 * k, 'byteLength': 48})
        scene['accessors'].append({'bufferView': 3 + k, 'componentType': 5126, 'count': 4, 'type': 'VEC3',
                                   'min': [-9] * 3, 'max': [9] * 3})
    primitive = scene['meshes'][0]['primitives'][0]
    primitive['attributes'].update(POSITION=4, NORMAL=5)
    primitive['targets'] = [{'POSITION': 6, 'NORMAL': 7}, {'POSITION': 8, 'NORMAL': 9}]
    scene['buffers'][0] = {'byteLength': len(data), 'uri': 'data:application/octet-stream;base64,' +
                           base64.b64encode(data).decode()}
    for owner in scene['nodes'][:2] if of_nodes else scene['meshes']:
        owner['weights'] = [-.5, .25]
    if of_nodes:
        scene['meshes'][0]['weights'] = [1, 1]
    return scene


scene = gltf(MATERIAL)
scene['meshes'][0]['primitives'][0]['targets'] = [{'POSITION': 0}]
write('morph_rest.gltf', json.dumps(scene))  # weights are 0 unless the file says so
write('morph.gltf', json.dumps(morphed(False)))
write('morph_nodes.gltf', json.dumps(morphed(True)))
# Text with a name in Latin-1 or with NULs, and one that is no JSON; a .glb with more chunks, and with the chunks in
# another order.
scene, data = integers(5121, octets, 4, True)
text = json.dumps(scene)
write('latin.gltf', text.replace('"wood"', '"w\xe4d"').encode('latin-1'))
write('nul.gltf', text.replace('"wood"', '"w\\u0000d"'))
write('comma.gltf', text[:-1] + ',}')
# of floats and without a camera, so that nothing but its text is a reason to write it anew
scene, data = gltf(MATERIAL), buffer
del scene['buffers'][0]['uri'], scene['cameras'], scene['nodes'][2], scene['scenes'][0]['nodes'][2]
while len(json.dumps(scene)) % 4 != 1:
    scene['asset']['generator'] = scene['asset'].get('generator', '') + 'x'
binary = glb(scene, data)
end = 20 + struct.unpack('<I', binary[12:16])[0]
text = json.dumps(scene).encode()
write('padded.glb', binary[:20] + text + b'\0' * 3 + binary[end:])
odd = struct.pack('<II', len(text), 0x4e4f534a) + text + binary[end:]
write('unaligned.glb', struct.pack('<III', 0x46546c67, 2, 12 + len(odd)) + odd)
more = struct.pack('<II', 4, 0x12345678) + b'more'
for name, body in (('after', binary[12:] + more), ('between', binary[12:end] + more + binary[end:]),
                   ('before', binary[end:] + binary[12:end])):
    write('chunk_%s.glb' % name, struct.pack('<III', 0x46546c67, 2, 12 + len(body)) + body)
# Images that extensions name: of WebP, a picture of one colour; of AVIF, the letter without loss; of KTX2, which is not
# read, for a material or several, beside one that is read, for none.
write('F.avif', base64.b64decode(
    'AAAAHGZ0eXBhdmlmAAAAAG1pZjFhdmlmbWlhZgAAAOptZXRhAAAAAAAAACFoZGxyAAAAAAAAAABwaWN0AAAAAAAAAAAAAAAAAAAAACJpbG9j'
    'AAAAAERAAAEAAQAAAAABDgABAAAAAAAAAEEAAAAjaWluZgAAAAAAAQAAABVpbmZlAgAAAAABAABhdjAxAAAAAA5waXRtAAAAAAABAAAAamlw'
    'cnAAAABLaXBjbwAAAAxhdjFDgSACAAAAABNjb2xybmNseAABAA0AAIAAAAAUaXNwZQAAAAAAAAAQAAAAEAAAABBwaXhpAAAAAAMICAgAAAAX'
    'aXBtYQAAAAAAAAABAAEEgQIDBAAAAEltZGF0EgAKCDgM/9hAQ0AIMjNEAACG10i9LtBog9S1c3cWLCPpQlijU6HcC9ntl2Z0tiUGQNddAJMV'
    'EE0mYREss639XYA='))
write('red.webp', base64.b64decode(
    'UklGRkQAAABXRUJQVlA4IDgAAABQAgCdASoIAAgAAAAAJaACdLoB+AH6AfwAB5AA/v9vVv/8sPx/Unn/yxD//xPTm8RU8r/+JkAAAA=='))
for name, extension, image in (('webp', 'EXT_texture_webp', 'red.webp'), ('avif', 'EXT_texture_avif', 'F.avif'),
                               ('ktx', 'KHR_texture_basisu', 'wood.ktx2')):
    write(name + '.gltf', json.dumps(with_extension(
        extension, True, images=[{'uri': image}], textures=[{'extensions': {extension: {'source': 0}}}])))
shining = dict(MATERIAL, emissiveTexture={'index': 0}, emissiveFactor=[1, 1, 1], extensions={'KHR_materials_unlit': {}})
write('ktx_unlit.gltf', json.dumps(dict(json.load(open('ktx.gltf', encoding='ascii')), materials=[shining])))
scene = with_extension('KHR_texture_basisu', True, images=[{'uri': 'F.png'}, {'uri': 'a.ktx2'}, {'uri': 'b.ktx2'}, {}])
scene['textures'] = [{'source': 0, 'extensions': {'KHR_texture_basisu': {'source': 1}}},
                     *({'extensions': {'KHR_texture_basisu': {'source': k}}} for k in (1, 2, 3))]
scene['materials'] = [MATERIAL, {'name': 'bumps', 'normalTexture': {'index': 1}}, {'emissiveTexture': {'index': 1}},
                      {'name': 'coat', 'extensions': {'KHR_materials_clearcoat': {'clearcoatTexture': {'index': 3}}}},
                      *({'name': 'oak %d' % k, 'normalTexture': {'index': 1}} for k in range(5))]
write('ktx_some.gltf', json.dumps(scene))
scene = gltf(MATERIAL)
scene['images'] = [{'uri': 'gone %d.png' % k} for k in range(20)]
scene['textures'] = [{'source': k} for k in range(20)]
scene['materials'] = [{'normalTexture': {'index': k}} for k in range(20)]
scene['meshes'][0]['primitives'] = [dict(scene['meshes'][0]['primitives'][0], material=k) for k in range(20)]
write('gone.gltf', json.dumps(scene))
# The image on the eighth set of UV, and the ninth; one on the second where there is one, or none; three sets at once.
for name, sets, image in (('eighth', 8, 7), ('ninth', 9, 8), ('lacking', 1, 1), ('without', 0, 0)):
    scene = gltf(dict(MATERIAL, pbrMetallicRoughness={
        'baseColorTexture': {'index': 0, 'texCoord': image}, 'metallicFactor': 0}))
    scene['meshes'][0]['primitives'][0]['attributes'] = dict(
        {'POSITION': 0}, **{'TEXCOORD_%d' % k: 1 if k == sets - 1 else 3 for k in range(sets)})
    write(name + '.gltf', json.dumps(scene))
scene = gltf(dict(MATERIAL, pbrMetallicRoughness=both, normalTexture={'index': 0, 'texCoord': 2},
                  emissiveTexture={'index': 1, 'texCoord': 2}, emissiveFactor=[1, 1, 1]), second_uv=True)
scene['meshes'][0]['primitives'][0]['attributes']['TEXCOORD_2'] = 1
scene['images'].append({'uri': 'leaning.png'})
scene['textures'].append({'source': 1})
write('three.gltf', json.dumps(scene))

# An image that ends too early, and one that is none.
write('torn.gltf', json.dumps(gltf(MATERIAL, F[:-30])))
write('no_image.gltf', json.dumps(gltf(MATERIAL, F[:8] + b'no')))

# Damage.
write('short.glb', card[:len(card) // 2])
write('empty.obj', '')
write('noise.fbx', bytes(i * 37 % 256 for i in range(4096)))
huge = gltf(MATERIAL)
huge['accessors'][0]['count'] = 1000000000
write('huge.gltf', json.dumps(huge))
write('cycle.gltf', json.dumps(gltf(MATERIAL, nodes=[{'mesh': 0, 'children': [1]}, {'children': [0]}])))
write('far.obj', 'v 0 0 0\nv 1e30 0 0\nv 0 1 0\nf 1 2 3\n')
write('faces.obj', 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9999999\n')
os.makedirs('below', exist_ok=True)
write('secret.png', F)
write('below/out.gltf', json.dumps(gltf(MATERIAL, {'uri': '../secret.png'})))
write('below/buffer.gltf', json.dumps(gltf(MATERIAL, buffer_uri='../F.png')))
write('below/missing.gltf', json.dumps(gltf(MATERIAL, {'uri': 'http://example.org/wood.png'})))
write('names.obj', 'mtllib names.mtl\n' + ''.join('v %g %g %g\n' % p for p in positions) +
      ''.join('usemtl %s\nf 1 2 3\n' % n for n in ('sphere', 'Sphere', '2nd', '\u6728')))
write('names.mtl', ''.join('newmtl %s\nKd 1 0 0\n' % n for n in ('sphere', 'Sphere', '2nd', '\u6728')))
write('large.obj', 'v 0 0 0\nv 1 0 0\nv 0 1 0\n' * 1000000 + 'f 1 2 3\n')
