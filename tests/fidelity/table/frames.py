"""How much retextured frames flicker, as Markdown: frames.py WORK FRAMES HEAD SETTINGS SCENES SEEDS >MD

Also writes WORK/frames.csv, and WORK/frames.jpg: pictures of differences. R_t is frame t, T_t converged. The temporal
error is the root mean square of (R_t - T_t) - (R_t-1 - T_t-1), of colours as they are shown: sRGB-encoded and clipped
to 0..1. What is wrong in the same way in all frames is not in it; what changes is.
"""
import csv
import sys

import numpy as np

import pictures

KINDS = [("again", "again"), ("set-retextured", "retextured"), ("rival", "again denoised"),
         ("clean-retextured", "retextured denoised")]
GAIN = 8  # of the picture


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def errors(work, scene, seed, kind, frames, truth):
    found = []
    for t in range(frames):
        path = f"{work}/{scene}-seed{seed}-{kind}-{t + 1:02d}.exr"
        found.append(pictures.encoded(pictures.colours(path, truth[t].shape[:2])) - truth[t])
    return np.array(found)


def main():
    work, frames, head, settings, scenes, seeds = sys.argv[1:]
    frames, (height, spp, truth_spp) = int(frames), settings.split()
    rows, strips = [], []
    for scene in scenes.split():
        truth = np.split(pictures.encoded(pictures.colours(f"{work}/truth/pan-{scene}-{height}.exr")), frames)
        for seed in seeds.split():
            for kind, label in KINDS:
                e = errors(work, scene, seed, kind, frames, truth)
                steps = e[1:] - e[:-1]
                rows.append((scene, seed, label, rms(steps), rms(e)))
                if kind in ("rival", "clean-retextured") and seed == seeds.split()[0]:
                    strips.append((scene, label, steps[frames // 2]))
    with open(f"{work}/frames.csv", "w", encoding="ascii", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(("scene", "seed", "frames", "temporal", "still"))
        out.writerows((*row[:3], f"{row[3]:.6f}", f"{row[4]:.6f}") for row in rows)
    write_picture(work, strips)
    write_page(head, frames, height, spp, truth_spp, rows)


def write_picture(work, strips):
    """Two differences side by side for each scene."""
    bands = []
    for k in range(0, len(strips), 2):
        pair = [np.clip(0.5 + GAIN * s[2], 0, 1) for s in strips[k:k + 2]]
        gap = np.ones((pair[0].shape[0], 4, 3))
        bands.append(np.repeat(np.repeat(np.hstack([pair[0], gap, pair[1]]), 2, 0), 2, 1))
    wide = max(b.shape[1] for b in bands)
    padded = [np.pad(b, ((0, 8), (0, wide - b.shape[1]), (0, 0)), constant_values=1) for b in bands]
    pictures.write(f"{work}/frames.jpg", np.vstack(padded))


def mean(rows, scene, label, column):
    values = [row[column] for row in rows if row[0] == scene and row[2] == label]
    return float(np.sqrt(np.mean(np.square(values))))


def write_page(head, frames, height, spp, truth_spp, rows):
    scenes = list(dict.fromkeys(row[0] for row in rows))
    seeds = len({row[1] for row in rows})
    print(f"""# Frames of an animation

Whether retextured frames flicker. The camera moves through {frames} frames of {spp} samples, of {height}x{height} pixels
(cornell-box) and {int(height) * 4 // 3}x{int(height) * 3 // 4} (living-room). Every frame has noise of its own. The
frames are rendered as sets, denoised, and retextured. To compare, they are rendered again with the new textures and
denoised by the same filter. Converged frames T have {truth_spp} samples.

The temporal error is the root mean square of (R_t - T_t) - (R_t-1 - T_t-1), R being a frame: an error that stays where
it is does not count, one that changes from frame to frame does. The still error is that of R_t - T_t. Both are of
sRGB-encoded colours, 0 to 1, over all frames and {seeds} seed{"s" if seeds > 1 else ""}. The noise of the converged
frames is part of all of them. [frames.csv](frames.csv) has them by seed.
{head}

| scene | frames | temporal error | still error |
|---|---|---|---|""")
    for scene in scenes:
        for _, label in KINDS:
            print(f"| {scene} | {label} | {mean(rows, scene, label, 3):.4f} | {mean(rows, scene, label, 4):.4f} |")
    print(f"""
The scenes are `tests/fidelity/scenes/pan-cornell-box.pov`, with brick on the floor, and `pan-living-room.pov`, with
terrazzo on the floor and brick on the wall.

The picture shows (R_t - T_t) - (R_t-1 - T_t-1) at frame {frames // 2 + 2}, {GAIN} times as strong, around grey:
on the left rendered again and denoised, on the right retextured from a denoised set.

![](pictures/frames.jpg)""")


if __name__ == "__main__":
    main()
