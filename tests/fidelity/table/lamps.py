"""Lamps and textures changed after rendering, as Markdown: lamps.py WORK HEAD SETTINGS COUNTS HOURS >MD

Also writes WORK/lamps.csv, WORK/lamps-NAME.jpg: each edit of the living room beside its new render, and
WORK/lamps-hours.jpg.
Errors are those of pictures.squares.
"""
import csv
import os
import sys

import numpy as np

import pictures

METHODS = ("again", "set", "denoised")
BLOCK = 16
GOOD = 10 ** -5.5  # blocks below this squared error, before and after, are left out


def blocks(image):
    high, wide = (n // BLOCK * BLOCK for n in image.shape)
    return image[:high, :wide].reshape(high // BLOCK, BLOCK, wide // BLOCK, BLOCK).mean(axis=(1, 3))


def worst_block(noisy, clean):
    """The least gain of a block by denoising, in dB."""
    before, after = blocks(noisy), blocks(clean)
    counts = (before > GOOD) | (after > GOOD)
    gains = 10 * np.log10(np.maximum(before, GOOD / 10) / np.maximum(after, GOOD / 10))
    return float(gains[counts].min()) if counts.any() else 0.0


def edits():
    here = os.path.dirname(__file__)
    for line in open(f"{here}/lamps.txt", encoding="utf-8"):
        if not line.startswith("#"):
            yield [word.strip() for word in line.split("|")]


def numbers(path):
    with open(path, encoding="ascii") as file:
        return [float(word) for word in file.read().split()]


def seconds(path):
    return sum(numbers(path)[:2])


def words(text):
    """Options as a reader sees them: files without their folders."""
    return " ".join(f"`{os.path.basename(part) if '=' not in part else shorter(part)}`"
                    for part in text.replace("--light ", "").replace("--solo ", "solo:").split()) or "as rendered"


def shorter(statement):
    key, value = statement.split("=", 1)
    return f"{key}={os.path.basename(value)}"


def score(work):
    rows = []
    for scene, name, lamps, textures in edits():
        truth = f"{work}/truth/lamps-{scene}-{name}.exr"
        found = {method: pictures.squares(f"{work}/{scene}-{name}-{method}.exr", truth) for method in METHODS}
        rows.append((scene, name, lamps, textures, {m: pictures.decibels(found[m].mean()) for m in METHODS},
                     worst_block(found["set"], found["denoised"])))
    return rows


def show_pictures(work):
    """Each edit of the living room: ours, a gap, the new render."""
    names = []
    for scene, name, _, _ in edits():
        if scene != "living-room":
            continue
        pair = [pictures.encoded(pictures.colours(f"{work}/picture-{name}-{kind}.exr")) for kind in ("ours", "new")]
        pictures.write(f"{work}/lamps-{name}.jpg", np.hstack([pair[0], np.ones((pair[0].shape[0], 4, 3)), pair[1]]))
        names.append(name)
    return names


def show_hours(work, hours):
    frames = [pictures.encoded(pictures.colours(f"{work}/suns-{hour}.exr")) for hour in hours.split()]
    gap = np.ones((frames[0].shape[0], 3, 3))
    pictures.write(f"{work}/lamps-hours.jpg", np.hstack([part for frame in frames for part in (frame, gap)][:-1]))


def costs(work, counts):
    rows = []
    for count in counts.split():
        together, apart = f"{work}/together-{count}", f"{work}/apart-{count}"
        row = {"lamps": count}
        for name, kind in (("EXR", "denoised-bytes"), ("pack", "pack-bytes")):
            a, b = numbers(f"{apart}.{kind}")[0], numbers(f"{together}.{kind}")[0]
            row[name] = (a / 1e6, a / b)
        for name in ("render", "denoise", "pack"):
            a, b = seconds(f"{apart}.{name}-time"), seconds(f"{together}.{name}-time")
            row[f"{name} time"] = (a, a / b)
        for name in ("render", "denoise"):
            a, b = numbers(f"{apart}.{name}-time")[2], numbers(f"{together}.{name}-time")[2]
            row[f"{name} memory"] = (a / 1e3, a / b)
        for name, end in (("EXR", "-denoised.exr"), ("pack", ".retex")):
            a, b = seconds(f"{apart}{end}.combine-time"), seconds(f"{together}{end}.combine-time")
            row[f"combine {name}"] = (a, a / b)
            row[f"relight {name}"] = (seconds(f"{apart}{end}.light-time"), seconds(f"{apart}{end}.light-time") / b)
        rows.append(row)
    return rows


def write_csv(work, rows, sizes):
    with open(f"{work}/lamps.csv", "w", encoding="ascii", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(("subject", "name", "figure", "value"))
        for scene, name, _, _, found, worst in rows:
            for method in METHODS:
                out.writerow((scene, name, f"psnr {method}", f"{found[method]:.3f}"))
            out.writerow((scene, name, "worst block", f"{worst:.2f}"))
        for row in sizes:
            for key, value in row.items():
                if key != "lamps":
                    out.writerow(("lamps", row["lamps"], key, f"{value[0]:.3f}"))
                    out.writerow(("lamps", row["lamps"], f"{key} ratio", f"{value[1]:.3f}"))


CAPTIONS = {
    "day": "By day, with a walnut floor",
    "dusk": "At dusk: the windows at 8 and 5 % and bluish, the lamp four times as strong",
    "lamp": "The lamp alone, ten times as strong, with a brick wall",
    "warm": "The lamp at 2700 K, the windows at 2 %, with a walnut floor",
}


def main():
    work, head, settings, counts, hours = sys.argv[1:]
    spp, truth_spp, _, _, picture_spp, size, size_spp = settings.split()
    rows, shown, sizes = score(work), show_pictures(work), costs(work, counts)
    write_csv(work, rows, sizes)
    show_hours(work, hours)
    print(f"""# Lamps after rendering

`retex-render --lamps each` keeps the light of every lamp apart, in the same set as the textures.
Then each lamp can be dimmed, turned off, turned up and coloured, together with any texture, without rendering again.
Its caustics, its light through glass and the colours that it throws from one surface on another follow:

    retex-render -t Floor -t Wall --lamps each --denoise scenes/living-room/living-room.pov -o room.exr
    retex-combine room.exr --light Daylight=0.02 --light Garden=0.02 --light Lamp=10*2700K \\
        --texture Floor=scenes/textures/walnut-herringbone.jpg -o evening.jpg

[retex-edit(5)](../man/retex-edit.5) describes what a lamp's value may be: a factor, a colour, a colour temperature.

{head}

## The living room in four lights

On the left from one set, 64 samples, denoised; on the right rendered so, {picture_spp} samples, not denoised, so that noise
is left in it.
""")
    for name in shown:
        print(f"{CAPTIONS[name]}:\n\n![{name}](pictures/lamps-{name}.jpg)\n")
    print("""## A slider for the time of day

[suns.pov](suns.pov) has a sun for each hour from two to six. Each is a lamp; one of them shines at a time, twice as strong, and
the sky twenty times. All five pictures come from one set; five suns share its samples, so it has more than usual:

    retex-render docs/suns.pov -t Floor --lamps each --spp 512 --denoise -o suns.exr
    retex-combine suns.exr --solo Sun_16 --light Sun_16=2 --light sky=20 -o four-o-clock.jpg

![five hours](pictures/lamps-hours.jpg)
""")
    gains = [found["set"] - found["again"] for *_, found, _ in rows]
    cleaned = [found["denoised"] - found["set"] for *_, found, _ in rows]
    print(f"""## Compared with rendering again

PSNR against converged pictures, two of {truth_spp} samples each, whose noise does not count. The set and the new render have
{spp} samples; the new render knows the new values of the lamps and chooses lights by them. A set's samples are shared by
all of its lamps: a lamp that is turned up has the noise that it has in the set.

| scene | lamps | texture | again | set | set over again | denoised | worst block |
|---|---|---|---|---|---|---|---|""")
    for scene, _, lamps, textures, found, worst in rows:
        print(f"| {scene} | {words(lamps)} | {words(textures) if textures else ''} | {found['again']:.2f} | {found['set']:.2f}"
              f" | {found['set'] - found['again']:+.2f} | {found['denoised']:.2f} | {worst:+.2f} |")
    print(f"""
Over all: the set is {np.mean(gains):+.2f} dB from rendering again in the mean, {min(gains):+.2f} dB in the worst. Denoising, once
for all of these, gains {np.mean(cleaned):.2f} dB in the mean. `worst block`: what denoising gains in the worst block of 16x16
pixels; blocks beyond 55 dB before and after are left out.

## Bytes and times

The living room with more lamps (`tests/fidelity/scenes/lamps-living-room.pov`), {size}, {size_spp} samples, targets `Floor` and
`Wall`, denoised; in parentheses times what it is for the same room without `--lamps`. Times are processor seconds. `combine` is
with another floor, `relight` with two lamps changed too, by one thread.

| lamps | {" | ".join(row["lamps"] for row in sizes)} |
|---|{"---|" * len(sizes)}""")
    units = {"EXR": "MB", "pack": "MB", "render memory": "MB", "denoise memory": "MB"}
    for key in sizes[0]:
        if key != "lamps":
            cells = " | ".join(f"{row[key][0]:.{2 if row[key][0] < 10 else 0}f} {units.get(key, 's')} ({row[key][1]:.2f})"
                               for row in sizes)
            print(f"| {key} | {cells} |")
    print("""
Packs and rooms for browsers keep the light of a lamp as shares of all light, at steps that follow its own brightness
and how much of the lamp's light a number brings.

## What others do

- Light groups of Cycles, Arnold's AOVs of light groups and LightMix of Corona, V-Ray and Maxwell keep a picture for each lamp,
  with the textures baked into it. A new texture is a new render. retex writes such layers too: `retex-info --layers`.
- A [tutorial of Corona's LightMix](https://www.sanwenwang.com/ba/pbrjkfqf.html) warns of CXR files of more than ten gigabytes,
  and advises to put lights into groups. Here lamps are shares of one another's light, at the sizes above.
- A picture is split by lights or by materials; with both, each combination is a layer. Here the combination is what a set holds.
- A dim lamp that is turned up is noise, here as there. `--light-share` gives each lamp a least share of the samples, and every
  lamp is denoised with weights of its own.

## Limits

- Of several places on a target that one pixel sees, each lamp lights all in the proportion in which all lamps together do.
- A surface that emits by an image, or in several colours, is multiplied by a new colour.
- A lamp that has no light in one of red, green and blue is traced as white where that can be told (`light_source`); an emitting
  surface of a pure colour can be made brighter, but not get another colour.""")


if __name__ == "__main__":
    main()
