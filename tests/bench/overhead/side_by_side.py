"""What a set costs over the plain picture, where the machine's speed moves more than that: make bench-overhead-pairs.

The plain picture and the set are rendered at the same time, with one thread and one core each, and once more with the
cores swapped: whatever else slows the machine slows both. A round's overhead is the geometric mean of the two ratios of
processor time, of whole processes that write to the disk. Prints a page, which is also $BUILD/bench/overhead-pairs.md;
with BENCH_DOCS=1 it goes to docs/ too.

About a quarter of an hour on two cores. BENCH_ROUNDS (4), BENCH_SIZE (256x144), BENCH_SPP (128), BENCH_LAYOUTS
(footprints) and BENCH_SCENES ('living-room artist') choose otherwise.
"""
import os
import shutil
import statistics
import sys

BUILD = os.path.abspath(os.environ.get("BUILD", "build"))
ROUNDS = int(os.environ.get("BENCH_ROUNDS", 4))
SIZE, SPP = os.environ.get("BENCH_SIZE", "256x144"), os.environ.get("BENCH_SPP", "128")
LAYOUTS = os.environ.get("BENCH_LAYOUTS", "footprints").split()
SHARED = os.environ.get("RETEX_SHARED", "../shared")
SCENES = {
    "living-room": ("scenes/living-room/living-room.pov", ["Floor", "Wall"]),
    "artist": (f"{SHARED}/scenes/living-room-bitterli/scene.pov", ["Floor", "Painting"]),
}
WORK = f"{BUILD}/bench/overhead-pairs"


def start(core, scene, options):
    """A render on a core of its own."""
    process = os.fork()
    if process:
        return process
    os.sched_setaffinity(0, {core})
    out = f"{WORK}/{core}.exr"
    os.execv(f"{BUILD}/bin/retex-render", ["retex-render", "-q", "--threads", "1", "--size", SIZE, "--spp", SPP,
                                           *options, scene, "-o", out])


def seconds_of_both(cores, scene, plain, other):
    """Processor time of two renders side by side."""
    processes = [start(core, scene, options) for core, options in zip(cores, (plain, other))]
    seconds = {}
    while len(seconds) < 2:
        process, status, used = os.wait3(0)
        if status:
            sys.exit(f"bench-overhead-pairs: a render of {scene} failed")
        seconds[process] = used.ru_utime + used.ru_stime
    return [seconds[process] for process in processes]


def overheads(cores, scene, options):
    """In percent, of each round; and the plain picture's seconds."""
    found, plain = [], []
    for number in range(ROUNDS):
        product = 1
        for turn in range(2):
            a, b = seconds_of_both(cores[::-1] if turn else cores, scene, ["--plain"], options)
            product *= b / a
            plain.append(a)
        found.append(100 * (product**0.5 - 1))
        print(f"{scene} {' '.join(options)} round {number + 1}: {found[-1]:+.1f} %", file=sys.stderr)
    return found, plain


def main():
    cores = sorted(os.sched_getaffinity(0))[:2]
    if len(cores) < 2:
        sys.exit("bench-overhead-pairs: two cores are needed")
    os.makedirs(WORK, exist_ok=True)
    page = [
        "# What a set costs, side by side", "",
        "Processor time of a render that leaves a set over that of the plain picture, both at the same time with one",
        f"thread and one core each, and once more with the cores swapped. Pictures of {SIZE} with {SPP} samples a",
        f"pixel, whole processes, denoising data and writing included; {ROUNDS} rounds. `make bench-overhead-pairs` made",
        "this page: on a machine whose speed moves it tells small differences, which",
        "[runs in turn](overhead.md) do not.", "",
        "| scene | targets | layout | median | least | most | plain, s |", "|---|---|---|---|---|---|---|"
    ]
    for name in os.environ.get("BENCH_SCENES", "living-room artist").split():
        scene, targets = SCENES[name]
        if not os.path.exists(scene):
            print(f"bench-overhead-pairs: no {scene}: {name} is left out", file=sys.stderr)
            continue
        for chosen in (targets[:1], targets[1:], targets):
            for layout in LAYOUTS:
                options = ["--layout", layout] + [word for target in chosen for word in ("-t", target)]
                found, plain = overheads(cores, scene, options)
                page.append(f"| {name} | {' and '.join(chosen)} | `{layout}` | {statistics.median(found):+.1f} % | "
                            f"{min(found):+.1f} % | {max(found):+.1f} % | {statistics.median(plain):.1f} |")
    text = "\n".join(page) + "\n"
    with open(f"{BUILD}/bench/overhead-pairs.md", "w", encoding="ascii") as file:
        file.write(text)
    print(text, end="")
    shutil.rmtree(WORK)
    if os.environ.get("BENCH_DOCS") == "1":
        shutil.copy(f"{BUILD}/bench/overhead-pairs.md", "docs/")


main()
