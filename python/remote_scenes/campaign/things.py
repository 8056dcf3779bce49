"""Scene texts of placed objects: parts of the scene's text with nothing in them but what the objects need."""
from __future__ import annotations

import copy
import hashlib
from typing import Any, Iterable, Mapping, Sequence

from .campaign import as_json
from .objects import EVERYTHING
from .placement import Placed
from .text import leaves

_SECTIONS = ("materials", "media", "grids", "maps", "curves")
_FRAME = ("scene", "origin", "epoch", "times_s", "windows_um")


def item_scene(scene: Mapping[str, Any], place: str) -> dict[str, Any]:
    """One object or group alone, where it is defined."""
    return _with_needs(_shapes(scene), {}, {}, [{"place": place, "tag": "item"}])


def ground_scene(scene: Mapping[str, Any], name: str) -> dict[str, Any]:
    """The placements in the world of one object or group alone."""
    return _with_needs(_shapes(scene), {}, {}, [p for p in scene["world"] if isinstance(p, dict) and p.get("place") == name])


def backdrop_shapes(scene: Mapping[str, Any]) -> dict[str, Any]:
    """The whole scene, with shapes alone."""
    return _shapes(scene)


def _shapes(scene: Mapping[str, Any]) -> dict[str, Any]:
    """What something is made of does not matter to its shape, except for holes, so that samples with other materials share it."""
    materials = {name: m if isinstance(m, dict) and ("map" in m or "maps" in m) else {"model": "lambert", "reflectance": 0.5}
                 for name, m in scene.get("materials", {}).items()}
    return {**scene, "materials": materials}


def placed_scene(scene: Mapping[str, Any], placed: Sequence[Placed]) -> dict[str, Any]:
    """All objects of a sample alone, each with a tag of its own."""
    objects, groups, materials, world = _entries(scene, placed)
    return _with_needs({**scene, "materials": materials}, objects, groups, world)


def whole_scene(scene: Mapping[str, Any], placed: Sequence[Placed]) -> dict[str, Any]:
    """The scene with all objects of a sample, each with a tag of its own."""
    objects, groups, materials, world = _entries(scene, placed)
    parts = {"materials": materials, "objects": {**scene.get("objects", {}), **objects}, "groups": {**scene.get("groups", {}), **groups}}
    return {**scene, **{k: v for k, v in parts.items() if v}, "world": [*scene["world"], *world]}


def _entries(scene: Mapping[str, Any], placed: Sequence[Placed]) -> tuple[dict[str, Any], dict[str, Any], dict[str, Any], list[Any]]:
    """New objects and groups, all materials, and placements of the world."""
    objects: dict[str, Any] = {}
    groups: dict[str, Any] = {}
    own: dict[str, Any] = {}
    world = []
    for one in placed:
        materials = {key: _named(value, key, own) for key, value in one.materials.items()}
        place = _variant(scene, one.place, {k: v for k, v in materials.items() if k != EVERYTHING}, objects, groups)
        where: dict[str, Any] = {"rotate": {"heading_deg": one.heading_deg}, "translate": list(one.position_m)}
        if one.speed_m_s:
            where = {"motion": {"kind": "straight", "position_m": list(one.position_m), "heading_deg": one.heading_deg, "speed_m_s": one.speed_m_s}}
        entry: dict[str, Any] = {"place": place, "tag": one.tag, "scale": one.scale, **where}
        if EVERYTHING in materials:
            entry["material"] = materials[EVERYTHING]
        world.append(entry)
    return objects, groups, {**scene.get("materials", {}), **own}, world


def _named(value: str | dict[str, Any], key: str, own: dict[str, Any]) -> str:
    """The name of a material; one of an object alone gets a name by what it is."""
    if isinstance(value, str):
        return value
    name = f"{'any' if key == EVERYTHING else key} {hashlib.sha256(as_json(value).encode()).hexdigest()[:12]}"
    own[name] = value
    return name


def _variant(scene: Mapping[str, Any], name: str, materials: Mapping[str, str], objects: dict[str, Any], groups: dict[str, Any]) -> str:
    """The name of an object or group with other materials; what is the same is made once."""
    if not materials:
        return name
    new = name + "".join(f" {k}={v}" for k, v in sorted(materials.items()))
    if new in objects or new in groups:
        return new
    if name in scene.get("objects", {}):
        objects[new] = _replaced(scene["objects"][name], materials)
        return new
    groups[new] = []  # before its parts: a group that holds itself is for scene-prep to refuse
    for placement in scene["groups"][name]:
        inner = _replaced(placement, materials)
        if "place" in inner:
            inner["place"] = _variant(scene, inner["place"], materials, objects, groups)
        groups[new].append(inner)
    return new


def _replaced(tree: Mapping[str, Any], materials: Mapping[str, str]) -> dict[str, Any]:
    out = copy.deepcopy(dict(tree))
    if out.get("material") in materials:
        out["material"] = materials[out["material"]]
    named = out.get("materials")
    if isinstance(named, dict):
        out["materials"] = {k: materials.get(v, v) if isinstance(v, str) else v for k, v in named.items()}
    # Names of materials in a model's own file need no entry: those that are to be others get one.
    if any(kind in out for kind in ("obj", "gltf", "model", "gdb", "obj_text")):
        out["materials"] = {**{k: v for k, v in materials.items() if k not in (named or {})}, **out.get("materials", {})}
    return out


def _with_needs(scene: Mapping[str, Any], objects: dict[str, Any], groups: dict[str, Any], world: list[Any]) -> dict[str, Any]:
    """The world with the objects and groups that it reaches, and all that their texts name."""
    everything = {"objects": {**scene.get("objects", {}), **objects}, "groups": {**scene.get("groups", {}), **groups},
                  **{s: scene.get(s, {}) for s in _SECTIONS}}
    needed: dict[str, dict[str, Any]] = {section: {} for section in everything}
    open_names = _names(world)
    while open_names:
        name = open_names.pop()
        for section, entries in everything.items():
            if isinstance(entries, dict) and name in entries and name not in needed[section]:
                needed[section][name] = entries[name]
                open_names |= _names(entries[name])
    out = {key: scene[key] for key in _FRAME if key in scene}
    for section, entries in everything.items():  # in the order of the text
        kept = {k: v for k, v in entries.items() if k in needed[section]} if isinstance(entries, dict) else {}
        if kept:
            out[section] = kept
    return {**out, "world": world}


def _names(tree: Any) -> set[str]:
    """All texts of a tree, and its keys: whatever may be the name of something."""
    return {v for _, v in leaves(tree) if isinstance(v, str)} | set(_keys(tree))


def _keys(tree: Any) -> Iterable[str]:
    if isinstance(tree, dict):
        for key, value in tree.items():
            yield str(key)
            yield from _keys(value)
    elif isinstance(tree, list):
        for item in tree:
            yield from _keys(item)
