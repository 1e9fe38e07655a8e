"""Sets and packs: their targets, textures laid on them, pictures, batches, denoising and packing."""
import contextlib
import copy
import ctypes
import json
import threading
import weakref
from collections import OrderedDict
from ctypes import byref, c_float, c_int, c_void_p, sizeof
from dataclasses import dataclass
from types import TracebackType
from typing import Any, Dict, Iterable, Iterator, List, Mapping, NoReturn, Optional, Sequence, Tuple, Type, Union

import numpy as np

from .interface import RetexCombineParams, RetexCut, RetexDenoiseParams, RetexImage, RetexPackParams, RetexTextureSpec
from .library import MAX_TARGETS, Code, Error, call, free, keep_rows, lib, pass_warnings, path_bytes, shrink_rows
from .library import text_bytes, threads_of, warn
from .pictures import Path, Picture, array_of, image_of
from .texture import Light, Texture, Textures, parameters_of, parse_edit

Crop = Tuple[int, int, int, int]
Size = Tuple[Optional[int], Optional[int]]
MEGABYTE = 1 << 20


@dataclass(frozen=True)
class Target:
    """A surface, or several, whose texture may be replaced."""

    name: str
    idents: Tuple[str, ...]               #: the scene's identifiers that it was made of
    share: float                          #: of the picture's pixels, whose centre sees it directly; 0 to 1
    mean_albedo: Tuple[float, float, float]  #: of the original texture, scene-linear
    periodic: Tuple[bool, bool]           #: the surface closes in u, in v
    uv_min: Tuple[float, float]           #: range of UV that was met
    uv_max: Tuple[float, float]
    uv_scale: Tuple[float, float]         #: scene units that a unit of u and of v spans; 0: unknown


class _Lock:
    """Many may read at the same time; who changes something is alone."""

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._readers = 0
        self._writer = False

    @contextlib.contextmanager
    def shared(self) -> Iterator[None]:
        with self._changed:
            self._changed.wait_for(lambda: not self._writer)
            self._readers += 1
        try:
            yield
        finally:
            with self._changed:
                self._readers -= 1
                self._changed.notify_all()

    @contextlib.contextmanager
    def exclusive(self) -> Iterator[None]:
        with self._changed:
            self._changed.wait_for(lambda: not self._writer)
            self._writer = True
            self._changed.wait_for(lambda: not self._readers)
        try:
            yield
        finally:
            with self._changed:
                self._writer = False
                self._changed.notify_all()


def _close(name: str, address: Optional[int]) -> None:
    getattr(lib, name)(byref(c_void_p(address)))


class _Handle:
    """Something of the library that is closed when nobody has it any more."""

    def __init__(self, handle: c_void_p, close: str):
        self.pointer = handle
        self._finalizer = weakref.finalize(self, _close, close, handle.value)
        self._finalizer.atexit = False

    def close(self) -> None:
        self._finalizer()

    def __reduce__(self) -> NoReturn:
        raise TypeError("what the library keeps in memory cannot be pickled: write it to a file")


class _TextureCache:
    """Loaded textures of a batch, by target and texture, the last ones used up to a number of bytes."""

    def __init__(self, most_bytes: int):
        self._loaded: "OrderedDict[Any, Tuple[_Handle, int, Texture]]" = OrderedDict()
        self._most = most_bytes
        self._bytes = 0

    def get(self, key: Any) -> Optional[_Handle]:
        if key not in self._loaded:
            return None
        self._loaded.move_to_end(key)
        return self._loaded[key][0]

    def put(self, key: Any, handle: _Handle, texture: Texture) -> None:
        size = lib.retex_texture_bytes(handle.pointer)
        self._loaded[key] = handle, size, texture  # the texture keeps its array, whose id is in the key
        self._bytes += size
        while self._bytes > self._most:
            self._bytes -= self._loaded.popitem(last=False)[1][1]


