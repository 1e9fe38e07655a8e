"""retex-combine --solve of a colour against the best that colours and lamps can do, for solve.sh: FOLDER [SEED COUNT].

The mean of a region is a polynomial in the colours of the targets that are sought, by channel, and piecewise linear in the
strength of lamps. docs/read_set.py makes the pictures from which both are known. Channels do not depend on each other, so
that at some strength of the lamps the means that can be had are all between the least and the largest, by channel, on a
grid of colours: among these the nearest by CIEDE2000 is looked for, at each of a grid of strengths. With SEED and COUNT:
problems at random; the worst is told."""
import functools
import itertools
import os
import subprocess
import sys

import numpy as np

sys.path.insert(0, "docs")
import read_set  # noqa: E402

folder = sys.argv[1]
KNOTS = np.linspace(0, 1, 5)   # a polynomial of degree 4 is exact enough
GRID = np.linspace(0, 1, 9)
WORSE = 0.5                    # CIEDE2000
PROBLEMS = [                   # set, colour, region, what is sought
    ("grey", "#7d8f86", (9, 24, 18, 9), "Floor,Back,Ball"), ("grey", "#7e91f7", (9, 24, 18, 9), "Ball,Floor,Ceiling"),
    ("grey", "#406080", (0, 0, 48, 36), "Right"), ("lamps", "#0da25e", (3, 6, 12, 18), "Back,Floor,light:rest,light:light1"),
    ("lamps", "#7d8f86", (3, 6, 12, 18), "Back,Ball,light:light2,light:light1"), ("box", "#ffd100", (9, 24, 18, 9), "Floor"),
    ("box", "#c8102e", (9, 24, 18, 9), "Rest,Floor"), ("box", "#7c1dfb", (9, 24, 18, 9), "Floor,light:A")]
SOUGHT = {"grey": "Floor Back Ball Ceiling Right".split(), "box": "Floor Rest light:A light:B".split(),
          "lamps": "Floor Back Ball light:light1 light:light2 light:rest".split()}


def linear_of(color):
    code = np.array([int(color[i:i + 2], 16) for i in (1, 3, 5)]) / 255
    return np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)


def lab(rgb):
    matrix = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
    t = np.maximum(rgb, 0) @ matrix.T / matrix.sum(axis=1)
    x, y, z = np.moveaxis(np.where(t > (6 / 29) ** 3, np.cbrt(t), t / (3 * (6 / 29) ** 2) + 4 / 29), -1, 0)
    return 116 * y - 16, 500 * (x - y), 200 * (y - z)


def ciede2000(one, two):
    """Sharma, Wu and Dalal 2005, of linear colours."""
    (l1, a1, b1), (l2, a2, b2) = lab(one), lab(two)
    share = lambda c: np.sqrt(c ** 7 / (c ** 7 + 25.0 ** 7))
    grey = 1.5 - 0.5 * share((np.hypot(a1, b1) + np.hypot(a2, b2)) / 2)
    c1, c2 = np.hypot(grey * a1, b1), np.hypot(grey * a2, b2)
    h1, h2 = np.degrees(np.arctan2(b1, grey * a1)), np.degrees(np.arctan2(b2, grey * a2))
    turn = (h2 - h1 + 180) % 360 - 180
    l, c, h = (l1 + l2) / 2, (c1 + c2) / 2, (h1 + turn / 2) % 360
    cosine = lambda times, less: np.cos(np.radians(times * h - less))
    t = 1 - 0.17 * cosine(1, 30) + 0.24 * cosine(2, 0) + 0.32 * cosine(3, -6) - 0.2 * cosine(4, 63)
    dl = (l2 - l1) / (1 + 0.015 * (l - 50) ** 2 / np.sqrt(20 + (l - 50) ** 2))
    dc, dh = (c2 - c1) / (1 + 0.045 * c), 2 * np.sqrt(c1 * c2) * np.sin(np.radians(turn / 2)) / (1 + 0.015 * c * t)
    return np.sqrt(dl ** 2 + dc ** 2 + dh ** 2 -
                   2 * share(c) * np.sin(np.radians(60 * np.exp(-((h - 275) / 25) ** 2))) * dc * dh)


class Plain(read_set.Picture):
    """Of constant colours nothing need be looked up."""

    def average(self, footprint, texels):
        return np.where(self.parts[footprint["uv"]][:, :, 2:] > 0, texels[0, 0], [0, 0, 0, 1])


read_file = functools.lru_cache(None)(read_set.read_file)
read_set.read_file = read_file


