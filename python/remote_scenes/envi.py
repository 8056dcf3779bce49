"""ENVI images as they are stored: a raw cube `name.img` beside a text header (formats/envi/FORMAT.md).

Numbers are mapped from the file, never converted: what comes back has the bits that are stored.
"""
from __future__ import annotations

import os
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from .georeference import add_coordinates
from .tree import FileName

_TYPES = {1: "u1", 2: "i2", 3: "i4", 4: "f4", 5: "f8", 12: "u2", 13: "u4", 14: "i8", 15: "u8"}
_MICRON = {"micrometers": 1.0, "um": 1.0, "microns": 1.0, "nanometers": 1e-3, "nm": 1e-3, "millimeters": 1e3, "mm": 1e3,
           "centimeters": 1e4, "cm": 1e4, "meters": 1e6, "m": 1e6}
_UDUNITS = {"W/(m2 sr um)": "W m-2 sr-1 um-1", "W/(cm2 sr um)": "W cm-2 sr-1 um-1", "photons/(s m2 sr um)": "s-1 m-2 sr-1 um-1",
            "W/(m2 um)": "W m-2 um-1", "reflectance": "1", "e": "1", "electrons": "1", "DN": "1", "deg": "degree",
            "kg/m2": "kg m-2"}


class FormatError(ValueError):
    """A file is not what it should be: "FILE:LINE: what is wrong"."""


@dataclass
class EnviHeader:
    """A header. `keys` has all of it as text, by lower-case key; lists stand with their braces."""

    file: str
    samples: int
    lines: int
    bands: int
    dtype: np.dtype[Any]
    interleave: str
    offset: int
    keys: dict[str, str] = field(repr=False)

    def text(self, key: str) -> str:
        """The value of a key without braces; empty when it is not there."""
        return self.keys.get(key, "").strip("{}").strip()

    def items(self, key: str) -> list[str]:
        """The items of a list; empty when it is not there."""
        text = self.text(key)
        return [item.strip() for item in text.split(",")] if text else []

    def numbers(self, key: str) -> list[float]:
        """The items of a list as numbers. FormatError when one is none."""
        try:
            return [float(item) for item in self.items(key)]
        except ValueError as fault:
            raise FormatError(f"{self.file}: '{key}' is no list of numbers: {fault}") from None

    def per_band(self, key: str) -> list[float]:
        """A list with a number for each band. FormatError when it has another length; empty when it is not there."""
        numbers = self.numbers(key)
        if numbers and len(numbers) != self.bands:
            raise FormatError(f"{self.file}: {len(numbers)} numbers in '{key}' for {self.bands} bands")
        return numbers

    @property
    def band_names(self) -> list[str]:
        """A name for each band: as in the header, else "band 1" and so on."""
        names = self.items("band names")
        if names and len(names) != self.bands:
            raise FormatError(f"{self.file}: {len(names)} band names for {self.bands} bands")
        return names or [f"band {i + 1}" for i in range(self.bands)]


def udunits(unit: str) -> str:
    """A unit of the suite's files as UDUNITS (and so CF) writes it; unknown ones stay as they are."""
    return _UDUNITS.get(unit, unit)


def header_path(image: FileName) -> Path:
    """The header of an image: `image.hdr`, or the image with its ending replaced. FormatError when there is none."""
    path = Path(image)
    if path.suffix == ".hdr":
        return path
    for candidate in (path.with_name(path.name + ".hdr"), path.with_suffix(".hdr")):
        if candidate.is_file():
            return candidate
    raise FormatError(f"{path}: it has no header {path.name}.hdr beside it")


def read_header(image: FileName) -> EnviHeader:
    """Reads the header of an image (or a header itself). FormatError: what is wrong, and in which line."""
    path = header_path(image)
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    if not lines or lines[0].strip() != "ENVI":
        raise FormatError(f"{path}:1: not an ENVI header, whose first line is 'ENVI'")
    keys: dict[str, str] = {}
    at = 1
    while at < len(lines):
        first, line = at, lines[at]
        at += 1
        if not line.strip() or line.lstrip().startswith(";"):
            continue
        key, equals, value = line.partition("=")
        if not equals:
            raise FormatError(f"{path}:{first + 1}: '{line.strip()[:40]}' is not 'key = value'")
        while value.lstrip().startswith("{") and "}" not in value:
            if at == len(lines):
                raise FormatError(f"{path}:{first + 1}: the braces of '{key.strip()}' are not closed")
            value += "\n" + lines[at]
            at += 1
        name = re.sub(r"\s+", " ", key.strip().lower())
        if name in keys:
            raise FormatError(f"{path}:{first + 1}: '{name}' stands there twice")
        keys[name] = value.strip()

    def whole(key: str, default: int | None = None, least: int = 0) -> int:
        text = keys.get(key, "" if default is None else str(default))
        if not re.fullmatch(r"\d+", text) or int(text) < least:
            raise FormatError(f"{path}: '{key}' is {text or 'missing'}; a whole number from {least} is needed")
        return int(text)

    kind = whole("data type")
    if kind not in _TYPES:
        raise FormatError(f"{path}: data type {kind} is not known; known: {', '.join(map(str, _TYPES))}")
    interleave = keys.get("interleave", "").lower()
    if interleave not in ("bsq", "bil", "bip"):
        raise FormatError(f"{path}: interleave is '{interleave}'; known: bsq, bil, bip")
    dtype = np.dtype((">" if whole("byte order") else "<") + _TYPES[kind])
    return EnviHeader(str(path), whole("samples", least=1), whole("lines", least=1), whole("bands", least=1), dtype, interleave,
                      whole("header offset", 0), keys)


