"""Laser radars: the sensor, its responses (`NAME_response.h5`, formats/response/FORMAT.md) and its points (LAS)."""
from __future__ import annotations

import math
import os
import struct
from ctypes import byref, c_void_p
from pathlib import Path
from typing import Any, Mapping

import numpy as np
import xarray as xr

from .envi import FormatError
from .library import LidarInfo, Opened, ResponseArrays, c_text, library, opened, told, whole
from .tree import FileName, OpenKeys

_LIGHT = 299792458.0  # m/s
_EXTRA = {1: "u1", 2: "i1", 3: "<u2", 4: "<i2", 5: "<u4", 6: "<i4", 7: "<u8", 8: "<i8", 9: "<f4", 10: "<f8"}
_POINT = [("X", "<i4"), ("Y", "<i4"), ("Z", "<i4"), ("intensity", "<u2"), ("returns", "u1"), ("flags", "u1"), ("classification", "u1"),
          ("user", "u1"), ("scan_angle", "<i2"), ("source", "<u2"), ("gps_time", "<f8")]
_PACKET = [("descriptor", "u1"), ("packet_offset", "<u8"), ("packet_bytes", "<u4"), ("location_ps", "<f4"), ("x_t", "<f4"), ("y_t", "<f4"),
           ("z_t", "<f4")]


class Lidar(OpenKeys):
    """A laser radar (apps/dirsig-render/LIDAR.md): `laser`, `receiver`, `gate`, `tasks`, `motion` or `position_m` and `look_at_m`, `scanner`, ..."""

    def __init__(self, *, laser: Mapping[str, Any], receiver: Mapping[str, Any], gate: Mapping[str, Any], tasks: Any, name: str | None = None,
                 **keys: Any) -> None:
        super().__init__(kind="lidar", name=name, laser=laser, receiver=receiver, gate=gate, tasks=tasks, **keys)


def open_response(path: FileName) -> xr.Dataset:
    """Photons by arrival, in memory.

    Dimensions: `pulse`, `row` (a pulse and a pixel), `entry` (a bin of a row that a path reached), `channel`. Variables: of pulses
    `time` (s), `energy` (J), `wavelength` (um), `start` (s after the emission), `emission_place`, `reception_place` (scene ENU, m) and
    rotations (w, x, y, z); of rows `bound` (photons) and `paths`; of entries `entry_row`, `bin` (0 = passive light), `contributions` (deposits), `arrival` (s, NaN
    in bin 0), `range` (m, c t / 2), `value` and `standard_error` (photons, by channel), and `low` and `high`, between which the true value is with 95 % confidence.
    FileNotFoundError: no such file; FormatError:
    no such content; ImportError: netCDF4 is not installed (pip install netCDF4).
    """
    import netCDF4

    if not Path(path).is_file():
        raise FileNotFoundError(f"{path} is not there")
    try:
        with netCDF4.Dataset(str(path)) as file:
            if getattr(file, "format", None) != "suite range response":
                raise FormatError(f"{path} holds no responses of laser pulses (its 'format' is not 'suite range response')")
            return _responses(file)
    except (OSError, KeyError, IndexError) as error:
        raise FormatError(f"{path} is no file of responses, or is damaged: {error}") from error


def _responses(file: Any) -> xr.Dataset:
    width, bins, columns, rows, index, epsg, blocks, _ = (float(x) for x in file.bin_s_bins_columns_rows_group_index_epsg_blocks_pulses)
    parts: dict[str, list[np.ndarray[Any, Any]]] = {}
    counts = []
    for b in range(int(blocks)):
        block = file["block"][str(b)]
        for group in ("pulses", "rows", "entries"):
            for name, variable in block[group].variables.items():
                if name != "begin":
                    parts.setdefault(name, []).append(np.asarray(variable[:]))
        counts.append(np.diff(np.asarray(block["rows/begin"][:]).astype(np.int64)))
    channels = file["channels"]
    names = [str(channels[k]) for k in range(len(channels))]  # one by one: netCDF4 misreads several fixed-length texts at once
    scrambles = np.asarray(file["scrambles"][:]) if "scrambles" in file.variables else None
    return _dataset({name: np.concatenate(values) for name, values in parts.items()}, np.concatenate(counts), names, scrambles,
                    {"bin_s": width, "bins": int(bins), "columns": int(columns), "rows": int(rows), "group_index": index, "epsg": int(epsg),
                     "epoch": str(file.epoch), "description": str(file.arguments)})


