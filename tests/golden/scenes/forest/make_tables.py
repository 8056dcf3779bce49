#!/usr/bin/env python3
"""Writes leaves.csv (a crown of unit size) and trees.csv (a wood of it) into the folder where it is run."""
import math
import random

rnd = random.Random(5)


def table(name, header, rows):
    with open(name, "w") as out:
        out.write(header + "\n" + "".join(",".join("%.5f" % v for v in row) + "\n" for row in rows))


def leaf():
    place = [rnd.gauss(0, 1) for _ in range(3)]
    turn = [rnd.gauss(0, 1) for _ in range(4)]
    far, size = 0.5 * rnd.random() ** (1 / 3) / math.hypot(*place), math.hypot(*turn)
    return [place[0] * far, place[1] * far, 0.9 + place[2] * far] + [v / size for v in turn]


table("leaves.csv", "x,y,z,qw,qx,qy,qz", [leaf() for _ in range(400)])
table("trees.csv", "x,y,z,heading_deg,scale",
      [[rnd.uniform(-20, 20), rnd.uniform(-20, 20), 0, rnd.uniform(0, 360), rnd.uniform(3, 7)] for _ in range(60)])
