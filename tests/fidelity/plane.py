"""A checker on the plane of plane.sh: its texture, and its exact picture.

plane.py texture OUT.png TEXELS: eight squares along each side.
plane.py picture OUT.exr WIDTH HEIGHT TEXELS LIGHT: the texture, interpolated between the middles of its texels and repeated
with x and z, turned by 17 degrees; each pixel is the mean over a grid of points, times LIGHT."""
import sys

import numpy as np
import OpenImageIO as oiio

GRID, SQUARES = 32, 8
HEIGHT_OF_CAMERA, TILT, ANGLE, TURN = 1.0, np.radians(30), np.radians(40), np.radians(17)


def checker(texels):
    square = np.arange(texels) * SQUARES // texels
    return (square[:, None] + square[None, :]) % 2


def interpolated(image, u, v):
    size = image.shape[0]
    x, y = u * size - 0.5, (1 - v) * size - 0.5
    x0, y0 = np.floor(x).astype(int), np.floor(y).astype(int)
    fx, fy = x - x0, y - y0
    at = lambda i, j: image[(y0 + j) % size, (x0 + i) % size]
    return (at(0, 0) * (1 - fx) + at(1, 0) * fx) * (1 - fy) + (at(0, 1) * (1 - fx) + at(1, 1) * fx) * fy


def exact(width, height, texels, light):
    image, picture = checker(texels).astype(float), np.zeros((height, width, 3), np.float32)
    half, inside = np.tan(ANGLE / 2), (np.arange(GRID) + 0.5) / GRID
    right = ((np.arange(width)[:, None] + inside).ravel() / width * 2 - 1) * half
    for row in range(height):
        up = (1 - (row + inside) / height * 2) * half * height / width
        down, forward = np.sin(TILT) - up * np.cos(TILT), np.cos(TILT) + up * np.sin(TILT)
        far = (HEIGHT_OF_CAMERA / down)[:, None]
        x, z = far * right[None, :], far * forward[:, None]
        u, v = np.cos(TURN) * x - np.sin(TURN) * z, np.sin(TURN) * x + np.cos(TURN) * z
        picture[row] = light * interpolated(image, u, v).reshape(GRID, width, GRID).mean(axis=(0, 2))[:, None]
    return picture


def write(path, pixels, kind):
    file = oiio.ImageOutput.create(path)
    if not file or not file.open(path, oiio.ImageSpec(pixels.shape[1], pixels.shape[0], 3, kind)):
        raise SystemExit(f"{path} cannot be written")
    file.write_image(np.ascontiguousarray(pixels))
    file.close()


if sys.argv[1] == "texture":
    write(sys.argv[2], np.repeat((255 * checker(int(sys.argv[3]))).astype(np.uint8)[:, :, None], 3, axis=2), "uint8")
else:
    write(sys.argv[2], exact(*map(int, sys.argv[3:6]), float(sys.argv[6])), "float")
