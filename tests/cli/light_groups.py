"""Pictures with light groups as Blender writes them, for light_groups.t, and what must hold of their sets.

    light_groups.py make                     truth.exr, a.exr and b.exr with noise, filtered.exr as after Blender's
                                             denoiser, small.exr without noise
    light_groups.py layers PICTURE A=LAYER[*F]+…  prints whether the picture A is that sum of layers of PICTURE
    light_groups.py sum PICTURE A B …        prints how far the sum of the pictures A, B, … is from PICTURE
    light_groups.py gain PICTURE NOISY TRUTH  prints whether PICTURE is nearer to TRUTH than NOISY, by 10 dB
"""
import sys

import numpy as np
import OpenImageIO as oiio

WIDTH, HEIGHT = 96, 64


def write(path, layers):
    """Writes {name: array}, as one part of floats; three channels are R, G, B, or X, Y, Z of normals."""
    names = [f"{name}.{c}" for name, image in layers.items()
             for c in ("XYZ" if "Normal" in name else "RGBA")[:image.shape[2]]]
    spec = oiio.ImageSpec(WIDTH, HEIGHT, len(names), "float")
    spec.channelnames = tuple(names)
    spec["compression"] = "zip"
    out = oiio.ImageOutput.create(path)
    if not out.open(path, spec) or not out.write_image(np.ascontiguousarray(
            np.concatenate(list(layers.values()), 2).astype(np.float32))) or not out.close():
        sys.exit(out.geterror())


def read(path):
    """The channels of a file: {name: array}."""
    file = oiio.ImageInput.open(path)
    names = file.spec().channelnames
    pixels = file.read_image(0, 0, 0, len(names), "float")
    return {name: pixels[..., i].astype(np.float64) for i, name in enumerate(names)}


def light_of(channels, layer=""):
    return np.stack([channels[(layer + "." if layer else "") + c] for c in "RGB"], -1)


def scene():
    """The light of each group on a floor of tiles, and of none: a bar that shines."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH].astype(np.float64)
    tiles = np.where(((x // 16 + y // 16) % 2)[..., None] > 0, [.8, .5, .3], [.2, .3, .5])
    key = tiles * (1.5 * np.exp(-((x - 25) ** 2 + (y - 30) ** 2) / 900))[..., None] * [1, .9, .7]
    fill = tiles * (.1 + .2 * x / WIDTH)[..., None] * [.6, .8, 1]
    bar = np.where(((y > 50) & (y < 54))[..., None], [3., 3., 2.], [0., 0., 0.])
    return tiles, {"Key": key, "Fill Light": fill}, bar


def picture(noise, seed):
    random = np.random.default_rng(seed)
    tiles, groups, bar = scene()
    groups = {name: np.maximum(image * (1 + noise * random.standard_normal(image.shape)), 0).astype(np.float32)
              for name, image in groups.items()}
    whole = (sum(groups.values()) + bar).astype(np.float32)
    normal = np.zeros_like(tiles) + [0, 0, 1]
    layers = {"Combined": np.concatenate([whole, np.ones((HEIGHT, WIDTH, 1))], 2)}
    layers.update({"Combined_" + name: image for name, image in groups.items()})
    layers.update({"Denoising Albedo": tiles, "Denoising Normal": normal})
    return {"ViewLayer." + name: image for name, image in layers.items()}


def make():
    write("truth.exr", picture(0, 0))
    write("a.exr", picture(.4, 1))
    write("b.exr", picture(.4, 2))
    layers = picture(.4, 1)
    layers["ViewLayer.Noisy Image"] = layers["ViewLayer.Combined"]
    layers["ViewLayer.Combined"] = picture(0, 0)["ViewLayer.Combined"]
    write("filtered.exr", layers)
    del layers["ViewLayer.Noisy Image"]
    write("unlike.exr", layers)
    several = {"a.Combined_" + str(k): layers["ViewLayer.Combined_Key"] for k in range(17)}
    write("many.exr", {"a.Combined": layers["ViewLayer.Combined"], **several})
    write("none.exr", {"a.Combined": layers["ViewLayer.Combined"], "b.Combined_Key": layers["ViewLayer.Combined_Key"]})
    write("two.exr", {"a.Combined": layers["ViewLayer.Combined"], "a.Combined_Key": layers["ViewLayer.Combined_Key"],
                      "b.Combined": layers["ViewLayer.Combined"], "b.Combined_x:y": layers["ViewLayer.Combined_Key"]})
    write("taken.exr", {"a.Combined": layers["ViewLayer.Combined"], "a.Combined_Rest": layers["ViewLayer.Combined"]})


def compare(source, text):
    channels = read(source)
    path, _, layers = text.partition("=")
    total = 0
    for term in layers.split("+"):
        layer, _, factor = term.partition("*")
        total = total + light_of(channels, "ViewLayer." + layer) * float(factor or 1)
    error = abs(light_of(read(path)) - total).max() / total.max()
    print(path, "equal" if error < 1e-6 else f"off by {error:.1e}")


def psnr(a, b):
    return -10 * np.log10(np.mean((np.minimum(a, 1) - np.minimum(b, 1)) ** 2))


def main(command, *rest):
    if command == "make":
        make()
    elif command == "layers":
        for text in rest[1:]:
            compare(rest[0], text)
    elif command == "sum":
        whole = light_of(read(rest[0]))
        error = abs(sum(light_of(read(path)) for path in rest[1:]) - whole).max() / whole.max()
        print("equal" if error < 1e-6 else f"off by {error:.1e}")
    else:
        image, noisy, truth = (light_of(read(path)) for path in rest)
        gain = psnr(image, truth) - psnr(noisy, truth)
        print("less noise" if gain > 10 else f"{gain:.1f} dB")


main(*sys.argv[1:])
