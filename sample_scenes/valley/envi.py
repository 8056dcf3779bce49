"""ENVI images and raw sample texts as the programs write them, and small fits; Python's standard library only."""
import array
import math
import re


class Cube:
    """Bands of NAME.img by name: cube["red"][line * samples + sample]; wavelengths in um."""

    def __init__(self, path):
        with open(path + ".hdr") as text:
            header = dict((m[1].strip().lower(), m[2].strip().strip("{}").strip()) for m in re.finditer(r"^([^=\n]+?)\s*=\s*(\{.*?\}|[^\n]*)", text.read(), re.M | re.S))
        self.samples, self.lines, self.bands = (int(header[k]) for k in ("samples", "lines", "bands"))
        if header["interleave"] != "bsq" or header["byte order"] != "0" or int(header.get("header offset", "0")):
            raise ValueError(path + ": bands one after the other, little-endian, are expected")
        self.names = [n.strip() for n in header["band names"].split(",")]
        self.classes = [n.strip() for n in header.get("class names", "").split(",")]
        self.header = header
        values = array.array({"1": "B", "4": "f", "5": "d", "12": "H", "13": "I"}[header["data type"]])
        with open(path, "rb") as data:
            values.frombytes(data.read())
        self.size = self.samples * self.lines
        self._values = values

    def __getitem__(self, name):
        b = name if isinstance(name, int) else self.names.index(name)
        return self._values[b * self.size:(b + 1) * self.size]


def samples(path):
    """RAWBH10A -> wavelengths, zeniths of the outgoing directions, [(outgoing, (x, y, z), values)]."""
    rows = [line.split() for line in open(path).read().splitlines()[1:] if line.strip() and not line.startswith("#")]
    return ([float(v) for v in rows[0][1:]], [float(v) for v in rows[1][1:]],
            [(int(r[0]), tuple(float(v) for v in r[1:4]), [float(v) for v in r[4:]]) for r in rows[2:]])


def finer(points, center, fwhm):
    """The same curve over the rectangle, with points enough to be multiplied by others."""
    steps = [center + fwhm * (k / 50 - 0.5) for k in range(51)]
    at = lambda x: next(u + (v - u) * (x - a) / (b - a) for (a, u), (b, v) in zip(points, points[1:]) if a <= x <= b)
    return [(x, at(x)) for x in steps]


def curve_mean(points, center, fwhm):
    """Mean of straight lines between points over a rectangle."""
    def at(x):
        for (a, u), (b, v) in zip(points, points[1:]):
            if a <= x <= b:
                return u + (v - u) * (x - a) / (b - a)
        raise ValueError("%g um is outside of the curve" % x)
    n = 400
    return sum(at(center + fwhm * ((k + 0.5) / n - 0.5)) for k in range(n)) / n


def solve3(a, b):
    """x of a x = b, by Cramer's rule."""
    det = lambda m: (m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
                     + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]))
    d = det(a)
    return [det([[b[r] if c == k else a[r][c] for c in range(3)] for r in range(3)]) / d for k in range(3)]


def sun(days, latitude, longitude):
    """East, north, up of the Sun at `days` since 2000-01-01 12:00 UT: the low-precision formulae of the Astronomical Almanac (0.01 degrees)."""
    mean = math.radians((280.460 + 0.9856474 * days) % 360)
    anomaly = math.radians((357.528 + 0.9856003 * days) % 360)
    along = mean + math.radians(1.915 * math.sin(anomaly) + 0.020 * math.sin(2 * anomaly))
    tilt = math.radians(23.439 - 4e-7 * days)
    ascension = math.atan2(math.cos(tilt) * math.sin(along), math.cos(along))
    declination = math.asin(math.sin(tilt) * math.sin(along))
    sidereal = math.radians((280.46062 + 360.98564737 * days + longitude) % 360)
    hour, phi = sidereal - ascension, math.radians(latitude)
    return (-math.cos(declination) * math.sin(hour),
            math.sin(declination) * math.cos(phi) - math.cos(declination) * math.cos(hour) * math.sin(phi),
            math.sin(declination) * math.sin(phi) + math.cos(declination) * math.cos(hour) * math.cos(phi))


def planck(um, kelvin):
    """W/(m2 sr um)"""
    return 1.191042972e8 / um ** 5 / math.expm1(14387.76877 / (um * kelvin))
