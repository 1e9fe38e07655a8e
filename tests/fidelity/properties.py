"""For properties.sh, here and in ../long: properties.py FIRST LAST [TENTH] checks what must hold of any scene, in random
scenes of make_scene, by their seed. Prints TAP: a test for each property, and where it fails each scene with what is
wrong. With TENTH only the scenes whose seed ends in this digit. PROPERTIES='mirrored scaled' selects properties."""
import math
import os
import re
import subprocess
import sys
import tempfile

import numpy as np
import OpenImageIO as oiio

WIDTH, HEIGHT, SPP = 40, 24, 4  # bands of 16 rows: the last one is shorter
RENDER = ["retex-render", "-q", "--threads", "1", "--size", f"{WIDTH}x{HEIGHT}", "--spp", str(SPP)]
SPLIT = ["-t", "Floor", "-t", "Floor2", "-t", "Thing"]
IMAGE = {"All": "tests/golden/warm.ppm"}
WHOLE = ["-t", "All=Floor,Floor2", "-t", "Thing"]


class Broken(Exception):
    """What is wrong with a scene."""


class Scene:
    """A random scene, and what was made of it: each command runs once."""

    def __init__(self, seed, folder):
        self.seed, self.folder, self.made = seed, folder, {}
        self.text = os.path.join(folder, "scene.pov")
        with open(self.text, "wb") as file:
            file.write(subprocess.run(["make_scene", str(seed)], check=True, stdout=subprocess.PIPE).stdout)

    def read(self):
        with open(self.text, encoding="ascii") as file:
            return file.read()

    def run(self, *command, ending="exr"):
        """The output of a command, written with -o."""
        command = tuple(str(word) for word in command)
        if command not in self.made:
            output = os.path.join(self.folder, f"{len(self.made)}.{ending}")
            done = subprocess.run([*command, "-o", output], stderr=subprocess.PIPE, check=False)
            if done.returncode:
                raise Broken(" ".join(command[:1]) + ": " + done.stderr.decode(errors="replace").strip())
            self.made[command] = output
        return self.made[command]

    def render(self, *options):
        return self.run(*RENDER, *options, self.text)

    def combine(self, path, *options):
        return self.run("retex-combine", "-q", "--threads", "1", path, *options)

    def one_of(self, a, b):
        """By the seed, also among those that end in the same digit."""
        return (a, b)[self.seed // 10 % 2]

    def colours(self, *targets):
        """Of targets, which the scene's seed decides."""
        random = np.random.default_rng(self.seed)
        return {target: "rgb({:.3f},{:.3f},{:.3f})".format(*random.uniform(0.05, 0.95, 3)) for target in targets}


def options(name, edit):
    return [word for target, colour in edit.items() for word in (name, f"{target}={colour}")]


def pixels(path):
    """Of a picture, or of a set's first part."""
    picture = oiio.ImageInput.open(path)
    values = picture.read_image("float")
    picture.close()
    return values[:, :, :3].astype(np.float64)


def encoded(values):
    values = np.clip(values, 0, 1)
    return np.where(values <= 0.0031308, 12.92 * values, 1.055 * values ** (1 / 2.4) - 0.055)


def same_bits(a, b, smallest=0):
    different = np.count_nonzero(~(np.abs(a - b) <= smallest))
    if a.shape != b.shape or different:
        raise Broken(f"{different} values of {b.size} differ, by up to {np.abs(a - b).max():g}")


def same_file(a, b):
    with open(a, "rb") as file, open(b, "rb") as other:
        if file.read() != other.read():
            raise Broken(f"{os.path.basename(a)} and {os.path.basename(b)} are not the same bytes")


def decibels(a, b):
    """The PSNR of retex-diff."""
    if not (np.isfinite(a).all() and np.isfinite(b).all()):
        return 0
    error = np.mean((encoded(a) - encoded(b)) ** 2)
    return 120 if error < 1e-12 else -10 * math.log10(error)


def near(a, b, least):
    found = decibels(a, b)
    if not found >= least:
        raise Broken(f"{found:.1f} dB, should be {least}")
    return found


# ---- properties: each has a scene, raises Broken or returns decibels, if these say how well it holds ----

def recombined(scene):
    """A set is the picture; also where all its terms are added up, with the colour of one target given as it is."""
    thing = "Thing=rgb" + re.search(r"Thing = texture . pigment . rgb <(.*?)>", scene.read()).group(1).join("()")
    for layout in ("footprints", "paper"):
        path = scene.render(*WHOLE, "--full-precision", "--max-depth", 5, "--layout", layout)
        plain = pixels(scene.render("--plain", "--max-depth", 5))
        near(pixels(scene.combine(path)), plain, 100)
        found = near(pixels(scene.combine(path, "--texture", thing)), plain, 70)
    return found


def recoloured(scene):
    """A set with colours is the picture with these, where no path has more hits than the set keeps."""
    edit = scene.colours("All", "Thing")
    path = scene.render(*WHOLE, "--full-precision", "--max-depth", 5)
    truth = scene.render(*WHOLE, "--plain", "--max-depth", 5, *options("--replace", edit))
    return near(pixels(scene.combine(path, *options("--texture", edit))), pixels(truth), 60)


def piped(scene):
    """Samples that are combined are the retexture in one step."""
    path, edit = scene.render(*WHOLE), {**IMAGE, **scene.colours("Thing")}
    samples = scene.run("retex-sample", "-q", path, *options("--texture", edit))
    same_bits(pixels(scene.combine(path, samples)), pixels(scene.combine(path, *options("--texture", edit))))


def lossless(scene):
    """A pack without loss is the set: the same file again, the same picture."""
    edit = options("--texture", IMAGE)
    path = scene.render(*WHOLE, *scene.one_of(["--lamps", "each"], ["--full-precision"]))
    pack = scene.run("retex-pack", "-q", "--lossless", path, ending="retex")
    same_file(scene.run("retex-pack", "-q", "--unpack", pack), path)
    same_bits(pixels(scene.combine(pack, *edit)), pixels(scene.combine(path, *edit)))


def cropped(scene):
    """A part of the picture, with other threads, is that of the whole."""
    x, y, width, height = 5, 3, 31, 17
    part = pixels(scene.render("--plain", "--threads", 3, "--crop", f"{x},{y},{width},{height}"))
    same_bits(part, pixels(scene.render("--plain"))[y:y + height, x:x + width])
    edit = options("--texture", IMAGE)
    path = scene.render(*WHOLE)
    part = pixels(scene.combine(path, *edit, "--crop", f"{x},{y},{width},{height}"))
    same_bits(part, pixels(scene.combine(path, *edit))[y:y + height, x:x + width])


def frames(scene):
    """Frames are single renders at their clock, each with its own seed."""
    name = os.path.join(scene.folder, "frame%d")
    subprocess.run([*RENDER, "--plain", "--seed", "5", "--frames", "1-3x2", scene.text, "-o", name + ".exr"], check=True)
    for frame, clock in ((1, 0), (3, 1)):
        single = scene.render("--plain", "--seed", 5 + frame, "-D", f"clock={clock}")
        same_bits(pixels(name % frame + ".exr"), pixels(single))


def summed(scene):
    """The lamps one by one add up to all of them."""
    path = scene.render(*WHOLE, "--lamps", "each", "--full-precision")
    told = subprocess.run(["retex-info", path], check=True, stdout=subprocess.PIPE).stdout.decode().split("\n")
    lamps = [line.split()[1] for line in told if line.startswith("parameter ")]
    edit = options("--texture", scene.colours("All", "Thing"))
    total = sum(pixels(scene.combine(path, "--solo", lamp, *edit)) for lamp in lamps)
    return near(total, pixels(scene.combine(path, *edit)), 60)


def brighter(scene):
    """Twice the light is twice the picture, to the bit of halves, and twice the retexture."""
    bright, dim = (pixels(scene.render("--plain", "-D", f"Bright={k}")) for k in (2, 1))
    same_bits(bright, 2 * dim, 2**-23)
    edit = options("--texture", scene.colours("All", "Thing"))
    bright, dim = (scene.render(*WHOLE, "--full-precision", "-D", f"Bright={k}") for k in (2, 1))
    return near(pixels(scene.combine(bright, *edit)) / 2, pixels(scene.combine(dim, *edit)), 90)


def scaled(scene):
    """The picture does not tell how large scene and camera are."""
    size = scene.one_of(1 / 64, 32)
    same_bits(pixels(scene.render("--plain", "-D", f"Size={size}")), pixels(scene.render("--plain")))


def split(scene):
    """A target that is split in two, both with the same colour."""
    edit = scene.colours("All", "Thing")
    parts = {"Floor": edit["All"], "Floor2": edit["All"], "Thing": edit["Thing"]}
    of_parts = scene.combine(scene.render(*SPLIT, "--full-precision", "--max-depth", 5), *options("--texture", parts))
    of_whole = scene.combine(scene.render(*WHOLE, "--full-precision", "--max-depth", 5), *options("--texture", edit))
    return near(pixels(of_parts), pixels(of_whole), 50)


def mirrored(scene):
    """The mirrored scene is the mirrored picture, in the means of blocks within the noise of eight seeds."""
    means = []
    for side in (1, -1):
        name = os.path.join(scene.folder, f"side{side}-%d.exr")
        subprocess.run([*RENDER, "--plain", "--frames", "1-8", "-D", f"Mirror={side}", scene.text, "-o", name],
                       check=True)
        seeds = np.array([pixels(name % k)[:, ::side] for k in range(1, 9)])
        means.append(seeds.reshape(8, 3, HEIGHT // 3, 4, WIDTH // 4, 3).mean(axis=(2, 4)))
    a, b = means
    difference = np.abs(a.mean(axis=0) - b.mean(axis=0))
    noise = np.sqrt((a.var(axis=0, ddof=1) + b.var(axis=0, ddof=1)) / 8)
    if (difference > 8 * noise + 1e-5).any():
        worst = np.argmax(difference / (noise + 1e-9))
        raise Broken(f"block {worst // 3} is off by {difference.flat[worst]:g}, its noise is {noise.flat[worst]:g}")


PROPERTIES = [recombined, recoloured, piped, lossless, cropped, frames, summed, brighter, scaled, split, mirrored]


def check(prop, scene):
    """(decibels or None, what is wrong or None)."""
    try:
        return prop(scene), None
    except Broken as why:
        return None, str(why)


def main():
    first, last = map(int, sys.argv[1:3])
    seeds = [seed for seed in range(first, last + 1) if not sys.argv[3:] or seed % 10 == int(sys.argv[3])]
    wanted = os.environ.get("PROPERTIES", "").split()
    chosen = [prop for prop in PROPERTIES if not wanted or prop.__name__ in wanted]
    found = {prop: [] for prop in chosen}
    for seed in seeds:
        with tempfile.TemporaryDirectory() as folder:
            scene = Scene(seed, folder)
            for prop in chosen:
                found[prop].append((seed, *check(prop, scene)))
                if found[prop][-1][2]:
                    print(f"# {prop.__name__}, scene {seed}: {found[prop][-1][2]}", flush=True)
    print(f"1..{len(chosen)}")
    for number, prop in enumerate(chosen, 1):
        wrong = sum(why is not None for _, _, why in found[prop])
        levels = [level for _, level, _ in found[prop] if level is not None]
        print(f"{'not ' if wrong or not seeds else ''}ok {number} - {prop.__name__}: {len(seeds)} scenes"
              + (f", at least {min(levels):.1f} dB" if levels else ""))


if __name__ == "__main__":
    main()
