"""The page of make bench-catalogues: page.py RECORDS OUT.csv HEAD SIZE SPP

Prints what run.sh measured, and what follows from it for a million pictures a day, as Markdown; writes the figures as
CSV.
"""
import csv
import itertools
import json
import math
import sys
import textwrap
from statistics import median

COLUMNS = ["kind", "what", "way", "turns", "pictures", "wall_s", "wall_s_min", "wall_s_max", "cpu_s", "cpu_s_min",
           "cpu_s_max", "peak_memory_bytes", "file_bytes"]
WAYS = {"1-thread": "one thread", "2-threads": "two threads", "2-processes": "two processes of one thread"}
WHATS = {"placements": "one target, always the same image, placed anew", "one": "one target, always a new image",
         "two": "two targets, always new images"}
STEPS = {"plan": "`--plan`", "make": "making all", "resume": "`--resume` with nothing to do", "verify": "`--verify`"}
DAY, MILLION = 86400, 1000000
CORES = 8  # of a machine

BEGIN = """# Catalogues: what a million pictures take

How many pictures a machine makes a day, and what that takes in cores, storage and network. The recipes for several
machines are in [tools/cluster](../tools/cluster/README.md). {head}
[catalogues.csv](catalogues.csv) has the same figures.

## Pictures

The living room at {size} from a pack, {pictures} pictures of `--batch`, as JPEG of the default quality; images of 1024x1024 or
less. Starting, reading the pack and checking the table are included. {turns_text}

| new textures on | run by | processor time of a picture, s | pictures a second of processor time | pictures a second by the clock | largest process, MB |
|---|---|---|---|---|---|"""

AGAIN = """
{processes_text}
An image stays in memory for the rows that follow, as far as a quarter of `--memory` holds it, however it is placed.
{images_text}

The same pictures rendered again with {spp} samples per pixel:

| new textures on | rendered again, processor time, s | retextured, s | ratio |
|---|---|---|---|"""

BESIDE = """
A render with {spp} samples is still noisy. The ratio grows with the samples; the set takes its samples once.

## What is beside the pictures

{total:,} pictures of 64x48 in {views} views of {rows:,} rows, one thread, so that checking, recording and starting are what
takes the time:

| step | processor time, s | by the clock, s | largest process, MB |
|---|---|---|---|"""

PAPER = """
So checking, recording and tiny pictures together take {each:.1f} ms each. The manifest has {line:.0f} bytes a picture. `--verify`
reads every picture once; with large pictures, that is the time of the disk.

## A million pictures a day, on paper

From the pictures above, by one thread and with a new image in each row: {one:.3f} s of processor time for one target, {two:.3f} s
for two. A core has 86,400 s a day, so that it makes 86,400 / {one:.3f} = {one_a_day:,} pictures a day ({two_a_day:,}).

| for 1,000,000 pictures | one target | two targets | rendered again |
|---|---|---|---|"""

STORAGE = """
{machines_text}

**Storage.** A JPEG of this size has {jpeg:.2f} MB: 1,000,000 x {jpeg:.2f} MB = {kept:.0f} GB a day, if all are kept. The manifest has
1,000,000 x {line:.0f} bytes = {manifest:.2f} GB. A pack has {pack:.1f} MB and does not grow with the number of pictures.

**Network.** {kept:.0f} GB / 86,400 s = {rate:.1f} MB/s to the storage on average, and seven times as much, {peak:.0f} MB/s, if all is made
in 3.4 hours at night: {network} than a network of 1 Gbit/s carries.

**On demand instead.** `retex-serve` makes a picture when it is asked for, and a cache keeps it. With a hit rate h, only
the share 1 - h of a million requests is made:

| hit rate | pictures made | core hours, one target | kept, at {jpeg:.2f} MB |
|---|---|---|---|"""

END = """
A catalogue of 24,000 pictures with a million requests a day is made at most once: its hit rate is at least
1 - 24,000 / 1,000,000 = 0.976, and its pictures take 24,000 x {one:.3f} s = {hours:.1f} core hours and {kept:.1f} GB."""


def summary(runs, **keys):
    """A row of the CSV: medians of turns."""
    walls = [r["run"]["wall"] for r in runs]
    cpus = [sum(p["cpu"] for p in r["run"]["processes"]) for r in runs]
    return dict(keys, turns=len(runs), pictures=runs[0]["pictures"], wall_s=median(walls), wall_s_min=min(walls),
                wall_s_max=max(walls), cpu_s=median(cpus), cpu_s_min=min(cpus), cpu_s_max=max(cpus),
                peak_memory_bytes=max(p["peak_memory_bytes"] for r in runs for p in r["run"]["processes"]),
                file_bytes=runs[0]["bytes"])


def added(runs, **keys):
    """The same of steps: one process a view, one after the other."""
    row = summary(runs, **keys)
    row.update(turns=1, pictures=sum(r["pictures"] for r in runs), file_bytes="")
    for name, values in (("wall_s", [r["run"]["wall"] for r in runs]),
                         ("cpu_s", [r["run"]["processes"][0]["cpu"] for r in runs])):
        row[name] = row[name + "_min"] = row[name + "_max"] = sum(values)
    return row


def figures(records):
    groups = {}
    for r in records:
        way = "" if r["kind"] == "step" else r.get("way", "")
        groups.setdefault((r["kind"], r.get("what", ""), way), []).append(r)
    for (kind, what, way), runs in groups.items():
        keys = {"kind": kind, "what": what, "way": way}
        if kind in ("pictures", "render"):
            yield summary(runs, **keys)
        elif kind == "step":
            yield added(runs, **keys)
        else:
            yield dict(keys, pictures=runs[0].get("pictures", ""), file_bytes=runs[0]["bytes"])


