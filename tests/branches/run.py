#!/usr/bin/env python3
"""Mutation of compiled branches: one instruction of a file's code is another one, and a test must notice.

    run.py AREA…    COUNT=60 mutants of each area, drawn by SEED=1; `all` is all areas

An area is a room of the renderer, the library or the tools; `player` is tools/web, whose mutants are of operators in
the source. SUITES='unit cli golden' are run, or single tests such as cli/lamps, those whose coverage reaches the line, until one fails; they may
take MUTANT_SECONDS=120 for one mutant. What was found is kept in
$BUILD/branches/results and not done again while the code and the tests are the same. Survivors that make no difference
are in equivalent.txt. Prints each survivor and a table. See tests/README.md."""

import glob
import os
import platform
import resource
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
sys.dont_write_bytecode = True
import compiled  # noqa: E402
import coverage  # noqa: E402
import linked  # noqa: E402
import player  # noqa: E402

AREAS = ("film", "retexture", "path", "light", "shade", "texture", "denoise", "compact", "set", "combine", "exr",
         "medium", "import", "web", "serve", "player")
WORK = os.path.join(os.environ.get("BUILD", "build"), "branches")
MEMORY = 16 << 30  # of a test, so that a mutant that allocates for ever ends


def files_of(area):
    """The C files of an area."""
    for root in ("renderer", "tools/libretex", "tools"):
        folder = f"{root}/{area}"
        if os.path.isdir(folder) and glob.glob(f"{folder}/**/*.c", recursive=True):
            return sorted(glob.glob(f"{folder}/**/*.c", recursive=True))
    sys.exit(f"there is no area {area}")


def read_equivalent():
    """{(file, function, line's text, change): reason}."""
    found, key = {}, None
    with open(os.path.join(HERE, "equivalent.txt"), encoding="utf-8") as file:
        for number, line in enumerate(file, 1):
            kind, text = line[:1], line[2:].rstrip("\n")
            if not line.strip() or kind == "#":
                continue
            if kind == "@":
                path, function, *what = text.split()
                key = [path, function, " ".join(what)]
            elif kind == "-":
                key.append(text)
            elif kind == "~" and len(key) == 4:
                found[key[0], key[1], key[3], key[2]] = text
            else:
                sys.exit(f"equivalent.txt:{number}: @ FILE FUNCTION CHANGE, - the line's text, ~ the reason")
    return found


class Results:
    """What each test said of each mutant, by digests of the code and of the test; a file that grows."""

    def __init__(self, path):
        self.path, self.known, self.deaths = path, {}, {}
        if os.path.exists(path):
            with open(path, encoding="utf-8") as file:
                for line in file:
                    mutant, code, test, of_test, outcome = line.rstrip("\n").rsplit("|", 4)
                    self.keep(mutant, code, test, of_test, outcome)

    def keep(self, mutant, code, test, of_test, outcome):
        """In memory."""
        self.known[mutant, code, test, of_test] = outcome
        if outcome == "died":
            self.deaths.setdefault((mutant, code), []).append((test, of_test))

    def killer(self, mutant, code):
        """A test that noticed a mutant, and is as it was then."""
        deaths = self.deaths.get((mutant, code), [])
        return next((test for test, of_test in deaths if coverage.digest(coverage.file_of(test)) == of_test), None)

    def get(self, *key):
        """`died`, `passed` or None."""
        return self.known.get(key)

    def put(self, *key, outcome):
        """Keep what was found."""
        self.keep(*key, outcome)
        with open(self.path, "a", encoding="utf-8") as file:
            file.write("|".join(key) + f"|{outcome}\n")


class Compiled:
    """Mutants of compiled code, in the programs of a build."""

    def __init__(self, suites, programs, reached):
        self.suites, self.programs, self.coverage = suites, programs, reached
        self.codes = {}

    def mutants(self, area):
        """All mutants of an area."""
        found, files = [], files_of(area)
        self.coverage.measure(self.suites, lambda test: self.may_reach(test, files))
        for path in files:
            with open(f"{WORK}/plain/obj/{path[:-2]}.s", encoding="utf-8") as file:
                assembly = file.read().splitlines()
            self.codes[path] = compiled.Code(self.object(path), assembly, WORK)
            found += compiled.mutants_of(path, assembly)
        return found

    def may_reach(self, test, files):
        """Whether a unit test has code of a file at all; what others run is not known."""
        return not test.startswith("unit/") or \
            any(self.programs.place(f"tests/{test}", self.object(path)) is not None for path in files)

    def object(self, path):
        """What is built from a file."""
        return f"{WORK}/plain/obj/{path[:-2]}.o"

    def prepare(self, mutant):
        """The bytes of a mutant, or None where there can be none."""
        return self.codes[mutant.path].mutate(mutant)

    def digest(self, mutant):
        """Of the code that is changed."""
        return self.codes[mutant.path].digest

    def tests(self, mutant):
        """Tests that reach a mutant, unit tests first, the shortest of a suite first, as many as their time allows."""
        left, found = float(os.environ.get("MUTANT_SECONDS") or 120), []
        for test in self.coverage.reaching(mutant.path, mutant.line, self.suites):
            left -= self.coverage.seconds(test)
            if left > 0:
                found.append(test)
        return found

    def run(self, test, mutant=None, change=None):
        """Whether a test passes, with a mutant or without; taking much longer than it should is failing."""
        limit = int(15 + 5 * self.coverage.seconds(test))
        if not mutant:
            return coverage.run_test(f"{WORK}/plain", test, limit)[0]
        names = [f"tests/{test}"] if test.startswith("unit/") else self.programs.all()
        try:
            there = [self.programs.change(name, self.object(mutant.path), change) for name in names]
            level = {"RETEX_CPU": mutant.level} if mutant.level else {}
            return not any(there) or coverage.run_test(f"{WORK}/tree", test, limit, **level)[0]
        finally:
            self.programs.restore()


