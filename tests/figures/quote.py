"""Figures in texts are those of the pages: quote.py --check | --update

quotes.txt, beside this file, has excerpts of texts, with names of figures in place of the figures; FIGURES gives the
names. Prints one line for each excerpt that is not once in its text, for each figure that differs from docs/*.csv, and
for each figure with a unit that is neither quoted nor in given.txt, and exits with 1. --update first writes the figures
into the texts.
"""
import csv
import glob
import os
import re
import sys
from statistics import mean, median

HERE = os.path.dirname(os.path.abspath(__file__))
DOCS = os.path.join(HERE, "..", "..", "docs")


def rows(page, **which):
    with open(os.path.join(DOCS, page + ".csv"), encoding="utf-8") as file:
        found = [row for row in csv.DictReader(file) if all(row[name] == value for name, value in which.items())]
    if not found:
        raise KeyError(f"docs/{page}.csv has no row with {which}")
    return found


def one(page, column, **which):
    found = rows(page, **which)
    if len(found) > 1:
        raise KeyError(f"docs/{page}.csv has {len(found)} rows with {which}")
    return float(found[0][column])


# ---- fidelity and denoising ----

def gaps(method, samples):
    psnr = {(r["scene"], r["texture"], r["method"]): float(r["psnr"]) for r in rows("fidelity", samples=samples)}
    return [value - psnr[scene, texture, "again"] for (scene, texture, name), value in psnr.items() if name == method]


def decibels(value, digits):
    return f"{value:+.{digits}f} dB"


def fidelity_mean(method, samples, digits):
    return decibels(mean(gaps(method, samples)), int(digits))


def fidelity_worst(method, samples, digits):
    return decibels(min(gaps(method, samples)), int(digits))


def fidelity_again(scene, texture, samples):
    """Of rendering again."""
    return f"{one('fidelity', 'psnr', scene=scene, texture=texture, samples=samples, method='again'):.0f} dB"


def denoise_gain(method, samples):
    """Over the set with 128 samples as rendered, whole pictures: mean of scenes and textures."""
    def cells(which, count):
        found = {}
        for r in rows("denoise", method=which, samples=count, region="all"):
            found.setdefault((r["scene"], r["texture"]), []).append(float(r["psnr"]))
        return {key: mean(values) for key, values in found.items()}
    these, base = cells(method, samples), cells("set", "128")
    return decibels(mean(these[key] - base[key] for key in these), 1)


# ---- times and sizes ----

def lamps_pack(count):
    """Of a room with so many lamps over one with them together."""
    return f"{one('lamps', 'value', subject='lamps', name=count, figure='pack ratio'):.1f} times"


def post_size(targets, what):
    return megabytes(one("post", "file_bytes", kind="size", scene="living-room", targets=targets, what=what))


def megabytes(count):
    return f"{count / 1e6:.{0 if count >= 2e7 else 1}f} MB"


def post(column, size, what, scene="living-room", targets="Floor"):
    return one("post", column, kind="time", scene=scene, targets=targets, size=size, what=what)


def post_sizes_of(unit=""):
    """The picture whose sizes the page has: pixels, and samples with their unit, where it is given."""
    with open(os.path.join(DOCS, "post.md"), encoding="utf-8") as file:
        pixels, samples = re.search(r"Megabytes on disk at (\w+), (\d+) samples", file.read()).groups()
    return f"{pixels}, {samples} {unit}" if unit else pixels


def post_seconds(size, what):
    return f"{post('wall_s', size, what):.2f} s"


def post_memory(size, what):
    return f"{post('peak_memory_bytes', size, what) / 1e6:.0f} MB"


def post_variants(size):
    """Pictures a minute; a row of post.csv makes 12."""
    return f"{12 * 60 / post('wall_s', size, 'batch'):.0f}"


def catalogue_rate(what):
    """Pictures of --batch a second of a core's time."""
    row, = rows("catalogues", kind="pictures", what=what, way="1-thread")
    return f"{float(row['pictures']) / float(row['cpu_s']):.1f}"


def overhead(count):
    """Least and largest of the edits of so many targets, processor time of sets over plain pictures."""
    found = [float(r["over_cpu_percent"]) for r in rows("overhead", part="time", row="footprints")
             if r["targets"].count("+") == int(count) - 1]
    low, high = f"{min(found):.0f}", f"{max(found):.0f}"
    return f"{low} %" if low == high else f"{low} to {high} %"


def overhead_of(row, *targets):
    """Of one edit of the living room: processor time over the plain picture."""
    return f"{one('overhead', 'over_cpu_percent', part='time', scene='living-room', targets='+'.join(targets), row=row):+.1f} %"


def paper_size(what, scene, *targets):
    return megabytes(one("paper-sizes", "bytes", scene=scene, targets=" ".join(targets) or "none", what=what))


def paper_psnr(what, scene, *targets):
    return f"{one('paper-sizes', 'psnr', scene=scene, targets=' '.join(targets), what=what):.1f} dB"


