"""Pictures of the package retex are those of the tools, to the bit."""
import itertools
import json
import os
import pathlib
import shutil
import warnings

import lib
import numpy as np
import OpenImageIO as oiio

import retex

numbers = itertools.count()

OAK = lib.SCENES + "/living-room/textures/oak-planks.jpg"
TERRAZZO = lib.SCENES + "/textures/terrazzo.jpg"
lib.run("make_set", "room.exr", "200", "140", "denoise")
lib.run("make_set", "clusters.exr", "96", "70", "footprints")
lib.run("retex-pack", "-q", "room.exr", "-o", "room.retex")
lib.run("oiiotool", "--pattern", "fill:topleft=1,0,0:topright=0,1,0:bottomleft=0,0,1:bottomright=1,1,.5", "33x17", "3",
        "-d", "float", "-o", "fill.exr")


def combined(set_name, *options):
    """What retex-combine makes, as an array."""
    name = f"expected-{next(numbers)}.exr"  # another one each time: the reader keeps files by their names
    lib.run("retex-combine", "-q", set_name, *options, "-o", name)
    return as_written(lib_read(name))


def lib_read(path):
    """A picture's red, green and blue by another reader."""
    image = oiio.ImageBuf(path)
    return image.get_pixels(oiio.FLOAT)[:, :, :3]


def as_written(picture):
    """As halves, which an EXR has."""
    return np.asarray(picture, dtype=np.float32).astype(np.float16).view(np.uint16)


def check(picture, expected):
    assert picture.dtype == np.float32 and picture.shape == expected.shape, (picture.shape, expected.shape)
    assert np.array_equal(as_written(picture), expected)


def test_originals():
    """A picture without new textures"""
    for name in ("room.exr", "room.retex", "clusters.exr"):
        with retex.open(name) as room:
            check(room.combine(), combined(name))


def test_files_and_colours():
    """Files and colours, of sets and packs"""
    for name in ("room.exr", "room.retex", "clusters.exr"):
        with retex.open(name) as room:
            check(room.combine({"Floor": OAK, "Wall": (0.8, 0.25, 0.1)}),
                  combined(name, "--texture", "Floor=" + OAK, "--texture", "Wall=rgb(0.8,0.25,0.1)"))
            check(room.combine({"floor": TERRAZZO}), combined(name, "--texture", "Floor=" + TERRAZZO))


def test_folders():
    """A folder is the base colour that it holds, and what else it has is told"""
    os.makedirs("oak/textures")
    shutil.copy(OAK, "oak/textures/oak_diff_2k.jpg")
    shutil.copy(TERRAZZO, "oak/textures/oak_rough_2k.jpg")
    expected = combined("room.exr", "--texture:scale=2", "Floor=" + OAK)
    with retex.open("room.exr") as room:
        for textures in ({"Floor": retex.Texture("oak/", scale=2)}, "Floor=oak;Floor.scale=2",
                         {"Floor": retex.Texture(pathlib.Path("oak"), scale=2)}):
            with warnings.catch_warnings(record=True) as told:
                warnings.simplefilter("always")
                check(room.combine(textures), expected)
            assert [str(warning.message) for warning in told] == ["oak: the roughness map is not used"], told
        os.remove("oak/textures/oak_diff_2k.jpg")
        error = lib.fails(retex.Error, room.combine, {"Floor": "oak"})
        assert str(error).endswith("it has a roughness map") and error.code == retex.Code.EFORMAT, error


def test_placement():
    """All ways to place a texture"""
    texture = retex.Texture(OAK, scale=(2, 3.5), rotate=30, offset=(0.25, -0.5), flip="u", wrap=("mirror", "clamp"))
    brick = retex.Texture(OAK, scale=0.7, repeat="brick", colorspace="linear")
    with retex.open("room.exr") as room:
        check(room.combine({"Floor": texture, "Wall": brick}),
              combined("room.exr", "--texture:scale=2,3.5:rotate=30:offset=0.25,-0.5:flip=u:wrap=mirror,clamp",
                       "Floor=" + OAK, "--texture:scale=0.7:repeat=brick:colorspace=linear", "Wall=" + OAK))


