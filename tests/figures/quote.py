"""Figures in texts are those of the pages: quote.py --check | --update

quotes.txt, beside this file, has excerpts of texts, with names of figures in place of the figures; measured.py has the
names. Prints one line for each excerpt that is not once in its text, for each figure that differs from docs/*.csv, and
for each figure with a unit that is neither quoted nor in given.txt, and exits with 1. --update first writes the figures
into the texts.
"""
import glob
import os
import re
import sys

from measured import figure

HERE = os.path.dirname(os.path.abspath(__file__))


def blocks(name):
    """Of a file of excerpts beside this one, the blocks between blank lines, without comments."""
    with open(os.path.join(HERE, name), encoding="utf-8") as file:
        return filter(None, map(str.strip, re.sub(r"^#.*\n", "", file.read(), flags=re.M).split("\n\n")))


def quotes():
    """Of quotes.txt: texts with their excerpts."""
    texts = {}
    for block in blocks("quotes.txt"):
        if block.startswith("@ "):
            excerpts = texts.setdefault(block[2:], [])
        else:
            excerpts.append(block)
    return texts


def given():
    """Of given.txt: excerpts with the texts in which they may be."""
    found, why = [], None
    for block in blocks("given.txt"):
        if block.startswith("? "):
            why, paths = block[2:], None
        elif block.startswith("@ "):
            paths = sorted(glob.glob(block[2:]))
        elif why and paths:
            found.append((block, paths))
        else:
            sys.exit(f"given.txt: an excerpt without a reason or a file: {block}")
    return found


def pattern(excerpt):
    """Matches the excerpt, however its lines are broken: a piece of a text for each figure."""
    words = [re.sub(r"(\\[ \n])+", r"\\s+", re.escape(piece)) for piece in re.split(r"\{[^}]*\}", excerpt)]
    return rf"(?<!\w){'([^|]{1,120}?)'.join(words)}(?!\w)"


def quoted(path, text, excerpt):
    """Returns the text with the figures in the excerpt's place, and what was wrong there."""
    found = list(re.finditer(pattern(excerpt), text))
    if len(found) != 1:
        has = "has more than once" if found else "no longer has"
        return text, [f"{path}: {has}: {' '.join(excerpt.split())}"]
    wrong = []
    for number, name in reversed(list(enumerate(re.findall(r"\{([^}]*)\}", excerpt), 1))):
        low, high = found[0].span(number)
        has, line = " ".join(text[low:high].split()), text.count("\n", 0, low) + 1
        try:
            now = figure(name)
        except (KeyError, TypeError, ValueError, OSError) as why:
            wrong.insert(0, f"{path}:{line}: {name}: {why}")
            continue
        if has != now:
            wrong.insert(0, f"{path}:{line}: {name}: the text has {has}, the page {now}")
            text = text[:low] + now + text[high:]
    return text, wrong


# ---- figures that nobody measured ----

NUMBER = r"(?<![\w./:-])(?:\d+(?:[.,]\d+)*|\.\d+)"
UNIT = r"(?:dB|ms|s|seconds?|minutes?|hours?|KB|MB|GB|%|percent|fps|times(?= (?:as|the|faster|slower|smaller|larger|more)\b))"
FIGURE = re.compile(rf"({NUMBER})[ \u00a0]?{UNIT}(?!\w)")


def written():
    """Texts that people write: not the pages that make figures makes, but docs/serve.md, which only quotes one."""
    with open(os.path.join(HERE, "pages.txt"), encoding="utf-8") as file:
        made = {f"docs/{line.split()[0]}.md" for line in file if not line.startswith("#")} - {"docs/serve.md"}
    return ["README.md"] + [path for path in sorted(glob.glob("docs/*.md") + glob.glob("man/*.[1357]")) if path not in made]


def prose(text):
    """The text with blanks in place of the listings of Markdown."""
    return re.sub(r"(?ms)^```.*?^```$|(?-s:^    .*$)", lambda found: re.sub(r"[^\n]", " ", found[0]), text)


def unmeasured(excerpts):
    """A line for each figure that is neither quoted nor given, and for each given excerpt that is nowhere."""
    wrong, allowed = [], {}
    for excerpt, paths in given():
        found = [(path, m.span()) for path in paths for m in re.finditer(pattern(excerpt), read(path))]
        wrong += [] if found else [f"given.txt: no text has: {' '.join(excerpt.split())}"]
        for path, span in found:
            allowed.setdefault(path, []).append(span)
    for path in written():
        text = read(path)
        spans = allowed.get(path, [])
        spans += [m.span(k) for excerpt in excerpts.get(path, []) for m in re.finditer(pattern(excerpt), text)
                  for k in range(1, m.re.groups + 1)]
        for m in FIGURE.finditer(prose(text)):
            if not any(low <= m.start(1) and m.end(1) <= high for low, high in spans):
                wrong.append(f"{path}:{text.count(chr(10), 0, m.start()) + 1}: no page makes the figure {m[0]}: quote one "
                             "(quotes.txt), say why it may stand (given.txt), or leave it out")
    return wrong


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def main(mode):
    wrong = []
    for path, excerpts in quotes().items():
        text = old = read(path)
        if mode == "--update":
            for excerpt in excerpts:
                text, _ = quoted(path, text, excerpt)
        if text != old:
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
        for excerpt in excerpts:
            wrong += quoted(path, text, excerpt)[1]
    wrong += unmeasured(quotes())
    for line in wrong:
        print(line)
    return 1 if wrong else 0


if __name__ == "__main__":
    if sys.argv[1:] not in (["--check"], ["--update"]):
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1]))
