"""The C library: where it is, its structures and calls, its errors. The public headers in include/retex describe them;
tests/python/test_interface.py compares this file with them."""
import ctypes
import enum
import os
import pathlib
import sys
import threading
import warnings
from ctypes import CFUNCTYPE, POINTER, c_char, c_char_p, c_double, c_float, c_int, c_long, c_size_t, c_uint, c_uint64
from ctypes import c_void_p
from typing import Any, Dict, List, Optional, Tuple

MAX_TARGETS = 8
STRIP = 64  # rows of a picture that are submitted at once
NAME = "libretex.so.2"


class Code(enum.IntEnum):
    """Why a call failed."""

    EINVAL = -1        #: an argument or option is out of its range
    EIO = -2           #: the system refused: no such file, full disk
    EFORMAT = -3       #: the bytes are not what they should be: truncated, damaged, foreign
    ENOMEM = -4        #: no memory
    ENOTFOUND = -5     #: a name that nothing has: target, texture, part
    EUNSUPPORTED = -6  #: understood, but beyond this version
    EPARSE = -7        #: an option with an error in its text
    ELIMIT = -8        #: a budget is used up
    EINTERNAL = -9     #: a broken promise of the library itself
    ESTOPPED = -10     #: the caller asked for it
    EACCESS = -11      #: a file that may not be read
    EPIPE = -12        #: the reader of a pipe has gone


class Error(Exception):
    """A call of the library failed. str() gives the whole text, as the tools print it."""

    def __init__(self, code: int, message: str, file: str = "", line: int = 0, column: int = 0):
        place = f"{file}:{line}:{column}" if file and line and column else f"{file}:{line}" if file and line else file
        super().__init__(f"{place}: {message}" if place else message)
        self.code = Code(code) if code in Code.__members__.values() else Code.EINTERNAL
        self.message = message
        self.file = file
        self.line = line
        self.column = column

    def __reduce__(self) -> Tuple[Any, ...]:
        return type(self), (int(self.code), self.message, self.file, self.line, self.column)


class RetexWarning(UserWarning):
    """What is odd about the colours of a texture, or what is assumed of a picture."""


class RetexError(ctypes.Structure):
    _fields_ = [("code", c_int), ("line", c_int), ("column", c_int), ("file", c_char * 512), ("message", c_char * 1024)]


class RetexImage(ctypes.Structure):
    _fields_ = [("width", c_int), ("height", c_int), ("channels", c_int), ("pixels", POINTER(c_float))]


class RetexRoi(ctypes.Structure):
    _fields_ = [(name, c_int) for name in ("x0", "y0", "x1", "y1", "c0", "c1")]


WARN = CFUNCTYPE(None, c_void_p, c_char_p)


class RetexAdjustment(ctypes.Structure):
    _fields_ = [("kind", c_int), ("value", c_float * 3)]


class RetexTextureLayer(ctypes.Structure):
    _fields_ = [("image", c_char * 256), ("colorspace", c_char * 64), ("scale", c_double * 2), ("rotate", c_double),
                ("offset", c_double * 2), ("width", c_double * 2), ("flip", c_int * 2), ("has_at", c_int),
                ("at", c_double * 2), ("nadjustments", c_int), ("adjustments", RetexAdjustment * 9), ("metric", c_int)]


class RetexTextureSpec(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("target", c_char * 128), ("image", c_char * 1024), ("constant", c_int),
                ("color", c_float * 3), ("scale", c_double * 2), ("rotate", c_double), ("offset", c_double * 2),
                ("wrap", c_int * 2), ("colorspace", c_char * 64), ("flip", c_int * 2), ("repeat", c_int),
                ("width", c_double * 2), ("uv_scale", c_double * 2), ("uv_min", c_double * 2), ("uv_max", c_double * 2),
                ("access", c_void_p), ("warn", WARN), ("warn_context", c_void_p), ("is_light", c_int),
                ("budget", c_void_p), ("periodic", c_int * 2), ("finish", c_char * 1024), ("nfinishes", c_int),
                ("roughness", c_float * 4), ("nadjustments", c_int), ("adjustments", RetexAdjustment * 9),
                ("grout", c_double), ("grout_color", c_float * 3), ("vary", c_int), ("vary_seed", c_uint),
                ("tiles", (c_char * 256) * 8), ("has_at", c_int), ("at", c_double * 2),
                ("normal", c_int), ("normal_tilt", c_double), ("nlayers", c_int),
                ("layers", RetexTextureLayer * 4), ("metric", c_int), ("unit", c_double)]


class RetexReadParams(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("colorspace", c_char_p), ("max_pixels", c_long), ("access", c_void_p),
                ("budget", c_void_p), ("pixel_bytes", c_uint), ("warn", WARN), ("warn_context", c_void_p)]


class RetexWriteParams(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("display", c_char_p), ("view", c_char_p), ("colorspace", c_char_p),
                ("quality", c_int), ("is_data", c_int), ("depth", c_int)]