def test_arrays():
    """An array as a texture is what the same numbers in a file are"""
    array = lib_read("fill.exr").astype(np.float32)
    with retex.open("room.exr") as room:
        plain = combined("room.exr", "--texture", "Floor=fill.exr")
        check(room.combine({"Floor": array}), plain)
        check(room.combine({"Floor": array.astype(np.float64)}), plain)
        check(room.combine({"Floor": retex.read("fill.exr")}), plain)
        assert np.allclose(room.combine({"Floor": retex.Texture(array[:, ::-1], flip="u")}),
                           room.combine({"Floor": array}), atol=1e-4)
        check(room.combine({"Wall": retex.Texture(array, rotate=45, wrap="mirror")}),
              combined("room.exr", "--texture:rotate=45:wrap=mirror", "Wall=fill.exr"))
        grey = array[:, :, :1]
        assert np.array_equal(room.combine({"Floor": grey}), room.combine({"Floor": np.repeat(grey, 3, axis=2)}))
        assert np.array_equal(room.combine({"Floor": grey[:, :, 0]}), room.combine({"Floor": grey}))


def test_integer_arrays():
    """Arrays of 8 and 16 bits are what such files are"""
    numbers_of = np.random.default_rng(1)
    with retex.open("room.exr") as room:
        for dtype, kind, ending in ((np.uint8, oiio.UINT8, "png"), (np.uint16, oiio.UINT16, "tif")):
            for channels in (1, 3, 4):
                array = numbers_of.integers(0, np.iinfo(dtype).max, (19, 23, channels), endpoint=True).astype(dtype)
                name = f"integers-{channels}.{ending}"
                spec = oiio.ImageSpec(23, 19, channels, kind)
                spec.attribute("oiio:UnassociatedAlpha", 1)
                output = oiio.ImageOutput.create(name)
                assert output.open(name, spec) and output.write_image(array) and output.close()
                textures = [room.combine({"Floor": source}) for source in (array, name)]
                # a file's texels are kept as integers of 16 bits
                assert np.abs(textures[0] - textures[1]).max() < 1e-4, name
                assert np.abs(textures[0] - room.combine({"Floor": array / np.iinfo(dtype).max})).max() > .01, name


def test_width_of_array():
    """An array with a width in scene units"""
    lib.run("retex-render", "-q", "--size", "64x40", "--spp", "4", "-t", "Floor", "-o", "cornell.exr",
            lib.SCENES + "/cornell-box/cornell-box.pov")
    with retex.open("cornell.exr") as room:
        assert min(room.targets[0].uv_scale) > 0
        array = retex.read("fill.exr")
        check(room.combine({"Floor": retex.Texture(array, width=0.5)}),
              combined("cornell.exr", "--texture:width=0.5", "Floor=fill.exr"))
    with retex.open("room.exr") as room:
        error = lib.fails(retex.Error, room.combine, {"Floor": retex.Texture(array, width=0.5)})
        assert error.code == retex.Code.EINVAL, error


def test_size():
    """Smaller pictures, against means"""
    with retex.open("room.exr") as room:
        full = room.combine({"Floor": OAK})
        small = full.reshape(35, 4, 50, 4, 3).mean((1, 3))
        assert np.allclose(room.combine({"Floor": OAK}, size=(50, 35)), small, atol=1e-5)
        part = full[20:100, 10:110].reshape(20, 4, 25, 4, 3).mean((1, 3))
        for size in ((25, 20), (None, 20), (25, None)):
            assert np.allclose(room.combine({"Floor": OAK}, crop=(10, 20, 100, 80), size=size), part, atol=1e-5)
        middle = full[:, 30:170].reshape(10, 14, 10, 14, 3).mean((1, 3))
        assert np.allclose(room.combine({"Floor": OAK}, size=(10, 10)), middle, atol=1e-5)
        assert np.array_equal(list(room.batch([{"Floor": OAK}], size=(50, 35)))[0],
                              room.combine({"Floor": OAK}, size=(50, 35)))
        error = room.error({"Floor": OAK}).reshape(35, 4, 50, 4, 3).mean((1, 3))
        assert np.allclose(room.error({"Floor": OAK}, size=(50, None)), error, atol=1e-5)
        for size in ((0, 5), (-1, None), (None, None)):
            lib.fails(ValueError, room.combine, size=size)
        for size in ((201, None), (50, 141)):
            lib.fails(retex.Error, room.combine, size=size)
        lib.fails(ValueError, room.combine, size=(50, 35), out=np.zeros((35, 50, 3), np.float32))


