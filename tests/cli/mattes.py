#!/usr/bin/python3
"""Decode a file of retex-render --mattes by the specification of Cryptomatte, and compare.

mattes.py layout FILE            channels, metadata and manifests, and that pixels agree with them
mattes.py sums FILE              what masks and coverages add up to
mattes.py names FILE KIND        names of a manifest that cover more than a hundredth of some pixel
mattes.py whole FILE KIND        whether the coverages are 1 in each pixel
mattes.py where FILE LAYER OBJECT…  whether the layer is above a hundredth only where one of the objects is seen, and there
mattes.py same FILE DB (TRUTH LAYER+…)…   sums of layers, masks or KIND/NAME, against the red of pictures
"""
import json
import sys

import numpy
import OpenImageIO as oiio

KINDS = ("CryptoObject", "CryptoMaterial", "CryptoThroughObject", "CryptoThroughMaterial")
MASK = 0xFFFFFFFF


def murmur(data):
    """MurmurHash3_x86_32 with seed 0, as its author describes it."""
    def scramble(k):
        k = k * 0xCC9E2D51 & MASK
        k = (k << 15 | k >> 17) & MASK
        return k * 0x1B873593 & MASK

    state = 0
    words, tail = divmod(len(data), 4)
    for word in numpy.frombuffer(data[: 4 * words], "<u4"):
        state ^= scramble(int(word))
        state = (state << 13 | state >> 19) & MASK
        state = (state * 5 + 0xE6546B64) & MASK
    if tail:
        state ^= scramble(int.from_bytes(data[4 * words:], "little"))
    state ^= len(data)
    for shift, factor in ((16, 0x85EBCA6B), (13, 0xC2B2AE35), (16, 1)):
        state = (state ^ state >> shift) * factor & MASK
    return state


def number(name):
    """The float of a name, as bits."""
    bits = murmur(name.encode())
    exponent = min(max(bits >> 23 & 255, 1), 254)
    return bits & ~(255 << 23) & MASK | exponent << 23


class Mattes:
    def __init__(self, path):
        file = oiio.ImageInput.open(path)
        assert file, oiio.geterror()
        self.spec = file.spec()
        self.parts = 1 if not file.seek_subimage(1, 0) else 2
        file.seek_subimage(0, 0)
        self.channels = list(self.spec.channelnames)
        self.formats = dict(zip(self.channels, map(str, self.spec.channelformats or [])))
        self.pixels = file.read_image(0, 0, 0, self.spec.nchannels, oiio.FLOAT)

    def channel(self, name):
        return numpy.ascontiguousarray(self.pixels[..., self.channels.index(name)])

    def metadata(self, kind):
        key = f"{murmur(kind.encode()):08x}"[:7]
        return {word: self.spec.getattribute(f"cryptomatte/{key}/{word}")
                for word in ("name", "hash", "conversion", "manifest")}

    def ranks(self, kind):
        """Bits of the number, and coverage, of each rank."""
        for name in sorted(c for c in self.channels if c.startswith(kind) and c.endswith(".R")):
            for of, by in ("RG", "BA"):
                yield self.channel(name[:-1] + of).view(numpy.uint32), self.channel(name[:-1] + by)

    def matte(self, kind, name):
        wanted = number(name)
        return sum(numpy.where(ids == wanted, coverage, 0) for ids, coverage in self.ranks(kind))

    def layer(self, text):
        kind, slash, name = text.partition("/")
        return self.matte(kind, name) if slash else self.channel(text + ".R")

    def direct(self):
        return [c for c in self.channels if c.startswith("mask_") and not c.endswith(("_transmitted.R", "_reflected.R"))]


def layout(mattes):
    crypto = [c for c in mattes.channels if c.startswith("Crypto")]
    print("parts", mattes.parts, "channels", len(mattes.channels), "of Cryptomatte", len(crypto),
          "floats", all(mattes.formats[c] == "float" for c in crypto))
    for kind in KINDS:
        data = mattes.metadata(kind)
        manifest = json.loads(data["manifest"])
        known = {int(bits, 16) for bits in manifest.values()} | {0}
        seen = set()
        sorted_by_coverage, last = True, None
        for ids, coverage in mattes.ranks(kind):
            seen |= set(int(i) for i in numpy.unique(ids))
            sorted_by_coverage &= last is None or bool((coverage <= last).all())
            sorted_by_coverage &= bool(((ids == 0) == (coverage == 0)).all())
            last = coverage
        print(data["name"], data["hash"], data["conversion"],
              "manifest", all(int(bits, 16) == number(name) for name, bits in manifest.items()),
              "ids known", seen <= known, "ranked", sorted_by_coverage)


def sums(mattes):
    direct = sum(mattes.channel(c).astype(float) for c in mattes.direct())
    print(f"direct {abs(direct - 1).max() < 1e-6}")
    for kind in KINDS:
        total = sum(coverage.astype(float) for _, coverage in mattes.ranks(kind))
        print(f"{kind} at most {total.max():.6f}")
    targets = [c[:-2] for c in mattes.direct() if c != "mask_rest.R"]
    most = 0
    for target in targets:
        of = sum(mattes.channel(target + how + ".R").astype(float) for how in ("", "_transmitted", "_reflected"))
        most = max(most, of.max())
    print(f"target at most {most:.6f}")
    # each layer over black, and all of them added up
    picture = numpy.stack([mattes.channel(c) for c in "RGB"], -1)
    layers = [(picture * mattes.channel(c)[..., None]).astype(numpy.float16).astype(float) for c in mattes.direct()]
    error = float(((sum(layers) - picture) ** 2).mean())
    print("layers over black", "60 dB" if error < 1e-6 else error)


def main():
    command, mattes = sys.argv[1], Mattes(sys.argv[2])
    if command == "layout":
        layout(mattes)
    elif command == "sums":
        sums(mattes)
    elif command == "names":
        manifest = json.loads(mattes.metadata(sys.argv[3])["manifest"])
        print(*[name for name in manifest if mattes.matte(sys.argv[3], name).max() > 0.01])
    elif command == "whole":
        total = sum(coverage.astype(float) for _, coverage in mattes.ranks(sys.argv[3]))
        print(sys.argv[3], "whole", abs(total - 1).max() < 1e-5)
    elif command == "where":
        inside = sum(mattes.matte("CryptoObject", name) for name in sys.argv[4:]) > 0
        layer = mattes.layer(sys.argv[3]) > 0.01
        print(sys.argv[3], "only in", *sys.argv[4:], bool((layer <= inside).all() and layer.any()))
    elif command == "same":
        for path, layers in zip(sys.argv[4::2], sys.argv[5::2]):
            truth = oiio.ImageBuf(path).get_pixels(oiio.FLOAT)[..., 0]
            found = sum(mattes.layer(text) for text in layers.split("+"))
            decibels = -10 * numpy.log10(max(float(((found - truth) ** 2).mean()), 1e-12))
            seen = float(truth.mean())
            good = decibels >= float(sys.argv[3]) and seen > 1e-3
            print(layers, "same" if good else f"{decibels:.2f} dB, mean {seen:.4f} and {found.mean():.4f}")


main()
