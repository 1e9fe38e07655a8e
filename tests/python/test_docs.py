"""The examples of docs/python.md and of the package's help run, in their order, in one folder."""
import os
import re
import shutil

import lib

import retex

shutil.copy(lib.SCENES + "/living-room/textures/oak-planks.jpg", "oak.jpg")
lib.run("make_set", "room.exr", "64", "48", "denoise")
lib.run("retex-pack", "-q", "room.exr", "-o", "room.retex")


def examples(text, pattern):
    return [example.group(1) for example in re.finditer(pattern, text, re.S | re.M)]


def test_page():
    """docs/python.md"""
    with open(lib.ROOT + "/docs/python.md", encoding="utf-8") as file:
        page = file.read()
    names = {"print": lambda *words: print("#", *words)}
    found = examples(page, r"^```python\n(.*?)^```")
    assert len(found) >= 6
    for example in found:
        exec(compile(example, "docs/python.md: " + example.split("\n", maxsplit=1)[0], "exec"), names)
    for made in ("oak.png", "walls-2.jpg", "clean.exr", "clean.retex"):
        assert os.path.getsize(made) > 200, made
    for name in re.findall(r"`retex\.(\w+)", page):
        assert hasattr(retex, name), name
    for name in re.findall(r"`Set\.(\w+)", page):
        assert hasattr(retex.Set, name), name


def test_help():
    """The example of help(retex), and everything has a help text"""
    example = re.search(r"\n(    import retex\n.*?)\n\n\S", retex.__doc__, re.S)[1]
    example = re.sub("^    ", "", example, flags=re.M).replace("print(", "repr(")
    os.remove("oak.png")
    exec(compile(example, "retex.__doc__", "exec"), {})
    assert os.path.getsize("oak.png") > 200
    for name in set(retex.__all__) - {"Picture", "Source"}:
        thing = getattr(retex, name)
        assert thing.__doc__, name
        for member, value in vars(thing).items() if isinstance(thing, type) else ():
            if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                assert value.__doc__, f"{name}.{member}"


lib.main(globals())
