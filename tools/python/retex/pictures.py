"""Images as numpy arrays that share the library's memory; reading, writing and encoding of pictures."""
import ctypes
import os
import weakref
from ctypes import byref, sizeof
from typing import Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from .interface import RetexDenoiseParams, RetexDenoisePictureParams, RetexImage, RetexReadParams, RetexWriteParams
from .library import STRIP, call, free, lib, note, pass_warnings, path_bytes, text_bytes, threads_of, warn

#: Rows from the top, pixels, channels; scene-linear.
Picture = npt.NDArray[np.float32]
Path = Union[str, "os.PathLike[str]"]


def _free_image(width: int, height: int, channels: int, address: int) -> None:
    image = RetexImage(width, height, channels, ctypes.cast(address, ctypes.POINTER(ctypes.c_float)))
    lib.retex_image_free(byref(image))


def array_of(image: RetexImage) -> Picture:
    """An image's pixels as an array, without a copy. The array owns them: they are freed when neither it nor a view of
    it is left."""
    shape = (image.height, image.width, image.channels)
    address = ctypes.cast(image.pixels, ctypes.c_void_p).value
    assert address is not None
    memory = (ctypes.c_float * (shape[0] * shape[1] * shape[2])).from_address(address)
    # At the end of the process arrays may still be in use, and the memory goes with it.
    weakref.finalize(memory, _free_image, image.width, image.height, image.channels, address).atexit = False
    return np.frombuffer(memory, dtype=np.float32).reshape(shape)


def image_of(array: npt.ArrayLike) -> Tuple[RetexImage, Picture]:
    """An array as an image that borrows its memory: the second value, which must live as long. An array of floats whose
    rows follow each other is not copied. Two dimensions are grey."""
    pixels = np.ascontiguousarray(array, dtype=np.float32)
    if pixels.ndim == 2:
        pixels = pixels[:, :, np.newaxis]
    if pixels.ndim != 3 or pixels.shape[2] not in (1, 3, 4) or not pixels.size:
        raise ValueError(f"a picture has rows, pixels and 1, 3 or 4 channels, not the shape {np.shape(array)}")
    if max(pixels.shape) > 65536:
        raise ValueError("a picture has at most 65536 rows and pixels in a row")
    height, width, channels = pixels.shape
    return RetexImage(width, height, channels, pixels.ctypes.data_as(ctypes.POINTER(ctypes.c_float))), pixels


def _write_params(quality: int, display: Optional[str], view: Optional[str], colorspace: Optional[str],
                  is_data: bool, depth: int) -> RetexWriteParams:
    return RetexWriteParams(size=sizeof(RetexWriteParams), display=text_bytes(display), view=text_bytes(view),
                            colorspace=text_bytes(colorspace), quality=quality, is_data=is_data, depth=depth)


def read(path: Path, *, colorspace: Optional[str] = None, threads: int = 0) -> Picture:
    """Read a picture of any format that OpenImageIO reads: red, green, blue and alpha (not premultiplied),
    scene-linear. `colorspace` overrides what the file states about its colours."""
    image = RetexImage()
    params = RetexReadParams(size=sizeof(RetexReadParams), colorspace=text_bytes(colorspace), pixel_bytes=16, warn=warn)
    call("retex_image_read", byref(image), path_bytes(path), byref(params), threads_of(threads))
    picture = array_of(image)
    pass_warnings()
    return picture


def write(picture: npt.ArrayLike, path: Path, *, quality: int = 95, display: Optional[str] = None,
          view: Optional[str] = None, colorspace: Optional[str] = None, is_data: bool = False, depth: int = 0,
          threads: int = 0) -> None:
    """Write a picture; its format follows the name's ending. 8- and 16-bit formats go through the display's curve, or
    `display`, `view` or `colorspace` of the OpenColorIO config; float formats stay scene-linear. `depth` is 8 or 16
    bits for a PNG or another file of integers, 0 for what the format usually has. The file is complete or not there."""
    image, _pixels = image_of(picture)
    params = _write_params(quality, display, view, colorspace, is_data, depth)
    call("retex_image_write", byref(image), path_bytes(path), byref(params), threads_of(threads))


def encode(picture: npt.ArrayLike, format: str = "png", *, quality: int = 95,  # pylint: disable=redefined-builtin
           display: Optional[str] = None, view: Optional[str] = None, colorspace: Optional[str] = None,
           depth: int = 0) -> bytes:
    """The bytes of the file that write() would make; `format` is the ending of its name, such as "jpg"."""
    image, pixels = image_of(picture)
    params = _write_params(quality, display, view, colorspace, False, depth)
    handle, data, size = ctypes.c_void_p(), ctypes.c_void_p(), ctypes.c_size_t()
    call("retex_picture_open_memory", byref(handle), text_bytes(format), image.width, image.height, image.channels,
         byref(params))
    try:
        for row in range(0, image.height, STRIP):
            rows = pixels[row:row + STRIP]
            call("retex_picture_rows", handle, row, row + rows.shape[0],
                 rows.ctypes.data_as(ctypes.POINTER(ctypes.c_float)))
        call("retex_picture_take", byref(handle), byref(data), byref(size))
        return ctypes.string_at(data, size.value)
    finally:
        free(data)
        if handle:
            lib.retex_picture_close(byref(handle), 0, None)


def denoise_picture(path: Path, output: Path, *, layers: Sequence[str] = (), other_half: Optional[Path] = None,
                    variance: Optional[str] = None, normal: Optional[str] = None, albedo: Optional[str] = None,
                    position: Optional[str] = None, depth: Optional[str] = None, strength: float = 1, radius: int = 5,
                    denoiser: str = "nlm", quality: str = "final", threads: int = 0) -> None:
    """Remove the noise from an EXR file of any renderer into another one, as retex-denoise(1) does with pictures that
    are no sets. `layers` are denoised, by default the picture; all other channels stay. The noise is that between the
    file and `other_half`, a second render of the frame, or the layer `variance`, or else it is estimated, with a
    RetexWarning. The guides `normal`, `albedo`, `position` and `depth` are layers; by default those of well known
    names."""
    names = (ctypes.c_char_p * len(layers))(*[text_bytes(layer) for layer in layers])
    picture = RetexDenoisePictureParams(
        size=sizeof(RetexDenoisePictureParams), layers=names, nlayers=len(layers),
        other_half=None if other_half is None else path_bytes(other_half), variance=text_bytes(variance),
        normal=text_bytes(normal), albedo=text_bytes(albedo), position=text_bytes(position), depth=text_bytes(depth),
        note=note)
    params = RetexDenoiseParams(size=sizeof(RetexDenoiseParams), strength=strength, radius=radius, footprints=1,
                                denoiser=text_bytes(denoiser), quality=text_bytes(quality))
    call("retex_denoise_picture", path_bytes(path), path_bytes(output), byref(picture), byref(params),
         threads_of(threads))
    pass_warnings()
