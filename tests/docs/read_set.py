"""docs/read_set.py against retex-combine, for read-set.sh: renders small sets of every kind, and prints TAP."""
import csv
import functools
import os
import subprocess
import sys

import numpy as np
import OpenImageIO as oiio

ROOT = sys.argv[1]
sys.path.insert(0, ROOT + "/docs")
import read_set  # noqa: E402

ROOM = ROOT + "/tests/golden/room.pov"
SIZE = "29x23"  # no multiple of the scales of reduced parts
CONSTANT = 100  # dB
COLORS = [(0.8, 0.2, 0.1), (0, 0, 0), (1.7, 1, 0.3), (0.1, 0.5, 0.9), (1, 1, 1), (0.3, 0.3, 0.3), (0, 0.6, 0.2),
          (0.9, 0, 0.5)]
GAINS = [None, [0.5, 0.8, 3], [0.5, 0, 3]]  # of lamps by turns; None: as rendered
number = 0


def run(*command, to=subprocess.PIPE):
    done = subprocess.run(command, stdout=to, stderr=subprocess.PIPE)
    if done.returncode:  # warnings, as of colours above 1, do not matter
        raise SystemExit(f"{command}: {done.stderr.decode()}")


def result(passed, name):
    global number
    number += 1
    print(f"{'ok' if passed else 'not ok'} {number} - {name}", flush=True)


def read_pfm(path):
    with open(path, "rb") as file:
        assert file.readline() == b"PF\n"
        width, height = map(int, file.readline().split())
        kind = "<f4" if float(file.readline()) < 0 else ">f4"
        return np.frombuffer(file.read(), kind).reshape(height, width, 3)[::-1].astype(float)


def decibels(picture, reference):
    """Of linear values, with a peak of 1; at most 200."""
    assert picture.shape == reference.shape
    return min(200, -10 * np.log10(((picture - reference) ** 2).mean() + 1e-30))


def combined(path, options):
    run("retex-combine", "-q", path, *options, "-o", "expected.pfm")
    return read_pfm("expected.pfm")


# ---- sets: name, and what makes it ----

def render(*options, spp="16"):
    return lambda path: run("retex-render", "-q", "--size", SIZE, "--spp", spp, *options, ROOM, "-o", path)


def made_of(name, *commands):
    """From another set, by commands in which SET is that set and OUT the file to make."""
    def make(path):
        for command in commands:
            run(*[{"SET": file_of(name), "OUT": path}.get(word, word) for word in command.split()])
    return make


def packed(name, quality):
    return made_of(name, f"retex-pack -q --quality {quality} SET -o set.retex",
                   "retex-pack -q --unpack set.retex -o OUT")


THREE = ["-t", "Floor", "-t", "Back", "-t", "Ball"]
TWO = THREE[:4]
LAMPS = ["--lamps=each", "-D", "Lamps=1"]
FINISHES = ["--finish", "Floor=matt,polished"]
SETS = {
    "one target": render("-t", "Floor"),
    "several targets": render(*THREE, "-D", "Gloss=0.2", "-D", "Metal=0.5"),
    "eight targets": render(*THREE, "-t", "Ceiling", "-t", "Left", "-t", "Right", "-t", "Block", "-t", "Lid"),
    "mirror and glass": render(*THREE, "-D", "Glass=1"),
    "Gaussian filter": render(*TWO, "--filter", "gaussian"),
    "one hit kept": render(*TWO, "-t", "Left", "--orders", "1"),
    "two hits kept": render(*TWO, "-t", "Left", "-t", "Right", "-t", "Ceiling", "--orders", "2"),
    "three hits kept, further hits": render("-t", "Room=Floor,Ceiling,Left,Right,Back", "--orders", "3"),
    "layout paper": render("-t", "Floor", "--layout", "paper"),
    "layout paper, several targets": render(*THREE, "--layout", "paper"),
    "layout paper, mixed terms dropped": render(*TWO, "--layout", "paper", "--strict-paper"),
    "one sample a pixel": render(*TWO, spp="1"),
    "full precision": render(*TWO, "--full-precision"),
    "denoised": made_of("several targets", "retex-denoise -q SET -o OUT"),
    "lamps": render(*TWO, *LAMPS),
    "finishes": render(*FINISHES, "--finish", "Ball=matt,satin,metal", *THREE),
    "finishes and lamps": render(*FINISHES, *TWO, *LAMPS),
    "finishes and lamps, denoised": made_of("finishes and lamps", "retex-denoise -q SET -o OUT"),
    "normals and lamps": render("--finish", "Floor=normals", *TWO, *LAMPS),
    "packed": packed("several targets", 75),
    "packed, one target": packed("one target", 40),
    "packed, mirror and glass": packed("mirror and glass", 95),
    "packed, lamps": packed("lamps", 75),
    "packed, finishes and lamps": packed("finishes and lamps", 75),
}


