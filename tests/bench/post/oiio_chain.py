"""Recombination as one call of oiiotool: oiio_chain.py SET.exr SAMPLES.exr OUT.exr

Prints the call, one argument a line: what somebody without retex-combine could do with a set, given the textures
already filtered at its footprints, as retex-sample writes them. The polynomial that the manifest lists (retex-set(5))
is nested by its factors, so that each term takes one multiplication and one addition. Where weights of a mixture differ
by colour, a colour without any stays black, which is the one thing done less well.
"""
import json
import subprocess
import sys


def manifest(path):
    return json.loads(subprocess.run(["retex-info", "--json", path], check=True, stdout=subprocess.PIPE).stdout)


class Chain:
    def __init__(self, manifest_of_set, samples):
        self.set, self.mixed = manifest_of_set, {}
        self.parts = {part["name"]: part for part in self.set["parts"]}
        of_samples = {part["name"]: part for part in samples["parts"]}
        self.samples = [of_samples.get(footprint.get("sampled")) for footprint in samples["footprints"]]
        footprints = self.set["footprints"]
        self.edited = {f["target"] for f, part in zip(footprints, self.samples) if part is not None}

    def enlarged(self, part):
        """Bilinear, as recombination does, to whole multiples, of which the picture is the upper left part."""
        wide, high = self.set["width"], self.set["height"]
        scale = round(wide / part["width"])
        if scale == 1:
            return []
        size = f"{part['width'] * scale}x{part['height'] * scale}"
        return ["--fullpixels", "--resize:filter=triangle", size, "--cut", f"{wide}x{high}+0+0"]

    def part(self, name, enlarge=True):
        part = self.parts[name]
        spread = ["--ch", "0,0,0"] if part["letters"] == "R" else []
        return ["SET", "--subimage", name, *spread, *(self.enlarged(part) if enlarge else [])]

    def sample(self, footprint, enlarge=True):
        part = self.samples[footprint]
        if part is None:    # its target keeps the original
            return self.part(self.set["footprints"][footprint]["albedo"], enlarge)
        return ["SAMPLES", "--subimage", part["name"], *(self.enlarged(part) if enlarge else [])]

    def mixtures(self):
        """Each once, as an image of its own name."""
        for number, shares in enumerate(self.set.get("mixtures", [])):
            first = self.parts[shares[0]["weight"]]
            for k, share in enumerate(shares):
                yield from [*self.part(share["weight"], False), *self.sample(share["footprint"], False), "--mul"]
                yield from ["--add"] if k else []
            for k, share in enumerate(shares):
                yield from self.part(share["weight"], False)
                yield from ["--add"] if k else []
            yield from ["--div", *self.enlarged(first), "--label", f"MIXTURE{number}", "--pop"]

    def factor(self, factor):
        kind, number = factor
        return self.sample(number) if kind == "footprint" else [f"MIXTURE{number}"]

    def weight(self, term):
        """Of a correction, by how many targets have samples. The picture is no term of a sum."""
        if term["role"] != "correction":
            return term["role"] != "picture"
        targets, edited = len(self.set["targets"]), len(self.edited)
        return (targets - edited) / (edited * (targets - 1)) if term["target"] in self.edited else 0

    def radiance(self, term):
        gain = [word for f in term["factors"] if "image" in f for word in [*self.part(f["image"]), "--mul"]]
        weight = [] if self.weight(term) == 1 else ["--mulc", f"{self.weight(term)}"]
        return [*self.part(term["radiance"]), *gain, *weight]

    def sum(self, terms):
        """Of terms and the factors they have left: those without, and for each first factor it times its own sum."""
        whole = [self.radiance(term) for term, factors in terms if not factors]
        for first in dict.fromkeys(factors[0] for _, factors in terms if factors):
            rest = [(term, factors[1:]) for term, factors in terms if factors and factors[0] == first]
            whole.append([*self.sum(rest), *self.factor(first), "--mul"])
        return [word for k, part in enumerate(whole) for word in (part + ["--add"] if k else part)]


def main(path, samples, out):
    chain = Chain(manifest(path), manifest(samples))
    terms = [(term, tuple((kind, f[kind]) for f in term["factors"] for kind in ("footprint", "mixture") if kind in f))
             for term in chain.set["terms"] if chain.weight(term)]
    call = ["oiiotool", path, "--label", "SET", "--pop", samples, "--label", "SAMPLES", "--pop",
            *chain.mixtures(), *chain.sum(terms), "--chnames", "R,G,B", "-d", "half", "-o", out]
    print("\n".join(call))


if __name__ == "__main__":
    main(*sys.argv[1:])
