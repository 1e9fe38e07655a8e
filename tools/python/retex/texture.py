"""Textures: an image, a colour or an array, and how it is placed on its target."""
import contextlib
import ctypes
import os
from ctypes import byref, c_float, c_void_p
from typing import Any, Dict, Iterator, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from .interface import RetexDevelop, RetexTextureSpec
from .library import Code, Error, call, free, lib, path_bytes, text_bytes, threads_of, warn
from .pictures import image_of

#: A file's name or a colour as text; a colour, scene-linear red, green and blue; or an array of rows, texels and 1, 3 or
#: 4 channels.
Source = Union[str, "os.PathLike[str]", Sequence[float], npt.NDArray[np.generic]]
Pair = Union[float, Tuple[float, float]]
Color = Union[str, Tuple[float, float, float]]
Adjustment = Union[float, Color]
ADJUSTMENTS = ("hue", "saturation", "gain", "gamma", "contrast", "blur", "invert", "tint", "colorize")


def _pair(value: Union[Pair, str]) -> str:
    if isinstance(value, str):
        return value
    return ",".join(f"{float(number)!r}" for number in (value if isinstance(value, (tuple, list)) else (value,)))


def _linear(array: npt.NDArray[np.generic]) -> npt.NDArray[np.generic]:
    """Integers of 8 and 16 bits decoded by the curve of sRGB (IEC 61966-2-1), alpha without it; others as they are."""
    if array.dtype not in (np.uint8, np.uint16):
        return array
    codes = np.linspace(0, 1, int(np.iinfo(array.dtype).max) + 1)
    curve = np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055)**2.4).astype(np.float32)
    texels = curve[array]
    if array.ndim == 3 and array.shape[2] == 4:
        texels[:, :, 3] = codes[array[:, :, 3]]
    return texels


def _numbers(value: Adjustment) -> str:
    return ",".join(repr(float(x)) for x in value) if isinstance(value, (tuple, list)) else str(value)


def _color(color: Adjustment) -> str:
    return "rgb({})".format(_numbers(color)) if isinstance(color, (tuple, list)) else str(color)


def _tile(tile: Union[str, "os.PathLike[str]"]) -> str:
    name = os.fsdecode(path_bytes(tile))
    if not name or ":" in name or "," in name:
        raise ValueError(f"tiles: expected pictures without a colon or comma in their names, not {name!r}")
    return name


def _map(option: str, file: Union[str, "os.PathLike[str]"]) -> str:
    """The name of a map of finishes or normals; a path that is called none is a file."""
    name = os.fsdecode(path_bytes(file))
    if not name or ":" in name:
        raise ValueError(f"{option}: expected a picture without a colon in its name, not {name!r}")
    return "./" + name if isinstance(file, os.PathLike) and name == "none" else name


def _is_color(text: str) -> bool:
    try:
        call("retex_color_parse", (c_float * 3)(), os.fsencode(text))
    except Error as error:
        return error.code != Code.ENOTFOUND
    return True


@contextlib.contextmanager
def _edit() -> Iterator[c_void_p]:
    """An edit of the library, for a while."""
    edit = c_void_p()
    call("retex_edit_create", byref(edit))
    try:
        yield edit
    finally:
        lib.retex_edit_close(byref(edit))


def _take_text(name: str, *arguments: Any) -> str:
    """The text that a call makes."""
    made = c_void_p()
    call(name, *arguments, byref(made))
    try:
        return os.fsdecode(ctypes.string_at(made))
    finally:
        free(made)


