"""Read a script of retex-info --nuke as Nuke does, stack and all, and compute its picture; for info.t.

    nuke.py SCRIPT.nk TEXTURE PICTURE.exr

Nuke itself is not here. What is checked: braces and quotes balance, every node is of a known class with known knobs and
finds its inputs on the stack, and what comes to the viewer is the retexture. TEXTURE takes the place of the node Texture;
each pixel's colour is that of the texel it lies in, between neighbours bilinearly.
"""
import re
import sys

import numpy
import OpenImageIO as oiio

KNOBS = {
    "Read": {"file", "raw"},
    "CheckerBoard2": {"label"},
    "Reformat": {"type", "box_width", "box_height", "box_fixed", "resize"},
    "Blur": {"channels", "size"},
    "Shuffle": {"in", "alpha"},
    "Expression": {"expr0", "expr1", "expr2"},
    "STMap": {"channels", "uv"},
    "Merge2": {"operation", "output"},
    "Viewer": set(),
}


def read(path):
    """Rows from the bottom, as Nuke counts them, by channel."""
    image = oiio.ImageBuf(path)
    pixels = image.get_pixels(oiio.FLOAT)[::-1]
    return {name: pixels[..., i] for i, name in enumerate(image.spec().channelnames)}


def layers_of(path):
    """Nuke's layers of a flat EXR."""
    layers = {}
    for name, pixels in read(path).items():
        layer, _, letter = name.rpartition(".")
        layer = re.sub(r"[^A-Za-z0-9]", "_", layer.lstrip("0123456789")) or "rgb"
        layers.setdefault(layer, {})["RGB".find(letter)] = pixels
    return {name: numpy.stack([by[k] for k in range(3)], -1) for name, by in layers.items() if {0, 1, 2} <= set(by)}


def gather(image, u, v):
    """Between the centres of texels; at the border, the outermost."""
    height, width = image.shape[:2]
    x, y = numpy.clip(u * width - 0.5, 0, width - 1), numpy.clip(v * height - 0.5, 0, height - 1)
    x0, y0 = numpy.minimum(x.astype(int), width - 2), numpy.minimum(y.astype(int), height - 2)
    fx, fy = (x - x0)[..., None], (y - y0)[..., None]
    lower = image[y0, x0] * (1 - fx) + image[y0, x0 + 1] * fx
    upper = image[y0 + 1, x0] * (1 - fx) + image[y0 + 1, x0 + 1] * fx
    return lower * (1 - fy) + upper * fy


def smaller(image, width, height):
    """Means of boxes; a whole number of texels each."""
    h, w = image.shape[:2]
    return image.reshape(height, h // height, width, w // width, -1).mean((1, 3))


def blurred(image, sigma):
    for axis in (0, 1):
        at = numpy.arange(image.shape[axis])
        weights = numpy.exp(-((at[:, None] - at[None, :]) ** 2) / (2 * sigma**2))
        weights /= weights.sum(1, keepdims=True)
        image = numpy.moveaxis(numpy.tensordot(weights, image, (1, axis)), 0, axis)
    return image


def evaluate(kind, knobs, inputs):
    """The red, green and blue of a node, or, of Read, all layers."""
    if kind == "Read":
        return layers_of(knobs["file"])
    if kind == "CheckerBoard2":
        return texture
    if kind == "Reformat":
        assert knobs["type"] == "to box" and knobs["box_fixed"] == "true" and knobs["resize"] == "distort"
        return smaller(inputs[0], int(knobs["box_width"]), int(knobs["box_height"]))
    if kind == "Blur":
        return blurred(inputs[0], float(knobs["size"]) / 2)
    if kind == "Shuffle":
        return inputs[0][knobs["in"]]
    if kind == "Expression":
        r, g, b = (inputs[0][..., k] for k in range(3))
        given = {"r": r, "g": g, "b": b, "floor": numpy.floor, "clamp": lambda x: numpy.clip(x, 0, 1)}
        return numpy.stack([eval(knobs.get("expr%d" % k, "rgb"[k]), {}, given) for k in range(3)], -1)
    if kind == "STMap":
        source, places = inputs
        return gather(source, places[..., 0], places[..., 1])
    if kind == "Merge2":
        assert knobs["output"] == "rgb"
        below, above = inputs
        return above * below if {"multiply": 1, "plus": 0}[knobs["operation"]] else above + below
    return inputs[0]


script, texture_file, picture_file = sys.argv[1:]
channels = read(texture_file)
texture = numpy.stack([channels[c] for c in "RGB"], -1)
stack, names, shown, seen, added = [], {}, None, set(), set()
lines = iter(open(script, encoding="utf-8").read().splitlines())
for line in lines:
    if not line or line.startswith("#"):
        continue
    if match := re.fullmatch(r"add_layer \{(\w+) (\w+)\.red \2\.green \2\.blue\}", line):
        assert match[1] == match[2]
        added.add(match[1])
    elif match := re.fullmatch(r"set (\w+) \[stack 0\]", line):
        names[match[1]] = stack[-1]
    elif match := re.fullmatch(r"push \$(\w+)", line):
        stack.append(names[match[1]])
    elif match := re.fullmatch(r"(\w+) \{", line):
        kind, knobs = match[1], {}
        while (line := next(lines)) != "}":
            # a word, or quoted; a brace or bracket, a quote or a dollar in it would need its backslash
            assert not re.search(r'(?<!\\)[][{}$]', line), line
            name, value = re.fullmatch(r' (\w+) ([^\s"]+|"(?:[^"\\]|\\.)*")', line).groups()
            value = re.sub(r"\\(.)", r"\1", value[1:-1]) if value.startswith('"') else value
            assert name in KNOBS[kind] | {"inputs", "name", "xpos", "ypos"}, (kind, name)
            knobs[name] = value
        assert knobs["name"] not in seen, knobs["name"]
        seen.add(knobs["name"])
        wanted = int(knobs.get("inputs", 1))
        inputs = [stack.pop() for _ in range(wanted)]
        stack.append(evaluate(kind, knobs, inputs))
        if kind == "Shuffle":
            assert knobs["in"] in added, knobs["in"]
        if kind == "Viewer":
            shown = stack[-1]
    else:
        raise AssertionError(line)
height, width = shown.shape[:2]
result = oiio.ImageBuf(oiio.ImageSpec(width, height, 3, oiio.FLOAT))
result.set_pixels(oiio.ROI(0, width, 0, height), numpy.ascontiguousarray(shown[::-1], numpy.float32))
result.write(picture_file)
print("%d nodes" % len(seen))