def read_values(image: FileName, header: EnviHeader | None = None) -> np.ndarray[Any, Any]:
    """The numbers as [band, line, sample], mapped from the file (read-only). FormatError unless the file has exactly the
    bytes that the header says.
    """
    h = header or read_header(image)
    path = Path(image)
    wanted = h.offset + h.samples * h.lines * h.bands * h.dtype.itemsize
    there = os.path.getsize(path)
    if there != wanted:
        raise FormatError(f"{path}: {there} bytes; its header says {wanted}")
    shape, axes = {"bsq": ((h.bands, h.lines, h.samples), (0, 1, 2)), "bil": ((h.lines, h.bands, h.samples), (1, 0, 2)),
                   "bip": ((h.lines, h.samples, h.bands), (2, 0, 1))}[h.interleave]
    mapped = np.memmap(path, dtype=h.dtype, mode="r", offset=h.offset, shape=shape)
    return np.asarray(mapped).transpose(axes)


def open_envi(image: FileName) -> xr.DataArray:
    """An ENVI image as it is stored, with the dimensions (band, y, x).

    Coordinates: `band` (names), `wavelength_um` and `fwhm_um` where the header has them, and on a map `x`, `y` (centres of
    pixels) and `spatial_ref` (the coordinate system as CF and rioxarray have it). Attributes: `units` (as UDUNITS writes
    them), `description`, `acquisition_time`, `sun_azimuth_deg`, `sun_elevation_deg`, `ignore_value` (the number that is no
    measurement; it stays in the numbers), `scale_factor` (of counts: what one stands for), classes and flags as CF has
    them. FormatError when header and file do not agree.
    """
    h = read_header(image)
    array = xr.DataArray(read_values(image, h), dims=("band", "y", "x"), coords={"band": h.band_names},
                         name=Path(image).stem, attrs=attributes_of(h))
    for key, name, about in (("wavelength", "wavelength_um", "centre wavelength"),
                             ("fwhm", "fwhm_um", "full width at half maximum")):
        if numbers := h.per_band(key):
            scale = micron_of(h)
            scaled = [n * scale for n in numbers] if scale != 1 else numbers
            array = array.assign_coords({name: ("band", scaled, {"units": "um", "long_name": about})})
    if "wavelength_um" in array.coords:
        array["wavelength_um"].attrs["standard_name"] = "radiation_wavelength"
    array["band"].attrs["long_name"] = "name of the band"
    return add_coordinates(array, h.items("map info"), h.text("coordinate system string"), h.file)


def micron_of(h: EnviHeader) -> float:
    """Micrometres of one of the header's units of wavelength. FormatError: it is not known."""
    unit = h.text("wavelength units").lower()
    if unit not in _MICRON:
        raise FormatError(f"{h.file}: 'wavelength units' is '{unit}'; known: {', '.join(_MICRON)}")
    return _MICRON[unit]


def attributes_of(h: EnviHeader) -> dict[str, Any]:
    """What a header states of its image, as open_envi has it."""
    attrs: dict[str, Any] = {"long_name": re.split(r" of sensor |[;\n]", h.text("description"))[0]}
    if h.text("data units"):
        attrs["units"] = udunits(h.text("data units"))
    for key in ("description", "acquisition time"):
        if h.text(key):
            attrs[key.replace(" ", "_")] = h.text(key)
    for key, name in (("sun azimuth", "sun_azimuth_deg"), ("sun elevation", "sun_elevation_deg"),
                      ("data ignore value", "ignore_value")):
        if h.text(key):
            attrs[name] = h.numbers(key)[0]
    if gains := h.per_band("data gain values"):
        if len(set(gains)) > 1:
            raise FormatError(f"{h.file}: bands with gains of their own are not known")
        attrs["scale_factor"] = gains[0]
    if h.text("default bands"):
        attrs["default_bands"] = [int(n) for n in h.numbers("default bands")]
    return attrs | _meanings(h)


def _meanings(h: EnviHeader) -> dict[str, Any]:
    """Of classifications and flags, what the numbers mean: as CF has it, and the names as they are."""
    names, values, kind = h.items("class names"), [], "flag_values"
    values = list(range(len(names)))
    if h.items("quality bits"):
        split = [item.partition(" ") for item in h.items("quality bits")]
        names, values, kind = [name for _, _, name in split], [int(bit) for bit, _, _ in split], "flag_masks"
    if not names:
        return {}
    meanings = " ".join(re.sub(r"[^A-Za-z0-9_\-.+@]+", "_", name) or "_" for name in names)
    return {kind: np.array(values, dtype=h.dtype.newbyteorder("=")), "flag_meanings": meanings, "class_names": names}
