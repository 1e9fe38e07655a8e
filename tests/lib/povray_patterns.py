#!/usr/bin/env python3
"""Asks POV-Ray for values of patterns, as data for unit/test_pattern_values.c:

    tests/lib/povray_patterns.py >tests/data/patterns.txt

A line `= TEXT` is what stands in `function { pattern { TEXT } }`, a line `~ TEXT` in `function { pigment { TEXT } }`. The
lines after it are points and the value there, or of a pigment red, green and blue."""
import random
import re
import subprocess
import tempfile

WARPS = '''planar
planar <1,1,0>, .3
cubic
spherical
spherical dist_exp 1
spherical orientation y
spherical orientation <1,2,-3>
cylindrical
cylindrical orientation x dist_exp .7
toroidal
toroidal dist_exp 1 major_radius 2 orientation <1,2,3>
repeat x
repeat -.7*x flip <1,1,0> offset <.1,.2,.3>
repeat 2*z flip <1,0,1> offset <.1,.2,.3>
repeat .5*y
black_hole <.2,.3,-.5>, 2
black_hole <.2,.3,-.5>, 2 inverse falloff 1
black_hole <.2,.3,-.5>, 2 strength 3 falloff 1
black_hole <.2,.3,-.5>, 2 strength 3 falloff 1 inverse
black_hole <.2,.3,.5>, .5 repeat <1,1,1>
black_hole <.5,.5,.5>, .5 repeat <1,.2,0>
black_hole <.5,.5,.5>, .5 repeat <2,2,2> turbulence <.1,.2,.3>
turbulence <1,.2,.3> octaves 4 lambda 2.5 omega .8'''.split('\n')
PATTERNS = '''bozo
spotted
bumps
dents
granite
wrinkles
agate
agate agate_turb .3 turbulence .2
marble
marble turbulence .4 octaves 4 lambda 2.2 omega .6
marble turbulence y
wood
wood turbulence <.4,.5,.6> octaves 4 lambda 2.2 omega .6
wood turbulence z
wood warp { turbulence .3 }
crackle
crackle solid
crackle form x
crackle form <.3,.2,.5>
crackle form <-.5,0,1> frequency 2
crackle form <3,0,0>
crackle metric 1
crackle metric 3
crackle metric .5
crackle metric 1.5 form x
crackle offset .5
crackle metric 1 offset .3
crackle metric 3 offset .3
crackle turbulence .3 scale .4'''.split('\n')
GEOMETRIC = '''leopard
leopard frequency 3 turbulence .7
onion
onion frequency 3 phase .3
radial
radial frequency 6
spherical
spherical poly_wave 2.3
planar
cylindrical
cylindrical scallop_wave frequency .7
boxed
boxed cubic_wave
cubic
ripples
ripples frequency 2 phase .3
ripples sine_wave turbulence .2
waves
waves frequency 2 phase .3
quilted
quilted control0 .3 control1 .8
cells
cells scale .3 translate .1
gradient <1,2,3> triangle_wave
bozo turbulence .5 scale 2
bozo scale 2 turbulence .5
bozo turbulence .3 octaves 3 lambda 3.1 omega .7
bozo scale 2 warp { turbulence .5 }
bozo warp { turbulence .5 } scale 2
bozo warp { turbulence .5 } scale 2 turbulence .3
bozo turbulence .3 warp { turbulence .5 } scale 2
bozo warp { turbulence .3 } warp { turbulence .5 } scale 2
bozo frequency -2 phase .2
bozo frequency 0 phase .2
bozo translate <.1,.2,.3> scale 2 warp { spherical } rotate <10,20,30> warp { repeat x } turbulence .2 scale .4
spiral1 1
spiral1 3 frequency 2
spiral2 2
spiral2 5 ramp_wave phase .3'''.split('\n')
PIGMENTS = '''agate
bozo
granite
marble
wood
radial
crackle
gradient x turbulence .5 pigment_map { [0 bozo] [1 rgb .5] }
checker pigment { bozo } pigment { wood scale .3 } turbulence .3'''.split('\n')
# Every pattern alone: its colours, and its wave, are POV-Ray's defaults. The files are in tests/data.
PIGMENTS += [p + ' translate <.017,.031,.013>' for p in '''boxed
brick
bumps
cells
checker
cubic
cylindrical
density_file df3 "tests/data/density.df3"
dents
function { x*y }
gradient y
hexagon
image_pattern { png "tests/data/colours.png" }
julia <.3,.5>, 20
leopard
magnet 1 mandel 20
mandel 20
object { sphere { 0, 2 } }
onion
pigment_pattern { wood }
planar
quilted
ripples
spherical
spiral1 3
spiral2 3
spotted
square
tiling 9
triangular
waves
wrinkles'''.split('\n')]
PIGMENTS += [f'tiling {n} scale .4 translate <.123,0,.077>' for n in range(1, 25)]
PIGMENTS += [f'tiling 22 scale {s} translate <.123,0,.077>' for s in (.07, .13, .17, .23, .31)]
PIGMENTS += [f'pavement number_of_sides 4 number_of_tiles {tiles} pattern {k} exterior {(k + 1) % 3} '
             f'interior {k // 3 % 3} form {(k + tiles) % 4} scale .4 translate <.123,0,.077>'
             for tiles, count in ((1, 1), (2, 1), (3, 2), (4, 5), (5, 12), (6, 35)) for k in range(1, count + 1)]
