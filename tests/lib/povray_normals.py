#!/usr/bin/env python3
"""Asks POV-Ray for normals that `normal` statements perturb, as data for unit/test_normal.c:

    tests/lib/povray_normals.py >tests/data/normals.txt

A line `normal STATEMENT` is followed by lines `at X Y Z NORMAL PERTURBED`: a point, the normal of the shape there and
what POV-Ray makes of it. Each statement is on a sphere of its own. Six parallel lights along the axes, seen in two
pictures of 16 bits, give the normals; points that POV-Ray would see from behind are left out.

povray_normals.py STATEMENT prints the lines of one statement."""
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

STATEMENTS = '''
bumps .5
bumps 1.2 scale .3
bumps .5 scale <.2,.6,1> rotate <10,20,30> translate <.1,.2,.3>
bumps .5 scale <.2,.6,1> no_bump_scale
bumps .5 turbulence .4 scale .5
bumps .5 scale .3 turbulence .3 rotate 30*x scale <1,2,1>
bumps .5 scale .3 warp { turbulence .3 octaves 3 } scale <2,1,1> rotate 20*z
gradient x .5 warp { repeat .5*y flip x } scale .4 rotate 30*z
dents .8 scale .4
dents 1.5 scale .2 noise_generator 1
wrinkles .5 scale .7
ripples .4 frequency 6 phase .3
ripples .3 scale .2
waves .4 frequency 5 phase .2
waves .3 scale .15 turbulence .2
quilted .7 scale .5
quilted 1 control0 .3 control1 .7 scale .4
facets size .4
facets coords .6 size .3
facets size .5 metric 3
bozo .5 scale .4
granite .4 scale 1.5
granite .3 accuracy .01
agate .4
marble .5 turbulence .3 scale .4
wood .5 scale .3
crackle .6 scale .4
leopard .5 scale .2
onion .5 scale .3
gradient x, .4 scale .5
gradient x+y, .4 sine_wave frequency 3
gradient y .6 slope_map { [0 <0,1>] [.3 <.5,.2>] [.6 <.5,0>] [1 <0,-1>] } scale .5
gradient y .6 triangle_wave slope_map { [0 <0,1>] [1 <1,0>] } scale .5
radial .8 frequency 8 sine_wave
spherical 1 scale 3
checker .5 scale .6
brick .6 scale .15
hexagon .5 scale .3
checker normal { bumps .6 scale .2 } normal { gradient x .5 scale .2 } scale .7
brick normal { bumps .6 scale .5 } normal { granite .3 scale 3 } scale .15
gradient x normal_map { [0 bumps .7 scale .2] [.5 bumps .1 scale .2] [1 dents 1 scale .1] } scale .8
bumps normal_map { [.3 gradient x .5 scale .2] [.7 gradient y .5 scale .2] } scale .5
average normal_map { [1 bumps .7 scale .2] [2 gradient x .5 scale .3] }
average normal_map { [1 bumps .7 scale .2] [.5 wrinkles 1] } rotate 40*y scale <1,.5,1>
average turbulence .2 normal_map { [1 bumps .7 scale .2] [.5 wrinkles 1] }
gradient x no_bump_scale normal_map { [0 bumps .7 scale .2] [1 dents .7 scale .3] } scale .6
slope y .5
slope { <1,1,0> 0 .7 } .5 scale .5
aoi .8
bump_map { png "bumps.png" bump_size 3 } scale 2
bump_map { png "bumps.png" map_type 1 interpolate 2 bump_size 5 }
bump_map { png "bumps.png" map_type 2 interpolate 4 bump_size 5 }
bump_map { png "bumps.png" map_type 5 bump_size 5 interpolate 2 }
bump_map { png "bumps.png" once interpolate 3 } bump_size 4 scale .8
bump_map { png "index.png" use_index bump_size .3 }
bump_map { function 9,7 { y*y*y*.5 + x*x*.4 } bump_size 5 interpolate 2 }
bump_map { png "index.png" use_color bump_size 2 interpolate 2 }
uv_mapping bump_map { png "bumps.png" bump_size 3 interpolate 2 }
uv_mapping bumps .5 scale .1
bumps 0.4 bump_size .9 scale .2
bumps -.6 scale .3
square .5 scale .4
triangular .5 scale .4
cubic .5 scale .5
cells .4 scale .3
boxed 1 scale 3
planar .8 scale 2
cylindrical .9 scale 3
mandel 20 .5 scale .7
spotted .6 scale .3
hexagon normal { bumps .5 scale .1 } normal { bumps .1 } normal { dents 1 scale .2 } scale .4
function { sin(x*5)*.5+.5 } .5
spiral1 3 .4 scale .5
image_pattern { png "bumps.png" } .3 scale 2
slope y normal_map { [.3 bumps .5 scale .2] [.7 dents .8 scale .1] }
slope { <1,1,-1>, .3, .8 } sine_wave normal_map { [0 bumps .5 scale .3] [1 gradient x .5 scale .2] } rotate 30*x
slope { y altitude y } normal_map { [0 bumps .5 scale .3] [1 gradient x .5 scale .2] } scale 2
aoi normal_map { [.1 bumps .5 scale .2] [.6 gradient y .8 scale .1] }
average normal_map { [1 slope y normal_map { [.3 bumps .5 scale .2] [.7 dents .8 scale .1] }] [1 bumps .3] }
checker normal { aoi normal_map { [.1 bumps .5 scale .2] [.6 gradient y .8 scale .1] } } normal { bumps .2 } scale .7
pigment_pattern { slope y color_map { [0 rgb 0] [1 rgb 1] } } normal_map { [.3 bumps .5 scale .2] [.7 dents .8 scale .1] }
aoi .8 scallop_wave frequency 3 scale .2
bump_map { png "bumps.png" interpolate 3 bump_size 5 } rotate 25*y scale <1.2,.9,1>
bump_map { png "bumps.png" once interpolate 3 bump_size 8 } translate <-.5,-.4,0> scale 2 translate <12.21,40.7,0>
spherical 1 scale 1.8 translate <16.5,40.5,-1>
boxed 1 scale 1.6 translate <20.2,40.6,-.8>
planar .8 scale 2 rotate 50*x translate <24.42,40.7,-1>
cylindrical .9 scale <1.7,1,1.5> translate <28.6,40.7,-.9>
mandel 20 .5 scale .7 translate <0,44.77,0>
julia <-.4,.6> 15 .5 scale .7 translate <4.07,44.77,0>
'''.strip().split('\n')
RADIUS, STEP, CELL = 1.5, 4.07, 32   # of spheres; between them; pixels of each
COLUMNS = 8
DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), '../data')


