"""For import_bumps.t. Without arguments: writes bumps.glb, cards with a normal map, turned at random, with UV that are
plain, mirrored, turned and sheared: seen from in front; from behind, for the card is turned, or its winding and normals
are; by nodes that mirror. With the picture of their normals: compares the middle of each card with glTF's rule, by numpy.

That is: the normal is x T + y B + z N, normalised; N and T are interpolated between the corners, B is the cross product of
N and T times w, by which B is on the side to which v grows up; where the back is seen, which has no other normal map, all of
it is reversed."""
import json
import struct
import sys

import numpy as np

WIDE, HIGH, YFOV, FAR = 160, 120, .5, 12
PLACES = [(20 + 40 * i, 15 + 30 * j) for j in range(4) for i in range(4)]  # pixels
COLOR = np.array([179, 140, 220], np.uint8)
UVS = [[[1, 0], [0, 1]], [[-1, 0], [0, 1]], [[0, 1], [-1, 0]], [[.5, .4], [0, -2]]]
KINDS = ['front', 'turned', 'reversed', 'mirrored']
random = np.random.default_rng(3)


def turned():
    """A small rotation at random."""
    axis, angle = random.normal(size=3), random.uniform(-.4, .4)
    x, y, z = axis / np.linalg.norm(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def card(place, matrix, kind):
    """Corners, normals, tangents with w, UV from the top, and faces of a card in its own space, and its node's matrix."""
    positions = np.array([[-.5, -.5, 0], [.5, -.5, 0], [.5, .5, 0], [-.5, .5, 0]])
    normals = unit(positions * [.2, .2, 0] + [.2, .1, 1])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    rotation = turned()
    if kind == 'turned':
        rotation = rotation @ np.diag([-1, 1, -1])
    if kind == 'mirrored':
        rotation = rotation @ np.diag([-1, 1, 1])
    if kind == 'reversed':
        normals, faces = -normals, faces[:, ::-1]
    uvs = positions[:, :2] @ np.array(matrix).T
    along_u, along_v = np.linalg.inv(np.array(matrix)).T  # how a place on the card moves with u and v
    along_u, along_v = np.append(along_u, 0), np.append(along_v, 0)
    tangents = unit(along_u - normals * (normals @ along_u)[:, None])
    w = np.sign(np.cross(normals, tangents) @ along_v)
    half = np.tan(YFOV / 2) * FAR
    x, y = (2 * (place[0] + .5) / WIDE - 1) * half * WIDE / HIGH, (1 - 2 * (place[1] + .5) / HIGH) * half
    node = np.eye(4)
    node[:3, :3], node[:3, 3] = rotation, (x, y, -FAR)
    return positions, normals, np.column_stack([tangents, w]), np.column_stack([uvs[:, 0], 1 - uvs[:, 1]]), faces, node


def cards():
    return [(kind, *card(PLACES[4 * j + i], matrix, kind)) for j, kind in enumerate(KINDS) for i, matrix in enumerate(UVS)]


def expected(kind, positions, normals, tangents, uvs, faces, node):
    """In the scene's space, whose z is mirrored: the normal that is seen in the middle, where both faces meet."""
    m, x = node[:3, :3], COLOR / 127.5 - 1
    place = positions @ m.T + node[:3, 3]
    n = unit(unit(normals @ np.linalg.inv(m))[[0, 2]].mean(0))
    t = unit(unit(tangents[:, :3] @ m.T)[[0, 2]].mean(0))
    w = tangents[0, 3] * np.sign(np.linalg.det(m))  # as of the card without its node
    seen = unit(x[0] * t + x[1] * np.cross(n, t) * w + x[2] * n)
    a, b, c = place[faces[0]]
    outside = np.cross(b - a, c - a) * np.sign(np.linalg.det(m))  # counter-clockwise is in front; nodes that mirror turn it
    is_back = outside @ -place.mean(0) < 0  # the camera is at 0
    assert is_back == (kind in ('turned', 'reversed'))
    return (-seen if is_back else seen) * [1, 1, -1]


def png(color):
    import io
    import zlib
    chunk = lambda kind, data: struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
    rows = (b'\0' + bytes(color) * 4) * 4
    out = io.BytesIO(b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', 4, 4, 8, 2, 0, 0, 0)) +
                     chunk(b'IDAT', zlib.compress(rows)) + chunk(b'IEND', b''))
    return out.getvalue()


def write():
    data, views, accessors, meshes, nodes = b'', [], [], [], []

    def view(content):
        nonlocal data
        views.append({'buffer': 0, 'byteOffset': len(data), 'byteLength': len(content)})
        data += content + bytes(-len(content) % 4)
        return len(views) - 1

    def accessor(array, kind):
        array = np.ascontiguousarray(array, np.uint16 if kind == 'SCALAR' else np.float32)
        accessors.append({'bufferView': view(array.tobytes()), 'componentType': 5123 if kind == 'SCALAR' else 5126,
                          'count': len(array), 'type': kind, 'min': np.atleast_1d(array.min(0)).tolist(),
                          'max': np.atleast_1d(array.max(0)).tolist()})
        return len(accessors) - 1

    for kind, positions, normals, tangents, uvs, faces, node in cards():
        meshes.append({'primitives': [{'attributes': {
            'POSITION': accessor(positions, 'VEC3'), 'NORMAL': accessor(normals, 'VEC3'),
            'TANGENT': accessor(tangents, 'VEC4'), 'TEXCOORD_0': accessor(uvs, 'VEC2')},
            'indices': accessor(faces.ravel(), 'SCALAR'), 'material': 0}]})
        nodes.append({'mesh': len(meshes) - 1, 'matrix': node.T.ravel().tolist()})
    nodes.append({'camera': 0, 'name': 'eye'})
    image = view(png(COLOR))
    scene = {
        'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': list(range(len(nodes)))}], 'nodes': nodes,
        'cameras': [{'type': 'perspective', 'perspective': {'yfov': YFOV, 'aspectRatio': WIDE / HIGH, 'znear': .1}}],
        'meshes': meshes, 'images': [{'bufferView': image, 'mimeType': 'image/png'}], 'textures': [{'source': 0}],
        'materials': [{'name': 'card', 'doubleSided': True, 'normalTexture': {'index': 0},
                       'pbrMetallicRoughness': {'metallicFactor': 0}}],
        'accessors': accessors, 'bufferViews': views, 'buffers': [{'byteLength': len(data)}]}
    text = json.dumps(scene).encode()
    text += b' ' * (-len(text) % 4)
    with open('bumps.glb', 'wb') as out:
        out.write(struct.pack('<4sII', b'glTF', 2, 28 + len(text) + len(data)) +
                  struct.pack('<I4s', len(text), b'JSON') + text + struct.pack('<I4s', len(data), b'BIN\0') + data)


def judge(picture):
    import OpenImageIO as oiio
    image = oiio.ImageInput.open(picture)
    seen = image.read_image(format='float')
    for number, (kind, *of) in enumerate(cards()):
        x, y = PLACES[number]
        found, wanted = seen[y, x, :3], expected(kind, *of)
        off = np.linalg.norm(found - wanted)
        print(kind, 'UV', number % 4, 'as expected' if off < 1e-3 else f'{found} instead of {wanted}')


judge(sys.argv[1]) if len(sys.argv) > 1 else write()
