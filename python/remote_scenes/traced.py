"""Prepared scenes (.h5) within this process: what rays meet, and what sees what."""
from __future__ import annotations

import os
from ctypes import POINTER, byref, c_uint8, c_uint32
from dataclasses import dataclass
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from .library import HitArrays, Numbers, Opened, SceneInfo, doubles, integers, library, opened, rows

Integers = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Hits:
    """What rays meet first, each array in their shape. Where nothing is met: infinity, NaN, -1."""

    distance: Numbers
    """m."""
    position: Numbers
    """(..., 3): ENU, m."""
    normal: Numbers
    """(..., 3): of the geometry, on its front side."""
    material: Integers
    """Numbers of TracedScene.materials, after overrides and class maps; -1 also where the surface has none."""
    instance: Integers
    """As in truth images."""
    tag: Integers
    """Numbers of TracedScene.tags; -1 also where there is none."""
    triangle: Integers
    """Of the mesh; -1 on exact surfaces."""

    @property
    def hit(self) -> npt.NDArray[np.bool_]:
        """Where something is met."""
        return np.isfinite(self.distance)


def _draws(given: npt.ArrayLike) -> npt.NDArray[np.uint32]:
    numbers = np.asarray(given)
    if numbers.size and (numbers.dtype.kind not in "iu" or numbers.min() < 0 or numbers.max() >= 1 << 32):
        raise ValueError(f"draw: whole numbers from 0 to {(1 << 32) - 1} are wanted, not {numbers.dtype} "
                         f"from {numbers.min()} to {numbers.max()}")
    return numbers.astype(np.uint32)


class TracedScene(Opened):
    """A scene that scene-prep has made, as it is from begin_s to end_s. Places and directions are ENU (..., 3), broadcast
    against each other."""

    def __init__(self, path: Union[str, os.PathLike[str]], begin_s: float = 0, end_s: Optional[float] = None) -> None:
        self.path = os.fspath(path)
        self.begin_s, self.end_s = begin_s, begin_s if end_s is None else end_s
        super().__init__(opened("rs_scene_open", self.path, self.begin_s, self.end_s), "rs_scene_close")
        info = SceneInfo()
        library().rs_scene_describe(self._open, byref(info))
        self.materials: tuple[str, ...] = self._names("rs_scene_material", info.materials)
        self.tags: tuple[str, ...] = self._names("rs_scene_tag", info.tags)
        self.triangles: int = info.triangles
        """Of instances each time counted."""
        self.bounds: Numbers = np.array([list(info.low), list(info.high)])
        """2 x 3: lowest and highest corner of what has an end, ENU, m."""
        self.origin: tuple[float, float, float] = (info.latitude_deg, info.longitude_deg, info.height_m)
        """Latitude and longitude in degrees, height above the ellipsoid in m, of the place (0, 0, 0)."""

    def __enter__(self) -> "TracedScene":
        return self

    def _names(self, function: str, count: int) -> tuple[str, ...]:
        return tuple(getattr(library(), function)(self._open, i).decode() for i in range(count))

    def trace(self, origin: npt.ArrayLike, direction: npt.ArrayLike, time_s: Optional[npt.ArrayLike] = None,
              draw: Optional[npt.ArrayLike] = None) -> Hits:
        """What rays meet first. time_s within the span the scene was opened for, without: its beginning. Leaves through
        whose holes (opacity maps) rays pass are there or not by a hash of the ray and of `draw`, whole numbers."""
        shape, (o, d) = rows("origin and direction", origin, direction)
        n = len(o)
        number = self._each(None if draw is None else _draws(draw), shape, np.uint32)
        hits = Hits(np.empty(n), np.empty((n, 3)), np.empty((n, 3)), *(np.empty(n, np.int64) for _ in range(4)))
        arrays = HitArrays(doubles(hits.distance), doubles(hits.position), doubles(hits.normal), integers(hits.material),
                           integers(hits.instance), integers(hits.tag), integers(hits.triangle))
        time = self._each(time_s, shape, np.float64)
        self._check(library().rs_scene_trace(self._open, n, doubles(o), doubles(d), doubles(time),
                                             None if number is None else number.ctypes.data_as(POINTER(c_uint32)), byref(arrays)))
        return Hits(*(getattr(hits, f).reshape(shape + getattr(hits, f).shape[1:]) for f in Hits.__dataclass_fields__))

    def visible(self, from_: npt.ArrayLike, to: npt.ArrayLike, gap_m: float = 1e-3,
                time_s: Optional[npt.ArrayLike] = None) -> npt.NDArray[np.bool_]:
        """Whether no surface stands between two places, whatever its material lets through; media do not count. Surfaces
        within gap_m of either place do not stand between."""
        shape, (a, b) = rows("from_ and to", from_, to)
        seen = np.empty(len(a), np.uint8)
        self._check(library().rs_scene_visible(self._open, len(a), doubles(a), doubles(b), gap_m,
                                               doubles(self._each(time_s, shape, np.float64)),
                                               seen.ctypes.data_as(POINTER(c_uint8))))
        return np.asarray(seen.reshape(shape) != 0)

    @staticmethod
    def _each(given: Optional[npt.ArrayLike], shape: tuple[int, ...], kind: Any) -> Any:
        if given is None:
            return None
        return np.ascontiguousarray(np.broadcast_to(np.asarray(given, kind), shape)).reshape(-1)


def open_scene(path: Union[str, os.PathLike[str]], begin_s: float = 0, end_s: Optional[float] = None) -> TracedScene:
    """Opens a prepared scene for times of a span (s; without an end for its beginning alone). InputError: no such file, a
    damaged one, or a motion that does not cover the span."""
    return TracedScene(path, begin_s, end_s)
