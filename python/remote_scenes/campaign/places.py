"""Places in a tree: `sensors.0.gsd_m`, items of lists by number (from 0) or by their `name`."""
from __future__ import annotations

from typing import Any

from .text import near


class NoSuchPlace(LookupError):
    """A place is not there. args: what is wrong, what would be right."""


def _inner(tree: Any, key: str, way: str) -> Any:
    if isinstance(tree, dict):
        if key in tree:
            return tree[key]
        raise NoSuchPlace(f"there is no '{key}' in '{way}'", near(key, tree))
    if isinstance(tree, list):
        return tree[_item(tree, key, way)]
    raise NoSuchPlace(f"'{way}' has nothing in it", "only maps and lists have")


def _item(items: list[Any], key: str, way: str) -> int:
    if key.isdecimal() and int(key) < len(items):
        return int(key)
    for i, item in enumerate(items):
        if isinstance(item, dict) and item.get("name") == key:
            return i
    names = [item["name"] for item in items if isinstance(item, dict) and "name" in item]
    raise NoSuchPlace(f"'{way}' has no item '{key}'", f"items are numbered from 0 to {len(items) - 1}" if not names else near(key, names))


def put(tree: Any, path: str, value: Any) -> None:
    """Puts a value in a place; the last key may be a new one, a value of None takes it out. NoSuchPlace otherwise."""
    *way, last = path.split(".")
    at, walked = tree, list[str]()
    for key in way:
        at = _inner(at, key, ".".join(walked) or "the text")
        walked.append(key)
    here = ".".join(walked) or "the text"
    if isinstance(at, list):
        at[_item(at, last, here)] = value
    elif not isinstance(at, dict):
        raise NoSuchPlace(f"'{here}' has nothing in it", "only maps and lists have")
    elif value is None:
        at.pop(last, None)
    else:
        at[last] = value
