"""Training data: an image cut into chips with labels from its truth, in the layout of COCO (images and one JSON file).

Based on: T.-Y. Lin et al., "Microsoft COCO: Common Objects in Context", 2014, and the data format of the COCO project
(object detection; run-length codes go down the columns and begin with what is not the object).
"""
from __future__ import annotations

import json
import os
import struct
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, Mapping, Sequence, Union

import numpy as np
import xarray as xr

from .results import Result
from .tree import FileName

Mask = np.ndarray[Any, np.dtype[np.bool_]]
Pixels = np.ndarray[Any, Any]


def write_chips(datasets: Union[xr.Dataset, Mapping[str, xr.Dataset], Result], folder: FileName, *, size: int = 256,
                stride: int | None = None, category: Literal["tag", "material"] = "tag", names: Union[str, Sequence[str], None] = None,
                bands: Union[str, Sequence[str], None] = None, stretch: tuple[float, float] = (1, 99),
                value_range: tuple[float, float] | None = None, segmentation: Literal["rle", "polygon"] = "rle",
                min_area: int = 1, keep_empty: bool = True, cubes: bool = False) -> dict[str, Any]:
    """Writes chips of images as `folder/images/*.png` and their labels as `folder/annotations.json`; returns the labels.

    datasets: one of a Result, several by name, or a Result, of which all images are taken. Objects are the instances of the truth (a sensor with `truth: [tag, instance, ...]`
    or `[material, instance, ...]`): a pixel belongs to the instance, tag and material that most of its samples met first.
    By tag, a group with a tag is one object (`truth_object`); `instance` of a label is then its first one.
    category: what names them; untagged ones are no objects. names: the categories, in the order of their numbers from 1;
    else those that occur in the scene, which are the same for all images of one scene; others than these are left out.
    size, stride: pixels; chips at the right and lower edge are moved inwards so that all are whole, smaller images are one
    chip. bands: a name, or one or three in a list; else the header's default bands. stretch: percent of the pixels of an image that are
    black in one of the bands, and not white in any; value_range: instead, in the unit of the image. segmentation: run
    lengths, or polygons along the edges of pixels (objects with holes keep run lengths: polygons of COCO have none).
    min_area: pixels in a chip below which there is no label. keep_empty: chips without objects, too. cubes: beside every
    PNG an .npy with all bands as stored, (band, y, x).
    ValueError: no such truth, band, category or kind of segmentation, sizes below 1, a range without width.
    """
    several = _several(datasets)
    _check_choices(size, stride, category, segmentation, value_range)
    categories = _categories(several, category, names)
    out = Path(folder)
    (out / "images").mkdir(parents=True, exist_ok=True)
    labels: dict[str, Any] = {
        "info": {"description": f"objects by {category}", "version": "1"}, "licenses": [], "images": [], "annotations": [],
        "categories": [{"id": i + 1, "name": name, "supercategory": category} for i, name in enumerate(categories)]}
    for name, dataset in several.items():
        scene = _Objects.of(name, dataset, category, categories)
        picture = _picture(dataset, bands, stretch, value_range)
        height, width = picture.shape[:2]
        for top in _starts(height, size, stride or size):
            for left in _starts(width, size, stride or size):
                window = (slice(top, min(top + size, height)), slice(left, min(left + size, width)))
                found = scene.annotations(window, segmentation, min_area)
                if not found and not keep_empty:
                    continue
                chip = picture[window]
                file = f"{name}_{top:05d}_{left:05d}.png"
                _write_png(out / "images" / file, chip)
                image = {"id": len(labels["images"]) + 1, "file_name": file, "width": chip.shape[1], "height": chip.shape[0],
                         "source": name, "left": left, "top": top}
                if utc := dataset.attrs.get("acquisition_time"):
                    image["date_captured"] = utc
                if cubes:
                    image["cube"] = file.replace(".png", ".npy")
                    np.save(out / "images" / image["cube"], dataset[_quantity(dataset)].values[(slice(None), *window)])
                labels["images"].append(image)
                for a in found:
                    labels["annotations"].append({"id": len(labels["annotations"]) + 1, "image_id": image["id"], **a})
    temporary = out / f".annotations.{os.getpid()}"
    temporary.write_text(json.dumps(labels), encoding="utf-8")
    os.replace(temporary, out / "annotations.json")
    return labels


def _several(datasets: Union[xr.Dataset, Mapping[str, xr.Dataset], Result]) -> dict[str, xr.Dataset]:
    if isinstance(datasets, xr.Dataset):
        return {"image": datasets}
    return {name: datasets[name] for name in datasets} if isinstance(datasets, Result) else dict(datasets)


