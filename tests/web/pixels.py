"""Writes pictures as the tests in Node read them: pixels.py PICTURE OUTPUT [PICTURE OUTPUT]... Two numbers of four bytes,
the size, then four bytes of each pixel, with alpha 255 where there is none."""
import struct
import sys

import numpy as np
import OpenImageIO as oiio

straight = oiio.ImageSpec()
straight.attribute("oiio:UnassociatedAlpha", 1)  # colours are not multiplied by it
for picture, output in zip(sys.argv[1::2], sys.argv[2::2]):
    source = oiio.ImageInput.open(picture, straight)
    data = source.read_image(oiio.UINT8)
    source.close()
    if data.shape[2] < 3:
        data = np.repeat(data[:, :, :1], 3, axis=2)
    if data.shape[2] == 3:
        data = np.dstack([data, np.full(data.shape[:2], 255, np.uint8)])
    with open(output, "wb") as file:
        file.write(struct.pack("<II", data.shape[1], data.shape[0]) + data.tobytes())
