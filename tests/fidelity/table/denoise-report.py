"""The table of `make fidelity-denoise` as Markdown, and its pictures: denoise-report.py WORK HEAD PART TRUTH-SPP NOTES TRIED

Reads WORK/denoise.csv and writes WORK/pictures/denoise-SCENE.jpg. NOTES is a file of Markdown, put where the rival is
compared, if it is there: what figures do not say.
"""
import csv
import os
import sys

import numpy as np

import pictures
import regions

LABELS = [("again", 128, "again, 128"), ("set", 128, "set, 128"), ("denoised", 128, "denoised, 128"),
          ("rival", 128, "again denoised, 128"), ("again", 512, "again, 512"), ("set", 1024, "set, 1024"),
          ("denoised", 1024, "denoised, 1024"), ("paper", 128, "layout paper, 128"),
          ("paper-denoised", 128, "layout paper denoised, 128")]
DETAIL = ["checker", "wood", "grout", "text", "photo"]
SHOWN = [("glass-caustics", "wood"), ("living-room", "text"), ("glossy-pair", "photo")]
REGIONS = ["all"] + regions.NAMES


class Table:
    """Figures by scene, texture, region, method, samples and seed."""

    def __init__(self, path):
        self.psnr, self.flip, self.interval, self.scenes, self.textures, self.seeds = {}, {}, {}, [], [], {}
        with open(path, encoding="ascii") as file:
            for row in csv.DictReader(file):
                kind = row["method"], int(row["samples"])
                key = row["scene"], row["texture"], row["region"], *kind, int(row["seed"])
                if key in self.psnr:
                    pictures.fail(f"{path} has {key} twice")
                self.psnr[key] = float(row["psnr"])
                self.interval[key] = float(row["gain_interval"])
                if row["flip"]:
                    self.flip[key] = float(row["flip"])
                for name, names in ((row["scene"], self.scenes), (row["texture"], self.textures),
                                    (int(row["seed"]), self.seeds.setdefault(kind, []))):
                    if name not in names:
                        names.append(name)
        if not self.psnr:
            pictures.fail(f"{path} is empty")

    def values(self, kind, region="all", scenes=None, textures=None, seed=None, of=None):
        """One a scene and texture, the mean of its seeds; none where the scene lacks the region."""
        of = self.psnr if of is None else of
        found = {}
        for scene in scenes or self.scenes:
            for texture in textures or self.textures:
                if (scene, texture, region, *kind, self.seeds[kind][0]) in of:
                    found[scene, texture] = np.mean([of[scene, texture, region, *kind, s]
                                                     for s in ([seed] if seed else self.seeds[kind])])
        return found

    def gains(self, kind, over, **which):
        a, b = self.values(kind, **which), self.values(over, **which)
        return {key: a[key] - b[key] for key in a}

    def mean(self, kind, **which):
        return mean(self.values(kind, **which))

    def gain(self, kind, over, **which):
        return mean(self.gains(kind, over, **which))

    def around(self, kind):
        """The mean gain over the set of 128 samples with its interval: textures of one scene share their paths."""
        by_scene = {}
        for (scene, _), half in self.values(kind, seed=self.seeds[kind][0], of=self.interval).items():
            by_scene.setdefault(scene, []).append(half)
        half = np.sqrt(sum(sum(halves) ** 2 for halves in by_scene.values())) / sum(map(len, by_scene.values()))
        return f"{signed(self.gain(kind, SET))} ± {half:.2f}"


def mean(values):
    return float(np.mean(list(values.values()))) if values else None


def signed(value):
    return "" if value is None else f"{value:+.2f}"


def plain(value):
    return "" if value is None else f"{value:.2f}"


def table(heads, rows):
    print("\n| " + " | ".join(heads) + " |\n|" + "---|" * len(heads))
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


SET, DENOISED, AGAIN, MORE, RIVAL = ("set", 128), ("denoised", 128), ("again", 128), ("again", 512), ("rival", 128)
MANY, MANY_DENOISED = ("set", 1024), ("denoised", 1024)


def count_of_seeds(t):
    count = len(t.seeds[SET])
    return "1 seed" if count == 1 else f"{count} seeds"


def worst_seeds(t):
    """By scene and region: the seed of the least gain, mean over textures, and that gain."""
    found = {}
    for scene in t.scenes:
        for region in REGIONS:
            by_seed = [(t.gain(DENOISED, SET, region=region, scenes=[scene], seed=s), s) for s in t.seeds[SET]]
            if by_seed[0][0] is not None:
                found[scene, region] = min(by_seed)
    return found


def least(t, kind, over, **which):
    """The least gain of all textures, seeds, and the region and scenes given, and where."""
    return min(((gain, *where, seed) for seed in t.seeds[kind]
                for where, gain in t.gains(kind, over, seed=seed, **which).items()), default=None)


