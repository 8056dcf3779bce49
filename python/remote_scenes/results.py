"""What dirsig-render left in a folder, as xarray datasets: one for each image, with errors, flags, truth and classes."""
from __future__ import annotations

import csv
import io
import json
import os
import re
import warnings
from pathlib import Path
from typing import Any, Iterable, Iterator

import numpy as np
import xarray as xr

from .envi import FormatError, open_envi, udunits
from .tree import FileName

QUANTITIES = {"spectral radiance": "radiance", "top-of-atmosphere reflectance": "reflectance",
               "brightness temperature": "brightness_temperature"}
_ABOUT = ("description", "acquisition_time", "sun_azimuth_deg", "sun_elevation_deg", "default_bands")
_TAKEN = re.compile(r"(.+)_(\d{4,})$")


class Result:
    """A folder of results. `images`: names of all its images; `result[name]` is the dataset of one."""

    def __init__(self, folder: FileName, files: Iterable[str] | None = None) -> None:
        """files: names of those that count, when an earlier run may have left others; all unless given. What lies beside an
        image and was made by another command line does not belong to it, and is reported by a warning.
        FileNotFoundError: the folder is not there.
        """
        self.folder = Path(folder)
        self._files = None if files is None else set(files)
        if not self.folder.is_dir():
            raise FileNotFoundError(f"{self.folder} is no folder of results")

    @property
    def images(self) -> list[str]:
        """Names of the images, in the order of the alphabet: those that have their errors and flags beside them."""
        there = {path.name for path in self.folder.glob("*.img") if self._files is None or path.name in self._files}
        return sorted(n[:-4] for n in there if {f"{n[:-4]}_error.img", f"{n[:-4]}_quality.img"} <= there)

    @property
    def log(self) -> dict[str, Any]:
        """What was run (`render.json`)."""
        log: dict[str, Any] = json.loads((self.folder / "render.json").read_text(encoding="utf-8"))
        return log

    def __iter__(self) -> Iterator[str]:
        return iter(self.images)

    def __getitem__(self, name: str) -> xr.Dataset:
        return self.dataset(name)

    def __repr__(self) -> str:
        return f"Result('{self.folder}': {', '.join(self.images) or 'no images'})"

    def dataset(self, name: str | None = None) -> xr.Dataset:
        """An image (the only one, unless named) with all that belongs to it, mapped from the files.

        Variables: `radiance` (or `reflectance`, `brightness_temperature`; of instruments at points `value`) and
        `standard_error` (band, y, x); `quality` (flags), `material` and `tag` (classes; 0 = nothing); `truth_NAME` for
        what the truth holds (NaN where nothing was met); `electrons`, `dn` and `counts` of detectors. Counts of uint16 come in their
        unit, other numbers as they are stored. Coordinates: `band`, `wavelength_um`, `fwhm_um`; `x`, `y`, `spatial_ref` of
        maps; with a geolocation `longitude`, `latitude`, `height_m` (of a scene without an origin `east_m`, `north_m`,
        `up_m`); `time` (UTC) where there is a date. KeyError: no such image; FormatError: a file is damaged.
        """
        name = self._one(name)
        main = open_envi(self.folder / f"{name}.img")
        quantity = QUANTITIES.get(main.attrs["long_name"], "value")
        dataset = xr.Dataset({quantity: _in_units(main)}, attrs={k: main.attrs[k] for k in _ABOUT if k in main.attrs})
        error = open_envi(self.folder / f"{name}_error.img")
        if interval := re.search(r"reaches ([\d.]+) standard errors", error.attrs["description"]):
            error.attrs["standard_errors_of_95_percent"] = float(interval[1])
        dataset["standard_error"] = error
        dataset["quality"] = _flat(open_envi(self.folder / f"{name}_quality.img"))
        for product in ("electrons", "dn", "counts", "material", "tag"):
            if (array := self._beside(name, product, main)) is not None:
                dataset[product] = _flat(array) if product in ("material", "tag") else array.drop_vars("band")
        if (truth := self._beside(name, "truth", main)) is not None:
            dataset.update(_truth(truth, list(dataset["band"].values)))
        for variable in dataset.data_vars.values():  # said once
            for key in _ABOUT[1:]:
                variable.attrs.pop(key, None)
        dataset[quantity].attrs["ancillary_variables"] = "standard_error quality"
        return _located(self._of_points(name, dataset, quantity), self._beside(name, "igm", main))

    def series(self, name: str) -> xr.Dataset:
        """All captures of an image (`NAME_0000`, `NAME_0001`, ...) along a new first dimension `capture`, in memory."""
        taken = [image for image in self.images if (match := _TAKEN.match(image)) and match[1] == name]
        if not taken:
            raise KeyError(f"{self.folder} has no captures '{name}_0000'; it has {', '.join(self.images) or 'no images'}")
        datasets = [self.dataset(image).load() for image in taken]
        joined: xr.Dataset = xr.concat(datasets, "capture", combine_attrs="drop_conflicts", data_vars="all", coords="different",
                                       compat="equals", join="exact")
        command = datasets[0].attrs.get("description", "").rpartition("\n")[2]
        joined.attrs.setdefault("description", f"{len(taken)} captures of '{name}'\n{command}")
        return joined

    def lookup_table(self, name: str | None = None) -> xr.Dataset:
        """The geographic lookup table (GLT) of an image: `sample` and `line` from 1 for every cell of a north-up map,
        negative = from a neighbour, 0 = not seen. FileNotFoundError: the sensor had no `geolocation`.
        """
        name = self._one(name)
        table = self._beside(name, "glt", open_envi(self.folder / f"{name}.img"))
        if table is None:
            raise FileNotFoundError(f"{self.folder}/{name}_glt.img is not there: give the sensor `geolocation: true`")
        parts = {part: table.isel(band=i, drop=True) for i, part in enumerate(("sample", "line"))}
        return xr.Dataset(parts)

    def on_map(self, name: str | None = None, variable: str | None = None) -> xr.DataArray:
        """A variable of an image (its radiance unless named) put on the map by the lookup table; what was not seen is NaN
        (of classes and flags 0).
        """
        name = self._one(name)
        dataset, table = self.dataset(name), self.lookup_table(name)
        array = dataset[variable or next(iter(dataset.data_vars))]
        rows, columns = abs(table["line"].values) - 1, abs(table["sample"].values) - 1
        values = array.values[..., rows, columns]
        seen = table["line"].values != 0
        values = np.where(seen, values, np.nan if np.issubdtype(values.dtype, np.floating) else values.dtype.type(0))
        kept = {k: c for k, c in array.coords.items() if not {"x", "y"} & set(c.dims) and k != "spatial_ref"}
        out = xr.DataArray(values, dims=array.dims, coords=kept, attrs={**array.attrs, "grid_mapping": "spatial_ref"}, name=array.name)
        return out.assign_coords({k: table[k] for k in ("x", "y", "spatial_ref") if k in table.coords})

    def table(self, name: str) -> xr.Dataset:
        """A table `NAME.csv` of a sensor (points, rami, poses): one variable a column, along the dimension `row`."""
        columns = _csv(self.folder / f"{name}.csv")
        return xr.Dataset({key: ("row", values) for key, values in columns.items()})

    def error_correlation(self, name: str | None = None) -> xr.DataArray:
        """The correlation of the errors of the bands, which share their paths, as (band, other_band)."""
        columns = _csv(self.folder / f"{self._one(name)}_error_correlation.csv")
        names = [str(n) for n in columns.pop("band")]
        return xr.DataArray(np.array(list(columns.values()), dtype=float), dims=("band", "other_band"),
                            coords={"band": names, "other_band": names}, name="error_correlation")

    def _one(self, name: str | None) -> str:
        images = self.images
        if name is None and len(images) == 1:
            return images[0]
        if name is None or name not in images:
            wanted = f"no image '{name}'" if name else "several images, say which"
            raise KeyError(f"{self.folder}: {wanted}; there are: {', '.join(images) or 'none'}")
        return name

    def _beside(self, name: str, product: str, main: xr.DataArray) -> xr.DataArray | None:
        """An image that belongs to another one; None when there is none, or one that another run has left."""
        file = f"{name}_{product}.img"
        path = self.folder / file
        if not path.exists() or file[:-4] in self.images or (self._files is not None and file not in self._files):
            return None
        array = open_envi(path)
        commands = [a.attrs.get("description", "").rpartition("\n")[2] for a in (main, array)]
        if self._files is None and commands[0] != commands[1]:
            warnings.warn(f"{path} is left out: it was made by '{commands[1]}', {name}.img by '{commands[0]}'", stacklevel=3)
            return None
        return array

    def _of_points(self, name: str, dataset: xr.Dataset, quantity: str) -> xr.Dataset:
        """Collectors at points have quantities and units of their own, which their table states."""
        if "one column a collector" not in dataset.attrs.get("description", ""):
            return dataset
        table = self.table(name)
        first = slice(None, None, dataset.sizes["band"])  # rows: band by band of each collector
        units = [udunits(str(u)) for u in table["unit"].values[first]]
        dataset = dataset.rename({quantity: "value"}).assign_coords(
            collector=("x", table["name"].values[first]), quantity=("x", table["quantity"].values[first]),
            unit=("x", np.array(units)))
        dataset["value"].attrs["long_name"] = "see the coordinates quantity and unit"
        for variable in ("value", "standard_error"):
            del dataset[variable].attrs["units"]
        return dataset