class Judge:
    """Runs tests on the mutants of an area, and keeps what they say."""

    def __init__(self, subject):
        self.subject, self.sound = subject, {}
        self.results = Results(f"{WORK}/results")

    def draw(self, area, count, seed):
        """(mutant, its change) of `count` that can be."""
        found = []
        for mutant in compiled.draw(self.subject.mutants(area), 2 * count, seed):
            change = self.subject.prepare(mutant)
            if change:
                found.append((mutant, change))
            if len(found) == count:
                break
        return found

    def is_sound(self, test):
        """Whether a test passes without a mutant."""
        if test not in self.sound:
            self.sound[test] = self.subject.run(test)
            if not self.sound[test]:
                print(f"# {test} fails without a mutant", flush=True)
        return self.sound[test]

    def notices(self, mutant, change, test):
        """Whether a test notices a mutant, as kept or as it is run."""
        key = (mutant.name, self.subject.digest(mutant), test, coverage.digest(coverage.file_of(test)))
        outcome = self.results.get(*key)
        if not outcome:
            passes = self.subject.run(test, mutant, change)
            outcome = "passed" if passes or not self.is_sound(test) else "died"
            self.results.put(*key, outcome=outcome)
        return outcome == "died"

    def judge(self, mutant, change):
        """The test that noticed a mutant or None, and how many tests reach it."""
        killer = self.results.killer(mutant.name, self.subject.digest(mutant))
        if killer:
            return killer, 0
        tests = self.subject.tests(mutant)
        return next((test for test in tests if self.notices(mutant, change, test)), None), len(tests)


def tell_survivor(mutant, tests):
    """A survivor, as equivalent.txt would have it."""
    print(f"# {mutant.path}:{mutant.line}: {mutant.old} -> {mutant.kind}: {tests} tests pass")
    print(f"@ {mutant.path} {mutant.function} {mutant.what}\n- {mutant.text}\n", flush=True)


def table(judge, area, equivalent):
    """One area: judges its mutants, prints its survivors, returns its row."""
    count, seed = int(os.environ.get("COUNT") or 60), os.environ.get("SEED") or "1"
    row = {"area": area, "mutants": 0, "unit": 0, "others": 0, "equivalent": 0, "survived": 0}
    with open(f"{WORK}/{area}.txt", "w", encoding="utf-8") as kept:
        for mutant, change in judge.draw(area, count, seed):
            test, tests = judge.judge(mutant, change)
            reason = equivalent.get((mutant.path, mutant.function, mutant.text, mutant.what))
            outcome = ("unit" if test.startswith(("unit/", "web/")) else "others") if test else \
                "equivalent" if reason else "survived"
            row["mutants"] += 1
            row[outcome] += 1
            if outcome == "survived":
                tell_survivor(mutant, tests)
            kept.write("\t".join((f"{mutant.path}:{mutant.line}", mutant.function, mutant.what, mutant.old,
                                  test or outcome, mutant.text)) + "\n")
            kept.flush()
    return row


def main():
    if platform.machine() != "x86_64":
        print("mutation of compiled branches knows the instructions of x86-64 only; skipped")
        return 0
    areas = list(AREAS) if sys.argv[1:] in ([], ["all"]) else sys.argv[1:]
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    suites = (os.environ.get("SUITES") or "unit cli golden").split()
    judge = Judge(Compiled(suites, linked.Programs(f"{WORK}/plain", f"{WORK}/tree"),
                           coverage.Coverage(f"{WORK}/covered", f"{WORK}/coverage")))
    equivalent, rows = read_equivalent(), []
    for area in areas:
        rows.append(table(Judge(player.Player(WORK)) if area == "player" else judge, area, equivalent))
        print(" ".join(f"{key} {value}" for key, value in rows[-1].items()), flush=True)
    print("\n| area | mutants | died in unit tests | in others | equivalent | survived |\n|---|---|---|---|---|---|")
    for row in rows:
        print("| " + " | ".join(str(value) for value in row.values()) + " |")
    return 1 if any(row["survived"] for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
