#!/usr/bin/env python3
"""One sense a word: prints where docs/glossary.md has a term twice, and where the code uses a word that means something
else there. A term of several words counts as one: `light_group` is no group, `RetexBandStore` no band."""

import re
import subprocess
import sys

# What another word is for: a pattern of the files in which it is no part of a name.
ELSEWHERE = {
    "band": r"tools/libretex/(compact|metrics|pack|picture|retexture|texture|web)/",  # strip
    "budget": r"tools/libretex/(compact|pack|web)/",
    "chunk": r"tools/libretex/(compact|pack|web)/",  # slice
    "colour": r"",  # the code spells color
    "group": r"(oiio_plugins|renderer|tools(?!/libretex/(retexture|web)))/",  # compound, class, use
    "manifest": r"tools/batch/",  # journal
    "signal": r"renderer/(?!film/)",
    "slice": r"tools/libretex/(?!pack/)",
    "strip": r"tools/libretex/exr/|renderer/film/",  # band
}
NO_NAME = r'/\*.*?\*/|//[^\n]*|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'|\b__\w+'


def read_terms():
    """The glossary's terms, lower case, in its order."""
    with open("docs/glossary.md", encoding="utf-8") as lines:
        heads = [line.split("|")[1] for line in lines if line.startswith("| ") and not line.startswith("| term |")]
    return [re.sub(r" *\(.*?\)", "", term).strip().lower() for head in heads for term in head.split(",")]


def words_of(name, terms):
    """The words of a name, without plurals and the n of numbers; the words of a term of several are joined."""
    words = [re.sub(r"^n(?=\w+s$)|s$", "", word.lower()) for word in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+", name)]
    text = " ".join(words)
    for term in terms:
        if " " in term:
            text = text.replace(term, term.replace(" ", "-"))
    return text.split()


def complaints():
    terms = read_terms()
    yield from (f"docs/glossary.md: {term} twice" for term in sorted(set(terms)) if terms.count(term) > 1)
    yield from (f"tests/lib/words.py: {word} is no term of docs/glossary.md"
                for word in sorted(set(ELSEWHERE) - set(terms) - {"colour"}))
    for path in subprocess.check_output(["git", "ls-files", "*.c", "*.h", "*.cpp", "*.hpp"], text=True).split():
        with open(path, encoding="utf-8", errors="replace") as file:
            names = set(re.findall(r"[A-Za-z_]\w*", re.sub(NO_NAME, " ", file.read(), flags=re.S)))
        here = {word for word in ELSEWHERE if re.match(ELSEWHERE[word], path)}
        yield from (f"{path}: {name}: {word} means something else"
                    for name in sorted(names) for word in here & set(words_of(name, terms)))


found = list(complaints())
print("\n".join(found))
sys.exit(bool(found))
