#!/usr/bin/env python3
"""Asks POV-Ray for colours of pigments at random points, as data for unit/test_scene_pigments.c:

    tests/lib/povray_pigments.py >tests/data/pigments.txt

A line is `pigment BODY`, what stands between the braces, or `R G B FILTER TRANSMIT X Y Z`, its colour at a point."""
import random
import re
import subprocess
import tempfile

COLOURS = 'png "tests/data/colours.png"'
X, Y, Z = (f'gradient {a} color_map {{ [0 rgb 0] [1 rgb <1,.7,.2>] }}' for a in 'xyz')
# A body, and how far from 0 its points go.
PIGMENTS = [
    (f'gradient x pigment_map {{ [.2 {Y}] [.6 {Z} scale .5] [.6 rgbft <.1,.2,.3,.4,.5>] [1 {X}] }}', 2),
    (f'gradient x pigment_map {{ [0 {Y} rotate 20*z] [1 {Z}] }} scale 4 rotate 30*y', 5),
    (f'checker pigment {{ {X} }} pigment {{ checker rgb 1, rgbt <.2,.3,.4,.5> scale .3 }} scale 1.5', 4),
    (f'average pigment_map {{ [1 {X}] [2.5 {Y} scale 3] [{Z}] }} scale <1,2,3>', 3),
    (f'gradient y triangle_wave frequency 2 pigment_map {{ [.3 average pigment_map {{ [{X}] [{Z}] }}] [1 rgbf .5] }}', 2),
    (f'image_map {{ {COLOURS} }}', 2),
    (f'image_map {{ {COLOURS} interpolate 2 }} scale 2', 3),
    (f'image_map {{ {COLOURS} interpolate 3 }}', 1.5),
    (f'image_map {{ {COLOURS} interpolate 4 once filter all .2 }}', 1.2),
    (f'image_map {{ {COLOURS} map_type 1 interpolate 2 }}', 2),
    (f'image_map {{ {COLOURS} map_type 2 once transmit all .3 }}', 2),
    (f'image_map {{ {COLOURS} map_type 5 interpolate 4 }}', 2),
    (f'image_map {{ {COLOURS} gamma 1 }}', 2),
    (f'image_map {{ {COLOURS} gamma 1.5 interpolate 2 }}', 2),
    (f'image_map {{ {COLOURS} gamma srgb interpolate 3 }} scale 3', 2),
    ('image_map { png "tests/data/colours-alpha.png" }', 2),
    ('image_map { png "tests/data/palette.png" filter 1, .25 transmit 2, .5 transmit 3, 1 filter 3, .1 }', 2),
    ('image_map { png "tests/data/palette.png" filter 1, .25 transmit 2, .5 filter all .125 }', 2),
    ('image_map { png "tests/data/palette.png" transmit 1, .25 transmit 2, .5 interpolate 2 }', 2),
    ('image_map { png "tests/data/palette.png" filter all .125 filter 1, .25 transmit 2, .5 }', 2),
    (f'gradient x pigment_map {{ [0 image_map {{ {COLOURS} interpolate 2 }} scale .4] [1 {Y}] }}', 2),
]


def main():
    rng = random.Random(28)
    lines = ['#version 3.7;', 'global_settings { assumed_gamma 1 }', 'camera { location -z look_at 0 }']
    asked = []
    for body, reach in PIGMENTS:
        points = [[round(rng.uniform(-reach, reach), 4) for _ in range(3)] for _ in range(16)]
        lines.append(f'#declare F = function {{ pigment {{ {body} }} }}')
        for p in points:
            lines.append('#declare C = F({},{},{});'.format(*p))
            lines.append('#debug concat("@",' + '," ",'.join(
                f'str(C.{c},0,9)' for c in ('red', 'green', 'blue', 'filter', 'transmit')) + ',"\\n")')
        lines.append('#undef F')
        asked.append((body, points))
    with tempfile.NamedTemporaryFile('w', suffix='.pov') as scene:
        scene.write('\n'.join(lines) + '\n')
        scene.flush()
        run = subprocess.run(['povray', f'+I{scene.name}', '+W8', '+H8', '-D', '-F'], capture_output=True, text=True)
    if run.returncode:
        raise SystemExit(run.stderr[-1000:])
    answers = iter(re.findall(r'^@(.*)$', run.stderr, re.M))
    for body, points in asked:
        print('pigment', body)
        for p in points:
            print(next(answers), *p)


main()
