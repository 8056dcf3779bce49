#!/usr/bin/env python3
"""compare.py FOLDER [--within PERCENT]

Holds the canopy's reflectance factors by the surface that was measured (out/surface_SUN_90_brf.csv) against those of the trees, the mean of
the sides from which the sun comes (out/forest_SUN_AZIMUTH_brf.csv): views to 60 degrees, further than 15 degrees from the hot spot. A line for each sun, band and plane; with --within,
exit code 1 where a mean or the root mean square of the differences, less the trees' own noise, is larger.
"""
import argparse
import csv
import glob
import os
import sys

parser = argparse.ArgumentParser()
parser.add_argument("folder")
parser.add_argument("--within", type=float)
args = parser.parse_args()


def table(scene, sun):
    """{(band, plane, view): (reflectance factor, its standard error)}, means over the sun's azimuths"""
    sums = {}
    files = glob.glob(os.path.join(args.folder, "out", f"{scene}_{sun}_*_brf.csv"))
    for name in files:
        with open(name) as f:
            for r in csv.DictReader(f):
                key = r["band"], r["plane"], float(r["view_zenith_deg"])
                value, squares = sums.get(key, (0, 0))
                sums[key] = value + float(r["brf"]), squares + float(r["standard_error"]) ** 2
    n = len(files)
    return {key: (value / n, squares**0.5 / n) for key, (value, squares) in sums.items()}


far = views = near = 0
print("sun  band  plane       mean %   rms %   noise %   largest % (at view)")
for sun in (30, 55):
    trees, surface = table("forest", sun), table("surface", sun)
    for band, plane in sorted({key[:2] for key in trees}, reverse=True):
        d, noise, largest = [], 0, (0, 0)
        for (b, p, view), (brf, error) in trees.items():
            hot = p == "principal" and abs(view + sun) <= 15  # negative views are on the sun's side
            if (b, p) != (band, plane) or abs(view) > 60 or hot or brf == 0:
                continue
            d.append(100 * (surface[b, p, view][0] / brf - 1))
            noise += (100 * error / brf) ** 2
            largest = max(largest, (abs(d[-1]), view))
            views, near = views + 1, near + (abs(d[-1]) <= 3)
        if not d:
            continue
        mean, rms, noise = sum(d) / len(d), (sum(v * v for v in d) / len(d)) ** 0.5, (noise / len(d)) ** 0.5
        far += args.within is not None and (abs(mean) > args.within or rms**2 - noise**2 > args.within**2)
        print(f"{sun:3d}  {band:4s}  {plane:10s}  {mean:+6.2f}  {rms:6.2f}  {noise:8.2f}   {largest[0]:.1f} ({largest[1]:+.0f})")
print(f"{near} of {views} views are within 3 %")
sys.exit(far > 0)
