"""Reads picture files whole and damaged, with make_digests. `pictures.py whole` compares pixels with those that are
recorded in data/pictures.txt, by another program: a build that did not look for damage. `pictures.py record DIGESTS` writes
that file. `pictures.py pixels` damages coded pixels alone. `pictures.py damaged CUTS COUNT SEED` damages the files
as damage_pictures.py does; `pictures.py accepted CUTS COUNT SEED` accepts it, and that of coded pixels too."""
import collections
import hashlib
import os
import re
import shutil
import struct
import subprocess
import sys
import zlib

HERE = os.path.dirname(os.path.abspath(__file__))
TABLE = os.path.join(HERE, "..", "data", "pictures.txt")

# Files with checksums: what is damaged in their pixels is always found.
CHECKED = re.compile(r"png|exr-(zip|zips)-|exr-tiled\.|tiff-zip")
# Formats in which a changed byte is a changed pixel or another valid code; the readers cannot know of it.
UNCHECKED = {
    "bmp": "pixels as they are", "dds": "pixels as they are", "dpx": "pixels as they are", "fits": "pixels as they are",
    "pfm": "pixels as they are", "pnm": "pixels as they are", "psd": "pixels as they are, or runs of them",
    "sgi": "pixels as they are, or runs of them", "tga": "pixels as they are, or runs of them",
    "iff": "pixels as they are, or runs of them", "rla": "runs of pixels", "hdr": "runs of pixels",
    "ico": "pixels as they are", "zfile": "pixels as they are",
    "exr": "pixels as they are, or codes without checksums (RLE, PIZ, B44, DWA)", "gif": "LZW without a checksum",
    "tiff": "pixels as they are, or codes without checksums (LZW, PackBits, JPEG, fax); tags",
    "jpeg": "Huffman codes find back into step after a change", "webp": "arithmetic codes",
    "heif": "arithmetic codes", "jp2": "arithmetic codes", "j2k": "arithmetic codes",
}


def make_files():
    os.makedirs("whole", exist_ok=True)
    subprocess.run(["make_jpegs", "whole"], check=True)
    subprocess.run(["make_tiffs", "whole"], check=True, stderr=subprocess.DEVNULL)
    subprocess.run(["/usr/bin/python3", os.path.join(HERE, "..", "lib", "make_pictures.py"), "whole"], check=True)


def read(folder, *options):
    """By file: the lines of its pixels, warnings, and what was printed."""
    results = collections.OrderedDict()
    names = sorted(os.listdir(folder))
    for first in range(0, len(names), 200):
        batch = names[first:first + 200]
        output = subprocess.run(["make_digests", *options, *batch], cwd=folder, stdout=subprocess.PIPE, check=False)
        lines = [line for line in output.stdout.decode(errors="replace").split("\n") if line]
        if output.returncode != 0:
            print(f"make_digests ended with {output.returncode} after {lines[-1:]}")
        warnings = []
        for line in lines:
            if line.startswith("warning: "):
                warnings.append(line)
            elif line.startswith("printed: "):
                print(f"{list(results)[-1]}: {line}")
            else:
                name, result = line.split(" ", 1)
                results[name] = (result, warnings)
                warnings = []
    return results


