#!/usr/bin/env python3
"""Files and functions that comments, READMEs and man pages name must exist. Prints those that do not; for make lint.

Looked for are file names with an ending of ours, paths in backquotes, names with a prefix of the library, and calls
written NAME(). NAME, `x.c` and the examples of renderer/README.md stand for any file."""
import os
import re
import subprocess
import sys

EXAMPLES = re.compile(r"NAME|SIGNAL|^x(_kernel)?\.[ch]$|superellipsoid|marble")
ELSEWHERE = {"radiosity/cornell.pov", "scenes/living-room-bitterli"}  # files of others
SOURCES = (".c", ".h", ".cpp", ".hpp")
ROOTS = ("", "renderer/", "tools/", "tools/libretex/", "tools/libretex/include/", "tests/")


def comments(path, text):
    """The texts of a file that say something, with their offsets."""
    if path.endswith(SOURCES):
        return [(m.start(), m.group()) for m in re.finditer(r"/\*.*?\*/|//[^\n]*", text, re.S)]
    if path.endswith(".md") or path.startswith("man/"):
        return [(0, text)]
    return [(m.start(), m.group()) for m in re.finditer(r"^\s*#[^!].*$", text, re.M)]


def main():
    tracked = subprocess.run(["git", "ls-files"], capture_output=True, text=True, check=True).stdout.split()
    tracked = [path for path in tracked if os.path.isfile(path)]
    ends = {"/".join(path.split("/")[i:]) for path in tracked for i in range(path.count("/") + 1)}
    folders = {os.path.dirname(path)[:i] for path in tracked for i in range(1, 200)} | {""}
    stems = {end.split(".")[0] for end in ends}
    texts = {}
    for path in tracked:
        if path.endswith(SOURCES + (".md", ".sh", ".mk", ".py")) or path.startswith("man/") or path == "Makefile":
            with open(path, encoding="utf-8", errors="replace") as file:
                texts[path] = file.read()
    names = set()
    for path, text in texts.items():
        if path.endswith(SOURCES):
            names.update(re.findall(r"[A-Za-z_]\w*", re.sub(r"/\*.*?\*/|//[^\n]*", "", text, flags=re.S)))
    wrong = 0

    def complain(path, text, offset, what):
        nonlocal wrong
        print(f"{path}:{text.count(chr(10), 0, offset) + 1}: there is no {what}")
        wrong = 1

    for path, text in texts.items():
        if path == "CHANGES.md" or "/stb" in path:
            continue
        made = set(re.findall(r'^\.\\" file (\S+)', text, flags=re.M))  # by a page's own examples
        for start, comment in comments(path, text):
            for m in re.finditer(r"(?<![\w<$./*{}-])((?:[\w-]+/)*[\w-]+\.(?:c|h|cpp|hpp|sh|py|mk))\b(?![\w(.])", comment):
                if m[1] not in ends | made and not EXAMPLES.search(m[1]):
                    complain(path, text, start + m.start(), f"file {m[1]}")
            for m in re.finditer(r"`((?!build/)[a-z][\w-]*(?:/[\w.-]+)+)/?`", comment if path.endswith(".md") else ""):
                if not any(root + m[1] in folders for root in ROOTS) and m[1].split(".")[0] not in stems and \
                        m[1] not in ELSEWHERE and not EXAMPLES.search(m[1]):
                    complain(path, text, start + m.start(), f"file or folder {m[1]}")
            for m in re.finditer(r"\b(retex_\w*[a-z0-9])\b(?![*_/.…-])|\b(\w+_\w+)\(\)", comment):
                if (m[1] or m[2]) not in names and f"{m[1]}.h" not in ends:
                    complain(path, text, start + m.start(), f"function {m[1] or m[2]}")
    return wrong


sys.exit(main())
