"""The suite's shared library, called within this process (apps/in-process/remote_scenes.h)."""
from __future__ import annotations

import ctypes
import operator
import os
import warnings
import weakref
from ctypes import POINTER, Structure, byref, c_char_p, c_double, c_float, c_int, c_int64, c_size_t, c_uint8, c_uint32, c_uint64, c_void_p
from functools import lru_cache
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from .errors import ProgramMissing, ProgramWarning, error_of
from .programs import FOLDER_VARIABLE, find_program

NAME = "libremote_scenes.so.1"
INTERFACE = 3
"""What this package needs of the library; newer ones have more."""

Numbers = npt.NDArray[np.float64]
_doubles, _integers = POINTER(c_double), POINTER(c_int64)


class SqtInfo(Structure):
    _fields_ = [("channels", c_size_t), ("totals", c_size_t), ("wavelength_um", _doubles), ("total_um", _doubles),
                ("cosine", c_int), ("sphere", c_int), ("dirac", c_int)]


class SceneInfo(Structure):
    _fields_ = [("materials", c_size_t), ("tags", c_size_t), ("triangles", c_size_t), ("low", c_double * 3),
                ("high", c_double * 3), ("latitude_deg", c_double), ("longitude_deg", c_double), ("height_m", c_double)]


class SimulationInfo(Structure):
    _fields_ = [("bands", c_size_t), ("paths", c_uint32), ("seed", c_uint64), ("begin", c_double), ("end", c_double)]


class HitArrays(Structure):
    _fields_ = [("distance", _doubles), ("position", _doubles), ("normal", _doubles), ("material", _integers),
                ("instance", _integers), ("tag", _integers), ("triangle", _integers)]


class LidarInfo(Structure):
    _fields_ = [("pulses", c_uint64), ("seed", c_uint64), ("paths", c_uint32), ("bins", c_uint32), ("columns", c_uint32), ("rows", c_uint32),
                ("channels", c_size_t), ("bin_s", c_double), ("group_index", c_double)]


class ResponseArrays(Structure):
    _fields_ = [("pulses", c_uint64), ("rows", c_uint64), ("entries", c_uint64), ("time", _doubles), ("energy", _doubles), ("wavelength", _doubles),
                ("start", _doubles), ("emission_place", _doubles), ("emission_rotation", _doubles), ("reception_place", _doubles),
                ("reception_rotation", _doubles), ("begin", POINTER(c_uint64)), ("bound", _doubles), ("paths", POINTER(c_uint64)),
                ("bin", POINTER(c_uint32)), ("contributions", POINTER(c_uint32)), ("value", _doubles), ("variance", _doubles), ("skewness", POINTER(c_float)), ("scrambles", c_double), ("student", c_double)]


_d, _n = _doubles, c_size_t
_FUNCTIONS: dict[str, tuple[Any, list[Any]]] = {
    "rs_interface": (c_int, []), "rs_version": (c_char_p, []), "rs_message": (c_char_p, []),
    "rs_set_threads": (c_int, [c_int]),
    "rs_sqt_open": (c_int, [c_char_p, POINTER(c_void_p)]), "rs_sqt_close": (None, [c_void_p]),
    "rs_sqt_header": (c_char_p, [c_void_p]), "rs_sqt_describe": (None, [c_void_p, POINTER(SqtInfo)]),
    "rs_sqt_evaluate": (c_int, [c_void_p, _n, _d, _d, _d]), "rs_sqt_total": (c_int, [c_void_p, _n, _d, _d]),
    "rs_sqt_magnitude": (c_int, [c_void_p, _n, _d, _d]), "rs_sqt_sample": (c_int, [c_void_p, _n, _d, _n, _d, _d, _d]),
    "rs_sqt_pdf": (c_int, [c_void_p, _n, _d, _d, _d]), "rs_sqt_dirac": (c_int, [c_void_p, _n, _d, _n, _d, _d]),
    "rs_scene_open": (c_int, [c_char_p, c_double, c_double, POINTER(c_void_p)]), "rs_scene_close": (None, [c_void_p]),
    "rs_scene_describe": (None, [c_void_p, POINTER(SceneInfo)]), "rs_scene_material": (c_char_p, [c_void_p, _n]),
    "rs_scene_tag": (c_char_p, [c_void_p, _n]),
    "rs_told": (c_char_p, []),
    "rs_simulation_open": (c_int, [c_char_p, c_char_p, POINTER(c_void_p)]), "rs_simulation_close": (None, [c_void_p]),
    "rs_simulation_describe": (None, [c_void_p, POINTER(SimulationInfo)]),
    "rs_simulation_band": (c_char_p, [c_void_p, _n, _d]),
    "rs_simulation_radiance": (c_int, [c_void_p, _n, _d, _d, _d, c_uint32, c_uint64, _d, _d, POINTER(c_uint8)]),
    "rs_lidar_open": (c_int, [c_char_p, c_char_p, POINTER(c_void_p)]), "rs_lidar_close": (None, [c_void_p]),
    "rs_lidar_describe": (None, [c_void_p, POINTER(LidarInfo)]), "rs_lidar_channel": (c_char_p, [c_void_p, _n]),
    "rs_lidar_trace": (c_int, [c_void_p, c_uint64, c_uint64, c_uint32, c_uint64, POINTER(c_void_p)]),
    "rs_responses_close": (None, [c_void_p]), "rs_responses_describe": (None, [c_void_p, POINTER(ResponseArrays)]),
    "rs_scene_trace": (c_int, [c_void_p, _n, _d, _d, _d, POINTER(c_uint32), POINTER(HitArrays)]),
    "rs_scene_visible": (c_int, [c_void_p, _n, _d, _d, c_double, _d, POINTER(c_uint8)]),
}


