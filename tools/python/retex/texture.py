"""Textures: an image, a colour or an array, and how it is placed on its target."""
import os
from ctypes import byref, c_void_p, sizeof
from typing import Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from .library import Error, Code, RetexTextureSpec, call, path_bytes, text_bytes, threads_of, warn
from .pictures import image_of

#: A file's name; a colour, scene-linear red, green and blue; or an array of rows, texels and 1, 3 or 4 channels.
Source = Union[str, "os.PathLike[str]", Sequence[float], npt.NDArray[np.generic]]
Pair = Union[float, Tuple[float, float]]


def _pair(value: Pair) -> str:
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


class Texture:
    """A texture for a target. All but `image` is as for --texture of retex-sample(1):

    image       a file's name; a colour, three scene-linear numbers; or a numpy array, row 0 at the top: of floats,
                scene-linear; of uint8 or uint16, sRGB from 0 to the highest number, as such files are
    scale       repeats in a unit of UV; a pair for u and v
    rotate      degrees, counter-clockwise
    offset      in repeats of the texture
    flip        "u", "v" or "uv": mirrored
    wrap        "repeat", "mirror", "clamp" or "black"; a pair for u and v
    repeat      "straight", "brick", "half-drop" or "mirror"
    width       of one repeat in scene units; a pair for width and height
    colorspace  of the image, if its file does not say it; arrays have theirs by their type

    An array of floats is not copied until a set uses it: do not change it before."""

    def __init__(self, image: Source, *, scale: Optional[Pair] = None, rotate: Optional[float] = None,
                 offset: Optional[Tuple[float, float]] = None, flip: Optional[str] = None,
                 wrap: Union[str, Tuple[str, str], None] = None, repeat: Optional[str] = None,
                 width: Optional[Pair] = None, colorspace: Optional[str] = None):
        options = {"scale": scale if scale is None else _pair(scale), "rotate": rotate,
                   "offset": offset if offset is None else _pair(offset), "flip": flip,
                   "wrap": ",".join(wrap) if isinstance(wrap, (tuple, list)) else wrap, "repeat": repeat,
                   "width": width if width is None else _pair(width), "colorspace": colorspace}
        self.options = ":".join(f"{name}={value}" for name, value in options.items() if value is not None)
        self.array: Optional[npt.NDArray[np.generic]] = None
        if isinstance(image, (str, os.PathLike)):
            self.image = os.fsdecode(path_bytes(image))
            if not self.image:
                raise ValueError("the name of the image is empty")
            if self.image.startswith("rgb("):  # a file of that name, not a colour
                self.image = "./" + self.image
        elif np.ndim(image) == 1 and len(image) == 3:
            self.image = "rgb({!r},{!r},{!r})".format(*(float(channel) for channel in image))
        elif isinstance(image, np.ndarray):
            self.image, self.array = "an array", _linear(image)
            image_of(self.array)
        else:
            raise TypeError("a texture is a file's name, a colour of three numbers or a numpy array")
        self.spec("a target")

    def __repr__(self) -> str:
        return f"Texture({self.image!r}{', ' + self.options if self.options else ''})"

    @staticmethod
    def of(source: Union[Source, "Texture"]) -> "Texture":
        """The texture itself, or a plain one of that image."""
        return source if isinstance(source, Texture) else Texture(source)

    def spec(self, target: str) -> RetexTextureSpec:
        """Its description for the library, on a target."""
        spec = RetexTextureSpec(sizeof(RetexTextureSpec))
        if "=" in target:
            raise Error(Code.ENOTFOUND, f"there is no target '{target}'")
        argument = b"%s=%s" % (text_bytes(target), os.fsencode(self.image))
        call("retex_texture_spec_parse", byref(spec), text_bytes(self.options), argument)
        spec.warn = warn
        return spec

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
