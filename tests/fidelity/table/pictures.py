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


def write(path, picture, *attributes):
    """Values of 0..1 as 8 bits."""
    pixels = np.ascontiguousarray(np.clip(picture * 255 + 0.5, 0, 255).astype(np.uint8))
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], "uint8")
    for name, value in attributes:
        spec.attribute(name, value)
    file = oiio.ImageOutput.create(path)
    if not file or not file.open(path, spec) or not file.write_image(pixels) or not file.close():
        fail(f"cannot write {path}: {oiio.geterror() if not file else file.geterror()}")