class Texture:
    """A texture for a target. All but `image` is as for --texture of retex-sample(1):

    image       the name of a file, or of a folder with a base colour, or a colour, as in retex-edit(5): "oak.jpg",
                "oak_2k/", "#f80", "tomato"; a pathlib.Path, always a file or folder; a colour of three scene-linear
                numbers; or a numpy array, row 0 at the top: of floats, scene-linear; of uint8 or uint16, sRGB from 0 to
                the highest number, as such files are
    scale       repeats in a unit of UV; a pair for u and v
    rotate      degrees, counter-clockwise
    offset      in repeats of the texture
    flip        "u", "v" or "uv": mirrored
    wrap        "repeat", "mirror", "clamp" or "black"; a pair for u and v
    repeat      "straight", "brick", "half-drop" or "mirror"
    width       of one repeat in scene units, or text with units: "60cm"; a pair, or "60cm,9cm", for width and height
    colorspace  of the image, if its file does not say it; arrays have theirs by their type
    finish      the name of a picture that says which finish of the target is where; "none": the roughness of a folder
                says nothing. Not of arrays
    normal      the name of a normal map, for a target that takes one: "wall.png", "wall.png,dx" where green points down;
                "none": that of a folder is not used. Not of arrays, nor beside finish
    grout       width of joints between repeats, in scene units, or "4mm"; groutcolor: a colour
    vary        what differs from repeat to repeat: "turn,flip,shift" or some of them, and a number
    tiles       names of more images for the repeats
    at          where the middle of the image lies, in scene units with a width, or "1.2m,40cm", else in UV

    hue, saturation, gain, gamma, contrast, blur, invert, tint and colorize adjust colours one after the other, in the
    order in which they are given; `invert` is "yes", `tint` and `colorize` are colours.

    An array of floats is not copied until a set uses it: do not change it before."""

    def __init__(self, image: Source, *, scale: Optional[Pair] = None, rotate: Optional[float] = None,
                 offset: Optional[Tuple[float, float]] = None, flip: Optional[str] = None,
                 wrap: Union[str, Tuple[str, str], None] = None, repeat: Optional[str] = None,
                 width: Union[Pair, str, None] = None, colorspace: Optional[str] = None,
                 finish: Union[str, "os.PathLike[str]", None] = None,
                 normal: Union[str, "os.PathLike[str]", None] = None, grout: Union[float, str, None] = None,
                 groutcolor: Optional[Color] = None, vary: Optional[str] = None,
                 tiles: Optional[Sequence[Union[str, "os.PathLike[str]"]]] = None,
                 at: Union[Tuple[float, float], str, None] = None, **adjustments: Adjustment):
        options = {"scale": scale if scale is None else _pair(scale), "rotate": rotate,
                   "offset": offset if offset is None else _pair(offset), "flip": flip,
                   "wrap": ",".join(wrap) if isinstance(wrap, (tuple, list)) else wrap, "repeat": repeat,
                   "width": width if width is None else _pair(width), "colorspace": colorspace,
                   "finish": finish if finish is None else _map("finish", finish),
                   "normal": normal if normal is None else _map("normal", normal), "grout": grout,
                   "groutcolor": groutcolor if groutcolor is None else _color(groutcolor), "vary": vary,
                   "tiles": tiles if tiles is None else ",".join(_tile(tile) for tile in tiles),
                   "at": at if at is None else _pair(at)}
        for name, value in adjustments.items():
            if name not in ADJUSTMENTS:
                raise TypeError(f"a texture has no {name!r}")
            options[name] = _color(value) if name in ("tint", "colorize") else _numbers(value)
        self.options = ":".join(f"{name}={value}" for name, value in options.items() if value is not None)
        self.array: Optional[npt.NDArray[np.generic]] = None
        if isinstance(image, (str, os.PathLike)):
            self.image = os.fsdecode(path_bytes(image))
            if not self.image:
                raise ValueError("the name of the image is empty")
            if isinstance(image, os.PathLike) and _is_color(self.image):
                self.image = "./" + self.image
        elif np.ndim(image) == 1 and len(image) == 3:
            self.image = "rgb({!r},{!r},{!r})".format(*(float(channel) for channel in image))
        elif isinstance(image, np.ndarray):
            if finish not in (None, "none") or normal not in (None, "none"):
                raise ValueError("an array has no map of finishes or normals: write it to a file")
            self.image, self.array = "an array", _linear(image)
            image_of(self.array)
        else:
            raise TypeError("a texture is a file's name, a colour of three numbers or a numpy array")
        self.spec("a target")

    def __repr__(self) -> str:
        return f"Texture({self.image!r}{', ' + self.options if self.options else ''})"

    @classmethod
    def _of_spec(cls, spec: RetexTextureSpec) -> "Texture":
        image = ctypes.create_string_buffer(ctypes.sizeof(spec))
        lib.retex_edit_image_text(byref(spec), image, len(image))
        texture = cls((0, 0, 0))
        texture.image, texture.options = os.fsdecode(image.value), _take_text("retex_edit_options_text", byref(spec))
        return texture

    @staticmethod
    def of(source: Union[Source, "Texture"]) -> "Texture":
        """The texture itself, or a plain one of that image."""
        return source if isinstance(source, Texture) else Texture(source)

    def spec(self, target: str) -> RetexTextureSpec:
        """Its description for the library, on a target."""
        spec = RetexTextureSpec()
        with _edit() as edit:
            self._add(edit, target)
            ctypes.pointer(spec)[0] = lib.retex_edit_texture(edit, 0)[0]
        spec.warn = warn
        return spec

    def _add(self, edit: c_void_p, target: str) -> None:
        if "=" in target:
            raise Error(Code.ENOTFOUND, f"there is no target '{target}'")
        argument = b"%s=%s" % (text_bytes(target), os.fsencode(self.image))
        call("retex_edit_option", edit, text_bytes(self.options), argument)

    def key(self) -> Tuple[str, str, int]:
        """Equal for textures that look the same, as long as no file changes."""
        return self.image, self.options, id(self.array) if self.array is not None else 0

    def create(self, target: str, threads: int) -> c_void_p:
        """Make the texture of an array."""
        assert self.array is not None
        image, _pixels = image_of(self.array)
        handle, spec = c_void_p(), self.spec(target)
        spec.uv_scale[:] = 1, 1  # until it is put on the surface
        call("retex_texture_create", byref(handle), byref(image), byref(spec), threads_of(threads))
        return handle


