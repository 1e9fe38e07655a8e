"""Prints what reference.py reads of the footprints of a folder for browsers, as JSON: classes.py FOLDER. For each class a
list of footprints; each has a list of its pixels, with [pixel, u, v, sigma of u, sigma of v, rho, weight, weight], or of a
footprint with axes [pixel, u, v, du/dx, du/dy, dv/dx, dv/dy, weight, weight]."""
import json
import sys

import numpy as np

import reference

folder = sys.argv[1]
with open(f"{folder}/room.json", encoding="utf-8") as file:
    room = json.load(file)
classes = []
for c in room["classes"]:
    footprints = []
    for present, uv, sigma, rho, weights in reference.read_class(folder, c, room["targets"][c["target"]]["periodic"]):
        spread = [*sigma, rho] if rho is not None else [*sigma[0], *sigma[1]]
        planes = [*uv, *spread, *weights] + [np.zeros(present.shape)] * (2 - len(weights))
        rows = np.stack([np.flatnonzero(present)] + [np.asarray(p, float)[present] for p in planes], axis=1)
        footprints.append(rows.tolist())
    classes.append(footprints)
json.dump(classes, sys.stdout)
