"""Records of a stored form, a JSON object a line: scored.py TRUTHS PICTURES SIZES.json SCENE LAYOUT SET METHOD LEVEL TEXTURE…

PICTURES has set-SCENE-TEXTURE.exr, the set's pictures, and stored-SCENE-TEXTURE.exr, those of its stored form. PSNR is
of one against the other, and of each against the truth, whose noise does not count; null where values are not finite.
"""
import json
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "..", "fidelity", "table"))
import pictures  # noqa: E402


def main(truths, folder, sizes, scene, layout, kind, method, level, *textures):
    with open(sizes, encoding="ascii") as file:
        stored = json.load(file)
    for texture in textures:
        ours, theirs = f"{folder}/set-{scene}-{texture}.exr", f"{folder}/stored-{scene}-{texture}.exr"
        record = {"scene": scene, "layout": layout, "set": kind, "method": method, "level": level, "texture": texture,
                  "psnr": None, "truth": None, "set_truth": None, "stored": stored}
        if np.isfinite(pictures.parts(theirs)[""]).all():
            made, real = (pictures.encoded(pictures.colours(path)) for path in (theirs, ours))
            truth = f"{truths}/{scene}-{texture}.exr"
            record["psnr"] = pictures.decibels(((made - real) ** 2).mean())
            record["truth"], record["set_truth"] = (pictures.psnr(pictures.squares(path, truth))
                                                    for path in (theirs, ours))
        print(json.dumps(record))


main(*sys.argv[1:])
