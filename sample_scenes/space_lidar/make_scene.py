#!/usr/bin/env python3
"""Writes two trees and the clouds of this sample into a folder: make_scene.py FOLDER

The trees are grown as those of ../valley. Needs Python 3 and its standard library only.
"""
import math
import os
import random
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(HERE, "..", "valley"))
import trees  # noqa: E402

CELLS, CELL_M = (44, 12), (25, 7)       # of the cloud, along the track and upwards; m
HILLS = [(9, 0.004, 0.0075, 0.4), (3, -0.01, 0.021, 2)]  # amplitude, kx, ky, phase
FOREST = {"beech": (-760, 130, 0.02), "spruce": (290, 810, 0.03)}  # from north to north (m), trees a m2: a clearing between
HALF = 30.0                              # width of the forest to either side of the track, m


def cloud():
    """Densities 0 to 1 of a thin sheet, x fastest: thick in its middle, torn at its ends, its top in waves."""
    rnd, out = random.Random(4), []
    phases = [rnd.uniform(0, 2 * math.pi) for _ in range(4)]
    for k in range(CELLS[1]):
        for i in range(CELLS[0]):
            x, z = (i + 0.5) / CELLS[0], (k + 0.5) / CELLS[1]
            waves = sum(math.sin(2 * math.pi * f * x + p) / f for f, p in zip((2, 3, 5, 9), phases)) / 2
            middle = 0.5 + 0.15 * waves
            thick = 0.32 * math.sin(math.pi * x) * (1 + 0.5 * waves)
            out.append(round(max(0, 1 - ((z - middle) / max(thick, 0.02)) ** 2), 3))
    return out


def height(x, y):
    return sum(a * math.sin(kx * x + ky * y + phase) for a, kx, ky, phase in HILLS)


def plant(kind):
    """-> rows of a table: trees on a jittered grid of the density."""
    south, north, density = FOREST[kind]
    rnd, step, rows = random.Random(kind), density ** -0.5, []
    for j in range(int((north - south) / step)):
        for i in range(int(2 * HALF / step)):
            x, y = -HALF + (i + rnd.random()) * step, south + (j + rnd.random()) * step
            rows.append("%.2f,%.2f,%.2f,%.0f,%.3f" % (x, y, height(x, y), rnd.uniform(0, 360), rnd.uniform(0.65, 1.2)))
    return ["x,y,z,heading_deg,scale"] + rows


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    os.makedirs(sys.argv[1], exist_ok=True)
    for kind in FOREST:
        trees.grow(kind, 1).write(os.path.join(sys.argv[1], kind + ".obj"))
        with open(os.path.join(sys.argv[1], kind + ".csv"), "w") as out:
            out.writelines(row + "\n" for row in plant(kind))
    with open(os.path.join(sys.argv[1], "cloud.vox"), "w") as out:
        out.write("# Made by make_scene.py.\nvoxels: 1\ncells: [1, %d, %d]\ncell_m: [400, %d, %d]\norigin_m: [-200, 0, 0]\nfields:\n  density: {values: %s}\n"
                  % (*CELLS, *CELL_M, cloud()))


if __name__ == "__main__":
    main()
