#!/usr/bin/env python3
"""Makes landcover.png and curves/*.txt of this scene; needs Python 3 and its standard library only.

The land cover is invented: classes follow slope and height of the shipped elevation raster, plus a few parcels, a road
and a paved yard around the panels. The curves are invented too: smooth sums of logistic steps and Gaussian bands, placed where
chlorophyll, water and iron oxide absorb, and no measurement of anything.
"""
import math
import os
import struct
import zlib

HERE = os.path.dirname(os.path.abspath(__file__))

# The scene's origin in the raster: centre of row 45, column 138. ENU leans against the grid by the meridian convergence
# at 8.69 E, 49.42 N (central meridian 9 E): atan(tan(-0.3081 deg) sin(49.4179 deg)).
ORIGIN_ROW, ORIGIN_COLUMN, GRID_M = 45.5, 138.5, 25.0
CONVERGENCE = math.atan(math.tan(math.radians(-0.3081)) * math.sin(math.radians(49.4179)))
GSD = 2.5
WEST, NORTH, COLUMNS, ROWS = -3480.0, 1155.0, 1988, 1204  # outer corner of the first pixel, m ENU

GRASS, FOREST, SOIL, ASPHALT, ROCK = 1, 2, 3, 4, 5


def read_heights(path):
    """Rows of an uncompressed single-band float32 TIFF."""
    data = open(path, "rb").read()
    end = "<" if data[:2] == b"II" else ">"
    (ifd,) = struct.unpack(end + "I", data[4:8])
    (count,) = struct.unpack(end + "H", data[ifd:ifd + 2])
    tags = {}
    for k in range(count):
        tag, kind, n, value = struct.unpack(end + "HHI4s", data[ifd + 2 + 12 * k:ifd + 14 + 12 * k])
        size, code = {3: (2, "H"), 4: (4, "I")}.get(kind, (0, ""))
        if size:
            at = value if size * n <= 4 else data[struct.unpack(end + "I", value)[0]:]
            tags[tag] = struct.unpack(end + code * n, at[:size * n])
    assert tags[259][0] == 1 and tags[258][0] == 32, "an uncompressed float32 raster is expected"
    width, height = tags[256][0], tags[257][0]
    raw = b"".join(data[o:o + n] for o, n in zip(tags[273], tags[279]))
    values = struct.unpack(end + "f" * (width * height), raw[:4 * width * height])
    return [values[r * width:(r + 1) * width] for r in range(height)]


def noise(x, y):
    """Smooth value noise from 0 to 1 on a unit lattice."""
    def corner(i, j):
        h = (i * 374761393 + j * 668265263) & 0xFFFFFFFF
        h = ((h ^ (h >> 13)) * 1274126177) & 0xFFFFFFFF
        return ((h ^ (h >> 16)) & 0xFFFF) / 65535.0
    i, j = math.floor(x), math.floor(y)
    u, v = x - i, y - j
    u, v = u * u * (3 - 2 * u), v * v * (3 - 2 * v)
    return (corner(i, j) * (1 - u) + corner(i + 1, j) * u) * (1 - v) + (corner(i, j + 1) * (1 - u) + corner(i + 1, j + 1) * u) * v


def classify(heights, x, y):
    if abs(x) < 15 and abs(y - 1) < 6:
        return ASPHALT                                        # the yard with the panels
    if abs(y - 20 - 12 * math.sin(x / 130.0)) < 3.5:
        return ASPHALT                                        # a road
    c, s = math.cos(CONVERGENCE), math.sin(CONVERGENCE)
    column = ORIGIN_COLUMN + (c * x - s * y) / GRID_M - 0.5
    row = ORIGIN_ROW - (s * x + c * y) / GRID_M - 0.5
    i = min(max(int(column), 0), len(heights[0]) - 2)
    j = min(max(int(row), 0), len(heights) - 2)
    h = heights[j]
    slope = math.hypot(h[i + 1] - h[i], heights[j + 1][i] - h[i]) / GRID_M
    if slope > 0.75:
        return ROCK
    if slope > 0.22 or noise(x / 90.0, y / 90.0) > 0.72:
        return FOREST
    return SOIL if noise(math.floor(x / 60.0) * 7.3, math.floor(y / 45.0) * 5.1) > 0.6 else GRASS


def write_png(path, rows):
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    with open(path, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n")
        out.write(chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 0, 0, 0, 0)))
        out.write(chunk(b"IDAT", zlib.compress(b"".join(b"\0" + bytes(r) for r in rows), 9)))
        out.write(chunk(b"IEND", b""))


def step(w, centre, width):
    return 1 / (1 + math.exp(-(w - centre) / width))


def band(w, centre, width):
    return math.exp(-0.5 * ((w - centre) / width) ** 2)


def water(w, depth):
    """What is left after liquid water of a relative depth: bands at 0.97, 1.20, 1.45 and 1.94 um."""
    return math.exp(-depth * (0.05 * band(w, 0.97, 0.03) + 0.12 * band(w, 1.2, 0.05) + 1.0 * band(w, 1.45, 0.07) + 1.6 * band(w, 1.94, 0.09)
                              + 0.9 * step(w, 2.35, 0.12)))


CURVES = {
    "grass": lambda w: (0.03 + 0.06 * band(w, 0.55, 0.035) + 0.42 * step(w, 0.715, 0.013)) * water(w, 1.0),
    "forest": lambda w: (0.02 + 0.035 * band(w, 0.55, 0.035) + 0.34 * step(w, 0.72, 0.014)) * water(w, 1.2),
    "soil": lambda w: (0.05 + 0.16 * step(w, 0.58, 0.07) + 0.17 * step(w, 1.05, 0.25)) * water(w, 0.25),
    "asphalt": lambda w: 0.05 + 0.06 * step(w, 0.6, 0.25) + 0.03 * step(w, 1.5, 0.4),
    "rock": lambda w: (0.20 + 0.22 * step(w, 0.52, 0.09) - 0.05 * band(w, 0.9, 0.12)) * water(w, 0.1),
    "hide": lambda w: (0.06 + 0.22 * step(w, 0.62, 0.05) + 0.28 * step(w, 0.9, 0.12)) * water(w, 0.3),
}


def main():
    for name, curve in CURVES.items():
        with open(os.path.join(HERE, "curves", name + ".txt"), "w") as out:
            out.write("# %s: synthetic (make_inputs.py), hemispherical reflectance\n# wavelength_um reflectance\n" % name)
            for k in range(35, 251):
                out.write("%.2f %.5f\n" % (k / 100, curve(k / 100)))
    heights = read_heights(os.path.join(HERE, "dem_hd_sub.tif"))
    rows = [[classify(heights, WEST + (i + 0.5) * GSD, NORTH - (j + 0.5) * GSD) for i in range(COLUMNS)] for j in range(ROWS)]
    write_png(os.path.join(HERE, "landcover.png"), rows)


main()
