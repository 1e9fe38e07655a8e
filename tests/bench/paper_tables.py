"""The paper's tables 1 to 6 with retex's figures, as Markdown: paper_tables.py DOCS HEAD >MD

Measures nothing: the figures are those of overhead.csv, paper-sizes.csv and post.csv in DOCS.
"""
import csv
import re
import sys

import paper as published

RENDERS = (("first render of Rousselle and others, biased", "initial-biased", 0), ("the same, unbiased", "initial-unbiased", None),
           ("their second render, biased", "again-biased", 1), ("the same, unbiased", "again-unbiased", None),
           ("the paper's method: layout `paper`", "paper", 2), ("layout `footprints`", "footprints", None))
# Of tables 4 and 5: ours, and what it is in the paper.
SIZES = (("Rousselle and others, biased", "control-biased", "control-biased"),
         ("Rousselle and others, unbiased", "control-unbiased", "control-unbiased"),
         ("the paper's AOVs, EXR, `float16`", "strict-half", "aovs"), ("the same, UV and spread as `float`", "strict", None),
         ("`float16`, radiance as JPEG (here of quality 90)", "jpeg-90", "jpeg"),
         ("set of layout `footprints`, denoised", "denoised", None), ("its pack", "denoised-pack", None))
PIXELS = 1920 * 1080


def read(docs, name):
    with open(f"{docs}/{name}.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    with open(f"{docs}/{name}.md", encoding="utf-8") as file:
        text = file.read()
    return rows, text, re.search(r"from commit (\w+)", text)[1]


def table(heads, rows):
    print("| " + " | ".join(heads) + " |\n|" + "---|" * len(heads))
    for row in rows:
        print("| " + " | ".join(row) + " |")


def factor(ours, paper):
    return f"{ours / paper:.2f}" if paper else ""


def overhead(docs):
    rows, text, commit = read(docs, "overhead")
    size = re.search(r"Pictures are (\d+x\d+)", text)[1]
    print(f"""## Tables 1 to 3: what a render takes longer

Processor time over that of the path tracer's plain picture, in the living room, {size}; the paper's is wall time at 1920x1080 with 128
samples. Measured by [overhead.md](overhead.md), commit {commit}. Between the plain picture's two runs of each turn lies
the noise of the measurement; the brackets have the least and the most of the turns.
""")
    of = {(r["targets"], r["row"]): r for r in rows if r["part"] == "time" and r["scene"] == "living-room"}
    lines = []
    for number, (edit, paper) in enumerate(published.OVERHEAD.items(), 1):
        for k, (label, row, column) in enumerate(RENDERS):
            found = of.get((edit, row))
            if not found:
                continue
            ours, low, high = (float(found["over_cpu_percent" + end]) for end in ("", "_min", "_max"))
            known = paper[column] if column is not None else None
            lines.append([f"{number}, {edit.replace('+', ' and ')}" if k == 0 else "", label, f"+{known:.2f} %" if known else "",
                          f"{ours:+.1f} % ({low:+.1f} to {high:+.1f})", factor(ours, known)])
    table(["table", "method", "paper", "retex", "factor"], lines)
    print("""
What differs: the paper's renderer is not named; here the plain picture is `retex-render --plain`. The paper does not say
which mode of Rousselle's method its tables measure; its figures stand beside the biased one. Biased is `--control-data
biased` and `--control-mode biased`, unbiased `--control-data unbiased` and `--control-mode halves`.
""")


def sizes(docs):
    rows, text, commit = read(docs, "paper-sizes")
    size, spp = re.search(r"pictures of (\d+x\d+) with (\d+) samples", text).groups()
    wide, high = map(int, size.split("x"))
    scale = PIXELS / (wide * high)
    print(f"""## Tables 4 and 5: what is stored

Megabytes of the living room, {size}, {spp} samples, times {scale:.4g} for the pixels of 1920x1080; the paper's are of 1920x1080 and 128
samples. Measured by [paper-sizes.md](paper-sizes.md), commit {commit}. Without the original textures, which the paper does
not store.
""")
    of = {(r["targets"], r["what"]): int(r["bytes"]) for r in rows if r["scene"] == "living-room"}
    lines = []
    for label, what, known_as in SIZES:
        line = [label]
        for known, targets in zip(published.MEGABYTES.get(known_as, (None, None)), ("Floor", "Floor Wall")):
            found = of.get((targets, what), of.get(("none", what)))
            ours = found * scale / 1e6 if found else None
            line += [f"{known:g} MB" if known else "", f"{ours:.0f} MB" if ours else "", factor(ours, known) if ours else ""]
        lines.append(line)
    table(["file", "paper, one object", "retex, `Floor`", "factor", "paper, two objects", "retex, `Floor` and `Wall`", "factor"], lines)
    print("""
What differs: the paper stores UV and their variances as `float16` too, which retex does not by default: `float16` has 11
bits, so that in a floor of ten tiles a UV is off by a hundredth of a tile. The row `float16` is the strict layout with all
channels converted. How noisy radiance is decides what zip takes off, so that fewer samples give larger files; and a room
in which light meets its floor more often fills more of the 33 images. Small pictures compress a little worse.
""")


def times(docs):
    rows, _, commit = read(docs, "post")
    print(f"""## Table 6: how long a retexture takes

From the file of the set to the written JPEG, seconds of wall time, the living room with one target, two cores. Measured by
[post.md](post.md), commit {commit}. The paper's time is that of sampling and of reading the AOVs.
""")
    of = {(r["size"], r["what"]): float(r["wall_s"]) for r in rows
          if (r["kind"], r["scene"], r["targets"]) == ("time", "living-room", "Floor")}
    table(["size", "paper", "retex, from EXR", "factor", "retex, from a pack", "factor"],
          [[size, f"{known:g} s", *(cell for what in ("set-jpg", "pack-jpg") for cell in
                                    (f"{of[size, what]:.2f} s", factor(of[size, what], known)))]
           for size, known in published.SECONDS.items() if (size, "set-jpg") in of])
    print("""
What differs: the sets of layout `footprints` hold more images and denoising data than the paper's; the machine is another.""")


def main(docs, head):
    print(f"""# The paper's tables

The supplement of *Efficient physically-based retexturing in image-space* has six tables. Here they are line by line, with
the figure of retex, the factor between the two, and what differs in method. [paper.md](paper.md) goes through the rest of
the paper. The paper's Living Room is not available: that of retex is `scenes/living-room`, with a floor and a wall as
targets. `make figures FULL=1` measures at the paper's sizes.
{head}
""")
    overhead(docs)
    sizes(docs)
    times(docs)


main(*sys.argv[1:])
