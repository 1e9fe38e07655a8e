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
    ('brick rgb .2, rgb <.9,.5,.3>', 20),
    ('brick pigment { brick rgb 0, rgb 1 scale .1 } pigment { rgb .7 } brick_size <2,1,1.5> mortar .2', 4),
    ('hexagon rgb 0, rgb .5, rgb 1', 6),
    ('square rgb 0, rgb .3, rgb .6, rgb 1', 5),
    ('triangular rgb 0, rgb .2, rgb .4, rgb .6, rgb .8, rgb 1', 5),
    ('spiral1 3', 4),
    ('spiral1 -2 ramp_wave frequency 2 scale .7', 4),
    ('mandel 30 color_map { [0 rgb 0] [1 rgb 1] }', 2),
    ('mandel 30 exponent 3 exterior 2,.7', 2),
    ('mandel 25 exponent 5 exterior 6,.2 interior 1,.5', 2),
    ('julia <-.4,.6>, 40 interior 6,.3 exterior 0,.5', 1.5),
    ('julia <-.4,.6>, 40 interior 3,.3 exterior 4,.5', 1.5),
    ('julia <-.4,.3>, 40 exponent 4 interior 5,2 exterior 5,.3', 1.5),
    ('magnet 1 mandel 30', 3),
    ('magnet 2 mandel 30 interior 1,.5 exterior 3,.3', 3),
    ('magnet 1 julia <1.2,.3>, 30 interior 1,.5 exterior 6,.3', 3),
    ('magnet 2 julia <1.2,.3>, 30 interior 2,.5', 3),
    ('density_file df3 "tests/data/density.df3"', 1),
    ('density_file df3 "tests/data/density.df3" interpolate 1 translate -.5', .6),
    ('density_file df3 "tests/data/density.df3" interpolate 2 translate -.5', .6),
    ('density_file df3 "tests/data/density16.df3" interpolate 1 translate -.5', .6),
    ('function { x*x - y + sin(z) }', 3),
    ('function { x + y } triangle_wave frequency 2 color_map { [.2 rgb <1,.5,0>] [.8 rgb <0,.2,1>] } scale .7', 3),
    ('object { union { sphere { 0, 1 } box { -2, <0,.5,.3> } } rgb <1,.2,.1>, rgb <.1,.2,1> }', 2.5),
    ('pigment_pattern { checker rgb <1,.2,0>, rgb <.3,.1,.8> rotate 20*y } color_map { [0 rgb 0] [1 rgb 1] }', 3),
    ('pigment_pattern { function { x } scale 2 } frequency 3', 3),
    (f'image_pattern {{ {COLOURS} interpolate 2 }}', 2),
    ('image_pattern { png "tests/data/colours-alpha.png" use_alpha }', 2),
    ('image_pattern { png "tests/data/colours-alpha.png" }', 2),
    (f'image_map {{ {COLOURS} interpolate 2 }} turbulence .3', 2),
    (f'gradient x pigment_map {{ [0 image_map {{ {COLOURS} interpolate 2 }} scale .4] [1 {Y}] }}', 2),
    *[(f'hexagon rgb 0, rgb .5, rgb 1 scale {scale}', 6) for scale in (.3, .5, .7, 1.1)], # few points are near a corner
    ('image_map { function 5,4 { x*.9 + y*.05 } }', 2),
    ('image_map { function 7,3 { pattern { bozo scale .2 } } interpolate 2 }', 2),
    ('image_map { function 6,5 { pigment { gradient x color_map { [0 rgbft <.9,.1,.2,.3,.4>] [1 rgb <0,1,.5>] } } } '
     'interpolate 3 }', 2),
    ('image_map { function 5,4 { pigment { checker rgb <1,.2,.3>, rgb <.2,.3,.4> scale .3 } } filter all .3 once }', 1),
    (f'image_map {{ {COLOURS} repeat <2,3> }}', 2),
    (f'image_map {{ {COLOURS} offset <.3,.2> once }}', 1.2),
    (f'image_map {{ {COLOURS} offset <.5,0> once }} translate -.75', .8),
    (f'image_map {{ {COLOURS} repeat <3,.5> offset <.1,.2> interpolate 2 map_type 1 }}', 2),
    (f'image_map {{ {COLOURS} once map_type 2 offset <0,.4> }}', 2),
    ('image_pattern { function 4,5 { x*y } interpolate 2 }', 2),
    ('image_pattern { function 4,5 { pigment { gradient x color_map { [0 rgbt <1,0,0,.25>] [1 rgb y] } } } use_alpha }',
     2),
    *[(f'image_map {{ {COLOURS} once interpolate {kind} filter all .2 }} translate -.5', .55) for kind in (2, 3, 4)],
    *[(f'image_map {{ png "tests/data/colours-alpha.png" {kind} }} translate -.5', .55)
      for kind in ('interpolate 2', 'once interpolate 2', 'interpolate 3', 'once interpolate 3', 'interpolate 4')],
    (f'image_map {{ {COLOURS} once interpolate 2 map_type 1 }}', 2),
    (f'image_map {{ {COLOURS} once interpolate 3 map_type 2 }} scale <1,2,1>', 2),
    (f'image_map {{ {COLOURS} once interpolate 3 repeat <2,3> offset <.3,.2> }} translate -.5', .6),
    ('image_pattern { png "tests/data/colours-alpha.png" use_alpha interpolate 2 once } translate -.5', .6),
    (f'image_pattern {{ {COLOURS} use_alpha once map_type 2 }}', 1.5),
    (f'image_pattern {{ {COLOURS} once interpolate 4 }} translate -.5', .6),
    ('density_file df3 "tests/data/density.df3" translate -.5', .55),
    ('density_file df3 "tests/data/density.df3" interpolate 2 translate -.5', .53),
    ('density_file df3 "tests/data/density16.df3" interpolate 2 translate -.5', .55),
    ('pigment_pattern { checker rgb <1,.2,0>, rgb <.3,.1,.8> scale .4 turbulence .2 }', 3),
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
