"""The page of make bench-paper: paper_page.py RECORDS OUT.csv HEAD SIZE SPP

Prints what paper.sh measured as Markdown, and writes the figures as CSV.
"""
import csv
import json
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import paper as published

SCENES = {"living-room": "scenes/living-room", "artist": "the artist's living room", "kitchen": "scenes/kitchen",
          "cornell-box": "scenes/cornell-box", "glass-caustics": "scenes/glass-caustics"}
STORED = {
    "strict": "the paper's AOVs, EXR",
    "strict-half": "the same, UV and spread as half floats too",
    "jpeg": "the same, radiance as JPEG of quality {}",
    "set": "set, layout footprints",
    "pack": "its pack",
    "denoised": "set, denoised",
    "denoised-pack": "its pack",
}
# What they are in the paper, where they have another name there.
PUBLISHED_AS = {"strict-half": "aovs"}

INTRODUCTION = """# Sizes in the paper's form and in ours

{head}
[paper-sizes.csv](paper-sizes.csv) has the same figures.

Megabytes on disk of pictures of {size} with {spp} samples per pixel, without the original textures, which the paper
does not store. "The paper's AOVs" are the 33 images for one target of `retex-render --layout paper --strict-paper
--no-denoise-data`, in EXR with zip. "Radiance as JPEG" stores each of their radiance images as a JPEG, scaled to its
largest value and sRGB-encoded, and the others in EXR. The PSNR is that of a retextured picture from the smaller file
against the one from the EXR file. The paper's figures are those of its Living Room, at 1920x1080.
"Rousselle" are the buffers of `--control-data`, which are of the scene, whatever is changed.

The sets have denoising data. A denoised set has none.
"""
COLUMNS = ["scene", "targets", "what", "bytes", "psnr"]


def counted(what, stored):
    """Of the paper's form its AOVs, of all else the file without originals."""
    uses = stored["uses"]
    if what.startswith(("strict", "jpeg")):
        return uses["radiance"] + uses["UV"] + uses["spread"]
    return stored["bytes"] - uses.get("originals", 0)


def main(records, table, head, size, spp):
    with open(records, encoding="ascii") as file:
        found = [json.loads(line) for line in file]
    losses = {(r["scene"], r["targets"]): r["psnr"] for r in found if r["what"] == "pack-loss"}
    found = [r for r in found if r["what"] != "pack-loss"]
    for r in found:
        r["bytes"] = counted(r["what"], r["stored"])
        if r["what"] == "pack":
            r["psnr"] = losses[r["scene"], r["targets"]]
    with open(table, "w", encoding="ascii", newline="") as file:
        out = csv.DictWriter(file, COLUMNS, extrasaction="ignore", lineterminator="\n")
        out.writeheader()
        out.writerows({**r, "psnr": "" if r["psnr"] is None else f"{r['psnr']:.2f}"} for r in found)
    print(INTRODUCTION.format(head=head, size=size, spp=spp))
    print("| scene | targets | stored as | MB | PSNR | the paper |\n|---|---|---|---|---|---|")
    for r in found:
        kind, _, quality = r["what"].partition("-") if r["what"].startswith("jpeg") else (r["what"], "", "")
        count = len(r["targets"].split())
        known = published.MEGABYTES.get(PUBLISHED_AS.get(kind, kind)) if r["scene"] == "living-room" else None
        if kind.startswith("control"):
            name, targets = f"Rousselle, {kind.partition('-')[2]}", "any"
            theirs = ", ".join(map(str, known or ()))
        else:
            name, targets = STORED[kind].format(quality), " and ".join(r["targets"].split())
            theirs = known[count - 1] if known and count <= len(known) else ""
        psnr = "" if r["psnr"] is None else f"{r['psnr']:.1f} dB"
        print(f"| {SCENES[r['scene']]} | {targets} | {name} | {r['bytes'] / 1e6:.1f} | {psnr} | {theirs} |")


main(*sys.argv[1:])
