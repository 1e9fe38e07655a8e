"""Wrong inputs end in exceptions that say why."""
import copy
import os
import pathlib
import pickle
import shutil
import warnings

import lib
import numpy as np

import retex
from retex import Code, Error

lib.run("make_set", "room.exr", "64", "48")
lib.run("make_set", "plain.exr", "64", "48", "plain")
with open("text.exr", "w", encoding="utf-8") as text:
    text.write("no picture")


def expect(code, words, function, *arguments, **options):
    error = lib.fails(Error, function, *arguments, **options)
    assert error.code == code and words in str(error), (error.code, str(error))
    return error


def test_opening():
    """Files that are no sets"""
    error = expect(Code.EIO, "none.exr", retex.open, "none.exr")
    assert isinstance(error.code, Code) and error.message and not error.line
    expect(Code.EFORMAT, "text.exr", retex.open, "text.exr")
    shutil.copy("room.exr", "damaged.exr")
    with open("damaged.exr", "r+b") as file:
        file.truncate(20000)
    expect(Code.EFORMAT, "damaged.exr", retex.open, "damaged.exr")
    lib.run("retex-sample", "room.exr", "--texture", "Floor=red", "-o", "red-samples.exr")
    expect(Code.EFORMAT, "red-samples.exr", retex.open, "red-samples.exr")
    lib.fails(ValueError, retex.open, "a\0b")
    lib.fails(TypeError, retex.open, 7)
    assert str(pickle.loads(pickle.dumps(error))) == str(error)


def test_damaged_rows():
    """Damage that is found when rows are read"""
    with open("room.exr", "rb") as file:
        data = bytearray(file.read())
    for k in range(200000, 400000, 97):
        data[k] ^= 1
    with open("rows.exr", "wb") as file:
        file.write(data)
    with retex.open("rows.exr") as room:
        expect(Code.EFORMAT, "rows.exr", room.combine, {"Floor": (1, 1, 1)})


def test_textures():
    """Targets and textures that there are not"""
    with retex.open("room.exr") as room:
        expect(Code.ENOTFOUND, "is Floor meant?", room.combine, {"Flor": (1, 1, 1)})
        expect(Code.ENOTFOUND, "no target", room.combine, {"Floor=x": (1, 1, 1)})
        expect(Code.ENOTFOUND, "Flor", room.combine, {"Flor": np.zeros((4, 4, 3))})
        expect(Code.EINVAL, "two textures", room.combine, {"Floor": (1, 1, 1), "floor": (0, 0, 0)})
        expect(Code.EIO, "none.png", room.combine, {"Floor": "none.png"})
        expect(Code.EIO, "rgb(1,1,1)", room.combine, {"Floor": pathlib.Path("rgb(1,1,1)")})
        expect(Code.EIO, "cannot read ./red", room.combine, {"Floor": pathlib.Path("red")})
        expect(Code.EIO, "is red meant?", room.combine, {"Floor": "rde"})
        expect(Code.EPARSE, "three numbers", room.combine, {"Floor": "rgb(1,1)"})
        lib.fails(Error, room.combine, {"Floor": "text.exr"})
        lib.fails(ValueError, room.combine, {"Floor": ""})
        lib.fails(ValueError, room.combine, {"Floor": "a\0b"})
        lib.fails(ValueError, room.combine, {"Fl\0or": (1, 1, 1)})
        for colour in ((-1, 0, 0), (float("nan"), 0, 0), (float("inf"), 0, 0)):
            lib.fails(Error, room.combine, {"Floor": colour})
        for wrong in ((1, 1), 7, None, b"x.png"):
            lib.fails(TypeError, room.combine, {"Floor": wrong})
        for wrong in (np.zeros((4, 4, 2)), np.zeros((0, 4, 3)), np.zeros((2, 2, 2, 3)), np.zeros(4)):
            lib.fails(ValueError, room.combine, {"Floor": wrong})
        lib.fails(Error, room.combine, {"Floor": "x" * 2000})
    with retex.open("plain.exr") as plain:
        assert plain.targets == [] and "none" in repr(plain)
        expect(Code.ENOTFOUND, "no targets", plain.combine, {"Floor": (1, 1, 1)})


