#!/usr/bin/env python3
"""Chooses the tests of `make check`: quick.py SECONDS LOGS…, into tests/quick.txt.

LOGS are folders of build/tests/log, whose logs end with each test's processor time. The tests that ALWAYS names come
first; then the one that notices most of the mutants of list.txt that no other does yet, for its time, as long as all take
no more than SECONDS. Which tests notice a mutant is what its block says. Long tests stand first, so that the last ones
end together.

quick.py --lint tells whether the tests of tests/quick.txt notice less than LEAST of the mutants."""
import fnmatch
import glob
import os
import re
import sys

from run import ROOT, read_list

LIST = os.path.join(ROOT, "tests/quick.txt")
LEAST = 0.8
# Something of every suite and tool, whatever notices it.
ALWAYS = ["lint/house", "golden/*", "faults/calls", "fidelity/constants", "fidelity/closed-forms", "docs/quotes",
          "man/retex-*", "cli/common", "cli/serve", "cli/try", "python/pictures", "web/page", "web/studio_page",
          "oiio/python"]


def seconds_of(folders):
    """{test: seconds of processors}"""
    found = {}
    for path in (path for folder in folders for path in glob.glob(os.path.join(folder, "*.log"))):
        with open(path, encoding="utf-8", errors="replace") as file:
            times = re.search(r"^# exit status 0 after (\d+)m([\d.]+)s (\d+)m([\d.]+)s", file.read(), re.M)
        if times:
            minutes, seconds, more_minutes, more = (float(x) for x in times.groups())
            found[os.path.basename(path)[:-4].replace(".", "/", 1)] = 60 * (minutes + more_minutes) + seconds + more
    return found


def noticed_by_test():
    """{test: the names of the mutants that it notices}, and the number of all that some test notices."""
    noticed = {}
    mutants = [mutant for mutant in read_list() if mutant.tests]
    for mutant in mutants:
        for test in mutant.tests:
            noticed.setdefault(test, set()).add(mutant.name)
    return noticed, len(mutants)


def choose(seconds, most):
    """The names of the tests."""
    noticed_by, _ = noticed_by_test()
    chosen = [test for test in seconds if any(fnmatch.fnmatch(test, name) for name in ALWAYS)]
    noticed = set().union(*(noticed_by.get(test, set()) for test in chosen))
    left = most - sum(seconds[test] for test in chosen)
    while True:
        worth = {test: len(of - noticed) / (seconds[test] + 0.2) for test, of in noticed_by.items()
                 if test not in chosen and seconds.get(test, left + 1) <= left and of - noticed}
        if not worth:
            return chosen
        best = max(worth, key=worth.get)
        chosen.append(best)
        noticed |= noticed_by[best]
        left -= seconds[best]


def share(tests):
    """Of the mutants that some test notices, how many these do."""
    noticed_by, mutants = noticed_by_test()
    return len(set().union(*(noticed_by.get(test, set()) for test in tests))) / mutants


def main():
    if sys.argv[1] == "--lint":
        with open(LIST, encoding="utf-8") as file:
            noticed = share([line.strip() for line in file if not line.startswith("#")])
        if noticed < LEAST:
            print(f"tests/quick.txt: its tests notice {noticed:.1%} of the mutants, less than {LEAST:.0%}")
        return noticed < LEAST
    seconds = seconds_of(sys.argv[2:])
    chosen = choose(seconds, float(sys.argv[1]))
    chosen.sort(key=lambda test: (-round(seconds[test]), test))
    with open(LIST, "w", encoding="utf-8") as file:
        file.write("# The tests of `make check`, chosen by tests/mutants/quick.py; those that take longest first.\n")
        file.writelines(f"{test}\n" for test in chosen)
    print(f"{len(chosen)} of {len(seconds)} tests, {sum(seconds[test] for test in chosen):.0f} of "
          f"{sum(seconds.values()):.0f} s, {share(chosen):.1%} of the mutants")
    return 0


if __name__ == "__main__":
    sys.exit(main())
