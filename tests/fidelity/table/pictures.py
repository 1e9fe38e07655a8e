"""Pictures as arrays, for the tables of fidelity."""
import sys

import numpy as np
import OpenImageIO as oiio


def fail(text):
    sys.exit("fidelity: " + text)


def parts(path):
    """All parts of an EXR by name, each height x width x channels, float."""
    file = oiio.ImageInput.open(path)
    if not file:
        fail(f"cannot read {path}: {oiio.geterror()}")
    found, index = {}, 0
    while file.seek_subimage(index, 0):
        spec = file.spec()
        pixels = file.read_image(index, 0, 0, spec.nchannels, "float")
        if pixels is None:
            fail(f"cannot read {path}: {file.geterror()}")
        name = spec.get_string_attribute("oiio:subimagename") or "beauty"
        found[name] = np.asarray(pixels, dtype=np.float64).reshape(spec.height, spec.width, spec.nchannels)
        if index == 0:
            found[""] = found[name]
            if list(spec.channelnames[:3]) != ["R", "G", "B"]:
                fail(f"{path}: its channels are {spec.channelnames}, not R, G, B")
        index += 1
    file.close()
    return found


def colours(path, shape=None):
    """A picture's R, G, B; of that height and width, and finite, or it is an error."""
    picture = parts(path)[""][..., :3]
    if shape and picture.shape[:2] != shape:
        fail(f"{path} is {picture.shape[1]} x {picture.shape[0]} pixels, not {shape[1]} x {shape[0]}")
    if not np.isfinite(picture).all():
        fail(f"{path} has values that are not finite")
    return picture


def encoded(picture):
    """sRGB-encoded and clipped to 0..1, as retex-diff does before it takes the PSNR."""
    x = np.clip(picture, 0, 1)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.maximum(x, 1e-9) ** (1 / 2.4) - 0.055)


def decoded(picture):
    """What has these sRGB-encoded values."""
    return np.where(picture <= 0.04045, picture / 12.92, ((picture + 0.055) / 1.055) ** 2.4)


def squares(path, truth):
    """By pixel, the squared error of a picture against a file of truth.py, whose noise is taken out of the mean."""
    found = parts(truth)
    if "noise" not in found:
        fail(f"{truth} has no part noise: truth.py makes such files")
    real = encoded(found[""][..., :3])
    return ((encoded(colours(path, real.shape[:2])) - real) ** 2).mean(axis=2) - found["noise"][..., 0] ** 2


def decibels(square):
    """PSNR of a mean squared error, at most 120."""
    return -10 * np.log10(max(square, 1e-12))


def psnr(square):
    """Of squared errors of pixels. What is less than their mean is known to is taken for that, for the noise of a truth
    may leave nothing, or less."""
    return decibels(max(square.mean(), square.std() / np.sqrt(square.size)))


TILE = 8  # pixels a side


def tiles(image, mask=None):
    """Sums over tiles of the picture, of pixels in the mask."""
    image = image if mask is None else np.where(mask, image, 0)
    height, width = image.shape
    image = np.pad(image, ((0, -height % TILE), (0, -width % TILE)))
    return image.reshape(image.shape[0] // TILE, TILE, -1, TILE).sum(axis=(1, 3)).ravel()


def gain(made, other, mask=None):
    """By how many dB the first squares are less than the others, and its 95 % interval: half its width.

    The interval is the jackknife's over tiles: what another place in the picture, or another seed, would have given."""
    a, b = tiles(made, mask), tiles(other, mask)
    least_a, least_b = (np.sqrt(x.size) * x.std() for x in (a, b))

    def over(x, y):
        return decibels(max(x, least_a)) - decibels(max(y, least_b))

    whole = over(a.sum(), b.sum())
    less = [over(a.sum() - x, b.sum() - y) for x, y in zip(a, b) if x or y]
    n = len(less)
    return whole, 1.96 * np.sqrt((n - 1) / n * np.sum((np.array(less) - np.mean(less)) ** 2)) if n > 1 else 0.0


def write(path, picture, *attributes):
    """Values of 0..1 as 8 bits."""
    pixels = np.ascontiguousarray(np.clip(picture * 255 + 0.5, 0, 255).astype(np.uint8))
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], "uint8")
    for name, value in attributes:
        spec.attribute(name, value)
    file = oiio.ImageOutput.create(path)
    if not file or not file.open(path, spec) or not file.write_image(pixels) or not file.close():
        fail(f"cannot write {path}: {oiio.geterror() if not file else file.geterror()}")
