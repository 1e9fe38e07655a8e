"""The C library: where it is, its calls, its errors. interface.py has its structures and calls."""
import ctypes
import enum
import os
import pathlib
import sys
import threading
import warnings
from ctypes import c_void_p
from typing import Any, List, Optional, Tuple

from .interface import CALLS, RetexDenoisePictureParams, RetexError, RetexReadParams

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

def _declare() -> None:
    for name, (arguments, result) in CALLS.items():
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
note = dict(RetexDenoisePictureParams._fields_)["note"](_keep_note)

#: Keeps the library's warnings, which it tells in the calling thread.
warn = dict(RetexReadParams._fields_)["warn"](_keep_warning)


def pass_warnings() -> None:
    """Warn of what the library has told since the last time. Call where an exception does no harm."""
    texts, _told.texts = getattr(_told, "texts", []), []
    level, frame = 1, sys._getframe()
    while frame.f_back and frame.f_globals.get("__package__") == __package__:
        level, frame = level + 1, frame.f_back
    for text in texts:
        warnings.warn(text, RetexWarning, stacklevel=level)
