"""Images of a dataset as arrays of Zarr 3: a group a sensor with one array of all samples for each product, a chunk an image.

Based on: the Zarr core specification, version 3.1 (zarr.json, regular chunk grid, default chunk keys, codecs bytes and gzip).
"""
from __future__ import annotations

import gzip
import json
import os
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ..envi import read_values
from .campaign import Campaign
from .exports import Image, images
from .text import CampaignError
from .whole_files import write_whole

_PRODUCTS = {"": ("radiance", "float32"), "_error": ("standard_error", "float32"), "_quality": ("quality", "uint8")}
_LEVEL = 5  # of gzip


def write_zarr(campaign: Campaign, folder: Path) -> None:
    """`dataset.zarr`: groups by sensor with `radiance`, `standard_error` and `quality` (of what is kept) by sample, band, y, x, and the coordinates
    `sample`, `band` and `wavelength_um`. Written beside and renamed as a whole. CampaignError: images of other sizes or bands."""
    new, target = folder / f".dataset.zarr.{os.getpid()}", folder / "dataset.zarr"
    shutil.rmtree(new, ignore_errors=True)
    try:
        _root(campaign, new)
        groups: dict[str, _Group] = {}
        for image in images(folder):
            name = str(image.about["name"])
            if name not in groups:
                groups[name] = _Group(new / name, image)
            groups[name].add(image, (folder / image.file).parent)
        for group in groups.values():
            group.finish()
        shutil.rmtree(target, ignore_errors=True)
        os.rename(new, target)
    finally:
        shutil.rmtree(new, ignore_errors=True)


def _root(campaign: Campaign, path: Path) -> None:
    about = {"name": campaign.name, "description": campaign.description, "seed": campaign.seed, "campaign": campaign.digest}
    _json(path, {"node_type": "group", "attributes": about})


class _Group:
    """The arrays of one sensor."""

    def __init__(self, path: Path, first: Image) -> None:
        self._path, self._about = path, first.about
        self._numbers: list[int] = []
        self._made: set[str] = set()

    def add(self, image: Image, folder: Path) -> None:
        """One image, as the next chunk."""
        for key in ("width", "height", "bands"):
            if image.about[key] != self._about[key]:
                raise CampaignError(f"sample {image.sample} of '{image.about['name']}' has {key} {image.about[key]}, the first one {self._about[key]}",
                                    "the format zarr where all images of a sensor have one size and the same bands")
        for ending, (product, kind) in _PRODUCTS.items():
            file = folder / f"{image.about['name']}{ending}.img"
            if file.exists():
                self._made.add(ending)
                values = np.ascontiguousarray(read_values(file), kind)
                _chunk(self._path / product, (len(self._numbers), *[0] * 3), values)
        self._numbers.append(image.sample)

    def finish(self) -> None:
        """What describes the arrays, when their length is known."""
        bands, (width, height) = [str(b) for b in self._about["bands"]], (int(self._about["width"]), int(self._about["height"]))
        count = len(self._numbers)
        for ending in self._made:
            product, kind = _PRODUCTS[ending]
            depth = 1 if product == "quality" else len(bands)
            units = {} if product == "quality" else {"units": self._about["unit"]}
            long_name = {"long_name": self._about["quantity"]} if not ending else {}
            _array(self._path / product, (count, depth, height, width), (1, depth, height, width), kind,
                   ("sample", "flags" if product == "quality" else "band", "y", "x"), {**units, **long_name})
        _vector(self._path / "sample", np.array(self._numbers, "int64"), "sample")
        if "wavelength_um" in self._about:
            _vector(self._path / "wavelength_um", np.array(self._about["wavelength_um"], "float64"), "band")
        _json(self._path, {"node_type": "group", "attributes": {"bands": bands}})


def _vector(path: Path, values: npt.NDArray[Any], dimension: str) -> None:
    _chunk(path, (0,), values)
    _array(path, values.shape, values.shape, str(values.dtype), (dimension,), {})


def _chunk(path: Path, place: tuple[int, ...], values: npt.NDArray[Any]) -> None:
    file = path.joinpath("c", *map(str, place))
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(gzip.compress(values.astype(values.dtype.newbyteorder("<")).tobytes(), _LEVEL, mtime=0))


def _array(path: Path, shape: tuple[int, ...], chunk: tuple[int, ...], kind: str, names: tuple[str, ...], attributes: dict[str, Any]) -> None:
    endian = {} if kind == "uint8" else {"configuration": {"endian": "little"}}
    _json(path, {"node_type": "array", "shape": list(shape), "data_type": kind, "fill_value": "NaN" if kind.startswith("float") else 0,
                 "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": list(chunk)}},
                 "chunk_key_encoding": {"name": "default", "configuration": {"separator": "/"}},
                 "codecs": [{"name": "bytes", **endian}, {"name": "gzip", "configuration": {"level": _LEVEL}}],
                 "dimension_names": list(names), "attributes": attributes})


def _json(path: Path, tree: dict[str, Any]) -> None:
    write_whole(path / "zarr.json", json.dumps({"zarr_format": 3, **tree}, indent=1).encode())
