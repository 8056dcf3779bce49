"""Where objects may stand: in polygons, along roads, or in slots; drawn inline (scene ENU) or taken from a GeoJSON map.

A region offers places (east, north, direction); direction is a compass heading in degrees that headings are counted from.
"""
from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Sequence, Union

from .draws import shuffled
from .earth import Frame
from .text import CampaignError, Node

Point = tuple[float, float]
Place = tuple[float, float, float]
Unit = Callable[[str], float]
"""A number within (0, 1) by name, of one attempt to place one object."""


@dataclass(frozen=True)
class Polygons:
    """Rings of corners; a place is inside when a ray from it crosses an odd number of edges."""

    rings: tuple[tuple[Point, ...], ...]
    direction_deg: float = 0.0

    def place(self, number: int, unit: Unit) -> Place | None:
        """A place, even over the bounding box; None where that is outside."""
        (x0, y0), (x1, y1) = self.bounds()
        x, y = x0 + unit("x") * (x1 - x0), y0 + unit("y") * (y1 - y0)
        return (x, y, self.direction_deg) if self.holds(x, y) else None

    def bounds(self) -> tuple[Point, Point]:
        """Lowest and highest corner."""
        xs, ys = [x for r in self.rings for x, _ in r], [y for r in self.rings for _, y in r]
        return (min(xs), min(ys)), (max(xs), max(ys))

    def holds(self, x: float, y: float) -> bool:
        """Whether a place is inside."""
        odd = False
        for ring in self.rings:
            for (ax, ay), (bx, by) in zip(ring, (*ring[1:], ring[0])):
                if (ay > y) != (by > y) and x < ax + (y - ay) / (by - ay) * (bx - ax):
                    odd = not odd
        return odd

    def holds_all(self, corners: Sequence[Point]) -> bool:
        """Whether a footprint is inside: all of its corners, and no edge of the region crosses one of its edges."""
        if not all(self.holds(x, y) for x, y in corners):
            return False
        sides = list(zip(corners, (*corners[1:], corners[0])))
        return not any(_cross(a, b, c, d) for ring in self.rings for a, b in zip(ring, (*ring[1:], ring[0])) for c, d in sides)


@dataclass(frozen=True)
class Roads:
    """Lines with a width; places are even along them, in lanes `lane_m` from the middle to either side (right-hand traffic), or anywhere
    across when there is no lane."""

    lines: tuple[tuple[Point, ...], ...]
    width_m: float
    lane_m: float | None = None

    def place(self, number: int, unit: Unit) -> Place | None:
        """A place on a road that heads along it, one way or the other."""
        pieces = [(a, b) for line in self.lines for a, b in zip(line, line[1:])]
        lengths = [math.dist(a, b) for a, b in pieces]
        along = unit("along") * math.fsum(lengths)
        i = 0
        while i < len(pieces) - 1 and along > lengths[i]:
            along -= lengths[i]
            i += 1
        (ax, ay), (bx, by) = pieces[i]
        dx, dy = (bx - ax) / lengths[i], (by - ay) / lengths[i]
        back = unit("way") < 0.5
        if self.lane_m is None:
            right = (unit("across") - 0.5) * self.width_m
        else:
            right = -self.lane_m if back else self.lane_m
        heading = math.degrees(math.atan2(dx, dy)) + (180 if back else 0)
        return ax + along * dx + right * dy, ay + along * dy - right * dx, heading % 360

    def holds_all(self, corners: Sequence[Point]) -> bool:
        """Whether all corners lie on roads."""
        return all(any(_distance(c, a, b) <= self.width_m / 2 for line in self.lines for a, b in zip(line, line[1:])) for c in corners)


@dataclass(frozen=True)
class Slots:
    """Places with headings of their own, of which each is taken once."""

    places: tuple[Place, ...]

    def place(self, number: int, unit: Unit) -> Place | None:
        """The slot of object `number`: one after the other in an order that the sample draws."""
        key = unit("slots")
        return self.places[shuffled(number, len(self.places), key)] if number < len(self.places) else None

    def holds_all(self, corners: Sequence[Point]) -> bool:
        """Slots say by themselves where things stand."""
        return True


Region = Union[Polygons, Roads, Slots]


def _cross(a: Point, b: Point, c: Point, d: Point) -> bool:
    def side(p: Point, q: Point, r: Point) -> float:
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])

    return side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0


def _distance(p: Point, a: Point, b: Point) -> float:
    dx, dy = b[0] - a[0], b[1] - a[1]
    t = max(0.0, min(1.0, ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / (dx * dx + dy * dy)))
    return math.hypot(p[0] - a[0] - t * dx, p[1] - a[1] - t * dy)


