"""How far pictures of as many samples are from converged ones: error.py WORK RUNS SAMPLES RENDERER=REFERENCE...

Each renderer's pictures, WORK/RENDERER-SEED.exr, are compared with its own reference. With both renderers, the
references must agree in the mean radiance of each wall of the Cornell box: exit 1 where one is off by more than 1 %.
"""
import glob
import sys
from statistics import median

import numpy as np
import OpenImageIO as oiio

import runs

PERCENTILE, LIMIT = 99, 0.01
EYE, HALF_ANGLE = 3.9, 20
MARGIN = 0.12                                                 # of a wall's edges
BALLS, NEAR = [(-0.4, -0.6, 0.3), (0.4, -0.6, -0.2)], 0.55    # their radius is 0.4


def picture(path):
    file = oiio.ImageInput.open(path)
    if not file:
        sys.exit(f"bench-render: cannot read {path}: {oiio.geterror()}")
    names = [name.split(".")[-1] for name in file.spec().channelnames]
    pixels = np.asarray(file.read_image("float"), np.float64).reshape(file.spec().height, file.spec().width, -1)
    return pixels[..., [names.index(c) for c in "RGB"]]


def walls(size):
    """Masks of what the camera sees of each, away from edges, balls and lamp. Here y is up and z into the picture."""
    at = (np.arange(size) + 0.5) / size * 2 - 1
    x, y = np.meshgrid(at, -at)
    ray = np.stack([x, y, np.full_like(x, 1 / np.tan(np.radians(HALF_ANGLE)))], -1)
    ray /= np.linalg.norm(ray, axis=-1, keepdims=True)
    eye, clear = np.array([0, 0, -EYE]), np.ones_like(x, bool)
    for ball in BALLS:
        to = np.array(ball) - eye
        clear &= np.linalg.norm(np.cross(np.broadcast_to(to, ray.shape), ray), axis=-1) > NEAR
    planes = {"floor": (1, -1), "ceiling": (1, 1), "back": (2, 1), "left": (0, -1), "right": (0, 1)}
    found = {}
    for name, (axis, where) in planes.items():
        with np.errstate(divide="ignore"):
            t = (where - eye[axis]) / ray[..., axis]
        hit = eye + t[..., None] * ray
        inside = (np.abs(np.delete(hit, axis, -1)) < 1 - MARGIN).all(-1)
        lamp = (np.abs(hit[..., [0, 2]]) < 0.45).all(-1) & (name == "ceiling")
        found[name] = (t > 0) & inside & clear & ~lamp
    return found


def regions(references, again):
    """again: retex's new pictures, which show whether a renderer that changed still has the mean of its reference."""
    print(f"\nmean radiance of converged pictures, and of {len(again)} new ones of retex")
    print(f"  {'':<12}{'pixels':>10}{'retex':>10}{'Cycles':>10}{'off by':>10}{'new ones':>10}")
    agree = True
    new = np.mean(again, axis=0)
    for name, mask in walls(len(new)).items():
        ours, theirs, now = (p[mask].mean() for p in (references["retex"], references["cycles"], new))
        good = abs(ours / theirs - 1) <= LIMIT
        agree &= good
        print(f"  {name:<12}{mask.sum():>10}{ours:>10.4f}{theirs:>10.4f}{100 * (ours / theirs - 1):>+9.2f}%"
              f"{100 * (now / theirs - 1):>+9.2f}%{'' if good else '  more than 1 %'}")
    return agree


def errors(pictures, reference, top):
    return [np.mean([((np.minimum(p, t) - np.minimum(reference, t)) ** 2).mean() for p in pictures])
            for t in (np.inf, top)]


def main(work, path, samples, *pairs):
    references = {name: picture(file) for name, file in (pair.split("=", 1) for pair in pairs)}
    taken = {name: [picture(p) for p in sorted(glob.glob(f"{work}/{name}-*.exr"))] for name in references}
    top = np.percentile(np.stack(list(references.values())), PERCENTILE)
    cost, measured = {}, runs.read(path)["cornell"]
    print(f"\nequal error: cornell, {samples} samples a pixel, {len(taken['retex'])} pictures each, against their own "
          "converged one")
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
    if not regions(references, taken["retex"]):
        print("bench-render: the references disagree: speeds of different work are no comparison")
        sys.exit(1)


main(*sys.argv[1:])
