#!/usr/bin/env python3
"""Plots the principal plane of RAMI tables: plot.py OUT.svg NAME_brf.csv [REFERENCE.csv]

A reference has lines "view zenith, BRF, ..."; it is drawn as dots.
"""
import csv
import sys

out, table = sys.argv[1:3]
mine = [(float(r["view_zenith_deg"]), float(r["brf"])) for r in csv.DictReader(open(table)) if r["plane"] == "principal"]
dots = []
if len(sys.argv) > 3:
    dots = [(float(r[0]), float(r[1])) for r in csv.reader(open(sys.argv[3])) if r and r[0][0] in "-0123456789"]
low, high = min(v for _, v in mine + dots) * 0.95, max(v for _, v in mine + dots) * 1.05


def place(p):
    return 60 + (p[0] + 75) / 150 * 520, 340 - (p[1] - low) / (high - low) * 300


with open(out, "w") as f:
    f.write('<svg xmlns="http://www.w3.org/2000/svg" width="640" height="400" font-family="sans-serif" font-size="12">\n')
    f.write('<rect width="640" height="400" fill="white"/><rect x="60" y="40" width="520" height="300" fill="none" stroke="black"/>\n')
    for z in range(-75, 76, 25):
        f.write('<text x="%g" y="358" text-anchor="middle">%d</text>\n' % (place((z, low))[0], z))
    for i in range(5):
        v = low + (high - low) * i / 4
        f.write('<text x="54" y="%g" text-anchor="end">%.3f</text>\n' % (place((0, v))[1] + 4, v))
    f.write('<text x="320" y="384" text-anchor="middle">view zenith, degrees (negative: the side of the sun)</text>\n')
    f.write('<text x="320" y="26" text-anchor="middle">BRF in the principal plane: %s%s</text>\n' % (table.split("/")[-1], ", dots: reference" if dots else ""))
    f.write('<polyline fill="none" stroke="#1060c0" points="%s"/>\n' % " ".join("%.1f,%.1f" % place(p) for p in mine))
    for p in dots:
        f.write('<circle cx="%.1f" cy="%.1f" r="2" fill="#c04010"/>\n' % place(p))
    f.write("</svg>\n")
