"""same_pictures.py OLD NEW: whether the programs of two builds make the same pictures, to the bit.

OLD and NEW are folders of programs, such as build/bin and that of another clone. OLD renders small sets of every kind,
then both make of each what a set is good for: pictures, parts and errors of them, samples in files and pipes, tables,
solutions. Prints each command whose status or output differs, and their number. For changes that are to change no
picture; it takes some minutes. Files of samples may differ in format: each program reads its own."""
import concurrent.futures
import json
import os
import random
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

ROOM = os.path.abspath(os.path.dirname(__file__) + "/../data/version-1/room.pov")
SCENES = os.path.abspath(os.path.dirname(__file__) + "/../../scenes")
OPTIONS = "--size 48x36 --spp 4 --max-depth 6 -q "
SETS = {
    "room": "-t Floor -t Wall", "one": "-t Floor", "paper": "--layout paper -t Floor -t Wall",
    "lamps": "--lamps each -t Floor -t Wall", "finishes": "--finish Floor=original,polished -t Floor -t Wall",
    "both": "--lamps each --finish Floor=original,polished,matt -t Floor -t Wall",
    "normals": "--lamps each --finish Wall=normals -t Floor -t Wall",
    "large": "--size 200x150 --spp 2 --lamps each -t Floor -t Wall", "plain": "--plain",
}
UNUSED = ("samples.exr", "more.exr", "table.csv")  # what is made on the way


def run(programs, command, folder):
    """The status and the errors of a command line, with these programs in front of others."""
    done = subprocess.run(["bash", "-o", "pipefail", "-c", command], cwd=folder, capture_output=True, check=False,
                          env=dict(os.environ, PATH=programs + ":" + os.environ["PATH"]))
    return done.returncode, done.stderr.decode("utf-8", "replace")


