"""For import_targets.t. Without arguments: writes rooms as glTF. `judge NAME < LIST`: whether the targets that --list-targets
lists for NAME/NAME.pov are what its parts are labelled as, by a ray tracer of its own: Floor is all that is labelled `floor`,
Wall is that part labelled `wall` of which most is seen; prints what is wrong."""
import base64
import json
import math
import re
import struct
import sys

import numpy as np

W, H = 64, 48


class Room:
    """Parts are (node, material, label, four corners); y is up, z towards the viewer, in metres. Three corners suffice: all
    are parallelograms."""

    def __init__(self):
        self.parts = []

    def quad(self, node, material, label, p, a, b):
        p, a, b = (np.array(v, float) for v in (p, a, b))
        self.parts.append((node, material, label, [p, p + a, p + a + b, p + b]))

    def box(self, node, material, low, high, top=None, front=None):
        """Seen from outside. top, front: the labels of these sides, towards +y and +z."""
        (x, y, z), (w, h, d) = low, np.subtract(high, low)
        self.quad(node, material, top, (x, y + h, z + d), (w, 0, 0), (0, 0, -d))
        self.quad(node, material, None, (x, y, z), (w, 0, 0), (0, 0, d))
        self.quad(node, material, front, (x, y, z + d), (w, 0, 0), (0, h, 0))
        self.quad(node, material, None, (x + w, y, z), (-w, 0, 0), (0, h, 0))
        self.quad(node, material, None, (x, y, z), (0, 0, d), (0, h, 0))
        self.quad(node, material, None, (x + w, y, z + d), (0, 0, -d), (0, h, 0))

    def shell(self, floor=True, material='Mat', ceiling='Mat.003', walls='LBRF', names=('Plane', 'Cube')):
        """5 by 4 by 2.6, seen from inside."""
        floor_name, wall_name = names
        if floor:
            self.quad(floor_name, material, 'floor', (0, 0, 4), (5, 0, 0), (0, 0, -4))
        if ceiling:
            self.quad('Cube.001', ceiling, None, (0, 2.6, 0), (5, 0, 0), (0, 0, 4))
        for side, p, a in (('L', (0, 0, 4), (0, 0, -4)), ('B', (0, 0, 0), (5, 0, 0)), ('R', (5, 0, 0), (0, 0, 4)),
                           ('F', (5, 0, 4), (-5, 0, 0))):
            if side in walls:
                self.quad(wall_name, material, 'wall' + side, p, a, (0, 2.6, 0))

    def furniture(self, material='Mat.001', rug=.012):
        self.box('Cube.004', material, (3.4, 0, .1), (4.9, .75, .9))
        self.box('Cube.005', material, (.1, 0, .6), (1, .8, 2.2))
        if rug:
            self.box('Cube.006', material, (1.8, .003, 1.6), (3.2, rug, 2.6))

    def turned(self, degrees):
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        other = Room()
        for node, material, label, corners in self.parts:
            other.parts.append((node, material, label, [np.array((c * x + s * z, y, c * z - s * x)) for x, y, z in corners]))
        return other


def boards():
    room = Room()
    room.shell(floor=False)
    for k in range(20):
        for row in range(2):
            top = .001 * ((7 * k + 5 * row) % 3) # flush, or a millimetre or two higher
            room.box('Cube.%03d' % (10 + 2 * k + row), 'Mat.002', (.25 * k + .001, -.02, 2 * row + .001),
                     (.25 * k + .249, top, 2 * row + 1.999), top='floor')
    room.quad('Plane.001', 'Mat.002', None, (0, -.02, 4), (5, 0, 0), (0, 0, -4))
    room.furniture()
    return room


def tiles():
    """On a bed, which is seen between them."""
    room = Room()
    room.shell(floor=False)
    room.quad('Plane.001', 'Mat.002', 'floor', (0, -.008, 4), (5, 0, 0), (0, 0, -4))
    for i in range(10):
        for j in range(8):
            room.box('Tile', 'Mat.002', (.5 * i + .02, -.008, .5 * j + .02), (.5 * i + .48, 0, .5 * j + .48), top='floor')
    room.furniture()
    return room


