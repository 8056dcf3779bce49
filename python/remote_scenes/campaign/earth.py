"""Scene ENU and longitude, latitude on WGS84.

Formulas: B. Hofmann-Wellenhof, H. Lichtenegger and J. Collins, "GPS: Theory and Practice", chapter 10 (Bowring's solution for the latitude,
good to less than a micrometre near the ellipsoid).
"""
from __future__ import annotations

import math
from dataclasses import dataclass

SEMI_MAJOR_M = 6378137.0
FLATTENING = 1 / 298.257223563
_E2 = FLATTENING * (2 - FLATTENING)


@dataclass(frozen=True)
class Frame:
    """The frame of a scene whose place (0, 0, 0) is at a latitude and longitude (degrees) and a height above the ellipsoid (m)."""

    latitude_deg: float
    longitude_deg: float
    height_m: float = 0.0

    def to_geodetic(self, east: float, north: float, up: float = 0.0) -> tuple[float, float, float]:
        """Longitude, latitude (degrees) and height above the ellipsoid (m)."""
        a, b = math.radians(self.latitude_deg), math.radians(self.longitude_deg)
        x0, y0, z0 = _ecef(a, b, self.height_m)
        x = x0 - math.sin(b) * east - math.sin(a) * math.cos(b) * north + math.cos(a) * math.cos(b) * up
        y = y0 + math.cos(b) * east - math.sin(a) * math.sin(b) * north + math.cos(a) * math.sin(b) * up
        z = z0 + math.cos(a) * north + math.sin(a) * up
        p, semi_minor = math.hypot(x, y), SEMI_MAJOR_M * (1 - FLATTENING)
        t = math.atan2(z * SEMI_MAJOR_M, p * semi_minor)
        latitude = math.atan2(z + _E2 / (1 - _E2) * semi_minor * math.sin(t) ** 3, p - _E2 * SEMI_MAJOR_M * math.cos(t) ** 3)
        n = SEMI_MAJOR_M / math.sqrt(1 - _E2 * math.sin(latitude) ** 2)
        height = p * math.cos(latitude) + z * math.sin(latitude) - n * (1 - _E2 * math.sin(latitude) ** 2)
        return math.degrees(math.atan2(y, x)), math.degrees(latitude), height

    def to_enu(self, longitude_deg: float, latitude_deg: float, height_m: float | None = None) -> tuple[float, float, float]:
        """East, north, up (m); the height is that of the origin unless given."""
        a, b = math.radians(self.latitude_deg), math.radians(self.longitude_deg)
        x0, y0, z0 = _ecef(a, b, self.height_m)
        x, y, z = _ecef(math.radians(latitude_deg), math.radians(longitude_deg), self.height_m if height_m is None else height_m)
        dx, dy, dz = x - x0, y - y0, z - z0
        return (-math.sin(b) * dx + math.cos(b) * dy,
                -math.sin(a) * math.cos(b) * dx - math.sin(a) * math.sin(b) * dy + math.cos(a) * dz,
                math.cos(a) * math.cos(b) * dx + math.cos(a) * math.sin(b) * dy + math.sin(a) * dz)


def _ecef(latitude: float, longitude: float, height: float) -> tuple[float, float, float]:
    n = SEMI_MAJOR_M / math.sqrt(1 - _E2 * math.sin(latitude) ** 2)
    return ((n + height) * math.cos(latitude) * math.cos(longitude), (n + height) * math.cos(latitude) * math.sin(longitude),
            (n * (1 - _E2) + height) * math.sin(latitude))