def find_library() -> Path:
    """The library that belongs to the programs found (programs.find_program): in the folder `lib` beside theirs.
    ProgramMissing when it is not there."""
    folder = Path(find_program("sqt-inspect")).resolve().parent
    path = folder.parent / "lib" / NAME
    if not path.exists():
        raise ProgramMissing(f"{NAME} is not in {path.parent}, beside the programs in {folder}: build the target remote_scenes")
    return path


def _hint(problem: str) -> str:
    if "ISA level" not in problem:
        return ""
    return "; this processor lacks AVX2 or what else the suite was built for: build it with cmake -DSUITE_ARCH=x86-64"


@lru_cache(maxsize=None)
def _loaded(path: Path) -> ctypes.CDLL:
    try:
        library = ctypes.CDLL(str(path))
    except OSError as problem:
        raise ProgramMissing(f"{path} cannot be loaded: {problem}{_hint(str(problem))}") from None
    library.rs_interface.restype = c_int
    if library.rs_interface() < INTERFACE:
        raise ProgramMissing(f"{path} is older than this package needs")
    for name, (result, arguments) in _FUNCTIONS.items():
        function = getattr(library, name)
        function.restype, function.argtypes = result, arguments
    return library


def library() -> ctypes.CDLL:
    """The library, loaded when it is first asked for; looked for again when the environment names other folders."""
    return _of(os.environ.get(FOLDER_VARIABLE), os.environ.get("PATH"))


@lru_cache(maxsize=8)
def _of(folder: str | None, path: str | None) -> ctypes.CDLL:
    return _loaded(find_library())


def check(status: int) -> None:
    """Raises what a refused call has to say, as run_program does of a program: InputError or ProgramBug."""
    if status:
        raise error_of("libremote_scenes", status, library().rs_message().decode(errors="replace").splitlines())


def told() -> None:
    """Warns of what the last call of a simulation had to say, a ProgramWarning for each sentence."""
    for sentence in library().rs_told().decode(errors="replace").splitlines():
        warnings.warn(sentence, ProgramWarning, stacklevel=4)


def set_threads(threads: int) -> None:
    """Threads that calls within this process take from now on; 0 = one a core."""
    check(library().rs_set_threads(whole(threads, "threads", 2 ** 31 - 1, -2 ** 31)))


def whole(number: Any, what: str, most: int, least: int = 0) -> int:
    """A whole number from `least` to `most`; ValueError or TypeError else. What is larger than its C type would be another
    number there."""
    try:
        value = operator.index(number)
    except TypeError:
        raise TypeError(f"{what}={number!r}: a whole number is wanted") from None
    if not least <= value <= most:
        raise ValueError(f"{what}={value}: {least} to {most}")
    return value


def c_text(text: Union[str, bytes], what: str) -> bytes:
    """Text for C, where a NUL would end it: ValueError when there is one."""
    raw = os.fsencode(text)
    if b"\0" in raw:
        raise ValueError(f"{what} {text!r} has a NUL character in it")
    return raw


class Opened:
    """Something of the library that is closed with this object, or by close(). Calls of other threads that are on their way
    then come to their end; later ones raise ValueError."""

    def __init__(self, handle: c_void_p, close: str) -> None:
        self._handle: Optional[c_void_p] = handle
        self._finalizer = weakref.finalize(self, getattr(library(), close), handle)

    @property
    def _open(self) -> c_void_p:
        # Once: another thread may close it meanwhile. The library refuses handles that are closed then.
        handle = self._handle
        if handle is None:
            raise ValueError("it has been closed")
        return handle

    def _check(self, status: int) -> None:
        """check(), of a call with _open."""
        if status and self._handle is None:
            raise ValueError("it has been closed")
        check(status)

    def close(self) -> None:
        """Gives its memory back; it cannot be asked any more."""
        self._handle = None
        self._finalizer()

    def __enter__(self) -> "Opened":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def opened(function: str, path: Union[str, Path], *more: Any) -> c_void_p:
    """What an open function of the library makes of a file."""
    handle = c_void_p()
    check(getattr(library(), function)(c_text(path, "the path"), *more, byref(handle)))
    return handle


def rows(what: str, *arrays: npt.ArrayLike) -> tuple[tuple[int, ...], list[Numbers]]:
    """Arrays of vectors (..., 3) broadcast against each other: the shape without the 3, and each as n x 3 for the library.
    ValueError for other shapes."""
    given = [np.asarray(a, dtype=np.float64) for a in arrays]
    for a in given:
        if a.ndim == 0 or a.shape[-1] != 3:
            raise ValueError(f"{what}: arrays of shape (..., 3) are wanted, not {a.shape}")
    shape = np.broadcast_shapes(*(a.shape for a in given))
    return shape[:-1], [np.ascontiguousarray(np.broadcast_to(a, shape)).reshape(-1, 3) for a in given]


def doubles(array: Optional[Numbers]) -> Any:
    """The array as the library takes it; None as NULL."""
    return None if array is None else array.ctypes.data_as(_doubles)


def integers(array: npt.NDArray[np.int64]) -> Any:
    return array.ctypes.data_as(_integers)
