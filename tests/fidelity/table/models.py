"""For models.sh: imports models, renders them, and compares with three.js. WORK HEAD SPP NAME…

Both draw the colours of surfaces alone, from the camera that retex-import chose: retex the AOV albedo_mean, three.js
materials without light. Compared are which pixels show the model at all, and means of colour in 16 x 12 regions that
both cover, as sRGB. Surfaces that transmit light or that are blended with what is behind them differ by definition: the
AOV shows the first surface. Such regions, and what else differs, are named in the column `why` of models.csv. In rooms
with a column `floor`, that target is rendered and gets walnut planks, an image of which is `width` wide."""
import base64
import csv
import hashlib
import json
import math
import os
import re
import shutil
import subprocess
import sys
import time

import numpy as np
import OpenImageIO as oiio

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "../../web"))
from browser import Browser, serve  # pylint: disable=wrong-import-position

WALNUT = os.path.join(HERE, "../../../scenes/textures/walnut-herringbone.jpg")
WIDTH = 320
COLUMNS, ROWS = 16, 12  # regions
DIFFERS = 0.05          # of a region's mean, of 1
FREE = re.compile(r"CC0|CC-BY-[0-9]|CC-BY$|MIT|BSD|Apache|GPL|public domain", re.I)  # licences that allow showing a picture
A_SHEET = 8             # models on one picture of the page


def run(*command, timeout=None):
    """Status, what was told, and seconds; status -1: it was not done in time."""
    began = time.time()
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", check=False, timeout=timeout)
    except subprocess.TimeoutExpired:
        return -1, f"not done in {timeout} s", time.time() - began
    return done.returncode, done.stderr.replace(f"{os.path.basename(command[0])}: ", ""), time.time() - began


def hash_of(path):
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()


def camera_of(scene):
    """The scene's camera as three.js has it, right-handed, and its aspect."""
    with open(scene, encoding="utf-8") as file:
        text = file.read()
    used = re.findall(r"^camera \{ (\w+) \}", text, re.M)
    start = rf"#declare {used[-1]} = camera \{{" if used else r"^camera \{"
    block = re.search(start + r"(.*?)\n\}", text, re.S | re.M).group(1)

    def vector(key):
        found = re.search(rf"\b{key}\s+<([^>]*)>", block)
        return [float(x) for x in found.group(1).split(",")] if found else None

    right = re.search(r"right x \* ([\d.]+)(?:/([\d.]+))?", block)
    aspect = float(right.group(1)) / float(right.group(2) or 1)
    angle = float(re.search(r"\bangle ([\d.]+)", block).group(1))
    place, target, up = vector("location"), vector("look_at"), vector("sky") or [0, 1, 0]
    turn = lambda v: [v[0], v[1], -v[2]]
    upright = 2 * math.degrees(math.atan(math.tan(math.radians(angle) / 2) / aspect))
    return {"location": turn(place), "target": turn(target), "up": turn(up), "fov": upright}, aspect


def read(path, part=0):
    image = oiio.ImageBuf(path, part, 0)
    return None if image.has_error or not image.spec().width else image.get_pixels(oiio.FLOAT)


def aov(path, name):
    part = 0
    while True:
        image = oiio.ImageBuf(path, part, 0)
        if image.has_error or not image.spec().width:
            raise SystemExit(f"{path} has no part {name}")
        if image.spec().getattribute("oiio:subimagename") == name:
            return image.get_pixels(oiio.FLOAT)
        part += 1


def encode(x):
    x = np.clip(x, 0, 1)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.maximum(x, 1e-9)**(1 / 2.4) - 0.055)


def write(path, pixels):
    pixels = np.ascontiguousarray(pixels[:, :, :3], np.float32)
    out = oiio.ImageBuf(oiio.ImageSpec(pixels.shape[1], pixels.shape[0], 3, oiio.FLOAT))
    out.set_pixels(out.roi, pixels)
    out.specmod().attribute("CompressionQuality", 85)
    out.write(path, "uint8")


def from_browser(url, path):
    with open(path, "wb") as file:
        file.write(base64.b64decode(url.split(",")[1]))
    pixels = read(path)
    return pixels if pixels.shape[2] == 4 else np.concatenate([pixels, np.ones_like(pixels[:, :, :1])], 2)


