#!/usr/bin/python3
"""Reads a set of retex, with textures laid on it or not, and makes its picture: retex-set(5) as a program.

    read_set.py SET.exr PICTURE.pfm [Floor=0.8,0.2,0.1] [Wall=oak.png] [finish:Floor=polished] [light:Lamp=1.2,1,0.8]
Colours are scene-linear, an image is laid once on each unit of u and v, a lamp takes a new value. Made to be read, it
holds the whole set, and looks textures up at many points of each footprint. Needs python3-openimageio, -numpy."""
import functools
import json
import sys
import zlib

import numpy as np
import OpenImageIO as oiio

POINTS = 24  # 24 x 24 points of each footprint
KNOWN = {
    "version": [1], "kind of file": ["set", "stream"], "kind of parameter": ["color", "correction"],
    "kind of factor": ["footprint", "mixture", "image", "parameter"], "quantity": ["color", "further"],
    "role": "full indep dep cross2 cross3 sharp broad interreflection correction picture lamp lamp_picture".split()}


def known(what, value):
    return value if value in KNOWN[what] else sys.exit(f"read_set.py: unknown {what}: {value}")


def read_file(path):
    """The manifest, and the parts that it lists: {name: height x width x channels}."""
    file = oiio.ImageInput.open(path)
    text = file and file.spec().getattribute("retex")
    text or sys.exit(f"read_set.py: {path} is no set")
    manifest, begin = json.loads(text), '{"retex":1,"crc32":"'
    known("version", manifest["retex"] if "parameters" in manifest else "before the release")
    known("kind of file", manifest["kind"])
    blank = begin + "00000000" + text[len(begin) + 8:]
    zlib.crc32(blank.encode()) == int(manifest["crc32"], 16) or sys.exit("read_set.py: the manifest is damaged")
    listed, parts, index = {part["name"]: part for part in manifest["parts"]}, {}, 0
    while file.seek_subimage(index, 0):
        part, channels = listed.get(file.spec().getattribute("name")), list(file.spec().channelnames)
        if part:  # channels are found by name, for EXR sorts them; those of part 0 have no prefix
            order = [channels.index(f"{part['name']}.{letter}" if index else letter) for letter in part["letters"]]
            planes = file.read_image(index, 0, 0, len(channels), "float")[:, :, order].transpose(2, 0, 1)
            planes = np.ascontiguousarray(planes, {"half": "<f2", "float": "<f4"}[part["type"]])
            zlib.crc32(planes.tobytes()) == int(part["crc32"], 16) or sys.exit(f"read_set.py: damaged: {part['name']}")
            parts[part["name"]] = planes.transpose(1, 2, 0).astype(float)
        index += 1
    return manifest, parts

def read_image(path):
    """Texels of red, green and blue, which are multiplied by alpha, and alpha: height x width x 4."""
    wanted = oiio.ImageSpec()
    wanted.attribute("oiio:UnassociatedAlpha", 1)
    image = oiio.ImageBuf(path, 0, 0, wanted)
    texels, is_linear = image.get_pixels(oiio.FLOAT).astype(float), str(image.spec().format) in ("float", "half")
    c, alpha = texels[:, :, :3], texels[:, :, 3:] if texels.shape[2] == 4 else np.ones_like(texels[:, :, :1])
    color = c if is_linear else alpha * np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)
    return np.dstack([color, alpha])


def look_up(texels, u, v):
    """Texels are interpolated bilinearly between their centres. The image repeats."""
    height, width = texels.shape[:2]
    x, y = u * width - 0.5, (1 - v) * height - 0.5
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    s, t = (x - i)[..., None], (y - j)[..., None]
    lines = [(1 - s) * texels[k % height, i % width] + s * texels[k % height, (i + 1) % width] for k in (j, j + 1)]
    return (1 - t) * lines[0] + t * lines[1]