def _interval(value: np.ndarray[Any, Any], error: np.ndarray[Any, Any], skewness: np.ndarray[Any, Any], n: float, t: float) -> tuple[Any, Any]:
    """What holds the mean of n scrambles with the confidence of t, Student's quantile (P. Hall, J. R. Statist. Soc. B 54, 1992)."""
    a = skewness / math.sqrt(n)
    some = np.where(np.abs(a) < 1e-6, 1.0, a)

    def student(g: float) -> Any:
        return np.where(np.abs(a) < 1e-6, g, 3 / some * (np.cbrt(1 + some * (g - some / 6)) - 1))
    return np.maximum(0, value - error * student(t)), value - error * student(-t)


def _dataset(flat: Mapping[str, np.ndarray[Any, Any]], counts: np.ndarray[Any, Any], names: list[str], scrambles: Any, about: dict[str, Any]) -> xr.Dataset:
    """counts: entries of each row. scrambles: their number and Student's quantile; None = not known."""
    row = np.repeat(np.arange(len(counts)), counts)
    start = flat["start"][row // (about["columns"] * about["rows"])]
    arrival = np.where(flat["bin"] > 0, start + (flat["bin"].astype(float) - 0.5) * about["bin_s"], np.nan)
    data: dict[str, Any] = {name: ("pulse", flat[name], {"units": unit})
                            for name, unit in (("time", "s"), ("energy", "J"), ("wavelength", "um"), ("start", "s"))}
    for which in ("emission", "reception"):
        data[f"{which}_place"] = (("pulse", "axis"), flat[f"{which}_place"], {"units": "m"})
        data[f"{which}_rotation"] = (("pulse", "quaternion"), flat[f"{which}_rotation"], {"units": "1"})
    data["bound"] = ("row", flat["bound"], {"units": "photons"})
    data["paths"] = ("row", flat["paths"])
    data["entry_row"] = ("entry", row)
    data["bin"] = ("entry", flat["bin"])
    data["contributions"] = ("entry", flat["contributions"])
    data["arrival"] = ("entry", arrival, {"units": "s"})
    data["range"] = ("entry", arrival * _LIGHT / 2, {"units": "m"})
    data["value"] = (("entry", "channel"), flat["value"].reshape(-1, len(names)), {"units": "photons"})
    data["standard_error"] = (("entry", "channel"), np.sqrt(flat["variance"].reshape(-1, len(names))), {"units": "photons"})
    if scrambles is not None and "skewness" in flat:
        low, high = _interval(data["value"][1], data["standard_error"][1], flat["skewness"].astype(float).reshape(-1, len(names)), *map(float, scrambles))
        data["low"], data["high"] = (("entry", "channel"), low, {"units": "photons"}), (("entry", "channel"), high, {"units": "photons"})
    return xr.Dataset(data, coords={"channel": names, "axis": ["east", "north", "up"]}, attrs=about)


class OpenLidar(Opened):
    """A laser radar of a simulation, whose pulses are traced within this process."""

    def __init__(self, path: FileName, sensor: str | None = None) -> None:
        self.path = os.fspath(path)
        super().__init__(opened("rs_lidar_open", self.path, None if sensor is None else c_text(sensor, "the sensor's name")), "rs_lidar_close")
        told()
        info = LidarInfo()
        library().rs_lidar_describe(self._open, byref(info))
        self.pulses: int = info.pulses
        """Shots of the clock; at some no beam may leave the scanner."""
        self.paths: int = info.paths
        """Of a pulse and pixel, unless a call says otherwise."""
        self.seed: int = info.seed
        self.channels: tuple[str, ...] = tuple(library().rs_lidar_channel(self._open, i).decode() for i in range(info.channels))
        self._about = {"bin_s": info.bin_s, "bins": info.bins, "columns": info.columns, "rows": info.rows, "group_index": info.group_index}

    def __enter__(self) -> "OpenLidar":
        return self

    def trace(self, first: int = 0, count: int | None = None, paths: int | None = None, seed: int | None = None) -> xr.Dataset:
        """Photons by arrival of shots `first` to `first` + `count`, as open_response() has them, with the values of dirsig-render to the last bit.
        Detectors are not applied. Every call builds optics and lights again: ask for many pulses at once."""
        first = whole(first, "first", 2 ** 63 - 1)
        count = 2 ** 63 - 1 if count is None else whole(count, "count", 2 ** 63 - 1)
        paths = 0 if paths is None else whole(paths, "paths", 1 << 30, 2)
        handle = c_void_p()
        self._check(library().rs_lidar_trace(self._open, first, count, paths, self.seed if seed is None else whole(seed, "seed", 1 << 53), byref(handle)))
        told()
        try:
            return self._copied(handle)
        finally:
            library().rs_responses_close(handle)

    def _copied(self, handle: c_void_p) -> xr.Dataset:
        a = ResponseArrays()
        library().rs_responses_describe(handle, byref(a))

        def copied(pointer: Any, *shape: int) -> np.ndarray[Any, Any]:
            return np.ctypeslib.as_array(pointer, shape).copy() if all(shape) else np.zeros(shape)
        flat = {name: copied(getattr(a, name), a.pulses) for name in ("time", "energy", "wavelength", "start")}
        for which in ("emission", "reception"):
            flat[f"{which}_place"] = copied(getattr(a, f"{which}_place"), a.pulses, 3)
            flat[f"{which}_rotation"] = copied(getattr(a, f"{which}_rotation"), a.pulses, 4)
        flat.update({name: copied(getattr(a, name), a.rows) for name in ("bound", "paths")})
        flat.update({name: copied(getattr(a, name), a.entries) for name in ("bin", "contributions")})
        flat.update({name: copied(getattr(a, name), a.entries, len(self.channels)) for name in ("value", "variance", "skewness")})
        return _dataset(flat, np.diff(copied(a.begin, a.rows + 1).astype(np.int64)), list(self.channels), (a.scrambles, a.student), dict(self._about))


def open_lidar(path: FileName, sensor: str | None = None) -> OpenLidar:
    """Opens a laser radar of a simulation's text (by name; without, its only one) to trace its pulses within this process.
    InputError: what dirsig-render would refuse."""
    return OpenLidar(path, sensor)


def response_of(responses: xr.Dataset, pulse: int, pixel: int = 0) -> xr.DataArray:
    """Photons of one pulse and pixel in every range bin (0 where no path came), by `range` (m). IndexError: no such pulse or pixel."""
    pixels = responses.attrs["columns"] * responses.attrs["rows"]
    if not (0 <= pulse < responses.sizes["pulse"] and 0 <= pixel < pixels):
        raise IndexError(f"there is no pulse {pulse}, pixel {pixel}")
    here = (responses["entry_row"].values == pulse * pixels + pixel) & (responses["bin"].values > 0)
    dense = np.zeros((responses.attrs["bins"], responses.sizes["channel"]))
    dense[responses["bin"].values[here].astype(np.int64) - 1] = responses["value"].values[here]
    arrival = float(responses["start"][pulse]) + (np.arange(len(dense)) + 0.5) * responses.attrs["bin_s"]
    return xr.DataArray(dense, dims=("range", "channel"), name="photons", attrs={"units": "photons"},
                        coords={"range": ("range", arrival * _LIGHT / 2, {"units": "m"}), "channel": responses["channel"].values})


def read_points(path: FileName) -> xr.Dataset:
    """A point cloud (LAS 1.4, point formats 6 and 9, as `detectors` write it): `x`, `y`, `z` in the map's metres, `intensity`, `return_number`,
    `number_of_returns`, `gps_time`, `scan_angle_deg`, `classification`, and extra bytes by their names. FormatError: another file."""
    raw = Path(path).read_bytes()
    if len(raw) < 375 or raw[:4] != b"LASF" or raw[24:26] != b"\x01\x04" or raw[104] not in (6, 9):
        raise FormatError(f"{path} is no LAS 1.4 of point format 6 or 9")
    header, at, records = struct.unpack_from("<HII", raw, 94)
    size, count = struct.unpack_from("<H", raw, 105)[0], struct.unpack_from("<Q", raw, 247)[0]
    scale, offset = struct.unpack_from("<3d", raw, 131), struct.unpack_from("<3d", raw, 155)
    fields = _POINT + (_PACKET if raw[104] == 9 else [])
    place = header
    for _ in range(records):
        user, record, length = raw[place + 2:place + 18].rstrip(b"\0"), *struct.unpack_from("<HH", raw, place + 18)
        if user == b"LASF_Spec" and record == 4:
            for k in range(place + 54, place + 54 + length, 192):
                fields = fields + [(raw[k + 4:k + 36].rstrip(b"\0").decode(), _EXTRA[raw[k + 2]])]
        place += 54 + length
    kind = np.dtype([(f"{name}_extra" if name in dict(fields[:i]) else name, t) for i, (name, t) in enumerate(fields)])
    if kind.itemsize != size or len(raw) < at + count * size:
        raise FormatError(f"{path} is damaged: {count} points of {size} bytes are not there")
    points = np.frombuffer(raw, kind, count, at)
    data: dict[str, Any] = {c: ("point", points[c.upper()] * scale[k] + offset[k], {"units": "m"}) for k, c in enumerate("xyz")}
    data["return_number"], data["number_of_returns"] = ("point", points["returns"] & 15), ("point", points["returns"] >> 4)
    data["scan_angle_deg"] = ("point", points["scan_angle"] * 0.006)
    for name in points.dtype.names or ():
        if name not in ("X", "Y", "Z", "returns", "flags", "user", "scan_angle") and name not in data:
            data[name] = ("point", points[name].copy())
    return xr.Dataset(data)
