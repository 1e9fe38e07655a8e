"""The page of make bench-scale: page.py RECORDS OUT.csv HEAD SIZE SPP SIZES_SPP

Prints what measure.py of bench-overhead wrote as Markdown, and writes the figures as CSV.
"""
import csv
import json
import sys
from statistics import median

COLUMNS = ["series", "at", "render", "turns", "us_per_path", "us_per_path_min", "us_per_path_max", "rays_per_path",
           "reading_s", "peak_memory_bytes", "file_bytes"]
TITLES = {
    "triangles": ("Triangles", "triangles", "Twelve bumpy balls in a room, without instances."),
    "lights": ("Lights: emitting spheres", "lights", "Small spheres below the ceiling. "
               "Their total power is the same in all rows."),
    "points": ("Lights: light sources", "lights", "`light_source`s in the places of the spheres."),
    "targets": ("Targets", "targets", "Back wall, floor, balls, left and right wall, ceiling, table and front wall are "
                "added one after the other.\nEight targets are the whole scene."),
    "resolution": ("Resolution", "size", "With {sizes_spp} samples per pixel. "
                   "With fewer samples, writing takes a larger part of the time."),
}
LIMIT = 8e9

INTRODUCTION = """# How costs grow

This page shows how the cost of a path grows with a scene or picture, for the plain picture and for a set. The cost is
processor time in microseconds. What a catalogue of many pictures costs is in [catalogues.md](catalogues.md).
{head}
Each figure is the median of {turns}, with the least and largest in brackets.
[scale.csv](scale.csv) has the same figures.

The scene is a room of 100,000 triangles with one lamp. Each table varies one property. The set has one target, the back
wall, which covers two fifths of the picture. Pictures are {size} with {spp} samples per pixel unless stated otherwise.

The time is that of the process after it has read and prepared the scene, including writing the file. The column
"reading" is the time before that. Sets are compared with plain pictures of the same turn. Rays are those of the plain
picture, including shadow rays.

![](pictures/scale.png)
"""


def read(path):
    """Of (series, at, render), the runs by turn."""
    found = {}
    with open(path, encoding="ascii") as file:
        for r in map(json.loads, file):
            found.setdefault((r["series"], r["at"], r["render"]), {})[r["turn"]] = r
    return found


def points(found):
    """Rows of the CSV, as dictionaries."""
    for (series, at, render), runs in found.items():
        if series == "large":
            continue
        by_turn = {turn: (r["cpu"] - r["reading_cpu"]) / r["paths"] * 1e6 for turn, r in runs.items()}
        costs = list(by_turn.values())
        some = next(iter(runs.values()))
        figures = [series, at, render, len(costs), median(costs), min(costs), max(costs),
                   (some["segments"] + some["shadow_rays"]) / some["paths"],
                   median(r["reading_cpu"] for r in runs.values()),
                   max(r["peak_memory_bytes"] for r in runs.values()), some["bytes"]]
        yield dict(zip(COLUMNS, figures), by_turn=by_turn)


def cell(row):
    if row is None:
        return " |"
    return f" {row['us_per_path']:.2f} ({row['us_per_path_min']:.2f} .. {row['us_per_path_max']:.2f}) |"


def section(series, rows, sizes_spp):
    title, unit, text = TITLES[series]
    print(f"\n## {title}\n\n{text.format(sizes_spp=sizes_spp)}\n")
    print(f"| {unit} | plain, us per path | set | set / plain | rays per path | reading, s |"
          " memory, MB: plain | set |\n"
          "|---|---|---|---|---|---|---|---|")
    by = {(r["at"], r["render"]): r for r in rows}
    for at in dict.fromkeys(r["at"] for r in rows):
        plain, made = by.get((at, "plain")), by.get((at, "set"))
        against = plain or by["0", "plain"]
        ratio = ""
        if made:
            ratio = f"{median(made['by_turn'][t] / cost for t, cost in against['by_turn'].items()):.3f}"
        memory = [f"{r['peak_memory_bytes'] / 1e6:.0f}" if r else "" for r in (plain, made)]
        name = f"{int(at):,}" if at.isdigit() else at
        print(f"| {name} |{cell(plain)}{cell(made)} {ratio} | {against['rays_per_path']:.2f} |"
              f" {against['reading_s']:.2f} | {memory[0]} | {memory[1]} |")


def large(found):
    for (series, at, _), runs in found.items():
        if series != "large":
            continue
        print(f"\n## A large set\n\n`scenes/living-room` at {at}, one target, `--clusters 8`, 4 samples per pixel: ",
              end="")
        run = next(iter(runs.values()))
        if run["status"]:
            print("not rendered.")
            return
        peak = run["peak_memory_bytes"]
        than = "less" if peak < LIMIT else "more"
        print(f"the peak memory is {peak / 1e9:.2f} GB,\n{than} than the {LIMIT / 1e9:.0f} GB of a "
              f"small machine. The file has {run['bytes'] / 1e9:.2f} GB.")


def main(records, table, head, size, spp, sizes_spp):
    found = read(records)
    rows = list(points(found))
    turns = max((r["turns"] for r in rows), default=1)
    turns = f"{turns} turns" if turns > 1 else "one turn"
    print(INTRODUCTION.format(head=head, size=size, spp=spp, turns=turns), end="")
    with open(table, "w", encoding="ascii", newline="") as file:
        out = csv.DictWriter(file, COLUMNS, extrasaction="ignore", lineterminator="\n")
        out.writeheader()
        out.writerows({k: f"{v:.4g}" if isinstance(v, float) else v for k, v in r.items()} for r in rows)
    for series in dict.fromkeys(r["series"] for r in rows):
        section(series, [r for r in rows if r["series"] == series], sizes_spp)
    large(found)


main(*sys.argv[1:])
