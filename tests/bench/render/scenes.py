"""The scenes that two renderers are to render alike: scenes.py FOLDER [ARTISTS_ROOM]

scene.py writes them, beside the textures that both renderers read. The third is made of an artist's scene, which lies
in a folder of its own, and left out without it.
"""
import sys

import numpy as np
import OpenImageIO as oiio

import artists_room
from scene import Scene

TEXTURE, TEXELS = "checker.png", 2048


def write_texture(path):
    """A checker with a ramp; its first row is the lowest."""
    y, x = np.mgrid[0:TEXELS, 0:TEXELS]
    pixels = np.stack([(x // 64 + y // 64) % 2 * 0.6 + 0.2, x / TEXELS, np.full(x.shape, 0.4)], axis=-1)
    pixels = np.ascontiguousarray((pixels[::-1] * 255 + 0.5).astype(np.uint8))
    file = oiio.ImageOutput.create(path)
    if not file or not file.open(path, oiio.ImageSpec(TEXELS, TEXELS, 3, "uint8")) or not file.write_image(pixels):
        sys.exit(f"bench-render: cannot write {path}")
    file.close()


# ---- shapes: u, v to x, y, z, outward where u turns and v rises ----


def ball(radius):
    def point(u, v):
        a, b = 2 * np.pi * u, np.pi * (v - 0.5)
        return radius * np.cos(a) * np.cos(b), radius * np.sin(a) * np.cos(b), radius * np.sin(b)
    return point


def lathe(height, radius):
    """radius: of v, an array."""
    return lambda u, v: (radius(v) * np.cos(2 * np.pi * u), radius(v) * np.sin(2 * np.pi * u), height * v)


def cushion(x, y, z, sharp):
    """A superellipsoid of those half sides; the smaller sharp, the more it is a box."""
    def power(a):
        return np.sign(a) * np.abs(a) ** sharp

    def point(u, v):
        a, b = 2 * np.pi * u, np.pi * (v - 0.5)
        return x * power(np.cos(a)) * power(np.cos(b)), y * power(np.sin(a)) * power(np.cos(b)), z * power(np.sin(b))
    return point


def knot(size, thickness, p, q):
    """A tube about a torus knot."""
    def centre(t):
        r = size * (1 + 0.4 * np.cos(q * t))
        return np.stack([r * np.cos(p * t), r * np.sin(p * t), 0.5 * size * np.sin(q * t)], axis=-1)

    def point(u, v):
        t, e = 2 * np.pi * u, 1e-3
        along = centre(t + e) - centre(t - e)
        out = centre(t + e) - 2 * centre(t) + centre(t - e)
        side = np.cross(along, out)
        side /= np.linalg.norm(side, axis=-1, keepdims=True)
        out = np.cross(side, along)
        out /= np.linalg.norm(out, axis=-1, keepdims=True)
        a = (2 * np.pi * v)[..., None]
        return tuple(np.moveaxis(centre(t) + thickness * (np.cos(a) * out + np.sin(a) * side), -1, 0))
    return point


# ---- the scenes ----


def cornell():
    """A box with a checkered ball and one of glass."""
    s = Scene({"location": (0, -3.9, 0), "direction": (0, 1, 0), "angle": 40},
              light={"centre": (0, 0, 0.98), "x": 0.6, "y": 0.6, "watts": 30, "reflects": 0.73})
    white, red = s.material("White", (0.73, 0.73, 0.73)), s.material("Red", (0.65, 0.05, 0.05))
    green, floor = s.material("Green", (0.12, 0.45, 0.15)), s.material("Floor", texture=TEXTURE)
    glass = s.material("Glass", glass=1.5)
    s.quad(floor, (-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1))
    s.quad(white, (-1, -1, 1), (-1, 1, 1), (1, 1, 1), (1, -1, 1))
    s.quad(white, (-1, 1, -1), (1, 1, -1), (1, 1, 1), (-1, 1, 1))
    s.quad(red, (-1, -1, -1), (-1, 1, -1), (-1, 1, 1), (-1, -1, 1))
    s.quad(green, (1, -1, -1), (1, -1, 1), (1, 1, 1), (1, 1, -1))
    s.surface(floor, 64, 32, ball(0.4), (-0.4, 0.3, -0.6), textured=True)
    s.surface(glass, 64, 32, ball(0.4), (0.4, -0.2, -0.6))
    return s


def chair(s, material, x, y, turn):
    def placed(point, dx, dy, dz):
        c, d = np.cos(turn), np.sin(turn)

        def moved(u, v):
            px, py, pz = point(u, v)
            px, py = px + dx, py + dy
            return x + c * px - d * py, y + d * px + c * py, pz + dz
        return moved
    for dx in (-0.2, 0.2):
        for dy in (-0.2, 0.2):
            s.surface(material, 24, 24, placed(lathe(0.45, lambda v: 0.02 + 0.008 * np.sin(20 * v)), dx, dy, 0))
        s.surface(material, 24, 24, placed(lathe(0.55, lambda v: 0.018 + 0.006 * np.sin(26 * v)), dx, 0.2, 0.45))
    s.surface(material, 48, 24, placed(cushion(0.25, 0.25, 0.04, 0.4), 0, 0, 0.47))
    for k in range(3):
        s.surface(material, 32, 16, placed(cushion(0.22, 0.015, 0.035, 0.5), 0, 0.2, 0.62 + 0.14 * k))


def plant(s, material, x, y, z, random):
    """Leaves that bend, in all directions."""
    for _ in range(600):
        a, rise, length = random.uniform(0, 2 * np.pi), random.uniform(0.2, 1.3), random.uniform(0.25, 0.6)
        base = np.array([x, y, z + random.uniform(0, 0.35)])

        def leaf(u, v, a=a, rise=rise, length=length, base=base):
            far = length * u * np.cos(rise)
            up = length * u * np.sin(rise) - 0.4 * length * u * u
            wide = 0.08 * length * np.sin(np.pi * u) * (2 * v - 1)
            return (base[0] + far * np.cos(a) - wide * np.sin(a), base[1] + far * np.sin(a) + wide * np.cos(a),
                    base[2] + up + 0.3 * np.abs(wide))
        s.surface(material, 8, 4, leaf)


def shelf(s, boards, colours, random):
    for k in range(5):
        s.box(boards, (-2.95, -0.6, 0.3 + 0.42 * k), (-2.65, 1.4, 0.33 + 0.42 * k))
        y = -0.55
        while k < 4 and y < 1.3:
            thick, high = random.uniform(0.02, 0.05), random.uniform(0.22, 0.36)
            s.box(colours[random.integers(len(colours))], (-2.93, y, 0.33 + 0.42 * k),
                  (-2.93 + random.uniform(0.16, 0.24), y + thick, 0.33 + 0.42 * k + high))
            y += thick + 0.002


def interior():
    """A furnished room that nothing but its lamp lights."""
    random = np.random.default_rng(7)
    s = Scene({"location": (0.3, -2.4, 1.45), "direction": (0, 1, 0), "angle": 75},
              light={"centre": (0, 0.2, 2.79), "x": 1.6, "y": 1.0, "watts": 150, "reflects": 0.8})
    white, floor = s.material("White", (0.8, 0.8, 0.8)), s.material("Floor", texture=TEXTURE)
    wood, dark = s.material("Wood", (0.45, 0.26, 0.12)), s.material("Dark", (0.12, 0.1, 0.09))
    rug, sofa = s.material("Rug", (0.55, 0.5, 0.42)), s.material("Sofa", (0.2, 0.28, 0.42))
    leaf, cloth = s.material("Leaf", (0.1, 0.32, 0.08)), s.material("Cloth", (0.7, 0.62, 0.5))
    clay = [s.material(f"Clay{k}", c) for k, c in enumerate([(0.6, 0.25, 0.15), (0.15, 0.35, 0.4), (0.7, 0.65, 0.55)])]
    x, y, z = 3, 2.5, 2.8
    s.quad(floor, (-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0))
    s.quad(white, (-x, -y, z), (-x, y, z), (x, y, z), (x, -y, z))
    s.quad(white, (-x, y, 0), (x, y, 0), (x, y, z), (-x, y, z))
    s.quad(white, (-x, -y, 0), (-x, -y, z), (x, -y, z), (x, -y, 0))
    s.quad(white, (-x, -y, 0), (-x, y, 0), (-x, y, z), (-x, -y, z))
    s.quad(white, (x, -y, 0), (x, -y, z), (x, y, z), (x, y, 0))
    s.surface(rug, 170, 110, lambda u, v: (3.2 * u - 1.6, 2.2 * v - 1.1, 0.02 + 0.006 * np.sin(190 * u + 9 * v)
                                           * np.sin(140 * v + 7 * np.sin(6 * u))))
    s.surface(wood, 96, 32, cushion(0.8, 0.45, 0.03, 0.3), (0, 0.2, 0.75))
    for dx in (-0.65, 0.65):
        for dy in (-0.3, 0.3):
            s.surface(wood, 48, 40, lathe(0.73, lambda v: 0.035 + 0.012 * np.sin(24 * v)), (dx, 0.2 + dy, 0))
    for at in ((-0.45, -0.55, np.pi), (0.5, -0.6, np.pi + 0.4), (-0.4, 0.95, 0.1), (0.45, 0.95, -0.2)):
        chair(s, dark, *at)
    for k, (px, py, pz) in enumerate([(-0.35, 0.25, 0.78), (0.4, 0.1, 0.78), (-2.3, 2.1, 0), (1.0, 2.2, 0),
                                      (0.1, 0.35, 0.78)]):
        size = 1 if pz else 2.2
        s.surface(clay[k % 3], 96, 64, lathe(0.3 * size, lambda v, k=k, size=size: size * (
            0.03 + 0.06 * np.sin(np.pi * (0.15 + 0.75 * v) + 0.3 * k) ** 2 + 0.004 * np.sin(60 * v))), (px, py, pz))
    for k, (px, py, pz) in enumerate([(-1.2, 2.0, 0.5), (-0.4, 2.1, 1.9), (2.4, 2.1, 1.9), (-2.3, -1.2, 0.6)]):
        s.surface(clay[k % 3], 256, 24, knot(0.2, 0.05, 2, 3 + 2 * (k % 2)), (px, py, pz))
    for k in range(3):
        s.surface(sofa, 64, 48, cushion(0.42, 0.36, 0.14, 0.45), (2.4, -0.6 + 0.75 * k, 0.42))
        s.surface(sofa, 64, 48, cushion(0.14, 0.36, 0.3, 0.45), (2.75, -0.6 + 0.75 * k, 0.75))
    for px in (-1.9, 1.5):
        s.surface(cloth, 200, 30, lambda u, v, px=px: (px + u, 2.42 + 0.04 * np.sin(60 * u) * (1.2 - 0.4 * v),
                                                      0.05 + 2.5 * v))
    shelf(s, wood, clay + [dark, sofa, cloth], random)
    plant(s, leaf, 2.3, 2.0, 0.5, random)
    s.surface(clay[0], 64, 32, lathe(0.5, lambda v: 0.14 + 0.06 * v), (2.3, 2.0, 0))
    return s


def main(folder, artist=None):
    write_texture(f"{folder}/{TEXTURE}")
    cornell().write(folder, "cornell")
    interior().write(folder, "interior")
    if artist:
        artists_room.read(artist, folder).write(folder, "artists-room")


main(*sys.argv[1:])