def _located(dataset: xr.Dataset, places: xr.DataArray | None) -> xr.Dataset:
    """With the coordinates of every pixel, where they are known, and the time."""
    for i, band in enumerate(places["band"].values if places is not None else ()):
        text, unit = unit_of(str(band))
        attrs = {"units": {"longitude": "degrees_east", "latitude": "degrees_north"}.get(text, "m"), "long_name": text}
        if text in ("longitude", "latitude", "height"):
            attrs["standard_name"] = "height_above_reference_ellipsoid" if text == "height" else text
        key = text if unit == "deg" else f"{text}_m"
        assert places is not None
        dataset = dataset.assign_coords({key: (("y", "x"), places.values[i], attrs)})
    if utc := dataset.attrs.get("acquisition_time"):
        moment = np.datetime64(utc.rstrip("Z"), "ns")
        about = {"standard_name": "time", "long_name": "middle of what is shown, UTC"}
        dataset = dataset.assign_coords(time=((), moment, about))
    return dataset


def _in_units(array: xr.DataArray) -> xr.DataArray:
    """Counts as numbers in their unit; anything else as it is. What clipped or is no measurement is for the header to say."""
    scale = array.attrs.pop("scale_factor", None)
    if scale is None:
        return array
    # The number that is none stands for a count.
    if "ignore_value" in array.attrs:
        array.attrs["ignore_value"] *= scale
    return array.copy(data=array.values * float(scale))


