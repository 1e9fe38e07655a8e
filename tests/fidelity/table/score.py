"""How far the pictures of a scene are from their truths: score.py WORK SCENE TEXTURE... <LIST >CSV

LIST has a line for each kind of picture: method, samples, seed, the folder in WORK, and what the names of its files
have after scene and texture. The last column is half the interval of 95 % of the gain over the first line's picture
(pictures.gain). FLIP is retex-diff's; squared errors are pictures.squares, whose definition is checked against
retex-diff's PSNR. WORK/regions/SCENE.png shows the regions.
"""
import json
import os
import subprocess
import sys

import numpy as np

import pictures
import regions

LEAST = 60  # pixels of a region that counts


def measured(path, truth):
    """PSNR and mean of FLIP, by retex-diff, which exits with 1 where pictures differ."""
    run = subprocess.run(["retex-diff", "--json", path, truth], stdout=subprocess.PIPE, check=False)
    if run.returncode not in (0, 1):
        pictures.fail(f"retex-diff {path} {truth} failed")
    figures = json.loads(run.stdout)
    return figures["psnr"], figures["flip_mean"]


def main(work, scene, *textures):
    found = regions.of_scene(work, scene)
    os.makedirs(f"{work}/regions", exist_ok=True)
    regions.paint(found, f"{work}/regions/{scene}.png")
    masks = {name: found == k for k, name in enumerate(regions.NAMES)}
    masks = {name: mask for name, mask in masks.items() if mask.sum() >= LEAST}
    kinds = [line.split() for line in sys.stdin]
    if not kinds or not textures or any(len(kind) != 5 for kind in kinds):
        pictures.fail("score.py wants textures, and lines of method, samples, seed, folder and end of name")
    print("scene,texture,region,method,samples,seed,psnr,flip,gain_interval")
    for texture in textures:
        truth, first = f"{work}/truth/{scene}-{texture}.exr", None
        noise = (pictures.parts(truth)["noise"] ** 2).mean()
        for method, samples, seed, folder, end in kinds:
            path = f"{work}/{folder}/{scene}-{texture}{end}.exr"
            square = pictures.squares(path, truth)
            first = square if first is None else first
            whole, flip = measured(path, truth)
            if abs(pictures.decibels(square.mean() + noise) - whole) > 0.01:
                pictures.fail(f"{path}: PSNR {pictures.decibels(square.mean() + noise):.4f} here, {whole:.4f} by retex-diff")
            for name, mask in {"all": np.full(found.shape, True), **masks}.items():
                interval = pictures.gain(square, first, mask)[1]
                print(f"{scene},{texture},{name},{method},{samples},{seed},{pictures.psnr(square[mask]):.3f},"
                      f"{f'{flip:.5f}' if name == 'all' else ''},{interval:.3f}")


main(*sys.argv[1:])