def atlas():
    """One mesh, one material."""
    room = Room()
    room.shell()
    room.furniture('Mat')
    room.parts = [('Mesh', 'Mat', label, corners) for _, _, label, corners in room.parts]
    return room


def named():
    """A stage covers most of the floor, and a wardrobe a wall."""
    room = Room()
    room.shell(names=('Fußboden', 'rueckWand_01'))
    room.box('Podest', 'Mat.001', (1.2, 0, .9), (4.6, .15, 3.2))
    room.box('grosserSchrank', 'Mat.001', (.2, 0, .1), (4.9, 2.5, .6))
    return room


def divided():
    """A partition stands in the room, whose walls are of the ceiling's material."""
    room = Room()
    room.shell(floor=False, ceiling='Mat')
    room.quad('Plane', 'Mat.002', 'floor', (0, 0, 4), (5, 0, 0), (0, 0, -4))
    room.box('Cube.002', 'Mat.001', (1.5, 0, 1.9), (3.3, 1.9, 1.95))
    return room


def diorama():
    room = Room()
    room.box('Cube', 'Mat', (0, -.2, 0), (4, 0, 4), top='floor')
    room.box('Cube.001', 'Mat', (-.1, -.2, -.1), (0, 2.4, 4))
    room.parts[-2] = room.parts[-2][:2] + (None,) + room.parts[-2][3:]
    room.box('Cube.002', 'Mat', (0, -.2, -.1), (4, 2.4, 0), front='wallB')
    room.parts = [p[:2] + ('wallL',) + p[3:] if p[0] == 'Cube.001' and np.ptp([c[0] for c in p[3]]) == 0 and p[3][0][0] == 0
                  else p for p in room.parts]
    room.box('Cube.003', 'Mat.001', (1, 0, .4), (2.2, .7, 1.1))
    return room


def furniture():
    """A table with a chair, and a sofa on legs."""
    room = Room()
    room.box('Top', 'Wood', (0, .7, 0), (2.2, .75, 1))
    for x in (0, 2.1):
        for z in (0, .9):
            room.box('Leg', 'Wood', (x, 0, z), (x + .1, .7, z + .1))
    room.box('Seat', 'Cloth', (0, .15, 2), (2, .42, 2.9))
    room.box('Back', 'Cloth', (0, .15, 1.8), (2, .9, 2))
    for x in (-.2, 2):
        room.box('Arm', 'Cloth', (x, .15, 1.8), (x + .2, .65, 2.9))
    return room


def exterior():
    room = Room()
    room.box('Lawn', 'Grass', (-12, -.1, -12), (12, 0, 12))
    room.box('House', 'Brick', (-3, 0, -2), (3, 5, 2))
    for x, z in ((-8, 3), (6, -7), (8, 4), (-6, -8)):
        room.box('Trunk', 'Bark', (x, 0, z), (x + .5, 4, z + .5))
    return room


def park():
    room = Room()
    room.box('Lawn', 'Grass', (-12, -.1, -12), (12, 0, 12))
    for k in range(48):
        a, r = 2 * math.pi * k / 48, 7 + (k * 7 % 11) / 3
        room.box('Trunk', 'Bark', (r * math.cos(a), 0, r * math.sin(a)), (r * math.cos(a) + .45, 4, r * math.sin(a) + .45))
    return room


ROOMS = {'boards': boards(), 'tiles': tiles(), 'atlas': atlas(), 'turned': boards().turned(30), 'named': named(),
         'diorama': diorama(), 'furniture': furniture(), 'divided': divided(), 'park': park(), 'exterior': exterior()}


