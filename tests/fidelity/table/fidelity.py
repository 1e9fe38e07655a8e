"""The table of `make fidelity` as Markdown: fidelity.py WORK HEAD PART TRUTH-SPP METHODS <CELLS >MD

CELLS has a line for each scene, texture and number of samples. Also writes WORK/fidelity.csv. Errors are of
pictures.squares; an interval is that of pictures.gain: 95 %, over tiles of a picture.
"""
import csv
import sys

import numpy as np

import pictures

COLUMNS = ("footprints", "footprints-8", "paper")


class Cell:
    """PSNR of rendering again, and by method how much better or worse retexturing is, with its interval."""

    def __init__(self, work, scene, texture, samples, methods):
        truth = f"{work}/truth/{scene}-{texture}.exr"
        again = pictures.squares(f"{work}/again/{scene}-{texture}-{samples}.exr", truth)
        self.scene, self.texture, self.samples = scene, texture, samples
        self.psnr = {"again": pictures.psnr(again)}
        self.gap = {}
        for method in methods:
            made = pictures.squares(f"{work}/retextured/{scene}-{texture}-{samples}-{method}.exr", truth)
            self.psnr[method] = pictures.psnr(made)
            self.gap[method] = pictures.gain(made, again)


def mean(cells, method):
    """Of gaps, with its interval: textures of one scene share their paths, so only scenes are independent."""
    scenes = {}
    for cell in cells:
        scenes.setdefault(cell.scene, []).append(cell.gap[method])
    half = np.sqrt(sum((sum(gap[1] for gap in gaps)) ** 2 for gaps in scenes.values())) / len(cells)
    return np.mean([cell.gap[method][0] for cell in cells]), half


def around(value, half):
    return f"{value:+.2f} ± {half:.2f}"


def names(cells, what):
    return list(dict.fromkeys(getattr(cell, what) for cell in cells))


def head_of(cells, first, again):
    columns = [first]
    for samples in names(cells, "samples"):
        columns += [f"again, {samples}"] if again else []
        columns += [f"footprints, {samples}", *COLUMNS[1:]]
    print("| " + " | ".join(columns) + " |\n|" + "---|" * len(columns))


def page(cells, methods, head, part, truth_spp):
    print(f"""# Retexturing compared with rendering again

Each scene was rendered again with new textures. Sets of the same number of samples and the same seed were retextured.
The figures are PSNR in decibels (sRGB-encoded, clipped to 0..1) against converged pictures, two of {truth_spp} samples
each, whose noise does not count. Pictures are parts, {part} pixels, of pictures of 512x384. `gap` is the PSNR of
retexturing minus that of rendering again. Where it is above 0, retexturing gives the better picture, because it filters
textures where rendering samples them. After ± is half of an interval of 95 %, over places in the picture.

In scenes with two targets both change. The scenes are in `scenes/` and `tests/fidelity/scenes/`. The textures are those
of `make fidelity-textures`. [fidelity.csv](fidelity.csv) has the same figures.
{head}

| samples | set | mean gap | worst gap | where |
|---|---|---|---|---|""")
    for samples in names(cells, "samples"):
        those = [cell for cell in cells if cell.samples == samples]
        for method in methods:
            worst = min(those, key=lambda cell: cell.gap[method][0])
            print(f"| {samples} | {method} | {around(*mean(those, method))} dB | {around(*worst.gap[method])} dB "
                  f"| {worst.scene}, {worst.texture} |")
    print("""
`footprints` has the default clusters, 4+2+8 per pixel and target; `footprints-8` has 8 of both kinds together
(`--clusters 8`). `paper-cross-2` leaves out the cross terms of three hits, `paper-cross-0` all cross terms
(`retex-combine --cross`).

Mean gap by scene, and in brackets the mean PSNR of rendering again:
""")
    head_of(cells, "scene", False)
    for scene in names(cells, "scene"):
        line = [scene]
        for samples in names(cells, "samples"):
            those = [cell for cell in cells if (cell.scene, cell.samples) == (scene, samples)]
            again = np.mean([cell.psnr["again"] for cell in those])
            line += [around(*mean(those, method)) + (f" ({again:.1f})" if method == COLUMNS[0] else "") for method in COLUMNS]
        print("| " + " | ".join(line) + " |")
    for scene in names(cells, "scene"):
        print(f"\n## {scene}\n")
        head_of(cells, "texture", True)
        of_scene = [cell for cell in cells if cell.scene == scene]
        for texture in names(of_scene, "texture"):
            line = [texture]
            for cell in of_scene:
                if cell.texture == texture:
                    line += [f"{cell.psnr['again']:.2f}", *(f"{cell.gap[method][0]:+.2f}" for method in COLUMNS)]
            print("| " + " | ".join(line) + " |")


def main(work, head, part, truth_spp, methods):
    methods = methods.split()
    cells = [Cell(work, *line.split(), methods) for line in sys.stdin]
    if not cells:
        pictures.fail("there are no scenes, textures and samples")
    with open(f"{work}/fidelity.csv", "w", newline="", encoding="ascii") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["scene", "texture", "samples", "method", "psnr", "gap", "gap_interval"])
        for cell in cells:
            for method, psnr in cell.psnr.items():
                gap = [f"{value:.3f}" for value in cell.gap.get(method, ())] or ["", ""]
                out.writerow([cell.scene, cell.texture, cell.samples, method, f"{psnr:.3f}", *gap])
    page(cells, methods, head, part, truth_spp)


main(*sys.argv[1:])
