"""Edits as text: the cases of tests/data/edits.txt, and pictures of them."""
import pathlib
import pickle

import lib
import numpy as np

import retex

OAK = lib.SCENES + "/textures/fans.jpg"
lib.run("make_set", "room.exr", "64", "48")


def test_cases():
    """The cases that the library and the player have"""
    cases = 0
    with open(lib.ROOT + "/tests/data/edits.txt", encoding="utf-8") as file:
        for line in file.read().splitlines():
            mark, rest = line[:1], line[2:]
            if mark == "<":
                text = rest
            elif mark == ">":
                assert retex.edit_text(text) == rest, text
                if not any(prefix in text for prefix in ("light:", "finish:", "picture:")):  # parse_edit gives textures
                    assert retex.edit_text(pickle.loads(pickle.dumps(retex.parse_edit(text)))) == rest, text
            elif mark == "!":
                error = lib.fails(retex.Error, retex.parse_edit, text)
                assert error.code == retex.Code.EPARSE and rest in error.message, (text, error)
            cases += mark in {">", "!"}
    assert cases > 90


def test_textures():
    """Textures, and their text"""
    textures = {"Wall": "tan", "Floor": retex.Texture("a;b.png", scale=2, rotate=0.1, wrap=("clamp", "black"))}
    text = "Floor=a%3Bb.png;Floor.scale=2,2;Floor.rotate=0.1;Floor.wrap=clamp,black;" \
        "Wall=rgb(0.6444797,0.45641103,0.26225066)"
    assert retex.edit_text(textures) == text
    assert retex.edit_text({"Wall": (1, 0, 0), "Floor": pathlib.Path("red")}) == "Floor=./red;Wall=rgb(1,0,0)"
    assert retex.parse_edit("") == {} and retex.edit_text({}) == ""
    error = lib.fails(ValueError, retex.edit_text, {"Floor": np.zeros((4, 4, 3))})
    assert "Floor: an array" in str(error)
    lib.fails(ValueError, retex.parse_edit, "Floor=a\0b")


def test_pictures():
    """The text of an edit in place of textures"""
    with retex.open("room.exr") as room:
        floor = retex.Texture(OAK, scale=(2, 1), rotate=30)
        expected = room.combine({"Floor": floor, "Wall": (1, 0, 0)})
        text = f"Floor={OAK};Floor.scale=2,1;Floor.rotate=30;wall=red"
        assert np.array_equal(room.combine(text), expected)
        assert np.array_equal(next(room.batch([text])), expected)
        assert not np.array_equal(room.combine(f"Floor={OAK};wall=red"), expected)
        assert np.array_equal(room.combine({"Wall": "#f00", "Floor": floor}), expected)
        room.lay(text)
        assert np.array_equal(room.combine(), expected)
        room.lift()
        error = lib.fails(retex.Error, room.combine, "Flor=red")
        assert error.code == retex.Code.ENOTFOUND and "is Floor meant?" in error.message
        error = lib.fails(retex.Error, room.combine, "Floor=red;Floor.scal=2")
        assert "is scale meant?" in error.message


lib.main(globals())
