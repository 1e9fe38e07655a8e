"""listings.py RENDER COUNT SEED SCENE...: what retex-render RENDER lists of scenes, with all combinations of -t, -l,
--finish, --camera and --crop, or COUNT of them drawn by SEED. Used by cli/listings and long/listings.

Names come from the listings themselves. Targets and finishes change no list, and lamps only that of lamps: a list must
be what it is without them, to the byte. Else the run is refused by one line and status 2. No run ends by a signal, hangs,
or is reported by a sanitizer. Prints TAP, one line a scene."""
import itertools
import os
import random
import subprocess
import sys
import tempfile

LISTINGS = (["--list-targets"], ["-v", "--list-targets"], ["--list-targets=sheet.png"], ["--list-lamps"],
            ["--list-finishes"], ["--list-cameras"])
SIZE = ["--size", "32x24", "--threads", "1", "--max-time", "60", "-q"]
SECONDS = 120


def run(render, scene, arguments, folder):
    done = subprocess.run([render, *SIZE, *arguments, scene], cwd=folder, capture_output=True, timeout=SECONDS)
    return done.returncode, done.stdout, done.stderr.decode("utf-8", "replace")


def names(render, scene, listing, folder):
    """What stands after the share, as -t and -l take it."""
    status, out, _ = run(render, scene, [listing], folder)
    lines = out.decode("utf-8", "replace").splitlines() if status == 0 else []
    return [line.split("%  ", 1)[1].split("  ")[0] for line in lines if "all other light" not in line]


def repeated(option, values):
    return [word for value in values for word in (option, value)]


def rows(render, scene, folder):
    """For each option what it may be; [] is: not given."""
    targets, lamps = names(render, scene, "--list-targets", folder), names(render, scene, "--list-lamps", folder)
    plain = [t for t in targets if t.replace("_", "a").isalnum()]
    first, two, last = plain[:1], plain[:2], plain[-1:]
    of_targets = [[], repeated("-t", first), repeated("-t", two), repeated("-t", last[:1] + first[:1] if two[1:] else []),
                  repeated("-t", plain[:16]), ["-t", "Seen=@16:12/object", "-t", "Side=@3:20/flat", "-t", "Else=#1"]]
    of_lamps = [[], ["--lamps", "each"], repeated("-l", lamps[:1]), repeated("-l", lamps[:15]),
                ["-l", "Air=sky", *repeated("-l", lamps[:2])], ["--light", f"{lamps[0].split('=')[0]}=.5"] if lamps else []]
    of_finishes = [[]] + [["--finish", f"{t}={f}"] for t in first for f in ("matt,metal", "normals")]
    of_finishes += [["--finish", f"{two[0]}=original,polished", "--finish", f"{two[1]}=satin,metal", "--show",
                     f"{two[1]}=metal"]] if two[1:] else []
    unique = lambda options: [list(o) for o in dict.fromkeys(tuple(o) for o in options)]
    return (list(LISTINGS), unique(of_targets), unique(of_lamps), unique(of_finishes),
            [[], ["--camera", "1,2,-5:0,.5,0:50"]], [[], ["--crop", "5,7,20,9"]])


def wrong(render, scene, folder, combination, known):
    """None, 'refused', or what is wrong with the run."""
    listing, targets, lamps, finishes, camera, crop = combination
    status, out, err = run(render, scene, [w for words in combination for w in words], folder)
    if "Sanitizer" in err or "runtime error" in err or status not in (0, 2):
        return f"status {status}: {err[:2000]}"
    if status == 2:
        errors = [line for line in err.splitlines() if ": error: " in line]
        return "refused" if len(errors) == 1 else f"{len(errors)} lines of error: {err[:500]}"
    plain = [*listing, *(lamps if "--list-lamps" in listing else []), *camera, *crop]
    if tuple(plain) not in known:
        known[tuple(plain)] = run(render, scene, plain, folder)
    if known[tuple(plain)][:2] != (0, out):
        return f"prints\n{out.decode()}and without targets and finishes\n{known[tuple(plain)][1].decode()}"
    return None


def check_scene(render, scene, count, seed):
    failures, refused = [], 0
    with tempfile.TemporaryDirectory() as folder:
        status, _, err = run(render, scene, ["--list-targets"], folder)
        if status == 2:
            return 0, 0, []  # a scene that cannot be read, as some are made to be
        all_of_them = list(itertools.product(*rows(render, scene, folder)))
        if count:
            all_of_them = random.Random(f"{seed} {os.path.basename(scene)}").sample(all_of_them,
                                                                                  min(count, len(all_of_them)))
        known = {}
        for combination in all_of_them:
            told = wrong(render, scene, folder, combination, known)
            refused += told == "refused"
            if told and told != "refused":
                failures.append((" ".join(w for words in combination for w in words), told))
    return len(all_of_them), refused, failures


def main(render, count, seed, *scenes):
    for number, scene in enumerate(scenes, 1):
        runs, refused, failures = check_scene(os.path.abspath(render), os.path.abspath(scene), int(count), seed)
        print(f"# {scene}: {runs} runs, {refused} refused, {len(failures)} wrong")
        for arguments, told in failures[:5]:
            print(f"# retex-render {' '.join(SIZE)} {arguments} {scene}:", *told.splitlines(), sep="\n#   ")
        print("not " if failures else "", f"ok {number} - {os.path.basename(scene)}", sep="", flush=True)
    print(f"1..{len(scenes)}")


main(*sys.argv[1:])