class Set:
    """A set, or a pack: what one render leaves for retexturing. open() opens one; close() or `with` closes it."""

    def __init__(self, handle: c_void_p):
        """For open()."""
        self._lock = _Lock()
        self._handle = _Handle(handle, "retex_set_close")
        self._closed = False
        self._read_manifest()

    def _read_manifest(self) -> None:
        text = c_void_p()
        call("retex_set_manifest", self._handle.pointer, byref(text))
        try:
            self._manifest: Dict[str, Any] = json.loads(ctypes.string_at(text))
        finally:
            free(text)

    def close(self) -> None:
        """Free its memory and close its file. Pictures made of it stay."""
        with self._lock.exclusive():
            self._closed = True
            self._handle.close()

    def __enter__(self) -> "Set":
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        self.close()

    def __reduce__(self) -> NoReturn:  # of pickle and copy: two sets would close one handle
        raise TypeError("a set cannot be pickled or copied: open its file again")

    def __repr__(self) -> str:
        names = ", ".join(target.name for target in self.targets)
        return f"<retex.Set {self.width}x{self.height}, {self.layout}, targets: {names or 'none'}>"

    @property
    def manifest(self) -> Dict[str, Any]:
        """All that the set says about itself: a copy of its manifest, see retex-set(5)."""
        return copy.deepcopy(self._manifest)

    @property
    def width(self) -> int:
        """Pixels in a row."""
        return int(self._manifest["width"])

    @property
    def height(self) -> int:
        """Rows."""
        return int(self._manifest["height"])

    @property
    def layout(self) -> str:
        """'footprints', 'paper', or 'plain': a picture only."""
        return str(self._manifest["layout"])

    @property
    def spp(self) -> int:
        """Samples per pixel."""
        return int(self._manifest["spp"])

    @property
    def denoised(self) -> bool:
        """Whether its noise was removed."""
        return bool(self._manifest["denoised"])

    @property
    def targets(self) -> List[Target]:
        """The targets, in their order."""
        def pair(target: Dict[str, Any], name: str) -> Tuple[float, float]:
            first, second = target.get(name, (0.0, 0.0))
            return float(first), float(second)

        def colour(red: float, green: float, blue: float) -> Tuple[float, float, float]:
            return red, green, blue

        def both(u: bool, v: bool) -> Tuple[bool, bool]:
            return u, v

        return [Target(name=target["name"], idents=tuple(filter(None, target["idents"].split(","))),
                       share=target["share"], mean_albedo=colour(*target["mean_albedo"]),
                       periodic=both(*target["periodic"]), uv_min=pair(target, "uv_min"),
                       uv_max=pair(target, "uv_max"), uv_scale=pair(target, "uv_scale"))
                for target in self._manifest["targets"]]

    @property
    def can_denoise(self) -> bool:
        """Whether the set has the data that denoise() reads."""
        with self._shared() as pointer:
            return bool(lib.retex_denoise_has_data(pointer))

    @contextlib.contextmanager
    def _shared(self) -> Iterator[c_void_p]:
        with self._lock.shared():
            self._check_open()
            yield self._handle.pointer

    @contextlib.contextmanager
    def _exclusive(self) -> Iterator[c_void_p]:
        with self._lock.exclusive():
            self._check_open()
            yield self._handle.pointer

    def _check_open(self) -> None:
        if self._closed:
            raise ValueError("the set is closed")

    # ---- textures ----

    def _load(self, pointer: c_void_p, name: str, texture: Texture, threads: int) -> _Handle:
        """Load a texture for a target. An array takes the place of a colour, by which the target is checked."""
        loaded: Any = (c_void_p * MAX_TARGETS)()
        array = texture.array is not None
        spec = (Texture((0, 0, 0)) if array else texture).spec(name)
        specs = (RetexTextureSpec * 1)(spec)
        target = lib.retex_set_find_target(pointer, text_bytes(name))
        try:
            call("retex_textures_load", loaded, pointer, specs, 1, threads)
            if not array:
                handle, loaded[target] = c_void_p(loaded[target]), None
                return _Handle(handle, "retex_texture_close")
        finally:
            for address in loaded:
                if address:
                    _close("retex_texture_close", address)
        made = _Handle(texture.create(name, threads), "retex_texture_close")
        call("retex_textures_move", made.pointer, pointer, target)
        return made

    def _textures(self, pointer: c_void_p, textures: Optional[Textures], threads: int,
                  cache: Optional[_TextureCache] = None) -> Tuple[Any, List[_Handle], List[RetexTextureSpec]]:
        """Textures by target for the library; what keeps them; and their descriptions."""
        by_target = (c_void_p * MAX_TARGETS)()
        kept, specs = [], []
        for name, source in (parse_edit(textures) if isinstance(textures, str) else textures or {}).items():
            texture = Texture.of(source)
            target = lib.retex_set_find_target(pointer, text_bytes(name))
            key = target, texture.key()
            if target >= 0 and by_target[target]:
                raise Error(Code.EINVAL, f"target {self.targets[target].name} is given two textures")
            handle = cache.get(key) if cache else None
            if not handle:
                handle = self._load(pointer, name, texture, threads)
                if cache:
                    cache.put(key, handle, texture)
            by_target[target] = handle.pointer
            kept.append(handle)
            specs.append(texture.spec(name))
        pass_warnings()
        return by_target, kept, specs

    def lay(self, textures: Textures, *, threads: int = 0) -> None:
        """Lay textures on the set, for several pictures or for a file: they are filtered once, and targets have them
        in every picture to which no others are given. Other textures of these targets go."""
        threads_of(threads)
        with self._exclusive() as pointer:
            by_target, _kept, specs = self._textures(pointer, textures, threads)
            call("retex_sample_textures", pointer, by_target, (RetexTextureSpec * len(specs))(*specs), len(specs), b"-",
                 threads)
            self._read_manifest()

    def lay_samples(self, path: Path, *, threads: int = 0) -> None:
        """Lay on the set what is in a file that write_samples() or retex-sample made."""
        samples = c_void_p()
        call("retex_set_open_any", path_bytes(path), byref(samples), threads_of(threads))
        try:
            with self._exclusive() as pointer:
                call("retex_set_lay", pointer, samples)
                self._read_manifest()
        finally:
            lib.retex_set_close(byref(samples))

    def lift(self, target: Optional[str] = None) -> None:
        """Take the texture off a target that lay() laid there, or all of them: it has its original again."""
        with self._exclusive() as pointer:
            number = -1 if target is None else lib.retex_set_find_target(pointer, text_bytes(target))
            if target is not None and number < 0:
                raise Error(Code.ENOTFOUND, f"the set has no target {target!r}")
            lib.retex_set_lift(pointer, number)
            self._read_manifest()

    # ---- pictures ----

    def _parameters(self, given: Optional[Mapping[str, Sequence[float]]]) -> Any:
        """All parameters' values as C takes them; None: as rendered."""
        if not given:
            return None
        values = {parameter["name"]: parameter["value"] for parameter in self.manifest["parameters"]
                  if parameter["kind"] != "correction"}
        unknown = sorted(set(given) - set(values))
        if unknown:
            raise ValueError(f"parameters: the set has no {unknown[0]!r}; it has {sorted(values)}")
        numbers = [float(x) for parameter in self.manifest["parameters"]
                   for x in given.get(parameter["name"], parameter["value"])]
        if len(numbers) != 3 * len(self.manifest["parameters"]):
            raise ValueError("parameters: each takes three numbers")
        return (c_float * len(numbers))(*numbers)

    def _cut(self, crop: Optional[Crop], size: Optional[Size]) -> RetexCut:
        x, y, width, height = crop or (0, 0, self.width, self.height)
        if x < 0 or y < 0 or width < 1 or height < 1 or x + width > self.width or y + height > self.height:
            raise ValueError(f"crop: {crop} is not within the picture's {self.width}x{self.height} pixels")
        if size and (any(side is not None and side < 1 for side in size) or not any(size)):
            raise ValueError(f"size: {size} has no pixels")
        cut = RetexCut()
        call("retex_cut_fit", byref(cut), self.width, self.height, (c_int * 4)(x, y, width, height),
             *(side or 0 for side in size or (0, 0)))
        return cut

    def _make(self, what: str, textures: Optional[Textures], crop: Optional[Crop], cross: int,
              out: Optional[Picture], threads: int, cache: Optional[_TextureCache] = None,
              parameters: Optional[Mapping[str, Sequence[float]]] = None, size: Optional[Size] = None,
              **said: Any) -> Picture:
        threads_of(threads)
        if size and out is not None:
            raise ValueError("out and size exclude each other")
        with self._shared() as pointer:
            values, develop = parameters_of(pointer, len(self.manifest["parameters"]), textures, **said)
            if values is not None and parameters:
                raise ValueError("parameters and lights or finishes exclude each other")
            cut = self._cut(crop, size)
            params = RetexCombineParams(
                size=sizeof(RetexCombineParams), cross=cross, y0=cut.y, y1=cut.y + cut.height, x0=cut.x,
                x1=cut.x + cut.width, parameters=values if values is not None else self._parameters(parameters),
                develop=ctypes.pointer(develop))
            by_target, _kept, _specs = self._textures(pointer, textures, threads, cache)
            arguments = pointer, by_target, byref(params)
            if size:
                return self._shrunk(what, arguments, cut, threads)
            if out is None:
                image = RetexImage()
                call("retex_image_alloc", byref(image), self.width, self.height, 3)
                out = array_of(image)
            else:
                image, borrowed = image_of(out)
                if borrowed is not out or out.shape != (self.height, self.width, 3) or not out.flags.writeable:
                    raise ValueError(f"out: expected a writable array of float32, {self.height} x {self.width} x 3, "
                                     "row after row")
            call(what, *arguments, keep_rows, ctypes.addressof(image), threads)
            return out[cut.y:cut.y + cut.height, cut.x:cut.x + cut.width]

    def _shrunk(self, what: str, arguments: Tuple[Any, ...], cut: RetexCut, threads: int) -> Picture:
        shrink, image = c_void_p(), RetexImage()
        call("retex_shrink_open", byref(shrink), byref(cut), self.width)
        try:
            call(what, *arguments, shrink_rows, shrink, threads)
            call("retex_shrink_take", byref(shrink), byref(image), threads)
        finally:
            lib.retex_shrink_close(byref(shrink))
        return array_of(image)

    def combine(self, textures: Optional[Textures] = None, *,
                lights: Optional[Mapping[str, Light]] = None, solo: Optional[str] = None,
                finishes: Optional[Mapping[str, str]] = None, exposure: Optional[float] = None,
                white_balance: Optional[float] = None, auto_exposure: bool = False,
                parameters: Optional[Mapping[str, Sequence[float]]] = None, crop: Optional[Crop] = None,
                size: Optional[Size] = None, cross: int = 3, out: Optional[Picture] = None, threads: int = 0) -> Picture:
        """Make a picture: red, green and blue, scene-linear. Targets without a texture keep what lay() laid on
        them, or their own.

        textures  by target: a file's name, a colour, an array, or a Texture; or the text of an edit
        lights    new values by lamp: a number that multiplies its light, a colour, which keeps its luminance, or text,
                  as in retex-edit(5): "3000K", "1.5*#ffd0a0"; "*" is all lamps that are not named
        solo      turn off all lamps but this one and those of `lights`
        finishes  names of finishes that the set has, by target
        exposure  stops: the picture is 2**exposure times as bright
        white_balance  kelvins: what light of this colour does to white becomes white
        auto_exposure  True: first bring the picture's log-average brightness to 0.18
        parameters  by name, such as that of a lamp: three numbers each; others stay as rendered
        crop      x, y, width, height: make only this part, and return it
        size      width, height of the picture, or of its crop: smaller, every pixel the mean of what it covers. None for
                  one of them keeps the aspect; with both the crop loses what does not fit, evenly on both sides
        cross     use cross terms of paths with at most this many hits, 0, 2 or 3
        out       put the picture there instead of into a new array
        threads   0: all cores. The picture is the same to the bit for every number."""
        return self._make("retex_retexture", textures, crop, cross, out, threads, parameters=parameters,
                          lights=lights, solo=solo, finishes=finishes, exposure=exposure,
                          white_balance=white_balance, auto_exposure=auto_exposure, size=size)

    def error(self, textures: Optional[Textures] = None, *,
              lights: Optional[Mapping[str, Light]] = None, solo: Optional[str] = None,
              finishes: Optional[Mapping[str, str]] = None, crop: Optional[Crop] = None, size: Optional[Size] = None,
              cross: int = 3, out: Optional[Picture] = None, threads: int = 0) -> Picture:
        """The expected error of what combine() makes of the same arguments: the standard deviation, per channel, of the
        difference to rendering again with these textures, before it is developed. With `size` it is the mean of that of the pixels."""
        return self._make("retex_estimate_error", textures, crop, cross, out, threads, lights=lights,
                          solo=solo, finishes=finishes, size=size)

    def batch(self, rows: Iterable[Textures], *, crop: Optional[Crop] = None, size: Optional[Size] = None,
              cross: int = 3, threads: int = 0, memory: int = 2048 * MEGABYTE,
              texture_memory: int = 512 * MEGABYTE) -> Iterator[Picture]:
        """Make a picture for each row, a mapping as for combine(), when it is asked for. The set stays decoded if it
        takes at most `memory` bytes, and so do the textures used last, up to `texture_memory`."""
        cache = _TextureCache(texture_memory)
        self.preload(memory=memory, threads=threads)
        for row in rows:
            yield self._make("retex_retexture", row, crop, cross, None, threads, cache, size=size)

    def preload(self, *, memory: int = 2048 * MEGABYTE, threads: int = 0) -> None:
        """Decode what combine() reads, if it takes at most `memory` bytes: before several pictures of the set."""
        with self._exclusive() as pointer:
            call("retex_set_preload", pointer, None, memory, threads_of(threads))

    # ---- the set itself ----

    def denoise(self, *, strength: float = 1, radius: int = 5, footprints: bool = True, full_precision: bool = False,
                denoiser: str = "nlm", quality: str = "final", threads: int = 0) -> None:
        """Remove the noise from the set, once, in place, as retex-denoise(1): every picture made of it is clean then.
        Error, Code.ENOTFOUND, where the set has no data for that. The denoiser is nlm, oidn, or both: these two need
        Open Image Denoise 2. The quality is final, or preview, which is faster."""
        params = RetexDenoiseParams(size=sizeof(RetexDenoiseParams), strength=strength, radius=radius,
                                    footprints=footprints, full_precision=full_precision, denoiser=denoiser.encode(),
                                    quality=quality.encode())
        with self._exclusive() as pointer:
            call("retex_denoise", pointer, byref(params), None, threads_of(threads))
            self._read_manifest()

    def write(self, path: Path, *, threads: int = 0) -> None:
        """Write the set, OpenEXR."""
        with self._exclusive() as pointer:
            call("retex_set_write", pointer, path_bytes(path), None, threads_of(threads))

    def write_samples(self, path: Path, *, threads: int = 0) -> None:
        """Write what is laid on the set to a file, OpenEXR, without the set."""
        with self._shared() as pointer:
            call("retex_set_write_samples", pointer, path_bytes(path), None, threads_of(threads))

    def pack(self, path: Path, *, quality: int = 90, lossless: bool = False, threads: int = 0) -> int:
        """Write the set as a pack, a small file, as retex-pack(1). Return its bytes."""
        params = RetexPackParams(size=sizeof(RetexPackParams), quality=quality, lossless=lossless, warn=warn)
        size = ctypes.c_size_t()
        with self._exclusive() as pointer:
            call("retex_set_load", pointer, threads_of(threads))
            call("retex_pack_write", pointer, path_bytes(path), byref(params), byref(size), threads)
        pass_warnings()
        return size.value


def open(path: Path, *, threads: int = 0) -> Set:  # pylint: disable=redefined-builtin
    """Open a set or a pack. Its parts are read when they are needed: the file must stay as it is until the set is
    closed."""
    handle = c_void_p()
    call("retex_set_open", path_bytes(path), byref(handle), threads_of(threads))
    return Set(handle)
