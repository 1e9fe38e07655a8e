"""What web pages load, and how near their pictures are: figures.py WORK OUT.csv HEAD ROOMS HEIGHT SPP >MD

ROOMS are of the living room, SIZE-SAMPLES. HEIGHT and SPP are of the scenes whose pictures are compared. Sets are kept in WORK and not made twice.
"""
import csv
import json
import os
import re
import shutil
import subprocess
import sys

TEXTURES = ("walnut-herringbone", "terrazzo", "damask")
ROWS = []  # section, room, what, figure, value


def run(*words):
    done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8", check=False)
    if done.returncode:
        sys.exit(f"bench-web: {' '.join(words)}: {done.stderr}")
    return done.stderr


def record(section, room, what, figure, value):
    ROWS.append((section, room, what, figure, value))
    return value


def folder(work, name, scene, size, spp, render=(), pack=()):
    """A set, and its page in WORK/NAME; returns what retex-pack says."""
    made = f"{work}/{name}.exr"
    if not os.path.exists(made):
        run("retex-render", "-q", "--denoise", "-t", "Floor", "-t", "Wall", "--size", size, "--spp", spp, *render, scene, "-o", made)
    shutil.rmtree(f"{work}/{name}", ignore_errors=True)
    return run("retex-pack", made, "--web", f"{work}/{name}", *pack)


def psnr(work, name, edit, options):
    """Of the page's picture under the words of reference.py, and of retex-combine's under its options."""
    run("/usr/bin/python3", "-B", "tests/web/reference.py", f"{work}/{name}", f"{work}/page.exr", *edit)
    run("retex-combine", "-q", f"{work}/{name}.exr", *options, "-o", f"{work}/set.exr")
    return differ(f"{work}/page.exr", f"{work}/set.exr")


def differ(first, second):
    done = subprocess.run(["retex-diff", "--json", first, second], stdout=subprocess.PIPE, check=False)
    if done.returncode not in (0, 1):
        sys.exit(f"bench-web: retex-diff {first} {second} failed")
    return json.loads(done.stdout)["psnr"]


def textures(**surfaces):
    """The same for reference.py and for retex-combine."""
    images = {name: f"scenes/textures/{image}.jpg" for name, image in surfaces.items()}
    return ([f"{name}={image}" for name, image in images.items()],
            [word for name, image in images.items() for word in ("--texture", f"{name}={image}")])


def table(heads, rows):
    print("| " + " | ".join(heads) + " |\n|" + "---|" * len(heads))
    for row in rows:
        print("| " + " | ".join(row) + " |")


def kilobytes(count):
    return f"{count / 1e6:.2f} MB" if count >= 1e6 else f"{count / 1e3:.0f} KB"


def decibels(value):
    return f"{value:.1f} dB"


def loads(work, rooms):
    print("## What is loaded\n\nThe living room with `Floor` and `Wall`, denoised, at several sizes and samples a pixel:\n")
    columns = {}
    for room in rooms:
        size, spp = room.split("-")
        said = folder(work, f"living-room-{room}", "scenes/living-room/living-room.pov", size, spp)
        whole, picture, target = map(int, re.search(r"(\d+) bytes, (\d+) until the picture, (\d+) until", said).groups())
        player = sum(os.path.getsize(f"{work}/living-room-{room}/{name}") for name in ("retex-room.js", "index.html"))
        columns[f"{size}, {spp} samples"] = (player, picture, target, whole)
    labels = ("player and page", "until the picture is shown", "until the first target can be changed", "all")
    table(["", *columns], [[label, *(kilobytes(record("loaded", room, label, "bytes", sizes[k]))
                                     for room, sizes in columns.items())] for k, label in enumerate(labels)])


def near(work, rooms):
    print("""
## How near pictures are

PSNR of the page's picture, by `tests/web/reference.py`, against that of `retex-combine` from the set. What is left is
mostly the loss of the page's small files.
""")
    for name, title in rooms:
        for one in TEXTURES:
            for surface in ("Floor", "Wall"):
                record("near", title, f"{surface}, {one}", "psnr", psnr(work, name, *textures(**{surface: one})))
        record("near", title, "Floor, terrazzo, and Wall, damask", "psnr", psnr(work, name, *textures(Floor="terrazzo", Wall="damask")))
        record("near", title, "originals", "psnr", psnr(work, name, [], []))
    value = {(title, what): v for _, title, what, figure, v in ROWS if figure == "psnr"}
    whats = ["originals", *(f"{s}, {t}" for t in TEXTURES for s in ("Floor", "Wall")), "Floor, terrazzo, and Wall, damask"]
    table(["", *(title for _, title in rooms)],
          [[what, *(decibels(value[title, what]) for _, title in rooms)] for what in whats])


