"""A scene that two renderers are to render alike.

It is written twice, NAME.pov for retex and NAME.npz for cycles_render.py, with the very same triangles. Here z is up and
frames are right-handed; POV-Ray's scenes get (x, z, y). Coordinates are rounded to floats first, so that neither side
sees others. Pictures lie beside it.
"""
import json

import numpy as np


class Scene:
    """camera: location, direction, degrees; z is up in its picture. light: centre, side x, side y, watts, what it
    reflects; it faces down. sky: a picture of all directions; its middle is that of x, and that of y is a
    quarter from its left."""

    def __init__(self, camera, light=None, sky=None):
        self.camera, self.light, self.sky = camera, light, sky
        self.materials, self.meshes = {}, []

    def material(self, name, colour=None, texture=None, diffuse=1.0, glass=None, mirror=None):
        """Matte with a colour, or a texture times diffuse; or glass, its index of refraction; or a mirror's colour."""
        self.materials[name] = {"colour": colour, "texture": texture, "diffuse": diffuse, "glass": glass,
                                "mirror": mirror}
        return name

    def mesh(self, material, vertices, faces, uvs=None, normals=None):
        """Faces are counter-clockwise seen from outside; normals and UVs are the vertices'."""
        arrays = {"vertices": vertices, "normals": normals, "uvs": uvs}
        arrays = {name: np.asarray(a, np.float32) for name, a in arrays.items() if a is not None}
        self.meshes.append((material, {**arrays, "faces": np.asarray(faces, np.int32)}))

    def quad(self, material, *corners):
        self.mesh(material, corners, [(0, 1, 2), (0, 2, 3)], uvs=[(0, 0), (1, 0), (1, 1), (0, 1)])

    def box(self, material, low, high, turn=0.0):
        """Turned about the vertical through its middle."""
        low, high = np.array(low, float), np.array(high, float)
        points = np.array([[(low, high)[k >> a & 1][a] for a in range(3)] for k in range(8)])
        middle, (c, s) = (low + high) / 2, (np.cos(turn), np.sin(turn))
        points = (points - middle) @ np.array([(c, s, 0), (-s, c, 0), (0, 0, 1)]) + middle
        sides = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
        self.mesh(material, points, [f for a, b, c, d in sides for f in ((a, b, c), (a, c, d))])

    def surface(self, material, n, m, point, place=(0, 0, 0), textured=False):
        """Smooth: point(u, v) of arrays, sampled n by m times; u and v go from 0 to 1."""
        u, v = np.meshgrid(np.arange(n + 1) / n, np.arange(m + 1) / m, indexing="ij")
        points = np.stack(np.broadcast_arrays(*point(u, v)), axis=-1)
        wrapped = np.allclose(points[0], points[-1], atol=1e-9)
        points[-1] = points[0] if wrapped else points[-1]
        e, inner = 1e-4, np.clip(v, 1e-3, 1 - 1e-3)  # poles have the normal of what is beside them
        along = [np.stack(np.broadcast_arrays(*point(u + a, inner + b)), axis=-1)
                 for a, b in ((e, 0), (-e, 0), (0, e), (0, -e))]
        normals = np.cross(along[0] - along[1], along[2] - along[3])
        normals /= np.maximum(np.linalg.norm(normals, axis=-1, keepdims=True), 1e-30)
        a = (np.arange(n)[:, None] * (m + 1) + np.arange(m)).ravel()
        b = a + m + 1
        faces = np.concatenate([np.stack([a, b, b + 1], 1), np.stack([a, b + 1, a + 1], 1)])
        points, uvs = points.reshape(-1, 3), np.stack([u, v], -1).reshape(-1, 2)
        corners = points[faces]
        area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
        self.mesh(material, points + np.array(place), faces[area > 1e-12], uvs if textured else None,
                  normals.reshape(-1, 3))

    def count(self):
        return sum(len(arrays["faces"]) for _, arrays in self.meshes)

    # ---- output ----

    def write(self, folder, name):
        header = {"materials": self.materials, "meshes": [m for m, _ in self.meshes], "light": self.light,
                  "sky": self.sky, "camera": self.camera}
        arrays = {f"{i}-{key}": a for i, (_, mesh) in enumerate(self.meshes) for key, a in mesh.items()}
        np.savez(f"{folder}/{name}.npz", header=json.dumps(header), **arrays)
        with open(f"{folder}/{name}.pov", "w", encoding="ascii") as out:
            self.write_pov(out)
        print(f"{name}: {self.count()} triangles")

    def write_pov(self, out):
        (x, y, z), (dx, dy, dz) = self.camera["location"], self.camera["direction"]
        out.write("#version 3.7;\nglobal_settings { assumed_gamma 1 }\n"
                  f"camera {{ location <{x}, {z}, {y}> right x up y angle {self.camera['angle']} "
                  f"look_at <{x + dx}, {z + dz}, {y + dy}> }}\n")
        for name, material in self.materials.items():
            out.write(f"#declare {name} = {pov_material(material)}\n")
        if self.light:
            self.write_light(out)
        if self.sky:
            out.write(f'sky_sphere {{ pigment {{ image_map {{ exr "{self.sky}" map_type 1 interpolate 2 }} }} '
                      "matrix <-1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0> }\n")
        for material, mesh in self.meshes:
            out.write("mesh2 {\n")
            for key, word in (("vertices", "vertex_vectors"), ("normals", "normal_vectors"), ("uvs", "uv_vectors")):
                if key in mesh:
                    swapped = mesh[key] if key == "uvs" else mesh[key][:, [0, 2, 1]]
                    write_list(out, word, swapped, "%.9g")
            write_list(out, "face_indices", mesh["faces"][:, [0, 2, 1]], "%d")
            out.write(f"material {{ {material} }}\n}}\n")

    def write_light(self, out):
        """Cycles' area light shines down, is not seen by the camera, and lets through what comes from above; what hits
        it from below gets its light and that of the ceiling behind it. Here it reflects like the ceiling instead, and
        is clear on its back."""
        (x, y, z), a, b = self.light["centre"], self.light["x"] / 2, self.light["y"] / 2
        reflects = self.light["reflects"]
        radiance = self.light["watts"] / (4 * self.light["x"] * self.light["y"])  # Cycles has 4 for the pi of physics
        corners = [f"<{x + i * a}, {z}, {y + j * b}>" for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        faces = " ".join("triangle { " + ", ".join(corners[k] for k in face) + " }" for face in ((0, 1, 2), (0, 2, 3)))
        out.write(f"mesh {{ {faces}\n  texture {{ pigment {{ rgb {reflects} }}\n"
                  f"    finish {{ diffuse 1 ambient 0 emission {radiance / reflects:.9g} }} }}\n"
                  "  interior_texture { pigment { rgbt 1 } finish { diffuse 0 ambient 0 } } no_image }\n")


def pov_material(material):
    if material["glass"]:
        return ("material { texture { pigment { rgbt 1 } finish { diffuse 0 ambient 0 reflection { 0, 1 fresnel }"
                f" conserve_energy }} }} interior {{ ior {material['glass']} }} }}")
    if material["mirror"]:
        return (f"material {{ texture {{ pigment {{ rgb 0 }} finish {{ diffuse 0 ambient 0 "
                f"reflection {{ {pov_colour(material['mirror'])} }} }} }} }}")
    if material["texture"]:
        pigment = f'uv_mapping image_map {{ png "{material["texture"]}" interpolate 2 }}'
    else:
        pigment = pov_colour(material["colour"])
    return (f"material {{ texture {{ pigment {{ {pigment} }} "
            f"finish {{ diffuse {material['diffuse']:g} ambient 0 }} }} }}")


def pov_colour(colour):
    return f"rgb <{', '.join(map(str, colour))}>"


def write_list(out, word, rows, form):
    row = "<" + ",".join([form] * rows.shape[1]) + ">"
    out.write(f"{word} {{ {len(rows)},\n" + ",\n".join(row % tuple(r) for r in rows.tolist()) + " }\n")
