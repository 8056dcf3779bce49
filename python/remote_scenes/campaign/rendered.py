"""The images of one sample as labels need them: without coordinates and histories, whose making takes longer than a chip's labels."""
from __future__ import annotations

import re
from pathlib import Path
from typing import Any, Iterator

import xarray as xr

from ..envi import EnviHeader, attributes_of, micron_of, read_header, read_values
from ..results import QUANTITIES, Result, unit_of

_PIXELS = ("y", "x")


def rendered(folder: Path) -> Iterator[tuple[str, xr.Dataset]]:
    """Names and datasets, as Result has them but for what is said above; images of detectors' counts and of points as Result has them in all."""
    result = Result(folder)
    for name in result.images:
        header = read_header(folder / f"{name}.img")
        plain = header.text("description").split(" of sensor ")[0].split(";")[0].split("\n")[0] in QUANTITIES and not header.text("data gain values")
        yield name, _plain(folder, name, header) if plain else result[name].load()


def _plain(folder: Path, name: str, header: EnviHeader) -> xr.Dataset:
    about = attributes_of(header)
    dims = ("band", *_PIXELS)
    parts: dict[str, Any] = {QUANTITIES[about["long_name"]]: (dims, read_values(folder / f"{name}.img", header), about),
                             "standard_error": (dims, read_values(folder / f"{name}_error.img"))}
    for product in ("quality", "material", "tag"):
        path = folder / f"{name}_{product}.img"
        if path.exists():
            inner = read_header(path)
            parts[product] = (_PIXELS, read_values(path, inner)[0], attributes_of(inner))
    if (path := folder / f"{name}_truth.img").exists():
        inner = read_header(path)
        for values, column in zip(read_values(path, inner), inner.band_names):
            parts.setdefault("truth_" + re.sub(r"\W+", "_", unit_of(column)[0]), (_PIXELS, values))
    coords: dict[str, Any] = {"band": header.band_names}
    if wavelength := header.per_band("wavelength"):
        scale = micron_of(header)
        coords["wavelength_um"] = ("band", [w * scale for w in wavelength] if scale != 1 else wavelength)
    kept = {k: about[k] for k in ("acquisition_time", "default_bands") if k in about}
    return xr.Dataset(parts, coords, kept)
