#!/usr/bin/env python3
"""Asks POV-Ray for values of its internal functions and of user functions, as data for unit/test_functions.c:

    tests/lib/povray_functions.py >tests/data/functions.txt

A line is `internal NUMBER VALUE ARGUMENTS…`, `noise GENERATOR VALUE X Y Z`, `turbulence` with lambda,
omega, octaves, X Y Z and the vector there, or `user VALUE A B BODY`, where BODY is of a function(a, b)."""
import random
import re
import subprocess
import tempfile

# Numbers of parameters after x, y and z.
COUNTS = [5, 5, 5, 5, 2, 2, 5, 4, 2, 1, 4, 1, 1, 1, 1, 6, 6, 3, 1, 4, 3, 6, 1, 1, 10, 7, 7, 1, 1, 6,
          1, 3, 4, 3, 6, 1, 1, 4, 1, 6, 5, 1, 1, 1, 4, 1, 3, 0, 1, 1, 7, 5, 6, 1, 1, 1, 3, 0, 6, 6,
          4, 1, 5, 4, 6, 1, 4, 7, 2, 0, 2, 3, 1, 1, 2, 6, 0, None, 1]
REVOLVED = {0, 1, 2, 3, 15, 21, 34, 39, 50, 67, 75}  # switch, offset, angle at the end
STEEP = (8, 30)  # with the strengths above they are nearly everywhere at their limits, -10 and 10
HETERO_MF, RIDGE, RIDGED_MF, HELIX1, HELIX2, SPIRAL, POLYTUBES, NOISE_GENERATOR = 29, 58, 59, 25, 26, 64, 52, 78
BODIES = [
    'sum(i,1,5,i*a)', 'prod(i,1,4,a+i*b)', 'sum(i,1,3,prod(j,1,i,a+j*b))', 'select(a,b,2,a*b)', 'select(b-.5,a,3*b)',
    'pow(a*a,.75)+pow(b,2)', 'mod(a*7,b)', 'div(a*9,b)', 'int(a*5)+floor(b*5)-ceil(a*3)', 'atan2(a,b)',
    'max(a,b,.2)-min(a,b,-.3)', 'sqrt(abs(a))+exp(-b*b)', 'ln(a*a+1)*log(b*b+2)', 'sinh(a)+cosh(b)-tanh(a*b)',
    'asinh(a)+acosh(1+b*b)+atanh(a*.4)', 'acos(a*.5)+asin(b*.5)+atan(a)', 'degrees(a)-radians(b)',
    '(a>b)+2*(a<=b)+4*(a=b)',
    '(a>0 & b>0)+2*(a>0 | b>0)', '-a+-b*-(a-b)', 'sin(a*3)*cos(b*2)+tan(a*b)', 'a/b-b/(a+4)']


def points(rng):
    for number, count in enumerate(COUNTS):
        for i in range(12 if count is not None else 0):
            reach = 1 if i < 9 else 3
            p = [round(rng.uniform(-reach, reach), 3) for _ in range(3)]
            if i == 11:
                p[0] = p[2] = 0
            a = [round(rng.uniform(.1, 1.5), 3) for _ in range(count)]
            if number in REVOLVED:
                a[-3], a[-1] = i % 2, [0, 0, 30, 75][i % 4]
            if number in (HELIX1, HELIX2, SPIRAL):
                a[5] = [1, 0, .5, 1.4][i % 4]
            if number == HELIX1:
                a[0], a[6] = 1 + i % 3, [0, 30][i // 4 % 2]
            if number == SPIRAL:
                a[2] = 3
            if number == POLYTUBES:
                a[0] = 1 + i
            if number in (HETERO_MF, RIDGED_MF):
                a[1], a[2], a[5] = 2.1, [4, 5, 1, 7][i // 4], i % 4
            if number == HETERO_MF:
                a[2], a[4] = [4, 5.5, 1, 7][i // 4], i % 3
            if number == RIDGE:
                a[1], a[2], a[5] = [4, 5.5, 1, 7][i // 4], .5, i % 4
            if number == NOISE_GENERATOR:
                a[0] = i % 4
            yield number, p + a
    rng = random.Random(8)
    for number in STEEP:
        for _ in range(12):
            p = [round(rng.uniform(-1.5, 1.5), 3) for _ in range(3)]
            yield number, p + [round(rng.uniform(1e-4, 2e-3), 6)] + [round(rng.uniform(.1, 1.5), 3)
                                                                    for _ in range(COUNTS[number] - 1)]


def main():
    rng = random.Random(7)
    questions = []  # what to print for it, expressions, declarations before
    for number, args in points(rng):
        text = ' '.join(map(repr, args))
        questions.append((f'internal {number} {{}} {text}', [f'F({",".join(map(repr, args))})'],
                          f'function {{ internal({number}) }}'))
    for i in range(60):
        generator, reach = 1 + i % 3, [1, 20, 3000, 1e7][i // 15]
        p = [round(rng.uniform(-reach, reach), 3) for _ in range(3)]
        if i % 15 == 0:
            p = [round(c) for c in p]
        args = ','.join(map(repr, p))
        questions.append((f'noise {generator} {{}} {p[0]!r} {p[1]!r} {p[2]!r}', [f'F({args},{generator})'],
                          'function { internal(78) }'))
    for i in range(20):
        a = [round(rng.uniform(.3, 3), 2), round(rng.uniform(.2, .8), 2), [1, 3, 6, 10, 14][i % 5]]
        p = [round(rng.uniform(-9, 9), 3) for _ in range(3)]
        call = 'vturbulence({},{},{},<{},{},{}>)'.format(*a, *p)
        questions.append(('turbulence ' + ' '.join(map(repr, a + p)) + ' {} {} {}',
                          [call + c for c in ('.x', '.y', '.z')], ''))
    for body in BODIES:
        for _ in range(4):
            a, b = round(rng.uniform(-2, 2), 3), round(rng.uniform(-2, 2), 3)
            questions.append((f'user {{}} {a} {b} {body}', [f'F({a},{b})'], f'function(a,b) {{ {body} }}'))
    lines = ['#version 3.7;', 'camera { location -z look_at 0 }']
    for i, (_, expressions, function) in enumerate(questions):
        if function:
            lines.append(f'#declare F = {function}')
        for k, expression in enumerate(expressions):
            lines.append(f'#debug concat("@{i} {k} ",str({expression},0,17),"\\n")')
        if function:
            lines.append('#undef F')
    with tempfile.NamedTemporaryFile('w', suffix='.pov') as scene:
        scene.write('\n'.join(lines) + '\n')
        scene.flush()
        command = ['povray', f'+I{scene.name}', '+W8', '+H8', '-D', '-F']
        run = subprocess.run(command, capture_output=True, text=True)
    if run.returncode:
        raise SystemExit(run.stderr[-1000:])
    answers = {(int(m[1]), int(m[2])): m[3] for m in re.finditer(r'^@(\d+) (\d+) (\S+)', run.stderr, re.M)}
    for i, (text, expressions, _) in enumerate(questions):
        print(text.format(*[answers[i, k] for k in range(len(expressions))]))


main()
