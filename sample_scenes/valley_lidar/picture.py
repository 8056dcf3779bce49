#!/usr/bin/env python3
"""Draws the points from the south-east and above, coloured by height over the ground: picture.py POINTS.las PICTURE.png [WIDTH]

The ground is the lowest tenth of the points of a square of 6 m, or of a square beside it that lies lower."""
import math
import sys
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lidar_survey"))
from cloud import colour, points_of, write_png  # noqa: E402

AZIMUTH, ELEVATION, CELL = math.radians(66), math.radians(38), 6.0  # of the view, degrees; of the ground's grid, m
TOP = 20.0  # m over the ground, the end of the colours


def heights_over_ground(points):
    lowest = {}
    for e, n, u in points:
        cell = (int(e // CELL), int(n // CELL))
        lowest.setdefault(cell, []).append(u)
    lowest = {cell: sorted(heights)[len(heights) // 10] for cell, heights in lowest.items()}
    around = {(i, j): min(lowest.get((i + a, j + b), 1e9) for a in (-1, 0, 1) for b in (-1, 0, 1)) for i, j in lowest}
    return [u - around[int(e // CELL), int(n // CELL)] for e, n, u in points]


def picture(points, over, width):
    middle = [sum(p[k] for p in points) / len(points) for k in range(2)]
    low, seen = min(p[2] for p in points), []
    for (e, n, u), h in zip(points, over):
        x, y, z = e - middle[0], n - middle[1], u - low
        right, away = x * math.cos(AZIMUTH) + y * math.sin(AZIMUTH), y * math.cos(AZIMUTH) - x * math.sin(AZIMUTH)
        seen.append((away * math.cos(ELEVATION) - z * math.sin(ELEVATION), right, z * math.cos(ELEVATION) + away * math.sin(ELEVATION), h))
    left, bottom = min(p[1] for p in seen), min(p[2] for p in seen)
    metre = (width - 20) / (max(p[1] for p in seen) - left)
    height = round((max(p[2] for p in seen) - bottom) * metre) + 20
    rows = [[(18, 20, 28)] * width for _ in range(height)]
    for _, right, up, h in sorted(seen, reverse=True):  # what is near covers what is far
        column, row = round(10 + (right - left) * metre), round(height - 10 - (up - bottom) * metre)
        for r in range(max(row - 1, 0), min(row + 1, height)):
            for c in range(max(column - 1, 0), min(column + 1, width)):
                rows[r][c] = colour(h / TOP)
    return rows


def main():
    points = list(points_of(sys.argv[1]))
    over = heights_over_ground(points)
    write_png(sys.argv[2], picture(points, over, int(sys.argv[3]) if len(sys.argv) > 3 else 1000))


if __name__ == "__main__":
    main()
