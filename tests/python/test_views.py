"""How pictures are developed, compared with numpy written from the published formulas; presets."""
import json
import os
import re

import lib
import numpy as np
import OpenImageIO as oiio

import retex

OAK = lib.SCENES + "/textures/fans.jpg"
lib.run("make_set", "room.exr", "64", "150")
GREY_OF_CARD = 0.18


def luminance(picture):
    """ITU-R BT.709"""
    return picture @ np.array([0.2126, 0.7152, 0.0722])


def white_balance(kelvin):
    """Bradford's adaptation (Lam 1985) from the light of so many kelvins to the white of Rec.709."""
    lamp = retex.edit_text(f"light:a={kelvin}K")
    light = np.array([float(x) for x in re.findall(r"[\d.e+-]+(?=[,)])", lamp)])
    x, y = np.array([.64, .30, .15]), np.array([.33, .60, .06])  # of the primaries, and of white:
    white = np.array([.3127 / .3290, 1, (1 - .3127 - .3290) / .3290])
    primaries = np.array([x / y, np.ones(3), (1 - x - y) / y])
    to_xyz = primaries * np.linalg.solve(primaries, white)
    bradford = np.array([[.8951, .2664, -.1614], [-.7502, 1.7135, .0367], [.0389, -.0685, 1.0296]])
    to_cones = bradford @ to_xyz
    gains = (to_cones @ np.ones(3)) / (to_cones @ light)
    return light, np.linalg.inv(to_cones) @ np.diag(gains) @ to_cones


def filmic(x):
    """Narkowicz, 'ACES Filmic Tone Mapping Curve' (2016), of x times what leaves 0.18 as it is."""
    def curve(x):
        return x * (2.51 * x + .03) / (x * (2.43 * x + .59) + .14)
    low, high = .1, 1.
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if curve(middle * GREY_OF_CARD) < GREY_OF_CARD else (low, middle)
    return np.clip(curve(np.maximum(x, 0) * low), 0, 1)


def neutral(c):
    """The specification of Khronos' PBR Neutral Tone Mapper (2024)."""
    f90, kd = .04, .15
    ks = .8 - f90
    c = np.maximum(c, 0)
    x = c.min(axis=-1, keepdims=True)
    c = c - np.where(x <= 2 * f90, x - x * x / (4 * f90), f90)
    p = c.max(axis=-1, keepdims=True)
    pn = 1 - (1 - ks)**2 / np.maximum(p + 1 - 2 * ks, 1e-9)
    g = 1 / (kd * (p - pn) + 1)
    return np.where(p <= ks, c, c * pn / np.maximum(p, 1e-9) * g + pn * (1 - g))


def srgb(linear):
    """IEC 61966-2-1"""
    linear = np.clip(linear, 0, 1)
    return np.where(linear <= .0031308, 12.92 * linear, 1.055 * linear**(1 / 2.4) - .055)


VIEWS = {"Standard": lambda c: c, "Filmic": filmic, "Neutral": neutral}


def stored(path, channels, has_associated=False):
    """The numbers of a file, 0 to 1, as they are."""
    config = oiio.ImageSpec()
    config.attribute("oiio:UnassociatedAlpha", 1)
    file = oiio.ImageInput.open(path) if has_associated else oiio.ImageInput.open(path, config)
    assert file, oiio.geterror()
    pixels = np.asarray(file.read_image(oiio.FLOAT), dtype=np.float64)
    file.close()
    assert pixels.shape[2] == channels, pixels.shape
    return pixels


def test_exposure():
    """Exposure"""
    with retex.open("room.exr") as room:
        plain = room.combine({"Floor": OAK})
        for stops in (-30, -1.5, 0, 2, 30):
            made = room.combine({"Floor": OAK}, exposure=stops)
            assert np.allclose(made, plain.astype(float) * 2.0**stops, rtol=1e-6, atol=0)
        assert np.array_equal(room.combine(f"Floor={OAK};picture:exposure=2"), room.combine({"Floor": OAK}, exposure=2))
        assert np.array_equal(room.combine(f"Floor={OAK};picture:view=Filmic"), plain)  # a view is not of floats
        assert np.array_equal(room.combine({"Floor": OAK}, exposure=2, crop=(3, 5, 20, 90)),
                              room.combine({"Floor": OAK}, exposure=2)[5:95, 3:23])
        for wrong in ({"exposure": 31}, {"exposure": float("nan")}, {"white_balance": 999}, {"white_balance": 25001}):
            assert lib.fails(retex.Error, room.combine, **wrong).code == retex.Code.EPARSE
        assert np.array_equal(room.error({"Floor": OAK}), room.error(f"Floor={OAK};picture:exposure=3"))


