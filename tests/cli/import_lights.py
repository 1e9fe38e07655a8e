"""For import_lights.t. Without arguments: writes models of a white matte plane under a camera that looks down from a height
of 4, each with lights of one kind, and expected.txt: the radiance of the plane's middle, by closed forms. With a name and a
picture: compares the middle of the picture with it, or with that of another picture."""
import json
import math
import struct
import sys

import OpenImageIO as oiio

HEIGHT = 2  # of the lights above the plane
DOWN = [-.5**.5, 0, 0, .5**.5]  # -z becomes -y
UP = [.5**.5, 0, 0, .5**.5]


def model(nodes, lights=(), camera=None, yfov=.1):
    positions = [(-9, 0, 9), (9, 0, 9), (9, 0, -9), (-9, 0, -9)]
    buffer = b''.join(struct.pack('<3f', *p) for p in positions) + struct.pack('<6H', 0, 1, 2, 0, 2, 3)
    eye = {'camera': 0, 'name': 'eye', 'translation': [0, 4, 0], 'rotation': DOWN, **(camera or {})}
    nodes = [{'mesh': 0, 'name': 'plane'}, eye] + nodes
    return {
        'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': list(range(len(nodes)))}], 'nodes': nodes,
        'cameras': [{'type': 'perspective', 'perspective': {'yfov': yfov, 'aspectRatio': 1, 'znear': .1}}],
        'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'indices': 1, 'material': 0}]}],
        'materials': [{'name': 'white', 'pbrMetallicRoughness': {'metallicFactor': 0},
                       'extensions': {'KHR_materials_specular': {'specularColorFactor': [0, 0, 0]}}}],
        'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 4, 'type': 'VEC3', 'min': [-9, 0, -9],
                       'max': [9, 0, 9]},
                      {'bufferView': 1, 'componentType': 5123, 'count': 6, 'type': 'SCALAR'}],
        'bufferViews': [{'buffer': 0, 'byteLength': 48}, {'buffer': 0, 'byteOffset': 48, 'byteLength': 12}],
        'buffers': [{'uri': 'plane.bin', 'byteLength': len(buffer)}],
        'extensionsUsed': ['KHR_lights_punctual', 'KHR_materials_specular'],
        'extensions': {'KHR_lights_punctual': {'lights': list(lights)}}}, buffer


def lamp(name, x=0, light=0, extras=None, rotation=DOWN):
    node = {'name': name, 'translation': [x, HEIGHT, 0], 'rotation': rotation}
    if light is not None:
        node['extensions'] = {'KHR_lights_punctual': {'light': light}}
    if extras:
        node['extras'] = {'retex': extras}
    return node


def of_intensity(i, x=0):
    """Radiance of a white surface below a small light."""
    squared = HEIGHT**2 + x**2
    return i / squared * HEIGHT / math.sqrt(squared) / math.pi


def look_up(model):
    """From below the area light to the ceiling; a lamp, also below, lights both planes."""
    nodes = model['nodes']
    nodes[1].update(translation=[0, .5, 0], rotation=UP)
    nodes.append({'name': 'lamp', 'translation': [.5, 1, 0], 'extensions': {'KHR_lights_punctual': {'light': 0}}})
    model['scenes'][0]['nodes'].append(len(nodes) - 1)


def falloff(constant, linear, quadratic):
    """The same plane and camera in Collada, and a lamp whose light is divided by c + l d + q d^2."""
    return '''<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>Y_UP</up_axis></asset>
<library_lights><light id="l"><technique_common><point><color>1 1 1</color>
<constant_attenuation>%g</constant_attenuation><linear_attenuation>%g</linear_attenuation>
<quadratic_attenuation>%g</quadratic_attenuation></point></technique_common></light></library_lights>
<library_cameras><camera id="c"><optics><technique_common><perspective><yfov>6</yfov><aspect_ratio>1</aspect_ratio>
<znear>.1</znear><zfar>9</zfar></perspective></technique_common></optics></camera></library_cameras>
<library_effects><effect id="e"><profile_COMMON><technique sid="t"><phong><diffuse><color>.5 .5 .5 1</color></diffuse>
<specular><color>0 0 0 1</color></specular></phong></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="12">-9 0 9 9 0 9 9 0 -9 -9 0 -9</float_array><technique_common>
<accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="2" material="w"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2 0 2 3</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="S">
<node id="plane"><instance_geometry url="#g"><bind_material><technique_common><instance_material symbol="w" target="#m"/>
</technique_common></bind_material></instance_geometry></node>
<node id="lamp"><translate>0 2 0</translate><instance_light url="#l"/></node>
<node id="eye"><translate>0 4 0</translate><rotate>1 0 0 -90</rotate><instance_camera url="#c"/></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#S"/></scene></COLLADA>
''' % (constant, linear, quadratic)


