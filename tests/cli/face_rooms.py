"""Scenes for target_faces.t, target_names.t and target_forms.t: each as a person finds it, of which one image covers
all, and NAME-right.pov, in which what is pointed at there is an object of its own, of one colour, with UV that are right
by construction."""

import math

HEAD = """#version 3.7; global_settings { assumed_gamma 1 }
camera { location <%g,%g,%g> look_at <%g,%g,%g> angle 65 }
light_source { <-1,2.4,-1.2> rgb .5 area_light x, z, 3, 3 jitter adaptive 1 fade_distance 2 fade_power 2 }
#declare Atlas = texture { pigment { image_map { ppm "atlas.ppm" } } uv_mapping }
"""
COLOURS = [(184, 150, 110), (200, 200, 190), (90, 120, 160), (150, 80, 60)]  # 4 fields of the atlas, side by side


def linear(byte):
    value = byte / 255
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def field(k):
    """A place of the atlas within that field, away from its neighbours."""
    return ((k + 0.5) / 4, 0.5)


class Mesh:
    def __init__(self):
        self.points, self.uv, self.faces = [], [], []

    def add(self, corners, uv):
        """A polygon, as a fan of triangles."""
        first = len(self.points)
        self.points += corners
        self.uv += uv
        self.faces += [(first, first + k, first + k + 1) for k in range(1, len(corners) - 1)]

    def text(self, texture):
        def vectors(list_of):
            return ", ".join("<" + ",".join(f"{x:.9f}" for x in v) + ">" for v in list_of)

        faces = ", ".join("<%d,%d,%d>" % f for f in self.faces)
        return (
            f"mesh2 {{ vertex_vectors {{ {len(self.points)}, {vectors(self.points)} }}\n"
            f" uv_vectors {{ {len(self.uv)}, {vectors(self.uv)} }}\n"
            f" face_indices {{ {len(self.faces)}, {faces} }} {texture} }}\n"
        )


def colour(k):
    rgb = ",".join(f"{linear(c):.9f}" for c in COLOURS[k])
    return f"#declare Right = texture {{ pigment {{ rgb <{rgb}> }} uv_mapping }} "


def build(name, camera, polygons, apart):
    """polygons: (corners, field of the atlas, UV that are right or None). apart: what has these is a mesh by itself."""
    whole, part, rest, right, chosen = Mesh(), Mesh(), Mesh(), Mesh(), None
    for corners, k, uv in polygons:
        (part if apart and uv else whole).add(corners, [field(k)] * len(corners))
        if uv:
            right.add(corners, uv)
            chosen = k
        else:
            rest.add(corners, [field(k)] * len(corners))
    with open(name + ".pov", "w", encoding="utf-8") as out:
        out.write(HEAD % camera + whole.text("texture { Atlas }") + (part.text("texture { Atlas }") if apart else ""))
    with open(name + "-right.pov", "w", encoding="utf-8") as out:
        out.write(HEAD % camera + rest.text("texture { Atlas }") + colour(chosen) + right.text("texture { Right }"))


def room():
    """Floor, walls and a plinth: 5 by 4 by 2.6, all with the atlas. The floor is four strips with corners in between."""
    x0, x1, z0, z1, h = -2.5, 2.5, -2, 2, 2.6
    polygons = []
    for k in range(4):
        a, b = x0 + 1.25 * k, x0 + 1.25 * (k + 1)
        corners = [(a, 0, z0), (a, 0, z1), (b, 0, z1), (b, 0, z0)]
        polygons.append((corners, 0, [(x - x0, z - z0) for x, _, z in corners]))
    for (ax, az), (bx, bz) in [((x0, z1), (x1, z1)), ((x0, z0), (x0, z1)), ((x1, z1), (x1, z0)), ((x1, z0), (x0, z0))]:
        polygons.append(([(ax, 0, az), (bx, 0, bz), (bx, h, bz), (ax, h, az)], 1, None))
    polygons.append(([(x0, h, z0), (x1, h, z0), (x1, h, z1), (x0, h, z1)], 1, None))
    for corners in sides((0.3, 0, 0.5), (0.9, 0.7, 0.6), 0):
        polygons.append((corners[0], 2, None))
    return polygons


def sides(place, size, degrees):
    """The six sides of a turned box, and UV of each as it is seen from outside: from its lower left corner."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))

    def at(x, y, z):
        x, y, z = x * size[0], y * size[1], z * size[2]
        return (place[0] + c * x - s * z, place[1] + y, place[2] + s * x + c * z)

    w, h, d = size
    corners = [
        [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)],  # as seen from the front: from the lower left on
        [(1, 0, 0), (1, 0, 1), (1, 1, 1), (1, 1, 0)],
        [(1, 0, 1), (0, 0, 1), (0, 1, 1), (1, 1, 1)],
        [(0, 0, 1), (0, 0, 0), (0, 1, 0), (0, 1, 1)],
        [(0, 1, 0), (1, 1, 0), (1, 1, 1), (0, 1, 1)],
        [(0, 0, 1), (1, 0, 1), (1, 0, 0), (0, 0, 0)],
    ]
    lengths = [(w, h), (d, h), (w, h), (d, h), (w, d), (w, d)]
    return [
        ([at(*p) for p in four], [(0, 0), (a, 0), (a, b), (0, b)]) for four, (a, b) in zip(corners, lengths)
    ]


def walls():
    return [(corners, k, None) for corners, k, _ in room() if k < 2]


def crate():
    return walls() + [(corners, 3, uv) for corners, uv in sides((-0.6, 0, 0.2), (1.2, 0.8, 0.7), 30)]


def pillar():
    """A drum of 96 sides, u around it from the back on, clockwise as seen from above from behind: as one walks round it."""
    n, r, h, x, z = 96, 0.5, 1.2, 0.2, 0.7
    polygons = walls()

    def at(k, y):
        angle = 2 * math.pi * k / n
        return (x - r * math.sin(angle), y, z + r * math.cos(angle))

    for k in range(n):
        u0, u1 = 2 * math.pi * r * k / n, 2 * math.pi * r * (k + 1) / n
        polygons.append(
            ([at(k, 0), at(k + 1, 0), at(k + 1, h), at(k, h)], 3, [(u0, 0), (u1, 0), (u1, h), (u0, h)])
        )
    top = [at(k, h) for k in range(n)]
    polygons.append((top, 3, [(px - (x - r), pz - (z - r)) for px, _, pz in top]))
    return polygons


def boards():
    """Ten boxes of one height are a floor, and one is higher; around them walls with the same texture."""
    with open("boards.pov", "w", encoding="utf-8") as out:
        out.write(HEAD % (0, 1.4, -1.9, 0, 0.4, 1) + "#default { texture { pigment { rgb .6 } } }\n")
        for k in range(10):
            out.write(f"box {{ <{-2.5 + 0.5 * k},-.1,-2>, <{-2 + 0.5 * k},0,2> }}\n")
        out.write("box { <.5,0,.8>, <1.2,.4,1.4> }\nbox { <-2.5,0,2>, <2.5,2.6,2.1> }\n")


with open("atlas.ppm", "wb") as atlas:
    width = 64
    atlas.write(b"P6 %d 16 255\n" % width + b"".join(bytes(COLOURS[4 * x // width]) for x in range(width)) * 16)
build("room", (0, 1.4, -1.9, 0, 0.5, 1), room(), False)
build("crate", (-0.4, 1.5, -1.9, 0, 0.4, 0.6), crate(), True)
build("pillar", (-0.4, 1.5, -1.9, 0.1, 0.6, 0.6), pillar(), True)
boards()
