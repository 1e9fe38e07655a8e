"""Pictures as other renderers write them, for denoise_pictures.t, and what must hold of them when they are denoised.

    denoise_pictures.py make              writes pictures of a scene that is computed here, with noise, and their truth
    denoise_pictures.py render SCENE      joins renders of retex-render into pictures with AOVs
    denoise_pictures.py gain FILE NOISY TRUTH [LAYER] least=DB   whether FILE is nearer to TRUTH than NOISY, by so much
    denoise_pictures.py changed A B       prints the channels that differ
    denoise_pictures.py same A B LAYER…   prints the channels that differ in bits, but for those of the layers, and
                                          what differs in the headers
    denoise_pictures.py sum FILE          whether Combined is what the layers add up to, to the rounding of a half
"""

import sys

import numpy as np
import OpenImageIO as oiio

WIDTH, HEIGHT = 120, 90


def write(path, layers, kind="half", parts=False, **attributes):
    """Writes {name: array of 1 or 3 channels}, as one part or one a layer. Letters of channels may follow a colon."""
    specs, images = [], []
    for name, image in layers.items():
        name, _, letters = name.partition(":")
        letters = letters or ("RGB" if image.shape[2] == 3 else "Z")
        specs.append([(name + "." if name else "") + letter for letter in letters])
        images.append(image.astype(np.float32))
    if not parts:
        specs, images = [sum(specs, [])], [np.concatenate(images, 2)]
    opened = []
    for names, image in zip(specs, images):
        spec = oiio.ImageSpec(image.shape[1], image.shape[0], image.shape[2], kind)
        spec.channelnames = names
        spec["compression"] = "zip"
        spec["Artist"] = "somebody"
        spec["a number"] = 7
        if parts:
            spec["oiio:subimagename"] = names[0].rpartition(".")[0]
        window = attributes.pop("window", None) if not parts else None
        if window:
            spec.x, spec.y, spec.full_x, spec.full_y, spec.full_width, spec.full_height = window
        for key, value in attributes.items():
            if key == "tile":
                spec.tile_width = spec.tile_height = value
            elif key == "types":
                spec.channelformats = tuple(value(name) for name in names)
            else:
                spec[key] = value
        opened.append(spec)
    out = oiio.ImageOutput.create(path)
    if len(opened) > 1:
        out.open(path, tuple(opened))
    else:
        out.open(path, opened[0])
    for number, image in enumerate(images):
        if number:
            out.open(path, opened[number], "AppendSubimage")
        out.write_image(np.ascontiguousarray(image))
    if not out.close() or out.has_error:
        sys.exit(out.geterror())


def read(path):
    """The channels of all parts by name."""
    file = oiio.ImageInput.open(path)
    channels, number = {}, 0
    while file.seek_subimage(number, 0):
        spec = file.spec()
        pixels = file.read_image(number, 0, 0, spec.nchannels, "float")
        for k, name in enumerate(spec.channelnames):
            channels[name] = pixels[..., k]
        number += 1
    return channels


def layer(path, name):
    channels = read(path)
    return np.stack([channels[(name + "." if name else "") + c] for c in "RGB"], 2).astype(float)


