"""The scenes of make bench-scale: scenes.py triangles|lights|points COUNT OUT.pov

All are the same room: floor, walls, ceiling, a table and twelve bumpy balls on the floor, whose meshes together have as
many triangles as wanted (else 100,000), each written out: nothing is an instance. It is lit by one lamp, or by COUNT
small balls (lights) or light sources (points) with as much power in all. Everything it declares can be a target.
"""
import sys

import numpy as np

BALLS, PLAIN_TRIANGLES = 12, 100_000
UNITS = 1_000_000  # coordinates of meshes are whole numbers, fastest to read, in a millionth of the box about a ball
LAMP = 12.0        # radiance of the lamp; its area is 1.6 x 1.0

ROOM = """#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1.6, -2.4> right x*16/9 up y angle 78 look_at <0, 1.0, 1> }
#macro Matt(Colour) texture { pigment { rgb Colour } finish { diffuse 1 ambient 0 } } #end
#macro Side(A, B, C, D)
  mesh2 { vertex_vectors { 4, A, B, C, D } uv_vectors { 4, <0,0>, <1,0>, <1,1>, <0,1> }
    face_indices { 2, <0,1,2>, <0,2,3> } texture { pigment { uv_mapping checker rgb 0.8 rgb 0.5 scale 0.1 }
      finish { diffuse 1 ambient 0 } } }
#end
#declare Floor = object { Side(<-3,0,-2.5>, <3,0,-2.5>, <3,0,2.5>, <-3,0,2.5>) }
#declare Back = object { Side(<-3,0,2.5>, <3,0,2.5>, <3,2.8,2.5>, <-3,2.8,2.5>) }
#declare Left = object { Side(<-3,0,-2.5>, <-3,0,2.5>, <-3,2.8,2.5>, <-3,2.8,-2.5>) }
#declare Right = object { Side(<3,0,-2.5>, <3,0,2.5>, <3,2.8,2.5>, <3,2.8,-2.5>) }
#declare Ceiling = object { Side(<-3,2.8,-2.5>, <3,2.8,-2.5>, <3,2.8,2.5>, <-3,2.8,2.5>) }
#declare Front = object { Side(<-3,0,-2.5>, <3,0,-2.5>, <3,2.8,-2.5>, <-3,2.8,-2.5>) }
#declare Table = box { <-0.9, 0.7, -0.4>, <0.9, 0.76, 0.4> Matt(<0.45, 0.3, 0.2>) }
#declare Ball = Matt(<0.6, 0.6, 0.55>)
object { Floor } object { Back } object { Left } object { Right } object { Ceiling } object { Front } object { Table }
"""


def ball(columns, rows, phase):
    """Points in 0..UNITS and faces of a sphere with bumps; the first and last row lie at the poles, a little apart."""
    u, v = np.meshgrid(np.arange(columns) / columns * 2 * np.pi, np.linspace(0.01, np.pi - 0.01, rows + 1))
    radius = 0.85 + 0.1 * np.sin(5 * u + phase) * np.sin(v) * np.sin(7 * v) + 0.04 * np.sin(v) * np.sin(17 * u + 23 * v)
    points = np.stack([radius * np.cos(u) * np.sin(v), radius * np.cos(v), radius * np.sin(u) * np.sin(v)], -1)
    a = np.arange(rows)[:, None] * columns + np.arange(columns)
    b = np.arange(rows)[:, None] * columns + (np.arange(columns) + 1) % columns
    faces = np.stack([a, b, b + columns, a, b + columns, a + columns], -1).reshape(-1, 3)
    return np.rint((points.reshape(-1, 3) / 2 + 0.5) * UNITS).astype(int), faces


def write_list(out, word, rows):
    out.write(f"{word} {{ {len(rows)}")
    for part in np.array_split(rows, len(rows) // 100_000 + 1):
        out.write(("\n,<%d,%d,%d>" * len(part)) % tuple(part.ravel().tolist()))
    out.write(" }\n")


def balls(out, count):
    count = max(count - 30, 12 * BALLS) / BALLS    # the room has some
    columns = round(count ** 0.5)
    rows = max(round(count / 2 / columns), 2)
    for k in range(BALLS):
        points, faces = ball(columns, rows, k)
        out.write("mesh2 {\n")
        write_list(out, "vertex_vectors", points)
        write_list(out, "face_indices", faces)
        x, z = k % 4 * 1.3 - 1.95, k // 4 * 1.1 - 0.6
        out.write(f"texture {{ Ball }} translate -{UNITS // 2} scale {0.9 / UNITS:.9g} translate <{x}, 0.42, {z}> }}\n")


def lamp(out):
    out.write("mesh2 { vertex_vectors { 4, <-0.8,2.75,-0.3>, <0.8,2.75,-0.3>, <0.8,2.75,0.7>, <-0.8,2.75,0.7> }\n"
              "face_indices { 2, <0,1,2>, <0,2,3> }\n"
              f"texture {{ pigment {{ rgb 1 }} finish {{ diffuse 0 ambient 0 emission {LAMP} }} }} }}\n")


def lights(out, count, points):
    """Below the ceiling, wherever a fixed sequence puts them."""
    random = np.random.default_rng(1)
    radius = 0.008
    radiance = LAMP * 1.6 / (4 * np.pi * radius ** 2) / count
    out.write("#declare Lit = texture { pigment { rgb 1 } finish { diffuse 0 ambient 0 "
              f"emission {radiance:.6g} }} }}\n")
    for x, y, z in random.uniform((-2.9, 2.3, -2.4), (2.9, 2.75, 2.4), (count, 3)):
        at = f"<{x:.4f}, {y:.4f}, {z:.4f}>"
        out.write(f"light_source {{ {at} rgb {4 / count:.6g} fade_distance 1 fade_power 2 }}\n" if points else
                  f"sphere {{ {at}, {radius} texture {{ Lit }} }}\n")


def main(kind, count, path):
    count = int(count)
    with open(path, "w", encoding="ascii") as out:
        out.write(ROOM)
        balls(out, count if kind == "triangles" else PLAIN_TRIANGLES)
        lamp(out) if kind == "triangles" else lights(out, count, kind == "points")


main(*sys.argv[1:])