def paper_at():
    """Size and samples of docs/paper-sizes.md."""
    with open(os.path.join(DOCS, "paper-sizes.md"), encoding="utf-8") as file:
        found = re.search(r"pictures of (\S+) with (\S+) samples", file.read())
    return f"{found[1]} with {found[2]} samples"


def storage_loss(method, level, layout):
    """The worst of scenes and textures, denoised sets, against converged pictures."""
    found = [float(r["truth_loss_worst"]) for r in rows("storage", method=method, level=level, layout=layout,
                                                        set="denoised") if r["truth_loss_worst"]]
    return f"{max(found):.1f} dB"


def stored(which, quality):
    return [r for r in rows("storage", set=which, method="pack-jpeg", level=quality)]


def pack_differs(which, quality):
    """PSNR against the set's own pictures: the worst texture of the worst scene, and the best scene's mean."""
    found = stored(which, quality)
    return f"{min(float(r['psnr_worst']) for r in found):.0f} to {max(float(r['psnr']) for r in found):.0f} dB"


def pack_loses(which, quality):
    """Against converged pictures, mean of textures: the most of all scenes."""
    return f"{max(float(r['truth_loss']) for r in stored(which, quality) if r['truth_loss']):.2f} dB"


def pack_gains(which, quality):
    return f"{-min(float(r['truth_loss']) for r in stored(which, quality) if r['truth_loss']):.1f} dB"


def pack_grows(quality, base):
    """Bytes of packs of denoised sets over those of another quality, without originals."""
    sizes = {(r["scene"], r["layout"]): int(r["bytes_without_originals"]) for r in stored("denoised", base)}
    found = [int(r["bytes_without_originals"]) / sizes[r["scene"], r["layout"]] for r in stored("denoised", quality)]
    return f"{min(found):.1f} to {max(found):.1f} times"


def lossless_shares():
    """Of the EXR set, denoised and as rendered, with originals."""
    def size(what, targets):
        return one("post", "file_bytes", kind="size", scene="living-room", targets=targets, what=what)
    found = [100 * size("lossless" + ending, targets) / size("exr" + ending, targets)
             for targets in ("one", "two") for ending in ("", "-rendered")]
    return f"{min(found):.0f} to {max(found):.0f} percent"


def denoise_psnr(method, samples):
    return f"{mean(float(r['psnr']) for r in rows('denoise', method=method, samples=samples, region='all')):.0f} dB"


def overhead_memory(*targets):
    """Of writing a set over the plain picture, and the size of the pictures."""
    with open(os.path.join(DOCS, "overhead.md"), encoding="utf-8") as file:
        size = re.search(r"^The peak memory of `scenes/living-room` at (\S+),", file.read(), re.M)[1]

    def peak(row, edit):
        return one("overhead", "peak_memory_bytes", part="memory", row=row, targets=edit)
    return f"{(peak('footprints', '+'.join(targets)) - peak('plain', 'Floor')) / 1e6:.0f} MB at {size}"


def speed_over_cycles():
    """Least and largest of the turns of all scenes."""
    found = [float(r["paths_over_cycles"]) for r in rows("speed")]
    return f"{min(found):.1f} to {max(found):.1f} times"


def served(what, name):
    found, = rows("serve", what=what, figure=name)
    return found["value"]


def serve_cost(what):
    """Processor time of an answer."""
    value = float(served(what, "processor_ms"))
    return f"{value / 1000:.1f} s" if value >= 1000 else f"{value:.0f} ms" if value >= 10 else f"{value:.2g} ms"


def serve_bytes(what):
    value = float(served(what, "bytes"))
    return megabytes(value) if value >= 1e6 else f"{value / 1e3:.0f} KB"


def serve_number(what, name, digits):
    return f"{float(served(what, name)):.{int(digits)}f}"


def serve_size():
    """Pixels of the large room's pictures."""
    return served("large", "size")


def serve_rate(what):
    """New pictures a second of one core."""
    return f"{1000 / float(served(what, 'processor_ms')):.0f}"


def serve_clients_rate():
    """Answers to many clients a second of processor time."""
    rate, seconds, used = (float(served("clients", name)) for name in ("answers_per_s", "seconds", "processor_s"))
    return f"{rate * seconds / used:.0f}"


def serve_measured():
    return served("measured", "by")


FIGURES = {f.__name__: f for f in (fidelity_mean, fidelity_worst, fidelity_again, denoise_gain, post_size, post_sizes_of,
                                   post_seconds, post_memory, post_variants, catalogue_rate, overhead, overhead_of, paper_size, paper_psnr,
                                   paper_at, storage_loss, pack_differs, pack_loses, pack_gains, pack_grows,
                                   lossless_shares, denoise_psnr, overhead_memory, speed_over_cycles, serve_cost, serve_bytes,
                                   serve_number, serve_size, serve_rate, serve_clients_rate, serve_measured, lamps_pack)}


def figure(name):
    function, *arguments = name.split()
    return FIGURES[function](*arguments)


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
