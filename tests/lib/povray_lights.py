#!/usr/bin/env python3
"""Asks POV-Ray how light sources shine on a plane and a sphere, as data for unit/test_lights_povray.c:

    /usr/bin/python3 tests/lib/povray_lights.py >tests/data/lights.txt

A line `scene TEXT` is what stands before the lights, `lights TEXT` one case. After it, each line is x, z and the red,
green and blue of what is seen there from above, along two rows, one of which crosses the sphere and its shadow."""
import os
import subprocess
import sys
import tempfile
import numpy as np
import OpenImageIO as oiio

WIDTH, HEIGHT, ROWS, STEP = 96, 72, (24, 44), 3
SCENE = ('#version 3.7; global_settings { assumed_gamma 1 } camera { orthographic location 10*y direction -10*y '
         'right 8*x up 6*z } #default { finish { ambient 0 diffuse 1 } } plane { y, 0 pigment { rgb 1 } } '
         'sphere { <-1, .9, .8>, .6 pigment { rgb 1 } }')
TO = 'point_at 0 }'
AREA = 'light_source { <1,3,-1>, 1 area_light 2*x, 2*z, '
BOX = 'box { <1,0,.5>, <2,1,1.5> pigment { rgb 1 } } '
INNER = 'light_source { <2,4,2> rgb z } box { <1,0,-1.5>, <2,1,-.5> pigment { rgb 1 } } '
GROUP = 'light_source { <1,4,-1>, rgb x } light_group { light_source { <-2,4,1>, rgb y } ' + BOX
SPOT, CYLINDER = 'light_source { <1,4,-1>, 1 spotlight ', 'light_source { <1,4,-1>, 1 cylinder '
PARALLEL, THROUGH = 'light_source { <1,4,-1>, 1 parallel ', 'light_source { <1,4,-1>, 1 projected_through { '
CASES = [
    'light_source { <1,3,-1>, rgb <1,.8,.6> }', 'light_source { <1,3,-1>, 1 shadowless }',
    SPOT + TO, SPOT + 'radius 20 falloff 35 ' + TO, SPOT + 'radius 12 falloff 40 tightness 10 ' + TO,
    SPOT + 'tightness 30 ' + TO, SPOT + 'radius 0 falloff 30 ' + TO, SPOT + 'radius 80 falloff 110 ' + TO,
    SPOT + 'radius 35 falloff 20 ' + TO, SPOT + 'radius -20 falloff 35 ' + TO,
    SPOT + 'radius 20 falloff 35 point_at 0 rotate 30*y scale <1,1.2,1> translate .5*x }',
    SPOT + 'radius 20 falloff 35 point_at 0 shadowless }', 'light_source { <1,4,-1>, 1 shadowless spotlight ' + TO,
    'light_source { <1,4,-1>, 1 shadowless parallel ' + TO,
    CYLINDER + TO, CYLINDER + 'radius 1 falloff 2 ' + TO, CYLINDER + 'radius .5 falloff 2 tightness 2 ' + TO,
    CYLINDER + 'radius 0 falloff 2 ' + TO, CYLINDER + 'radius 1 falloff 2 fade_distance 2 fade_power 2 ' + TO,
    PARALLEL + TO, PARALLEL + 'fade_distance 2 fade_power 2 ' + TO, PARALLEL + 'spotlight radius 20 falloff 35 ' + TO,
    'light_source { <1,.7,-1>, 1 parallel ' + TO,
    'light_source { <1,3,-1>, 1 fade_distance 2 fade_power 1 }',
    'light_source { <1,3,-1>, 1 fade_distance 2 fade_power 2 }',
    'light_source { <1,3,-1>, 1 fade_distance 4 fade_power 1000 }', 'light_source { <1,3,-1>, 1 fade_power 2 }',
    AREA + '5, 5 }', AREA + '4, 6 }', AREA + '9, 1 }', AREA + '7, 7 circular orient }',
    AREA + '5, 5 fade_distance 1 fade_power 2 }', SPOT + 'area_light x, z, 5, 5 radius 20 falloff 35 ' + TO,
    PARALLEL + 'area_light 2*x, 2*z, 5, 5 ' + TO, CYLINDER + 'radius 1 falloff 3 area_light 2*x, 2*z, 5, 5 ' + TO,
    AREA + '5, 5 area_illumination shadowless }', AREA + '7, 7 circular orient area_illumination shadowless }',
    'light_source { 0, 1 area_light x, z, 5, 5 rotate 30*y scale 2 translate <1,3,-1> }',
    'light_source { <1,3,-1>, 1 looks_like { sphere { 0, .3 no_image finish { emission 0 diffuse 0 } } } }',
    THROUGH + 'box { <-.5,2,-1.5>, <1,2.2,0> } } }', THROUGH + 'box { <-2,1.2,-1.5>, <0,1.3,2> } } }',
    THROUGH + 'box { <-4,.1,-3>, <4,.2,3> } } }',
    THROUGH + 'torus { 1, .3 translate .3*y } } }', THROUGH + 'box { <-.5,2,-1.5>, <1,2.2,0> } } translate x }',
    GROUP + '}', GROUP + 'global_lights on }', GROUP + 'global_lights off }', GROUP + 'translate -x }',
    GROUP + 'light_group { ' + INNER + 'global_lights off } global_lights on }',
    GROUP + 'light_group { ' + INNER + 'global_lights on } }', GROUP + 'light_group { ' + INNER + '} }',
    'light_source { <1,4,-1>, rgb x } union { light_source { <-2,4,1>, rgb y } ' + BOX + '}']


def rendered(text, folder, name):
    scene, picture = os.path.join(folder, name + '.pov'), os.path.join(folder, name + '.exr')
    with open(scene, 'w') as file:
        file.write(text)
    subprocess.run(['povray', scene, f'+W{WIDTH}', f'+H{HEIGHT}', '-D', '-A', '+FE', '+O' + picture, '+WT1'],
                   check=True, capture_output=True)
    return np.asarray(oiio.ImageBuf(picture).get_pixels(oiio.FLOAT))


def main():
    print('scene', SCENE)
    with tempfile.TemporaryDirectory() as folder:
        for k, case in enumerate(CASES):
            print('lights', case)
            pixels = rendered(SCENE + ' ' + case, folder, str(k))  # OpenImageIO keeps pictures by name
            for row in ROWS:
                for column in range(STEP // 2, WIDTH, STEP):
                    x, z = 8 * (column + .5) / WIDTH - 4, 3 - 6 * (row + .5) / HEIGHT
                    print(f'{x:.6g} {z:.6g}', *(f'{v:.4g}' for v in pixels[row, column, :3]))


sys.exit(main())