def test_white_balance():
    """White balance"""
    with retex.open("room.exr") as room:
        plain = room.combine({"Floor": OAK})
        for kelvin in (1000, 2700, 4000, 6504, 25000):
            light, matrix = white_balance(kelvin)
            assert np.allclose(matrix @ light, 1, atol=1e-5)  # white, of the luminance that the light had
            made = room.combine({"Floor": OAK}, white_balance=kelvin)
            expected = plain.astype(float) @ matrix.T
            assert np.allclose(made, expected, rtol=0, atol=5e-4 * expected.max()), kelvin
        near = room.combine({"Floor": OAK}, white_balance=6504)
        assert np.abs(near - plain).max() < .05 * plain.max()


def test_auto_exposure():
    """Automatic exposure: the log-average of luminance is 0.18"""
    with retex.open("room.exr") as room:
        plain = room.combine({"Floor": OAK}).astype(float)
        bright = luminance(plain)
        mean = np.exp(np.log(bright[bright > 0]).mean())
        made = room.combine({"Floor": OAK}, auto_exposure=True)
        assert np.allclose(made, plain * GREY_OF_CARD / mean, rtol=1e-5, atol=0)
        for threads in (1, 2, 7):
            assert np.array_equal(room.combine({"Floor": OAK}, auto_exposure=True, threads=threads), made)
        text = f"Floor={OAK};picture:auto-exposure=yes;picture:exposure=-1"
        assert np.allclose(room.combine(text), made / 2, rtol=1e-6, atol=0)
        part = room.combine({"Floor": OAK}, auto_exposure=True, crop=(0, 0, 10, 10))  # of the whole picture too
        assert np.array_equal(part, made[:10, :10])
        black = room.combine({name: "black" for name in ("Floor", "Wall")}, auto_exposure=True)
        assert np.isfinite(black).all()


def test_views():
    """Views, of 8 and 16 bits, of grey, with alpha, and through OpenImageIO"""
    random = np.random.RandomState(1)
    colors = np.exp2(random.uniform(-9, 5, (70, 33, 3))).astype(np.float32)
    colors[0, :11] = np.array([0, -1, 1e30, np.inf, np.nan, .18, .08, .76, .8, 1, 10], np.float32)[:, np.newaxis]
    colors[1, 0] = 3, 0, 0
    alpha = random.uniform(0, 1, (70, 33, 1)).astype(np.float32)
    clean = np.where(np.isnan(colors), 0, np.minimum(colors, 1e30)).astype(float)
    for view, curve in VIEWS.items():
        expected = srgb(curve(clean))
        for path, depth in ("a.png", 8), ("a.png", 16), ("a.tif", 8), ("a.tif", 16), ("a.dpx", 16):
            retex.write(colors, path, view=view.lower(), depth=depth)
            error = np.abs(stored(path, 3) - expected).max() * (2**depth - 1)
            assert error <= (.51 if depth == 8 else 1.01 if path != "a.dpx" else 1.51), (view, path, depth, error)
        retex.write(colors, "a.jpg", view=view, quality=100)
        assert np.abs(stored("a.jpg", 3) - expected)[2:].mean() < 2 / 255
        grey = clean[2:, :, 0]
        retex.write(colors[2:, :, 0], "a.png", view=view, depth=16)
        shown = srgb(curve(np.repeat(grey[:, :, np.newaxis], 3, axis=2)))[:, :, :1]
        assert np.abs(stored("a.png", 1) - shown).max() * 65535 <= 1.01, view
        for path, times in ("a.png", 1), ("a.tga", 1), ("a.sgi", alpha[2:]):  # SGI has codes times alpha, not clipped
            if path == "a.sgi" and view == "Standard":
                continue
            retex.write(np.concatenate([colors, alpha], axis=2)[2:], path, view=view)
            error = np.abs(stored(path, 4, path == "a.sgi")[:, :, :3] - expected[2:] * times)
            assert error.max() <= 1.01 / 255, (view, path, error.max())
        flat = srgb(curve(clean * alpha))[2:]  # a format without alpha shows it over black
        retex.write(np.concatenate([colors, alpha], axis=2)[2:], "a.jpg", view=view, quality=100)
        assert np.abs(stored("a.jpg", 3) - flat).mean() < 2 / 255, view
        retex.write(colors[2:], "a.exr", view=view)
        assert np.array_equal(stored("a.exr", 3), colors[2:].astype(np.float16).astype(float))
    assert retex.encode(colors, "png") == retex.encode(colors, "png", view="standard", display="srgb")
    grey = np.full((1, 1, 3), GREY_OF_CARD, np.float32)
    assert retex.encode(grey, "png", view="Filmic", depth=16) == retex.encode(grey, "png", depth=16)
    error = lib.fails(retex.Error, retex.encode, grey, "png", view="Filmy")
    assert "Standard, Filmic, Neutral, Raw" in error.message


