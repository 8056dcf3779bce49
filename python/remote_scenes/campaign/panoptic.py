"""Panoptic labels: of every pixel its object, or what the ground there is made of.

Based on: A. Kirillov et al., "Panoptic Segmentation", CVPR 2019, and the panoptic format of the COCO project: pictures whose colours are numbers of
segments (red + 256 green + 65536 blue, 0 = none), and one JSON file.
"""
from __future__ import annotations

import json
from itertools import chain
from pathlib import Path
from typing import Any, Iterator, Mapping, Sequence

import numpy as np
import numpy.typing as npt
import xarray as xr

from ..chips import _write_png
from .campaign import Campaign
from .exports import images, joined
from .placement import Placed
from .whole_files import write_parts

STUFF = 1_000_000
"""Numbers of segments of ground begin here; those of objects are the numbers of the objects, from 1."""


def write_segments(dataset: xr.Dataset, placed: Sequence[Placed], classes: Sequence[str], stuff: Mapping[str, str], path: Path) -> list[dict[str, Any]]:
    """Writes the picture of one image's segments; returns what each is. stuff: the class of every material of the scene that has one."""
    number = np.zeros(dataset["tag"].shape, np.int64)
    segments = []

    def add(mask: npt.NDArray[np.bool_], identity: int, category: int) -> None:
        if mask.any():
            number[mask] = identity
            rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
            box = [int(columns[0]), int(rows[0]), int(columns[-1] - columns[0] + 1), int(rows[-1] - rows[0] + 1)]
            segments.append({"id": identity, "category_id": category, "area": int(mask.sum()), "bbox": box, "iscrowd": 0})

    tag, tags = dataset["tag"].values, dataset["tag"].attrs["class_names"]
    for one in placed:
        if one.tag in tags:
            add(tag == tags.index(one.tag), one.number, classes.index(one.class_name) + 1)
    names, material = stuff_classes(stuff), dataset["material"].values
    free = number == 0
    for i, name in enumerate(names):
        mine = [k for k, m in enumerate(dataset["material"].attrs["class_names"]) if k and stuff.get(m) == name]
        add(free & np.isin(material, mine), STUFF + i, len(classes) + 1 + i)
    _write_png(path, np.stack([number >> shift & 255 for shift in (0, 8, 16)], axis=-1).astype(np.uint8))
    return segments


def stuff_classes(stuff: Mapping[str, str]) -> list[str]:
    """Names of the classes of ground, in the order of their numbers, which follow those of the objects."""
    return list(dict.fromkeys(stuff.values()))


def write_panoptic(campaign: Campaign, folder: Path) -> None:
    """`panoptic.json`; its pictures are in the samples."""
    things = [{"id": i, "name": name, "supercategory": "object", "isthing": 1} for i, name in enumerate(campaign.classes, 1)]
    stuff = [{"id": len(things) + 1 + i, "name": name, "supercategory": "ground", "isthing": 0} for i, name in enumerate(stuff_classes(campaign.stuff))]
    head = {"info": {"description": campaign.description or campaign.name, "version": "1"}, "licenses": [], "categories": things + stuff}

    def pictures() -> Iterator[dict[str, Any]]:
        for number, image in enumerate(images(folder), 1):
            yield {"id": number, "file_name": image.file, "width": image.size[0], "height": image.size[1], "sample": image.sample}

    def annotations() -> Iterator[dict[str, Any]]:
        for number, image in enumerate(images(folder), 1):
            yield {"image_id": number, "file_name": image.file[:-len(".png")] + "_panoptic.png", "segments_info": image.about.get("segments", [])}

    parts = (json.dumps(head)[:-1], ', "images": [')
    write_parts(folder / "panoptic.json", chain(parts, joined(pictures()), ['], "annotations": ['], joined(annotations()), ["]}\n"]))