def lamps(work, scenes, spp):
    print("""
## Lamps

Rooms with their lamps apart. A page has each lamp's shares of light, smaller than the picture:
""")
    rows = []
    for name, size in scenes:
        said = folder(work, f"lamps-{name}", f"scenes/{name}/{name}.pov", size, spp, ("--lamps", "each"))
        title, line = f"{name}, {size}", re.search(r"lamps (.*): (\d+) bytes", said)
        known = [lamp for lamp in line[1].split(", ") if lamp != "rest"]
        rows.append([title, "bytes of lamps", kilobytes(record("lamps", title, "lamps", "bytes", int(line[2])))])
        for lamp in known:
            value = psnr(work, f"lamps-{name}", ["light:*=0", f"light:{lamp}=1"], ["--solo", lamp])
            rows.append([title, f"`{lamp}` alone", decibels(record("lamps", title, lamp, "psnr", value))])
    words, options = textures(Floor="walnut-herringbone")
    value = psnr(work, "lamps-living-room", ["light:Daylight=0.2", "light:Lamp=3*rgb(1,.6,.2)", *words],
                 ["--light", "Daylight=0.2", "--light", "Lamp=3*rgb(1,.6,.2)", *options])
    rows.append([rows[0][0], "`Daylight` .2, `Lamp` 3 times and orange, a floor of walnut",
                 decibels(record("lamps", rows[0][0], "edit", "psnr", value))])
    table(["room", "", ""], rows)


def finishes(work, height, spp):
    print("\n## Finishes\n\nThe living room with three finishes of `Floor` and two of `Wall`:\n")
    wide = height * 16 // 9
    title = f"living-room, {wide}x{height}"
    folder(work, "finishes", "scenes/living-room/living-room.pov", f"{wide}x{height}", spp,
           ("--finish", "Floor=original,satin,polished", "--finish", "Wall=original,satin"))
    rows = []
    for floor, wall in (("original", "original"), ("satin", "original"), ("polished", "original"), ("polished", "satin")):
        value = psnr(work, "finishes", [f"finish:Floor={floor}", f"finish:Wall={wall}"],
                     ["--finish", f"Floor={floor}", "--finish", f"Wall={wall}"])
        rows.append([floor, wall, decibels(record("finishes", title, f"{floor}, {wall}", "psnr", value))])
    table(["`Floor`", "`Wall`", title], rows)


def smaller(work, height, spp):
    wide = height * 16 // 9
    print(f"""
## Smaller rooms

The living room, {wide}x{height}, with rooms of half and a quarter of its size beside it. Pictures of a smaller room are
compared with those of the set, averaged:
""")
    said = folder(work, "smaller", "scenes/living-room/living-room.pov", f"{wide}x{height}", spp, (), ("--web-smaller", "2,4"))
    whole = int(re.search(r": (\d+) bytes, \d+ until", said)[1])
    found = re.findall(r"smaller room, (\S+): (\d+) bytes", said)
    rows = [["whole", kilobytes(record("smaller", "whole", "room", "bytes", whole)), "", ""]]
    with open(f"{work}/smaller/room.json", encoding="utf-8") as file:
        manifests = [entry["file"] for entry in json.load(file)["smaller"]]
    for (size, count), manifest in zip(found, manifests):
        shutil.copytree(f"{work}/smaller", f"{work}/small", dirs_exist_ok=True)
        shutil.copy(f"{work}/smaller/{manifest}", f"{work}/small/room.json")
        line = [size, kilobytes(record("smaller", size, "room", "bytes", int(count)))]
        for what, (words, options) in (("originals", ([], [])), ("both", textures(Floor="terrazzo", Wall="damask"))):
            run("/usr/bin/python3", "-B", "tests/web/reference.py", f"{work}/small", f"{work}/page.exr", *words)
            run("retex-combine", "-q", f"{work}/smaller.exr", *options, "-o", f"{work}/set.exr")
            run("oiiotool", f"{work}/set.exr", "--ch", "R,G,B", "--resize:filter=box", size, "-d", "float", "-o", f"{work}/half.exr")
            line.append(decibels(record("smaller", size, what, "psnr", differ(f"{work}/page.exr", f"{work}/half.exr"))))
        rows.append(line)
        shutil.rmtree(f"{work}/small")
    table(["room", "loaded", "originals", "terrazzo floor, damask wall"], rows)


def main(work, path, head, rooms, height, spp):
    rooms, height = rooms.split(), int(height)
    scenes = [(name, f"{height * wide // high}x{height}") for name, wide, high in (("living-room", 16, 9), ("kitchen", 4, 3))]
    print(f"# Figures of web pages\n\nWhat a page of [`retex-pack --web`](web.md) loads, and how near its pictures come to those of `retex-combine`.\n"
          f"[web-figures.csv](web-figures.csv) has the same figures.\n{head}\n")
    loads(work, rooms)
    for name, size in scenes:
        folder(work, name, f"scenes/{name}/{name}.pov", size, spp)
    near(work, [(name, f"{name}, {size}") for name, size in scenes])
    lamps(work, scenes, spp)
    finishes(work, height, spp)
    smaller(work, height, spp)
    with open(path, "w", newline="", encoding="ascii") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["section", "room", "what", "figure", "value"])
        out.writerows((*row[:4], f"{row[4]:.6g}") for row in ROWS)


main(*sys.argv[1:])
