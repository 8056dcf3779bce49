"""Objects of one sample: what is placed, where, and which way it faces; no two nearer to each other than they may be."""
from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import count
from typing import Any, Callable, Iterator, Mapping, Sequence

from .distributions import Rule
from .draws import unit
from .objects import Group, Item
from .regions import Point, Slots
from .text import CampaignError, Node
from .variables import Draw

Bounds = tuple[tuple[float, float, float], tuple[float, float, float]]
Ground = Callable[["str | None", float, float], "float | None"]
MOST_OBJECTS = 100_000


@dataclass(frozen=True)
class Placed:
    """One object. tag: of it alone in the truth; heading_deg: compass, of its +y axis; materials: those of its item that others stand for."""

    tag: str
    group: str
    item: str
    class_name: str
    place: str
    position_m: tuple[float, float, float]
    heading_deg: float
    scale: float
    materials: Mapping[str, str | dict[str, Any]]
    """What stands for a material: the name of another one, or a material of this object alone."""
    speed_m_s: float = 0.0
    """Along the heading; position_m is that of second 0."""
    keypoints: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    """In the object's frame, m."""

    @property
    def number(self) -> int:
        """Of the object in its sample, from 1; both pictures of a pair have the same."""
        return int(self.tag.rpartition(".")[2])

    def at(self, time_s: float) -> tuple[float, float, float]:
        """Where it is at a time."""
        a, way = math.radians(self.heading_deg), self.speed_m_s * time_s
        x, y, z = self.position_m
        return (x + way * math.sin(a), y + way * math.cos(a), z) if way else self.position_m


class ObjectDraw:
    """The draws of one object (distributions.Context): its numbers depend on the sample, its group and its number in it."""

    def __init__(self, draw: Draw, group: str, number: int) -> None:
        self._draw, self._parts = draw, (group, number)

    def number(self, key: str) -> float:
        """For a key of this object."""
        return unit(self._draw.seed, self._draw.sample, "object", *self._parts, key)

    def reference(self, name: str, at: Node) -> Any:
        """The value of a variable of the sample."""
        return self._draw.reference(name, at)

    def step(self, axis: str, length: int) -> int:
        """Never: objects have no grid."""
        raise AssertionError(axis)


def footprint(bounds: Bounds, x: float, y: float, heading_deg: float, scale: float) -> list[Point]:
    """The corners of a placed object's box from above, counted against the clock: left behind, right behind, right ahead, left ahead."""
    (x0, y0, _), (x1, y1, _) = bounds
    c, s = math.cos(math.radians(heading_deg)), math.sin(math.radians(heading_deg))
    return [(x + scale * (c * px + s * py), y + scale * (-s * px + c * py)) for px, py in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))]


def apart(a: Sequence[Point], b: Sequence[Point], gap_m: float) -> bool:
    """Whether two rectangles have a line between them with so much room across (the separating axes are those of their sides)."""
    for box in (a, b):
        for (px, py), (qx, qy) in ((box[0], box[1]), (box[1], box[2])):
            length = math.hypot(qx - px, qy - py)
            if length == 0:
                continue
            nx, ny = (qx - px) / length, (qy - py) / length
            first, other = [nx * x + ny * y for x, y in a], [nx * x + ny * y for x, y in b]
            if max(min(other) - max(first), min(first) - max(other)) >= gap_m:
                return True
    return False


class Taken:
    """Footprints that are there, with circles around them, so that only neighbours are compared in full."""

    def __init__(self) -> None:
        self._all: list[tuple[list[Point], float, Point]] = []

    def free(self, corners: list[Point], gap_m: float) -> bool:
        """Whether a footprint keeps its distance from all."""
        radius, (x, y) = _circle(corners)
        for other, r, (ox, oy) in self._all:
            if math.hypot(x - ox, y - oy) < radius + r + gap_m and not apart(corners, other, gap_m):
                return False
        return True

    def add_placed(self, one: Placed, bounds: Bounds) -> None:
        """Takes the place of an object that is there."""
        self.add(footprint(bounds, one.position_m[0], one.position_m[1], one.heading_deg, one.scale))

    def add(self, corners: list[Point]) -> None:
        """Takes the place."""
        radius, middle = _circle(corners)
        self._all.append((corners, radius, middle))


def _circle(corners: Sequence[Point]) -> tuple[float, Point]:
    x, y = sum(p[0] for p in corners) / 4, sum(p[1] for p in corners) / 4
    return max(math.hypot(px - x, py - y) for px, py in corners), (x, y)


