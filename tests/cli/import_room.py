"""For import_room.t. Without arguments: writes rooms and other models of boxes. `view NAME MODEL`: where the camera of the
scene NAME/NAME.pov is, and what it sees of MODEL's boxes, by a ray tracer of its own; prints what is wrong. `cut NAME MODEL`:
whether what stands before the rooms is left out, and nothing else. `bounds NAME`: the size of all that is placed in the
scene."""
import base64
import json
import math
import re
import struct
import sys

import numpy as np

# Boxes from corner to corner, in metres, y up; z towards the viewer, as models have it. A room's are seen from inside.
SHELL = [('Walls', (0, 0, 0), (5, 2.6, 4))]
FURNITURE = [('Table', (3, 0, 1), (4.2, .75, 2)), ('Sofa', (.1, 0, .1), (2.2, .8, 1)),
             ('Cupboard', (4.4, 0, 3), (4.9, 1.9, 3.9)), ('Stool', (2.3, 0, 2.4), (2.7, .45, 2.8))]
ELL = [('Walls', (0, 0, 0), (6, 2.5, 2.8)), ('Walls', (0, 0, 2.8), (2.8, 2.5, 6))]
ELL_FURNITURE = [('Bed', (4, 0, .1), (5.9, .5, 1.7)), ('Desk', (.1, 0, 4.8), (1.5, .74, 5.9)),
                 ('Chair', (1.6, 0, 4.6), (2.1, .5, 5.1))]
MODELS = {
    'room': dict(inside=SHELL, boxes=FURNITURE),
    'ell': dict(inside=ELL, boxes=ELL_FURNITURE, between=[(0, 1)]),
    # hollow walls, .2 thick, around the room
    'thick': dict(inside=SHELL, boxes=[('Outside', (-.2, -.005, -.2), (5.2, 2.8, 4.2))] + FURNITURE),
    'plane': dict(inside=[], boxes=[('Ground', (-5, -.1, -5), (5, 0, 5)), ('Vase', (-.2, 0, -.2), (.2, .5, .2))]),
    'solid': dict(inside=[], boxes=[('Block', (0, 0, 0), (3, 2.6, 3))]),
    # a stove in centimetres, with boards within
    'hull': dict(inside=[], boxes=[('Hull', (0, 0, 0), (90, 82, 80)), ('Board', (10, .5, 10), (40, 20, 30)),
                                   ('Board', (60, .5, 50), (80, 30, 70))]),
    'shelves': dict(inside=[], boxes=[('Board', (0, y, 0), (1, y + .02, .4)) for y in (0, .5, 1, 1.5, 2)] +
                    [('Side', (x, 0, 0), (x + .02, 2, .4)) for x in (0, .98)] + [('Back', (0, 0, -.02), (1, 2, 0))]),
    # nowhere are .4 m free on all sides
    'passage': dict(inside=[('Walls', (0, 0, 0), (.6, 2.6, 5))], boxes=[]),
    'two_walls': dict(inside=[], boxes=[('Base', (0, -.1, 0), (4, 0, 4)), ('Left', (0, 0, 0), (.1, 2.5, 4)),
                                        ('Front', (.1, 0, 3.9), (4, 2.5, 4)), ('Table', (1, 0, 1), (2, .75, 2))]),
}


def quads(model, window=False):
    """Faces as (material, four corners), counter-clockwise from where they are seen."""
    faces = []

    def box(name, low, high, inwards, without=()):
        for axis in range(3):
            for side in (0, 1):
                if (axis, side) in without:
                    continue
                u, v = (axis + 1) % 3, (axis + 2) % 3
                corners = []
                for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    p = [0, 0, 0]
                    p[axis] = (low, high)[side][axis]
                    p[u], p[v] = (low, high)[a][u], (low, high)[b][v]
                    corners.append(tuple(p))
                if (side == 0) != inwards:
                    corners.reverse()
                faces.append((('Floor' if (axis, side) == (1, 0) else name) if inwards else name, corners))
    for i, (name, low, high) in enumerate(model['inside']):
        open_sides = {(2, 1)} if i == 0 and model.get('between') else {(2, 0)} if i == 1 else set()
        box(name, low, high, True, open_sides | ({(0, 0)} if window and i == 0 else set()))
    if model.get('between'):  # the part of the wall that is beside the opening
        faces.append(('Walls', [(2.8, 0, 2.8), (2.8, 2.5, 2.8), (6, 2.5, 2.8), (6, 0, 2.8)]))
    if window:
        low, high = model['inside'][0][1:]
        x, h, z = low[0], high[1], high[2]
        for y0, y1, z0, z1 in ((0, .9, 0, z), (2, h, 0, z), (.9, 2, 0, 1), (.9, 2, 3, z)):
            faces.append(('Walls', [(x, y0, z1), (x, y0, z0), (x, y1, z0), (x, y1, z1)]))
        if window == 'glass':
            faces.append(('Pane', [(x, .9, 3), (x, .9, 1), (x, 2, 1), (x, 2, 3)]))
    for name, low, high in model['boxes']:
        box(name, low, high, False)
    return faces