class RetexDevelop(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("exposure", c_double), ("white_balance", c_double), ("auto_exposure", c_int)]


class RetexCombineParams(ctypes.Structure):
    _fields_ = ([("size", c_size_t)] + [(name, c_int) for name in ("cross", "y0", "y1", "x0", "x1")] +
                [("parameters", POINTER(c_float)), ("terms_only", c_int), ("develop", POINTER(RetexDevelop)),
                 ("kept", c_void_p)])


class RetexCut(ctypes.Structure):
    _fields_ = [(name, c_int) for name in ("x", "y", "width", "height", "scaled_width", "scaled_height")]


class RetexDenoiseParams(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("strength", c_float), ("radius", c_int), ("footprints", c_int), ("scalar", c_int),
                ("progress", c_void_p), ("progress_context", c_void_p), ("near", c_char_p), ("budget", c_void_p),
                ("full_precision", c_int), ("denoiser", c_char_p), ("quality", c_char_p)]


NOTE = CFUNCTYPE(None, c_void_p, c_int, c_char_p)


class RetexDenoisePictureParams(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("layers", POINTER(c_char_p)), ("nlayers", c_int), ("other_half", c_char_p),
                ("variance", c_char_p), ("normal", c_char_p), ("albedo", c_char_p), ("position", c_char_p),
                ("depth", c_char_p), ("access", c_void_p), ("note", NOTE), ("note_context", c_void_p)]


class RetexPackParams(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("quality", c_int), ("lossless", c_int), ("warn", WARN), ("warn_context", c_void_p),
                ("levels", c_int)]


STRUCTURES = (RetexError, RetexImage, RetexRoi, RetexTextureSpec, RetexReadParams, RetexWriteParams, RetexDevelop,
              RetexCombineParams, RetexDenoiseParams, RetexDenoisePictureParams, RetexPackParams)


def _places() -> List[str]:
    asked = os.environ.get("RETEX_LIBRARY")
    if asked:
        return [asked]
    beside = pathlib.Path(__file__).parent / NAME
    return [str(beside)] * beside.exists() + [NAME, "/usr/local/lib/" + NAME]


def _load() -> ctypes.CDLL:
    problems = []
    for place in _places():
        try:
            return ctypes.CDLL(place)
        except OSError as problem:
            problems.append(str(problem))
    raise ImportError(f"retex needs the C library {NAME}, which cannot be loaded ({problems[0]}). Install it, by `make "
                      "install` in retex's sources or as Debian's package libretex2, or name the file in $RETEX_LIBRARY.")


lib = _load()
_libc = ctypes.CDLL(None)
_libc.free.argtypes, _libc.free.restype = [c_void_p], None
free = _libc.free

_handle = POINTER(c_void_p)       # what a call gives through a pointer
_textures = POINTER(c_void_p)     # an array by target
_error = POINTER(RetexError)
_image = POINTER(RetexImage)

