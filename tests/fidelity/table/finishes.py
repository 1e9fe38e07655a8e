"""Finishes chosen after rendering, as Markdown: finishes.py WORK HEAD SETTINGS SCENES FINISHES >MD

Also writes WORK/finishes.csv, and WORK/finishes-room.jpg: each finish of the living room above its new render.
Errors are those of pictures.squares.
"""
import csv
import sys

import numpy as np

import pictures

METHODS = ("own", "set", "denoised")
COSTS = ("none", "three", "six")


def numbers(path):
    with open(path, encoding="ascii") as file:
        return [float(word) for word in file.read().split()]


def seconds(path):
    return sum(numbers(path)[:2])


def score(work, scenes, finishes):
    """By scene and finish: squared errors, and the time of a set of its own and of its part of the one set."""
    rows = []
    for scene in scenes:
        for finish in finishes:
            name = f"{work}/{scene}-{finish}"
            truth = f"{work}/truth/finishes-{scene}-{finish}.exr"
            rows.append((scene, finish, {m: pictures.squares(f"{name}-{m}.exr", truth).mean() for m in METHODS},
                         seconds(f"{name}-own-time")))
    return rows


def equal_error(rows, scene, whole):
    """How many times as long the renders of their own take, as the one set does until its worst finish is as good."""
    own = [row for row in rows if row[0] == scene]
    worst = max(found["set"] / found["own"] for _, _, found, _ in own)
    return sum(time for *_, time in own) / (whole * worst)


def show_pictures(work, finishes):
    columns = []
    for finish in finishes:
        pair = [pictures.encoded(pictures.colours(f"{work}/picture-{finish}-{kind}.exr")) for kind in ("ours", "new")]
        columns.append(np.vstack([pair[0], np.ones((4, pair[0].shape[1], 3)), pair[1]]))
    gap = np.ones((columns[0].shape[0], 4, 3))
    halves = [np.hstack([columns[k], gap, columns[k + 1]]) for k in (0, 2)]
    for half, name in zip(halves, ("matt", "shiny")):
        pictures.write(f"{work}/finishes-{name}.jpg", half)


def costs(work):
    found = {}
    for kind in COSTS:
        name = f"{work}/costs-{kind}"
        found[kind] = {"EXR": numbers(f"{name}.exr-bytes")[0] / 1e6,
                       "EXR, denoised": numbers(f"{name}.denoised-bytes")[0] / 1e6,
                       "pack": numbers(f"{name}.pack-bytes")[0] / 1e6,
                       "render": seconds(f"{name}.render-time"), "denoise": seconds(f"{name}.denoise-time"),
                       "pack time": seconds(f"{name}.pack-time"),
                       "combine from EXR": seconds(f"{name}-denoised.exr.combine-time"),
                       "combine from pack": seconds(f"{name}.retex.combine-time")}
    return found


