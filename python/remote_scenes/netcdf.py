"""Datasets as NetCDF files that keep to CF."""
from __future__ import annotations

import importlib.util
import os
from pathlib import Path
from typing import Any, Literal

import numpy as np
import xarray as xr

from .tree import FileName

_Engine = Literal["netcdf4", "h5netcdf"]


def write_netcdf(dataset: xr.Dataset, path: FileName, *, engine: _Engine | None = None, compress: int = 4) -> Path:
    """Writes a dataset of Result as NetCDF-4 (CF-1.10), whole or not at all. compress: 0 (not) to 9.

    engine: "netcdf4" or "h5netcdf"; the one that is installed unless given, ImportError without any. `dataset.to_netcdf`
    writes the same numbers; this adds `Conventions`, `history` and compression, and says which numbers are no measurement
    (`_FillValue`). The names of bands stand in `band_name`: coordinates of CF are numbers (`back.set_index(band="band_name")`).
    """
    if engine is None:
        modules: dict[_Engine, tuple[str, ...]] = {"netcdf4": ("netCDF4",), "h5netcdf": ("h5netcdf", "h5py")}
        there = [name for name, needed in modules.items() if all(map(importlib.util.find_spec, needed))]
        if not there:
            raise ImportError("NetCDF needs netCDF4 (pip install netCDF4), or h5netcdf and h5py")
        engine = there[0]
    target = Path(path)
    names = dataset["band"]
    out = dataset.drop_vars("band").assign_coords(band_name=("band", names.values, names.attrs))
    encoding: dict[str, dict[str, Any]] = {}
    for name in out.variables:
        variable = out[name].variable
        about: dict[str, Any] = {}
        if np.issubdtype(variable.dtype, np.floating):
            about["_FillValue"] = None if name in out.coords else variable.dtype.type(np.nan)
        if compress and variable.ndim > 1 and variable.dtype.kind in "fiu":
            about.update(zlib=True, complevel=compress)
        if (no_data := variable.attrs.pop("ignore_value", None)) is not None and not np.isnan(no_data):
            # Told, not applied: xarray would make numbers of the classes floating.
            variable.attrs["missing_value"] = variable.dtype.type(no_data)
        if "class_names" in variable.attrs:
            variable.attrs["class_names"] = "\n".join(variable.attrs["class_names"])
        # Where a grid mapping is, xarray writes it from the encoding.
        if "grid_mapping" in variable.attrs:
            about["grid_mapping"] = variable.attrs.pop("grid_mapping")
        out[name].attrs = dict(variable.attrs)
        encoding[str(name)] = about
    if "time" in out.coords:
        encoding["time"] = {"units": "seconds since 1970-01-01T00:00:00Z", "dtype": "float64", "calendar": "standard"}
    description = out.attrs.pop("description", "")
    title, _, command = description.rpartition("\n")
    out.attrs = {"Conventions": "CF-1.10", "title": title, "source": title, "history": command, **out.attrs}
    temporary = target.with_name(f".{target.name}.{os.getpid()}")
    try:
        out.to_netcdf(temporary, engine=engine, format="NETCDF4", encoding=encoding)
        os.replace(temporary, target)
    finally:
        temporary.unlink(missing_ok=True)
    return target
