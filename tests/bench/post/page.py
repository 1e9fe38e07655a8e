"""The page of make bench-post: page.py RECORDS OUT.csv HEAD TABLE_SIZE TABLE_SPP CONTROL_SPP

Prints what run.sh measured as Markdown, and writes the figures as CSV.
"""
import csv
import json
import os
import sys
from statistics import median

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import paper as published
from stored import USES

# What files are in the paper, where they have another name there.
PUBLISHED_AS = {"exr-rendered": "aovs", "pack": "jpeg"}
# Megabytes, of one target and of two, and shares of the EXR set.
MOST_MEGABYTES = {"pack": (10, 16), "pack-rendered": (23.6, 52.6)}
MOST_OF_EXR = {"lossless": 0.6, "lossless-rendered": 0.6}
EDITS = ["one", "two"]
SCENES = {"living-room": "scenes/living-room", "artist": "the artist's living room"}
LARGE, SMALL = "4096x3840", "640x640"
PAPER_SIZE = "1920x1080"

ROWS = {
    "pack-jpg": "pack to JPEG",
    "pack-exr": "pack to half EXR",
    "pack-png": "pack to PNG",
    "pack-tif": "pack to TIFF",
    "set-jpg": "set to JPEG",
    "set-exr": "set to half EXR",
    "cat-pack": "`cat` pack, pipe, to JPEG",
    "cat-set": "`cat` set, pipe, to JPEG",
    "pipe": "pack, `retex-sample`, pipe, `retex-combine` to JPEG",
    "batch": "pack to 12 variants, JPEG",
    "floor-pack": "reading the pack alone",
    "floor-set": "reading the set alone",
    "oiio": "oiiotool, set and samples to half EXR",
    "samples": "`retex-sample`, samples for oiiotool",
    "render": "rendering again, to half EXR",
}
STORED = {
    "exr-rendered": "EXR, zip, as rendered",
    "exr": "EXR, zip, denoised",
    "dwaa-rendered": "EXR, DWAA 45, as rendered",
    "dwaa": "EXR, DWAA 45, denoised",
    "pack-rendered": "pack, as rendered",
    "pack": "pack, denoised",
    "lossless-rendered": "pack, `--lossless`, as rendered",
    "lossless": "pack, `--lossless`, denoised",
    "control-biased": "Rousselle, biased: its buffers",
    "control-unbiased": "Rousselle, unbiased: its buffers",
}

INTRODUCTION = """# How long retexturing takes

This page has the time from a set on disk to the written picture, as table 6 of the paper, and the sizes of
sets, as its tables 4 and 5. [post.csv](post.csv) has all figures, with their least and largest values.
{head}

A time is that of a whole process, or of all processes of a pipe, from the start until the file is written. It
includes reading the set, and loading and filtering the textures. All files were read once before and are in the
page cache. The rows of a table were run in turn,
{turns}. Times are medians, with the least and largest in
brackets. Ratios are medians over the runs of the same turn. Memory is the largest peak of a process; in pipes
each process has its own.

- "Reading alone" opens the same file. It reads and decodes every row that recombination needs, on all cores,
  and does nothing with it. No program that needs the whole file can be faster.
- "oiiotool" computes the same sum in one call of OpenImageIO's program. It reads the same set, and textures
  that `retex-sample` has already filtered. The time for these is not included; it is in a row of its own.
- "Rendering again" is `retex-render --replace` with the samples of the set, which are few. With 128 samples, as
  in the other tables of the paper, its time grows in proportion. It ran once.

For pictures of four million pixels and more, oiiotool and the variants ran once, and the other rows at most
three times.
"""

SIZES = """
## Sizes

Megabytes on disk at {size}, {spp} samples per pixel. The paper's figures are those of its Living Room at
1920x1080: EXR, and the same with radiance as JPEG. They contain no originals. "DWAA" is
`oiiotool -a --compression dwaa:45` of the whole set, which also makes UV coarser; [storage.md](storage.md)
measures what such files lose. Rousselle's buffers belong to the scene, whatever is changed, and require the
scene as well{control}. The last columns give the size by purpose.
"""


