"""How many shades each hue of a picture has: sheet_hues.py FILE. Greys are no hue. Two colours are shades of one hue if
red and blue are the same parts of green in both, to a hundredth."""

import collections
import sys

import numpy
import OpenImageIO

pixels = OpenImageIO.ImageBuf(sys.argv[1]).get_pixels().reshape(-1, OpenImageIO.ImageBuf(sys.argv[1]).nchannels)[:, :3]
colours = numpy.unique(pixels[pixels[:, 0] != pixels[:, 1]], axis=0)
hues = collections.Counter(tuple(numpy.round(c[[0, 2]] / c[1], 2)) for c in colours)
for count in sorted(hues.values()):
    print(count, "shades of one hue")