def scene():
    """Two walls and a ball, lit from one side: {layer: values}, without noise."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH] + 0.5
    u, v = x / WIDTH, y / HEIGHT
    left = (u < 0.45)[..., None]
    ball = ((u - 0.7) ** 2 * 1.8 + (v - 0.6) ** 2 < 0.05)[..., None]
    normal = np.where(left, [1.0, 0, 0], [0, 0, 1.0])
    bx, by = (u - 0.7) * 1.34 / 0.224, (v - 0.6) / 0.224
    round_ = np.stack([bx, -by, np.sqrt(np.maximum(0, 1 - bx**2 - by**2))], 2)
    normal = np.where(ball, round_, normal)
    position = np.where(left, np.stack([0 * u, -v, 2 * u], 2), np.stack([u - 0.45, -v, 0.9 + 0 * u], 2))
    position = np.where(ball, np.stack([u - 0.45, -v, 1.1 + 0.2 * round_[..., 2]], 2), position)
    tiles = ((x // 9 + y // 7) % 2)[..., None]
    color = np.where(ball, [0.8, 0.3, 0.2], np.where(tiles > 0, [0.7, 0.6, 0.4], [0.25, 0.3, 0.5]))
    shadow = 1 / (1 + np.exp(-(u + 0.4 * v - 0.75) * 60))[..., None]
    direct = (0.15 + 0.85 * shadow) * np.array([1.0, 0.95, 0.9]) * (0.4 + 0.6 * normal[..., 2:3] ** 2)
    indirect = 0.3 * np.array([0.9, 1.0, 1.1]) * (0.5 + 0.5 * v[..., None])
    emit = np.where((u[..., None] > 0.93) & (v[..., None] < 0.2), [2.0, 2, 2], 0)
    depth = 3 - position[..., 2:3]
    return {"Col": color, "Dir": direct, "Ind": indirect, "Emit": emit, "Normal": normal, "Position": position,
            "Depth": depth}


def noisy(image, seed, samples):
    """Each sample is the light times a number of exponential distribution."""
    random = np.random.RandomState(seed)
    numbers = random.gamma(samples, 1 / samples, image.shape[:2])[..., None]
    return image * numbers


def half(image):
    return image.astype(np.float16).astype(np.float64)


def cycles(seed, samples):
    """Layers as Blender writes them."""
    s = scene()
    direct, indirect = half(noisy(s["Dir"], seed, samples)), half(noisy(s["Ind"], seed + 1000, samples / 3))
    color, emit = half(s["Col"]), half(s["Emit"])
    combined = color * (direct + indirect) + emit
    alpha = np.ones((HEIGHT, WIDTH, 1))
    return {"ViewLayer.Combined": combined, "ViewLayer.Combined:A": alpha, "ViewLayer.DiffDir": direct,
            "ViewLayer.DiffInd": indirect, "ViewLayer.DiffCol": color, "ViewLayer.Emit": emit,
            "ViewLayer.Normal:XYZ": s["Normal"], "ViewLayer.Position:XYZ": s["Position"],
            "ViewLayer.Depth": s["Depth"], "ViewLayer.Denoising Albedo": color}


def types(name):
    return "float" if name[-1] in "XYZ" else "half"


def make():
    s = scene()
    truth = s["Col"] * (s["Dir"] + s["Ind"]) + s["Emit"]
    write("truth.exr", {"": truth}, "float")
    write("truth-cycles.exr", {"ViewLayer.Combined": truth}, "float")
    for name, seed in (("a", 1), ("b", 2)):
        write(name + ".exr", cycles(seed, 8), types=types)
        layers = cycles(seed, 8)
        del layers["ViewLayer.Combined:A"]
        write(name + "-parts.exr", layers, parts=True)
    everything = cycles(1, 8)
    write("tiled.exr", everything, types=types, tile=32)
    write("cropped.exr", everything, types=types, window=(-20, 12, 0, 0, 640, 480))
    for compression in ("none", "rle", "zips", "piz", "pxr24", "b44"):
        write(compression + ".exr", everything, "float" if compression == "pxr24" else "half", compression=compression,
              window=(-20, 12, 0, 0, 640, 480) if compression == "piz" else None)
    write("pieces.exr", everything, types=types, tile=32, compression="piz")
    # one render with the variance of the mean, of 16 samples that are all known
    light = s["Dir"] + s["Ind"]
    samples = np.array([noisy(s["Col"] * light, 100 + k, 1) for k in range(16)])
    variance = samples.var(0, ddof=1) / 16
    guides = {"N:XYZ": s["Normal"], "albedo": s["Col"], "P:XYZ": s["Position"], "variance": variance}
    write("one.exr", {"": samples.mean(0) + s["Emit"], ":A": np.ones((HEIGHT, WIDTH, 1)), **guides}, "float",
          **{"an attribute with a name of more than 31 letters": 3})
    write("depth.exr", {"": samples.mean(0) + s["Emit"], "N:XYZ": s["Normal"], "albedo": s["Col"], ":Z": s["Depth"]},
          "float")
    write("bare.exr", {"": samples.mean(0) + s["Emit"]}, "float")
    write("grey.exr", {":Y": (samples.mean(0) + s["Emit"])[..., 1:2], **guides}, "float")
    bad = samples.mean(0) + s["Emit"]
    bad[5, 7, 1] = np.nan
    write("nan.exr", {"": bad, **guides}, "float")
    bad[5, 7, 1] = np.inf
    write("inf.exr", {"": bad, **guides}, "float")
    write("small.exr", {"": bad[:40]}, "float")
    write("two.exr", {"A.Combined": truth, "B.Combined": truth})


def render():
    """Renders by retex-render in folders r1 and r2, and the truth in rt."""
    def aov(folder, name):
        file = oiio.ImageInput.open(folder + "/" + name + ".exr")
        return file.read_image(0, 0, 0, 3, "float").astype(float)

    for folder in ("r1", "r2"):
        write(folder + ".exr", {"": aov(folder, "beauty"), "N:XYZ": aov(folder, "normal_mean"),
                                "albedo": aov(folder, "albedo_mean"), "P:XYZ": aov(folder, "position")}, "float")
    write("r.exr", {"": (aov("r1", "beauty") + aov("r2", "beauty")) / 2, "N:XYZ": aov("r1", "normal_mean"),
                    "albedo": aov("r1", "albedo_mean"), "P:XYZ": aov("r1", "position")}, "float")
    write("rt.exr", {"": aov("rt", "beauty")}, "float")


def gain(path, before, truth, *rest):
    name = rest[0] if len(rest) > 1 else ""
    least = float(rest[-1].partition("=")[2])
    reference = layer(truth, name)
    errors = [np.mean((layer(p, name) - reference) ** 2) for p in (before, path)]
    by = 10 * np.log10(errors[0] / errors[1])
    print("nearer" if by >= least else "nearer by %.2f dB only" % by)


def changed(a, b):
    first, second = read(a), read(b)
    print(*(name for name in first if not np.array_equal(first[name], second[name], equal_nan=True)))


def header(path):
    file = oiio.ImageInput.open(path)
    specs, number = [], 0
    while file.seek_subimage(number, 0):
        s = file.spec()
        specs.append({"channels": s.channelnames, "formats": [str(f) for f in s.channelformats],
                      "format": str(s.format),
                      "window": (s.x, s.y, s.width, s.height, s.full_x, s.full_y, s.full_width, s.full_height),
                      "tile": (s.tile_width, s.tile_height), **{a.name: a.value for a in s.extra_attribs}})
        number += 1
    return specs


def same(a, b, *layers):
    first, second = read(a), read(b)
    for name in first:
        inside = name.rpartition(".")[0] in layers and name.rpartition(".")[2] in ("R", "G", "B")
        if inside == np.array_equal(first[name], second[name], equal_nan=True):
            print(name, "is the same" if inside else "differs")
    for number, (x, y) in enumerate(zip(header(a), header(b))):
        for key in sorted(set(x) | set(y)):
            if x.get(key) != y.get(key):
                print("part %d: %s: %s, %s" % (number, key, x.get(key), y.get(key)))


def total(path):
    """In units of the last bit of a half."""
    view = "ViewLayer."
    sums = layer(path, view + "DiffCol") * (layer(path, view + "DiffDir") + layer(path, view + "DiffInd"))
    sums += layer(path, view + "Emit")
    difference = np.abs(sums - layer(path, view + "Combined")) / np.maximum(sums, 1e-3)
    print("adds up" if difference.max() * 2048 <= 1.01 else "differs by %g of the last bit" % (difference.max() * 2048))


def main():
    command, arguments = sys.argv[1], sys.argv[2:]
    {"make": make, "render": render, "gain": gain, "same": same, "changed": changed,
     "sum": total}[command](*arguments)


if __name__ == "__main__":
    main()