def write_png(path, width, height, channels, values):
    """Bytes as PNG of one, three or four channels."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    line = width * channels
    rows = b"".join(b"\0" + bytes(values[y * line:(y + 1) * line]) for y in range(height))
    head = struct.pack(">IIBBBBB", width, height, 8, {1: 0, 3: 2, 4: 6}[channels], 0, 0, 0)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) +
                   chunk(b"IEND", b""))


def write_textures(folder):
    """An image, one with alpha, a map of finishes and one of normals."""
    draw = random.Random(1).randrange
    write_png(f"{folder}/image.png", 64, 48, 3, [draw(256) for _ in range(64 * 48 * 3)])
    write_png(f"{folder}/clear.png", 64, 48, 4, [draw(256) for _ in range(64 * 48 * 4)])
    write_png(f"{folder}/map.png", 32, 32, 1, [draw(3) * 127 for _ in range(32 * 32)])
    write_png(f"{folder}/normals.png", 32, 32, 3,
              [value for _ in range(32 * 32) for value in (98 + draw(60), 98 + draw(60), 240)])


def targets_of(old, scene):
    """The names of up to two targets that a scene could have."""
    done = subprocess.run([old + "/retex-render", "--size", "32x24", "--list-targets", scene], capture_output=True,
                          text=True, check=False)
    names = [line.split("%  ", 1)[1].split("  ")[0] for line in done.stdout.splitlines() if "%  " in line]
    return [name for name in names if name.replace("_", "a").isalnum()][:2]


def make_sets(old, folder):
    """Render, pack and denoise; the names of the files."""
    lines = {name: f"{OPTIONS}{options} {ROOM}" for name, options in SETS.items()}
    for scene in sorted(os.listdir(SCENES)):
        path = f"{SCENES}/{scene}/{scene}.pov"
        if os.path.exists(path) and targets_of(old, path):
            lines[scene] = OPTIONS + " ".join("-t " + name for name in targets_of(old, path)) + " " + path

    def make(name):
        made = []
        for file, command in ((f"{name}.exr", f"retex-render {lines[name]} -o {name}.exr"),
                              (f"{name}.retex", f"retex-pack -q {name}.exr -o {name}.retex"),
                              (f"{name}-exact.retex", f"retex-pack -q --lossless {name}.exr -o {name}-exact.retex"),
                              (f"{name}-denoised.exr", f"retex-denoise -q {name}.exr -o {name}-denoised.exr")):
            if run(old, command, folder)[0] == 0:
                made.append(file)
        return made

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return [file for files in pool.map(make, lines) for file in files]


def commands(of, textures):
    """Command lines with SET for the name of a set that says this of itself."""
    image, clear = f"{textures}/image.png", f"{textures}/clear.png"
    names = [target["name"] for target in of["targets"]]
    yield from ("retex-combine -q SET -o o.exr", "retex-combine -q SET --crop 5,7,20,9 -o o.exr",
                "retex-combine -q SET --size 20x -o o.exr")
    for name in names[:1]:
        new, sampled = f"--texture '{name}={image}'", f"--texture '{name}={clear}'"
        yield from (f"retex-combine -q SET {new} -o o.exr", f"retex-combine -q SET {sampled} --error e.exr -o o.exr",
                    f"retex-combine -q SET {new} --cross 0 -o o.exr", f"retex-combine -q SET {new} --cross 2 -o o.exr",
                    f"retex-sample -q SET {sampled} -o samples.exr && retex-combine -q SET samples.exr -o o.exr",
                    f"retex-sample -q SET {sampled} | retex-combine -q - --crop 3,3,20,20 -o o.exr",
                    f"retex-sample -q SET --refer {sampled} -o samples.exr && retex-combine -q samples.exr -o o.exr",
                    f"retex-sample -q SET {sampled} -o samples.exr && retex-combine -q SET samples.exr {new} -o o.exr",
                    f"printf 'output,{name}\\no.exr,{image}\\np.exr,tan\\n' >table.csv && "
                    "retex-combine -q SET --batch table.csv",
                    f"retex-combine -q SET --solve '#a08060' --region 10,10,8,8 --free '{name}' >solution")
    if names[1:]:
        one, other = f"--texture '{names[0]}={image}'", f"--texture '{names[1]}={clear}'"
        yield from (f"retex-combine -q SET {one} {other} -o o.exr",
                    f"retex-sample -q SET {one} | retex-sample -q - {other} | retex-combine -q - -o o.exr",
                    f"retex-sample -q SET {one} -o samples.exr && retex-combine -q SET samples.exr {other} -o o.exr",
                    f"retex-sample -q SET --refer {one} -o more.exr && retex-sample -q more.exr --refer {other} "
                    "-o samples.exr && retex-combine -q samples.exr -o o.exr")
    if any(parameter["kind"] == "color" for parameter in of["parameters"]):
        yield "retex-combine -q SET --light '*=2*2700K' -o o.exr"
    for target in of["targets"]:
        what = f"'{target['name']}={image}'"
        options = f"--texture:normal={textures}/normals.png" if "normal_tilt" in target else \
            f"--texture:finish={textures}/map.png" if "finishes" in target else None
        if options:
            yield from (f"retex-combine -q SET {options} {what} -o o.exr",
                        f"retex-sample -q SET {options} {what} | retex-combine -q - -o o.exr")


def compare(old, new, path, command):
    """None, or how the programs differ."""
    results = []
    for programs in (old, new):
        with tempfile.TemporaryDirectory() as folder:
            status, errors = run(programs, command.replace("SET", path), folder)
            files = {}
            for name in set(os.listdir(folder)) - set(UNUSED):
                with open(f"{folder}/{name}", "rb") as file:
                    files[name] = file.read()
            results.append((status, files, errors))
    if results[0][:2] == results[1][:2]:
        return None
    return f"{command.replace('SET', path)}: status {results[0][0]} and {results[1][0]}\n" + \
        "".join("  " + result[2] for result in results)


def main(old, new):
    """Exit with 1 where any picture differs."""
    folder = tempfile.mkdtemp()
    try:
        write_textures(folder)
        jobs = []
        for file in make_sets(old, folder):
            said = subprocess.run([old + "/retex-info", "--json", file], cwd=folder, capture_output=True, check=False)
            if said.returncode == 0:  # a picture without a set is none
                jobs += [(f"{folder}/{file}", command) for command in commands(json.loads(said.stdout), folder)]
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            told = [line for line in pool.map(lambda job: compare(old, new, *job), jobs) if line]
    finally:
        shutil.rmtree(folder)
    print(*told, f"{len(jobs)} commands, {len(told)} differ", sep="\n")
    return 1 if told or not jobs else 0


sys.exit(main(*(os.path.abspath(path) for path in sys.argv[1:])))
