"""The artist's room, a scene for POV-Ray with a folder of meshes and one of pictures, as a scene of scene.py.

Only what such a converted scene has is understood: a line for each material, meshes in files of their own, a sky, a
camera. Both renderers must say a material alike. So surfaces are matte, with their colour or picture and how much of it
they reflect, or glass, or mirrors; the gloss of floor, table and panelling is left out, brushed steel is a mirror of its
colour, and the leaves' pictures do not cut them out.

Its coordinates are right-handed with y up: (x, y, z) becomes (x, -z, y) here.
"""
import math
import os
import re
import shutil
import sys

import numpy as np
import OpenImageIO as oiio

from scene import Scene

SKY = "sky.exr"
# POV-Ray begins with x at the left; half a turn of that is the sky of scene.py.
SKY_MATRIX = "matrix <-1,0,0,0,1,0,0,0,-1,0,0,0>"


def refuse(what):
    sys.exit(f"bench-render: the artist's room: {what}")


def found(pattern, text):
    match = re.search(pattern, text)
    if not match:
        refuse(f"no {pattern} in {text[:80]}")
    return match


def vector(word, text):
    x, y, z = map(float, found(rf"\b{word} *<([^>]*)>", text)[1].split(","))
    return x, y, z


def turned(x, y, z):
    return x, -z, y


def camera(text):
    """A square picture, as wide as the scene's."""
    text = found(r"camera *\{.*\}", text)[0]
    direction = np.array(vector("direction", text))
    angle = 2 * math.atan2(np.linalg.norm(vector("right", text)) / 2, np.linalg.norm(direction))
    return {"location": turned(*vector("location", text)), "direction": turned(*direction.tolist()),
            "angle": math.degrees(angle)}


def texture(source, folder):
    """Both renderers read the very same texels, without alpha."""
    name = os.path.splitext(os.path.basename(source))[0] + ".png"
    file = oiio.ImageInput.open(source)
    if not file:
        refuse(oiio.geterror())
    pixels = np.ascontiguousarray(file.read_image("uint8")[..., :3])
    file.close()
    out = oiio.ImageOutput.create(name)
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], 3, "uint8")
    if not out or not out.open(f"{folder}/{name}", spec) or not out.write_image(pixels):
        refuse(f"cannot write {folder}/{name}")
    out.close()
    return name


def material(scene, name, text, source, folder):
    diffuse = float(found(r"\bdiffuse ([\d.]+)", text)[1])
    image = re.search(r'image_map *\{ *\w+ "([^"]*)"', text)
    if "rgbt 1" in text:
        scene.material(name, glass=float(found(r"\bior ([\d.]+)", text)[1]))
    elif "reflection{1 metallic}" in text:
        scene.material(name, mirror=vector("rgb", text))
    elif image:
        scene.material(name, texture=texture(f"{source}/{image[1]}", folder), diffuse=diffuse)
    else:
        scene.material(name, colour=vector("rgb", text), diffuse=diffuse)


def mesh(scene, text):
    lists = {}
    for word, count, rows in re.findall(r"(\w+) *\{ *(\d+),([^}]*)\}", text):
        numbers = np.array(re.sub("[<>,]", " ", rows).split(), float)
        lists[word] = numbers.reshape(int(count), -1)
    vertices, normals = lists.pop("vertex_vectors"), lists.pop("normal_vectors", None)
    uvs, faces = lists.pop("uv_vectors", None), lists.pop("face_indices")
    if lists:
        refuse(f"a mesh with {', '.join(lists)}")
    vertices, normals = (a if a is None else np.stack(turned(*a.T), -1) for a in (vertices, normals))
    scene.mesh(found(r"material *\{ *(\w+) *\}", text)[1], vertices, faces, uvs, normals)


def read(source, folder):
    """source: the folder of scene.pov; folder: for the pictures."""
    with open(f"{source}/scene.pov", encoding="ascii") as file:
        text = file.read()
    if SKY_MATRIX not in text:
        refuse("its sky is turned otherwise")
    sky = found(r'sky_sphere.*exr "([^"]*)"', text)[1]
    shutil.copyfile(f"{source}/{sky}", f"{folder}/{SKY}")
    scene = Scene(camera(text), sky=SKY)
    for name, body in re.findall(r"#declare (\w+) *= *material *\{(.*)\}", text):
        material(scene, name, body, source, folder)
    for name in re.findall(r'#include "(geom/[^"]*)"', text):
        with open(f"{source}/{name}", encoding="ascii") as file:
            for part in file.read().split("mesh2")[1:]:
                mesh(scene, part)
    return scene
