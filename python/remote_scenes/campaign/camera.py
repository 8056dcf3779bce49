"""Where a sensor's pixels look, and which pixel shows a place: maps and pinhole cameras, as formats/sim_text/FORMAT.md defines them.

Pixel coordinates are (x, y): (0, 0) is the outer corner of the first pixel, x goes right and y down.
"""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Mapping, Protocol

import numpy as np
import numpy.typing as npt

Numbers = npt.NDArray[np.float64]


class Camera(Protocol):
    """A sensor whose geometry is known here."""

    @property
    def columns(self) -> int:
        """Pixels of a row."""

    @property
    def rows(self) -> int:
        """Rows of pixels."""

    @property
    def time_s(self) -> float:
        """Second at which the picture is taken."""

    def rays(self, x: Numbers, y: Numbers) -> tuple[Numbers, Numbers]:
        """Origins and directions (n, 3), scene ENU, of places in the picture."""

    def project(self, places: Numbers) -> tuple[Numbers, Numbers]:
        """Places (n, 3) in the picture as (n, 2), NaN behind the camera; and their distances along the ray, m."""

    def gsd_m(self, range_m: float) -> float:
        """Distance of neighbouring pixels across the line of sight, m."""

    def depth(self, places: Numbers, distance: Numbers) -> Numbers:
        """Of places (n, 3) that rays meet at distances (n), along the camera's axis, m; infinite where nothing is met."""

    def record(self) -> dict[str, Any] | None:
        """What labels in the camera's axes need; None of maps."""


@dataclass(frozen=True)
class MapCamera:
    """An orthographic sensor: straight down, north up."""

    columns: int
    rows: int
    time_s: float
    west: float
    north: float
    gsd: float
    height_m: float

    def rays(self, x: Numbers, y: Numbers) -> tuple[Numbers, Numbers]:
        """Parallel, from the sensor's height."""
        origin = np.stack([self.west + x * self.gsd, self.north - y * self.gsd, np.full_like(x, self.height_m)], axis=-1)
        return origin, np.broadcast_to(np.array([0.0, 0.0, -1.0]), origin.shape)

    def project(self, places: Numbers) -> tuple[Numbers, Numbers]:
        """Heights do not matter."""
        at = np.stack([(places[:, 0] - self.west) / self.gsd, (self.north - places[:, 1]) / self.gsd], axis=-1)
        return at, self.height_m - places[:, 2]

    def gsd_m(self, range_m: float) -> float:
        """The same everywhere."""
        return self.gsd

    def depth(self, places: Numbers, distance: Numbers) -> Numbers:
        """The rays are along the axis."""
        return distance

    def record(self) -> None:
        """A map has no axes of its own."""


@dataclass(frozen=True)
class Pinhole:
    """A frame camera. axes: rows are right, down and forward, unit vectors; focal: in pixels."""

    columns: int
    rows: int
    time_s: float
    position: Numbers
    axes: Numbers
    focal: float

    def rays(self, x: Numbers, y: Numbers) -> tuple[Numbers, Numbers]:
        """From the camera's place."""
        local = np.stack([(x - self.columns / 2) / self.focal, (y - self.rows / 2) / self.focal, np.ones_like(x)], axis=-1)
        direction = local @ self.axes
        direction /= np.linalg.norm(direction, axis=-1, keepdims=True)
        return np.broadcast_to(self.position, direction.shape), direction

    def project(self, places: Numbers) -> tuple[Numbers, Numbers]:
        """Central projection."""
        away = places - self.position
        local = away @ self.axes.T
        ahead = np.where(local[:, 2] > 1e-9, local[:, 2], np.nan)
        at = local[:, :2] / ahead[:, None] * self.focal + np.array([self.columns / 2, self.rows / 2])
        return at, np.linalg.norm(away, axis=-1)

    def gsd_m(self, range_m: float) -> float:
        """At a distance."""
        return range_m / self.focal

    def depth(self, places: Numbers, distance: Numbers) -> Numbers:
        """Of the rays' directions the part ahead."""
        return np.where(np.isfinite(distance), (places - self.position) @ self.axes[2], np.inf)

    def record(self) -> dict[str, Any]:
        """Place, axes (right, down, ahead) and focal length in pixels."""
        return {"position_m": self.position, "axes": self.axes, "focal_px": self.focal}


def camera_of(sensor: Mapping[str, Any]) -> Camera | None:
    """The geometry of a sensor of a simulation's text; None of kinds that are not known here."""
    kind = sensor.get("kind")
    if kind not in ("orthographic", "frame_camera"):
        return None
    columns, rows, time = int(sensor["columns"]), int(sensor["rows"]), float(sensor.get("time_s", 0))
    if kind == "orthographic":
        gsd, (east, north) = float(sensor["gsd_m"]), (float(v) for v in sensor["center_m"])
        return MapCamera(columns, rows, time, east - gsd * columns / 2, north + gsd * rows / 2, gsd, float(sensor.get("height_m", 20000)))
    position, target = np.array(sensor["position_m"], float), np.array(sensor["look_at_m"], float)
    forward = (target - position) / np.linalg.norm(target - position)
    # Straight down or up: rows run north to south.
    up = np.array(sensor["up"], float) if sensor.get("up") is not None else np.array([0.0, 1, 0] if abs(forward[2]) > 1 - 1e-9 else [0.0, 0, 1])
    right = np.cross(forward, up)
    right /= np.linalg.norm(right)
    axes = np.stack([right, np.cross(forward, right), forward])
    return Pinhole(columns, rows, time, position, axes, float(sensor["focal_length_mm"]) * 1000 / float(sensor["pitch_um"]))


def name_of(sensor: Mapping[str, Any]) -> str:
    """The name of a sensor's images."""
    return str(sensor.get("name") or {"orthographic": "map", "frame_camera": "camera"}.get(str(sensor.get("kind")), sensor.get("kind")))
