"""For imported-rooms.sh: scores, and the page. WORK ROOMS.txt HEAD SIZE SPP

Errors are mean squares of sRGB-encoded, clipped values, as in retex-diff's PSNR. R1, R2, … are pictures rendered again and A
is the retexture, all with the same number of samples and seeds of their own. The error of rendering again is the mean of
(Ri - Rj)^2 / 2, that of the retexture the mean of (A - Ri)(A - Rj), over all pairs: both are against the mean of infinitely
many such pictures, without its noise."""
import csv
import glob
import os
import sys

import numpy as np

from pictures import colours, decibels, encoded, write

GRID = 6  # regions a side
DARK = 0.02  # regions with a mean below are not compared


def scores(room, texture):
    """Mean squared errors: of the retexture, of rendering again; and how many pictures."""
    again = [encoded(colours(path)) for path in sorted(glob.glob(f"{room}/again-*-{texture}.exr"))]
    made = encoded(colours(f"{room}/retextured-{texture}.exr"))
    n = len(again)
    total, squares = sum(again), sum(np.mean(r * r) for r in again)
    # over pairs i != j: sums of (A - Ri)(A - Rj) = (sum of A - Ri)^2 - sum of (A - Ri)^2
    apart = np.mean((n * made - total)**2) - sum(np.mean((made - r)**2) for r in again)
    spread = (squares - np.mean(total * total) / n) / (n - 1)
    return apart / (n * (n - 1)), spread, n


def regions(room):
    """Relative differences of regions' means from Cycles, or None."""
    if not os.path.exists(f"{room}/cycles.exr"):
        return None
    ours, theirs = colours(f"{room}/plain.exr"), colours(f"{room}/cycles.exr")
    height, width = ours.shape[:2]
    found = []
    for j in range(GRID):
        for i in range(GRID):
            place = np.s_[j * height // GRID:(j + 1) * height // GRID, i * width // GRID:(i + 1) * width // GRID]
            if theirs[place].mean() > DARK:
                found.append(abs(ours[place].mean() / theirs[place].mean() - 1))
    return found


def picture(work, name, room, exposure):
    """Cycles' picture, ours, and both retextures beside each other."""
    files = [f"{room}/{f}.exr" for f in ("cycles", "plain", "retextured-walnut", "retextured-damask")]
    parts = [encoded(colours(f) * exposure) for f in files if os.path.exists(f)]
    write(f"{work}/rooms-{name}.jpg", np.concatenate(parts, axis=1), ("CompressionQuality", 88))


def main(work, table, head, size, spp):
    rows, lines = [], []
    for line in open(table):
        if line.startswith("#") or not line.strip():
            continue
        name, model, _options, source = (part.strip() for part in line.split("|"))
        room = f"{work}/{name}"
        if not glob.glob(f"{room}/again-3-*.exr"):
            continue
        triangles = count_triangles(room, name)
        gains = []
        for texture in ("walnut", "damask"):
            made, again, n = scores(room, texture)
            gains.append(decibels(made) - decibels(again))
            rows.append([name, texture, spp, f"{decibels(again):.2f}", f"{decibels(made):.2f}", f"{gains[-1]:.2f}", n])
        apart = regions(room)
        picture(work, name, room, float(os.environ.get("ROOMS_EXPOSURE", 1)))
        lines.append((name, model, triangles, source, gains, apart, n))
    with open(f"{work}/imported-rooms.csv", "w", newline="") as out:
        csv.writer(out, lineterminator="\n").writerows(
            [["room", "texture", "samples", "again", "retextured", "gain", "pictures"], *rows])
    write_page(work, head, size, spp, rows, lines)


def count_triangles(room, name):
    with open(f"{room}/{name}-meshes.inc") as text:
        return sum(int(line.split("face_indices")[1].strip(" {,\n").split(",")[0]) for line in text
                   if "face_indices" in line and line.split("face_indices")[1].strip(" {,\n"))


def write_page(work, head, size, spp, rows, lines):
    mean = np.mean([float(row[5]) for row in rows])
    with open(f"{work}/imported-rooms.md", "w") as out:
        print(f"# Rooms of other people\n\n{head}\n", file=out)
        print(f"Rooms that `retex-import` made scenes of, {size} pixels, {spp} samples. Each is rendered once as a set with\n"
              "the targets `Floor` and `Wall`, retextured, and rendered again with the same textures: walnut on the\n"
              "floor, and terrazzo on the floor with damask on the wall. The gain is by how many dB the retexture is nearer\n"
              "to the converged picture than rendering again is. The converged picture is not rendered: errors are products\n"
              "of differences from pictures with seeds of their own, whose noise cancels (`tests/fidelity/table/imported-rooms.py`).\n"
              f"The mean gain is {mean:+.2f} dB.\n", file=out)
        print("| room | from | triangles | walnut | terrazzo, damask | regions from Cycles: median, most, within 5 % |\n"
              "|---|---|---|---|---|---|", file=out)
        for name, model, triangles, _source, gains, apart, _n in lines:
            kind = model.rsplit(".", 1)[-1].upper()
            text = "-" if apart is None else (f"{100 * np.median(apart):.1f} %, {100 * max(apart):.1f} %, "
                                              f"{sum(a <= .05 for a in apart)} of {len(apart)}")
            print(f"| {name} | {kind} | {triangles:,} | {gains[0]:+.2f} dB | {gains[1]:+.2f} dB | {text} |", file=out)
        print("\nFrom left to right: Cycles, retex, and the two retextures.\n", file=out)
        for name, _model, _triangles, source, _gains, _apart, _n in lines:
            print(f"**{name}**: {source}\n\n![{name}](pictures/rooms-{name}.jpg)\n", file=out)


if __name__ == "__main__":
    main(*sys.argv[1:])
