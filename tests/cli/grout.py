"""For grout.t: the PSNR of pictures of a floor in even light, laid with tiles of one colour, against numpy, which looks up 16 x
16 points in each pixel: grout.py CAMERA WIDTH,HEIGHT GROUT REPEAT LEAST PICTURE... Prints those below LEAST dB."""
import sys

import numpy as np
import OpenImageIO as oiio

TILE, JOINT, N = np.array([.6, .3, .1]), np.array([.05, .05, .05]), 16
camera, size, grout, repeat, least, *pictures = sys.argv[1:]
(width, height), grout = map(float, size.split(',')), float(grout)


def read(name):
    return oiio.ImageInput.open(name).read_image(format='float')[..., :3]


def is_joint(u, v):
    """Of places in scene units."""
    across, up = width + grout, height + grout
    row = np.floor(v / up)
    if repeat == 'brick':
        u = u + across / 2 * (row % 2)
    return (u % across >= width) | (v - row * up >= height)


def encoded(a):
    a = np.clip(a, 0, 1)
    return np.where(a <= .0031308, 12.92 * a, 1.055 * np.maximum(a, 1e-9) ** (1 / 2.4) - .055)


seen = read(pictures[0])
high, wide = seen.shape[:2]
eye, at = {'above': ((.1, 1.5, .3), (.1, 0, .3001)), 'low': ((.1, .35, -1), (.1, .1, .3))}[camera]
eye = np.array(eye)
forward = (np.array(at) - eye) / np.linalg.norm(np.array(at) - eye)
right = np.cross([0, 1, 0], forward)
right /= np.linalg.norm(right)
upward, half = np.cross(forward, right), np.tan(np.radians(30))
total, whole = np.zeros((high, wide, 3)), np.ones((high, wide), bool)
for j in range(N):
    for i in range(N):
        x, y = 2 * (np.arange(wide) + (i + .5) / N) / wide - 1, 1 - 2 * (np.arange(high) + (j + .5) / N) / high
        ray = forward + half * x[None, :, None] * right + half * high / wide * y[:, None, None] * upward
        place = eye - ray * (eye[1] / ray[..., 1:2])
        whole &= (ray[..., 1] < 0) & (np.abs(place[..., 0]) < 3) & (np.abs(place[..., 2]) < 3)
        total += np.where(is_joint(place[..., 0] + 3, place[..., 2] + 3)[..., None], JOINT, TILE)
for name in pictures:
    error = (encoded(read(name)) - encoded(total / N ** 2))[whole]
    psnr = -10 * np.log10(np.mean(error ** 2))
    if not psnr >= float(least):
        print(f'{name} {camera} {width} {height} {grout} {repeat}: {psnr:.1f} dB')
