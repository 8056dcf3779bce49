"""Pairs of pictures of one place: some variables are drawn again for the second, some objects have left, others have come."""
from __future__ import annotations

from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import Any, Callable, Sequence

import numpy as np
import numpy.typing as npt
import xarray as xr

from ..chips import _write_png
from .draws import unit
from .objects import Group
from .placement import Bounds, Ground, Placed, Taken, place_one
from .text import Node, near
from .variables import Draw, Variables

LATER = "_later"
"""Behind the name of an image: the second picture."""
LEFT, CAME = 1, 2
"""Of a pixel of the change's picture; 3: where something has left, something else has come."""


@dataclass(frozen=True)
class Pair:
    """again: variables that the second picture draws again; leave: with which probability an object leaves, arrive: how many come, as a share of those
    that were there."""

    again: frozenset[str]
    leave: float
    arrive: float


def read_pair(node: Node | None, variables: Variables, groups: Sequence[Group], frames: int) -> Pair | None:
    """`{again: [NAME, ...], leave: P, arrive: P}`. CampaignError: no such variable, one of a grid; nothing to leave; a sequence."""
    if node is None:
        return None
    keys = node.map(("again", "leave", "arrive"))
    names = keys["again"].list() if "again" in keys else []
    for n in names:
        rule = variables.rules.get(n.text())
        if rule is None:
            raise n.error(f"there is no variable '{n.value}'", near(n.value, variables.rules))
        if rule.axis:
            raise n.error(f"'{n.value}' is an axis of the grid, which both pictures share", "a variable that is drawn")
    shares = [keys[k].number(0, 1) if k in keys else 0.0 for k in ("leave", "arrive")]
    if max(shares) > 0 and not groups:
        raise node.error("no objects can leave or arrive", "`objects`")
    if frames > 1:
        raise node.error("'pair' and 'sequence' exclude each other")
    return Pair(frozenset(n.text() for n in names), shares[0], shares[1])


def place_later(groups: Sequence[Group], draw: Draw, bounds: Callable[[str], Bounds], ground: Ground, first: Sequence[Placed], pair: Pair) -> list[Placed]:
    """The objects of the second picture: those of the first that stay, as they were, and those that have come, whose numbers follow."""
    def number(*parts: object) -> float:
        return unit(draw.seed, draw.sample, *parts)

    out = [one for one in first if number("leaves", one.tag) >= pair.leave]
    taken = Taken()
    for one in out:
        taken.add_placed(one, bounds(one.place))
    last = len(first)
    for group in groups:
        slots = count()
        there = sum(one.group == group.name for one in first)
        for i in range(there):
            if number("arrives", group.name, i) < pair.arrive:
                last += 1
                out.append(place_one(group, there + i, draw, bounds, ground, taken, slots, last))
    return out


def changes(earlier: Sequence[Placed], later: Sequence[Placed]) -> dict[str, str]:
    """Of every tag whether the object stays, leaves or arrives."""
    tags = [{one.tag for one in placed} for placed in (earlier, later)]
    return {tag: "stays" if all(tag in t for t in tags) else "leaves" if tag in tags[0] else "arrives" for tag in sorted(tags[0] | tags[1])}


def write_change(earlier: xr.Dataset, later: xr.Dataset, change: dict[str, str], path: Path) -> None:
    """A grey picture: where an object is seen that leaves (1), one that has come (2), or both (3)."""
    picture = _shown(earlier, {t for t, c in change.items() if c == "leaves"}) * LEFT + _shown(later, {t for t, c in change.items() if c == "arrives"}) * CAME
    _write_png(path, picture.astype(np.uint8))


def _shown(dataset: xr.Dataset, tags: set[str]) -> npt.NDArray[np.bool_]:
    names: list[Any] = list(dataset["tag"].attrs["class_names"])
    return np.isin(dataset["tag"].values, [i for i, name in enumerate(names) if i and name in tags])


__all__ = ["LATER", "Pair", "changes", "place_later", "read_pair", "write_change"]