def asked(t):
    seeds = worst_seeds(t)
    (below, seed), (scene, region) = min((value, key) for key, value in seeds.items())
    whole = least(t, MANY_DENOISED, MANY)
    many = min((*least(t, MANY_DENOISED, MANY, region=r), r) for r in REGIONS if t.values(MANY, region=r))
    detail = [x for x in DETAIL if x in t.textures]
    lost = [x for x in detail if t.gain(DENOISED, RIVAL, textures=[x]) <= 0]
    rows = [("at 128 samples at least as good as rendered again with 512 samples, mean",
             signed(t.gain(DENOISED, MORE)) + " dB", t.gain(DENOISED, MORE) >= 0),
            ("at 128 samples 6 dB over the set, mean", signed(t.gain(DENOISED, SET)) + " dB",
             t.gain(DENOISED, SET) >= 6),
            ("in no scene and region worse than the set by more than 0.1 dB, mean of textures, "
             f"for each of {count_of_seeds(t)}",
             f"least {signed(below)} dB: {scene}, {region}, seed {seed}", below >= -0.1),
            ("at 1024 samples never worse than the set, in whole pictures, for each scene and texture",
             f"least {signed(whole[0])} dB: {whole[1]}, {whole[2]}", whole[0] >= 0),
            ("the same for each region",
             f"least {signed(many[0])} dB: {many[1]}, {many[2]}, {many[4]}", many[0] >= 0),
            ("better than rendered again and denoised, for each texture with detail, mean of scenes",
             "yes" if not lost else "not on " + ", ".join(lost), not lost)]
    table(["requirement", "result", ""], [(text, found, "met" if met else "**not met**") for text, found, met in rows])


def summary(t):
    rows = []
    for method, samples, label in LABELS:
        kind = method, samples
        if kind in t.seeds:
            rows.append([label, plain(t.mean(kind))] + [t.around(kind)] +
                        [signed(t.gain(kind, over)) for over in (AGAIN, MORE)] +
                        [f"{t.mean(kind, of=t.flip):.4f}"])
    table(["picture", "PSNR", "over the set, 128", "over again, 128", "over again, 512", "FLIP"], rows)


def by(t, head, names, which):
    rows = []
    for name in names:
        if t.values(SET, **which(name)):
            rows.append([name, plain(t.mean(SET, **which(name)))] +
                        [signed(t.gain(kind, SET, **which(name))) for kind in (AGAIN, MORE, RIVAL, DENOISED)] +
                        [signed(t.gain(MANY_DENOISED, MANY, **which(name)))])
    table([head, "set, 128", "again, 128", "again, 512", "again denoised, 128", "denoised, 128",
           "denoised over set, both 1024"], rows)


def by_scene_and_region(t, cell):
    rows = [[scene] + [cell(scene, region) for region in REGIONS] for scene in t.scenes]
    table(["scene"] + REGIONS, rows)


def least_cell(t, kind, over):
    def cell(scene, region):
        found = least(t, kind, over, scenes=[scene], region=region)
        return f"{found[0]:+.2f} {found[2]}" if found else ""
    return cell


def against_rival(t):
    rows = []
    for texture in t.textures:
        gains = t.gains(DENOISED, RIVAL, textures=[texture])
        lowest = min(gains, key=gains.get)
        rows.append([texture + (" (detail)" if texture in DETAIL else ""), plain(t.mean(RIVAL, textures=[texture])),
                     plain(t.mean(DENOISED, textures=[texture])), signed(mean(gains)),
                     f"{sum(g > 0 for g in gains.values())} of {len(gains)}", f"{gains[lowest]:+.2f} {lowest[0]}",
                     f"{t.mean(RIVAL, textures=[texture], of=t.flip):.4f}",
                     f"{t.mean(DENOISED, textures=[texture], of=t.flip):.4f}"])
    table(["texture", "again denoised", "denoised", "gain", "better in", "least", "FLIP, again denoised",
           "FLIP, denoised"], rows)
    print("Gain by scene and texture, whole pictures:")
    table(["scene"] + t.textures,
          [[scene] + [signed(t.gain(DENOISED, RIVAL, scenes=[scene], textures=[x])) for x in t.textures]
           for scene in t.scenes])
    print("By scene and region, mean of textures:")
    by_scene_and_region(t, lambda s, r: signed(t.gain(DENOISED, RIVAL, scenes=[s], region=r)))


