#!/usr/bin/env python3
"""Asks POV-Ray for colours of layers and maps of textures, as data for unit/test_povray_layers.c:

    tests/lib/povray_layers.py >tests/data/layers.txt

A line `scene HEAD`, with the working space, is followed by lines `texture STATEMENTS`, and these by lines `at X Y R G B`:
the colour, scene-linear, at a point of the plane z = 0, which faces -z. The colours are those of a picture in which
surfaces shine by `ambient` alone. Before version 3.7, a dark filter is more opaque; before 3.5, layers do not tint."""
import os
import subprocess
import tempfile
from povray_normals import read_png16

HEADS = ['#version 3.7; global_settings { assumed_gamma 1 }', '#version 3.7; global_settings { assumed_gamma 2.2 }',
         '#version 3.7; global_settings { assumed_gamma srgb }', '#version 3.7;', '#version 3.5;',
         '#version 3.6; global_settings { assumed_gamma 1.5 }', '#version 3.6; global_settings { assumed_gamma 1 }',
         '#version 3.1; global_settings { assumed_gamma 1 }']
TEXTURES = '''
texture { pigment { rgb <.9,.4,.1> } } texture { pigment { rgbt <.1,.3,.8,.6> } }
texture { pigment { rgb <.9,.4,.1> } } texture { pigment { rgbf <.1,.3,.8,.6> } }
texture { pigment { rgb <.9,.4,.1> } } texture { pigment { rgbft <.1,.5,.8,.5,.3> } } texture { pigment { rgbt <1,1,.2,.7> } }
texture { pigment { gradient x color_map { [0 rgb <.9,.4,.1>] [1 rgb .1] } } }
texture { pigment { rgb <.1,.8,.3> } } texture { pigment { gradient x color_map { [0 rgbt <.9,.4,.1,.2>] [1 rgbf <.2,1,1,1>] } } }
texture { gradient x texture_map { [0 pigment { rgb <.9,.4,.1> }] [1 pigment { rgb <.1,.5,.9> } finish { phong .1 }] } }
texture { average texture_map { [1 pigment { rgb <.9,.4,.1> }] [3 pigment { gradient y }] } }
texture { pigment { average pigment_map { [1 rgb <.9,.4,.1>] [3 gradient y] } } }
texture { pigment { image_map { png "colours.png" interpolate 2 } } }
texture { pigment { image_map { png "colours.png" interpolate 3 } } }
texture { pigment { image_map { png "colours.png" interpolate 4 } } }
texture { pigment { rgb .4 } } texture { pigment { rgbf <.1,.3,.2,.9> } } texture { pigment { rgbft <.3,.5,.2,.4,.2> } }
texture { pigment { rgb .4 } } texture { pigment { rgbf <.1,.3,.2,.9> } finish { phong .1 } } texture { pigment { rgbf <.3,.5,.2,.4> } }
texture { material_map { png "palette.png" texture { pigment { rgb <.9,.4,.1> } } texture { pigment { rgb <.1,.5,.9> } finish { phong .1 } } texture { pigment { gradient y } } } }
'''.strip().split('\n')
CELL = 5   # pixels of a texture
DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), '../data')


def decoded(number):
    v = number / 65535
    return v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4


def picture(head):
    count = len(TEXTURES)
    text = [head, '#default { finish { ambient 1 diffuse 0 } }',
            f'camera {{ orthographic location <{count / 2},.5,-5> direction z up y right {count}*x }}']
    for k, texture in enumerate(TEXTURES):
        text.append(f'box {{ <{k},0,0>, <{k + 1},1,1> {texture} }}')
    with tempfile.NamedTemporaryFile('w', suffix='.pov', dir=DATA) as scene:
        scene.write('\n'.join(text) + '\n')
        scene.flush()
        run = subprocess.run(['povray', f'+I{scene.name}', f'+W{count * CELL}', f'+H{CELL}', '-D', '-A', '-J', '+FN16',
                              'File_Gamma=srgb', f'+O{scene.name}.png'], cwd=DATA, capture_output=True, text=True)
        if run.returncode:
            raise SystemExit(run.stderr[-1500:])
        rows = read_png16(scene.name + '.png')
        os.remove(scene.name + '.png')
    return rows


def main():
    for head in HEADS:
        rows = picture(head)
        print('scene', head)
        for k, texture in enumerate(TEXTURES):
            print('texture', texture.strip())
            for j in range(CELL):
                i = 2 * j % CELL
                c = rows[j][3 * (k * CELL + i):][:3]
                print('at', f'{k + (i + .5) / CELL:g} {1 - (j + .5) / CELL:g}', *(f'{decoded(v):.5f}' for v in c))


main()
