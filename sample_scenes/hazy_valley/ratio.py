#!/usr/bin/env python3
"""Divides the green band of two images and smooths the ratio: ratio.py OVER.img UNDER.img OUT.png

Each pixel is the ratio of the means over 9 x 9 pixels about it; 0.7 is black, 1.05 and more white. Shows where traced air is darker than the
even field: in the shadows of clouds. Python 3, standard library only.
"""
import array
import re
import struct
import sys
import zlib

REACH, BLACK, WHITE, BAND = 4, 0.7, 1.05, 1


def green(path):
    with open(path + ".hdr") as header:
        text = header.read()
    columns, lines, bands = (int(re.search(rf"{key} = (\d+)", text)[1]) for key in ("samples", "lines", "bands"))
    order = re.search(r"interleave = (\w+)", text)[1]
    with open(path, "rb") as data:
        values = array.array("f", data.read())
    pixel, line, start = {"bsq": (1, columns, BAND * columns * lines), "bil": (1, columns * bands, BAND * columns), "bip": (bands, columns * bands, BAND)}[order]
    return [[values[start + y * line + x * pixel] for x in range(columns)] for y in range(lines)]


def total(image, y, x):
    """The sum over the square about a pixel, as far as there are pixels."""
    return sum(sum(row[max(0, x - REACH):x + REACH + 1]) for row in image[max(0, y - REACH):y + REACH + 1])


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


over, under = green(sys.argv[1]), green(sys.argv[2])
rows, columns = len(over), len(over[0])
raw = b"".join(b"\0" + bytes(round(255 * min(1, max(0, (total(over, y, x) / total(under, y, x) - BLACK) / (WHITE - BLACK)))) for x in range(columns)) for y in range(rows))
with open(sys.argv[3], "wb") as out:
    out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", columns, rows, 8, 0, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))
