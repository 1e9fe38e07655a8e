"""Memory: nothing is copied, nothing leaks, nothing is freed too early; and threads."""
import gc
import threading
import time
import weakref

import lib
import numpy as np

import retex

lib.run("make_set", "room.exr", "160", "100", "denoise")
lib.run("make_set", "small.exr", "32", "24", "denoise")
lib.run("retex-pack", "-q", "room.exr", "-o", "room.retex")
lib.run("make_picture", "oak.exr")
OAK = "oak.exr"
PICTURE = 160 * 100 * 3 * 4


def resident():
    """Bytes of this process in memory."""
    gc.collect()
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * 4096


def grown(times, work):
    """What `times` runs of work add to the memory of the process, after a fifth as many."""
    for _ in range(times // 5):
        work()
    before = resident()
    for _ in range(times):
        work()
    return resident() - before


def test_combines():
    """200 pictures, 38 MB, leave nothing behind"""
    for name in ("room.exr", "room.retex"):
        with retex.open(name) as room:
            grew = grown(200, lambda: room.combine({"Floor": OAK, "Wall": np.full((8, 8, 3), 0.5, np.float32)}))
        print(f"# {name}: {grew / 1024:.0f} KiB")
        assert grew < 20 * PICTURE, grew


def test_sets_and_samples():
    """60 sets, with all that is made of them, leave nothing behind"""
    def work():
        room = retex.open("small.exr")
        room.lay({"Floor": OAK})
        room.combine()
        room.lift()
        room.error({"Floor": (1, 0, 0)})
        retex.encode(room.combine(), "jpg")
        list(room.batch([{"Floor": OAK}, {}]))
        room.denoise()
        for wrong in ({"Floor": "none.png"}, {"Flor": (1, 1, 1)}):
            lib.fails(retex.Error, room.combine, wrong)
        lib.fails(retex.Error, retex.encode, room.combine(), "none")

    grew = grown(60, work)
    print(f"# {grew / 1024:.0f} KiB")
    assert grew < 4 << 20, grew


def test_no_copy():
    """The array lies in the library's memory, and views keep it"""
    with retex.open("room.exr") as room:
        picture = room.combine()
        assert not picture.flags.owndata and picture.flags.writeable and picture.flags.c_contiguous
        address = picture.ctypes.data
        part = room.combine(crop=(10, 20, 30, 40))
        expected = part.copy()
        root = part
        while isinstance(root.base, np.ndarray):
            root = root.base
        owner = root.base.obj if isinstance(root.base, memoryview) else root.base
        gone = weakref.ref(owner)
        del root, owner
        row = part[3]
        del part
        gc.collect()
        for _ in range(20):
            room.combine()
        assert gone() is not None and np.array_equal(row, expected[3])
        del row
        gc.collect()
        assert gone() is None
    picture[:] = 1
    assert picture.ctypes.data == address and picture.sum() == picture.size


def test_freed_at_once():
    """A set that nobody has is closed, without the cycle collector"""
    gc.disable()
    try:
        room = retex.open("room.exr")
        gone = weakref.ref(room._handle)
        pictures = room.batch([{"Floor": OAK}] * 3)
        next(pictures)
        del room
        assert gone() is not None
        del pictures
        assert gone() is None
    finally:
        gc.enable()


def test_threads():
    """Several threads make pictures of one set, while another denoises it and closes it"""
    room = retex.open("room.exr")
    noisy = room.combine({"Floor": OAK}, threads=1)
    with retex.open("room.exr") as other:
        other.denoise()
        clean = other.combine({"Floor": OAK})
    made, problems = [], []

    def work():
        try:
            while True:
                picture = room.combine({"Floor": OAK}, threads=2)
                made.append("noisy" if np.array_equal(picture, noisy) else
                            "clean" if np.array_equal(picture, clean) else "wrong")
        except ValueError:  # it is closed
            pass
        except BaseException as problem:  # pylint: disable=broad-except
            problems.append(problem)

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    wait_for(lambda: len(made) > 8)
    room.denoise()
    wait_for(lambda: "clean" in made)
    room.close()
    for thread in threads:
        thread.join(60)
    assert not problems, problems
    assert set(made) == {"noisy", "clean"}, set(made)


def wait_for(condition):
    until = time.monotonic() + 60
    while not condition():
        assert time.monotonic() < until
        time.sleep(0.01)


def test_lock_is_free():
    """Python runs while the library works"""
    ticks, stop = [], []

    def tick():
        while not stop:
            ticks.append(time.monotonic())
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    with retex.open("room.exr") as room:
        wait_for(lambda: ticks)
        begin = time.monotonic()
        room.denoise(radius=8, threads=1)
        end = time.monotonic()
    stop.append(True)
    thread.join()
    during = [begin] + [moment for moment in ticks if begin < moment < end] + [end]
    pause = max(after - before for before, after in zip(during, during[1:]))
    print(f"# {len(during) - 2} ticks in {end - begin:.2f} s, at most {pause:.2f} s apart")
    assert pause < (end - begin) / 2


lib.main(globals())
