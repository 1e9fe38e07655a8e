"""The figures of the pages by name: FIGURES, as quotes.txt writes them. Each is computed of docs/*.csv, or of the words
of a page, and is text."""
import csv
import os
import re
from statistics import mean, median

DOCS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs")


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


def tests_take(check):
    """As tests/times.txt has it."""
    with open(os.path.join(DOCS, "..", "tests", "times.txt"), encoding="utf-8") as file:
        return next(line.split(maxsplit=1)[1].strip() for line in file if line.split()[0] == check)


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
                                   lossless_shares, denoise_psnr, overhead_memory, speed_over_cycles, tests_take, serve_cost, serve_bytes,
                                   serve_number, serve_size, serve_rate, serve_clients_rate, serve_measured, lamps_pack)}


def figure(name):
    function, *arguments = name.split()
    return FIGURES[function](*arguments)
