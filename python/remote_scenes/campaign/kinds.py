"""Kinds of sensors, also of those that name a preset, and what the renderer leaves of laser radars."""
from __future__ import annotations

import os
from functools import lru_cache
from pathlib import Path
from typing import Any, Iterable, Mapping, Sequence

import yaml

from ..errors import InputError
from ..programs import run_program

_RESPONSE = "_response.h5"
_PARTS = 2
"""Channels before those of tags: `single` and `multiple` (formats/response/FORMAT.md)."""


def kind_of(sensor: Mapping[str, Any]) -> str | None:
    """`kind`, or that of its preset; None where neither says one, which the renderer refuses."""
    kind = sensor.get("kind") or (_preset(str(sensor["preset"])).get("kind") if "preset" in sensor else None)
    return None if kind is None else str(kind)


def lidar_name(sensor: Mapping[str, Any]) -> str:
    """Of the files of a laser radar."""
    return str(sensor.get("name") or (_preset(str(sensor["preset"])).get("name") if "preset" in sensor else None) or "lidar")


@lru_cache(maxsize=64)
def _preset(name: str) -> dict[str, Any]:
    try:
        texts = yaml.safe_load(run_program("dirsig-render", ["--preset", name]).stdout)
    except InputError:
        return {}  # there is none: the renderer says so with its place
    return texts[0] if isinstance(texts, list) and texts and isinstance(texts[0], dict) else {}


def keep_lidar_files(sensors: Sequence[Mapping[str, Any]], tags: Iterable[str], out: Path, new: Path, ending: str, keep: Sequence[str]) -> list[dict[str, Any]]:
    """Moves what laser radars have left in the folder `out` to a sample's folder, without folders of their own: NAME_response.h5 (`response`, and
    always where there is no detector), and the files of the detectors (`points`). ending: of the names. Returns their records: name, files, and by the objects' tags
    the number that `tag` has in a file of points, which is the channel of the response."""
    found = []
    for sensor in sensors:
        if kind_of(sensor) != "lidar":
            continue
        name, files = lidar_name(sensor), []
        detected = (out / name).is_dir()
        if ("response" in keep or not detected) and (out / (name + _RESPONSE)).is_file():
            files.append((out / (name + _RESPONSE), f"{name}{ending}{_RESPONSE}"))
        if "points" in keep and detected:
            files += [(path, f"{name}{ending}_{path.name}") for path in sorted((out / name).iterdir())]
        for path, own in files:
            os.replace(path, new / own)
        found.append({"name": name + ending, "files": [own for _, own in files], "tags": {tag: number for number, tag in enumerate(tags, _PARTS)}})
    return found
