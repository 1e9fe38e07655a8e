"""What JPEGs of radiance lose, to look at: paper_jpeg.py FROM-EXR FROM-JPEG OUT.jpg

A part of both pictures, side by side, and their difference, sRGB-encoded, eight times around middle grey.
"""
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "fidelity", "table"))
import pictures  # noqa: E402

WIDE, HIGH = 400, 300


def main(exr, jpeg, out):
    a, b = (pictures.encoded(pictures.colours(path)) for path in (exr, jpeg))
    # Where the pictures differ most, of parts a hundred pixels apart.
    off = ((a - b) ** 2).sum(-1)
    high, wide = min(HIGH, a.shape[0]), min(WIDE, a.shape[1])
    places = [(y, x) for y in range(0, a.shape[0] - high + 1, 100) for x in range(0, a.shape[1] - wide + 1, 100)]
    y, x = max(places, key=lambda at: off[at[0]:at[0] + high, at[1]:at[1] + wide].sum())
    part = np.s_[y:y + high, x:x + wide]
    pictures.write(out, np.concatenate([a[part], b[part], 0.5 + 8 * (b[part] - a[part])], 1), ("CompressionQuality", 92))


main(*sys.argv[1:])