def gltf(name, room):
    data, views, accessors, meshes, nodes = b'', [], [], [], []
    materials = sorted({p[1] for p in room.parts})
    groups = {}
    for node, material, _, corners in room.parts:
        groups.setdefault((node, material), []).append(corners)
    for (node, material), quads in groups.items():
        points = [tuple(float(c) for c in p) for q in quads for p in q]
        indices = [4 * k + j for k in range(len(quads)) for j in (0, 1, 2, 0, 2, 3)]
        for part, kind, count, of in ((b''.join(struct.pack('<3f', *p) for p in points), 5126, len(points), 'VEC3'),
                                      (struct.pack('<%dH' % len(indices), *indices), 5123, len(indices), 'SCALAR')):
            views.append({'buffer': 0, 'byteOffset': len(data), 'byteLength': len(part)})
            accessors.append({'bufferView': len(views) - 1, 'componentType': kind, 'count': count, 'type': of})
            if of == 'VEC3':
                accessors[-1].update(min=[min(p[k] for p in points) for k in range(3)],
                                     max=[max(p[k] for p in points) for k in range(3)])
            data += part + b'\0' * (-len(part) % 4)
        meshes.append({'primitives': [{'attributes': {'POSITION': len(accessors) - 2}, 'indices': len(accessors) - 1,
                                       'material': materials.index(material)}]})
        nodes.append({'mesh': len(meshes) - 1, 'name': node})
    with open(name + '.gltf', 'w', encoding='utf-8') as out:
        json.dump({'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': list(range(len(nodes)))}], 'nodes': nodes,
                   'meshes': meshes, 'accessors': accessors, 'bufferViews': views,
                   'materials': [{'name': m, 'pbrMetallicRoughness': {'baseColorFactor': [.6, .6, .6, 1], 'metallicFactor': 0}}
                                 for m in materials],
                   'buffers': [{'byteLength': len(data), 'uri': 'data:application/octet-stream;base64,' +
                                base64.b64encode(data).decode()}]}, out)


def shares(name):
    """Of each label, what part of the picture shows it."""
    text = open('%s/%s.pov' % (name, name), encoding='utf-8').read()
    camera = re.search(r'^camera \{\n(.*?)^\}', text, re.S | re.M).group(1)

    def vector(word):
        return np.array([float(c) for c in re.search(word + r' <([^>]*)>', camera).group(1).split(',')])
    eye, target, angle = vector('location'), vector('look_at'), float(re.search(r'angle ([0-9.]+)', camera).group(1))
    ahead = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross((0, 1, 0), ahead)
    right /= np.linalg.norm(right)
    up, half = np.cross(ahead, right), math.tan(math.radians(angle) / 2)
    y, x = np.mgrid[:H, :W]
    rays = (ahead + ((2 * (x + .5) / W - 1) * half)[..., None] * right +
            ((1 - 2 * (y + .5) / H) * half * .75)[..., None] * up).reshape(-1, 3)
    nearest, seen = np.full(len(rays), np.inf), np.full(len(rays), -1)
    labels = []
    for k, (_, _, label, corners) in enumerate(ROOMS[name].parts):
        labels.append(label)
        p, q, _, r = (c * (1, 1, -1) for c in corners)
        a, b = q - p, r - p
        n = np.cross(a, b)
        with np.errstate(divide='ignore', invalid='ignore'):
            t = (p - eye) @ n / (rays @ n)
            at = eye + t[:, None] * rays - p
            u, v = at @ a / (a @ a), at @ b / (b @ b)
        hit = (t > 1e-9) & (t < nearest) & (u >= 0) & (u <= 1) & (v >= 0) & (v <= 1)
        nearest[hit], seen[hit] = t[hit], k
    counts = {}
    for k in seen:
        if k >= 0 and labels[k]:
            counts[labels[k]] = counts.get(labels[k], 0) + 1
    return {label: 100 * n / len(rays) for label, n in counts.items()}


def judge(name):
    listed = {}
    for line in sys.stdin:
        m = re.match(r' *([0-9.]+)%  (.*)\toffered by the scene', line)
        if m:
            listed[m.group(2)] = float(m.group(1))
    of = shares(name)
    expected = {'Floor': of.get('floor', 0), 'Wall': max([s for label, s in of.items() if label.startswith('wall')] or [0])}
    wrong = ['%s %.1f %% instead of %.1f' % (what, listed.get(what, 0), share) for what, share in expected.items()
             if abs(listed.get(what, 0) - share) > .5]
    print('; '.join(wrong) or 'as expected')


if len(sys.argv) == 1:
    for of_name, of_room in ROOMS.items():
        gltf(of_name, of_room)
else:
    judge(sys.argv[2])