def test_presets():
    """Presets"""
    os.makedirs("shop/textures")
    os.makedirs("shop/presets")
    retex.write(retex.read(OAK)[:, :, :3], "shop/textures/fans.png")
    retex.write(retex.read(OAK)[:, :, :3], "shop/textures/red.png")
    os.rename("shop/textures/red.png", "shop/textures/red")
    textures = {"Floor": retex.Texture("shop/textures/fans.png", scale=2), "Wall": "shop/textures/red"}
    retex.save_preset("shop/presets/a.json", textures, exposure=.5, white_balance=4000, view="Filmic")
    with open("shop/presets/a.json", encoding="utf-8") as file:
        assert json.load(file) == {"retex-preset": 1, "edit": "Floor=../textures/fans.png;Floor.scale=2,2;"
                                   "Wall=../textures/red;picture:exposure=0.5;picture:view=Filmic;"
                                   "picture:white-balance=4000"}
    with retex.open("room.exr") as room:
        expected = room.combine(textures, exposure=.5, white_balance=4000)
        preset = retex.load_preset("shop/presets/a.json")
        assert np.array_equal(room.combine(preset), expected) and retex.edit_view(preset) == "Filmic"
        os.rename("shop", "moved")
        assert np.array_equal(room.combine(retex.load_preset("moved/presets/a.json")), expected)
    os.chdir("moved/textures")
    retex.save_preset("b.json", {"Floor": retex.Texture("fans.png"), "Wall": "./red", "over:Floor": "../textures/red"})
    os.chdir(lib.FOLDER)
    assert retex.edit_text(retex.load_preset("moved/textures/b.json")) == \
        "Floor=moved/textures/fans.png;over:Floor=moved/textures/red;Wall=moved/textures/red"
    os.chdir("moved/textures")
    assert retex.load_preset("b.json") == "Floor=fans.png;over:Floor=./red;Wall=./red"
    os.chdir(lib.FOLDER)
    retex.save_preset("c.json", {"Floor": "/an/absolute.png", "Wall": "gone/with.png"})
    assert retex.load_preset("c.json") == "Floor=/an/absolute.png;Wall=gone/with.png"
    with open("wrong.json", "w", encoding="utf-8") as file:
        file.write('{"retex-preset": 2, "edit": ""}')
    assert lib.fails(retex.Error, retex.load_preset, "wrong.json").code == retex.Code.EUNSUPPORTED
    assert lib.fails(retex.Error, retex.load_preset, "room.exr").code == retex.Code.EFORMAT
    assert lib.fails(retex.Error, retex.save_preset, "gone/a.json", {}).code == retex.Code.EIO
    assert lib.fails(ValueError, retex.save_preset, "d.json", {"Floor": np.zeros((2, 2, 3))})
    assert not os.path.exists("d.json")


lib.main(globals())
