"""Makes the picture of a folder that retex-pack --web wrote, as the player's shaders do, but on the CPU with numpy.

    reference.py FOLDER PICTURE.exr [TARGET=IMAGE|r,g,b[:scale=U,V][:rotate=DEGREES][:offset=U,V][:finish=MAP]]... [PARAMETER=r,g,b]...
        [light:LAMP=GAIN[*rgb(r,g,b)]]... [finish:TARGET=NAME]...  as of retex-edit(5); LAMP may be *
"""
import copy
import json
import sys
import zlib

import numpy as np
import OpenImageIO as oiio

LEVELS_PER_E = 48


def pixels(path, kind):
    source = oiio.ImageInput.open(path)
    if not source:
        raise SystemExit(f"cannot read {path}")
    data = source.read_image(kind)
    source.close()
    return data


def srgb_decode(y):
    return np.where(y <= 0.04045, y / 12.92, ((np.maximum(y, 0.04045) + 0.055) / 1.055) ** 2.4)


def decode_light(codes, curve):
    y = codes.astype(np.float64) / curve["levels"]
    return np.array(curve["white"]) * np.where(y > 1, np.exp((np.maximum(y, 1) - 1) * 255 / LEVELS_PER_E), srgb_decode(y))


# ---- footprints ----


def zigzag(values):
    values = values.astype(np.int64)
    return np.where(values & 1, -((values + 1) >> 1), values >> 1)


def wrap(value, bits):
    return value & 255 if bits == 8 else (value + 2**31) % 2**32 - 2**31


def plane(stream, present, bits, shift):
    """Integers of one plane, undone pixel by pixel as retex-web(5) says."""
    height, width = present.shape
    head = stream.take(1)[0]
    predictor, size = head & 15, head >> 4
    out = np.zeros((height, width), np.int64)
    if size == 0:
        return out
    count = int(present.sum())
    raw = np.frombuffer(stream.take(count * size), np.uint8).reshape(size, count).astype(np.int64)
    residuals = zigzag(sum(raw[k] << 8 * k for k in range(size))).tolist()
    here, rows, steps, last, at = present.tolist(), out.tolist(), None if shift is None else shift.tolist(), 0, 0
    for y in range(height):
        row, above = rows[y], rows[y - 1] if y else None
        for x in range(width):
            if not here[y][x]:
                continue
            left, upper = x > 0 and here[y][x - 1], y > 0 and here[y - 1][x]
            if predictor == 0:
                guess = 0
            elif left and upper and here[y - 1][x - 1]:
                a, b, c = row[x - 1], above[x], above[x - 1]
                if predictor == 1:
                    guess = a
                elif predictor == 2:
                    guess = b
                elif predictor == 3 or min(a, b) < c < max(a, b):
                    guess = a + b - c
                else:
                    guess = min(a, b) if c >= max(a, b) else max(a, b)
            else:
                guess = row[x - 1] if left else above[x] if upper else last
            s = steps[y][x] if steps else 0
            guess = (guess + ((1 << s) >> 1)) >> s
            row[x] = last = wrap((guess + residuals[at]) << s, bits)
            at += 1
    return np.array(rows, np.int64)


class Stream:
    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, count):
        self.at += count
        return self.data[self.at - count:self.at]


def checked(folder, entry):
    data = open(f"{folder}/{entry['file']}", "rb").read()
    if len(data) != entry["bytes"] or zlib.crc32(data) != entry["crc32"]:
        raise SystemExit(f"{entry['file']} is damaged")
    return data


def steps(uv, present, periodic):
    """The derivatives to the right and down, pixel by pixel: of the parabola through a pixel and the two beside it, or the two
    on one side; of a line through two pixels; or 0. Down within 64 rows."""
    out = np.zeros((2,) + uv.shape)
    height, width = uv.shape
    near = lambda d: d - round(d) if periodic else d
    for y, x in zip(*np.nonzero(present)):
        first, end = y // 64 * 64, min(y // 64 * 64 + 64, height)
        for down in range(2):
            def at(k):
                i, j = (y + k, x) if down else (y, x + k)
                return near(uv[i, j] - uv[y, x]) if first <= i < end and 0 <= j < width and present[i, j] else None
            places = [k for k in (-1, 1) if at(k) is not None]
            if len(places) == 1 and at(2 * places[0]) is not None:
                k = places[0]
                out[down, y, x] = k * (at(k) - (near(at(2 * k) - at(k)) - at(k)) / 2)
            elif places:
                out[down, y, x] = sum(k * at(k) for k in places) / len(places)
    return list(out)