def with_map(texels, weights):
    """A texture with a map, whose texels are weights of finishes: texels times weight, and weight alone, by finish."""
    height, width = np.maximum(texels.shape[:2], weights.shape[:2])
    u, v = np.meshgrid((np.arange(width) + 0.5) / width, 1 - (np.arange(height) + 0.5) / height)
    color, alpha, weights = *np.split(look_up(texels, u, v), [3], axis=2), look_up(weights, u, v)
    products = {k: np.dstack([color * weights[:, :, k:k + 1], alpha]) for k in range(weights.shape[2])}
    return {"color": texels, "gate": np.dstack([weights * alpha, alpha]), **products}


class Picture:
    """textures: {target: {"color": texels} or with_map()}; finishes: {target: name}; lights: {lamp: value}."""

    def __init__(self, path, textures={}, finishes={}, lights={}):
        self.m, self.parts = read_file(path)
        self.targets, self.footprints = self.m["targets"], self.m["footprints"]
        self.size, self.samples = (self.m["height"], self.m["width"]), {}
        self.samples |= {("gate", t): self.parts[of["gates"]] for t, of in enumerate(self.targets) if "gates" in of}
        for i, f in ((i, f) for i, f in enumerate(self.footprints) if "sampled" in f):
            self.samples[i, "color"] = self.parts[f["sampled"]]
            self.samples |= {(i, k): self.parts[name] for k, name in enumerate(f.get("finished", []))}
        self.textures = {t: textures[of["name"]] for t, of in enumerate(self.targets) if of["name"] in textures}
        self.mapped = {t for t in range(8) if ("gate", t) in self.samples or "gate" in self.textures.get(t, {})}
        self.edited = {f["target"] for i, f in enumerate(self.footprints) if (i, "color") in self.samples}
        self.edited |= {f["target"] for f in self.footprints if f["target"] in self.textures}
        self.finish = [t["finishes"].index(finishes[t["name"]]) + 1 if t["name"] in finishes else t.get("finish", 0)
                       for t in self.targets]
        self.parameters = {p["name"]: p for p in self.m["parameters"]}
        self.factor = functools.lru_cache(maxsize=None)(self.factor)
        self.values = {name: self.value_of(p, lights) * np.ones(3) for name, p in self.parameters.items()}

    def value_of(self, p, lights):
        if known("kind of parameter", p["kind"]) == "correction":
            m, n = len(self.edited), len(self.targets)
            return (p["target"] in self.edited) * ((n - m) / (m * (n - 1)) if m > 1 else 1)
        if "finishes" not in p:
            return lights.get(p["name"], p["value"])
        lamps = {q["lamp"]: q["value"] for q in self.parameters.values() if "lamp" in q and not any(q["finishes"])}
        value = lights.get(p["lamp"], lamps[p["lamp"]]) if p["lamp"] else [1, 1, 1]
        return np.array(value) * all(t in self.mapped or k in (0, self.finish[t]) for t, k in enumerate(p["finishes"]))

    def make(self):
        """The picture: height x width x 3."""
        terms, lamps = self.m["terms"], [p for p in self.m["parameters"] if p["kind"] == "color"]
        roles = {known("role", term["role"]) for term in terms}
        changed = any((self.values[p["name"]] != p["value"]).any() for p in lamps)
        if not terms or "picture" in roles and not self.edited and not changed:
            return self.parts[self.m["parts"][0]["name"]]
        if "lamp_picture" in roles and not self.edited and changed:
            return sum((self.make_term(term, 1) for term in terms if term["role"] == "lamp_picture"))
        lamps, picture = lamps if "lamp" in roles else [], np.zeros(self.size + (3,))
        common = self.take_common(lamps) if lamps else 1
        for term in (term for term in terms if term["role"] not in ("picture", "lamp_picture")):
            is_by_lamp = any(self.parameters.get(factor.get("parameter")) in lamps for factor in term["factors"])
            picture = picture + self.make_term(term, 1 if is_by_lamp else common)
        return np.maximum(picture, 0) if any("normal_tilt" in self.targets[t] for t in self.mapped) else picture

    def take_common(self, lamps):
        """What all lamps have in common comes with all light, and is taken from each of them."""
        kept = {p["name"]: np.array(p.get("kept", p["value"])) for p in lamps}
        least = np.min([np.where(k > 0, self.values[n] / np.maximum(k, 1e-30), np.inf) for n, k in kept.items()], 0)
        common = np.where(np.isinf(least), 1, least) * (not self.mapped)
        self.values.update({name: np.maximum(self.values[name] - common * k, 0) for name, k in kept.items()})
        return common

    def make_term(self, term, weight):
        weight = weight * np.prod([self.values[f["parameter"]] for f in term["factors"] if "parameter" in f], axis=0)
        if not np.any(weight):
            return 0
        factors = [self.factor(*factor) for factor in self.factors_of(term)]
        reduced = [values for values in factors if self.scale_of(values) > 1]
        if reduced:  # their product comes first, at the finest of their sizes
            finest = min(map(self.scale_of, reduced))
            factors.append(self.enlarge(np.prod([self.enlarge(values, finest) for values in reduced], axis=0), 1))
        return weight * self.parts[term["radiance"]] * np.prod([v for v in factors if self.scale_of(v) == 1], axis=0)

    def factors_of(self, term):
        """The factors but for parameters: kind, index or part, quantity. A map chooses the finish at the first hit."""
        factors = [(known("kind of factor", kind), factor[kind], known("quantity", factor.get("quantity", "color")))
                   for factor in term["factors"] for kind in factor if kind not in ("quantity", "parameter")]
        hits = [factor for factor in factors if factor[0] != "image" and factor[2] == "color"]
        footprints_of = lambda mixture: [share["footprint"] for share in self.m["mixtures"][mixture]]
        finishes = [self.parameters[f["parameter"]].get("finishes", []) for f in term["factors"] if "parameter" in f]
        for t, k in ((t, k) for numbers in finishes for t, k in enumerate(numbers) if k and t in self.mapped):
            kinds = [[self.footprints[f]["target"] == t and self.footprints[f]["kind"]
                      for f in (footprints_of(index) if kind == "mixture" else [index])] for kind, index, _ in hits]
            if kinds and all(kind in ("sharp", "broad") for kind in kinds[0]):
                factors[factors.index(hits[0])] = hits[0] = hits[0][:2] + (k - 1,)
            elif "normal_tilt" in self.targets[t] and not any(map(any, kinds)):
                factors.append(("number", k == 1, None))
            else:
                factors.append(("gate", t, k - 1))
        return factors

    def enlarge(self, values, scale):
        """Bilinear, between the centres of pixels; constant beyond them."""
        smaller = scale / self.scale_of(values)
        for axis, side in enumerate(self.size):
            pixels = np.arange(values.shape[axis])
            at = np.clip((np.arange(-(-side // scale)) + 0.5) * smaller - 0.5, 0, pixels[-1])
            weights = np.maximum(1 - abs(at[:, None] - pixels), 0)
            values = np.moveaxis(np.tensordot(weights, values, (1, axis)), 0, axis)
        return values

    def scale_of(self, values):
        return next(s for s in (1, 2, 4, 8) if values.shape[:2] == tuple(-(-side // s) for side in self.size))

    def factor(self, kind, index, quantity):
        """height x width x 3, at a size of its own."""
        if kind in ("number", "image", "gate"):
            return (np.full(self.size + (1,), index) if kind == "number" else self.parts[index] if kind == "image"
                    else self.gates(index)[:, :, quantity:quantity + 1]) * np.ones(3)
        if quantity == "further":
            a, b = self.factor(kind, index, "color"), self.factor(kind, index, "original")
            series = lambda x: sum(x ** i for i in range(self.m["further"]["hits"] + 1))
            return series(self.m["further"]["ratio"] * a) / series(self.m["further"]["ratio"] * b)
        if kind == "footprint":
            t, albedo = self.footprints[index]["target"], self.parts.get(self.footprints[index]["albedo"])
            if quantity == "original" or t not in self.edited:
                return albedo
            if (index, quantity) in self.samples:
                return self.samples[index, quantity]
            color = self.average(self.footprints[index], self.textures[t][quantity])
            is_shown = quantity in ("color", self.finish[t] - 1)  # what is clear has the finish without a map
            return color[:, :, :3] + (1 - color[:, :, 3:]) * albedo * is_shown
        colors, weights, least = 0, 0, 1e-30
        for share in self.m["mixtures"][index]:
            colors = colors + self.parts[share["weight"]] * self.factor("footprint", share["footprint"], quantity)
            weights = weights + self.parts[share["weight"]] * np.ones(3)
        of_all = colors.sum(axis=2, keepdims=True) / np.maximum(weights.sum(axis=2, keepdims=True), least)
        return np.where(weights > 0, colors / np.maximum(weights, least), of_all)

    def average(self, footprint, texels):
        """The mean of texels over a footprint; black where the coverage is 0."""
        axes, covered = "axes" in footprint, self.parts[footprint["uv"]][:, :, 2] > 0
        uv, spread = (self.parts[footprint[key]][covered].T[..., None] for key in ("uv", "axes" if axes else "spread"))
        number, is_even = np.arange(POINTS ** 2), self.m["filter"] == "box" and footprint.get("kind") == "sharp"
        if axes:
            x, y = ((line + 0.5) / POINTS - 0.5 for line in (number % POINTS, number // POINTS))
            if quadrant := footprint.get("quadrant"):
                x, y = (x + (quadrant - 1) % 2 - 0.5) / 2, (y + (quadrant - 1) // 2 - 0.5) / 2
            at = [uv[i] + x * spread[i] + y * spread[i + 2] for i in (0, 1)]
        else:
            share, angle, c = (number + 0.5) / POINTS ** 2, 2.399963 * number, spread[2] if len(spread) > 2 else 0
            radius = 2 * np.sqrt(share) if is_even else np.sqrt(-2 * np.log(1 - share))
            x, y = radius * np.cos(angle), radius * np.sin(angle)
            at = [uv[0] + x * spread[0], uv[1] + spread[1] * (c * x + np.sqrt(1 - c * c) * y)]
        weight, target = np.ones_like(at[0]), self.targets[footprint["target"]]
        for i in (i for i in (0, 1) if not (axes or is_even or target["periodic"][i])):  # a Gaussian ends with it
            weight *= (at[i] >= target["uv_min"][i]) & (at[i] <= target["uv_max"][i])
        weight = np.where(weight.any(axis=1, keepdims=True), weight, 1)[..., None]  # unless nothing is left
        mean = np.zeros(covered.shape + texels.shape[2:]) + ([0] * (texels.shape[2] - 1) + [1])
        mean[covered] = (weight * look_up(texels, *at)).sum(axis=1) / weight.sum(axis=1)
        return mean

    def gates(self, t):
        """The mean weights of a target's finishes over its footprints in each pixel: height x width x finishes."""
        if ("gate", t) in self.samples:
            return np.dstack([1 - self.samples["gate", t].sum(axis=2), self.samples["gate", t]])
        importance, weights, total = {"sharp": 1, "broad": 1e-3, "interreflection": 1e-6}, 0, 0
        shown = np.arange(len(self.targets[t]["finishes"])) == self.finish[t] - 1
        for footprint in (f for f in self.footprints if f["target"] == t):
            share = self.parts[footprint["uv"]][:, :, 2:] * importance[footprint["kind"]]
            means, alpha = np.split(self.average(footprint, self.textures[t]["gate"]), [-1], axis=2)
            weights = weights + self.enlarge(share * (means + (1 - alpha) * shown), 1)
            total = total + self.enlarge(share, 1)
        return np.where(total > 0, weights / np.maximum(total, 1e-30), shown)


def main(path, output, *edits):
    said = {"": {}, "finish": {}, "light": {}}
    for key, value in (edit.split("=") for edit in edits):
        kind, _, name = key.rpartition(":")
        numbers = [float(number) for number in value.split(",")] if "," in value else []
        said[kind][name] = numbers or value if kind else {
            "color": np.array([[numbers + [1]]]) if numbers else read_image(value)}
    picture = Picture(path, said[""], said["finish"], said["light"]).make()
    with open(output, "wb") as file:  # PFM: lines from the bottom
        file.write(b"PF\n%d %d\n-1\n" % picture.shape[1::-1] + picture[::-1].astype("<f4").tobytes())


if __name__ == "__main__":
    main(*sys.argv[1:])
