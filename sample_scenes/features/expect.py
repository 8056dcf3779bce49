#!/usr/bin/env python3
"""expect.py FOLDER: holds what `run FOLDER` made against what is expected; a line a feature, exit code 1 where one is off."""
import array
import csv
import math
import os
import re
import sys

OUT = os.path.join(sys.argv[1], "out")
off = 0


def image(name):
    """{band: rows of values}"""
    text = open(f"{OUT}/{name}.img.hdr").read()
    word = lambda key: re.search(rf"^{key} = \{{?([^}}\n]*)", text, re.M).group(1)
    columns, rows, bands = (int(word(key)) for key in ("samples", "lines", "bands"))
    values = array.array({"1": "B", "4": "f", "5": "d", "12": "H"}[word("data type")])
    values.frombytes(open(f"{OUT}/{name}.img", "rb").read())
    names = [n.strip() for n in word("band names").split(",")] if "band names" in text else [str(b) for b in range(bands)]
    return {n: [values[(b * rows + r) * columns:][:columns].tolist() for r in range(rows)] for b, n in enumerate(names)}


def first(name):
    return next(iter(image(name).values()))


def point(name, band):
    """The value of a point instrument in a band."""
    rows = csv.DictReader(line for line in open(f"{OUT}/{name}.csv") if not line.startswith("#"))
    return next(float(r["value"]) for r in rows if r["band"] == band)


def tell(feature, what, found, expected, within):
    global off
    good = abs(found - expected) <= within
    off += not good
    print(f"{feature:14s} {what:60s} {found:12.5g}  expected {expected:.5g} +- {within:.2g}{'' if good else '   OFF'}")


mean = lambda rows: sum(map(sum, rows)) / sum(map(len, rows))


def clear_sky():
    # The lawn's corner is lit by all of the sky but what the house covers; a Lambert surface returns E rho / pi.
    corner = [row[50:58] for row in image("map")["green"][50:58]]
    tell("clear sky", "radiance of the lawn x pi / 0.3, W/(m2 um)", mean(corner) * math.pi / 0.3, point("lawn", "green"), 5)
    tell("orthographic", "share of the map that the house covers", sum(v == 2 for row in first("map_material") for v in row) / 3600, 80 / 3600, 1e-9)


def image_sky():
    north, south = (first("up")[row][32] for row in (16, 48))
    tell("image sky", "radiance in the north, 200 x 0.1", north, 20, 1e-4)
    tell("image sky", "radiance in the south", south, 0, 1e-4)
    tell("fisheye", "share of the square in the circle's northern half", sum(v > 0 for row in first("up") for v in row) / 4096, math.pi / 8, 0.015)
    tell("point", "irradiance under half a sky of 20, W/(m2 um)", point("open", "pan"), 10 * math.pi, 0.05)


def scatter():
    # Discs of 0.79 m2, 0.2 of them a m2, placed without regard to each other.
    covered = sum(v == 2 for row in first("stones_material") for v in row) / 1e4
    tell("scatter", "share of the field that stones cover", covered, 1 - math.exp(-0.2 * math.pi * 0.25), 0.015)


def curvature():
    tell("curvature", "height of the tangent plane, 20 km north (m)", mean(image("north_truth")["up [m]"]), -(20000**2) / 2 / 6335439, 0.01)


def detector():
    electrons, counts = first("counts_electrons"), first("counts_dn")
    tell("detector", "mean count: 100 + electrons / 2", mean(counts), 100 + mean(electrons) / 2, 1.5)
    spread = mean([[(v - mean(counts)) ** 2 for v in row] for row in counts])
    tell("detector", "variance of counts, over (electrons + 25) / 4", spread / ((mean(electrons) + 25) / 4), 1, 0.1)


def rolling():
    # The bar is 2 m wide, 20 m/s x 0.01 s = 0.2 m a row, and pixels are 0.5 m.
    rows = first("rolling")
    middles = []
    for row in rows:
        lit = [(c, v - min(row)) for c, v in enumerate(row)]
        middles.append(sum(c * v for c, v in lit) / sum(v for _, v in lit))
    tell("rolling", "lean of the bar, columns from row to row", (middles[40] - middles[20]) / 20, 0.4, 0.02)


def tdi():
    tell("tdi", "electrons of 16 stages over those of one", mean(first("broom_tdi_electrons")) / mean(first("broom_one_electrons")), 16, 0.01)


def whisk():
    east = image("whisk_truth")["east [m]"]
    tell("whisk", "first sample of a scan, 30 degrees to the right (m east)", mean([row[:1] for row in east]), 100 * math.tan(math.radians(30)), 0.7)
    tell("whisk", "last sample, 29 degrees to the left", mean([row[-1:] for row in east]), -100 * math.tan(math.radians(29)), 0.7)


def scenes():
    rows = first("both")
    tell("scenes", "mean of the yard beside it over that of the yard", mean([r[60:] for r in rows]) / mean([r[:60] for r in rows]), 1, 0.01)


for feature in (clear_sky, image_sky, scatter, curvature, detector, rolling, tdi, whisk, scenes):
    feature()
sys.exit(off > 0)
