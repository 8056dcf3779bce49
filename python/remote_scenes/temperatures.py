"""Temperatures that follow from weather (`heat.h5`, formats/heat_hdf/FORMAT.md), as an xarray dataset."""
from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from .envi import FormatError
from .tree import FileName

_OF_FACES = {"temperature": "moment", "absorbed_sunlight": "moment", "received_infrared": "moment", "path_error": "part",
             "size_error": "part", "step_error": "part", "emissivity": None, "absorptance": None, "sun_hours": None}


def open_temperatures(path: FileName) -> xr.Dataset:
    """A file of found temperatures, in memory.

    Dimensions: `face` (sides of elements), `moment` (`time_s`, seconds of the simulation), `part` (24ths of the span).
    Variables: `temperature`, its errors by cause, `path_error`, `size_error`, `step_error` (K); `absorbed_sunlight` and
    `received_infrared` (W/m2); `emissivity`, `absorptance`, `sun_hours`; `material` (names), `area` (m2), `is_back`;
    `centre` and `normal` (scene ENU); `air_temperature` (K). FileNotFoundError: no such file; FormatError: no such content;
    ImportError: netCDF4 is not installed (pip install netCDF4).
    """
    import netCDF4

    if not Path(path).is_file():
        raise FileNotFoundError(f"{path} is not there")
    try:
        with netCDF4.Dataset(str(path)) as file:
            if getattr(file, "format", None) != "suite heat":
                raise FormatError(f"{path} holds no temperatures of elements (its 'format' is not 'suite heat')")
            return _dataset(file)
    except (OSError, KeyError, IndexError) as error:
        raise FormatError(f"{path} is no file of temperatures, or is damaged: {error}") from error


def _dataset(file: Any) -> xr.Dataset:
    faces, elements = file["faces"], file["elements"]
    element = np.asarray(faces["element"][:])
    begin, end, repeats = (float(x) for x in file.begin_s_end_s_repeats)
    dataset = xr.Dataset(attrs={"begin_s": begin, "end_s": end, "repeats": bool(repeats), "description": str(file.arguments)})
    for name, second in _OF_FACES.items():
        dims = ("face", second) if second else ("face",)
        dataset[name] = (dims, np.asarray(faces[name][:]), {"units": faces[name].units})
    materials = file["materials"]
    names = np.array([str(materials[k]) for k in range(len(materials))])  # one by one: netCDF4 misreads several fixed-length texts at once
    dataset["material"] = ("face", names[np.asarray(elements["material"][:])[element]])
    dataset["area"] = ("face", np.asarray(elements["area"][:])[element], {"units": "m2"})
    dataset["is_back"] = ("face", np.asarray(faces["is_back"][:]).astype(bool))
    for name in ("centre", "normal"):
        values = np.asarray(elements[name][:])[element]
        dataset[name] = (("face", "axis"), values, {"units": "m" if name == "centre" else "1"})
    dataset["air_temperature"] = ("moment", np.asarray(file["air"]["temperature"][:]), {"units": "K"})
    times = np.linspace(begin, end, dataset.sizes["moment"])
    return dataset.assign_coords(time_s=("moment", times, {"units": "s"}), axis=["east", "north", "up"])
