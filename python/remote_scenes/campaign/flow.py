"""What leads from one frame of a sequence to the next: optical flow and depth of the middle of every pixel, by rays.

Files: Middlebury's .flo (S. Baker et al., "A database and evaluation methodology for optical flow", IJCV 92 (2011)): 32-bit u (right) and v (down) in
pixels, above 1e9 = not known; PFM of 32-bit floats, the lowest row first: metres along the camera's axis, infinite where nothing is met.
"""
from __future__ import annotations

from pathlib import Path
from typing import Sequence

import numpy as np
import numpy.typing as npt

from ..traced import TracedScene
from .camera import Camera, Numbers
from .placement import Placed

UNKNOWN = 1e10


def middles(camera: Camera, things: TracedScene | None, backdrop: TracedScene) -> tuple[Numbers, npt.NDArray[np.int64], Numbers]:
    """Of the middle of every pixel, row by row: the place that is met (n, 3), NaN where nothing is; the tag in `things`, -1 of others; the distance."""
    x, y = (g.ravel() for g in np.meshgrid(np.arange(camera.columns) + 0.5, np.arange(camera.rows) + 0.5))
    origin, direction = camera.rays(x, y)
    behind = backdrop.trace(origin, direction, camera.time_s)
    place, distance, tag = behind.position, behind.distance, np.full(len(x), -1)
    if things is not None:
        here = things.trace(origin, direction, camera.time_s)
        nearer = here.distance <= behind.distance
        nearer &= here.hit
        place, distance = np.where(nearer[:, None], here.position, place), np.where(nearer, here.distance, distance)
        tag = np.where(nearer, here.tag, tag)
    return place, tag, distance


def flow(camera: Camera, later: Camera, places: Numbers, tag: npt.NDArray[np.int64], tags: Sequence[str], placed: Sequence[Placed]) -> Numbers:
    """(rows, columns, 2): where what a pixel's middle shows is in the later picture, less where it is now; NaN of what is not known."""
    moved = places.copy()
    for one in placed:
        if one.speed_m_s and one.tag in tags:
            mine = tag == tags.index(one.tag)
            moved[mine] += np.array(one.at(later.time_s)) - np.array(one.at(camera.time_s))
    now, then = camera.project(places)[0], later.project(moved)[0]
    return np.asarray((then - now).reshape(camera.rows, camera.columns, 2))


def depth(camera: Camera, places: Numbers, distance: Numbers) -> Numbers:
    """(rows, columns): along the camera's axis, m."""
    return np.asarray(camera.depth(places, distance).reshape(camera.rows, camera.columns))


def write_flo(path: Path, values: Numbers) -> None:
    """values: (rows, columns, 2)."""
    rows, columns = values.shape[:2]
    known = np.where(np.isfinite(values).all(axis=-1, keepdims=True), values, UNKNOWN)
    path.write_bytes(b"PIEH" + np.array([columns, rows], "<i4").tobytes() + known.astype("<f4").tobytes())


def write_pfm(path: Path, values: Numbers) -> None:
    """values: (rows, columns)."""
    rows, columns = values.shape
    path.write_bytes(f"Pf\n{columns} {rows}\n-1.0\n".encode() + values[::-1].astype("<f4").tobytes())
