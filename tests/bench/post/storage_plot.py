"""The figure of make bench-storage: storage_plot.py STORAGE.csv OUT.png"""
import csv
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.ticker import LogFormatter  # noqa: E402

LABELS = {"dwaa": "EXR, DWAA of radiance", "dwaa-all": "EXR, DWAA of everything", "jpeg": "EXR, radiance as plain JPEG"}
COLOURS = {"dwaa": "#c06000", "dwaa-all": "#e0a060", "jpeg": "#555555"}
OURS = ["#0060b0", "#008060", "#8040a0", "#40a0d0"]
WITHOUT_LOSS = {"exr": ("EXR", "--", "#999999"), "lossless": ("lossless pack", ":", "#0060b0")}
BEST = 80  # dB; beyond it nothing is seen
LEGEND = 0.8  # inches below the panels


def line(axes, rows, method, colour):
    rows = sorted((r for r in rows if r["method"] == method and r["psnr"]), key=lambda r: float(r["bits_a_pixel"]))
    if not rows:
        return
    at, mean, worst = ([float(r[c]) for r in rows] for c in ("bits_a_pixel", "psnr", "psnr_worst"))
    mean, worst = ([min(v, BEST) for v in values] for values in (mean, worst))
    axes.plot(at, mean, color=colour, marker="o", markersize=4, linewidth=1.2,
              label=LABELS.get(method, f"pack, {method.partition('-')[2]}"))
    axes.plot(at, worst, color=colour, linewidth=0.7, linestyle="--")


def panel(axes, rows, scene, layout):
    these = [r for r in rows if (r["scene"], r["layout"]) == (scene, layout)]
    methods = dict.fromkeys(r["method"] for r in these)
    for method, colour in zip((m for m in methods if m.startswith("pack-")), OURS):
        line(axes, these, method, colour)
    for method, colour in COLOURS.items():
        line(axes, these, method, colour)
    for method, (label, style, colour) in WITHOUT_LOSS.items():
        for r in these:
            if r["method"] == method:
                axes.axvline(float(r["bits_a_pixel"]), color=colour, linestyle=style, linewidth=1, label=label)
    axes.set_xscale("log")
    axes.xaxis.set_major_formatter(LogFormatter())
    axes.xaxis.set_minor_formatter(LogFormatter(minor_thresholds=(1.5, 0.5)))
    axes.set_title(f"{scene}, {layout}", fontsize=10)
    axes.grid(color="#dddddd", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)


def main(table, out):
    with open(table, encoding="ascii", newline="") as file:
        rows = [r for r in csv.DictReader(file) if r["set"] == "denoised"]
    scenes, layouts = (list(dict.fromkeys(r[c] for r in rows)) for c in ("scene", "layout"))
    high = 3.2 * len(scenes) + LEGEND
    figure, axes = plt.subplots(len(scenes), len(layouts), figsize=(5.2 * len(layouts), high), dpi=110,
                                layout="constrained", squeeze=False, sharey=True)
    figure.get_layout_engine().set(rect=(0, LEGEND / high, 1, 1 - LEGEND / high))
    for down, scene in enumerate(scenes):
        for across, layout in enumerate(layouts):
            panel(axes[down, across], rows, scene, layout)
        axes[down, 0].set_ylabel("PSNR against the set, dB")
    for place in axes[-1]:
        place.set_xlabel("bits per pixel without originals")
    handles = dict(reversed(pair) for place in axes.flat for pair in zip(*place.get_legend_handles_labels()))
    figure.legend(handles.values(), handles.keys(), loc="lower center", ncols=3, frameon=False, fontsize=9)
    # No date or version: equal figures make equal files.
    figure.savefig(out, metadata={"Software": None})


main(*sys.argv[1:])