def write_all():
    point, sun = {'type': 'point', 'intensity': 20}, {'type': 'directional', 'intensity': 3}
    spot = {'type': 'spot', 'intensity': 20, 'spot': {'innerConeAngle': 0, 'outerConeAngle': .8}}
    slant = math.cos(math.atan(1 / HEIGHT))
    inner, outer = math.cos(.2), math.cos(.8)
    t = (slant - outer) / (inner - outer)
    square = {'size': [.02, .04], 'radiance': [1000, 1000, 1000]}
    ceiling = {'mesh': 0, 'name': 'ceiling', 'translation': [0, 3, 0]}
    models = {
        'shared': ([lamp('a', 1), lamp('b', -1)], [point], 2 * of_intensity(20, 1)),
        'ball': ([lamp('a', extras={'radius': .1})], [point], of_intensity(20)),
        'watts': ([lamp('a', extras={'intensity': [7, 7, 7]})], [point], of_intensity(7)),
        'spot': ([lamp('a', 1, extras={'inner': .2, 'tightness': 1})], [spot],
                 of_intensity(20, 1) * slant * t * t * (3 - 2 * t)),
        'sun': ([lamp('a', extras={'angle': .05})], [sun], 3 / math.pi),
        'area': ([lamp('a', light=None, extras=square)], [], of_intensity(1000 * .02 * .04)),
        'ellipse': ([lamp('a', light=None, extras={**square, 'shape': 'ellipse'})], [],
                    of_intensity(1000 * .02 * .04 * math.pi / 4)),
        'away': ([lamp('a', light=None, extras=square, rotation=UP)], [], 0),
        'behind': ([ceiling, lamp('b', light=None, extras={'size': [4, 4], 'radiance': [0, 0, 0]})], [point], 0),
        'empty': ([ceiling], [point], 0),
    }
    with open('expected.txt', 'w') as out:
        for name, (nodes, lights, radiance) in models.items():
            text, buffer = model(nodes, lights)
            if nodes[:1] == [ceiling]:
                look_up(text)
            json.dump(text, open(name + '.gltf', 'w'))
            open('plane.bin', 'wb').write(buffer)
            print(name, radiance, file=out)
        for name, c, l, q in (('even', 1.25, 0, 0), ('squared', 0, 0, .5), ('shifted', 1.5, 0, .25),
                              ('slow', .5, .75, 0)):
            open(name + '.dae', 'w').write(falloff(c, l, q))
            print(name, .5 / (c + l * HEIGHT + q * HEIGHT**2), file=out)
    lens = {'extras': {'retex': {'shift': [.25, -.5], 'lens_radius': .05, 'focus_distance': 3}}}
    json.dump(model([lamp('a')], [point], lens, .6)[0], open('lens.gltf', 'w'))


def middle(file, part):
    source = oiio.ImageInput.open(file)
    index = 0
    while source.seek_subimage(index, 0):
        spec = source.spec()
        if spec.getattribute('name') == part or part is None:
            pixels = source.read_image(index, 0, 0, 3, 'float')
            return pixels[8:24, 8:24].mean((0, 1))
        index += 1


def compare(name, file, other=None):
    expected = {line.split()[0]: float(line.split()[1]) for line in open('expected.txt')}[name]
    if other:
        expected = float(middle(other, None)[1])
    found = float(middle(file, None)[1])
    print(name, 'as expected' if abs(found - expected) <= .005 * expected + 1e-6 else f'{found} instead of {expected}')


if len(sys.argv) == 1:
    write_all()
elif sys.argv[1] == 'position':
    print(*(f'{x:.2f}' for x in middle(sys.argv[2], 'position')))
else:
    compare(*sys.argv[1:])
