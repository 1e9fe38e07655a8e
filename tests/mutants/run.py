#!/usr/bin/env python3
"""Mutation testing: each small wrongness of list.txt is built, and a test must notice. Prints TAP.

A mutant that no named test notices fails, and so does one that does not compile or whose text is not in its file once.
MUTANTS chooses: `all`; `tenth`, the default, those whose turn it is on the day of the last commit, so that ten days see
all; `changed`, those of files that differ from the commit MUTANTS_BASE, and then the tenth; or names. A test counts only
if it passes without a mutant, which is tried once a test; with `tenth` and `changed` it is taken as known from `make
check-full`. Trees with builds of their own lie in $BUILD/mutants, JOBS of them side by side.
MUTANT_MINUTES=N begins no mutant after that time: the rest is skipped, in another order each day.
$BUILD/mutants/results keeps what was found, so that a run that was stopped goes on; it counts as long as the sources are
the same.

run.py --lint checks the list alone, and prints what is wrong with it."""

import concurrent.futures
import hashlib
import os
import queue
import shutil
import signal
import subprocess
import sys
import threading
import time

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
BUILD = os.path.join(ROOT, os.environ.get("BUILD", "build"))
SECONDS = 900  # for one test; a mutant that hangs is noticed


class Mutant:
    """One block of list.txt."""

    def __init__(self, name, path):
        self.name, self.path = name, path
        self.old, self.new, self.tests, self.equivalent = "", "", [], ""


def read_list():
    """Blocks: `@ NAME FILE`, `- text` once in that file, `+ what takes its place`, then `= TEST…`, cheapest first, or
    `~ why it changes nothing`. Several lines of a kind are joined by newlines."""
    mutants = []
    with open(os.path.join(HERE, "list.txt"), encoding="utf-8") as lines:
        for number, line in enumerate(lines, 1):
            kind, text = line[:1], line[2:].rstrip("\n")
            if not line.strip() or kind == "#":
                continue
            if kind == "@":
                mutants.append(Mutant(*text.split()))
            elif kind == "-":
                mutants[-1].old += ("\n" if mutants[-1].old else "") + text
            elif kind == "+":
                mutants[-1].new += ("\n" if mutants[-1].new else "") + text
            elif kind == "=":
                mutants[-1].tests += text.split()
            elif kind == "~":
                mutants[-1].equivalent += text
            else:
                sys.exit(f"list.txt:{number}: a line begins with @ - + = ~ or #")
    return mutants


def test_file(test):
    """Where a test is, or the folder of a suite."""
    suite, _, name = test.partition("/")
    if test == "faults/calls":
        return os.path.join("tests", "faults", "faults.sh")
    ending = {"unit": ".c", "cli": ".t", "oiio": ".t", "golden": "/command", "fidelity": ".sh", "docs": ".sh",
              "long": ".sh", "python": ".py", "web": ".mjs"}
    if suite not in ending:
        return None
    name = f"test_{name}" if suite in ("python", "web") and name else name
    if suite == "web" and os.path.exists(os.path.join(ROOT, "tests", "web", f"{name}.sh")):
        return os.path.join("tests", "web", f"{name}.sh")
    return os.path.join("tests", suite, name + ending[suite]) if name else os.path.join("tests", suite)


def mistakes(mutants):
    """Whatever is wrong with the list, as it can be seen without building."""
    names = set()
    for mutant in mutants:
        if mutant.name in names:
            yield f"{mutant.name}: there are two"
        names.add(mutant.name)
        try:
            with open(os.path.join(ROOT, mutant.path), encoding="utf-8") as file:
                count = file.read().count(mutant.old) if mutant.old else 0
        except OSError:
            yield f"{mutant.name}: there is no {mutant.path}"
            continue
        if count != 1:
            yield f"{mutant.name}: its text is {count} times in {mutant.path}"
        if mutant.old == mutant.new:
            yield f"{mutant.name}: changes nothing"
        if bool(mutant.tests) == bool(mutant.equivalent):
            yield f"{mutant.name}: either tests or a reason why nothing can notice"
        for test in mutant.tests:
            file = test_file(test)
            if not file or not os.path.exists(os.path.join(ROOT, file)):
                yield f"{mutant.name}: there is no test {test}"


