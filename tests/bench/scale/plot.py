"""The figure of make bench-scale: plot.py SCALE.csv OUT.png"""
import csv
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

COLOURS, MARKS = {"plain": "#555555", "set": "#0060b0"}, {"plain": "o", "set": "s"}
PANELS = [("triangles", "triangles"), ("lights", "lights"), ("targets", "targets"), ("resolution", "picture, pixels")]


def line(axes, rows, render, label, dashed=False):
    rows = [r for r in rows if r["render"] == render]
    if not rows:
        return
    at = [pixels(r["at"]) for r in rows]
    cost, low, high = ([float(r["us_per_path" + end]) for r in rows] for end in ("", "_min", "_max"))
    axes.errorbar(at, cost, [[c - v for c, v in zip(cost, low)], [v - c for c, v in zip(cost, high)]], label=label,
                  color=COLOURS[render], marker=MARKS[render], markersize=4, capsize=2, linewidth=1.2, elinewidth=0.8,
                  linestyle="--" if dashed else "-", markerfacecolor="white" if dashed else COLOURS[render])


def pixels(at):
    wide, _, high = at.partition("x")
    return int(wide) * int(high or 1)


def panel(axes, rows, series, name):
    these = [r for r in rows if r["series"] == series]
    if series == "targets":
        plain = [dict(r, at="0") for r in these if r["render"] == "plain"]
        line(axes, plain, "plain", "plain picture")
        axes.set_xticks(range(9))
    else:
        axes.set_xscale("log")
        line(axes, these, "plain", "plain, spheres" if series == "lights" else "plain picture")
    line(axes, these, "set", {"lights": "set, spheres", "targets": "set"}.get(series, "set, one target"))
    if series == "lights":
        points = [r for r in rows if r["series"] == "points"]
        for render in ("plain", "set"):
            line(axes, points, render, f"{render}, light sources", dashed=True)
    if series == "resolution" and these:
        sizes = list(dict.fromkeys(r["at"] for r in these))
        axes.set_xticks([pixels(s) for s in sizes], [s.replace("x", "\nx") for s in sizes])
        axes.minorticks_off()
    axes.set_ylim(0, axes.get_ylim()[1] * (1.35 if series == "lights" else 1.15))  # the legend stands above
    axes.set_xlabel(name)
    axes.set_ylabel("processor time, µs a path")
    axes.grid(axis="y", color="#dddddd", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    if these:
        axes.legend(frameon=False, fontsize=9, loc="upper left", ncols=2)


def main(table, out):
    with open(table, encoding="ascii", newline="") as file:
        rows = list(csv.DictReader(file))
    figure, axes = plt.subplots(2, 2, figsize=(10, 7), dpi=110, layout="constrained")
    for place, (series, name) in zip(axes.flat, PANELS):
        panel(place, rows, series, name)
    figure.get_layout_engine().set(h_pad=0.15, w_pad=0.1)
    # No date or version: equal figures make equal files.
    figure.savefig(out, metadata={"Software": None})


main(*sys.argv[1:])