def file_of(name):
    path = name.replace(" ", "-").replace(",", "") + ".exr"
    if not os.path.exists(path):
        SETS[name](path)
    return path


# ---- constant colours ----

def lamps_of(manifest):
    """The values of lamps as rendered."""
    return {p.get("lamp") or p["name"]: p["value"] for p in manifest["parameters"]
            if p["kind"] == "color" and not any(p.get("finishes", []))
            and (p.get("lamp") or "finishes" not in p)}


def check_colors(name):
    """No colour, one, two, all; as rendered, with other lamps, with other finishes."""
    path = file_of(name)
    manifest = read_set.read_file(path)[0]
    names = [target["name"] for target in manifest["targets"]]
    lamps = lamps_of(manifest)
    finishes = {t["name"]: t["finishes"][-1] for t in manifest["targets"] if "finishes" in t and "normal_tilt" not in t}
    counts = sorted({0, 1, 2, len(names)} & set(range(len(names) + 1)))
    # each number of colours with all lamps and finishes by turns; none and all of them with each of these
    cases = [(count, i % len(GAINS), i % 2) for i, count in enumerate(counts)]
    cases += [(count, gained, refinished) for count in (0, len(names)) for gained in range(len(GAINS))
              for refinished in range(2)]
    rows, pictures = [], []
    for count, gained, refinished in sorted({(n, g if lamps else 0, f if finishes else 0) for n, g, f in cases}):
        colors = dict(zip(names[-count:] if count else [], COLORS))
        gains = {lamp: GAINS[gained][i % 3] for i, lamp in enumerate(lamps)} if gained else {}
        chosen = finishes if refinished else {}
        rows.append({"output": f"expected-{len(rows)}.pfm", **{t: f"rgb{c}" for t, c in colors.items()},
                     **{f"light:{lamp}": gain for lamp, gain in gains.items()},
                     **{f"finish:{target}": finish for target, finish in chosen.items()}})
        textures = {target: {"color": np.array([[[*c, 1.0]]])} for target, c in colors.items()}
        lights = {lamp: gain * np.array(lamps[lamp]) for lamp, gain in gains.items()}
        pictures.append(read_set.Picture(path, textures, chosen, lights).make())
    with open("rows.csv", "w", newline="", encoding="ascii") as file:
        table = csv.DictWriter(file, ["output", *names, *(f"light:{l}" for l in lamps),
                                      *(f"finish:{t}" for t in finishes)])
        table.writeheader()
        table.writerows(rows)
    run("retex-combine", "-q", path, "--batch", "rows.csv")
    worst = min(decibels(picture, read_pfm(row["output"])) for row, picture in zip(rows, pictures))
    print(f"# {name} | {worst:.1f} dB")
    result(worst >= CONSTANT, f"{name}: constant colours")


# ---- textures and maps ----

def write_image(path, texels):
    texels = np.clip(np.rint(texels), 0, 255).astype(np.uint8)
    out = oiio.ImageOutput.create(path)
    out.open(path, oiio.ImageSpec(texels.shape[1], texels.shape[0], texels.shape[2], "uint8"))
    out.write_image(np.ascontiguousarray(texels))
    out.close()