def test_crop():
    """A part of the picture"""
    with retex.open("room.exr") as room:
        whole = room.combine({"Floor": OAK})
        part = room.combine({"Floor": OAK}, crop=(21, 33, 57, 71))
        assert part.shape == (71, 57, 3) and np.array_equal(part, whole[33:104, 21:78])
        assert np.array_equal(room.combine(crop=(0, 0, 200, 140)), room.combine())
        for crop in ((-1, 0, 5, 5), (0, 0, 0, 5), (0, 0, 201, 5), (199, 139, 2, 1)):
            lib.fails(ValueError, room.combine, crop=crop)


def test_samples():
    """Textures that are laid on a set, and their file"""
    lib.run("retex-sample", "room.exr", "--texture", "Floor=" + OAK, "-o", "expected-samples.exr")
    with retex.open("room.exr") as room:
        expected = room.combine({"Floor": OAK})
        plain, red, both = room.combine(), room.combine({"Floor": (1, 0, 0)}), room.combine({"Wall": (1, 0, 0),
                                                                                           "Floor": OAK})
        room.lay({"Floor": OAK})
        assert np.array_equal(room.combine(), expected)
        assert room.manifest["targets"][0]["texture"] == OAK
        room.write_samples("samples.exr")
        assert np.array_equal(room.combine({"Wall": (1, 0, 0)}), both)
        assert np.array_equal(room.combine({"Floor": (1, 0, 0)}), red)
        for name in ("samples.exr", "expected-samples.exr"):
            room.lift()
            assert np.array_equal(room.combine(), plain)
            room.lay_samples(name)
            assert np.array_equal(room.combine(), expected)
        room.lift("Floor")
        assert np.array_equal(room.combine(), plain)
    check(lib_read("expected-samples.exr"), as_written(lib_read("samples.exr")))


def test_batch():
    """A batch makes what single pictures are, whatever it keeps in memory"""
    rows = [{}, {"Floor": OAK}, {"Wall": OAK}, {"Floor": OAK, "Wall": (0.1, 0.2, 0.3)},
            {"Floor": retex.Texture(OAK, scale=2)}, {"floor": TERRAZZO, "Wall": OAK}, {"Floor": OAK}]
    rows += [{"Floor": np.full((4, 4, 3), value, np.float32)} for value in (0.25, 0.5, 0.75)]
    for name in ("room.exr", "room.retex"):
        with retex.open(name) as fresh:
            expected = [fresh.combine(row) for row in rows]
        for options in ({}, {"memory": 0, "texture_memory": 0}, {"texture_memory": 3 << 20}, {"threads": 1}):
            with retex.open(name) as room:
                pictures = list(room.batch(iter(rows), **options))
            assert len(pictures) == len(rows)
            for picture, other in zip(pictures, expected):
                assert np.array_equal(picture, other)


def test_threads():
    """The same to the bit for every number of threads"""
    with retex.open("room.exr") as room:
        expected = room.combine({"Floor": OAK}, threads=1)
        for threads in (0, 2, 7):
            assert np.array_equal(room.combine({"Floor": OAK}, threads=threads), expected)


def test_out():
    """A picture into an array of one's own"""
    with retex.open("room.exr") as room:
        out = np.full((140, 200, 3), 7, np.float32)
        made = room.combine({"Floor": OAK}, out=out)
        assert np.shares_memory(made, out) and np.array_equal(out, room.combine({"Floor": OAK}))
        wrong = [np.zeros((140, 200, 3)), np.zeros((140, 199, 3), np.float32), np.zeros((140, 200, 4), np.float32),
                 np.zeros((140, 400, 3), np.float32)[:, ::2]]
        fixed = np.zeros((140, 200, 3), np.float32)
        fixed.flags.writeable = False
        for array in wrong + [fixed]:
            lib.fails(ValueError, room.combine, out=array)
        assert not fixed.any()


def test_cross():
    """Fewer cross terms"""
    with retex.open("room.exr") as room:
        for cross in (0, 2):
            check(room.combine({"Floor": OAK}, cross=cross),
                  combined("room.exr", "--texture", "Floor=" + OAK, "--cross", str(cross)))