class Case:
    """All about one set: what it is, and of each row the runs by turn."""

    def __init__(self, about):
        self.about, self.runs, self.agreement = about, {}, {}

    def succeeded(self, row):
        return {t: r for t, r in self.runs.get(row, {}).items() if all(p["status"] == 0 for p in r["processes"])}

    def walls(self, row):
        return [r["wall"] for r in self.succeeded(row).values()]

    def cpu(self, row):
        return median(sum(p["cpu"] for p in r["processes"]) for r in self.succeeded(row).values())

    def peaks(self, row):
        """Of each process of the row."""
        runs = self.succeeded(row).values()
        return [max(p["peak_memory_bytes"] for p in of) for of in zip(*(r["processes"] for r in runs))]

    def ratio(self, row, to):
        a, b = self.succeeded(row), self.succeeded(to)
        turns = a.keys() & b.keys()
        return median(a[t]["wall"] / b[t]["wall"] for t in turns) if turns else None

    def variants_a_minute(self):
        return 60 * 12 / median(self.walls("batch")) if self.walls("batch") else None


def read(path):
    cases, stored = {}, {}
    with open(path, encoding="utf-8") as file:
        for r in map(json.loads, file):
            key = tuple(r.get(name) for name in ("scene", "layout", "edit", "size"))
            if r["kind"] == "case":
                cases[key] = Case(r)
            elif r["kind"] == "time":
                cases[key].runs.setdefault(r["row"], {})[r["turn"]] = r["run"]
            elif r["kind"] == "agreement":
                cases[key].agreement[r["what"]] = r["run"]["psnr"]
            else:
                of = stored.setdefault((r["scene"], r.get("layout"), r.get("edit")), {})
                of[r["what"]] = r.get("run") or {"bytes": int(r["bytes"]), "uses": {}}
    return cases, stored


def seconds(values):
    if not values:
        return "failed"
    return f"{median(values):.3f}" + (f" ({min(values):.3f} .. {max(values):.3f})" if len(values) > 1 else "")


def times(value, digits=1):
    return "" if value is None else f"{value:.{digits}f}"


def targets(case):
    return " and ".join(case.about["targets"].split())


# ---- sections ----

def goals(cases):
    """Each goal with its worst case."""
    def worst(name, limit, unit, figure, chosen, at_most=True):
        if not chosen:
            return
        found = [(figure(c), c) for c in chosen]
        found = [(v, c) for v, c in found if v is not None]
        if not found:
            print(f"| {name} | failed | no |")
            return
        value, case = (max if at_most else min)(found, key=lambda pair: pair[0])
        reached = value <= limit if at_most else value >= limit
        at = f"{SCENES[case.about['scene']]}, {targets(case)}, {case.about['size']}"
        print(f"| {name} | {value:.3g} {unit}, {at} | {'yes' if reached else 'no'} |")

    def wall(row):
        return lambda c: median(c.walls(row)) if c.walls(row) else None

    def peak(*kinds):
        return lambda c: max((max(c.peaks(r)) / 1e9 for r in ROWS if r.startswith(kinds) and c.succeeded(r)),
                             default=None)

    def with_samples(row):
        def figure(c):
            walls = [c.walls(r) for r in ("oiio", "samples", row)]
            return (median(walls[0]) + median(walls[1])) / median(walls[2]) if all(walls) else None
        return figure
    every = [c for c in cases.values() if c.about["layout"] == "footprints"] or list(cases.values())
    large, small = ([c for c in every if c.about["size"] == size] for size in (LARGE, SMALL))
    tenth = published.SECONDS[LARGE] / 10
    print("\n## Goals\n\nThe worst case of all scenes and edits, in the default layout if it was measured.\n\n"
          "| goal | worst | met |\n|---|---|---|")
    for row in ("pack-jpg", "pack-exr"):
        worst(f"{ROWS[row]}, {LARGE}: at most a tenth of the paper's {published.SECONDS[LARGE]} s", tenth, "s", wall(row),
              large)
    for row in ("pack-jpg", "pack-exr"):
        worst(f"{ROWS[row]}, {SMALL}: at most 0.3 s", 0.3, "s", wall(row), small)
    for chosen, at in (every, "any size"), (large, LARGE):
        for row, to in (("pack-jpg", "floor-pack"), ("pack-exr", "floor-pack"), ("set-exr", "floor-set")):
            worst(f"{ROWS[row]}, {at}: at most 3 times {ROWS[to]}", 3, "times",
                  lambda c, r=row, t=to: c.ratio(r, t), chosen)
        for row in ("pack-exr", "set-exr"):
            worst(f"{ROWS[row]}, {at}: at least 8 times as fast as oiiotool", 8, "times",
                  lambda c, r=row: c.ratio("oiio", r), chosen, at_most=False)
            worst("the same, with the time of `retex-sample` added to oiiotool", 8, "times", with_samples(row), chosen,
                  at_most=False)
    worst(f"one picture from a file, {LARGE}: peak memory below 1.5 GB", 1.5, "GB", peak("pack-", "set-"), large)
    worst("the same through a pipe", 1.5, "GB", peak("cat-", "pipe"), large)
    worst("oiiotool computes the same: at least 50 dB", 50, "dB", lambda c: c.agreement.get("oiio"), every,
          at_most=False)