def _flat(array: xr.DataArray) -> xr.DataArray:
    return array.isel(band=0, drop=True).drop_vars([c for c in ("wavelength_um", "fwhm_um") if c in array.coords])


def unit_of(column: str) -> tuple[str, str]:
    """"range [m]" is a name and a unit."""
    match = re.fullmatch(r"(.*?) \[(.*)\]", column)
    return (match[1], match[2]) if match else (column, "")


def _truth(truth: xr.DataArray, bands: list[str]) -> dict[str, xr.DataArray]:
    """Columns of the truth by name; those that are there for every band are one variable of (band, y, x)."""
    columns = [unit_of(str(name)) for name in truth["band"].values]
    out: dict[str, xr.DataArray] = {}
    at = 0
    while at < len(columns):
        text, unit = columns[at]
        array = truth.isel(band=at, drop=True)
        stem = text.removesuffix(f" {bands[0]}")
        count = 1
        if stem != text and [t for t, _ in columns[at:at + len(bands)]] == [f"{stem} {b}" for b in bands]:
            text, count = stem, len(bands)
            array = truth.isel(band=slice(at, at + count)).assign_coords(band=bands)
        key = base = "truth_" + re.sub(r"\W+", "_", text)
        while key in out:
            key += "_"
        array.attrs = {"long_name": text, "units": udunits(unit) if unit else "1"}
        if "grid_mapping" in truth.attrs:
            array.attrs["grid_mapping"] = truth.attrs["grid_mapping"]
        if base in ("truth_east", "truth_north", "truth_up"):
            array.attrs["long_name"] += " in scene ENU"
        out[key] = array
        at += count
    return out


def _csv(path: Path) -> dict[str, np.ndarray[Any, Any]]:
    """Columns by name, as numbers where all of one are; lines with # are remarks. FormatError: rows of other lengths."""
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]
    rows = list(csv.reader(io.StringIO("\n".join(lines))))
    if not rows or any(len(row) != len(rows[0]) for row in rows):
        raise FormatError(f"{os.fspath(path)}: no table: rows have different lengths")
    out: dict[str, np.ndarray[Any, Any]] = {}
    for i, key in enumerate(rows[0]):
        texts = [row[i] for row in rows[1:]]
        try:
            out[key] = np.array([float(t) for t in texts])
        except ValueError:
            out[key] = np.array(texts, dtype=str)
    return out
