"""What a sensor would see of an object if nothing stood before it and the picture had no edges, and what it does see: by rays through an even
grid of places in each pixel, traced in the prepared scenes."""
from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..traced import TracedScene
from .camera import Camera, Numbers

MOST_RAYS = 1 << 18
"""Of one object; larger ones get fewer rays a pixel, or a pixel in so many."""


@dataclass(frozen=True)
class Pose:
    """Where an object is: scaled, turned to a compass heading, moved."""

    position_m: Numbers
    heading_deg: float
    scale: float

    @property
    def rotation(self) -> Numbers:
        """Rows lead from the object's frame to scene ENU: v_scene = rotation @ v_object."""
        c, s = math.cos(math.radians(self.heading_deg)), math.sin(math.radians(self.heading_deg))
        return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])

    def to_scene(self, places: Numbers) -> Numbers:
        """Places of the object's frame in scene ENU."""
        return np.asarray(self.scale * places @ self.rotation.T + self.position_m)


@dataclass(frozen=True)
class Silhouette:
    """x, y: middles of the cells of the grid that show the object, unoccluded; visible: which of them nothing hides; inside: which lie in the
    picture; cell: their width in pixels. Empty arrays: the object covers no place of the grid."""

    x: Numbers
    y: Numbers
    visible: npt.NDArray[np.bool_]
    inside: npt.NDArray[np.bool_]
    cell: float
    range_m: float

    @property
    def occlusion(self) -> float | None:
        """Share of what lies in the picture that something hides; None when nothing lies there."""
        within = int(self.inside.sum())
        return 1 - int((self.visible & self.inside).sum()) / within if within else None

    @property
    def truncation(self) -> float | None:
        """Share of the whole that lies beyond the picture's edges."""
        return 1 - int(self.inside.sum()) / len(self.x) if len(self.x) else None


def box_corners(bounds: Numbers, pose: Pose) -> Numbers:
    """The eight corners of an object's box in scene ENU: left before right, behind before ahead, low before high."""
    return pose.to_scene(np.array([[bounds[i, 0], bounds[j, 1], bounds[k, 2]] for k in (0, 1) for j in (0, 1) for i in (0, 1)]))


def silhouette(camera: Camera, item: TracedScene, pose: Pose, corners: Numbers, tag: int, things: TracedScene, backdrop: TracedScene,
               rays: int) -> Silhouette | None:
    """tag: the object's in `things`; rays: across a pixel. None: part of the object is beside or behind a pinhole."""
    at, _ = camera.project(corners)
    if not np.isfinite(at).all():
        return None
    low, high = np.floor(at.min(axis=0)), np.ceil(at.max(axis=0))
    if not (high > 0).all() or not (low < [camera.columns, camera.rows]).all():
        return Silhouette(np.empty(0), np.empty(0), np.empty(0, bool), np.empty(0, bool), 1.0 / rays, math.nan)
    count = (high - low) * rays
    cell = 1.0 / rays
    if count.prod() > MOST_RAYS:
        cell *= math.sqrt(float(count.prod()) / MOST_RAYS)
    xs, ys = (np.arange(low[i] + cell / 2, high[i], cell) for i in (0, 1))
    x, y = (g.ravel() for g in np.meshgrid(xs, ys))
    origin, direction = camera.rays(x, y)
    turn = pose.rotation
    alone = item.trace((origin - pose.position_m) @ turn / pose.scale, direction @ turn)
    met = alone.hit
    x, y, origin, direction = x[met], y[met], origin[met], direction[met]
    inside = (x >= 0) & (y >= 0) & (x < camera.columns) & (y < camera.rows)
    visible = np.zeros(len(x), bool)
    distance = math.nan
    if inside.any():
        here = things.trace(origin[inside], direction[inside], camera.time_s)
        behind = backdrop.trace(origin[inside], direction[inside], camera.time_s)
        visible[inside] = (here.tag == tag) & (here.distance <= behind.distance)
        distance = float(np.median(alone.distance[met][inside]) * pose.scale)
    return Silhouette(x, y, visible, inside, cell, distance)