def raw(path):
    return oiio.ImageBuf(path).get_pixels(oiio.FLOAT).astype(float)


def make_images():
    """Waves, of which the last is clear in places; maps of one texel, and of many."""
    y, x = np.mgrid[0:48, 0:64] / 64 * 2 * np.pi
    y *= 4 / 3
    write_image("waves.png", np.dstack([127 + 120 * np.sin(x), 127 + 120 * np.cos(2 * x), 127 + 120 * np.sin(y)]))
    write_image("clear.png", np.dstack([127 + 120 * np.sin(x), 200 + 0 * x, 90 + 0 * x, 127 + 120 * np.cos(y)]))
    write_image("grey.png", np.full((1, 1, 3), 102))
    write_image("colours.png", np.array([[[51, 102, 51]]]))
    write_image("grey-waves.png", np.dstack([127 + 120 * np.sin(x)] * 3))
    write_image("normal.png", np.array([[[150, 120, 240]]]))
    write_image("normal-waves.png", np.dstack([128 + 50 * np.sin(x), 128 + 50 * np.cos(y), 230 + 0 * x]))


def grey(rgb, target):
    """retex-edit(5): from the first finish at black to the last at white."""
    count = len(target["finishes"])
    return np.maximum(1 - abs(rgb[:, :, :1] * (count - 1) - np.arange(count)), 0)


def colours(rgb, target):
    others = rgb[:, :, :len(target["finishes"]) - 1]
    return np.dstack([1 - others.sum(axis=2), others])


def normals(rgb, target):
    vector = 2 * rgb - 1
    vector[abs(vector) < 1.5 / 255] = 0
    x, y, z = np.moveaxis(vector / np.linalg.norm(vector, axis=2, keepdims=True), 2, 0)
    tilt = np.radians(target["normal_tilt"])
    return np.dstack([z - (x + y) / np.tan(tilt), x / np.sin(tilt), y / np.sin(tilt)])


def check_texture(name, image, bound, weights=None, map_name=None, stream_bound=CONSTANT):
    """Of the floor, by the reader's own filter to a bound, and in a stream of retex-sample to that of constants."""
    path = file_of(name)
    options = ["--texture", f"Floor={image}"]
    color = read_set.read_image(image) if image.endswith(".png") else np.array([[[0.8, 0.3, 0.1, 1.0]]])
    texture = {"color": color}
    if weights:
        target = next(t for t in read_set.read_file(path)[0]["targets"] if t["name"] == "Floor")
        texture = read_set.with_map(color, weights(raw(map_name), target))
        options[0] += f":{'normal' if weights is normals else 'finish'}={map_name}" + ",gl" * (weights is normals)
    expected = combined(path, options)
    own = decibels(read_set.Picture(path, {"Floor": texture}).make(), expected)
    with open("stream.exr", "wb") as stream:
        run("retex-sample", "-q", path, *options, "-o", "-", to=stream)
    streamed = decibels(read_set.Picture("stream.exr").make(), expected)
    what = f"{name}, {image}" + (f" with {map_name}" if weights else "")
    print(f"# {what} | {own:.1f} dB, as a stream {streamed:.1f} dB")
    result(own >= bound, f"{what}: at least {bound} dB")
    result(streamed >= stream_bound, f"{what}: samples of a stream")


def check_samples(name, bound):
    """Samples of sharp footprints, which the tools filter almost exactly."""
    path = file_of(name)
    with open("stream.exr", "wb") as stream:
        run("retex-sample", "-q", path, "--texture", "Floor=waves.png", "-o", "-", to=stream)
    samples = read_set.Picture("stream.exr").samples
    own = read_set.Picture(path, {"Floor": {"color": read_set.read_image("waves.png")}})
    worst = {}
    for f, footprint in enumerate(own.footprints):
        if (f, "color") in samples and footprint["kind"] == "sharp":
            covered = own.parts[footprint["uv"]][:, :, 2] > 0
            shape = "parallelograms" if "axes" in footprint else "ellipses"
            close = decibels(own.factor("footprint", f, "color")[covered], samples[f, "color"][covered])
            worst[shape] = min(worst.get(shape, 200), close)
    for shape, close in worst.items():
        print(f"# {name}, waves.png on {shape} | {close:.1f} dB")
        result(close >= bound, f"{name}: samples of {shape}, at least {bound} dB")


