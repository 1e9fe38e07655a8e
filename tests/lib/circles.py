#!/usr/bin/env python3
"""Circles of units: circles.py ROOT [EXCEPT]. A unit is a .c file with the header of its name; it uses those whose
headers it includes. A header without such a file has types that others share, so it is taken as part of what includes
it. Prints each circle that is not within folders of ROOT that match the regular expression EXCEPT; for make lint."""
import os
import re
import sys


def includes_of(root):
    """Of each file below root, the headers below root that it includes."""
    files = [os.path.relpath(os.path.join(folder, name), root) for folder, _, names in os.walk(root) for name in names]
    files = [file for file in files if file.endswith((".c", ".h"))]
    of = {}
    for file in files:
        with open(os.path.join(root, file), encoding="utf-8") as text:
            of[file] = [name for name in re.findall(r'^#include "(.*)"', text.read(), flags=re.M)]
    return {file: [name for name in names if name in of] for file, names in of.items()}


def uses_of(includes):
    """Of each unit, the others that it uses."""
    uses = {file[:-2]: set() for file in includes if file.endswith(".c")}
    for file in includes:
        unit, seen, found = file[:-2], {file}, list(includes[file])
        while unit in uses and found:
            header = found.pop()
            if header in seen:
                continue
            seen.add(header)
            if header[:-2] in uses:
                uses[unit].add(header[:-2])
            else:
                found += includes[header]
        uses.get(unit, set()).discard(unit)
    return uses


def reached(uses, start):
    """All units that a unit uses, by however many steps."""
    seen, left = set(), [start]
    while left:
        for unit in uses[left.pop()] - seen:
            seen.add(unit)
            left.append(unit)
    return seen


def main():
    root, apart = sys.argv[1], re.compile(sys.argv[2] if len(sys.argv) > 2 else "$^")
    uses = uses_of(includes_of(root))
    uses = {unit: others for unit, others in uses.items() if not apart.match(unit)}
    uses = {unit: {other for other in others if other in uses} for unit, others in uses.items()}
    from_here = {unit: reached(uses, unit) for unit in uses}
    told = set()
    for unit in sorted(uses):
        circle = {other for other in from_here[unit] if unit in from_here[other]}
        if circle and unit not in told:
            print(" ".join(sorted(circle)))
            told |= circle
    sys.exit(1 if told else 0)


main()
