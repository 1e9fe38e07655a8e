"""How far the pictures of a scene are from their truths: score.py WORK SCENE TEXTURE... <LIST >CSV

LIST has a line for each kind of picture: method, samples, seed, the folder in WORK, and what the names of its files
have after scene and texture. FLIP and the PSNR of the whole picture are retex-diff's; the PSNR of regions is taken
here, by the same definition, which is checked against retex-diff's. WORK/regions/SCENE.png shows the regions.
"""
import json
import os
import subprocess
import sys

import numpy as np

import pictures
import regions

LEAST = 60  # pixels of a region that counts


def psnr(square):
    mean = square.mean()
    return min(120, -10 * np.log10(mean)) if mean > 0 else 120


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
    print("scene,texture,region,method,samples,seed,psnr,flip")
    for texture in textures:
        truth_path = f"{work}/truth/{scene}-{texture}.exr"
        truth = pictures.encoded(pictures.colours(truth_path, found.shape))
        for method, samples, seed, folder, end in kinds:
            path = f"{work}/{folder}/{scene}-{texture}{end}.exr"
            square = (pictures.encoded(pictures.colours(path, found.shape)) - truth) ** 2
            whole, flip = measured(path, truth_path)
            if abs(psnr(square) - whole) > 0.01:
                pictures.fail(f"{path}: PSNR {psnr(square):.4f} here, {whole:.4f} by retex-diff")
            print(f"{scene},{texture},all,{method},{samples},{seed},{whole:.3f},{flip:.5f}")
            for name, mask in masks.items():
                print(f"{scene},{texture},{name},{method},{samples},{seed},{psnr(square[mask]):.3f},")


main(*sys.argv[1:])
