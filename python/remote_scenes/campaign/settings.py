"""The smaller parts of a campaign's text: pictures, labels, formats, and which files are kept."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .text import Node

FORMATS = ("coco", "panoptic", "dota", "yolo", "yolo_obb", "kitti", "geojson", "webdataset", "zarr", "cog", "stac", "croissant")
KEPT = ("image", "error", "quality", "truth", "classes", "depth", "flow", "polarisation", "points", "response")
"""The radiance, its standard error, flags, all truth, classes by tag and material, by rays the depth and the flow to the next frame, degree and angle
of polarisation, and of laser radars what detectors make, and photons by their arrival."""


@dataclass(frozen=True)
class Picture:
    """How the PNG of an image shows it: names of one or three bands (None: the header's), and what is black and white in the image's unit (None:
    percentiles of each image)."""

    bands: tuple[str, ...] | None = None
    range: tuple[float, float] | None = None
    stretch: tuple[float, float] = (1.0, 99.0)


@dataclass(frozen=True)
class Labels:
    """classes: names in the order of their numbers; min_pixels: visible ones below which there is no label; rays: across a pixel, for shares."""

    classes: tuple[str, ...] = ()
    min_pixels: int = 1
    segmentation: Literal["rle", "polygon"] = "rle"
    rays: int = 4
    stuff: dict[str, tuple[str, ...]] | None = None
    """Classes of the ground by the materials that show them; None: each material is a class."""


def read_picture(node: Node | None) -> Picture:
    """`{bands: [NAME, ...], range: [LOW, HIGH], stretch: [LOW, HIGH]}`."""
    if node is None:
        return Picture()
    keys = node.map(("bands", "range", "stretch"))
    bands = tuple(n.text() for n in keys["bands"].list(1)) if "bands" in keys else None
    if bands is not None and len(bands) not in (1, 3):
        raise keys["bands"].error(f"a picture of {len(bands)} bands", "one or three")
    limits = []
    for key in ("range", "stretch"):
        pair = keys[key].numbers(2) if key in keys else None
        if pair and not pair[0] < pair[1]:
            raise keys[key].error(f"'{key}' has no width", "the lower number first")
        limits.append(pair)
    if limits[1] and not 0 <= limits[1][0] < limits[1][1] <= 100:
        raise keys["stretch"].error("'stretch' is in percent", "0 to 100")
    stretch = limits[1] or (1.0, 99.0)
    return Picture(bands, (limits[0][0], limits[0][1]) if limits[0] else None, (stretch[0], stretch[1]))


def read_labels(node: Node | None) -> Labels:
    """`{classes: [NAME, ...], min_pixels, segmentation: rle | polygon, rays, stuff: {CLASS: [MATERIAL, ...]}}`."""
    if node is None:
        return Labels()
    keys = node.map(("classes", "min_pixels", "segmentation", "rays", "stuff"))
    classes = tuple(n.text() for n in keys["classes"].list(1)) if "classes" in keys else ()
    if len(set(classes)) != len(classes):
        raise keys["classes"].error("a class stands there twice")
    return Labels(classes, keys["min_pixels"].integer(1, 1 << 30) if "min_pixels" in keys else 1,
                  "polygon" if "segmentation" in keys and keys["segmentation"].one_of(("rle", "polygon")) == "polygon" else "rle",
                  keys["rays"].integer(1, 16) if "rays" in keys else 4,
                  {name: tuple(m.text() for m in n.list(1)) for name, n in keys["stuff"].map().items()} if "stuff" in keys else None)


def read_formats(node: Node | None) -> tuple[str, ...]:
    """A list of names of FORMATS."""
    return ("coco",) if node is None else tuple(dict.fromkeys(n.one_of(FORMATS) for n in node.list()))


def read_keep(node: Node | None) -> tuple[str, ...]:
    """A list of names of KEPT."""
    return ("image", "error", "quality", "points") if node is None else tuple(dict.fromkeys(n.one_of(KEPT) for n in node.list(1)))
