"""The page of make bench-storage: storage_page.py RECORDS OUT.csv HEAD SIZE SPP TRUTH-SPP

Prints what storage.sh measured as Markdown, and writes the figures as CSV.
"""
import csv
import json
import sys
from statistics import mean

METHODS = {
    "exr": "EXR, zip: the set itself",
    "lossless": "pack, `--lossless`",
    "dwaa": "EXR, DWAA of radiance",
    "dwaa-all": "EXR, DWAA of everything",
    "jpeg": "EXR, radiance as plain JPEG",
}
COLUMNS = ["scene", "layout", "set", "method", "level", "bytes", "bytes_without_originals", "bits_a_pixel", "psnr",
           "psnr_worst", "truth_loss", "truth_loss_worst", "noise_added", "noise_moved", "textures"]

INTRODUCTION = """# Size of stored sets, and what they lose

{head}
[storage.csv](storage.csv) has the same figures.

A set can be stored without loss or with loss. The sets here are of parts, {size} pixels, of pictures of
512x384, as in [fidelity.md](fidelity.md), with {spp} samples, and are denoised unless stated otherwise. Every
stored form is read again and retextured with {textures}. They are laid on the scenes' targets
as `make fidelity` does.

- *PSNR* compares these pictures with those of the original set (retex-diff: sRGB-encoded, clipped). The tables
  have the mean of the textures and the worst one.
- *Loss against truth* is the PSNR of the set's pictures against converged pictures, two of {truth_spp} samples each whose
  noise does not count, minus that of the stored form's pictures.
- For sets as rendered, two columns are shares of the noise, for the worst of the textures. The noise is the
  mean squared error of the set's pictures against converged ones. *adds* is the increase of that error by
  storing. *moves* is the mean squared difference from the set's pictures. If a pack removes noise, it moves,
  and adds less than 0.
- *Bits per pixel* leave out the originals, which do not grow with the picture. Megabytes are those of the whole
  file, and in brackets scaled to 1920x1080 without originals.

In the plot, full lines are means, dashed lines are the worst textures, and vertical lines are lossless forms.

The stored forms are:

- *pack* is `retex-pack`, with the `--codec` and the `--quality` in its name.
- *EXR, DWAA of radiance* stores radiance with OpenEXR's lossy DWAA of the level in its name, and the other
  parts unchanged. *EXR, DWAA of everything* is `oiiotool -a --compression dwaa:45` of the whole set, UV
  included. It has no row where a value became infinite: such a file is no set any more.
- *EXR, radiance as plain JPEG* stores each radiance image as a JPEG of the quality in its name, scaled to its
  largest value and sRGB-encoded, and the other parts as the set does. In layout `paper` this is the method of
  the paper.

![](pictures/storage.png)
"""


def read(path):
    """Of (scene, layout, set, method, level), the records of its textures."""
    found = {}
    with open(path, encoding="ascii") as file:
        for r in map(json.loads, file):
            found.setdefault((r["scene"], r["layout"], r["set"], r["method"], r["level"]), []).append(r)
    return found


def decibels(value):
    return f"{round(value, 3) + 0.0:.3f}"   # no -0.000


def noise_moved(record):
    """By how much storing changes a picture, in mean square, as a share of what the set was off by."""
    return 10 ** ((record["set_truth"] - record["psnr"]) / 10)


def figures(key, records, pixels):
    stored = records[0]["stored"]
    without = stored["bytes"] - stored["uses"]["originals"]
    psnrs = [r["psnr"] for r in records if r["psnr"] is not None]
    against = [r for r in records if None not in (r["truth"], r["set_truth"], r["psnr"])]
    losses = [r["set_truth"] - r["truth"] for r in against]
    row = dict(zip(COLUMNS, key), bytes=stored["bytes"], bytes_without_originals=without,
               bits_a_pixel=f"{8 * without / pixels:.3f}", textures=len(records))
    if len(psnrs) == len(records):
        row.update(psnr=f"{mean(psnrs):.2f}", psnr_worst=f"{min(psnrs):.2f}")
    if losses:
        row.update(truth_loss=decibels(mean(losses)), truth_loss_worst=decibels(max(losses)),
                   noise_added=f"{10 ** (max(losses) / 10) - 1:.4f}",
                   noise_moved=f"{max(map(noise_moved, against)):.4f}")
    return row


def name(row):
    method = METHODS.get(row["method"]) or f"pack, `--codec {row['method'].partition('-')[2]}`"
    return f"{method} {row['level']}".rstrip()


def megabytes(row, pixels):
    scaled = row["bytes_without_originals"] * 1920 * 1080 / pixels / 1e6
    return f"{row['bytes'] / 1e6:.2f} ({scaled:.1f})"


def section(scene, layout, rows, pixels):
    print(f"\n## {scene}, layout {layout}\n\n| stored as | MB | bits per pixel | PSNR, dB | worst |"
          " loss against truth, dB | worst |\n|---|---|---|---|---|---|---|")
    for row in rows:
        cells = [row.get(c, "") for c in ("bits_a_pixel", "psnr", "psnr_worst", "truth_loss", "truth_loss_worst")]
        print(f"| {name(row)} | {megabytes(row, pixels)} | {' | '.join(cells)} |")


def rendered(rows, pixels):
    print("\n## Sets as rendered\n\n| scene | layout | stored as | MB | bits per pixel | PSNR, dB | worst |"
          " loss against truth, dB | worst | adds, share of the noise | moves |\n"
          "|---|---|---|---|---|---|---|---|---|---|---|")
    for row in rows:
        cells = [row.get(c, "") for c in ("bits_a_pixel", "psnr", "psnr_worst", "truth_loss", "truth_loss_worst",
                                          "noise_added", "noise_moved")]
        print(f"| {row['scene']} | {row['layout']} | {name(row)} | {megabytes(row, pixels)} | {' | '.join(cells)} |")


def main(records, table, head, size, spp, truth_spp):
    found = read(records)
    pixels = int(size.partition("x")[0]) * int(size.partition("x")[2])
    textures = max((len(r) for r in found.values()), default=0)
    print(INTRODUCTION.format(head=head, size=size, spp=spp, truth_spp=truth_spp,
                              textures=f"{textures} textures" if textures > 1 else "one texture"), end="")
    rows = [figures(key, of, pixels) for key, of in found.items()]
    with open(table, "w", encoding="ascii", newline="") as file:
        out = csv.DictWriter(file, COLUMNS, lineterminator="\n", restval="")
        out.writeheader()
        out.writerows(rows)
    denoised = [r for r in rows if r["set"] == "denoised"]
    for scene, layout in dict.fromkeys((r["scene"], r["layout"]) for r in denoised):
        section(scene, layout, [r for r in denoised if (r["scene"], r["layout"]) == (scene, layout)], pixels)
    rendered([r for r in rows if r["set"] == "rendered"], pixels)


main(*sys.argv[1:])
