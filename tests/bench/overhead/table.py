"""The page of make bench-overhead: table.py RECORDS OUT.csv HEAD SIZE SPP MEMORY_SIZE

Prints what measure.py wrote as Markdown, and writes the figures as CSV.
"""
import csv
import json
import os
import sys
from statistics import mean, median

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import paper as published

ROWS = {
    "plain": "plain picture",
    "footprints": "set, `footprints`",
    "footprints-bare": "set, `footprints`, no denoising data",
    "paper": "set, `paper`",
    "paper-bare": "set, `paper`, no denoising data",
    "initial-biased": "Rousselle, biased: first render",
    "again-biased": "Rousselle, biased: re-render",
    "initial-unbiased": "Rousselle, unbiased: first render",
    "again-unbiased": "Rousselle, unbiased: re-render",
    "again": "plain re-render",
}
SCENES = {"living-room": "scenes/living-room", "artist": "the artist's living room"}

INTRODUCTION = """# What a set costs

This page shows how much more time a render takes if it writes a set and not only the plain picture, as tables 1 to 3 of
the paper do. [overhead.csv](overhead.csv) has the same figures, with their least and largest values.
{head}

Pictures are {size} with {spp} samples per pixel. A figure is that of a whole process, from reading the scene to the
written OpenEXR file. Sets have denoising data unless stated otherwise.

The speed of the machine varies; runs one after the other may differ by a fifth. All processes of a table therefore run
by turns, for a tenth of a second each, so that the speed is the same for all. Times are medians of all rounds, without
the time that a process waited for its turn. The least and largest overhead are in brackets. An overhead is relative to
the mean plain picture of the same round, the paper's "baseline path tracer"; it is the median of all rounds. Wall time
is the time that a user waits. Processor time is the sum of all cores. The plain picture is measured twice: its overhead
is the error of the measurement.
"""
RIVALS = """
"Rousselle" is the method that the paper compares with, as `retex-render` implements it. The first render is one with
`--plain --control-data biased` or `unbiased`. Each change of texture needs a re-render with `--replace ... --control`,
in `--control-mode biased` or `halves`. A set needs no re-render. "Plain re-render" is `--replace` alone: the scene
rendered with new textures. Its overhead is the cost of reading the texture files.
"""


def read(path):
    """Of (part, scene, edit, row), the runs of all rounds."""
    found = {}
    with open(path, encoding="ascii") as file:
        for record in map(json.loads, file):
            key = tuple(record[name] for name in ("part", "scene", "edit", "row"))
            found.setdefault(key, []).append(record)
    return found


class Row:
    def __init__(self, runs, plain):
        def base(number, clock):
            return mean(p[clock] for p in plain if p["round"] == number)
        self.runs = runs
        self.over = {clock: [100 * (r[clock] / base(r["round"], clock) - 1) for r in runs] for clock in ("wall", "cpu")}

    def values(self, name):
        return [r[name] for r in self.runs]

    def speed(self):
        return median(r["paths"] / r["wall"] / 1e6 for r in self.runs)

    def csv(self):
        figures = [f(self.values(clock)) for clock in ("wall", "cpu") for f in (median, min, max)]
        figures += [f(self.over[clock]) for clock in ("wall", "cpu") for f in (median, min, max)]
        return [len(set(self.values("round")))] + [f"{v:.3f}" for v in figures + [self.speed()]] + \
            [max(self.values("peak_memory_bytes")), self.runs[0]["bytes"]]


CSV = ["part", "scene", "targets", "row", "rounds"] + \
    [f"{what}{end}" for what in ("wall_s", "cpu_s", "over_wall_percent", "over_cpu_percent")
     for end in ("", "_min", "_max")] + ["mpaths_per_s", "peak_memory_bytes", "file_bytes"]


def percent(name, row, clock):
    over = row.over[clock]
    spread = f"({min(over):+.1f} .. {max(over):+.1f})"
    return spread if name == "plain" else f"{median(over):+.1f} % {spread}"


def section(scene, edit, rows):
    print(f"\n## {SCENES[scene]}: {' and '.join(edit.split('+'))}\n")
    rounds = len(set(rows["plain"].values("round")))
    print(f"{rounds} rounds.\n" if rounds > 1 else "One round.\n")
    print("| render | wall s | processor s | over plain, wall | processor | Mpaths/s | memory MB | file MB |\n"
          "|---|---|---|---|---|---|---|---|")
    for name, row in rows.items():
        print(f"| {ROWS[name]} | {median(row.values('wall')):.2f} | {median(row.values('cpu')):.2f} |"
              f" {percent(name, row, 'wall')} | {percent(name, row, 'cpu')} | {row.speed():.3f} |"
              f" {max(row.values('peak_memory_bytes')) / 1e6:.0f} | {row.runs[0]['bytes'] / 1e6:.1f} |")


def paper():
    print("\n## The paper's figures\n\nThe Living Room of the paper, 128 samples per pixel, averages of five runs, "
          "relative to its plain path tracer:\n\n"
          "| changed | its set | Rousselle, first render | Rousselle, re-render |\n|---|---|---|---|")
    for edit, (first, again, its_set) in published.OVERHEAD.items():
        name = edit.lower().replace("+", " and ")
        print(f"| {name} | {its_set:.2f} % | {first:.2f} % | {again:.2f} % |")


def memory(found, size):
    rows = {key: runs[0] for key, runs in found.items() if key[0] == "memory"}
    if not rows:
        return
    print(f"\n## Memory\n\nThe peak memory of `scenes/living-room` at {size}, 2 samples per pixel. More samples need a "
          "little more.\nThe memory of the plain picture is that of program and scene.\n")
    print("| render | targets | memory MB | file MB |\n|---|---|---|---|")
    for (_, _, edit, name), run in rows.items():
        targets = "" if name == "plain" else edit.count("+") + 1
        print(f"| {ROWS[name]} | {targets} | {run['peak_memory_bytes'] / 1e6:.0f} | {run['bytes'] / 1e6:.1f} |")


def main(records, table, head, size, spp, memory_size):
    found = read(records)
    print(INTRODUCTION.format(head=head, size=size, spp=spp), end="")
    if any(key[3].startswith(("initial", "again")) for key in found):
        print(RIVALS, end="")
    with open(table, "w", encoding="ascii", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(CSV)
        for scene, edit in dict.fromkeys(key[1:3] for key in found if key[0] == "time"):
            plain = found["time", scene, edit, "plain"]
            rows = {name: Row(found["time", scene, edit, name], plain) for name in ROWS
                    if ("time", scene, edit, name) in found}
            section(scene, edit, rows)
            out.writerows(["time", scene, edit, name, *row.csv()] for name, row in rows.items())
        for key, runs in found.items():
            if key[0] == "memory":
                out.writerow([*key, *Row(runs, runs).csv()])
    paper()
    memory(found, memory_size)


main(*sys.argv[1:])