def is_prose(line):
    return line != "" and line[0] not in "|#"


def say(template, **values):
    """Prints a text with its paragraphs filled anew; lines of tables and headings stay as they are."""
    for prose, lines in itertools.groupby(template.format(**values).split("\n"), is_prose):
        print(textwrap.fill(" ".join(lines), 120, break_long_words=False, break_on_hyphens=False)
              if prose else "\n".join(lines))


def megabytes(row):
    return f"{row['peak_memory_bytes'] / 1e6:.0f}"


def three(value):
    """Three digits, in groups."""
    digits = max(0, 2 - math.floor(math.log10(value)))
    return f"{round(value, 2 - math.floor(math.log10(value))):,.{digits}f}"


def main(records, table, head, size, spp):
    with open(records, encoding="utf-8") as file:
        recorded = [json.loads(line) for line in file]
    rows = list(figures(recorded))
    by = {(r["kind"], r["what"], r["way"]): r for r in rows}
    with open(table, "w", encoding="ascii", newline="") as file:
        out = csv.DictWriter(file, COLUMNS, restval="", lineterminator="\n")
        out.writeheader()
        out.writerows({k: f"{v:.4f}" if isinstance(v, float) else v for k, v in r.items()} for r in rows)

    some = by["pictures", "one", "1-thread"]
    turns = some["turns"]
    say(BEGIN, head=head, size=size, pictures=some["pictures"],
        turns_text=f"Medians of {turns} turns." if turns > 1 else "One turn.")
    for what, text in WHATS.items():
        for way, by_what in WAYS.items():
            r = by["pictures", what, way]
            n = r["pictures"]
            print(f"| {text} | {by_what} | {r['cpu_s'] / n:.3f} | {n / r['cpu_s']:.1f} | {n / r['wall_s']:.1f} | "
                  f"{megabytes(r)} |")
    each = {what: by["pictures", what, "1-thread"]["cpu_s"] / some["pictures"] for what in WHATS}
    again = {"one": by["render", "Floor", "2-threads"]["cpu_s"], "two": by["render", "Floor Wall", "2-threads"]["cpu_s"]}
    processes = {what: by["pictures", what, "2-threads"]["wall_s"] / by["pictures", what, "2-processes"]["wall_s"]
                 for what in ("one", "two")}
    stays = each["one"] / each["placements"]
    say(AGAIN, spp=spp, processes_text=(
        f"Two processes of one thread make {processes['one']:.2f} times as many pictures by the clock as one process "
        f"of two threads with one target, and {processes['two']:.2f} times with two."),
        images_text=f"A new image takes {stays:.2f} times the processor time of one that has stayed." +
        (" Sort tables by their images." if stays > 1.05 else ""))
    for what, name in (("one", "one target"), ("two", "two targets")):
        print(f"| {name} | {again[what]:.1f} | {each[what]:.3f} | {again[what] / each[what]:.0f} |")

    made = by["step", "make", ""]
    views = sum(r["kind"] == "step" and r["what"] == "make" for r in recorded)
    say(BESIDE, spp=spp, total=made["pictures"], views=views, rows=made["pictures"] // views)
    for what, text in STEPS.items():
        r = by["step", what, ""]
        print(f"| {text} | {r['cpu_s']:.1f} | {r['wall_s']:.1f} | {megabytes(r)} |")

    manifest = by["manifest", "", ""]
    line = manifest["file_bytes"] / manifest["pictures"]
    say(PAPER, each=1000 * made["cpu_s"] / made["pictures"], line=line, one=each["one"], two=each["two"],
        one_a_day=int(float(f"{DAY / each['one']:.2g}")), two_a_day=int(float(f"{DAY / each['two']:.2g}")))
    costs = [each["one"], each["two"], again["one"]]
    hours = [MILLION * cost / 3600 for cost in costs]
    print(f"| core hours | {' | '.join(three(h) for h in hours)} |")
    print(f"| cores, busy all day | {' | '.join(three(h / 24) for h in hours)} |")
    print(f"| cores at half load, for peaks and failures | {' | '.join(f'{math.ceil(h / 12):,}' for h in hours)} |")
    machines = [math.ceil(h / 12 / CORES) for h in hours]
    jpeg = some["file_bytes"] / some["pictures"] / 1e6
    kept = MILLION * jpeg / 1e3
    rate = kept * 1e3 / DAY
    say(STORAGE, machines_text=f"With machines of {CORES} cores, and one more that may fail, that is "
        f"{machines[0] + 1} for one target, {machines[1] + 1} for two, and {machines[2] + 1:,} to "
        "render again.",
        jpeg=jpeg, kept=kept, line=line, manifest=MILLION * line / 1e9,
        pack=by["pack", "Floor", ""]["file_bytes"] / 1e6, rate=rate, peak=7 * rate,
        network="less" if 7 * rate < 125 else "more")
    for hit in (0, 0.5, 0.9, 0.99):
        share = round(1 - hit, 2)
        print(f"| {hit:g} | {round(MILLION * share):,} | {three(hours[0] * share)} | {three(kept * share)} GB |")
    say(END, one=each["one"], hours=24000 * each["one"] / 3600, kept=24 * jpeg)


main(*sys.argv[1:])
