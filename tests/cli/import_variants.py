"""Writes models into the current folder, for import_variants.t: variants.gltf, three cards of import_models.py with variants,
and for each variant NAME.gltf, which has its materials and knows of no variants."""
import json
import sys

sys.dont_write_bytecode = True
from import_models import gltf, write


def material(name, rough=1, metal=0, **more):
    return {'name': name, 'pbrMetallicRoughness': dict({'roughnessFactor': rough, 'metallicFactor': metal}, **more)}


TURNED = {'index': 0, 'extensions': {'KHR_texture_transform': {'scale': [2, 3], 'rotation': .4, 'offset': [.1, .2]}}}
MATERIALS = [
    material('floor', baseColorFactor=[.3, .5, .2, 1]),
    material('seat', baseColorFactor=[.6, .6, .6, 1]),
    material('red', baseColorFactor=[.7, .05, .05, 1]),
    material('print', baseColorTexture=TURNED, baseColorFactor=[.9, .8, 1, 1]),
    material('wet', rough=.3, baseColorFactor=[.1, .15, .08, 1]),
    material('brass', rough=.4, metal=1, baseColorFactor=[.8, .6, .2, 1]),
    dict(material('glass'), extensions={'KHR_materials_transmission': {'transmissionFactor': 1}}),
]
NAMES = ['Red', 'Print', 'Wet floor', 'Brass', 'Glass', 'As it is', 'Wet red']
FLOOR, SEAT = {2: 4, 6: 4}, {0: 2, 1: 3, 3: 5, 4: 6, 6: 2}  # by variant: the material


def mappings(of):
    return {'KHR_materials_variants': {'mappings': [
        {'material': m, 'variants': [v for v in of if of[v] == m]} for m in sorted(set(of.values()))]}}


def scene(floor=0, seat=1, variants=True):
    half = .5**.5
    made = gltf(MATERIALS[0], nodes=[
        {'mesh': 0, 'name': 'floor', 'rotation': [-half, 0, 0, half], 'translation': [-.6, 0, 1], 'scale': [2.6, 2.4, 1]},
        {'mesh': 1, 'name': 'seat', 'translation': [-.4, .05, -.5]},
        {'mesh': 2, 'name': 'shelf', 'rotation': [0, half, 0, half], 'translation': [1.5, .05, .5]},
        {'camera': 0, 'translation': [.6, .7, 3]}])
    made['materials'] = MATERIALS
    card = made['meshes'][0]['primitives'][0]
    made['meshes'] = [{'name': name, 'primitives': [dict(card, material=m)]}
                      for name, m in (('floor', floor), ('seat', seat), ('shelf', 1))]
    made['extensionsUsed'] = ['KHR_texture_transform', 'KHR_materials_transmission']
    if variants:
        made['extensionsUsed'] += ['KHR_materials_variants']
        made['extensions'] = {'KHR_materials_variants': {'variants': [{'name': name} for name in NAMES]}}
        made['meshes'][0]['primitives'][0]['extensions'] = mappings(FLOOR)
        made['meshes'][1]['primitives'][0]['extensions'] = mappings(SEAT)
    return made


whole = scene()
write('variants.gltf', json.dumps(whole))
for v, name in enumerate(NAMES):
    write(f'{name}.gltf', json.dumps(scene(FLOOR.get(v, 0), SEAT.get(v, 1), False)))
# mappings that lead nowhere, and variants that are none
whole['meshes'][0]['primitives'][0]['extensions'] = {'KHR_materials_variants': {'mappings': [
    {'material': 99, 'variants': [0, 1]}, {'material': 4, 'variants': [-1, 1.5, 'x', 77]}, 7, {'variants': 3}]}}
whole['meshes'][1]['primitives'][0]['extensions'] = {'KHR_materials_variants': {'mappings': {'a': 1}}}
write('astray.gltf', json.dumps(whole))
whole['extensions']['KHR_materials_variants']['variants'] = [{}] * 2000
write('many.gltf', json.dumps(whole))
whole['extensions']['KHR_materials_variants']['variants'] = [{'name': ''}, 5, {'name': 'A'}, {'name': 'A'}]
write('odd.gltf', json.dumps(whole))
# materials that no mesh has, or that meshes have in another order than the file: the strength is the lamp's
lamp = dict(material('lamp', baseColorFactor=[0, 0, 0, 1]), emissiveFactor=[1, 1, 1],
            extensions={'KHR_materials_emissive_strength': {'emissiveStrength': 7}})
order = scene(2, 1, False)
order['materials'] = [material('unused'), lamp, material('wall', baseColorFactor=[.5, .5, .5, 1])]
write('order.gltf', json.dumps(order))
