#!/usr/bin/python3
"""Compares what a shared library exports with what public headers declare: symbols.py LIBRARY HEADERS

Prints the names that only one of them has, and every version but RETEX_1."""
import pathlib
import re
import subprocess
import sys

declared = set()
for path in pathlib.Path(sys.argv[2]).rglob("*.h"):
    text = re.sub(r"/\*.*?\*/|//[^\n]*", "", path.read_text(), flags=re.S)
    text = re.sub(r"^ *#(.*\\\n)*.*$", "", text, flags=re.M)
    inline = set(re.findall(r"static inline[^;{(]*?\b(retex_\w+)\(", text))
    declared |= set(re.findall(r"\b(retex_\w+)\(", text)) - inline
    declared |= set(re.findall(r"^extern [^;]*?\b(retex_\w+)\[", text, flags=re.M))

listing = subprocess.run(["nm", "-D", "--defined-only", sys.argv[1]], capture_output=True, text=True, check=True)
exported = set()
for line in listing.stdout.splitlines():
    kind, name = line.split()[1:]
    name, _, version = name.partition("@@")
    if kind == "A":
        print(f"version {name}") if name != "RETEX_1" else None
        continue
    exported.add(name)
    if version != "RETEX_1":
        print(f"{name}: version '{version}'")
for name in sorted(declared - exported):
    print(f"{name}: declared, but not exported")
for name in sorted(exported - declared):
    print(f"{name}: exported, but not declared")
print("some" if len(exported) > 100 else f"only {len(exported)}", "symbols")