def _check_choices(size: int, stride: int | None, category: str, segmentation: str,
                   value_range: tuple[float, float] | None) -> None:
    for name, value in (("size", size), ("stride", stride)):
        if value is not None and value < 1:
            raise ValueError(f"{name} must be at least 1, not {value}")
    if category not in ("tag", "material"):
        raise ValueError(f"category is 'tag' or 'material', not '{category}'")
    if segmentation not in ("rle", "polygon"):
        raise ValueError(f"segmentation is 'rle' or 'polygon', not '{segmentation}'")
    if value_range is not None and not value_range[0] < value_range[1]:
        raise ValueError(f"value_range is (black, white), the lower first, not {tuple(value_range)}")


def _categories(datasets: Mapping[str, xr.Dataset], category: str,
                names: Union[str, Sequence[str], None]) -> list[str]:
    there = _names_of(datasets, category)
    if names is None:
        return there
    chosen = [names] if isinstance(names, str) else list(names)
    if not set(chosen) & set(there):
        raise ValueError(f"no {category} is named {', '.join(chosen) or '(names is empty)'}; there is: {', '.join(there)}")
    return chosen


def _quantity(dataset: xr.Dataset) -> str:
    return str(next(iter(dataset.data_vars)))


def _names_of(datasets: Mapping[str, xr.Dataset], category: str) -> list[str]:
    names: list[str] = []
    for name, dataset in datasets.items():
        for one in _classes(name, dataset, category).attrs["class_names"][1:]:
            if one not in names:
                names.append(one)
    return names


def _classes(name: str, dataset: xr.Dataset, category: str) -> xr.DataArray:
    if category not in dataset or "class_names" not in dataset[category].attrs:
        raise ValueError(f"'{name}' has no classes by {category}: give its sensor `truth: [{category}, instance]`"
                         + (", and placements of the scene a tag" if category == "tag" else ""))
    return dataset[category]


def _starts(length: int, size: int, stride: int) -> list[int]:
    """Where chips begin along one side; the last one ends with the picture."""
    last = max(length - size, 0)
    return [*range(0, last, stride), last]


@dataclass(frozen=True)
class _Objects:
    """The objects of one image: for every pixel the number of its object (0 = none), and of each its category and size."""

    number: np.ndarray[Any, np.dtype[np.int64]]
    category: list[int]
    instance: list[int]
    area: np.ndarray[Any, np.dtype[np.int64]]

    @staticmethod
    def of(name: str, dataset: xr.Dataset, category: str, categories: Sequence[str]) -> _Objects:
        classes = _classes(name, dataset, category)
        if "truth_instance" not in dataset:
            raise ValueError(f"'{name}' does not know which instance a pixel shows: give its sensor "
                             f"`truth: [{category}, instance]`")
        known = {one: i + 1 for i, one in enumerate(categories)}
        # Of each class its category, 0 = none: nothing or untagged, and what the caller did not name.
        of_class = np.array([0] + [known.get(one, 0) for one in classes.attrs["class_names"][1:]], dtype=np.int64)
        kind = of_class[classes.values.astype(np.int64)]
        instance = dataset["truth_object" if category == "tag" and "truth_object" in dataset else "truth_instance"].values
        there = (kind > 0) & np.isfinite(instance)
        pairs = np.stack([np.where(there, kind, 0), np.where(there, instance, 0).astype(np.int64)], axis=-1).reshape(-1, 2)
        unique, inverse = np.unique(pairs, axis=0, return_inverse=True)
        if not len(unique) or unique[0, 0] != 0:
            unique, inverse = np.vstack([[[0, 0]], unique]), inverse + 1
        number = np.asarray(inverse, dtype=np.int64).reshape(there.shape)
        return _Objects(number, unique[:, 0].tolist(), unique[:, 1].tolist(), np.bincount(number.ravel(), minlength=len(unique)))

    def annotations(self, window: tuple[slice, slice], segmentation: str, min_area: int) -> list[dict[str, Any]]:
        """The labels of a chip, without their numbers."""
        number = self.number[window]
        out = []
        for i in np.unique(number):
            if i == 0:
                continue
            mask: Mask = number == i
            area = int(mask.sum())
            if area < min_area:
                continue
            rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
            polygons = _polygons(mask) if segmentation == "polygon" else None
            out.append({
                "category_id": self.category[i], "iscrowd": 0, "area": area,
                "bbox": [int(columns[0]), int(rows[0]), int(columns[-1] - columns[0] + 1), int(rows[-1] - rows[0] + 1)],
                "segmentation": polygons or {"size": list(mask.shape), "counts": _run_lengths(mask)},
                "instance": self.instance[i], "share_in_chip": area / int(self.area[i])})
        return out


