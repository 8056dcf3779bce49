"""Where the pixels of an image are: ENVI's `map info` as coordinates and as a grid mapping of CF."""
from __future__ import annotations

import re
from typing import Any

import numpy as np
import xarray as xr

_GEOGRAPHIC = ('GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],'
               'UNIT["degree",0.0174532925199433]]')
_ELLIPSOID = {"semi_major_axis": 6378137.0, "inverse_flattening": 298.257223563, "longitude_of_prime_meridian": 0.0}
_KINDS = {"orthographic": "orthographic", "transverse_mercator": "transverse_mercator"}
_PARAMETERS = {"latitude_of_origin": "latitude_of_projection_origin", "false_easting": "false_easting",
               "false_northing": "false_northing", "scale_factor": "scale_factor_at_central_meridian"}


def _utm_wkt(zone: int, north: bool) -> str:
    return (f'PROJCS["WGS 84 / UTM zone {zone}{"N" if north else "S"}",{_GEOGRAPHIC},PROJECTION["Transverse_Mercator"],'
            f'PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",{6 * zone - 183}],PARAMETER["scale_factor",0.9996],'
            f'PARAMETER["false_easting",500000],PARAMETER["false_northing",{0 if north else 10000000}],UNIT["metre",1],'
            f'AUTHORITY["EPSG","{(32600 if north else 32700) + zone}"]]')


def _grid_mapping(wkt: str) -> dict[str, Any]:
    """The attributes of CF for a coordinate system; for projections that CF names differently only the WKT."""
    attrs: dict[str, Any] = {"crs_wkt": wkt}
    projection = re.search(r'PROJECTION\["([^"]+)"', wkt)
    if not projection and wkt.startswith("GEOGCS"):
        return {"grid_mapping_name": "latitude_longitude", **_ELLIPSOID, **attrs}
    kind = _KINDS.get(projection[1].lower()) if projection else None
    if not kind or 'SPHEROID["WGS 84",6378137,298.257223563' not in wkt:
        return attrs
    central = {"orthographic": "longitude_of_projection_origin"}.get(kind, "longitude_of_central_meridian")
    names = {**_PARAMETERS, "central_meridian": central}
    found = re.findall(r'PARAMETER\["([^"]+)",([-+.\deE]+)\]', wkt)
    return {"grid_mapping_name": kind, **{names[k]: float(v) for k, v in found if k in names}, **_ELLIPSOID, **attrs}


def add_coordinates(array: xr.DataArray, map_info: list[str], wkt: str, file: str) -> xr.DataArray:
    """The array (…, y, x) with the centres of its pixels and, where they are on the Earth, `spatial_ref`.

    map_info: ENVI's list: projection, column and row (from 1; 1, 1 = outer corner of the first pixel) of a place and its x
    and y, size of a pixel, further words. Turned grids have no coordinates of one dimension and get `spatial_ref` alone.
    """
    if len(map_info) < 7:
        return array
    try:
        column, row, x0, y0, dx, dy = (float(item) for item in map_info[1:7])
        turned = any(re.match(r"rotation\s*=\s*[-+]?0*\.?0*[1-9]", item) for item in map_info[7:])
        if map_info[0] == "UTM" and not wkt:
            wkt = _utm_wkt(int(map_info[7]), map_info[8].lower() == "north")
    except (ValueError, IndexError):
        raise ValueError(f"{file}: 'map info' is not understood: {', '.join(map_info)}") from None
    if map_info[0].lower().startswith("geographic") and not wkt:
        wkt = _GEOGRAPHIC
    west, north = x0 - (column - 1) * dx, y0 + (row - 1) * dy
    degrees = wkt.startswith("GEOGCS")
    if not turned:
        names = ("longitude", "latitude") if degrees else ("projection_x_coordinate", "projection_y_coordinate")
        units = ("degrees_east", "degrees_north") if degrees else ("m", "m")
        places = west + (np.arange(array.sizes["x"]) + 0.5) * dx, north - (np.arange(array.sizes["y"]) + 0.5) * dy
        for axis, place, name, unit in zip("xy", places, names, units):
            attrs = {"units": unit, "axis": axis.upper(), "long_name": f"{axis} of the pixel's centre"}
            if wkt:
                attrs["standard_name"] = name
            array = array.assign_coords({axis: (axis, place, attrs)})
    if wkt:
        attrs = {"long_name": "coordinate system", **_grid_mapping(wkt)}
        if not turned:
            attrs["GeoTransform"] = f"{west!r} {dx!r} 0 {north!r} 0 {-dy!r}"
        array = array.assign_coords(spatial_ref=((), 0, attrs))
        array.attrs["grid_mapping"] = "spatial_ref"
    return array
