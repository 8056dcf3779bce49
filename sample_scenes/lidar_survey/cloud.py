#!/usr/bin/env python3
"""Draws a point cloud (LAS 1.4), seen from the south-west and above, coloured by height: cloud.py POINTS.las PICTURE.png [WIDTH]"""
import math
import struct
import sys
import zlib

COLOURS = [(68, 1, 84), (59, 82, 139), (33, 145, 140), (94, 201, 98), (253, 231, 37)]  # viridis
AZIMUTH, ELEVATION = math.radians(25), math.radians(35)


def points_of(path):
    raw = open(path, "rb").read()
    at, size, count = struct.unpack_from("<I", raw, 96)[0], struct.unpack_from("<H", raw, 105)[0], struct.unpack_from("<Q", raw, 247)[0]
    scale, offset = struct.unpack_from("<3d", raw, 131), struct.unpack_from("<3d", raw, 155)
    for k in range(count):
        yield [v * s + o for v, s, o in zip(struct.unpack_from("<3i", raw, at + k * size), scale, offset)]


def colour(share):
    x = min(max(share, 0), 1) * (len(COLOURS) - 1)
    i = min(int(x), len(COLOURS) - 2)
    return [round(a + (b - a) * (x - i)) for a, b in zip(COLOURS[i], COLOURS[i + 1])]


def write_png(path, rows):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    flat = zlib.compress(b"".join(b"\0" + bytes(v for pixel in row for v in pixel) for row in rows), 9)
    size = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0)
    open(path, "wb").write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", size) + chunk(b"IDAT", flat) + chunk(b"IEND", b""))


def main():
    source, target = sys.argv[1:3]
    width = int(sys.argv[3]) if len(sys.argv) > 3 else 800
    points = list(points_of(source))
    middle = [sum(p[k] for p in points) / len(points) for k in range(3)]
    heights = sorted(p[2] for p in points)
    low, high = heights[len(heights) // 100], heights[-1 - len(heights) // 500]
    seen = []
    for e, n, u in points:
        x, y, z = e - middle[0], n - middle[1], u - low
        right, away = x * math.cos(AZIMUTH) + y * math.sin(AZIMUTH), y * math.cos(AZIMUTH) - x * math.sin(AZIMUTH)
        seen.append((right, z * math.cos(ELEVATION) + away * math.sin(ELEVATION), away * math.cos(ELEVATION) - z * math.sin(ELEVATION), z))
    left, bottom = min(p[0] for p in seen), min(p[1] for p in seen)
    metre = (width - 20) / (max(p[0] for p in seen) - left)
    height = round((max(p[1] for p in seen) - bottom) * metre) + 20
    rows = [[(18, 20, 28)] * width for _ in range(height)]
    for right, up, away, z in sorted(seen, key=lambda p: -p[2]):  # what is near covers what is far
        column, row = round(10 + (right - left) * metre), round(height - 10 - (up - bottom) * metre)
        for r in range(max(row - 1, 0), min(row + 2, height)):
            for c in range(max(column - 1, 0), min(column + 2, width)):
                rows[r][c] = colour(z / (high - low))
    write_png(target, rows)


if __name__ == "__main__":
    main()
