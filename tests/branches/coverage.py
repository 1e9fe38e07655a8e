"""Which lines each test reaches, by gcov: every test runs once in a build that counts lines.

What a test reaches is kept in a file, with digests of the test and of the files that it reaches; it runs again if one
of them is another now."""

import hashlib
import json
import os
import shutil
import subprocess
import time

SUITES = ("unit", "cli", "golden", "python", "web", "oiio", "fidelity")
ENDINGS = {"unit": ".c", "cli": ".t", "oiio": ".t", "golden": "/command", "fidelity": ".sh", "python": ".py",
           "web": ".mjs"}
SECONDS = float(os.environ.get("TEST_SECONDS") or 600)  # a test that takes longer is left out


def digest(path):
    """Of a file, or of nothing."""
    try:
        with open(path, "rb") as file:
            return hashlib.sha256(file.read()).hexdigest()[:16]
    except OSError:
        return ""


def tests_of(suite):
    """The names of a suite's tests; SUITE/NAME is one test."""
    suite, _, only = suite.partition("/")
    found = []
    for name in sorted(os.listdir(f"tests/{suite}")):
        path = f"tests/{suite}/{name}" + ("/command" if suite == "golden" else "")
        if os.path.isfile(path) and path.endswith(ENDINGS[suite]):
            name = os.path.splitext(name)[0]
            if suite in ("python", "web"):
                if not name.startswith("test_"):
                    continue
                name = name[5:]
            if (suite != "unit" or name.startswith("test_")) and only in ("", name):
                found.append(f"{suite}/{name}")
    return found


def file_of(test):
    """Where a test is."""
    suite, name = test.split("/")
    return f"tests/{suite}/{'test_' if suite in ('python', 'web') else ''}{name}{ENDINGS[suite]}"


def use_one_processor():
    """For what counts lines: threads that add to the same counters on several take ten times as long."""
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})


def run_test(build, test, seconds, prepare=None, **more):
    """Whether a test passes in a build, and how long it took; not if it takes longer than `seconds`. `prepare` is called
    in the new process."""
    start = time.monotonic()
    nothing = subprocess.DEVNULL
    status = subprocess.run(
        ["tests/lib/check.sh", test], stdin=nothing, stdout=nothing, stderr=nothing, check=False,
        preexec_fn=prepare, env={**os.environ, "BUILD": build, "JOBS": "1", "CI": "", "JOB_SECONDS": str(int(seconds)),
                                 **more})
    return status.returncode == 0, time.monotonic() - start


def lines_of(counts, build):
    """{file: [line…]} of what has been run, from gcov's counts in a folder that is as the build."""
    found, sources = {}, []
    root = os.getcwd()
    objects = os.path.join(counts, os.path.abspath(build).lstrip("/"), "obj")
    for folder, _, names in os.walk(objects):
        for name in names:
            if name.endswith(".gcda"):
                path = os.path.join(folder, name)
                note = os.path.join(build, "obj", os.path.relpath(path, objects))[:-5] + ".gcno"
                if os.path.relpath(path, objects).startswith("tests/") or not os.path.exists(note):
                    continue
                os.symlink(os.path.join(root, note), path[:-5] + ".gcno")
                sources.append(path)
    for start in range(0, len(sources), 100):
        out = subprocess.run(["gcov", "--json-format", "--stdout", *sources[start:start + 100]], capture_output=True,
                             check=False).stdout
        for text in out.splitlines():
            for file in json.loads(text)["files"] if text.strip() else []:
                path = os.path.normpath(file["file"])
                if path.startswith("/") or path.startswith("build"):
                    continue
                found.setdefault(path, set()).update(line["line_number"] for line in file["lines"] if line["count"])
    return {path: sorted(lines) for path, lines in found.items() if lines}


class Coverage:
    """What each test reaches, as it was found."""

    def __init__(self, build, kept):
        self.build, self.kept = build, kept
        self.tests, self.digests, self.sets = {}, {}, {}
        if os.path.exists(kept):
            with open(kept, encoding="utf-8") as file:
                for line in file:
                    record = json.loads(line)
                    self.tests[record["test"]] = record

    def current(self, path):
        """A file's digest now."""
        if path not in self.digests:
            self.digests[path] = digest(path)
        return self.digests[path]

    def is_known(self, test):
        """Whether the test and all that it reaches are as they were."""
        record = self.tests.get(test)
        return record and record["digest"] == self.current(file_of(test)) and \
            record.get("limit", SECONDS) >= SECONDS and \
            all(self.current(path) == old for path, (old, _) in record["files"].items())

    def measure(self, suites, may_reach):
        """Run the tests that are not known and may reach what is asked for."""
        for suite in suites:
            for test in tests_of(suite):
                if self.is_known(test) or not may_reach(test):
                    continue
                counts = os.path.abspath(os.path.join(self.build, "counts"))
                shutil.rmtree(counts, ignore_errors=True)
                passed, seconds = run_test(self.build, test, SECONDS, use_one_processor, GCOV_PREFIX=counts)
                is_long = seconds >= SECONDS
                files = {} if is_long else lines_of(counts, self.build)
                record = {"test": test, "digest": self.current(file_of(test)), "seconds": round(seconds, 2),
                          **({"limit": SECONDS} if is_long else {}),  # tried again only with a longer one
                          "files": {path: (self.current(path), lines) for path, lines in files.items()}}
                print(f"# {test} is left out: it takes longer than {SECONDS:.0f} s" if is_long else
                      f"# coverage of {test}: {seconds:.1f} s{'' if passed else ', fails'}", flush=True)
                self.tests[test] = record
                self.sets.pop(test, None)
                with open(self.kept, "a", encoding="utf-8") as file:
                    file.write(json.dumps(record) + "\n")

    def seconds(self, test):
        """How long a test took."""
        return self.tests[test]["seconds"]

    def reaching(self, path, line, suites):
        """The tests that reach a line, suites in order, the shortest first."""
        found, order = [], list(dict.fromkeys(suite.split("/")[0] for suite in suites))
        for suite in suites:
            for test in tests_of(suite):
                if path in self.tests.get(test, {"files": ()})["files"]:
                    if (test, path) not in self.sets:
                        self.sets[test, path] = set(self.tests[test]["files"][path][1])
                    if line in self.sets[test, path]:
                        found.append((order.index(test.split("/")[0]), self.seconds(test), test))
        return [test for _, _, test in sorted(found)]