def place_all(groups: Sequence[Group], draw: Draw, bounds: Callable[[str], Bounds], ground: Ground) -> list[Placed]:
    """The objects of a sample. bounds: of an object or group of the scene in its own frame, m; ground: height of what is below a place, m, of
    all or of the placements of one name, or None. CampaignError with the place in the text where an object finds no room."""
    taken, out = Taken(), list[Placed]()
    for group in groups:
        slots = count()  # the next one that is free
        for number in range(_count(group, draw)):
            out.append(place_one(group, number, draw, bounds, ground, taken, slots, len(out) + 1))
    return out


def place_one(group: Group, number: int, draw: Draw, bounds: Callable[[str], Bounds], ground: Ground, taken: Taken, slots: Iterator[int],
              whole_number: int) -> Placed:
    """One object, which takes its place. number: of the object in its group, which its draws depend on; whole_number: of the object in the sample, from 1."""
    context = ObjectDraw(draw, group.name, number)
    item = _item(group, context)
    scale = _number(item.scale, context) if item.scale else 1.0
    if not 1e-6 <= scale <= 1e6:
        raise item.node.error(f"sample {draw.sample}: the scale {scale:g} is out of range", "1e-06 to 1e+06")
    materials = {key: _material(rule, context) for key, rule in item.materials.items()}
    x, y, heading = _find(group, number, context, draw, bounds(item.place), scale, taken, slots)
    z = _number(group.height, context) if group.height else ground(group.on, x, y)
    if z is None:
        raise group.node.error(f"sample {draw.sample}: nothing is below object {number} of '{group.name}' at ({x:.2f}, {y:.2f})",
                               "ground there, or a `height_m`")
    return Placed(f"{item.class_name}.{whole_number}", group.name, item.name, item.class_name, item.place, (x, y, z), heading, scale, materials,
                  _number(group.speed, context) if group.speed else 0.0, item.keypoints)


def _count(group: Group, draw: Draw) -> int:
    context = ObjectDraw(draw, group.name, -1)
    count = group.count.value(context)
    if isinstance(count, bool) or not isinstance(count, (int, float)) or count != int(count) or not 0 <= count <= MOST_OBJECTS:
        raise group.count.node.error(f"sample {draw.sample}: {count!r} is no count", f"a whole number from 0 to {MOST_OBJECTS}")
    if isinstance(group.region, Slots) and count > len(group.region.places):
        raise group.count.node.error(f"sample {draw.sample}: {count} objects for {len(group.region.places)} places", "fewer objects, or more places")
    return int(count)


def _item(group: Group, context: ObjectDraw) -> Item:
    total, at = math.fsum(i.weight for i in group.items), 0.0
    u = context.number("item") * total
    for item in group.items:
        at += item.weight
        if item.weight > 0 and u < at:
            return item
    return [i for i in group.items if i.weight > 0][-1]


def _material(rule: Rule, context: ObjectDraw) -> str | dict[str, Any]:
    value = rule.value(context)
    if not isinstance(value, (str, dict)):
        raise rule.node.error(f"{value!r} is no material", "the name of one of the scene, or {material: {model: ..., ...}}")
    return value


def _number(rule: Any, context: ObjectDraw) -> float:
    value = rule.value(context)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise rule.node.error(f"{value!r} is no number")
    return float(value)


def _find(group: Group, number: int, context: ObjectDraw, draw: Draw, box: Bounds, scale: float, taken: Taken,
          slots: Iterator[int]) -> tuple[float, float, float]:
    """A place with room; of slots the next one that has it."""
    turned = _number(group.heading, context) if group.heading else 0.0
    tried = len(group.region.places) if isinstance(group.region, Slots) else group.attempts
    for attempt in range(tried):
        def one(name: str) -> float:
            if name == "slots":
                return unit(draw.seed, draw.sample, "slots", group.name)
            return context.number(f"{name}.{attempt}")

        found = group.region.place(next(slots), one)
        if found is None:
            continue
        x, y, heading = found[0], found[1], (found[2] + turned) % 360
        corners = footprint(box, x, y, heading, scale)
        if (not group.whole or group.region.holds_all(corners)) and taken.free(corners, group.spacing_m):
            taken.add(corners)
            return x, y, heading
    raise group.node.error(f"sample {draw.sample}: object {number} of '{group.name}': no place has room in {tried} attempts", "fewer objects, less `spacing_m`, or more room")


__all__ = ["Bounds", "CampaignError", "Ground", "Placed", "Taken", "apart", "footprint", "place_all", "place_one"]
