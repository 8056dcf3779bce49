#!/usr/bin/env python3
"""Lays the push-broom's three strips over each other as a processor does that knows the ground to stand still:
stack.py FOLDER writes FOLDER/broom.png, north up.

A band's line looks 2 mm in the focal plane ahead of the next band's: 20 m of ground, or 40 lines. What stands still fits after that;
what moves has gone on for 0.27 s from band to band. Python 3, standard library only.
"""
import array
import re
import struct
import sys
import zlib

SHIFT = 40  # lines from band to band
folder = sys.argv[1]


def strip(name):
    with open(f"{folder}/broom_{name}.img.hdr") as header:
        text = header.read()
    columns, lines = (int(re.search(rf"{key} = (\d+)", text)[1]) for key in ("samples", "lines"))
    with open(f"{folder}/broom_{name}.img", "rb") as data:
        values = array.array("f", data.read())
    return columns, lines, values


columns, lines, _ = strip("green")
height = lines - 2 * SHIFT
channels = []
for k, name in enumerate(("red", "green", "blue")):
    values = strip(name)[2]
    # The line that looks ahead sees a place first: its strip begins further north.
    channels.append(values[columns * SHIFT * (2 - k):columns * (SHIFT * (2 - k) + height)])
bright = sorted(v for c in channels for v in c)[int(3 * columns * height * 0.995)]
rows = b""
for y in reversed(range(height)):
    rows += b"\0"
    for x in reversed(range(columns)):
        rows += bytes(int(255 * min(1.0, max(0.0, c[y * columns + x] / bright)) ** (1 / 2.2)) for c in channels)


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


with open(f"{folder}/broom.png", "wb") as out:
    out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", columns, height, 8, 2, 0, 0, 0)) +
              chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