def strip(work, scene, texture):
    """Truth, set, denoised, again with 512, again denoised; below, the regions and what they differ by."""
    truth = pictures.encoded(pictures.colours(f"{work}/truth/{scene}-{texture}.exr"))
    gap = np.ones((truth.shape[0], 4, 3))
    above, below = [truth], [np.array(regions.FALSE_COLOURS)[regions.of_scene(work, scene)]]
    for folder, end in (("retextured", "128-footprints"), ("retextured", "128-denoised"), ("again", "512"),
                        ("again", "128-rival")):
        picture = pictures.encoded(pictures.colours(f"{work}/{folder}/{scene}-{texture}-{end}.exr", truth.shape[:2]))
        above += [gap, picture]
        below += [gap, 0.5 + 4 * (picture - truth)]
    rows = np.hstack(above), np.hstack(below)
    os.makedirs(f"{work}/pictures", exist_ok=True)
    between = np.ones((4, rows[0].shape[1], 3))
    pictures.write(f"{work}/pictures/denoise-{scene}.jpg", np.vstack([rows[0], between, rows[1]]),
                   ("Compression", "jpeg:92"))


def copy(text):
    if os.path.exists(text):
        with open(text, encoding="utf-8") as file:
            print(file.read())


def main(work, head, part, truth_samples, notes, tried):
    t = Table(f"{work}/denoise.csv")
    print(f"""# Denoised sets compared with rendering again

The figures are PSNR in decibels (sRGB-encoded, clipped to 0..1) and mean FLIP, against converged pictures,
two of {truth_samples} samples each. Pictures are parts, {part} pixels, of pictures of 512x384. The noise of the converged
pictures does not count for PSNR, but does for FLIP. The rows are:

- `set`: a set, layout footprints, retextured;
- `denoised`: the same after `retex-denoise`;
- `again`: the scene rendered again with the new texture;
- `again denoised`: that with `--denoise`. It uses the same filter, and is therefore a fair comparison. It must filter
  each texture anew, and sees the texture only with its noise.

Sets of 128 samples have {count_of_seeds(t)}, everything else has one. Means are over all scenes, textures and seeds.
Scenes and textures are those of [fidelity.md](fidelity.md). After ± is half of an interval of 95 %, over places in the
picture. [denoise.csv](denoise.csv) has all figures.
{head}""")
    asked(t)
    print("## Means")
    summary(t)
    print("""## By region

A pixel is in the first of these regions that applies:

- `glass-mirror`: the first hit is sharper than roughness 0.1;
- `silhouette`: next to an edge between surfaces;
- `caustic` (in glass-caustics only): glass or a mirror concentrates light there;
- `shadow-edge`: direct light changes by 8 % or more from pixel to pixel;
- `smooth`: everything else.

`tests/fidelity/table/regions.py` finds regions from first hits and from light that is nearly free of noise. Regions of
fewer than 60 pixels are left out. The table has the PSNR of the set, and gains over it:""")
    by(t, "region", REGIONS, lambda name: {"region": name})
    print("## By scene")
    by(t, "scene", t.scenes, lambda name: {"scenes": [name]})
    print("## By texture")
    by(t, "texture", t.textures, lambda name: {"textures": [name]})
    print("""## Worst cases

128 samples, denoised over set: mean over textures, for the seed with the least mean:""")
    seeds = worst_seeds(t)
    by_scene_and_region(t, lambda s, r: f"{seeds[s, r][0]:+.2f}" if (s, r) in seeds else "")
    print("The least of all textures and seeds, with the texture:")
    by_scene_and_region(t, least_cell(t, DENOISED, SET))
    print("1024 samples, denoised over set: the least of all textures, with the texture:")
    by_scene_and_region(t, least_cell(t, MANY_DENOISED, MANY))
    print("## Compared with rendering again and denoising\n\n128 samples, whole pictures, mean of scenes:")
    against_rival(t)
    copy(notes)
    print("## Layout paper\n\n128 samples, one seed, whole pictures:")
    table(["scene", "set", "denoised", "gain"],
          [[s, plain(t.mean(("paper", 128), scenes=[s])), plain(t.mean(("paper-denoised", 128), scenes=[s])),
            signed(t.gain(("paper-denoised", 128), ("paper", 128), scenes=[s]))] for s in t.scenes])
    copy(tried)
    print("""## Pictures

From left to right: the converged picture, the set, the denoised set, rendered again with 512 samples, and rendered
again with 128 samples and denoised. Below the converged picture are the regions: grey smooth, white silhouette, blue
glass and mirror, yellow caustic, red shadow edge. Below the others is their difference from the converged picture,
sRGB-encoded, multiplied by four, around middle grey.""")
    for scene, texture in SHOWN:
        if scene in t.scenes and texture in t.textures:
            strip(work, scene, texture)
            print(f"\n{scene}, {texture}:\n\n![{scene}, {texture}](pictures/denoise-{scene}.jpg)")


main(*sys.argv[1:])
