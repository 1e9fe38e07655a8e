"""A converged picture from two with noise of their own: truth.py A.exr B.exr OUT.exr

OUT has their mean, as half floats, and in a part `noise` half of what they differ by, per pixel: the root of the mean
square of R, G and B. Both are taken of sRGB-encoded, clipped values, as retex-diff's PSNR is. With T the mean and D half
the difference, (X - A)(X - B) = (X - T)^2 - D^2 for any picture X: its mean is the squared error of X against the picture
without noise, whatever noise A and B have (pictures.py, squares).
"""
import sys

import numpy as np
import OpenImageIO as oiio

import pictures


def write(path, mean, noise):
    parts = [("beauty", ("R", "G", "B"), mean), ("noise", ("Y",), noise[..., np.newaxis])]
    specs = []
    for name, channels, pixels in parts:
        spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], len(channels), "half")
        spec.channelnames = channels
        spec.attribute("oiio:subimagename", name)
        spec.attribute("compression", "zip")
        specs.append(spec)
    file = oiio.ImageOutput.create(path)
    if not file or not file.open(path, specs):
        pictures.fail(f"cannot write {path}: {oiio.geterror()}")
    for number, (_, _, pixels) in enumerate(parts):
        if number and not file.open(path, specs[number], "AppendSubimage"):
            pictures.fail(f"cannot write {path}: {file.geterror()}")
        if not file.write_image(np.ascontiguousarray(pixels, dtype=np.float32)):
            pictures.fail(f"cannot write {path}: {file.geterror()}")
    if not file.close():
        pictures.fail(f"cannot write {path}: {file.geterror()}")


def main(first, second, path):
    a = pictures.encoded(pictures.colours(first))
    b = pictures.encoded(pictures.colours(second, a.shape[:2]))
    write(path, pictures.decoded((a + b) / 2), np.sqrt(((a - b) ** 2).mean(axis=2)) / 2)


if __name__ == "__main__":
    main(*sys.argv[1:])