def read_png16(path):
    with open(path, 'rb') as file:
        data = file.read()
    at, body = 8, b''
    while at < len(data):
        length, name = struct.unpack('>I4s', data[at:at + 8])
        if name == b'IHDR':
            width, height, depth, kind = struct.unpack('>IIBB', data[at + 8:at + 18])
            assert depth == 16 and kind == 2
        if name == b'IDAT':
            body += data[at + 8:at + 8 + length]
        at += length + 12
    body = zlib.decompress(body)
    stride, rows, before = width * 6, [], bytearray(width * 6)
    for y in range(height):
        kind, row = body[y * (stride + 1)], bytearray(body[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            a, b, c = (row[i - 6] if i >= 6 else 0), before[i], (before[i - 6] if i >= 6 else 0)
            p = a + b - c
            paeth = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            row[i] = (row[i] + [0, a, b, (a + b) // 2, paeth][kind]) & 255
        rows.append(struct.unpack(f'>{width * 3}H', row))
        before = row
    return rows


def picture(folder, statements, sign, nrows):
    lights = ''.join(f'light_source {{ {sign}1e7*{c} rgb {c} parallel point_at 0 shadowless }}\n' for c in 'xyz')
    spheres = ''
    for k, statement in enumerate(statements):
        x, y = k % COLUMNS * STEP, k // COLUMNS * STEP
        spheres += (f'sphere {{ <{x},{y},0>, {RADIUS} pigment {{ rgb 1 }} finish {{ diffuse 1 ambient 0 }} '
                    f'normal {{ {statement} }} }}\n')
    wide, high = COLUMNS * STEP, nrows * STEP
    with open(os.path.join(folder, 'scene.pov'), 'w', encoding='ascii') as file:
        file.write(f'''#version 3.7; global_settings {{ assumed_gamma 1 }}
camera {{ orthographic location <{wide / 2 - STEP / 2},{high / 2 - STEP / 2},-10> direction z up {high}*y
right {wide}*x }}\n{lights}{spheres}''')
    run = subprocess.run(['povray', '+Iscene.pov', f'+W{COLUMNS * CELL}', f'+H{nrows * CELL}', '-D', '-A', '-J', '+FN16',
                          'File_Gamma=1', '+Q8', '+Oout.png'], cwd=folder, capture_output=True, text=True, check=False)
    if run.returncode:
        raise SystemExit(run.stderr[-1500:])
    return read_png16(os.path.join(folder, 'out.png'))


def main(statements):
    nrows = (len(statements) + COLUMNS - 1) // COLUMNS
    with tempfile.TemporaryDirectory() as folder:
        for name in ('bumps.png', 'index.png'):
            shutil.copy(os.path.join(DATA, name), folder)
        pictures = [picture(folder, statements, sign, nrows) for sign in '+-']
    for k, statement in enumerate(statements):
        print('normal', statement)
        column, row = k % COLUMNS, nrows - 1 - k // COLUMNS # the first row of spheres is the lowest
        for j in range(5, CELL, 4):
            for i in range(3 + j % 3, CELL, 5):
                x, y = ((i + .5) / CELL - .5) * STEP, (.5 - (j + .5) / CELL) * STEP
                rest = RADIUS ** 2 - x * x - y * y
                if rest < .3:
                    continue
                z = -rest ** .5
                px, py = column * CELL + i, row * CELL + j
                n = [(pictures[0][py][px * 3 + c] - pictures[1][py][px * 3 + c]) / 65535 for c in range(3)]
                if n[2] > -.02: # POV-Ray turns normals that are seen from behind
                    continue
                base = [c / RADIUS for c in (x, y, z)]
                at = [x + k % COLUMNS * STEP, y + k // COLUMNS * STEP, z]
                print('at', *(f'{v:.6f}' for v in at), *(f'{v:.6f}' for v in base), *(f'{v:.5f}' for v in n))


if __name__ == '__main__':
    main(sys.argv[1:] or STATEMENTS)
