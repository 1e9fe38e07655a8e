"""For reflectance.t: a row of walls of all kinds of finishes, lit by a light from the camera, whose reflectance has a
closed form: AOV `reflectance`, and the picture where the surface is Lambertian."""
import subprocess

import numpy as np
import OpenImageIO as oiio

COLOR = np.array([0.5, 0.4, 0.2])
PIGMENT = "pigment { rgb <0.5, 0.4, 0.2> }"
BASE = "texture { %s finish { diffuse 0.7 } }" % PIGMENT
WALLS = {  # name: texture, share of the pigment's colour, whether the picture is the reflectance
    "diffuse": (BASE, 0.7, True),
    "brilliance": (f"{PIGMENT} finish {{ diffuse 0.7 brilliance 3 }}", 0.7 * 2 / 4, False),
    "filter": ("pigment { rgbf <0.5, 0.4, 0.2, 0.25> } finish { diffuse 0.7 }", 0.7 * 0.75, False),
    "mirror": (f"{PIGMENT} finish {{ diffuse 0 reflection 0.9 }}", 0, False),
    "half a mirror": (f"{PIGMENT} finish {{ diffuse 0.7 reflection 0.5 }}", 0.5, True),
    "metal": (f"{PIGMENT} finish {{ retex {{ metallic 1 roughness 0.3 }} }}", 0, False),
    "part metal": (f"{PIGMENT} finish {{ retex {{ metallic 0.25 roughness 0.5 }} }}", 0.75, False),
    "part glass": (f"{PIGMENT} finish {{ retex {{ transmission 0.4 roughness 0.5 }} }}", 0.6, False),
    "coat": (f"{PIGMENT} finish {{ retex {{ roughness 0.5 clearcoat 1 }} }}", 0.96, False),
    "below the surface": (f"{PIGMENT} finish {{ diffuse 0.7 subsurface {{ translucency 0.1 }} }}", 0.7, False),
    "map": (f"texture {{ gradient y texture_map {{ [0.5 {PIGMENT} finish {{ diffuse 0.2 }}]"
            f" [0.5 {PIGMENT} finish {{ diffuse 0.2 }}] }} }}", 0.2, True),
    "layers": (BASE + " texture { pigment { rgbt <1, 0, 0, 0.5> } finish { diffuse 0.6 } }",
               np.array([0.3, 0, 0]) / COLOR + 0.5 * 0.7, True),
    "layer that shines": (BASE + " texture { pigment { rgbt <1, 0, 0, 0.5> } finish { diffuse 0.6 specular 0.1 } }",
                          np.array([0.3, 0, 0]) / COLOR + 0.5 * 0.7, False),
}

scene = ["#version 3.7; global_settings { assumed_gamma 1 radiosity {} mm_per_unit 1000 }",
         "#default { finish { ambient 0 diffuse 1 } }",
         f"camera {{ orthographic location <{len(WALLS) / 2}, 0.5, -5> look_at <{len(WALLS) / 2}, 0.5, 0>"
         f" right {len(WALLS) + 1} * x up y }}",
         "light_source { <0, 0, -9> rgb 1 parallel point_at <0, 0, 0> }"]
for k, (texture, _, _) in enumerate(WALLS.values()):
    scene.append(f"box {{ <{k}, 0, 0>, <{k + 0.99}, 1, 0.5> {texture} interior {{ ior 1.5 }} }}")
with open("walls.pov", "w") as file:
    file.write("\n".join(scene) + "\n")
subprocess.run(["retex-render", "-q", "--plain", "--size", f"{10 * (len(WALLS) + 1)}x10", "--spp", "16", "--aov",
                "albedo,reflectance,irradiance", "walls.pov", "-o", "walls.exr"], check=True)
parts, source = {}, oiio.ImageInput.open("walls.exr")
for index in range(4):
    source.seek_subimage(index, 0)
    channels = [name.rpartition(".")[2] for name in source.spec().channelnames]
    pixels = source.read_image(index, 0, 0, 3, "float").astype(float)
    parts[source.spec().getattribute("name")] = pixels[:, :, [channels.index(c) for c in "RGB"]]
for k, (name, (_, share, is_picture)) in enumerate(WALLS.items()):
    y, x = 5, 10 * k + 10
    expected = COLOR * share
    seen = parts["reflectance"][y, x]
    if abs(seen - expected).max() > 1e-5:
        print(f"{name}: reflectance {seen}, not {expected}")
    if is_picture and abs(parts["beauty"][y, x] - expected).max() > 1e-3:
        print(f"{name}: the picture is {parts['beauty'][y, x]}, not {expected}")
    if is_picture and abs(parts["irradiance"][y, x] * seen / np.pi - parts["beauty"][y, x]).max() > 1e-3:
        print(f"{name}: irradiance times reflectance is not the picture")
if parts["reflectance"][5, 1].any():
    print("where nothing is hit it is not 0")
