"""The objects that a campaign places: groups with a catalogue, a count and a region, as the text gives them."""
from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Sequence

from .distributions import SWEPT, Rule, read_rule
from .earth import Frame
from .regions import Region, read_region
from .text import Node, near
from .variables import Variables

CLASS_NAME = r"[A-Za-z0-9][A-Za-z0-9 _-]{0,47}"
EVERYTHING = "*"


@dataclass(frozen=True)
class Item:
    """One entry of a catalogue. place: an object or group of the scene's text; materials: what stands for a material of it ("*" for all)."""

    name: str
    class_name: str
    place: str
    weight: float
    materials: dict[str, Rule]
    scale: Rule | None
    node: Node
    keypoints: dict[str, tuple[float, ...]] = field(default_factory=dict)
    """In the object's frame, m."""


@dataclass(frozen=True)
class Group:
    """Objects of one kind of place. whole: footprints lie within the region as a whole; height: None = on what is first met from above, of
    the whole scene or of the placements of `on` alone."""

    name: str
    items: tuple[Item, ...]
    count: Rule
    region: Region
    heading: Rule | None
    spacing_m: float
    whole: bool
    height: Rule | None
    on: str | None
    attempts: int
    node: Node
    speed: Rule | None = None
    """m/s along the heading, from second 0 on."""


def read_objects(node: Node | None, scene: dict[str, Any], variables: Variables, folder: Path) -> tuple[Group, ...]:
    """The map of groups. scene: the scene's text as a tree. CampaignError: an empty catalogue, a name that is not there."""
    if node is None:
        return ()
    origin = scene.get("origin")
    frame = Frame(float(origin["latitude_deg"]), float(origin["longitude_deg"]), float(origin.get("height_m", 0))) if origin else None
    if scene.get("curvature", "none") != "none":
        raise node.error("objects are placed in a flat scene", "a scene without `curvature`")
    return tuple(_group(name, inner, scene, variables, frame, folder) for name, inner in node.map().items())


def _group(name: str, node: Node, scene: dict[str, Any], variables: Variables, frame: Frame | None, folder: Path) -> Group:
    keys = node.map(("catalogue", "count", "where", "heading_deg", "spacing_m", "whole", "height_m", "on", "attempts", "speed_m_s"), ("catalogue", "count", "where"))
    entries = keys["catalogue"].map()
    if not entries:
        raise keys["catalogue"].error("the catalogue is empty", "at least one entry, as `car: {place: NAME}`")
    items = tuple(_item(key, inner, scene, variables) for key, inner in entries.items())
    if not any(i.weight > 0 for i in items):
        raise keys["catalogue"].error("all weights are 0", "one above 0")
    rules = {key: _rule(keys[key], key, variables) for key in ("count", "heading_deg", "height_m", "speed_m_s") if key in keys}
    spacing = keys["spacing_m"].number(0, 1e6) if "spacing_m" in keys else 0.0
    whole = keys["whole"].flag() if "whole" in keys else True
    attempts = keys["attempts"].integer(1, 1_000_000) if "attempts" in keys else 1000
    on = keys["on"].text() if "on" in keys else None
    stood_on = [p["place"] for p in scene["world"] or () if isinstance(p, dict) and "place" in p]
    if on is not None and on not in stood_on:
        raise keys["on"].error(f"the scene's world places no '{on}'", near(on, dict.fromkeys(stood_on)))
    if on is not None and "height_m" in keys:
        raise keys["on"].error("'on' and 'height_m' exclude each other")
    return Group(name, items, rules["count"], read_region(keys["where"], frame, folder), rules.get("heading_deg"), spacing, whole,
                 rules.get("height_m"), on, attempts, node, rules.get("speed_m_s"))


def _item(name: str, node: Node, scene: dict[str, Any], variables: Variables) -> Item:
    keys = node.map(("place", "class", "weight", "materials", "scale", "keypoints"), ("place",))
    place, known = keys["place"].text(), [*scene.get("objects", {}), *scene.get("groups", {})]
    if place not in known:
        raise keys["place"].error(f"the scene has no object or group '{place}'", near(place, known))
    class_name = keys["class"].text() if "class" in keys else name
    if not re.fullmatch(CLASS_NAME, class_name):
        raise keys.get("class", node).error(f"'{class_name}' is no name of a class", "letters, digits, blanks, - and _, at most 48")
    materials = {key: _rule(n, f"materials.{key}", variables, scene.get("curves")) for key, n in (keys["materials"].map().items() if "materials" in keys else ())}
    there = scene.get("materials", {})
    for key, rule in materials.items():
        for one in ((key,) if key != EVERYTHING else ()) + tuple(e for e in rule.ends if isinstance(e, str)):
            if one not in there:
                raise rule.node.error(f"the scene has no material '{one}'", near(one, there))
    weight = keys["weight"].number(0, 1e30) if "weight" in keys else 1.0
    scale = _rule(keys["scale"], "scale", variables) if "scale" in keys else None
    if scale and any(isinstance(e, (int, float)) and not 1e-6 <= e <= 1e6 for e in scale.ends):
        raise scale.node.error("a scale is out of range", "1e-06 to 1e+06")
    keypoints = {key: n.numbers(3) for key, n in (keys["keypoints"].map().items() if "keypoints" in keys else ())}
    return Item(name, class_name, place, weight, materials, scale, node, keypoints)


def keypoints_of(groups: Sequence[Group]) -> dict[str, list[str]]:
    """Names of the keypoints of every class that has some. CampaignError: one item of a class has others than another one."""
    found: dict[str, list[str]] = {}
    for item in (i for group in groups for i in group.items):
        names = list(item.keypoints)
        if found.setdefault(item.class_name, names) != names:
            raise item.node.error(f"'{item.class_name}' has the keypoints {', '.join(names) or 'none'} here, elsewhere {', '.join(found[item.class_name]) or 'none'}",
                                  "the same names in the same order for all items of a class")
    return {name: points for name, points in found.items() if points}


def _rule(node: Node, key: str, variables: Variables, curves: dict[str, Any] | None = None) -> Rule:
    """A rule of an object, which is drawn at random for each."""
    rule = read_rule(node, key, curves)
    if rule.kind in SWEPT or rule.how != "random":
        raise node.error("what belongs to objects is drawn at random", "grid, zip, latin and sobol stand under `vary`")
    for name, at in rule.names:
        if name not in variables.rules:
            raise at.error(f"there is no variable '{name}'", near(name, variables.rules))
    return rule