def _run_lengths(mask: Mask) -> list[int]:
    flat = mask.ravel(order="F")
    changes = np.flatnonzero(flat[1:] != flat[:-1]) + 1
    counts: list[int] = np.diff(np.concatenate([[0], changes, [flat.size]])).tolist()
    return [0, *counts] if flat[0] else counts


def _polygons(mask: Mask) -> list[list[int]] | None:
    """Outlines along the edges of pixels, clockwise in the picture, [x, y, x, y, ...]; None when there is a hole. Pixels
    that touch at a corner only belong to different outlines.
    """
    padded = np.pad(mask, 1)
    follow: dict[tuple[int, int], list[tuple[int, int]]] = {}
    # Directed edges with the object to their right: the four sides of every pixel whose neighbour there is none.
    for (dy, dx), (begin, end) in {(-1, 0): ((0, 0), (1, 0)), (0, 1): ((1, 0), (1, 1)), (1, 0): ((1, 1), (0, 1)),
                                   (0, -1): ((0, 1), (0, 0))}.items():
        free = mask & ~padded[1 + dy:1 + dy + mask.shape[0], 1 + dx:1 + dx + mask.shape[1]]
        for y, x in np.argwhere(free).tolist():
            follow.setdefault((x + begin[0], y + begin[1]), []).append((x + end[0], y + end[1]))
    rings = []
    while follow:
        start = next(iter(follow))
        before, at = first = (start, follow[start][0])
        ring: list[tuple[int, int]] = []
        while True:
            # Of two ways on, that to the right keeps to the same pixel.
            ways = follow[at]
            dx, dy = at[0] - before[0], at[1] - before[1]
            right = (at[0] - dy, at[1] + dx)
            after = right if right in ways else ways[0]
            ways.remove(after)
            if not ways:
                del follow[at]
            if (after[0] - at[0], after[1] - at[1]) != (dx, dy):
                ring.append(at)
            before, at = at, after
            if (before, at) == first:
                break
        rings.append(ring)
    if any(_twice_area(ring) < 0 for ring in rings):
        return None
    return [[c for corner in ring for c in corner] for ring in rings]


def _twice_area(ring: list[tuple[int, int]]) -> int:
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(ring, ring[1:] + ring[:1]))


def _picture(dataset: xr.Dataset, bands: Union[str, Sequence[str], None], stretch: tuple[float, float],
             value_range: tuple[float, float] | None) -> Pixels:
    """uint8 as [y, x] or [y, x, 3]; linear between ends that all bands share, then sRGB."""
    array = dataset[_quantity(dataset)]
    there = [str(b) for b in array["band"].values]
    chosen = [bands] if isinstance(bands, str) else list(bands) if bands is not None else [there[i - 1] for i in dataset.attrs.get("default_bands", [1])]
    if len(chosen) not in (1, 3) or not set(chosen) <= set(there):
        raise ValueError(f"a picture has one or three of the bands {', '.join(there)}, not {', '.join(chosen)}")
    values = np.stack([array.values[there.index(b)] for b in chosen], axis=-1).astype(np.float64)
    known: Mask = np.isfinite(values.sum(axis=-1))
    if value_range is None:
        some = values[known] if known.any() else np.zeros((1, len(chosen)))
        value_range = (float(np.percentile(some.min(axis=-1), stretch[0])), float(np.percentile(some.max(axis=-1), stretch[1])))
    low, high = value_range
    t = np.clip((np.where(known[..., None], values, low) - low) / (high - low if high > low else 1), 0, 1)
    srgb = np.where(t <= 0.0031308, 12.92 * t, 1.055 * t ** (1 / 2.4) - 0.055)
    pixels = np.round(255 * srgb).astype(np.uint8)
    return pixels if len(chosen) == 3 else pixels[..., 0]


def _write_png(path: Path, pixels: Pixels) -> None:
    """8 bits a channel, grey or red, green and blue (ISO/IEC 15948)."""
    height, width = pixels.shape[:2]
    rows = np.concatenate([np.zeros((height, 1), np.uint8), pixels.reshape(height, -1)], axis=1).tobytes()

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2 if pixels.ndim == 3 else 0, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 6)) + chunk(b"IEND", b""))
