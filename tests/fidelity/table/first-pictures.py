"""For first-pictures.sh: imports rooms without an option, renders and measures them. WORK FOLDER BIN OLD HEAD SPP NAME…

A pixel is lit if its luminance, of the picture as it is shown, lies between 5 and 95 % of the range; a picture, if nine
tenths of its pixels are. Whether a picture is good is what a person found who looked at it, in the list: it shows a
floor and a wall, nothing stands in front, it is level, and it is lit."""
import csv
import os
import shutil
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
from models import FREE, hash_of, read, run, write  # pylint: disable=wrong-import-position

WIDTH, HEIGHT = 320, 240
COLUMNS = 2  # pairs
A_SHEET = 12
SECONDS = 900  # for one program
HALVES = (("blind", "Looked at last"), ("unseen", "Looked at before the last rules"))


def picture(to, programs, model, name, spp):
    """Make TO.png; what was told, seconds of the import and of all, or None in place of them."""
    shutil.rmtree(to, ignore_errors=True)
    code, told, seconds = run(f"{programs}/retex-import", "--partial", "-o", to, model, timeout=SECONDS)
    if code:
        return told, None
    code, failed, rendered = run(f"{programs}/retex-render", "-q", "--size", f"{WIDTH}x{HEIGHT}", "--spp", spp,
                                 "--denoise", f"{to}/{name}.pov", "-o", f"{to}.exr", timeout=SECONDS)
    if not code:
        code, failed, _ = run(f"{programs}/retex-combine", "-q", f"{to}.exr", "-o", f"{to}.png")
    shutil.rmtree(to, ignore_errors=True)
    return (failed, None) if code else (told, (seconds, seconds + rendered))


def lit(path):
    shown = read(path)[:, :, :3] @ (0.2126, 0.7152, 0.0722)
    return np.mean((shown > 0.05) & (shown < 0.95))


def one(work, row, model, programs, old, spp):
    to = f"{work}/{row['name']}"
    told, times = picture(to, programs, model, row["name"], spp)
    row = dict(row, told=told, times=times, lit=lit(f"{to}.png") if times else 0)
    if old and not os.path.exists(f"{to}-old.png"):
        picture(f"{to}-old", old, model, f"{row['name']}-old", spp)
    return row


def black(shape):
    return np.zeros((*shape, 3), np.float32)


def pair(work, name):
    """The picture, at its left that of an older build."""
    of = [f"{work}/{name}{which}.png" for which in ("-old", "")]
    return np.concatenate([read(path)[::2, ::2, :3] if os.path.exists(path) else black((HEIGHT // 2, WIDTH // 2))
                           for path in of], 1)


def sheets(work, rows):
    for k in range(0, len(rows), A_SHEET):
        some = rows[k:k + A_SHEET]
        pairs = [pair(work, row["name"]) for row in some]
        while len(pairs) % COLUMNS:
            pairs.append(black(pairs[0].shape[:2]))
        write(f"{work}/first-pictures-{k // A_SHEET + 1}.jpg", np.concatenate(
            [np.concatenate(pairs[i:i + COLUMNS], 1) for i in range(0, len(pairs), COLUMNS)], 0))
        yield f"first-pictures-{k // A_SHEET + 1}.jpg", [row["name"] for row in some]


def line_of(row):
    if row["times"] is None:
        return f"| {row['name']} | {row['repo']} | {row['licence']} | {int(row['triangles']):,} | | | no | {row['why']} |"
    return (f"| {row['name']} | {row['repo']} | {row['licence']} | {int(row['triangles']):,} | {row['times'][0]:.1f} s | "
            f"{100 * row['lit']:.0f} % | {row['good']} | {row['why']} |")


def write_page(work, head, rows, spp, missing):
    with open(f"{work}/first-pictures.md", "w", encoding="utf-8") as out:
        print(f"# First pictures of rooms of other people\n\n{head}\n", file=out)
        print("Rooms as `retex-import` shows them without an option. A picture is good if a shop would show it: a floor "
              "and a wall are seen, nothing stands in front, it is level, and it is lit, that is, nine tenths of its "
              "pixels lie between 5 and 95 % of the range. These criteria were written down first; a person looked at "
              "each picture. Nobody had seen any of these models while the rules were made, but for what is said below. "
              "The list, with revisions and hashes, is `tests/fidelity/table/first-pictures.csv`; the models are not in "
              f"the repository. Pictures have {WIDTH} x {HEIGHT} pixels and {spp} samples, denoised.\n", file=out)
        for half, title in HALVES:
            own = [row for row in rows if row["half"] == half]
            sources = len({row["repo"] for row in own})
            print(f"## {title}\n\n{len(own)} models of {sources} repositories: {sum(row['good'] == 'yes' for row in own)} "
                  "good.\n\n| model | from | licence | triangles | import | lit | good | |", file=out)
            print("|---|---|---|---|---|---|---|---|", file=out)
            for row in own:
                print(line_of(row), file=out)
            print("", file=out)
        print("## Pictures\n\nOf models whose licence allows it; at the left by the older build, where there is one.\n",
              file=out)
        for path, names in sheets(work, [row for row in rows if FREE.search(row["licence"])]):
            print(f"{', '.join(names)}:\n\n![first pictures](pictures/{path})\n", file=out)
        if missing:
            print(f"Not there when this page was made: {', '.join(missing)}.", file=out)


def find_model(folder, row):
    path = f"{folder}/{row['name']}/{os.path.basename(row['path'])}"
    return path if os.path.exists(path) and hash_of(path) == row["sha256"] else None


def main(work, folder, programs, old, head, spp, *names):
    with open(f"{HERE}/first-pictures.csv", encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if not names or row["name"] in names]
    found, missing = [], []
    for row in rows:
        model = find_model(folder, row)
        if model is None:
            missing.append(row["name"])
            continue
        found.append(one(work, row, model, programs, old, spp))
        times = found[-1]["times"]
        print(f"fidelity-first: {row['name']}: " + (f"import {times[0]:.1f} s, lit {100 * found[-1]['lit']:.0f} %"
                                                   if times else found[-1]["told"]), file=sys.stderr)
    for name in missing:
        print(f"fidelity-first: {name} is not there, or another file", file=sys.stderr)
    write_page(work, head, found, spp, missing)


if __name__ == "__main__":
    main(*sys.argv[1:])