def read_region(node: Node, frame: Frame | None, folder: Path) -> Region:
    """`{polygons: [[[x, y], ...], ...]}`, `{roads: [[[x, y], ...], ...], width_m}` or `{slots: [[x, y, heading], ...]}`; polygons and roads may
    be the name of a GeoJSON file. frame: of the scene, which such files need."""
    keys = node.map(("polygons", "direction_deg", "roads", "width_m", "lane_m", "slots", "rows"))
    kinds = [k for k in ("polygons", "roads", "slots", "rows") if k in keys]
    if len(kinds) != 1:
        raise node.error("one of 'polygons', 'roads', 'slots', 'rows' is wanted here")
    allowed = {"polygons": ("polygons", "direction_deg"), "roads": ("roads", "width_m", "lane_m"), "slots": ("slots",), "rows": ("rows",)}
    node.map(allowed[kinds[0]], ("width_m",) if kinds[0] == "roads" else ())
    if kinds[0] == "polygons":
        direction = keys["direction_deg"].number(-360, 360) if "direction_deg" in keys else 0.0
        return Polygons(_lines(keys["polygons"], 3, ("Polygon", "MultiPolygon"), frame, folder), direction)
    if kinds[0] == "roads":
        lane = keys["lane_m"].number(0, 1e6) if "lane_m" in keys else None
        return Roads(_lines(keys["roads"], 2, ("LineString", "MultiLineString"), frame, folder), keys["width_m"].number(1e-3, 1e6), lane)
    if kinds[0] == "slots":
        places = tuple(n.numbers(3) for n in keys["slots"].list(1))
        return Slots(tuple((x, y, h) for x, y, h in places))
    return Slots(tuple(p for n in keys["rows"].list(1) for p in _row(n)))


def _row(node: Node) -> list[Place]:
    """`{from: [x, y], to: [x, y], count, heading_deg}`: even places from the first to the last."""
    keys = node.map(("from", "to", "count", "heading_deg"), ("from", "to", "count", "heading_deg"))
    (x0, y0), (x1, y1) = keys["from"].numbers(2), keys["to"].numbers(2)
    count, heading = keys["count"].integer(1, 100_000), keys["heading_deg"].number(-360, 360)
    steps = max(count - 1, 1)
    return [(x0 + (x1 - x0) * i / steps, y0 + (y1 - y0) * i / steps, heading) for i in range(count)]


def _lines(node: Node, least: int, kinds: tuple[str, ...], frame: Frame | None, folder: Path) -> tuple[tuple[Point, ...], ...]:
    if isinstance(node.value, str):
        lines = _from_map(node, kinds, frame, folder)
    else:
        lines = [[(n.numbers(2)[0], n.numbers(2)[1]) for n in line.list(least)] for line in node.list(1)]
    for line in lines:
        if len(line) < least or any(a == b for a, b in zip(line, line[1:])):
            raise node.error("a line has too few corners, or one twice in a row", f"at least {least} different ones")
        if not all(math.isfinite(c) for p in line for c in p):
            raise node.error("a corner is not finite")
    return tuple(tuple(line) for line in lines)


def _from_map(node: Node, kinds: tuple[str, ...], frame: Frame | None, folder: Path) -> list[list[Point]]:
    """Geometries of a GeoJSON file (RFC 7946: longitude, latitude on WGS84)."""
    file = folder / node.text()
    if frame is None:
        raise node.error("a map needs a scene with an `origin`")
    try:
        tree = json.loads(file.read_text(encoding="utf-8"))
        features = tree["features"] if tree["type"] == "FeatureCollection" else [tree]
        shapes = [f["geometry"] if f["type"] == "Feature" else f for f in features]
        found: list[list[Point]] = []
        for shape in shapes:
            if shape["type"] in kinds:
                inner = shape["coordinates"]
                for line in [inner] if shape["type"] == "LineString" else inner if shape["type"] in ("Polygon", "MultiLineString") else \
                        [ring for polygon in inner for ring in polygon]:
                    points = [frame.to_enu(float(p[0]), float(p[1]))[:2] for p in line]
                    found.append(points[:-1] if kinds[0] == "Polygon" and points[0] == points[-1] else points)
    except (OSError, ValueError, KeyError, TypeError, IndexError, AttributeError) as problem:
        raise node.error(f"{file} is no GeoJSON map: {type(problem).__name__}: {problem}") from None
    if not found:
        raise node.error(f"{file} has none of the geometries {', '.join(kinds)}")
    return found


__all__ = ["CampaignError", "Place", "Polygons", "Region", "Roads", "Slots", "read_region"]