def of_exr(files, what):
    """Share of the EXR set that it is made of, None of buffers."""
    exr = files.get("exr-rendered" if what.endswith("-rendered") else "exr")
    return None if not exr or what.startswith("control") else files[what]["bytes"] / exr["bytes"]


def size_goals(stored, size):
    """More lines of the same table: sizes of the default layout where it was measured. Megabytes are of the paper's
    pictures."""
    stored = [(key, files) for key, files in stored.items() if key[2]]
    chosen = [(key, files) for key, files in stored if key[1] == "footprints"] or stored
    for what, limits in MOST_MEGABYTES.items() if size == PAPER_SIZE else ():
        for edit, most in zip(EDITS, limits):
            size_goal(f"{STORED[what]}, {edit} target{'s' if edit == 'two' else ''}: at most {most} MB", most, "MB",
                      {key: files[what]["bytes"] / 1e6 for key, files in chosen if key[2] == edit and what in files})
    for what, most in MOST_OF_EXR.items():
        size_goal(f"{STORED[what]}: at most {100 * most:.0f} % of the EXR set", 100 * most, "%",
                  {key: 100 * of_exr(files, what) for key, files in chosen if what in files})


def size_goal(name, most, unit, found):
    if found:
        (scene, _, edit), value = max(found.items(), key=lambda pair: pair[1])
        at = f"{SCENES[scene]}, {edit} target{'s' if edit == 'two' else ''}"
        print(f"| {name} | {value:.3g} {unit}, {at} | {'yes' if value <= most else 'no'} |")


def against_paper(cases):
    print("\n## Compared with table 6 of the paper\n\nSeconds from set to picture, and how many times faster this is than "
          "the paper's \"total processing time\".\n\n"
          "| scene | targets | layout | size | pack to JPEG | to half EXR |"
          " paper | faster, JPEG | EXR | set, MB | pack, MB | variants per minute |\n"
          "|---|---|---|---|---|---|---|---|---|---|---|---|")
    for c in cases.values():
        about = c.about
        paper = published.SECONDS.get(about["size"])
        walls = [c.walls(row) for row in ("pack-jpg", "pack-exr")]
        faster = [times(paper / median(w)) if paper and w else "" for w in walls]
        sizes = [f"{int(about[name]) / 1e6:.1f}" for name in ("set_bytes", "pack_bytes")]
        print(f"| {SCENES[about['scene']]} | {targets(c)} | {about['layout']} | {about['size']} |"
              f" {' | '.join(map(seconds, walls))} | {times(paper, 3)} | {' | '.join(faster)} | {' | '.join(sizes)} |"
              f" {times(c.variants_a_minute(), 0)} |")


