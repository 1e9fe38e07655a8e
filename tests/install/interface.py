#!/usr/bin/python3
"""The interface of libretex as one C text, and a library of nothing else, whose debug information abidiff compares.

interface.py HEADER-FOLDER                 print what the public headers declare, without macros and comments
interface.py --stub TEXT-FILE LIBRARY.so   compile a library in which each of these calls is empty"""
import os
import re
import subprocess
import sys

CC = os.environ.get("CC", "gcc").split()
CALL = re.compile(r"\n((?:[a-z]+ )*\w+[ *]+retex_\w+\([^;{}]*?\));")
CONSTANT = re.compile(r"\nextern ([^;]*?\bretex_\w+\[[^;]*\]);")


def interface(folder):
    """The lines that come from the headers of that folder, with macros expanded."""
    made = subprocess.run([*CC, "-std=c11", "-E", "-I" + folder, "-include", "retex/retex.h", "-xc", "/dev/null"],
                          capture_output=True, text=True, check=True).stdout
    kept, system, ours = [], [], False
    for line in made.splitlines():
        mark = re.match(r'# \d+ "([^"]*)"', line)
        if mark:
            ours = mark.group(1).startswith(folder)
        elif ours and line.strip() and not line.startswith("#"):
            kept.append(re.sub(r"__attribute__\s*\(\(.*\)\)", "", line).rstrip())
    for name in sorted(os.listdir(folder + "/retex")):
        if not name.endswith(".h"):  # the headers of hosts make no part of it
            continue
        with open(f"{folder}/retex/{name}", encoding="utf-8") as file:
            system += re.findall(r"^#include <(?!retex/).*>", file.read(), flags=re.M)
    return re.sub(r"\)\s+;", ");", "\n".join(sorted(set(system)) + kept) + "\n")


def stub(path, library):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    text = CALL.sub(r"\n\1 { __builtin_trap(); }", text)
    text = CONSTANT.sub(r"\n\1 = {0};", text)
    here = os.path.dirname(os.path.abspath(__file__))
    subprocess.run([*CC, "-std=c11", "-w", "-g", "-shared", "-fPIC", "-Wl,-soname,libretex.so.2",
                    f"-Wl,--version-script={here}/../../tools/libretex/libretex.map", "-xc", "-", "-o", library],
                   input=text, text=True, check=True)


if sys.argv[1] == "--stub":
    stub(*sys.argv[2:])
else:
    print(interface(sys.argv[1]), end="")