#: The arguments of each call but its last one, the error.
CALLS: Dict[str, List[Any]] = {
    "retex_image_alloc": [_image, c_int, c_int, c_int],
    "retex_image_read": [_image, c_char_p, POINTER(RetexReadParams), c_int],
    "retex_image_write": [_image, c_char_p, POINTER(RetexWriteParams), c_int],
    "retex_picture_open_memory": [_handle, c_char_p, c_int, c_int, c_int, POINTER(RetexWriteParams)],
    "retex_picture_rows": [c_void_p, c_int, c_int, c_void_p],
    "retex_picture_take": [_handle, _handle, POINTER(c_size_t)],
    "retex_picture_close": [_handle, c_int],
    "retex_edit_create": [_handle],
    "retex_edit_parse": [c_void_p, c_char_p],
    "retex_edit_set": [c_void_p, c_char_p, c_char_p],
    "retex_edit_solo": [c_void_p, c_char_p],
    "retex_edit_parameters": [c_void_p, c_void_p, POINTER(c_float)],
    "retex_edit_develop": [c_void_p, POINTER(RetexDevelop)],
    "retex_preset_read": [c_void_p, c_char_p],
    "retex_preset_write": [c_void_p, c_char_p],
    "retex_edit_option": [c_void_p, c_char_p, c_char_p],
    "retex_edit_text": [c_void_p, c_int, _handle],
    "retex_edit_options_text": [POINTER(RetexTextureSpec), _handle],
    "retex_color_parse": [POINTER(c_float), c_char_p],
    "retex_texture_create": [_handle, _image, POINTER(RetexTextureSpec), c_int],
    "retex_textures_load": [_textures, c_void_p, POINTER(RetexTextureSpec), c_int, c_int],
    "retex_textures_move": [c_void_p, c_void_p, c_int],
    "retex_set_open": [c_char_p, _handle, _handle, c_int],
    "retex_set_load": [c_void_p, c_int],
    "retex_set_preload": [c_void_p, c_void_p, POINTER(c_int), c_uint64, c_int],
    "retex_set_manifest": [c_void_p, c_void_p, _handle],
    "retex_set_write": [c_void_p, c_void_p, c_char_p, c_void_p, c_int],
    "retex_pack_write": [c_void_p, c_char_p, POINTER(RetexPackParams), POINTER(c_size_t), c_int],
    "retex_cut_fit": [POINTER(RetexCut), c_int, c_int, POINTER(c_int), c_int, c_int],
    "retex_shrink_open": [_handle, POINTER(RetexCut), c_int],
    "retex_shrink_take": [_handle, _image, c_int],
    "retex_denoise": [c_void_p, POINTER(RetexDenoiseParams), POINTER(RetexRoi), c_int],
    "retex_denoise_picture": [c_char_p, c_char_p, POINTER(RetexDenoisePictureParams), POINTER(RetexDenoiseParams),
                              c_int],
    "retex_sample_textures": [_handle, c_void_p, _textures, POINTER(RetexTextureSpec), c_int, c_char_p, c_int],
    "retex_retexture": [c_void_p, c_void_p, _textures, POINTER(RetexCombineParams), c_void_p, c_void_p, c_int],
    "retex_estimate_error": [c_void_p, c_void_p, _textures, POINTER(RetexCombineParams), c_void_p, c_void_p, c_int],
}
#: Calls that cannot fail: arguments and result.
PLAIN: Dict[str, Tuple[List[Any], Any]] = {
    "retex_image_free": ([_image], None),
    "retex_texture_close": ([_handle], None),
    "retex_texture_bytes": ([c_void_p], c_uint64),
    "retex_edit_close": ([_handle], None),
    "retex_edit_count": ([c_void_p], c_int),
    "retex_edit_lights": ([c_void_p], c_int),
    "retex_edit_view": ([c_void_p], c_char_p),
    "retex_edit_texture": ([c_void_p, c_int], POINTER(RetexTextureSpec)),
    "retex_texture_layer_get": ([POINTER(RetexTextureSpec), POINTER(RetexTextureSpec), c_int], None),
    "retex_edit_image_text": ([POINTER(RetexTextureSpec), c_char_p, c_size_t], None),
    "retex_set_close": ([_handle], None),
    "retex_set_find_target": ([c_void_p, c_char_p], c_int),
    "retex_samples_close": ([_handle], None),
    "retex_shrink_close": ([_handle], None),
    "retex_denoise_has_data": ([c_void_p], c_int),
}


def _declare() -> None:
    calls: Dict[str, Tuple[List[Any], Any]] = {name: ([*arguments, _error], c_int) for name, arguments in CALLS.items()}
    for name, (arguments, result) in {**calls, **PLAIN}.items():
        function = getattr(lib, name)
        function.argtypes, function.restype = arguments, result


try:
    _declare()
except AttributeError as missing:
    raise ImportError(f"{lib._name} is of another version than the package retex: {missing}") from None

#: A sink of rows that puts them into an image: C calls C, without Python's lock.
keep_rows = ctypes.cast(lib.retex_image_keep_rows, c_void_p)
#: One that makes them smaller.
shrink_rows = ctypes.cast(lib.retex_shrink_rows, c_void_p)


def call(name: str, *arguments: Any) -> None:
    """Call a function of the library; raise Error if it fails."""
    err = RetexError()
    code = getattr(lib, name)(*arguments, ctypes.byref(err))
    if code:
        raise Error(code, err.message.decode(errors="replace"), err.file.decode(errors="replace"), err.line, err.column)


def path_bytes(path: Any) -> bytes:
    """A path as C takes it."""
    name = os.fsencode(path)
    if b"\0" in name:
        raise ValueError("a path has no zero bytes")
    return name


def text_bytes(text: Optional[str]) -> Optional[bytes]:
    """A text as C takes it; None stays None."""
    if text is not None and "\0" in text:
        raise ValueError("a text has no zero bytes")
    return None if text is None else text.encode()


def threads_of(threads: int) -> int:
    """The number of threads, 0 for all cores."""
    if not 0 <= threads <= 256:
        raise ValueError(f"threads: expected 0 to 256, not {threads}")
    return threads


_told = threading.local()


def _keep_warning(_context: Any, text: bytes) -> None:
    _told.texts = getattr(_told, "texts", []) + [text.decode(errors="replace")]


def _keep_note(context: Any, important: int, text: bytes) -> None:
    if important:
        _keep_warning(context, text)


#: Keeps what matters of the library's notes, as a warning.
note = NOTE(_keep_note)

#: Keeps the library's warnings, which it tells in the calling thread.
warn = WARN(_keep_warning)


def pass_warnings() -> None:
    """Warn of what the library has told since the last time. Call where an exception does no harm."""
    texts, _told.texts = getattr(_told, "texts", []), []
    level, frame = 1, sys._getframe()
    while frame.f_back and frame.f_globals.get("__package__") == __package__:
        level, frame = level + 1, frame.f_back
    for text in texts:
        warnings.warn(text, RetexWarning, stacklevel=level)