def read_class(folder, c, periodic):
    """For each footprint: present, u, v, standard deviations, correlation, weights by slot. Of one with axes these stand in
    place of standard deviations: [right, down] of u, and of v; and there is no correlation."""
    stream = Stream(zlib.decompress(checked(folder, c)))
    width, height, out = c["width"], c["height"], []
    for f in c["footprints"]:
        mask = np.frombuffer(stream.take((width + 7) // 8 * height), np.uint8).reshape(height, -1)
        present = np.unpackbits(mask, axis=1, bitorder="little")[:, :width].astype(bool)
        codes = [plane(stream, present, 8, None) for _ in range(2 if c["spreads"] == 4 else c["spreads"])]
        sigma = [np.where(k > 0, f["first"] * 2.0 ** ((k - 1) / f["per_octave"]), 0) for k in codes[:2]]
        rho = np.sin((codes[2] - 128) / f["angle_steps"] * np.pi / 2) if c["spreads"] == 3 else np.zeros(present.shape)
        uv = []
        for k in range(2):
            shift = np.clip((codes[k] - 1 + f["sigma_first"]) // f["per_octave"], 0, 24)
            uv.append(plane(stream, present, 32, shift) * 2.0**-18)
        weights = []
        for first in f["weights"]:
            if first == "one":
                weights.append(np.ones(present.shape))
            else:
                weights.append(plane(stream, present, 8, None) * first if first else np.zeros(present.shape))
        if c["spreads"] == 4:
            sigma, rho = [steps(uv[k], present, periodic[k]) for k in range(2)], None
        out.append((present, uv, sigma, rho, weights))
    return out


# ---- textures ----

TENT, ALONG_MOST = 1 / 6, 32
DISC_ROWS = [(-np.sqrt(0.5), 0.25), (0.0, 0.5), (np.sqrt(0.5), 0.25)]
BELL_ROWS = [(-np.sqrt(3), 1 / 6), (0.0, 2 / 3), (np.sqrt(3), 1 / 6)]
BELL_END = 2.5


class Texture:
    def __init__(self, text):
        name, *options = text.split(":")
        options = dict(o.split("=") for o in options)
        pair = lambda key, default: np.array([float(x) for x in options.get(key, default).split(",")] * 2)[:2]
        self.scale, self.offset = pair("scale", "1"), pair("offset", "0")
        turn = np.radians(float(options.get("rotate", "0")))
        self.turn = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
        self.map = options.get("finish")
        if "," in name:
            base = np.array([[[float(x) for x in name.split(",")]]])
        else:
            base = srgb_decode(pixels(name, oiio.UINT8)[:, :, :3].astype(np.float64) / 255)
        self.fill(base)

    def fill(self, base):
        self.levels = [base]
        while max(self.levels[-1].shape[:2]) > 1:
            last = self.levels[-1]
            for axis in range(2):
                if last.shape[axis] > 1:
                    last = np.moveaxis(last, axis, 0)
                    last = (last[0:last.shape[0] // 2 * 2:2] + last[1::2][:last.shape[0] // 2]) / 2
                    last = np.moveaxis(last, 0, axis)
            self.levels.append(last)

    def products(self, count):
        """The weights of the second to the fourth finish of so many, and the texture times the weight of each."""
        codes = pixels(self.map, oiio.UINT8)[:, :, :3].astype(np.float64) / 255
        if np.abs(codes - codes[:, :, :1]).max() < 0.0101:
            weights = np.maximum(1 - np.abs(codes * (count - 1) - np.array([1, 2, 3])), 0)
        else:
            weights = codes * np.array([1, count > 2, count > 3])
            weights = weights / np.maximum(weights.sum(axis=2, keepdims=True), 1)
        size = [max(self.levels[0].shape[k], weights.shape[k]) for k in range(2)]
        v, u = ((np.indices(size).reshape(2, -1).T + 0.5) / size).T
        color, map_ = self, copy.copy(self)
        map_.fill(weights)
        color, weights = (x.bilinear(0, u, 1 - v).reshape(size + [3]) for x in (color, map_))
        shares = [np.maximum(1 - weights.sum(axis=2), 0)] + [weights[:, :, k] for k in range(count - 1)]
        made = [copy.copy(self) for _ in range(count + 1)]
        for texture, base in zip(made, [weights] + [color * share[:, :, None] for share in shares]):
            texture.fill(base)
        return made

    def bilinear(self, level, u, v):
        image = self.levels[level]
        height, width = image.shape[:2]
        x, y = u * width - 0.5, (1 - v) * height - 0.5
        x0, y0 = np.floor(x), np.floor(y)
        fx, fy = (x - x0)[:, None], (y - y0)[:, None]
        x0, y0 = x0.astype(np.int64), y0.astype(np.int64)
        at = lambda i, j: image[(y0 + j) % height, (x0 + i) % width]
        return (at(0, 0) * (1 - fx) + at(1, 0) * fx) * (1 - fy) + (at(0, 1) * (1 - fx) + at(1, 1) * fx) * fy

    def trilinear(self, lod, u, v):
        lod = np.clip(lod, 0, len(self.levels) - 1)
        low = np.floor(lod).astype(int)
        out = np.zeros((len(u), 3))
        for level in np.unique(low):
            i = low == level
            out[i] = self.bilinear(level, u[i], v[i])
            f = (lod[i] - level)[:, None]
            if f.any():
                out[i] = out[i] * (1 - f) + self.bilinear(min(level + 1, len(self.levels) - 1), u[i], v[i]) * f
        return out

    def placed(self, uv):
        """Where surface UV lies in the image."""
        return self.turn @ (self.scale[:, None] * uv) + self.offset[:, None]

    def filtered(self, uv, sigma, rho, disc, bounds):
        """The mean over a disc or a bell of these means and covariances; bounds: of UV, where a bell is cut off."""
        height, width = self.levels[0].shape[:2]
        turn = np.diag([width, height]) @ self.turn @ np.diag(self.scale)
        back = np.linalg.inv(turn)
        mean = self.placed(uv)
        cross = rho * sigma[0] * sigma[1]
        covariance = np.array([[sigma[0]**2, cross], [cross, sigma[1]**2]])
        covariance = np.einsum("ij,jkn,lk->iln", turn, covariance, turn)
        a, b, c = covariance[0, 0], covariance[0, 1], covariance[1, 1]
        half, root = (a + c) / 2, np.sqrt(((a - c) / 2)**2 + b * b)
        long, short = half + root, np.maximum(half - root, 0)
        angle = 0.5 * np.arctan2(2 * b, a - c)
        axis = np.array([np.cos(angle), np.sin(angle)])
        reach = 2.0 if disc else BELL_END
        tap = np.maximum(np.maximum(0.5 * short, TENT), long * (2 * reach / (1.5 * ALONG_MOST))**2)
        power = 4 * (tap + 1 / 12)  # 4^level: a texel of that level, interpolated, has this variance
        low = np.floor(np.log2(power) / 2)
        lod = low + (power / 4**low - 1) / 3
        long, short = np.sqrt(np.maximum(long - tap, 0)), np.sqrt(np.maximum(short - tap, 0))
        total, sum_ = np.zeros(len(rho)), np.zeros((len(rho), 3))
        for t, row_weight in DISC_ROWS if disc else BELL_ROWS:
            chord = reach * long * (np.sqrt(1 - t * t) if disc else 1)
            count = np.clip(np.ceil(2 * chord / (1.5 * np.sqrt(tap))), 1, ALONG_MOST).astype(int)
            across = t * short * (2 if disc else 1)
            for k in range(count.max()):
                i = count > k
                s = (2 * (k + 0.5) / count[i] - 1)
                w = row_weight / count[i] if disc else row_weight * np.exp(-0.5 * (reach * s)**2)
                offset = axis[:, i] * (s * chord[i]) + np.array([-axis[1, i], axis[0, i]]) * across[i]
                if not disc:
                    where = uv[:, i] + back @ offset
                    for d in range(2):
                        if not bounds["periodic"][d]:
                            w = w * ((where[d] >= bounds["uv_min"][d]) & (where[d] <= bounds["uv_max"][d]))
                offset = offset / np.array([[width], [height]])
                sum_[i] += w[:, None] * self.trilinear(lod[i], mean[0, i] + offset[0], mean[1, i] + offset[1])
                total[i] += w
        plain = total <= 0
        if plain.any():
            sum_[plain] = self.trilinear(lod[plain], mean[0, plain], mean[1, plain])
        return sum_ / np.where(plain, 1, total)[:, None]


    def evenly(self, uv, axes):
        """The mean over parallelograms: of a grid of points, each filtered over its part of the grid."""
        grid, shape = 12, np.array([[self.levels[0].shape[1]], [self.levels[0].shape[0]]])
        place = lambda p: self.turn @ (self.scale[:, None] * p)
        sides = [place(np.array([axes[0][k], axes[1][k]])) for k in range(2)]
        cell = np.sqrt(np.abs(np.linalg.norm(sides[0] * shape, axis=0) * np.linalg.norm(sides[1] * shape, axis=0))) / grid
        lod, mean = np.log2(np.maximum(cell, 1)), self.placed(uv)
        sum_ = np.zeros((uv.shape[1], 3))
        for j in range(grid):
            for i in range(grid):
                u, v = mean + sides[0] * ((i + 0.5) / grid - 0.5) + sides[1] * ((j + 0.5) / grid - 0.5)
                sum_ += self.trilinear(lod, u, v)
        return sum_ / grid**2


# ---- the picture ----


def enlarge(image, factor, width, height):
    """Bilinear, values lying at the centres of pixels."""
    def axis(count, size):
        at = np.clip((np.arange(count) + 0.5) / factor - 0.5, 0, size - 1)
        low = np.minimum(np.floor(at).astype(int), max(size - 2, 0))
        return low, np.minimum(low + 1, size - 1), at - low
    if factor == 1:
        return image[:height, :width]
    y0, y1, fy = axis(height, image.shape[0])
    x0, x1, fx = axis(width, image.shape[1])
    rows = image[y0] * (1 - fy)[:, None, None] + image[y1] * fy[:, None, None]
    return rows[:, x0] * (1 - fx)[None, :, None] + rows[:, x1] * fx[None, :, None]


def luminance(rgb):
    return float(np.dot(rgb, [0.2126, 0.7152, 0.0722]))


def lamp_color(lamp, text):
    """The colour of a lamp with a value, a number or a number times a colour."""
    gain, _, color = text.partition("*") if text[0].isdigit() else ("1", "*", text)
    value = np.array(lamp["value"])
    if not value.any():
        value = np.array(lamp["kept"])
    if color:
        hue = np.array([float(x) for x in color[4:-1].split(",")])
        hue /= luminance(hue)
        value = value * hue if lamp.get("several") else luminance(value) * hue
    return float(gain) * value


class Room:
    def __init__(self, folder):
        self.folder, self.room = folder, json.load(open(f"{folder}/room.json"))
        self.size = self.room["width"], self.room["height"]
        self.lights = [decode_light(self.image(x), x) for x in self.room["lights"]]
        self.tiles, self.lamp_tiles = self.atlas(self.room["reduced"]), self.atlas(self.room.get("lamps"))
        self.values = {p["name"]: np.array(p["value"]) for p in self.room.get("parameters", [])}
        targets = self.room["targets"]
        self.finishes = [t.get("finish", 0) for t in targets]
        self.classes = [read_class(folder, c, targets[c["target"]]["periodic"]) for c in self.room["classes"]]
        self.kept = {}  # filtered textures

    def image(self, entry):
        checked(self.folder, entry)
        return pixels(f"{self.folder}/{entry['file']}", oiio.UINT8)[:, :, :3]

    def atlas(self, entry):
        if not entry:
            return []
        image = self.image(entry)
        return [decode_light(image[t["y"]:t["y"] + t["height"], t["x"]:t["x"] + t["width"]], t) for t in entry["tiles"]]

    def set_edit(self, lamps, finishes, mapped):
        """Values of lamps and names of finishes, by name: what parameters are, as retex-web(5) says; of mapped targets
        with all finishes."""
        targets, parameters = self.room["targets"], self.room["parameters"]
        for index, name in finishes.items():
            self.finishes[index] = 1 + targets[index]["finishes"].index(name)
        colors = {"": np.ones(3)}
        for p in parameters:
            if not any(p.get("finishes", [])) and p.get("lamp") != "":
                name = p.get("lamp", p["name"])
                text = lamps.get(name, lamps.get("*"))
                colors[name] = lamp_color(p, text) if text else np.array(p["value"])
        for p in parameters:
            chosen = all(f in (0, self.finishes[t]) or t in mapped for t, f in enumerate(p.get("finishes", [])))
            self.values[p["name"]] = colors[p.get("lamp", p["name"])] if chosen else np.zeros(3)

    def filtered(self, c, footprint, texture):
        """A texture at a footprint of a class, where it is present."""
        if (id(footprint), texture) not in self.kept:
            self.kept[id(footprint), texture] = self.filter(c, footprint, texture)
        return self.kept[id(footprint), texture]

    def filter(self, c, footprint, texture):
        """The same, anew."""
        info, (present, uv, sigma, rho, _) = self.room["classes"][c], footprint
        uv = np.array([x[present] for x in uv])
        if rho is None:
            return texture.evenly(uv, [[x[present] for x in s] for s in sigma])
        return texture.filtered(uv, [x[present] for x in sigma], rho[present],
                                info["kind"] == "sharp" and self.room["filter"] == "box", self.room["targets"][info["target"]])

    def gate(self, target, weights):
        """The mean weights of the second to the fourth finish over the target's footprints in a pixel."""
        (width, height), sums = self.size, 0
        for c, info in enumerate(self.room["classes"]):
            if info["target"] != target:
                continue
            own = np.zeros(self.classes[c][0][0].shape + (4,))
            for footprint in self.classes[c]:
                present, weight = footprint[0], np.max(footprint[4], axis=0)[footprint[0]][:, None]
                own[present] += weight * np.concatenate([self.filtered(c, footprint, weights), np.ones_like(weight)], axis=1)
            importance = {"sharp": 1, "broad": 1e-3, "interreflection": 1e-6}[info["kind"]]
            sums = sums + importance * enlarge(own, info["scale"], width, height)
        shown = [self.finishes[target] == k for k in (2, 3, 4)]
        return np.where(sums[:, :, 3:] > 0, sums[:, :, :3] / np.maximum(sums[:, :, 3:], 1e-30), shown)

    def first_hit(self, mixture):
        """The target on which a mixture is a path's first hit; -1: none, or several."""
        if mixture < 0 or mixture in self.room.get("further", {}).get("mixtures", []):
            return -1
        classes = [self.room["classes"][c] for c, _ in self.room["mixtures"][mixture]]
        found = {-1 if c["kind"] == "interreflection" else c["target"] for c in classes}
        return found.pop() if len(found) == 1 else -1

    def first_hit_of(self, group):
        mixture = self.room["groups"][group]["mixture"]
        terms = [t["factors"] for t in self.room["lamps"]["terms"] if t["group"] == group]
        found = {self.first_hit(mixture)} if mixture >= 0 else {self.first_hit(f[0] if f else -1) for f in terms}
        return found.pop() if len(found) == 1 else -1

    def combine_mapped(self, textures):
        """The sum over choices of finishes of the targets with maps."""
        parameters, values = self.room["parameters"], self.values
        mapped = {t: x.products(len(self.room["targets"][t]["finishes"])) for t, x in textures.items() if x.map}
        gates = {t: self.gate(t, products[0]) for t, products in mapped.items()}
        choice = lambda p: tuple(p["finishes"][t] for t in mapped)
        out = 0
        for chosen in sorted({choice(p) for p in parameters}):
            self.values = {p["name"]: values[p["name"]] * (choice(p) == chosen) for p in parameters}
            finishes = {t: k for t, k in zip(mapped, chosen) if k}
            first = {**textures, **{t: mapped[t][k] for t, k in finishes.items()}}
            shares = {t: 1 - gates[t].sum(axis=2) if k == 1 else gates[t][:, :, k - 2] for t, k in finishes.items()}
            out = out + self.combine(textures, first, shares)
        self.values = values
        return out

    def mixture(self, index, textures):
        total = above = None
        for c, slot in self.room["mixtures"][index]:
            info = self.room["classes"][c]
            albedo = self.lights[info["albedo"]] if info["scale"] == 1 else self.tiles[info["albedo"]]
            texture = textures.get(info["target"])
            for footprint in self.classes[c]:
                present, weights = footprint[0], footprint[4]
                if total is None:
                    total, above = np.zeros(present.shape), np.zeros(present.shape + (3,))
                w = weights[slot]
                if texture is None:
                    color = albedo[present]
                else:
                    color = self.filtered(c, footprint, texture)
                above[present] += w[present][:, None] * color
                total[present] += w[present]
        return above / np.where(total > 0, total, 1)[:, :, None]

    def combine(self, textures, first=None, gates=None):
        """first: textures where a target is a path's first hit; gates: of targets, for light of other first hits."""
        room, (width, height) = self.room, self.size
        parameters = room.get("parameters", [])
        values, common = [self.values[p["name"]] for p in parameters], np.ones(3)
        if "lamps" in room:  # what all lamps have in common comes with all light
            kept = [np.array(p["kept"]) for p in parameters]
            times = np.array([np.where(k > 0, v / np.where(k > 0, k, 1), np.inf) for v, k in zip(values, kept)])
            common = np.where(np.isinf(times.min(axis=0)), 1, times.min(axis=0))
            values = [np.where(t <= common, 0, v - common * k) for t, v, k in zip(times, values, kept)]
        both = [(room["terms"], self.tiles, room["reduced"], room["finest"], None)]
        if np.any(values) and "lamps" in room:
            both.append((room["lamps"]["terms"], self.lamp_tiles, room["lamps"], room["lamps"]["finest"], values))
        mixtures = [self.mixture(i, first if first and self.first_hit(i) >= 0 else textures) for i in range(len(room["mixtures"]))]
        scale = [room["classes"][m[0][0]]["scale"] for m in room["mixtures"]]
        out = np.zeros((height, width, 3))
        for g, group in enumerate(room["groups"]):
            whole = 0
            for terms, tiles, source, finest, of_lamps in both:
                small = -(-width // finest), -(-height // finest)
                factor = np.zeros((small[1], small[0], 3))
                for term in terms:
                    if term["group"] != g:
                        continue
                    product = np.ones((small[1], small[0], 3)) * (of_lamps[term["parameter"]] if of_lamps else common)
                    if term["gain"] >= 0:
                        product = product * enlarge(tiles[term["gain"]], source["tiles"][term["gain"]]["scale"] // finest, *small)
                    for m in term["factors"]:
                        product = product * enlarge(mixtures[m], scale[m] // finest, *small)
                    factor = factor + product
                whole = whole + enlarge(factor, finest, width, height)
            for p in group.get("parameters", []):
                whole = whole * self.values[parameters[p]["name"]]
            light = self.lights[group["light"]] * whole
            for t, gate in (gates or {}).items():
                if self.first_hit_of(g) != t:
                    light = light * gate[:, :, None]
            out += light if group["mixture"] < 0 else light * mixtures[group["mixture"]]
        return out


    def picture(self, *words):
        """The picture under an edit, in the words of this program; the room stays as it is."""
        room, names = copy.copy(self), [t["name"] for t in self.room["targets"]]
        room.values, room.finishes = dict(self.values), list(self.finishes)
        textures, lamps, finishes = {}, {}, {}
        for word in words:
            name, text = word.split("=", 1)
            if name.startswith("light:"):
                lamps[name[6:]] = text
            elif name.startswith("finish:"):
                finishes[names.index(name[7:])] = text
            elif name not in names:
                room.values[name] = np.array([float(x) for x in text.split(",")])
            else:
                textures[names.index(name)] = Texture(text)
        mapped = [t for t, texture in textures.items() if texture.map]
        if lamps or finishes or mapped:
            room.set_edit(lamps, finishes, mapped)
        return room.combine_mapped(textures) if mapped else room.combine(textures)


def write(path, picture):
    out = oiio.ImageOutput.create(path)
    out.open(path, oiio.ImageSpec(picture.shape[1], picture.shape[0], 3, "float"))
    out.write_image(picture.astype(np.float32))
    out.close()


def main():
    write(sys.argv[2], Room(sys.argv[1]).picture(*sys.argv[3:]))


if __name__ == "__main__":
    main()