def write_csv(work, rows, gains, sizes):
    with open(f"{work}/finishes.csv", "w", encoding="ascii", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(("subject", "name", "figure", "value"))
        for scene, finish, found, _ in rows:
            for method in METHODS:
                out.writerow((scene, finish, f"psnr {method}", f"{pictures.decibels(found[method]):.3f}"))
        for scene, gain in gains.items():
            out.writerow((scene, "all", "equal error", f"{gain:.2f}"))
        for kind in COSTS:
            for key, value in sizes[kind].items():
                out.writerow(("costs", kind, key, f"{value:.3f}"))
                out.writerow(("costs", kind, f"{key} ratio", f"{value / sizes['none'][key]:.3f}"))


def main():
    work, head, settings, scenes, finishes = sys.argv[1:]
    spp, truth_spp, _, _, size, size_spp = settings.split()
    scenes, finishes = scenes.split(), finishes.split(",")
    rows, sizes = score(work, scenes, finishes), costs(work)
    gains = {scene: equal_error(rows, scene, seconds(f"{work}/{scene}-time")) for scene in scenes}
    write_csv(work, rows, gains, sizes)
    show_pictures(work, finishes)
    print(f"""# Finishes after rendering

A finish says how a surface reflects: matt, satin, polished, metal. `retex-render --finish` follows several finishes of a
target along the same paths; which one a picture has is chosen later, together with any texture and lamp:

    retex-render --finish Floor=original,satin,polished,metal -t Floor -t Wall --denoise \\
        scenes/living-room/living-room.pov -o room.exr
    retex-combine room.exr --finish Floor=polished --texture Floor=scenes/textures/walnut-herringbone.jpg -o polished.jpg

A finish is one that the scene declares, or built in; `retex-render --list-finishes SCENE.pov` has the names. With several
targets, each combination of their finishes can be chosen, up to eight. The picture with each is unbiased: it is what the
edited scene renders to, in the mirrored wall, the caustic and the colour that the floor throws on the wall, too.

{head}

## The living room

The floor as it is and satin, then polished and metal, all with a walnut floor. Above from one set, 64 samples, denoised;
below rendered so, 256 samples, not denoised, so that noise is left in it.

![as it is, and satin](pictures/finishes-matt.jpg)

![polished, and metal](pictures/finishes-shiny.jpg)

## Compared with renders of their own

PSNR against converged pictures, two of {truth_spp} samples each, whose noise does not count. `own`: a set of that finish
alone, `set`: one set of all four, each with {spp} samples a pixel; `denoised`: that one, denoised.

| scene | floor | own | set | set over own | denoised |
|---|---|---|---|---|---|""")
    for scene, finish, found, _ in rows:
        own, one, clean = (pictures.decibels(found[m]) for m in METHODS)
        print(f"| {scene} | {finish} | {own:.2f} | {one:.2f} | {one - own:+.2f} | {clean:.2f} |")
    print("""
Directions are drawn from the mixture of all finishes, so each has fewer samples where it reflects narrowly: a mirror
among four finishes has a quarter of them. Until the worst finish of the one set is as good as in a set of its own, the
four sets of their own take, of the time of the one,
""")
    for scene in scenes:
        print(f"- {gains[scene]:.2f} times in {scene}.")
    print(f"""
## Bytes and times

The living room, {size}, {size_spp} samples, targets `Floor` and `Wall`: without finishes, with three of the floor, and with
three of the floor and two of the wall, which are six combinations; in parentheses times what it is without. Times are
processor seconds. `combine` is with another floor and, where there are any, another finish, by one thread.

| | none | three | six |
|---|---|---|---|""")
    for key in sizes["none"]:
        unit = "MB" if key in ("EXR", "EXR, denoised", "pack") else "s"
        cells = " | ".join(f"{sizes[kind][key]:.{2 if sizes[kind][key] < 10 else 0}f} {unit}"
                           f" ({sizes[kind][key] / sizes['none'][key]:.2f})" for kind in COSTS)
        print(f"| {key} | {cells} |")
    print("""
## How it works

- Each finish of a target is a BSDF. A direction is sampled from the mixture of all, in which each has the same share;
  the weight of each finish is its BSDF over the density of the mixture. So one path is a sample of the picture with each
  finish, as in multiple importance sampling with the balance heuristic.
- A choice of a finish for every target is a combination. A path carries its throughput in each combination, and hits
  know what each finish does to light that comes from beyond them.
- A set keeps light by combination as it keeps that of lamps, for the value 1 of a parameter; light of paths that met no
  target with several finishes is kept once. Clusters and shares are those of the mean over all combinations.
- A path that meets a target again meets the same finish.

## Limits

- A [map of finishes](finish-maps.md) says which is where; its weights count at a path's first hit on the target.
- A finish that emits light, lets it through or below the surface is refused, and so is a target that does.
- Bumps stay as they are, and so does what the pigment's alpha cuts out.
- A target's finish and the textures of other targets that keep their originals: their mean albedos are multiplied, as
  for lamps; there are no corrections, which would be of the mean of all finishes. With constant textures on all targets
  a picture is exact.""")


if __name__ == "__main__":
    main()