PIGMENTS += [f'pavement number_of_sides {sides} number_of_tiles {tiles} pattern {k} exterior {(k + 1) % 3} '
             f'interior {(k + tiles) % 3} form {(k // 2 + tiles) % 4} scale .4 translate <.123,0,.077>'
             for sides, counts in ((3, (1, 1, 1, 3, 4, 12)), (6, (1, 1, 3, 7, 22)))
             for tiles, count in enumerate(counts, 1) for k in range(1, count + 1)]
PIGMENTS += [f'pavement number_of_sides {sides} number_of_tiles 5 pattern 4 exterior {n % 3} interior {n // 3 % 3} '
             f'form {n // 9}' for sides in (3, 6) for n in range(0, 36, 5)]
PIGMENTS += [f'tiling {n} scale {s} translate <.123,0,.077>' for n in (26, 27) for s in (.01, .03, .1, .2, .3, .4, .5)]
PIGMENTS += [f'tiling 25 scale {s} translate <.123,0,.077>' for s in
             (1e-5, 1e-4, .001, *(n / 200 for n in range(2, 41)), .3, .4, .5)]

# What ends at a distance of 1, so large that the points are within it.
ENDING = [p + ' scale 4.5' for p in ('spherical', 'spherical poly_wave 2.3', 'cylindrical', 'boxed', 'boxed cubic_wave',
                                     'cylindrical scallop_wave frequency .7', 'planar frequency 3 triangle_wave')]
ENDING += ['cylindrical scale 4 turbulence .3', 'boxed rotate <20,30,40> scale <3,4,5>', 'crackle form <3,0,0> scale .2']


def main():
    rng = random.Random(11)
    names = ['= ' + p for p in PATTERNS] + [f'= {p} noise_generator {g}' for p in PATTERNS[:-14] for g in (1, 3)]
    names += ['= ' + p for p in GEOMETRIC] + [f'= bozo warp {{ {w} }}' for w in WARPS] + ['~ ' + p for p in PIGMENTS]
    names += ['= ' + p for p in ENDING]
    lines = ['#version 3.7; global_settings { assumed_gamma 1 } camera { location -z look_at 0 }']
    points = {}
    for i, name in enumerate(names):
        kind = 'pattern' if name[0] == '=' else 'pigment'
        lines.append(f'#declare F{i} = function {{ {kind} {{ {name[2:]} }} }}')
        points[i] = [[round(rng.uniform(-3, 3), 3) for _ in range(3)] for _ in range(10)] + [[0, 0, 0], [1, -2, 0]]
        for k, p in enumerate(points[i]):
            call = f'F{i}({p[0]},{p[1]},{p[2]})'
            value = f'str({call},0,15)' if kind == 'pattern' else '," ",'.join(
                f'str({call}.{c},0,15)' for c in ('red', 'green', 'blue'))
            lines.append(f'#debug concat("@{i} {k} ",{value},"\\n")')
    with tempfile.NamedTemporaryFile('w', suffix='.pov') as scene:
        scene.write('\n'.join(lines) + '\n')
        scene.flush()
        command = ['povray', f'+I{scene.name}', '+W8', '+H8', '-D', '-F']
        run = subprocess.run(command, capture_output=True, text=True, errors='replace')
    if run.returncode:
        raise SystemExit(run.stderr[-1000:])
    answers = {(int(m[1]), int(m[2])): m[3] for m in re.finditer(r'@(\d+) (\d+) (\S[^\n]*)', run.stderr)}
    for i, name in enumerate(names):
        print(name)
        for k, p in enumerate(points[i]):
            if 'nan' not in answers[i, k]:
                print(*p, answers[i, k])


main()