class Region:
    def __init__(self, path, region, sought):
        self.path, self.region = path, region
        self.targets = [name for name in sought if ":" not in name]
        self.lamps = [name[6:] for name in sought if ":" in name]
        values = {p["name"]: np.array(p["value"]) for p in read_file(path)[0]["parameters"] if p["kind"] == "color"}
        self.others = [name for name in values if name not in self.lamps]
        parts = {"all": values}  # the light of all, of each lamp alone, and of what is not sought
        if self.lamps:
            parts |= {name: {k: (k == name) * v for k, v in values.items()} for name in self.lamps}
            parts["others"] = {k: (k in self.others) * v for k, v in values.items()}
        self.means = {name: self.on_grid(lights) for name, lights in parts.items()}

    def on_grid(self, lights):
        x, y, w, h = self.region
        means = []
        for values in itertools.product(KNOTS, repeat=len(self.targets)):
            textures = {t: {"color": np.array([[[v, v, v, 1.0]]])} for t, v in zip(self.targets, values)}
            means.append(Plain(self.path, textures, {}, lights).make()[y:y + h, x:x + w].mean(axis=(0, 1)))
        means = np.array(means).reshape((len(KNOTS),) * len(self.targets) + (3,))
        lagrange = np.array([[np.prod([(x - b) / (a - b) for b in KNOTS if b != a]) for a in KNOTS] for x in GRID])
        for axis in range(len(self.targets)):
            means = np.moveaxis(np.tensordot(lagrange, means, (1, axis)), 0, axis)
        return means.reshape(-1, 3)

    def best(self, wanted):
        """What all lamps have in common is that much of all light; a lamp's own light is what it has beyond."""
        strengths = np.concatenate([[0], 10 ** np.linspace(-2, 3, 26)])
        least = np.inf
        for gains in itertools.product(strengths, repeat=len(self.lamps)):
            common = min([*gains] + [1] * bool(self.others)) if gains else 1
            means = common * self.means["all"]
            for name, gain in zip(self.lamps, gains):
                means = means + (gain - common) * self.means[name]
            means = means + (1 - common) * self.means["others"] if self.lamps and self.others else means
            least = min(least, nearest(np.maximum(means.min(axis=0), 0), means.max(axis=0), wanted))
            if least == 0:
                break
        return least


def nearest(low, high, wanted):
    """The least difference from the colours between low and high: on a grid of cube roots, and finer ones about the best."""
    if (low <= wanted).all() and (wanted <= high).all():
        return 0
    ends, least = np.cbrt([low, high]), np.inf
    begin, end = ends
    for _ in range(5):
        colors = np.stack(np.meshgrid(*np.linspace(begin, end, 15).T, indexing="ij"), -1).reshape(-1, 3)
        far = ciede2000(colors ** 3, wanted)
        at, step, least = colors[far.argmin()], (end - begin) / 7, min(least, far.min())
        begin, end = np.maximum(at - step, ends[0]), np.minimum(at + step, ends[1])
    return least


def solve(path, color, region, sought):
    command = ["retex-combine", "-q", path, "--solve", color, "--region", ",".join(map(str, region)), "--free", sought]
    return float(subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True).stdout.split()[-1])


def random_problems(random, count):
    for name in itertools.islice(itertools.cycle(SOUGHT), count):
        sought = [str(x) for x in random.permutation(SOUGHT[name])[:random.integers(1, 5)]]
        while sum(":" not in x for x in sought) > 3 or sum(":" in x for x in sought) > 2:
            sought.pop()
        region = [(0, 0, 48, 36), (9, 24, 18, 9), (18, 12, 15, 8), (3, 6, 12, 18)][random.integers(4)]
        yield name, "#%02x%02x%02x" % tuple(random.integers(0, 256, 3)), region, ",".join(sought)


if len(sys.argv) > 2:
    PROBLEMS = list(random_problems(np.random.default_rng(int(sys.argv[2])), int(sys.argv[3])))
known, worst = {}, 0
for number, (name, color, region, sought) in enumerate(PROBLEMS, 1):
    path = os.path.join(folder, name + ".exr")
    reached = solve(path, color, region, sought)
    if (name, region, sought) not in known:
        known[name, region, sought] = Region(path, region, sought.split(","))
    best = known[name, region, sought].best(linear_of(color))
    worst = max(worst, reached - best)
    title = f"{name}, {color} in {','.join(map(str, region))} by {sought}: CIEDE2000 {reached:.2f}, of a grid {best:.2f}"
    print(f"{'ok' if reached <= best + WORSE else 'not ok'} {number} - {title}", flush=True)
print(f"# at most {worst:.2f} worse\n1..{len(PROBLEMS)}")
