#!/usr/bin/env python3
"""Writes the tables that scene.yaml places: the leaves of a crown, the trees of a wood's edge, the bars of a target.

    make_inputs.py [FOLDER]

All invented; the target follows the proportions of the USAF 1951 chart (three bars of five times their width, their own
width apart, groups a factor of two to the 1/3 apart).
"""
import math
import os
import random
import sys

folder = sys.argv[1] if len(sys.argv) > 1 else "."
random.seed(17)


def table(name, header, rows):
    with open(os.path.join(folder, name), "w") as out:
        out.write(header + "\n")
        for row in rows:
            out.write(",".join("%.5f" % v for v in row) + "\n")


def turned():
    q = [random.gauss(0, 1) for _ in range(4)]
    n = math.sqrt(sum(v * v for v in q))
    return [v / n for v in q]


# A crown of unit height and width around the origin: leaves near the surfaces of a few balls.
balls = [(0, 0, 0.55, 0.32), (0.2, 0.05, 0.4, 0.22), (-0.18, 0.12, 0.42, 0.22), (0, -0.2, 0.35, 0.22), (0.05, 0.1, 0.8, 0.2)]
leaves = []
for _ in range(9000):
    x, y, z, r = random.choice(balls)
    d = [random.gauss(0, 1) for _ in range(3)]
    n = math.sqrt(sum(v * v for v in d))
    r *= random.uniform(0.6, 1) ** 0.5
    leaves.append([x + r * d[0] / n, y + r * d[1] / n, z + r * d[2] / n] + turned())
table("leaves.csv", "x,y,z,qw,qx,qy,qz", leaves)

# The edge of a wood, 9 m and more behind the target as seen from the south.
trees = []
while len(trees) < 24:
    x, y = random.uniform(-28, 28), 9 + 14 * random.random()
    if all(math.hypot(x - t[0], y - t[1]) > 3 for t in trees):
        trees.append([x, y, 0, random.uniform(0, 360), random.uniform(8, 14)])
table("trees.csv", "x,y,z,heading_deg,scale", trees)

# Patches of lighter and darker grass, each a little disk on the meadow.
for name in ("lush.csv", "dry.csv"):
    table(name, "x,y,z,scale", [[random.gauss(0, 14), random.gauss(-8, 14), random.uniform(0.002, 0.018), random.lognormvariate(-2.8, 0.5)] for _ in range(25000)])

# Bars: unit boards scaled to width and length. Five groups side by side, upright ones above lying ones.
bars, x = [], -4.3
for group in range(5):
    w = 0.4 / 2 ** (group / 2)
    for i in range(3):
        bars.append([x + (2 * i + 0.5) * w, 1.5, 0.03, 1, 0, 0, 0, w, 5 * w, 1])
        bars.append([x + 2.5 * w, -1.5 + (2 * i - 2.0) * w, 0.03, 1, 0, 0, 0, 5 * w, w, 1])
    x += 7 * w
table("bars.csv", "x,y,z,qw,qx,qy,qz,sx,sy,sz", bars)
