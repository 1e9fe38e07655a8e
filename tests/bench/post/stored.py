"""What a set or a pack takes on the disk, by what its parts are for: stored.py FILE SET

Prints JSON: bytes of the file, and of the parts of each use, compressed as they are. Of an OpenEXR file these are the
chunks of the parts, of a pack the entries of the zip that are named after them. SET, often FILE itself, has the same
parts and is one that retex-info reads.
"""
import json
import os
import struct
import subprocess
import sys
import zipfile

USES = ["radiance", "UV", "spread", "albedo", "shares", "originals", "denoising data", "picture", "other"]


def uses(manifest):
    """Of each part its use: the first that refers to it."""
    found = {}

    def put(name, use):
        if name:
            found.setdefault(name, use)
    for term in manifest["terms"]:
        put(term["radiance"] if term["role"] != "picture" else None, "radiance")
        for factor in term["factors"]:
            put(factor.get("image"), "radiance")
    for footprint in manifest["footprints"]:
        put(footprint["uv"], "UV")
        put(footprint.get("spread") or footprint.get("axes"), "spread")
        put(footprint["albedo"], "albedo")
    for share in (share for mixture in manifest.get("mixtures", []) for share in mixture):
        put(share["weight"], "shares")
    for target in manifest["targets"]:
        put(target["original"], "originals")
    put(manifest["parts"][0]["name"], "picture")
    for part in manifest["parts"]:
        put(part["name"], "denoising data" if part["name"].startswith(("noise_", "guide_")) else "other")
    return found


def text(file):
    letters = bytearray()
    while (letter := file.read(1)) not in (b"\0", b""):
        letters += letter
    return letters.decode("ascii")


def exr_headers(file):
    """Of each part the number of chunks."""
    file.seek(8)
    counts = []
    while name := text(file):
        count = 0
        while name:
            text(file)
            value = file.read(struct.unpack("<i", file.read(4))[0])
            if name == "chunkCount":
                count = struct.unpack("<i", value)[0]
            name = text(file)
        counts.append(count)
    return counts


def exr_parts(path):
    """Of each part, in the file's order, the bytes of its chunks."""
    with open(path, "rb") as file:
        counts = exr_headers(file)
        offsets = [struct.unpack(f"<{count}Q", file.read(8 * count)) for count in counts]
        sizes = [0] * len(counts)
        for number, places in enumerate(offsets):
            for place in places:
                file.seek(place)
                sizes[number] += 12 + struct.unpack("<iii", file.read(12))[2]
        return sizes


def pack_parts(path, names):
    sizes = dict.fromkeys(names, 0)
    with zipfile.ZipFile(path) as pack:
        for entry in pack.infolist():
            name = os.path.basename(entry.filename).partition(".")[0]
            name = names[0] if name == "picture" else name
            sizes[name] = sizes.get(name, 0) + entry.compress_size
    return sizes


def main(path, manifest_of):
    told = subprocess.run(["retex-info", "--json", manifest_of], check=True, stdout=subprocess.PIPE).stdout
    manifest = json.loads(told)
    names = [part["name"] for part in manifest["parts"]]
    sizes = pack_parts(path, names) if zipfile.is_zipfile(path) else dict(zip(names, exr_parts(path)))
    use_of, total = uses(manifest), dict.fromkeys(USES, 0)
    for name, size in sizes.items():
        total[use_of.get(name, "other")] += size
    whole = os.path.getsize(path)
    total["other"] += whole - sum(total.values())   # headers and directories
    print(json.dumps({"bytes": whole, "uses": total}))


if __name__ == "__main__":
    main(*sys.argv[1:])