def run(tree, *command):
    """Exit status and output; a status of None where it took too long."""
    with subprocess.Popen(command, cwd=tree, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          stdin=subprocess.DEVNULL, start_new_session=True,
                          env={**os.environ, "BUILD": "build", "JOBS": "1", "CI": ""}) as process:
        try:
            output, _ = process.communicate(timeout=SECONDS)
            return process.returncode, output.decode(errors="replace")
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)  # with all that it has started
            return None, ""


def source_key():
    """Of all files that git knows, as they are."""
    names = subprocess.check_output(["git", "ls-files", "-z"], cwd=ROOT).decode().split("\0")[:-1]
    digest = hashlib.sha256()
    for name in sorted(names):
        if name.endswith(".md") or not os.path.exists(os.path.join(ROOT, name)):
            continue
        with open(os.path.join(ROOT, name), "rb") as file:
            digest.update(name.encode() + b"\0" + hashlib.sha256(file.read()).digest())
    return digest.hexdigest(), names


def make_tree(number, names):
    """A copy of the sources and of what is built, times kept, so that make builds what a mutant changes and no more."""
    tree = os.path.join(BUILD, "mutants", f"tree{number}")
    shutil.rmtree(tree, ignore_errors=True)
    for name in names:
        source, copy = os.path.join(ROOT, name), os.path.join(tree, name)
        if os.path.exists(source):
            os.makedirs(os.path.dirname(copy), exist_ok=True)
            shutil.copy2(source, copy)
    for name in ("obj", "gen", "lib", "bin", "plugins", "tests/unit", "tests/bin", "tests/oidn", "tests/libtest.a",
                 "config.mk", "test.mk"):
        source, copy = os.path.join(BUILD, name), os.path.join(tree, "build", name)
        os.makedirs(os.path.dirname(copy), exist_ok=True)
        if os.path.isdir(source):
            shutil.copytree(source, copy, symlinks=True)
        elif os.path.exists(source):
            shutil.copy2(source, copy)
    return tree


def target_of(test):
    """What make has to build for a test."""
    suite, _, name = test.partition("/")
    if suite == "unit" and name:
        return [f"build/tests/unit/{name}"]
    if suite == "faults":
        return ["test-programs", "build/tests/faults/shim.so", "build/tests/faults/faults"]
    return ["tests"] if suite == "unit" else ["test-programs"]


def build(tree, test, built):
    """What kept a test from being built, or None; `built` has what is built already."""
    for target in target_of(test):
        if target not in built:
            built.add(target)
            status, output = run(tree, "make", "JOBS=1", target)
            if status != 0:
                return "does not compile: " + output.strip().split("\n")[-1]
    return None


def passes(tree, test):
    """Whether a test passes in a tree."""
    return run(tree, "tests/lib/check.sh", test)[0] == 0


class Sound:
    """Tests that pass where nothing is wrong, each tried once."""

    def __init__(self):
        self.lock, self.known = threading.Lock(), {}

    def is_sound(self, tree, test):
        with self.lock:
            lock = self.known.setdefault(test, [threading.Lock(), None])
        with lock[0]:
            if lock[1] is None:
                lock[1] = build(tree, test, set()) is None and passes(tree, test)
            return lock[1]


def judge(tree, mutant, sound=None):
    """(passed, what became of it)."""
    for test in mutant.tests:
        if sound and not sound.is_sound(tree, test):
            return False, f"{test} fails without any mutant"
    path = os.path.join(tree, mutant.path)
    with open(path, encoding="utf-8") as file:
        text = file.read()
    if text.count(mutant.old) != 1:
        return False, f"its text is {text.count(mutant.old)} times in {mutant.path}"
    before = os.stat(path)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text.replace(mutant.old, mutant.new))
    try:
        built = set()
        for test in mutant.tests:
            why = build(tree, test, built)
            if why:
                return False, why
            if not passes(tree, test):
                return True, f"noticed by {test}"
        return False, "survives " + " ".join(mutant.tests)
    finally:
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        # newer than the mutant's object, for make
        os.utime(path, (before.st_atime, os.stat(path).st_mtime))


