#!/usr/bin/python3
"""Compares what a shared library exports with what public headers declare: symbols.py LIBRARY HEADERS

Calls of headers in retex/host have the version RETEX_HOST_2, all others RETEX_2. Prints what is otherwise."""
import pathlib
import re
import subprocess
import sys

declared = {}
for path in pathlib.Path(sys.argv[2]).rglob("*.h"):
    text = re.sub(r"/\*.*?\*/|//[^\n]*", "", path.read_text(), flags=re.S)
    text = re.sub(r"^ *#(.*\\\n)*.*$", "", text, flags=re.M)
    inline = set(re.findall(r"static inline[^;{(]*?\b(retex_\w+)\(", text))
    names = set(re.findall(r"\b(retex_\w+)\(", text)) - inline
    names |= set(re.findall(r"^extern [^;]*?\b(retex_\w+)\[", text, flags=re.M))
    declared.update(dict.fromkeys(names, "RETEX_HOST_2" if path.parent.name == "host" else "RETEX_2"))

listing = subprocess.run(["nm", "-D", "--defined-only", sys.argv[1]], capture_output=True, text=True, check=True)
exported = {}
for line in listing.stdout.splitlines():
    kind, name = line.split()[1:]
    name, _, version = name.partition("@@")
    if kind != "A":
        exported[name] = version
    elif name not in declared.values():
        print(f"version {name}")
for name in sorted(declared.keys() - exported.keys()):
    print(f"{name}: declared, but not exported")
for name in sorted(exported.keys() - declared.keys()):
    print(f"{name}: exported, but not declared")
for name in sorted(declared.keys() & exported.keys()):
    if declared[name] != exported[name]:
        print(f"{name}: of {exported[name]}, not {declared[name]}")
for version in sorted(set(exported.values())):
    print("some" if list(exported.values()).count(version) > 50 else "few", version)