#: New textures by the names of their targets; or the text of an edit.
Textures = Union[Mapping[str, Union[Source, Texture]], str]


def parse_edit(text: str) -> Dict[str, Texture]:
    """The textures of an edit, by target: of a text as in retex-edit(5), "Floor=oak.jpg;Floor.scale=2,1;Wall=tomato".
    Layers have keys such as "over:Floor", as they have where textures are given. Its lamps, finishes and what it says of
    the picture are left out."""
    with _edit() as edit:
        call("retex_edit_parse", edit, path_bytes(text))
        specs = [lib.retex_edit_texture(edit, index)[0] for index in range(lib.retex_edit_count(edit))]
        textures: Dict[str, Texture] = {}
        for spec in specs:
            target = os.fsdecode(spec.target)
            if spec.image or spec.constant:
                alone = RetexTextureSpec.from_buffer_copy(spec)
                alone.nlayers = 0
                textures[target] = Texture._of_spec(alone)
            for index in range(spec.nlayers):
                layer = RetexTextureSpec(size=ctypes.sizeof(RetexTextureSpec))
                lib.retex_texture_layer_get(byref(layer), byref(spec), index)
                textures[f"over{index + 1 if index else ''}:{target}"] = Texture._of_spec(layer)
        return textures


#: A lamp's new value: a number that multiplies it, a colour of three numbers, or text, as in retex-edit(5).
Light = Union[float, str, Sequence[float]]


def _light_text(value: Light) -> str:
    if isinstance(value, str):
        return value
    if np.ndim(value) == 0:
        return repr(float(value))  # type: ignore[arg-type]
    red, green, blue = (float(channel) for channel in value)  # type: ignore[union-attr]
    return f"rgb({red!r},{green!r},{blue!r})"