def test_finishes():
    """Finishes: as retex-combine makes them; of a text; unknown ones"""
    lib.run("retex-render", "-q", "--size", "32x24", "--spp", "4", "--full-precision", "-t", "Floor",
            "-t", "Wall", "--finish", "Floor=original,Gloss", lib.ROOT + "/tests/cli/finishes.pov", "-o", "finishes.exr")
    with retex.open("finishes.exr") as room:
        gloss = room.combine({"Floor": TERRAZZO}, finishes={"floor": "gloss"})
        check(gloss, combined("finishes.exr", "--finish", "Floor=Gloss", "--texture", "Floor=" + TERRAZZO))
        assert np.array_equal(gloss, room.combine(f"Floor={TERRAZZO};finish:Floor=Gloss"))
        assert not np.array_equal(gloss, room.combine({"Floor": TERRAZZO}))
        colors = {"Floor": (.5, .6, .7), "Wall": (.8, .2, .6)}
        mean = room.combine(colors, parameters={p["name"]: p.get("kept", p["value"])
                                                for p in room.manifest["parameters"] if p["kind"] == "color"})
        parts = [room.combine(colors, finishes={"Floor": name}) for name in ("original", "Gloss")]
        np.testing.assert_allclose((parts[0] + parts[1]) / 2, mean, rtol=5e-3, atol=1e-4)
        lib.run("make_picture", "gloss.png", "size=16x16", "noise=0.3")
        brick = combined("finishes.exr", "--texture:finish=gloss.png:scale=2", "Floor=" + TERRAZZO)
        for finish in "gloss.png", pathlib.Path("gloss.png"):
            check(room.combine({"Floor": retex.Texture(TERRAZZO, finish=finish, scale=2)}), brick)
        check(room.combine(f"Floor={TERRAZZO};Floor.finish=gloss.png;Floor.scale=2"), brick)
        check(room.combine({"Floor": retex.Texture("tan", finish="gloss.png")}),
              combined("finishes.exr", "--texture:finish=gloss.png", "Floor=tan"))
        assert not np.array_equal(brick, combined("finishes.exr", "--texture:scale=2", "Floor=" + TERRAZZO))
        assert retex.edit_text({"Floor": retex.Texture("tan", finish="none")}) == "Floor=rgb(" + \
            retex.edit_text({"Floor": "tan"}).split("(")[1] + ";Floor.finish=none"
        assert "Wall has no finishes" in str(lib.fails(retex.Error, room.combine,
                                                       {"Wall": retex.Texture("tan", finish="gloss.png")}))
        array = np.full((2, 2, 3), 0.5, np.float32)
        assert np.array_equal(room.combine({"Floor": retex.Texture(array, finish="none")}), room.combine({"Floor": array}))
        for texture, finish in (array, "gloss.png"), ("tan", "a:b.png"), ("tan", ""):
            lib.fails(ValueError, retex.Texture, texture, finish=finish)
        assert "is Gloss meant?" in str(lib.fails(retex.Error, room.combine, finishes={"Floor": "Glos"}))
        assert "has no lamps" in str(lib.fails(retex.Error, room.combine, lights={"Lamp": 1}))
    with retex.open("room.exr") as room:
        assert "--finish" in str(lib.fails(retex.Error, room.combine, finishes={"Floor": "matt"}))


def test_normals():
    """Normal maps: as retex-combine has them; of a text; refused ones"""
    lib.run("retex-render", "-q", "--size", "32x24", "--spp", "4", "-t", "Floor", "-t", "Wall", "--finish",
            "Wall=normals", lib.ROOT + "/tests/cli/finishes.pov", "-o", "normals.exr")
    lib.run("make_picture", "bumps.png", "size=16x16", "noise=0.3")
    with retex.open("normals.exr") as room:
        bumps = combined("normals.exr", "--texture:normal=bumps.png,dx:rotate=30", "Wall=" + TERRAZZO)
        check(room.combine({"Wall": retex.Texture(TERRAZZO, normal="bumps.png,dx", rotate=30)}), bumps)
        check(room.combine(f"Wall={TERRAZZO};Wall.normal=bumps.png,dx;Wall.rotate=30"), bumps)
        check(room.combine({"Wall": retex.Texture("tan", normal=pathlib.Path("bumps.png"))}),
              combined("normals.exr", "--texture:normal=bumps.png", "Wall=tan"))
        assert not np.array_equal(bumps, combined("normals.exr", "--texture:rotate=30", "Wall=" + TERRAZZO))
        assert room.manifest["targets"][1]["normal_tilt"] == 15
        assert "takes no normal maps" in str(lib.fails(retex.Error, room.combine,
                                                       {"Floor": retex.Texture("tan", normal="bumps.png")}))
        assert "there is none to choose" in str(lib.fails(retex.Error, room.combine, finishes={"Wall": "original"}))
        for texture, normal in (np.zeros((2, 2, 3), np.float32), "bumps.png"), ("tan", "a:b.png"), ("tan", ""):
            lib.fails(ValueError, retex.Texture, texture, normal=normal)


