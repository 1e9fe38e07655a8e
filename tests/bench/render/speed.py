"""How fast retex renders: speed.py RUNS OUT.csv. Beside Cycles, and beside what Embree needs for the same number of rays.

The table has one row for each scene and turn.
"""
import csv
import sys
from statistics import median

import runs

NAMES = {"retex": "retex", "cycles": "Cycles"}


def rates(turns):
    """Net is what the samples take, without what is done once: one of them renders in the second column's time."""
    for renderer, name in NAMES.items():
        if renderer not in turns:
            continue
        these = turns[renderer]
        whole, once = (median(t.figures["wall" + end] for t in these) for end in ("", "_once"))
        line = [whole, once, median(t.wall for t in these), median(t.cpu for t in these),
                median(t.paths / t.wall / 1e6 for t in these), median(t.paths / t.cpu / 1e6 for t in these)]
        if renderer == "retex":
            line.append(median((t.figures["segments"] + t.figures["shadow_rays"]) / t.wall / 1e6 for t in these))
        print(f"  {name:<16}" + "".join(f"{v:10.2f}" for v in line))


def against_cycles(turns):
    pairs = list(zip(turns["retex"], turns["cycles"]))
    print("  retex / Cycles, paths/s: by wall time " + runs.middle(c.wall / r.wall for r, c in pairs) +
          ", by processor time " + runs.middle(c.cpu / r.cpu for r, c in pairs))


def against_embree(turns):
    f = turns["retex"][0].figures
    counts = {"camera": f["paths"], "bounce": f["segments"] - f["paths"], "shadow": f["shadow_rays"]}
    print("  rays of retex, a path: " + ", ".join(f"{k} {n / f['paths']:.2f}" for k, n in counts.items()))
    pairs = list(zip(turns["retex"], turns.get("embree", ())))
    for prefix, name in (("", "Embree alone"), ("robust_", "Embree, robust")) if pairs else ():
        def limit(e, clock, prefix=prefix):
            return sum(n * e[prefix + k][clock] / e[prefix + k]["rays"] for k, n in counts.items())
        speeds = ", ".join(f"{k} {median(e[prefix + k]['rays'] / e[prefix + k]['wall'] for _, e in pairs) / 1e6:.2f}"
                           for k in counts)
        print(f"  {name:<15} Mrays/s: {speeds}; limit {median(limit(e, 'wall') for _, e in pairs):.2f} s")
        print(f"  {'':<15} retex's time over it: by wall time " +
              runs.middle(r.wall / limit(e, "wall") for r, e in pairs) + ", by processor time " +
              runs.middle(r.cpu / limit(e, "cpu") for r, e in pairs))


def write_table(path, scenes):
    with open(path, "w", encoding="ascii", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["scene", "turn", "mpaths_per_s", "paths_over_cycles"])
        for scene, turns in scenes.items():
            cycles = turns.get("cycles", [None] * len(turns["retex"]))
            for number, (r, c) in enumerate(zip(turns["retex"], cycles), 1):
                out.writerow([scene, number, f"{r.paths / r.wall / 1e6:.4f}", f"{c.wall / r.wall:.4f}" if c else ""])


def main(path, table):
    scenes = runs.read(path)
    write_table(table, scenes)
    for scene, turns in scenes.items():
        first = turns["retex"][0]
        print(f"\n{scene}: {first.paths / 1e6:.1f} million paths, {first.size}x{first.size}, {first.samples:.0f} "
              f"samples a pixel, "
              f"median of {len(turns['retex'])} turns")
        print(f"  {'seconds':<16}" + "".join(f"{h:>10}" for h in (
            "whole", "1 sample", "net", "net, cpu", "Mpaths/s", "per cpu s", "Mrays/s")))
        rates(turns)
        if "cycles" in turns:
            against_cycles(turns)
        against_embree(turns)


main(*sys.argv[1:])