def section(c):
    about = c.about
    print(f"\n## {SCENES[about['scene']]}: {targets(c)}, {about['size']}, layout {about['layout']}\n")
    agreement = "\n".join(f"{text} {c.agreement[name]:.1f} dB." for name, text in
                        (("oiio", "PSNR against the picture from the set: oiiotool"),
                         ("pack", "PSNR against the picture from the set: pack")) if name in c.agreement)
    print(f"The set has {about['spp']} samples per pixel and {about['run']['aovs']} AOVs, and is denoised.\n"
          f"{agreement}\n\n"
          "| what | wall s | processor s | of pack to JPEG | of reading alone | memory MB |\n|---|---|---|---|---|---|")
    for row, name in ROWS.items():
        if row not in c.runs:
            continue
        if not c.succeeded(row):
            print(f"| {name} | failed | | | | |")
            continue
        floor = "floor-set" if row in ("set-jpg", "set-exr", "cat-set", "oiio") else "floor-pack"
        of = None if row in ("render", "batch", "samples") else c.ratio(row, floor)
        memory = " + ".join(f"{peak / 1e6:.0f}" for peak in c.peaks(row))
        print(f"| {name} | {seconds(c.walls(row))} | {c.cpu(row):.2f} | {times(c.ratio(row, 'pack-jpg'), 2)} |"
              f" {times(of, 2)} | {memory} |")


def sizes(stored, size, spp, control_spp):
    if not stored:
        return
    control = "" if control_spp == spp else f"; here they have {control_spp} samples per pixel"
    print(SIZES.format(size=size, spp=spp, control=control))
    for (scene, layout, edit), files in stored.items():
        if not edit:
            continue
        files = {**files, **stored.get((scene, None, None), {})}
        number = EDITS.index(edit)
        print(f"\n### {SCENES[scene]}: {edit} target{'s' if number else ''}, layout {layout}\n")
        print("| file | MB | paper | of EXR, zip | " + " | ".join(USES) + " |\n|---|---|---|---|" +
              "---|" * len(USES))
        for what, name in STORED.items():
            if what not in files:
                continue
            paper = published.MEGABYTES.get(PUBLISHED_AS.get(what, what))
            parts = [f"{files[what]['uses'][use] / 1e6:.2f}" if files[what]["uses"] else "" for use in USES]
            share = of_exr(files, what)
            print(f"| {name} | {files[what]['bytes'] / 1e6:.2f} | {paper[number] if paper else ''} |"
                  f" {f'{100 * share:.1f} %' if share else ''} | {' | '.join(parts)} |")


CSV = ["kind", "scene", "targets", "layout", "size", "what", "turns", "wall_s", "wall_s_min", "wall_s_max", "cpu_s",
       "peak_memory_bytes", "file_bytes", "psnr"]


def write_csv(path, cases, stored, size):
    with open(path, "w", encoding="ascii", newline="") as file:
        out = csv.DictWriter(file, CSV, lineterminator="\n", restval="")
        out.writeheader()
        for (scene, layout, _, at), c in cases.items():
            about = {"scene": scene, "targets": c.about["targets"], "layout": layout, "size": at}
            for row in c.runs:
                if walls := c.walls(row):
                    out.writerow({"kind": "time", **about, "what": row, "turns": len(walls),
                                  "wall_s": f"{median(walls):.4f}", "wall_s_min": f"{min(walls):.4f}",
                                  "wall_s_max": f"{max(walls):.4f}", "cpu_s": f"{c.cpu(row):.4f}",
                                  "peak_memory_bytes": max(c.peaks(row))})
            out.writerows({"kind": "agreement", **about, "what": name, "psnr": f"{psnr:.2f}"}
                          for name, psnr in c.agreement.items())
        for (scene, layout, edit), files in stored.items():
            for what, of in files.items():
                about = {"kind": "size", "scene": scene, "targets": edit or "", "layout": layout or "", "size": size}
                out.writerow({**about, "what": what, "file_bytes": of["bytes"]})
                out.writerows({**about, "what": f"{what}: {use}", "file_bytes": bytes_}
                              for use, bytes_ in of["uses"].items())


def main(records, table, head, size, spp, control_spp):
    cases, stored = read(records)
    turns = max((len(runs) for c in cases.values() for runs in c.runs.values()), default=0)
    turns = f"{turns} times, every other turn backwards" if turns > 1 else "once"
    print(INTRODUCTION.format(head=head, turns=turns), end="")
    goals(cases)
    size_goals(stored, size)
    against_paper(cases)
    for case in cases.values():
        section(case)
    sizes(stored, size, spp, control_spp)
    write_csv(table, cases, stored, size)


main(*sys.argv[1:])