def test_lights():
    """Lamps: each alone adds up to the whole; values in all their forms; unknown lamps"""
    lib.run("make_lamp_terms", "room.exr", "lit.exr")
    with retex.open("lit.exr") as room:
        textures = {"Floor": TERRAZZO}
        plain = room.combine(textures)
        lamps = [p["name"] for p in room.manifest["parameters"] if p["kind"] == "color"]
        assert lamps == ["Lamp", "Window", "rest"]
        assert np.array_equal(plain, room.combine(textures, lights={"Lamp": 1}))
        parts = [room.combine(textures, solo=lamp) for lamp in lamps]
        np.testing.assert_allclose(sum(parts), plain, rtol=2e-2, atol=1e-5)
        twice = room.combine(textures, lights={"lamp": 2, "*": 0})
        np.testing.assert_allclose(twice, 2 * parts[0], rtol=1e-5)
        assert np.array_equal(twice, room.combine(textures, solo="Lamp", lights={"Lamp": "2"}))
        assert np.array_equal(twice, room.combine(f"Floor={TERRAZZO};light:Lamp=2;light:*=0"))
        np.testing.assert_allclose(room.combine(lights={"Window": "red"}), room.combine(lights={"Window": (3, 0, 0)}))
        assert "is Lamp meant?" in str(lib.fails(retex.Error, room.combine, lights={"Lmap": 1}))
        lib.fails(retex.Error, room.combine, lights={"Lamp": -1})
        lib.fails(ValueError, room.combine, lights={"Lamp": 1}, parameters={"Lamp": (1, 1, 1)})
    with retex.open("room.exr") as room:
        assert "has no lamps" in str(lib.fails(retex.Error, room.combine, solo="Lamp"))
    assert retex.edit_text("light:b=2*1;Floor=#fff") == "Floor=rgb(1,1,1);light:b=2"


def test_parameters():
    """Parameters: light is linear in a lamp's colour, by colour"""
    lib.run("make_set", "lamp.exr", "40", "30", "lamp:Lamp")
    with retex.open("lamp.exr") as room:
        lamp, = [p for p in room.manifest["parameters"] if p["kind"] == "color"]
        assert lamp["name"] == "Lamp" and lamp["value"] == [1, 0.5, 2]
        textures = {"Floor": TERRAZZO}
        dark = room.combine(textures, parameters={"Lamp": (0, 0, 0)})
        one = room.combine(textures, parameters={"Lamp": (1, 1, 1)})
        assert np.abs(one - dark).max() > 0.01
        for colour in ((1, 0.5, 2), (3, 0, 0.25)):
            picture = room.combine(textures, parameters={"Lamp": colour})
            assert np.allclose(picture, dark + (one - dark) * np.float32(colour), rtol=1e-4, atol=1e-6), colour
        assert np.array_equal(room.combine(textures), room.combine(textures, parameters={"Lamp": (1, 0.5, 2)}))
        for wrong in ({"lamp": (1, 1, 1)}, {"Lamp": (1, 1)}):
            lib.fails(ValueError, room.combine, parameters=wrong)
        assert lib.fails(retex.Error, room.combine, parameters={"Lamp": (1, -1, 1)}).code == retex.Code.EINVAL


def test_error():
    """The expected error"""
    lib.run("retex-combine", "-q", "clusters.exr", "--texture", "Floor=" + OAK, "--error", "error.exr", "-o", "x.exr")
    with retex.open("clusters.exr") as room:
        error = room.error({"Floor": OAK})
        check(error, as_written(lib_read("error.exr")))
        assert error.any()


