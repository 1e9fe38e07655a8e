"""Compares the AOVs roughness and metallic of varying.gltf, of import_models.py, with what is in its image, by the AOV uv.
Prints nothing where they agree."""
import sys

import OpenImageIO as oiio

parts, names = {}, {}
image = oiio.ImageInput.open(sys.argv[1])
while image.seek_subimage(len(parts), 0):
    names[image.spec().getattribute('name')] = [name.split('.')[-1] for name in image.spec().channelnames]
    parts[image.spec().getattribute('name')] = image.read_image('float')
seen = 0
for y, row in enumerate(parts['uv']):
    for x, uv in enumerate(row):
        u, v, known = (float(uv[names['uv'].index(name)]) for name in 'UVA')
        if not (known and .05 < u < .95 and .1 < abs(v - .5) < .4):
            continue
        seen += 1
        roughness, metallic = .75 * (16 * u - .5) * 16 / 255, float(v > .5)
        found = float(parts['roughness'][y][x][0]), float(parts['metallic'][y][x][0])
        if abs(found[0] - roughness) > .002 or abs(found[1] - metallic) > .002:
            print('at %d,%d: %g %g, not %g %g' % (x, y, *found, roughness, metallic))
if seen < 500:
    print('only %d pixels show it' % seen)
