#!/usr/bin/env python3
"""Writes bottom.png (16 bit, cm above -20 m) and kinds.png of a bay into a folder: make_inputs.py [FOLDER]

200 x 200 pixels of 4 m: a beach in the north, sand that falls to 6 m in the south, a reef that rises to 1.2 m under the
surface, and meadows of seagrass. Kinds: 1 sand, 2 reef, 3 seagrass, 4 dunes.
"""
import math
import os
import random
import struct
import sys
import zlib

folder = sys.argv[1] if len(sys.argv) > 1 else "."
random.seed(5)
N, GSD = 200, 4.0
waves = [(random.uniform(0.006, 0.05), random.uniform(0, 2 * math.pi), random.uniform(0, 2 * math.pi)) for _ in range(24)]


def rough(x, y, shift):
    """A smooth random field, about -1 to 1."""
    return sum(math.sin(k * (x * math.cos(a) + y * math.sin(a)) + p + shift * k * 100) for k, a, p in waves) / 6


def place(x, y):
    """Height (m) and kind."""
    shore = 250 + 30 * math.sin(x / 110) + 10 * rough(x, y, 1)
    out = y - shore
    z = 0.05 * out if out < 0 else min(6, 0.08 * out)
    z = max(-6, z - (0.012 * out * out / 60 if -300 < out < 0 else 0))
    z += 0.3 * rough(x, y, 3)
    kind = 4 if out > 35 else 1
    reef = math.hypot((x - 110) / 120, (y + 20) / 70) + 0.22 * rough(x, y, 5)
    if reef < 1:
        top = -1.2 - 1.2 * abs(rough(3 * x, 3 * y, 7))
        z, kind = z + (min(top, 0) - z) * min(1, 4 * (1 - reef)), 2
    elif kind == 1 and out < -60 and rough(x, y, 9) > 0.35:
        kind = 3
    return z, kind


def png(name, bits, rows):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    raw = b"".join(b"\0" + struct.pack(">%d%s" % (N, "H" if bits == 16 else "B"), *row) for row in rows)
    with open(os.path.join(folder, name), "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", N, N, bits, 0, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


places = [[place((c + 0.5 - N / 2) * GSD, (N / 2 - r - 0.5) * GSD) for c in range(N)] for r in range(N)]
png("bottom.png", 16, [[round(100 * (z + 20)) for z, _ in row] for row in places])
png("kinds.png", 8, [[kind for _, kind in row] for row in places])
