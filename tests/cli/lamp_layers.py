"""Compare lamps of a file of retex-info --layers with a picture: the sum of each times its value; for layers.t.

    lamp_layers.py SET.exr FLAT.exr PICTURE.exr [LAMP=FACTOR ...]

A factor multiplies the value that the set has for the lamp.
"""
import json
import subprocess
import sys

import numpy
import OpenImageIO as oiio


def channels(path):
    """The channels of a file's first part, by name."""
    file = oiio.ImageInput.open(path)
    names = file.spec().channelnames
    pixels = file.read_image(0, 0, 0, len(names), oiio.FLOAT)
    return {name: pixels[..., i] for i, name in enumerate(names)}


flat, picture = channels(sys.argv[2]), channels(sys.argv[3])
factors = {name: float(factor) for name, factor in (text.split("=") for text in sys.argv[4:])}
manifest = json.loads(subprocess.check_output(["retex-info", "--json", sys.argv[1]]))
lamps = {p["name"]: p["value"] for p in manifest["parameters"] if p["kind"] == "color"}
found = [name for name in lamps if f"lamp_{name}.R" in flat]
layers = {c[:-2] for c in flat if c.startswith("lamp_")}
print("lamps", *found, *sorted(layers - {"lamp_" + name for name in found}))
for i, c in enumerate("RGB"):
    total = sum(flat[f"lamp_{name}.{c}"] * lamps[name][i] * factors.get(name, 1) for name in found)
    error = abs(total - picture[c]).max() / picture[c].max()
    print(c, "equal" if error < 1e-3 else f"off by {error:.1e}")