def test_options():
    """Options of textures, checked where they are given"""
    for options in ({"scale": 0}, {"scale": (1, 2, 3)}, {"wrap": "tile"}, {"flip": "x"}, {"repeat": "wall"},
                    {"rotate": float("nan")}, {"width": -1}, {"wrap": ("repeat", "nothing")}):
        error = lib.fails(Error, retex.Texture, "oak.jpg", **options)
        assert next(iter(options)) in str(error), str(error)
    lib.fails(TypeError, retex.Texture, "oak.jpg", size=3)
    lib.fails(TypeError, retex.Texture)
    assert "scale=2.0" in repr(retex.Texture("oak.jpg", scale=2))


def test_numbers():
    """Numbers out of range"""
    with retex.open("room.exr") as room:
        for threads in (-1, 257):
            lib.fails(ValueError, room.combine, threads=threads)
            lib.fails(ValueError, room.lay, {}, threads=threads)
        lib.fails(Error, room.combine, cross=1)
        lib.fails(Error, room.denoise, radius=0)
        lib.fails(Error, room.denoise, denoiser="oid")
        lib.fails(Error, room.denoise, quality="high")
        lib.fails(Error, room.pack, "x.retex", quality=0)
        picture = room.combine()
    lib.fails(Error, retex.write, picture, "x.jpg", quality=101)
    lib.fails(Error, retex.write, picture, "x.nonsense")
    lib.fails(Error, retex.encode, picture, "nonsense")
    lib.fails(Error, retex.write, picture, "no folder/x.png")
    lib.fails(Error, retex.write, picture, "x.png", view="no such view")
    lib.fails(ValueError, retex.write, picture[0, 0], "x.png")
    expect(Code.EIO, "none.png", retex.read, "none.png")


def test_denoise_without_data():
    """A set that cannot be denoised stays as it is"""
    with retex.open("room.exr") as room:
        before = room.combine({"Floor": (1, 0, 0)})
        assert not room.can_denoise
        expect(Code.ENOTFOUND, "", room.denoise)
        assert np.array_equal(room.combine({"Floor": (1, 0, 0)}), before)


def test_samples_of_another_set():
    """Samples of another set"""
    lib.run("make_set", "other.exr", "32", "48")
    with retex.open("room.exr") as room, retex.open("other.exr") as other:
        other.lay({"Floor": (1, 0, 0)})
        other.write_samples("others-samples.exr")
        lib.fails(Error, room.lay_samples, "others-samples.exr")
        expect(Code.ENOTFOUND, "", room.lift, "Flor")


def test_closed():
    """A set that is closed"""
    room = retex.open("room.exr")
    picture = room.combine()
    room.close()
    room.close()
    for call in (room.combine, room.error, room.preload, room.denoise, lambda: room.lay({}), lambda: room.write("x"),
                 lambda: room.pack("x"), lambda: list(room.batch([{}])), lambda: room.can_denoise):
        lib.fails(ValueError, call)
    assert room.width == 64 and room.targets and np.isfinite(picture).all()


def test_copies():
    """Sets are neither copied nor pickled"""
    with retex.open("room.exr") as room:
        for refused in (copy.copy, copy.deepcopy, pickle.dumps):
            assert "open its file again" in str(lib.fails(TypeError, refused, room))
        texture = pickle.loads(pickle.dumps(retex.Texture("oak.jpg", scale=2)))
        assert repr(texture) == repr(retex.Texture("oak.jpg", scale=2))
        assert pickle.loads(pickle.dumps(room.targets)) == room.targets


def test_warnings():
    """What is odd about a texture is a warning"""
    with retex.open("room.exr") as room, warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        room.combine({"Floor": (2, 2, 2)})
        retex.Texture((2, 2, 2))
        room.lay({"Floor": (2, 2, 2)})
        assert [warning.category for warning in told] == [retex.RetexWarning] * 2, told
        assert {warning.filename for warning in told} == {__file__}, told  # the caller's line, not the package's
        warnings.simplefilter("error")
        lib.fails(retex.RetexWarning, room.combine, {"Floor": (2, 2, 2)})
        room.combine({"Floor": (0.5, 0.5, 0.5)})


def test_no_file_left():
    """What fails leaves no file"""
    assert not [name for name in os.listdir(".") if name.startswith("x")]


lib.main(globals())
