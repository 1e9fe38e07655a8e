"""Writes pictures as the tests in Node read them: pixels.py QUESTIONS ANSWERS, two pipes. A question is a line with a
picture, a tab and the output: two numbers of four bytes, the size, then four bytes of each pixel, with alpha 255 where there
is none. The answer is a line."""
import struct
import sys

questions, answers = open(sys.argv[1], encoding="utf-8"), open(sys.argv[2], "wb", buffering=0)

import numpy as np  # noqa: E402 a failure closes the pipes
import OpenImageIO as oiio  # noqa: E402

straight = oiio.ImageSpec()
straight.attribute("oiio:UnassociatedAlpha", 1)  # colours are not multiplied by it
for question in questions:
    picture, output = question.rstrip("\n").split("\t")
    source = oiio.ImageInput.open(picture, straight)
    data = source.read_image(oiio.UINT8)
    source.close()
    if data.shape[2] < 3:
        data = np.repeat(data[:, :, :1], 3, axis=2)
    if data.shape[2] == 3:
        data = np.dstack([data, np.full(data.shape[:2], 255, np.uint8)])
    with open(output, "wb") as file:
        file.write(struct.pack("<II", data.shape[1], data.shape[0]) + data.tobytes())
    answers.write(b"\n")