def _say(edit: c_void_p, textures: Optional[Textures], *, lights: Optional[Mapping[str, Light]] = None,
         solo: Optional[str] = None, finishes: Optional[Mapping[str, str]] = None, exposure: Optional[float] = None,
         white_balance: Optional[float] = None, auto_exposure: bool = False, view: Optional[str] = None) -> None:
    """Add to an edit what is said beside textures, and the text of an edit."""
    if isinstance(textures, str):
        call("retex_edit_parse", edit, path_bytes(textures))
    said = {"exposure": exposure if exposure is None else repr(float(exposure)),
            "white-balance": white_balance if white_balance is None else repr(float(white_balance)),
            "auto-exposure": "yes" if auto_exposure else None, "view": view}
    for lamp, value in (lights or {}).items():
        call("retex_edit_set", edit, b"light:" + text_bytes(lamp), text_bytes(_light_text(value)))
    for target, finish in (finishes or {}).items():
        call("retex_edit_set", edit, b"finish:" + text_bytes(target), text_bytes(finish))
    if solo is not None:
        call("retex_edit_solo", edit, text_bytes(solo))
    for key, text in said.items():
        if text is not None:
            call("retex_edit_set", edit, b"picture:" + key.encode(), text_bytes(text))


def parameters_of(pointer: c_void_p, count: int, textures: Optional[Textures], **said: Any) -> Any:
    """What lamps, finishes and the rest of an edit make of a picture: the values of the set's parameters as C takes them,
    None as rendered; and how it is developed."""
    develop = RetexDevelop(ctypes.sizeof(RetexDevelop))
    with _edit() as edit:
        _say(edit, textures, **said)
        call("retex_edit_develop", edit, byref(develop))
        if not lib.retex_edit_lights(edit):
            return None, develop
        values = (ctypes.c_float * max(3 * count, 1))()
        call("retex_edit_parameters", edit, pointer, values)
        return values, develop


@contextlib.contextmanager
def _edit_of(textures: Optional[Textures], **said: Any) -> Iterator[c_void_p]:
    with _edit() as edit:
        _say(edit, textures, **said)
        for target, source in ({} if isinstance(textures, str) else textures or {}).items():
            texture = Texture.of(source)
            if texture.array is not None:
                raise ValueError(f"{target}: an array cannot be written as text")
            texture._add(edit, target)
        yield edit


def edit_text(textures: Optional[Textures] = None, **said: Any) -> str:
    """The canonical text of an edit, which is the same for textures that look the same, however they were written. An
    array has none. Further arguments are those of Set.combine(): lights, solo, finishes, exposure, white_balance,
    auto_exposure; and `view`, that of write()."""
    with _edit_of(textures, **said) as edit:
        return _take_text("retex_edit_text", edit, ord(";"))


def edit_view(text: str) -> Optional[str]:
    """The view that the text of an edit names, for write() and encode(); or None."""
    with _edit_of(text) as edit:
        view = lib.retex_edit_view(edit)
        return None if view is None else os.fsdecode(view)


def load_preset(path: Union[str, "os.PathLike[str]"]) -> str:
    """The edit of a preset, as save_preset() and retex-combine --save-preset write them: a text for Set.combine(),
    Set.batch() and edit_view()."""
    with _edit() as edit:
        call("retex_preset_read", edit, path_bytes(path))
        return _take_text("retex_edit_text", edit, ord(";"))


def save_preset(path: Union[str, "os.PathLike[str]"], textures: Optional[Textures] = None, **said: Any) -> None:
    """Write an edit as a preset; its arguments are those of edit_text(). Names of images are written from the folder of
    the preset, so that it may be moved together with them. The file is complete or not there."""
    with _edit_of(textures, **said) as edit:
        call("retex_preset_write", edit, path_bytes(path))
