"""How far pictures of as many samples are from converged ones.

error.py SCENE PICTURES RUNS SAMPLES REFERENCE_SAMPLES RENDERER=REFERENCE...

Each renderer's pictures, PICTURES/RENDERER-SEED.exr, are compared with its own reference; RUNS has the renderers'
speeds. With both renderers, the references must agree in the mean radiance of each region: exit 1 where one does not.
"""
import glob
import sys
from statistics import median

import numpy as np
import OpenImageIO as oiio

import regions
import runs

PERCENTILE = 99


def picture(path):
    file = oiio.ImageInput.open(path)
    if not file:
        sys.exit(f"bench-render: cannot read {path}: {oiio.geterror()}")
    names = [name.split(".")[-1] for name in file.spec().channelnames]
    pixels = np.asarray(file.read_image("float"), np.float64).reshape(file.spec().height, file.spec().width, -1)
    return pixels[..., [names.index(c) for c in "RGB"]]


def errors(pictures, reference, top):
    return [np.mean([((np.minimum(p, t) - np.minimum(reference, t)) ** 2).mean() for p in pictures])
            for t in (np.inf, top)]


def main(scene, work, path, samples, reference_samples, *pairs):
    references = {name: picture(file) for name, file in (pair.split("=", 1) for pair in pairs)}
    taken = {name: [picture(p) for p in sorted(glob.glob(f"{work}/{name}-*.exr"))] for name in references}
    top = np.percentile(np.stack(list(references.values())), PERCENTILE)
    cost, measured = {}, runs.read(path)[scene]
    size = "x".join(map(str, references["retex"].shape[1::-1]))
    print(f"\nequal error: {scene}, {size}, {samples} samples a pixel, {len(taken['retex'])} pictures each, against their "
          f"own converged one of {reference_samples}")
    print(f"  {'':<12}{'MSE':>12}{'clipped':>12}{'wall s':>10}{'cpu s':>10}    clipped at {top:.2f}, the "
          f"{PERCENTILE}th percentile")
    for name, reference in references.items():
        paths = reference.shape[0] * reference.shape[1] * int(samples)
        seconds = [paths * median(getattr(r, clock) / r.paths for r in measured[name]) for clock in ("wall", "cpu")]
        mse = errors(taken[name], reference, top)
        cost[name] = np.outer(mse, seconds).ravel()
        print(f"  {'Cycles' if name == 'cycles' else name:<12}{mse[0]:>12.6f}{mse[1]:>12.6f}{seconds[0]:>10.2f}"
              f"{seconds[1]:>10.2f}")
    if "cycles" not in references:
        return
    ratio = cost["cycles"] / cost["retex"]
    print("  retex / Cycles, 1/(MSE seconds): by wall time {0:.2f}, clipped {2:.2f}; by processor time {1:.2f}, "
          "clipped {3:.2f}".format(*ratio))
    if not regions.compare(scene, references, taken, int(samples) / int(reference_samples)):
        print(f"bench-render: the references of {scene} disagree: speeds of different work are no comparison")
        sys.exit(1)


main(*sys.argv[1:])
