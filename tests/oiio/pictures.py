"""What the suite oiio asks of pictures through Python's OpenImageIO.

pictures.py same A B [SUBIMAGE]      the same pixels, to the bit; else how they differ
pictures.py open NAME                why it cannot be opened or read, else its size and how many subimages there are
pictures.py threads NAME...          every name read twice, all at once, subimage by subimage: how often it was the same
pictures.py renders NAME             as threads, and how many renders that took
pictures.py buffer NAME              its size by way of ImageBuf
pictures.py changes NAME FROM TO     whether its pixels change when FROM is copied over TO
"""
import shutil
import sys
import threading

import numpy
import OpenImageIO as oiio


def read(source, subimage):
    """Pixels, or why not."""
    if not source.seek_subimage(subimage, 0):
        return None
    pixels = source.read_image(subimage, 0, 0, source.spec().nchannels, oiio.FLOAT)
    return source.geterror() if pixels is None else pixels


def load(name, subimage=0):
    source = oiio.ImageInput.open(name)
    pixels = read(source, subimage) if source else oiio.geterror()
    if not isinstance(pixels, numpy.ndarray):
        sys.exit(f"{name}: {pixels}")
    return pixels


def same(a, b, subimage=0):
    a, b = load(a, int(subimage)), load(b, int(subimage))
    if a.shape != b.shape:
        return f"shape {a.shape} is not {b.shape}"
    if not numpy.array_equal(a, b, equal_nan=True):
        return f"they differ by up to {numpy.nanmax(abs(a - b))}"
    return "same, and black" if not a.any() else "same"


def open_(name):
    source = oiio.ImageInput.open(name)
    if not source:
        return f"cannot open: {oiio.geterror()}"
    count = 0
    while source.seek_subimage(count, 0):
        count += 1
    pixels = read(source, 0)
    if isinstance(pixels, str):
        return f"cannot read: {pixels}"
    return f"{pixels.shape[1]}x{pixels.shape[0]}, {count} subimages"


def threads(*names):
    start = threading.Barrier(2 * len(names))
    found = {}

    def work(name, number):
        start.wait()
        source = oiio.ImageInput.open(name)
        if not source:
            sys.exit(f"{name}: {oiio.geterror()}")
        subimage, all_pixels = 0, []
        while source.seek_subimage(subimage, 0):
            pixels = read(source, subimage)
            all_pixels.append(numpy.zeros(1) if isinstance(pixels, str) else pixels)
            subimage += 1
        found[name, number] = all_pixels

    workers = [threading.Thread(target=work, args=(name, number)) for name in names for number in range(2)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    equal = 0
    for name in names:
        a, b = found.get((name, 0), []), found.get((name, 1), [])
        equal += len(a) == len(b) > 0 and all(
            x.ndim == 3 and numpy.array_equal(x, y, equal_nan=True) for x, y in zip(a, b)
        )
    return f"{equal} of {len(names)}"


def renders(name):
    equal = threads(name)
    return f"{equal}, renders: {oiio.ImageInput.open(name).spec().getattribute('retex:renders')}"


def buffer(name):
    picture = oiio.ImageBuf(name)
    if not picture.read():
        return picture.geterror()
    return f"{picture.spec().width}x{picture.spec().height}, {picture.nsubimages} subimages"


def changes(name, source, target):
    before, again = load(name), load(name)
    shutil.copyfile(source, target)
    after = load(name)
    if not numpy.array_equal(before, again):
        return "they change by themselves"
    return "no" if numpy.array_equal(before, after) else "yes"


print({"same": same, "open": open_, "threads": threads, "renders": renders, "buffer": buffer,
       "changes": changes}[sys.argv[1]](*sys.argv[2:]))