def test_files():
    """Pictures in files and in memory"""
    with retex.open("room.exr") as room:
        picture = room.combine({"Floor": OAK})
    for name in ("a.png", "a.jpg", "a.exr", "a.tif"):
        lib.run("retex-combine", "-q", "room.exr", "--texture", "Floor=" + OAK, "-o", "expected-" + name)
        retex.write(picture, name)
        with open(name, "rb") as file, open("expected-" + name, "rb") as expected:
            assert file.read() == expected.read() or name == "a.tif", name
    for name in ("a.png", "a.jpg"):
        with open(name, "rb") as file:
            assert retex.encode(picture, name[2:]) == file.read(), name
    lib.run("retex-combine", "-q", "room.exr", "--texture", "Floor=" + OAK, "--depth", "16", "-o", "fine.png")
    with open("fine.png", "rb") as file:
        assert retex.encode(picture, "png", depth=16) == file.read()
    retex.write(picture, "same.png", depth=16)
    assert np.abs(retex.read("same.png")[:, :, :3] - np.clip(picture, 0, 1)).max() < 2e-5
    assert len(retex.encode(picture, "jpg", quality=20)) < len(retex.encode(picture, "jpg"))
    assert np.array_equal(as_written(retex.read("a.exr")[:, :, :3]), as_written(picture))
    assert (retex.read("a.exr")[:, :, 3] == 1).all()
    assert retex.encode(picture[::2, ::3], "png") == retex.encode(picture[::2, ::3].copy(), "png")


def test_denoise_and_pack():
    """Denoising, writing and packing"""
    lib.run("retex-denoise", "-q", "room.exr", "-o", "denoised.exr")
    lib.run("retex-pack", "-q", "denoised.exr", "-o", "denoised.retex")
    with retex.open("room.exr") as room:
        assert room.can_denoise and not room.denoised
        room.denoise()
        assert room.denoised and not room.can_denoise
        check(room.combine({"Floor": OAK}), combined("denoised.exr", "--texture", "Floor=" + OAK))
        room.write("own.exr")
        assert room.pack("own.retex") > 1000
        assert room.pack("fine.retex", lossless=True) > room.pack("own.retex")
    for name in ("own", "denoised"):
        lib.run("retex-info", "--check", name + ".exr")
    with open("own.retex", "rb") as own, open("denoised.retex", "rb") as expected:
        assert own.read() == expected.read()
    check(lib_read("own.exr"), as_written(lib_read("denoised.exr")))


def test_denoise_picture():
    """Denoising pictures of other renderers"""
    generator = np.random.default_rng(1)
    light = np.linspace(0.2, 0.8, 48, dtype=np.float32)[None, :, None] * np.ones((32, 1, 3), np.float32)
    for name in ("first.exr", "second.exr"):
        retex.write(light * generator.exponential(1, light.shape).astype(np.float32), name)
    lib.run("retex-denoise", "-q", "--other-half", "second.exr", "--strength", "2", "first.exr", "-o", "halves.exr")
    lib.run("retex-denoise", "-q", "--quality", "preview", "first.exr", "-o", "alone.exr")
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        retex.denoise_picture("first.exr", "own-halves.exr", other_half="second.exr", strength=2)
        assert not told
        retex.denoise_picture("first.exr", "own-alone.exr", quality="preview", threads=1)
    assert [warning.category for warning in told] == [retex.RetexWarning] and "estimated" in str(told[0].message)
    for name in ("halves.exr", "alone.exr"):
        with open(name, "rb") as expected, open("own-" + name, "rb") as own:
            assert own.read() == expected.read(), name
    error = lib.fails(retex.Error, retex.denoise_picture, "first.exr", "none.exr", layers=["diffuse", "specular"])
    assert "no layer diffuse" in str(error) and not os.path.exists("none.exr")
    lib.fails(retex.Error, retex.denoise_picture, "first.exr", "none.exr", denoiser="oid")


def test_metadata():
    """Targets and the manifest"""
    expected = json.loads(lib.run("retex-info", "--json", "room.exr"))
    with retex.open("room.exr") as room:
        assert (room.width, room.height, room.layout, room.spp) == (200, 140, "paper", 16)
        manifest = room.manifest
        assert all(expected[key] == value for key, value in manifest.items()), "manifest"
        manifest["width"] = 1
        assert room.width == 200
        floor, wall = room.targets
        assert (floor.name, wall.name, floor.idents, floor.share) == ("Floor", "Wall", ("Floor",), 0.4)
        assert floor.mean_albedo == (0.5, 0.375, 0.25) and wall.periodic == (True, False)
        assert floor.uv_min == (0.2, -0.3) and floor.uv_max == (1.7, 0.9)
        assert "Floor, Wall" in repr(room)


lib.main(globals())