def obj(name, faces, scale=1.0, z_up=False, turned=False):
    lines, material = ['# a room'], None
    for i, (what, corners) in enumerate(faces):
        for x, y, z in corners[::-1] if turned else corners:
            lines.append('v %.9g %.9g %.9g' % tuple(scale * c for c in ((x, -z, y) if z_up else (x, y, z))))
        if what != material:
            lines.append('usemtl ' + what)
            material = what
        lines.append('f %d %d %d %d' % tuple(range(4 * i + 1, 4 * i + 5)))
    with open(name, 'w') as out:
        out.write('\n'.join(lines) + '\n')


def gltf(name, faces, scale=1.0, emission=(), camera=None, place=(2, 1.2, 3.5), instances=1, apart=0.0):
    names = sorted({what for what, _ in faces})
    data, views, accessors, primitives = b'', [], [], []
    for material, what in enumerate(names):
        points = [tuple(scale * c for c in p) for n, q in faces if n == what for p in q]
        indices = [4 * k + j for k in range(len(points) // 4) for j in (0, 1, 2, 0, 2, 3)]
        for part, kind, count, of in ((b''.join(struct.pack('<3f', *p) for p in points), 5126, len(points), 'VEC3'),
                                      (struct.pack('<%dH' % len(indices), *indices), 5123, len(indices), 'SCALAR')):
            views.append({'buffer': 0, 'byteOffset': len(data), 'byteLength': len(part)})
            accessor = {'bufferView': len(views) - 1, 'componentType': kind, 'count': count, 'type': of}
            if of == 'VEC3':
                accessor['min'] = [min(p[k] for p in points) for k in range(3)]
                accessor['max'] = [max(p[k] for p in points) for k in range(3)]
            accessors.append(accessor)
            data += part + b'\0' * (-len(part) % 4)
        primitives.append({'attributes': {'POSITION': len(accessors) - 2}, 'indices': len(accessors) - 1,
                           'material': material})
    materials = []
    for what in names:
        m = {'name': what, 'pbrMetallicRoughness': {'baseColorFactor': [.6, .6, .6, 1], 'metallicFactor': 0}}
        if what == 'Pane':
            m['extensions'] = {'KHR_materials_transmission': {'transmissionFactor': 1}}
            m['pbrMetallicRoughness']['roughnessFactor'] = 0
        if what in emission:
            m['emissiveFactor'] = [1, 1, 1]
            m['extensions'] = {'KHR_materials_emissive_strength': {'emissiveStrength': 20}}
        materials.append(m)
    used = sorted({e for m in materials for e in m.get('extensions', ())})
    scene = {'asset': {'version': '2.0'}, 'extensionsUsed': used, 'scene': 0, 'scenes': [{'nodes': list(range(instances))}],
             'nodes': [{'mesh': 0, 'translation': [i * apart, 0, 0]} for i in range(instances)], 'meshes': [{'primitives': primitives}],
             'materials': materials, 'accessors': accessors, 'bufferViews': views,
             'buffers': [{'byteLength': len(data),
                          'uri': 'data:application/octet-stream;base64,' + base64.b64encode(data).decode()}]}
    if camera:
        scene['cameras'] = [{'type': 'perspective', 'perspective': {'yfov': .6, 'aspectRatio': 4 / 3, 'znear': .1}}]
        scene['nodes'].append({'camera': 0, 'name': camera, 'translation': list(place)})
        scene['scenes'][0]['nodes'].append(instances)
    with open(name, 'w') as out:
        json.dump(scene, out)


def write_models():
    for name, model in MODELS.items():
        obj(name + '.obj', quads(model), turned=False)
    room = MODELS['room']
    faces = quads(room)
    obj('room_cm.obj', faces, 100)
    obj('room_in.obj', faces, 1 / .0254)
    obj('room_high.obj', faces, 4)
    obj('room_z.obj', faces, z_up=True)
    obj('room_mm_z.obj', faces, 1000, z_up=True)
    obj('turned.obj', faces, turned=True)
    # on one wall hang shelves, and there is no ceiling
    shelves = quads(dict(inside=SHELL, boxes=[('Shelves', (.5, .5, 0), (3, 2.4, .9))]))
    obj('lidless.obj', [(n, q) for n, q in shelves if {p[1] for p in q} != {2.6}])
    # each face again, the other way round; and of another material
    obj('doubled.obj', faces + [(n, q[:1] + q[:0:-1]) for n, q in faces])
    obj('back_sides.obj', faces + [('Back', q[:1] + q[:0:-1]) for n, q in faces])
    gltf('dark.gltf', faces)
    gltf('twice.gltf', faces, instances=2)
    gltf('window.gltf', quads(room, True))
    gltf('glass.gltf', quads(room, 'glass'))
    gltf('two_panes.gltf', quads(room, 'glass') + [(n, q[:1] + q[:0:-1]) for n, q in quads(room, 'glass') if n == 'Pane'])
    gltf('shared.gltf', faces, instances=2, apart=20)
    for name, zs in ('panes_before', (4.1, 4.2, -.1)), ('panes_behind', (4.1, -.2, -.1)):
        gltf(name + '.gltf', faces + [('Pane', [(1, 1, z), (2, 1, z), (2, 2, z), (1, 2, z)]) for z in zs])
    lamp = [('Lamp', [(2, 2.59, 1), (3, 2.59, 1), (3, 2.59, 2), (2, 2.59, 2)])]
    gltf('lamp.gltf', faces + lamp, emission=('Lamp',))
    # within a tray, where it lights nothing
    tray = quads(dict(inside=[], boxes=[('Tray', (3.1, .75, 1.2), (4.1, .81, 1.8))]))
    hidden = [('Lamp', [(3.2, .78, 1.25), (4, .78, 1.25), (4, .78, 1.75), (3.2, .78, 1.75)])]
    gltf('hidden.gltf', faces + tray + hidden, emission=('Lamp',))
    gltf('camera.gltf', faces, camera='inside')
    gltf('blind.gltf', faces, camera='eye', place=(3.6, 1.2, .05))  # a wall is before it
    gltf('behind.gltf', faces, camera='eye', place=(2.5, 1.2, 9))  # outside of a closed room
    gltf('cm.gltf', faces, 100)
    gltf('toy.gltf', faces, 3)


# ---- the view ----


def read_camera(name):
    text = open('%s/%s.pov' % (name, name)).read()
    camera = re.search(r'^camera \{\n(.*?)^\}', text, re.S | re.M).group(1)

    def vector(word):
        return np.array([float(c) for c in re.search(word + r' <([^>]*)>', camera).group(1).split(',')])
    return vector('location'), vector('look_at'), float(re.search(r'angle ([0-9.]+)', camera).group(1))


def cross(low, high, eye, direction):
    """Where a ray enters a box, and leaves it; or None."""
    near, far = -math.inf, math.inf
    for k in range(3):
        d = direction[k] if direction[k] else 1e-12
        a, b = sorted(((low[k] - eye[k]) / d, (high[k] - eye[k]) / d))
        near, far = max(near, a), min(far, b)
    return (near, far) if near < far else None


def first_hit(model, eye, direction):
    """What is seen, and how far away. Out of one part of a room one comes into the next where they touch."""
    best = (math.inf, 'nothing')
    for name, low, high in model['boxes']:
        hit = cross(low, high, eye, direction)
        if hit and hit[0] > 0:
            best = min(best, (hit[0], name))
    end = 0.0
    for _ in model['inside']:
        for _, low, high in model['inside']:
            hit = cross(low, high, eye, direction)
            if hit and hit[0] <= end + 1e-9 < hit[1]:
                end = hit[1]
    if 0 < end < best[0]:
        best = (end, 'Floor' if abs(eye[1] + end * direction[1]) < 1e-6 else 'Walls')
    return best


def judge_view(name, model):
    eye, target, angle = read_camera(name)
    eye[2], target[2] = -eye[2], -target[2]  # to the model's right-handed space
    wrong = []
    if abs(eye[1] - 1.5) > .01:
        wrong.append('the eye is %g above the floor' % eye[1])
    if not any(all(low[k] < eye[k] < high[k] for k in range(3)) for _, low, high in model['inside']):
        wrong.append('the eye is out of the room')
    for what, low, high in model['boxes']:
        if all(low[k] - .15 < eye[k] < high[k] + .15 for k in (0, 2)):
            wrong.append('the eye is above or in the ' + what)
    near = min(first_hit(model, eye, np.array([math.cos(a), 0, math.sin(a)]))[0]
               for a in np.arange(64) * math.pi / 32)
    if near < .3:
        wrong.append('something is %g beside the eye' % near)
    if not 65 <= angle <= 75:
        wrong.append('the angle is %g' % angle)
    ahead = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(ahead, (0, 1, 0))
    right /= np.linalg.norm(right)
    up = np.cross(right, ahead)
    half = math.tan(math.radians(angle / 2))
    seen, distances = {}, []
    for j in range(30):
        for i in range(40):
            direction = ahead + half * ((i + .5) / 20 - 1) * right + .75 * half * (1 - (j + .5) / 15) * up
            distance, what = first_hit(model, eye, direction / np.linalg.norm(direction))
            seen[what] = seen.get(what, 0) + 1 / 1200
            distances.append(distance)
    furniture = sum(share for what, share in seen.items() if what not in ('Floor', 'Walls', 'nothing'))
    things = sum(share > .005 for what, share in seen.items() if what not in ('Floor', 'Walls', 'nothing'))
    if furniture < .05 or things < min(2, len(model['boxes'])):
        wrong.append('%g of the picture is furniture, %d pieces' % (furniture, things))
    if seen.get('Floor', 0) < .08:
        wrong.append('%g of the picture is floor' % seen.get('Floor', 0))
    if np.median(distances) < 1.5:
        wrong.append('half of the picture is nearer than %g' % np.median(distances))
    print('; '.join(wrong) or 'a view')


def placed(name):
    """Of each object of a scene its material and triangles, as an array (n, 3 corners, 3)."""
    meshes, objects = {}, []
    mesh = r'#declare (\w+) = mesh2 \{\s*vertex_vectors \{ \d+,(.*?)\}.*?face_indices \{ \d+,(.*?)\}'
    for of, text, faces in re.findall(mesh, open('%s/%s-meshes.inc' % (name, name)).read(), re.S):
        vertices = np.array([[float(c) for c in v.split(',')] for v in re.findall('<([^>]*)>', text)])
        meshes[of] = vertices[[[int(c) for c in f.split(',')] for f in re.findall('<([^>]*)>', faces)]]
    for of, what, transform in re.findall(r'^object \{ (\w+) \w+ \{ (\w+) \}(.*?) \} //',
                                          open('%s/%s.pov' % (name, name)).read(), re.M):
        points = meshes[of]
        for word, numbers in re.findall(r'(matrix|scale|translate) <?([-0-9., e]+)>?', transform):
            n = np.array([float(c) for c in numbers.split(',')])
            points = (points @ n.reshape(4, 3)[:3] + n.reshape(4, 3)[3] if word == 'matrix' else
                      points * n if word == 'scale' else points + n)
        objects.append((what, points))
    return objects


def bounds(name):
    points = np.concatenate([points for _, points in placed(name)]).reshape(-1, 3)
    print('%.4g x %.4g x %.4g' % tuple(points.max(0) - points.min(0)))


def judge_cut(name, model):
    """Of walls and ceilings those whose front the camera sees are there, of what is around those whose back it sees, and
    all of what stands in the room."""
    eye, wrong = read_camera(name)[0], []
    objects = placed(name)
    if not all(high[1] < eye[1] for _, _, high in model['inside']):
        wrong.append('the eye is %g above the floor' % eye[1])
    for i, (what, corners) in enumerate(quads(model)):
        corners = np.array(corners, float) * (1, 1, -1)
        normal = -np.cross(corners[1] - corners[0], corners[2] - corners[0])
        area, normal = np.linalg.norm(normal), normal / np.linalg.norm(normal)
        is_front = normal @ (eye - corners[0]) > 0
        is_to_be = not is_front if what == 'Outside' else is_front or what not in ('Walls', 'Floor')
        triangles = np.concatenate([points for of, points in objects if of == what] or [np.empty((0, 3, 3))])
        middles = triangles.mean(1)
        on = (abs((triangles - corners[0]) @ normal).max(1) < 1e-4) & \
             ((middles > corners.min(0) - 1e-4) & (middles < corners.max(0) + 1e-4)).all(1)
        edges = triangles[on][:, 1:] - triangles[on][:, :1]
        there = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1).sum() / 2
        if abs(there - (area if is_to_be else 0)) > 1e-3 * area:
            wrong.append('%g of face %d (%s) is there' % (there / area, i, what))
    print('; '.join(wrong) or 'cut')


if len(sys.argv) == 1:
    write_models()
elif sys.argv[1] == 'view':
    judge_view(sys.argv[2], MODELS[sys.argv[3]])
elif sys.argv[1] == 'cut':
    judge_cut(sys.argv[2], MODELS[sys.argv[3]])
else:
    bounds(sys.argv[2])
