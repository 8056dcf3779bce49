#!/usr/bin/env python3
"""Draws a slice through the vehicle seen from the south, of one pulse and of all of them: section.py POINTS.las PICTURE.png"""
import struct
import sys
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lidar_survey"))
from cloud import colour, points_of, write_png  # noqa: E402

WIDTH, METRE, SLICE = 800, 55, 1.3  # pixels, pixels a metre, m to either side of the middle


def times_of(path):
    raw = open(path, "rb").read()
    at, size, count = struct.unpack_from("<I", raw, 96)[0], struct.unpack_from("<H", raw, 105)[0], struct.unpack_from("<Q", raw, 247)[0]
    return [struct.unpack_from("<d", raw, at + k * size + 22)[0] for k in range(count)]


def panel(points, dot):
    height = int(4.6 * METRE)
    rows = [[(18, 20, 28)] * WIDTH for _ in range(height)]
    for east, up in points:
        column, row = round(WIDTH / 2 + east * METRE), round(height - 25 - up * METRE)
        for r in range(max(row - dot, 0), min(row + dot + 1, height)):
            for c in range(max(column - dot, 0), min(column + dot + 1, WIDTH)):
                rows[r][c] = colour(up / 3)
    return rows


def main():
    points, times = list(points_of(sys.argv[1])), times_of(sys.argv[1])
    middle = [sorted(p[k] for p in points)[len(points) // 2] for k in range(2)]
    ground = sorted(p[2] for p in points)[len(points) // 4]
    slices = [(p[0] - middle[0], p[2] - ground, t) for p, t in zip(points, times) if abs(p[1] - middle[1]) < SLICE]
    one = sorted(set(times))[len(set(times)) // 2]
    rows = panel([(e, u) for e, u, t in slices if t == one], 2) + [[(90, 90, 90)] * WIDTH] * 2 + panel([(e, u) for e, u, _ in slices], 1)
    write_png(sys.argv[2], rows)


main()