def sum_of(name):
    with open(os.path.join("whole", name), "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()[:16]


def recorded():
    with open(TABLE, encoding="ascii") as file:
        return {line.split()[0]: line.split()[1:] for line in file if not line.startswith("#")}


def whole():
    """All are read, without a warning. Of those that are the same files as when they were recorded, the pixels are too:
    other versions of the libraries may encode them otherwise."""
    expected, same = recorded(), 0
    results = read("whole")
    for name, (result, warnings) in results.items():
        known = expected.get(name, [""])
        if "refused" in result or warnings:
            print(name, result, *warnings)
        elif known[0] == sum_of(name):
            same += 1
            if result.split() != known[1:]:
                print(f"{name}: {result}, not {' '.join(known[1:])}")
    print("read" if len(results) >= 150 else f"only {len(results)}")
    print("# ", same, "files are those that were recorded")


def damage(*how):
    shutil.rmtree("damaged", ignore_errors=True)
    os.makedirs("damaged")
    subprocess.run(["/usr/bin/python3", os.path.join(HERE, "..", "lib", "damage_pictures.py"), "whole", "damaged", *how],
                   check=True)


def judge_all(read_files, accepts):
    """Of what read() gave of damaged files: how many of each kind are refused, read as they were, or with other pixels."""
    right = {name: result for name, (result, _) in read("whole").items()}
    found = collections.defaultdict(collections.Counter)
    for name, (result, warnings) in read_files.items():
        parts = re.fullmatch(r"(.*?)@(\w+)-\d+(\.\w+)", name)
        if not parts:
            continue  # of damage_pixels
        base, damage, ending = parts.groups()
        kind = "refused" if "refused" in result else "same" if result == right[base + ending] else "other"
        group = re.split(r"[-.]", base)[0]
        found[group][damage, kind] += 1
        if kind == "other" and not warnings:
            judge(name, group, base, damage)
        if warnings and not accepts:
            print(f"{name}: {warnings}")
        if kind == "refused" and warnings:
            print(f"{name}: refused and warned of")
    with open("shares.txt", "w", encoding="ascii") as table:
        for group, counts in sorted(found.items()):
            print(group, *(f"{damage} {counts[damage, 'refused']}/{counts[damage, 'same']}/{counts[damage, 'other']}"
                           for damage in ("cut", "zeros", "flip", "missing", "surplus")), UNCHECKED.get(group, ""),
                  file=table, sep="; ")
    return found


def accept_twice():
    """Damage is accepted, and told. Pixels that are not in a file are the same whatever memory held before: glibc fills it with a byte. OpenImageIO takes
    64 MiB at a time, which it must not map anew for each file. Messages may differ, where threads decode."""
    results = read("damaged", "-a")
    judge_all(results, True)
    filling = {"MALLOC_PERTURB_": "201",
               "GLIBC_TUNABLES": "glibc.malloc.mmap_threshold=200000000:glibc.malloc.trim_threshold=300000000"}
    os.environ.update(filling)
    filled = read("damaged", "-a")
    for name in filling:
        del os.environ[name]
    for name, (result, _) in results.items():
        if "refused" not in result and result != filled[name][0]:
            print(f"{name}: pixels of what was in memory")
    same = sum("refused" not in result for result, _ in results.values())
    print("pictures" if same > 600 else f"only {same} pictures")


def judge(name, group, base, damage):
    """A damaged file was read, with other pixels, and nobody was told."""
    if damage == "cut":
        print(f"{name}: cut off, and read")
    elif group not in UNCHECKED or CHECKED.match(base):
        # damage of a TIFF's tags is not damage of its pixels
        if not (group == "tiff" and damage in ("flip", "zeros", "surplus")):
            print(f"{name}: read with other pixels")


def tags_of(data):
    """Of a TIFF's first picture, those of short and long numbers: tag, byte order, form, how many, and where."""
    order = "<" if data[:2] == b"II" else ">"
    at, = struct.unpack_from(order + "I", data, 4)
    for entry in range(struct.unpack_from(order + "H", data, at)[0]):
        tag, kind, count = struct.unpack_from(order + "HHI", data, at + 2 + 12 * entry)
        size, letter = {3: (2, "H"), 4: (4, "I")}.get(kind, (0, ""))
        place = at + 10 + 12 * entry
        if size * count > 4:
            place, = struct.unpack_from(order + "I", data, place)
        if size:
            yield tag, order, letter, count, place


def blocks_of(data):
    """Where the strips or tiles of a TIFF's first picture begin, and their bytes."""
    values = {tag: struct.unpack_from(f"{order}{count}{letter}", data, place)
              for tag, order, letter, count, place in tags_of(data)}
    return list(zip(values.get(273) or values[324], values.get(279) or values[325]))


def damage_pixels(folder):
    """Files that are whole but for their coded pixels: the sums of deflate streams, which OpenImageIO and libtiff do not
    look at, and codes of which libtiff only warns. And an IFF beside 0,0, for which OpenImageIO's reader has no memory."""
    sys.path.insert(0, os.path.join(HERE, "..", "lib"))
    import make_pictures  # pylint: disable=import-outside-toplevel
    with open(f"{folder}/png-sum.png", "wb") as file:  # the sum is in chunks of its own
        file.write(make_pictures.png(6, 16, pieces=2000, damage=True))
    with open("whole/iff-rle.iff", "rb") as file:
        data = bytearray(file.read())
    data[0x2e] = 1  # x is 256
    with open(f"{folder}/iff-beside.iff", "wb") as file:
        file.write(data)
    for name in sorted(os.listdir("whole")):
        kind = re.fullmatch(r"tiff-(zip|fax|jpeg\.).*", name)
        if not kind:
            continue
        with open(f"whole/{name}", "rb") as file:
            data = bytearray(file.read())
        at, size = blocks_of(data)[0]
        if kind[1] == "zip":
            data[at + size - 1] ^= 1
        else:
            data[at + size // 2:at + size // 2 + 24] = bytes(24)
        with open(f"{folder}/{name}", "wb") as file:
            file.write(data)
        if kind[1] == "zip":
            with open(f"whole/{name}", "rb") as file:
                overfill(bytearray(file.read()), f"{folder}/overfull-{name}")


def overfill(data, path):
    """Writes a TIFF whose first strip or tile inflates to more than its pixels, by a run of equal bytes that goes on
    beyond them. libtiff leaves the end of that run out, and says nothing."""
    at, size = blocks_of(data)[0]
    pixels = zlib.decompress(data[at:at + size])
    coded = zlib.compress(pixels[:-40] + bytes([7]) * 640)
    replace_block(data, len(data), len(coded))
    with open(path, "wb") as file:
        file.write(data + coded)


def replace_block(data, at, size):
    """Where the first strip or tile is, in the tags of a TIFF."""
    for tag, order, letter, _, place in tags_of(data):
        if tag in (273, 324, 279, 325):
            struct.pack_into(order + letter, data, place, at if tag in (273, 324) else size)


def pixels():
    os.makedirs("pixels", exist_ok=True)
    damage_pixels("pixels")
    results = read("pixels")
    for name, (result, _) in results.items():
        if "refused" not in result:
            print(f"{name}: {result}")
    print("refused" if len(results) > 10 else f"only {len(results)}")


# How files begin by the specifications of their formats: where, and with what. Nothing else may have the ending.
SIGNATURES = [
    ("png", 0, "89504e470d0a1a0a"), ("jpg jpe jpeg jif jfif jfi", 0, "ffd8ff"),
    ("tif tiff tx env sm vsm", 0, "49492a00 4d4d002a"), ("exr sxr mxr", 0, "762f3101"), ("hdr rgbe", 0, "233f52"),
    ("bmp dib", 0, "424d"), ("tga tpic", 0, "000002 00000a"), ("webp", 8, "57454250"), ("avif", 4, "6674797061766966"),
    ("jxl", 0, "ff0a"),
    ("heic", 4, "6674797068656963"), ("heif", 4, "6674797068656963 667479706d696631"),
    ("jp2", 0, "0000000c6a5020200d0a870a"), ("j2k j2c", 0, "ff4fff51"), ("dpx", 0, "53445058 58504453"),
    ("gif", 0, "474946383761 474946383961"), ("ppm", 0, "5036"), ("pnm", 0, "5036"), ("pfm", 0, "5046"),
    ("sgi rgb rgba bw int inta", 0, "01da"), ("ico", 0, "00000100"), ("iff", 0, "464f5234"), ("rla", 26, "fffe"),
    ("fits", 0, "53494d504c45"),
]


def endings():
    """Writes a picture with each ending of OpenImageIO's. It is of that format, and can be read, or the ending is refused,
    with those that can be written."""
    import OpenImageIO as oiio  # pylint: disable=import-outside-toplevel
    signatures = {ending: (at, marks.split()) for names, at, marks in SIGNATURES for ending in names.split()}
    known = {ending for part in oiio.get_string_attribute("extension_list").split(";")
             for ending in part.split(":")[1].split(",")}
    endings = sorted(known | set(signatures) | {"xyz"})
    refused = collections.Counter()
    for at in range(0, len(endings), 20):  # as many as retex-combine tells each of
        with open("endings.csv", "w", encoding="ascii") as table:
            print("output", *(f"c.{ending}" for ending in endings[at:at + 20]), sep="\n", file=table)
        done = subprocess.run(["retex-combine", "-q", "s.exr", "--batch", "endings.csv", "--keep-going"],
                              stderr=subprocess.PIPE, check=False)
        refused.update(line.split(":")[4].strip() for line in done.stderr.decode().splitlines()
                       if line.startswith("retex-combine: error: endings.csv:") and ".tif .exr .hdr" in line)
    written = []
    for ending in endings:
        name = f"c.{ending}"
        if os.path.exists(name) == (refused[name] == 1):
            print(f"{name}: {'written' if os.path.exists(name) else 'not written'}, {refused[name]} errors")
        if not os.path.exists(name):
            continue
        if ending in signatures:
            at, marks = signatures[ending]
            with open(name, "rb") as file:
                begin = file.read(64)[at:].hex()
            if not any(begin.startswith(mark) for mark in marks):
                print(f"{name}: begins with {begin}")
        else:
            print(f"{name}: its beginning is not known")
        written += [name] if ending != "jxl" else []  # which OpenImageIO 2.4 does not read: cli/serve_formats does
    for line in subprocess.run(["make_digests", *written], stdout=subprocess.PIPE, check=True).stdout.decode().split("\n"):
        if "refused" in line or "printed" in line:
            print(line)
    missing = {"png", "jpg", "tif", "exr", "hdr", "bmp", "tga", "webp", "avif"} - {name[2:] for name in written}
    print("written" if not missing else missing)


def tell(source, attribute, length, output):
    """A copy of an OpenEXR file whose last attribute of this name tells another length."""
    with open(source, "rb") as file:
        content = bytearray(file.read())
    at = content.rindex(attribute.encode() + b"\0") + len(attribute) + 1  # its type
    at = content.index(b"\0", at) + 1
    content[at:at + 4] = int(length).to_bytes(4, "little")
    with open(output, "wb") as file:
        file.write(content)


def main():
    what, *rest = sys.argv[1:]
    if what == "record":
        with open(rest[0], encoding="ascii") as digests, open(TABLE, "w", encoding="ascii") as table:
            print("# Picture files: the first digits of their SHA-256, their size, and digests of their pixels as floats and",
                  "# as integers, by a build that did not look for damage.", file=table, sep="\n")
            for line in digests:
                name, result = line.strip().split(" ", 1)
                if os.path.exists(os.path.join("whole", name)):
                    print(name, sum_of(name), result, file=table)
        return
    if what in ("endings", "tell"):
        {"endings": endings, "tell": tell}[what](*rest)
        return
    make_files()
    if what == "whole":
        whole()
    elif what == "damaged":
        damage(*rest)
        found = judge_all(read("damaged"), False)
        total = {kind: sum(n for (damage, k), n in found["jpeg"].items() if k == kind and damage != "cut")
                 for kind in ("refused", "same", "other")}
        # libjpeg warns of about half of the damages; of zeros in coded data, of more than two thirds
        print("jpeg", total["refused"] > total["other"],
              found["jpeg"]["zeros", "refused"] > 1.5 * found["jpeg"]["zeros", "other"])
    elif what == "pixels":
        pixels()
    elif what == "accepted":
        damage(*rest)
        damage_pixels("damaged")
        accept_twice()


if __name__ == "__main__":
    main()