def compare(ours, covered, theirs, shown):
    """Shares of pixels that one of both shows, and of regions whose mean differs; the regions' mean difference."""
    height, width = covered.shape
    found = []
    for j in range(ROWS):
        for i in range(COLUMNS):
            place = np.s_[j * height // ROWS:(j + 1) * height // ROWS, i * width // COLUMNS:(i + 1) * width // COLUMNS]
            both = covered[place] & shown[place]
            if both.mean() > 0.1:
                found.append(np.abs((ours[place][both] - theirs[place][both]).mean(0)).max())
    found = np.array(found or [0])
    return np.mean(covered != shown), np.mean(found > DIFFERS), found.mean()


class Page:
    """three.js in a browser, started when it is asked for first."""

    def __init__(self, work):
        self.address, self.browser = serve(work), None

    def draw(self, name, file, camera, height):
        if not self.browser:
            self.browser = Browser()
        self.browser.call("Page.navigate", url=self.address + "models.html")
        self.browser.run("new Promise(done => { const look = () => window.ready ? done(1) : setTimeout(look, 50); "
                         "look(); })")
        return self.browser.run(f"draw({json.dumps(f'/models/{name}/')}, {json.dumps(file)}, {json.dumps(camera)}, "
                                f"{WIDTH}, {height})")

    def close(self):
        if self.browser:
            self.browser.close()


UNITS = {"centimetres": .01, "millimetres": .001, "inches": .0254}


def scale_of(told):
    """What the tool multiplied lengths by."""
    found = re.search(r"taken as (\w+), and become metres", told)
    return UNITS[found.group(1)] if found else 1


def one(work, page, row, spp):
    """What became of a model: a dictionary for the table."""
    name, file = row["name"], os.path.basename(row["path"])
    folder, model = f"{work}/scenes/{name}", f"{work}/models/{name}/{file}"
    shutil.rmtree(folder, ignore_errors=True)
    code, told, seconds = run("retex-import", "--partial", "-o", folder, *row["options"].split(), model)
    lines = [line for line in told.splitlines() if not line.startswith("wrote ")]
    got = dict(row, code=code, told=lines, seconds=seconds)
    if code:
        return got
    scene, set_file = f"{folder}/{name}.pov", f"{work}/{name}.exr"
    camera, aspect = camera_of(scene)
    scale = scale_of("\n".join(lines))
    height = round(WIDTH / aspect)
    code, told, _ = run("retex-render", "-q", "--denoise", "--size", f"{WIDTH}x{height}", "--spp", str(spp), "--aov",
                        "albedo_mean,depth", *(["-t", row["floor"]] if row["floor"] else []), scene, "-o", set_file)
    if code:
        return dict(got, code=code, told=told.splitlines())
    run("retex-combine", "-q", "--auto-exposure", set_file, "-o", f"{work}/{name}-retex.png")
    if row["floor"]:
        run("retex-combine", "-q", "--auto-exposure", set_file, f"--texture:width={row['width']}", f"Floor={WALNUT}",
            "-o", f"{work}/{name}-walnut.png")
        write(f"{work}/{name}-floors.png", np.concatenate(
            [read(f"{work}/{name}-{which}.png")[:, :, :3] for which in ("retex", "walnut")], 1))
    depth = aov(set_file, "depth")[:, :, 0]
    covered = np.isfinite(depth)
    span = float(np.max(depth[covered], initial=1))
    camera.update(near=span / 5000, far=4 * span)
    for key, value in camera.items():
        if key in ("location", "target"):
            camera[key] = [x / scale for x in value]
        elif key in ("near", "far"):
            camera[key] = value / scale
    try:
        drawn = page.draw(name, file, camera, height)
    except RuntimeError as error:
        return dict(got, other=str(error).splitlines()[0][:100])
    flat = from_browser(drawn["flat"], f"{work}/{name}-flat.png")
    lit = from_browser(drawn["lit"], f"{work}/{name}-three.png")
    ours = encode(aov(set_file, "albedo_mean")[:, :, :3])
    write(f"{work}/{name}-albedo.png", np.concatenate([ours, flat[:, :, :3]], 1))
    cover, differs, mean = compare(ours, covered, flat[:, :, :3], flat[:, :, 3] > 0.5)
    write(f"{work}/{name}-pair.png", np.concatenate([read(f"{work}/{name}-retex.png")[:, :, :3], lit[:, :, :3]], 1))
    return dict(got, cover=cover, differs=differs, mean=mean, triangles=drawn["triangles"])


def from_above(work, row, spp):
    """A room without what stands before it."""
    name, folder = row["name"], f"{work}/scenes/{row['name']}-cutaway"
    shutil.rmtree(folder, ignore_errors=True)
    code, _, _ = run("retex-import", "--partial", "--camera", "cutaway", "-o", folder, *row["options"].split(),
                     f"{work}/models/{name}/{os.path.basename(row['path'])}")
    if code:
        return
    run("retex-render", "-q", "--denoise", "--size", f"{WIDTH}x{WIDTH * 3 // 4}", "--spp", str(spp),
        f"{folder}/{name}-cutaway.pov", "-o", f"{folder}.exr")
    run("retex-combine", "-q", "--auto-exposure", f"{folder}.exr", "-o", f"{work}/{name}-cutaway.png")


def sheets(work, found, kind, to):
    """Pictures of those that may be shown, in pairs, a few to a sheet."""
    shown = [r["name"] for r in found if FREE.search(r["licence"]) and os.path.exists(f"{work}/{r['name']}-{kind}.png")]
    names = []
    for k in range(0, len(shown), A_SHEET):
        rows, some = [], shown[k:k + A_SHEET]
        for name in some:
            pair = read(f"{work}/{name}-{kind}.png")[:240, :, :3]
            rows.append(np.pad(pair, ((0, 240 - pair.shape[0]), (0, 0), (0, 0))))
        while len(rows) % 2:
            rows.append(np.zeros_like(rows[0]))
        lines = [np.concatenate(rows[i:i + 2], 1) for i in range(0, len(rows), 2)]
        path = f"{to}-{k // A_SHEET + 1}.jpg"
        write(f"{work}/{path}", np.concatenate(lines, 0))
        names.append((path, some))
    return names


def line_of(r):
    told = "; ".join(re.sub(r"/\S*/models/", "", line.replace("warning: ", "").replace("|", "/").replace("`", "'"))
                     for line in r["told"] if not re.match(r"\d+ materials?, ", line))
    told = told if len(told) <= 240 else told[:237] + "…"
    if r["code"]:
        return f"| {r['name']} | {r['source']} | {r['licence']} | refused | | | {told} |"
    if "cover" not in r:
        return (f"| {r['name']} | {r['source']} | {r['licence']} | {r['seconds']:.1f} s | three.js: {r['other']} | | "
                f"{told} |")
    why = f"{r['why']}; " if r["why"] else ""
    return (f"| {r['name']} | {r['source']} | {r['licence']} | {r['triangles']:,}, {r['seconds']:.1f} s | "
            f"{100 * r['cover']:.1f} % | {100 * r['differs']:.0f} % | {why}{told} |")


def write_page(work, head, found, spp, missing):
    kinds = {kind: [r for r in found if r["kind"] == kind] for kind in ("room", "furniture", "test")}
    whole = sum(not r["code"] for r in found)
    alike = sum("cover" in r and (r["cover"] < 0.005 and r["differs"] < 0.02) for r in found)
    with open(f"{work}/models.md", "w", encoding="utf-8") as out:
        print(f"# Models of other people\n\n{head}\n", file=out)
        print(f"{len(found)} models of {len({r['source'] for r in found})} sources, as `retex-import --partial` brings "
              f"them in: {whole} become scenes, the others are refused in one line. "
              f"{alike} of them show the same colours as three.js in at least 98 % of {COLUMNS} x {ROWS} regions "
              f"(to {DIFFERS}) and the same outline to half a percent of the picture; what differs in the others is "
              "said. The list, with revisions and hashes, is `tests/fidelity/table/models.csv`; the models are not in "
              f"the repository. Pictures are {WIDTH} wide, {spp} samples, denoised, with `--auto-exposure`.\n", file=out)
        print("The AOV shows the first surface, three.js what is behind glass and blended images: such surfaces "
              "differ by definition.\n", file=out)
        for kind, title in (("room", "Rooms"), ("furniture", "Furniture"), ("test", "Tests of extensions")):
            print(f"## {title}\n\n| model | from | licence | triangles, import | outline differs | regions differ | "
                  "told |", file=out)
            print("|---|---|---|---|---|---|---|", file=out)
            for r in kinds[kind]:
                print(line_of(r), file=out)
            print("", file=out)
        print("## Other floors\n\nRooms as `retex-import` shows them, and with walnut on the floor, from one render each, "
              "by the target of the column `floor` of the list, as in `-t Floor=@140:228/level`.\n", file=out)
        for path, names in sheets(work, found, "floors", "models-floors"):
            print(f"{', '.join(names)}:\n\n![rooms with another floor]({'pictures/' + path})\n", file=out)
        print("## From above\n\nClosed rooms by `retex-import --camera cutaway`, which leaves out what stands before "
              "them.\n", file=out)
        for path, names in sheets(work, found, "cutaway", "models-cutaway"):
            print(f"{', '.join(names)}:\n\n![rooms from above]({'pictures/' + path})\n", file=out)
        print("## Pictures\n\nretex at the left, three.js with lights of its own at the right; of models whose licence "
              "allows it.\n", file=out)
        for path, names in sheets(work, found, "pair", "models"):
            print(f"{', '.join(names)}:\n\n![models]({'pictures/' + path})\n", file=out)
        if missing:
            print(f"Not there when this page was made: {', '.join(missing)}.", file=out)


def main(work, head, spp, *names):
    with open(f"{HERE}/models.csv", encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if not names or row["name"] in names]
    found, missing, page = [], [], Page(work)
    for row in rows:
        path = f"{work}/models/{row['name']}/{os.path.basename(row['path'])}"
        if not os.path.exists(path) or hash_of(path) != row["sha256"]:
            missing.append(row["name"])
            continue
        r = one(work, page, row, spp)
        found.append(r)
        if any("view is from inside" in line for line in r["told"]):
            from_above(work, row, spp)
        what = f"outline {100 * r['cover']:.1f} %, regions {100 * r['differs']:.0f} %" if "cover" in r else r["told"]
        print(f"fidelity-models: {r['name']}: {what}", file=sys.stderr)
    page.close()
    for name in missing:
        print(f"fidelity-models: {name} is not there, or another file", file=sys.stderr)
    write_page(work, head, found, spp, missing)


if __name__ == "__main__":
    main(*sys.argv[1:])
