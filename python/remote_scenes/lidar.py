"""Laser radars: the sensor, its responses (`NAME_response.h5`, formats/response/FORMAT.md) and its points (LAS)."""
from __future__ import annotations

import struct
from pathlib import Path
from typing import Any, Mapping

import numpy as np
import xarray as xr

from .envi import FormatError
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
    rotations (w, x, y, z); of rows `bound` (photons) and `paths`; of entries `entry_row`, `bin` (0 = passive light), `arrival` (s, NaN
    in bin 0), `range` (m, c t / 2), `value` and `standard_error` (photons, by channel). FileNotFoundError: no such file; FormatError:
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
    entry_rows, row_count = [], 0
    for b in range(int(blocks)):
        block = file["block"][str(b)]
        for group in ("pulses", "rows", "entries"):
            for name, variable in block[group].variables.items():
                if name != "begin":
                    parts.setdefault(name, []).append(np.asarray(variable[:]))
        counts = np.diff(np.asarray(block["rows/begin"][:]).astype(np.int64))
        entry_rows.append(np.repeat(np.arange(len(counts)), counts) + row_count)
        row_count += len(counts)
    flat = {name: np.concatenate(values) for name, values in parts.items()}
    pixels = int(columns) * int(rows)
    row = np.concatenate(entry_rows)
    start = flat["start"][row // pixels]
    arrival = np.where(flat["bin"] > 0, start + (flat["bin"].astype(float) - 0.5) * width, np.nan)
    channels = file["channels"]
    names = [str(channels[k]) for k in range(len(channels))]  # one by one: netCDF4 misreads several fixed-length texts at once
    data: dict[str, Any] = {name: ("pulse", flat[name], {"units": unit})
                            for name, unit in (("time", "s"), ("energy", "J"), ("wavelength", "um"), ("start", "s"))}
    for which in ("emission", "reception"):
        data[f"{which}_place"] = (("pulse", "axis"), flat[f"{which}_place"], {"units": "m"})
        data[f"{which}_rotation"] = (("pulse", "quaternion"), flat[f"{which}_rotation"], {"units": "1"})
    data["bound"] = ("row", flat["bound"], {"units": "photons"})
    data["paths"] = ("row", flat["paths"])
    data["entry_row"] = ("entry", row)
    data["bin"] = ("entry", flat["bin"])
    data["arrival"] = ("entry", arrival, {"units": "s"})
    data["range"] = ("entry", arrival * _LIGHT / 2, {"units": "m"})
    data["value"] = (("entry", "channel"), flat["value"].reshape(-1, len(names)), {"units": "photons"})
    data["standard_error"] = (("entry", "channel"), np.sqrt(flat["variance"].reshape(-1, len(names))), {"units": "photons"})
    return xr.Dataset(data, coords={"channel": names, "axis": ["east", "north", "up"]},
                      attrs={"bin_s": width, "bins": int(bins), "columns": int(columns), "rows": int(rows), "group_index": index, "epsg": int(epsg),
                             "epoch": str(file.epoch), "description": str(file.arguments)})


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