def digest(text):
    return int(hashlib.sha256(text.encode()).hexdigest(), 16)


def changed_files():
    """Those that differ from MUTANTS_BASE; none where git does not know that commit."""
    base = os.environ.get("MUTANTS_BASE") or "HEAD~1"
    told = subprocess.run(["git", "diff", "--name-only", base, "HEAD"], cwd=ROOT, capture_output=True, text=True,
                          check=False)
    return set(told.stdout.split("\n")) - {""}


def choose(mutants):
    """By MUTANTS."""
    wanted = os.environ.get("MUTANTS") or "tenth"
    if wanted == "all":
        return mutants
    if wanted in ("tenth", "changed"):
        seconds = subprocess.check_output(["git", "show", "-s", "--format=%ct", "HEAD"], cwd=ROOT)
        day = int(seconds) // 86400
        able = [m for m in mutants if not any(test.startswith("long/") for test in m.tests)]  # make check-all's programs
        files = changed_files() if wanted == "changed" else set()
        turn = [m for m in able if m.path in files or digest(m.name) % 10 == day % 10]
        return sorted(turn, key=lambda m: (m.path not in files, digest(f"{day} {m.name}")))
    unknown = set(wanted.split()) - {m.name for m in mutants}
    if unknown:
        sys.exit("no such mutant: " + " ".join(sorted(unknown)))
    return [m for m in mutants if m.name in wanted.split()]


def main():
    mutants = read_list()
    if sys.argv[1:] == ["--lint"]:
        found = [f"tests/mutants/list.txt: {mistake}" for mistake in mistakes(mutants)]
        print("\n".join(found), end="\n" if found else "")
        return 1 if found else 0
    chosen = choose(mutants)
    sound = None if os.environ.get("MUTANTS", "tenth") in ("tenth", "changed") else Sound()
    key, names = source_key()
    os.makedirs(os.path.join(BUILD, "mutants"), exist_ok=True)
    results = os.path.join(BUILD, "mutants", "results")
    known = {}
    if os.path.exists(results):
        with open(results, encoding="utf-8") as file:
            for line in file:
                found, name, told = line.rstrip("\n").split("\t")
                if found == key:
                    known[name] = told
    trees = queue.Queue()
    fresh = [m for m in chosen if not m.equivalent and m.name not in known]
    for number in range(min(int(os.environ.get("JOBS") or 2), len(fresh))):
        trees.put(make_tree(number, names))

    minutes = float(os.environ.get("MUTANT_MINUTES") or "inf")
    end = time.monotonic() + 60 * minutes

    def work(mutant):
        if mutant.equivalent:
            return True, "equivalent: " + mutant.equivalent
        if mutant.name in known:
            return True, known[mutant.name]
        if time.monotonic() > end:
            return True, f"# SKIP not begun within {minutes:g} minutes"
        tree = trees.get()
        try:
            passed, told = judge(tree, mutant, sound)
        finally:
            trees.put(tree)
        if passed:
            with open(results, "a", encoding="utf-8") as file:
                file.write(f"{key}\t{mutant.name}\t{told}\n")
        return passed, told

    print(f"1..{max(len(chosen), 1)}", flush=True)
    if not chosen:
        print("ok 1 - it is no mutant's turn")
    with concurrent.futures.ThreadPoolExecutor(max(trees.qsize(), 1)) as pool:
        for number, (mutant, (passed, told)) in enumerate(zip(chosen, pool.map(work, chosen)), 1):
            print(f"{'' if passed else 'not '}ok {number} - {mutant.name} ({mutant.path}): {told}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
