"""Mutants of the player: operators and conditions in the source of tools/web, made into a script as the player is.

The tests are those of suite web that run it in Node; all of them, since each takes a second."""

import glob
import json
import os
import shutil
import subprocess

import coverage

HERE = os.path.dirname(os.path.abspath(__file__))


class Operator:
    """A mutant of the source: `start` to `end` of its file become `by`."""

    def __init__(self, fields, turn):
        self.__dict__.update(fields)
        self.old, self.kind = self.what.rsplit(" ", 1)
        self.place = self.start
        self.decides = self.old in ("condition", "!", "&&", "||", "??") or self.old[0] in "=!<>"
        self.name = "\t".join((self.path, self.function, self.text, self.what, str(turn)))


class Player:
    """What run.py judges for the area `player`."""

    def __init__(self, work):
        self.work = work
        self.folder = os.path.join(work, "player")
        self.script = os.path.join(work, "tree", "tests", "web", "player.js")
        self.names = sorted(glob.glob("tools/web/*.js"))
        for name in self.names + ["tests/web/modules.js"]:
            os.makedirs(os.path.join(self.folder, os.path.dirname(name)), exist_ok=True)
            shutil.copy(name, os.path.join(self.folder, name))
        os.unlink(self.script)  # a link to what is built
        self.times, self.made = {}, None

    def mutants(self, _):
        """All mutants of all modules."""
        out = subprocess.run(["node", "--expose-internals", os.path.join(HERE, "operators.js"), *self.names],
                             capture_output=True, text=True, check=True).stdout
        found, turns = [], {}
        for fields in map(json.loads, out.splitlines()):
            key = (fields["path"], fields["function"], fields["text"], fields["what"])
            turns[key] = turns.get(key, -1) + 1
            found.append(Operator(fields, turns[key]))
        return found

    def prepare(self, mutant):
        """The module with the mutant, or None where it does not parse."""
        with open(mutant.path, encoding="utf-8") as file:
            units = file.read().encode("utf-16-le")  # what node counts in
        text = (units[:2 * mutant.start] + mutant.by.encode("utf-16-le") + units[2 * mutant.end:]).decode("utf-16-le")
        return text if self.bundle(mutant.path, text) else None

    def digest(self, mutant):
        """Of the module that is changed."""
        return coverage.digest(mutant.path)

    def bundle(self, path=None, text=None):
        """Make the script for the tests, one module changed; whether the modules parse."""
        if path:
            with open(os.path.join(self.folder, path), "w", encoding="utf-8") as file:
                file.write(text)
        made = subprocess.run(
            ["esbuild", "--bundle", os.path.join(self.folder, "tests/web/modules.js"), "--charset=utf8",
             f"--alias:colors={os.path.abspath(self.work)}/plain/gen/colors.js", "--log-level=silent",
             "--global-name=player", "--allow-overwrite", f"--outfile={self.script}"], check=False).returncode == 0
        if path:
            shutil.copy(path, os.path.join(self.folder, path))
        return made

    def tests(self, _):
        """All tests of the player, the shortest first."""
        others = ("web/bundle", "web/shaders", "web/studio")
        found = [test for test in coverage.tests_of("web") if not test.startswith(others)]
        return sorted(found, key=lambda test: self.times.get(test, 1))

    def run(self, test, mutant=None, change=None):
        """Whether a test passes, with a mutant or without; taking much longer than it should is failing."""
        if self.made != (mutant, change):
            self.bundle(mutant and mutant.path, change)
            self.made = mutant, change
        passed, seconds = coverage.run_test(os.path.join(self.work, "tree"), test, 300)
        if passed:
            self.times[test] = seconds
        return passed
