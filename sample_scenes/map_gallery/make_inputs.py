#!/usr/bin/env python3
"""Makes the rasters and curves of this scene; needs Python 3 and its standard library only. Everything is invented."""
import math
import os
import random
import struct
import zlib

HERE = os.path.dirname(os.path.abspath(__file__))
SIDE = 32


def write_png(name, rows, depth=8):
    """rows: of pixels, a pixel is a number (grey) or three (RGB)."""
    colour = 2 if isinstance(rows[0][0], tuple) else 0
    code = ">B" if depth == 8 else ">H"
    raw = b""
    for row in rows:
        raw += b"\0" + b"".join(struct.pack(code, v) for p in row for v in (p if colour else (p,)))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    with open(os.path.join(HERE, name), "wb") as f:
        f.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), depth, colour, 0, 0, 0))
                + chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


def raster(pixel, side=SIDE):
    """pixel(x, y): x from 0 to 1 rightwards, y from 0 to 1 upwards, at pixel centres."""
    return [[pixel((c + 0.5) / side, 1 - (r + 0.5) / side) for c in range(side)] for r in range(side)]


def byte(v):
    return max(0, min(255, round(255 * v)))


def write_envi(name, header, values):
    with open(os.path.join(HERE, name), "wb") as f:
        f.write(struct.pack("<%df" % len(values), *values))
    with open(os.path.join(HERE, name + ".hdr"), "w") as f:
        f.write("ENVI\n" + header)


def main():
    draw = random.Random(7)
    write_png("classes.png", raster(lambda x, y: 1 + int(2 * x) + 2 * int(2 * y), 2))
    # From bright on the left to dark on the right, a little green towards the top.
    write_png("mixture.png", raster(lambda x, y: (byte((1 - x) * (1 - y / 2)), byte(x * (1 - y / 2)), byte(y / 2))))
    # Blurred noise, skewed.
    noise = [[draw.random() for _ in range(SIDE)] for _ in range(SIDE)]
    soft = [[sum(noise[(r + i) % SIDE][(c + j) % SIDE] for i in range(3) for j in range(3)) / 9 for c in range(SIDE)] for r in range(SIDE)]
    write_png("image.png", [[byte(2.2 * max(0, v - 0.25) ** 1.5) for v in row] for row in soft])
    write_png("numbers.png", raster(lambda x, y: (int(4 * x) + int(4 * y)) % 4, 4))
    write_png("kelvin.png", raster(lambda x, y: round(100 * (280 + 40 * x)), SIDE), 16)
    write_png("ripples.png", raster(lambda x, y: round(32767 * (1 + math.cos(40 * math.hypot(x - 0.5, y - 0.5)))), 64), 16)

    def dome(x, y):
        u, v = 2.4 * (x - 0.5), 2.4 * (y - 0.5)
        z = math.sqrt(max(0.0, 1 - u * u - v * v))
        n = (u, v, z) if u * u + v * v < 0.9 else (0, 0, 1)
        return tuple(byte(0.5 + 0.5 * c) for c in n)

    write_png("normals.png", raster(dome, 64))

    def leaf(x, y):
        u, v = 2 * x - 1, 2 * y - 1
        width = 0.55 * (1 - abs(v)) ** 0.6
        return 255 if abs(u) < width and not (abs(v) < 0.9 and int(abs(u) * 12 + v * 6) % 3 == 2 and abs(u) > 0.06) else 0

    write_png("leaf.png", raster(leaf, 64))

    wavelengths = [0.35 + 0.05 * k for k in range(16)]
    family = []
    for _ in range(24):
        level, tilt = draw.random(), draw.random() - 0.5
        family += [0.15 + 0.25 * level + 0.2 * tilt * (w - 0.7) for w in wavelengths]
    text = "wavelength = {%s}\nwavelength units = micrometers\n" % ", ".join("%.2f" % w for w in wavelengths)
    write_envi("soils.sli", "file type = ENVI Spectral Library\nsamples = 16\nlines = 24\nbands = 1\ndata type = 4\nheader offset = 0\n"
               "interleave = bsq\nbyte order = 0\n" + text, family)
    # 8 x 8 pixels of 6 channels: levels rise to the right, slopes upwards.
    channels = [0.45, 0.55, 0.65, 0.75, 0.85, 0.95]
    cube = []
    for r in range(8):
        for c in range(8):
            x, y = (c + 0.5) / 8, 1 - (r + 0.5) / 8
            cube += [0.1 + 0.4 * x + 0.8 * (y - 0.5) * (w - 0.7) for w in channels]
    write_envi("cube.img", "samples = 8\nlines = 8\nbands = 6\ndata type = 4\nheader offset = 0\ninterleave = bip\nbyte order = 0\n"
               "wavelength = {%s}\nwavelength units = micrometers\n" % ", ".join("%.2f" % w for w in channels), cube)


main()