def check_refusals():
    """A damaged file, and one that says what the reader does not know."""
    reader = [sys.executable, ROOT + "/docs/read_set.py"]
    content = open(file_of("one target"), "rb").read()
    for name, old, new, message in (
            ("a damaged manifest", b'"role":"indep"', b'"role":"indeq"', "read_set.py: the manifest is damaged"),
            ("another version", b'{"retex":1,', b'{"retex":9,', "read_set.py: unknown version: 9"),
            ("a set from before the release", b'"parameters":', b'"parametres":',
             "read_set.py: unknown version: before the release"),
            ("no set", b"retex\0string", b"retey\0string", "read_set.py: bad.exr is no set")):
        assert content.count(old) >= 1
        with open("bad.exr", "wb") as file:
            file.write(content.replace(old, new, 1))
        done = subprocess.run([*reader, "bad.exr", "bad.pfm"], stderr=subprocess.PIPE, text=True)
        result(done.returncode == 1 and done.stderr.strip() == message and not os.path.exists("bad.pfm"),
               f"{name} is refused")
    role = dict(read_set.KNOWN)
    read_set.KNOWN["role"] = [r for r in role["role"] if r != "indep"]
    try:
        read_set.Picture(file_of("one target")).make()
        result(False, "an unknown role is refused and named")
    except SystemExit as refused:
        result(str(refused) == "read_set.py: unknown role: indep", "an unknown role is refused and named")
    read_set.KNOWN["role"] = role["role"]


def check_command():
    """The program itself, with an edit of each kind."""
    path = file_of("finishes and lamps")
    run(sys.executable, ROOT + "/docs/read_set.py", path, "own.pfm", "Floor=0.8,0.2,0.1", "finish:Floor=polished",
        "light:light1=0.3,0.05,0.025")
    expected = combined(path, ["--texture", "Floor=rgb(0.8,0.2,0.1)", "--finish", "Floor=polished",
                               "--light", "light1=0.5"])
    result(decibels(read_pfm("own.pfm"), expected) >= CONSTANT, "the command makes the picture")


make_images()
words = os.environ.get("READ_SET", "").split()
read_set.POINTS = 1  # of a constant colour
read_file = read_set.read_file
read_set.read_file = functools.lru_cache(1)(read_file)  # sets that stay as they are
for kind in SETS:
    if not words or any(word in kind for word in words):
        check_colors(kind)
read_set.read_file = read_file
if not words:
    COLOR = "rgb(0.8,0.3,0.1)"
    check_texture("finishes", COLOR, CONSTANT, grey, "grey.png")
    check_texture("finishes and lamps", COLOR, CONSTANT, grey, "grey.png")
    check_texture("packed, finishes and lamps", COLOR, CONSTANT, grey, "grey.png")
    check_texture("normals and lamps", COLOR, CONSTANT, normals, "normal.png")
    read_set.POINTS = 12
    check_texture("finishes", COLOR, 75, grey, "grey-waves.png")
    check_texture("normals and lamps", "waves.png", 45, normals, "normal-waves.png")
    check_texture("one target", "waves.png", 55)
    check_texture("one target", "clear.png", 55)
    check_texture("Gaussian filter", "waves.png", 55)
    check_texture("layout paper", "waves.png", 55)
    check_texture("several targets", "waves.png", 55)
    check_texture("one sample a pixel", "waves.png", 70)
    check_samples("one target", 68)
    check_samples("one sample a pixel", 90)
    check_refusals()
    check_command()
print(f"1..{number}")
