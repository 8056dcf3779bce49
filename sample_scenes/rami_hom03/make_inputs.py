#!/usr/bin/env python3
"""Writes the leaves and the simulations of the homogeneous erectophile canopy HOM03 (RAMI, third phase) into a folder.

    make_inputs.py [FOLDER] [--half-width M] [--seed N]

Discs of radius 0.05 m fill a layer of 2 m with a leaf area index of 3: centres uniform, azimuths uniform, normals with
the erectophile density g(t) = (2/pi) (1 - cos 2t) of the zenith angle t in 0 .. 90 degrees. The cell repeats itself.
Based on: J.-L. Widlowski et al., "Third Radiation Transfer Model Intercomparison (RAMI) exercise", J. Geophys. Res. 112,
2007, whose scene description this follows; the positions are random and not those of the intercomparison.
"""
import argparse
import math
import os
import random

parser = argparse.ArgumentParser()
parser.add_argument("folder", nargs="?", default=".")
parser.add_argument("--half-width", type=float, default=6.25, help="of the cell, m")
parser.add_argument("--seed", type=int, default=3)
args = parser.parse_args()
random.seed(args.seed)
half, radius, height, lai = args.half_width, 0.05, 2.0, 3.0
count = round(lai * (2 * half) ** 2 / (math.pi * radius ** 2))


def erectophile():
    while True:
        t = random.random() * math.pi / 2
        if random.random() * 2 < 1 - math.cos(2 * t):
            return t


with open(os.path.join(args.folder, "leaves.csv"), "w") as out:
    # A disc lies in its own x-y plane: it is turned about x by its zenith angle, then about z by its azimuth.
    out.write("x,y,z,qw,qx,qy,qz\n")
    for _ in range(count):
        t, a = erectophile() / 2, random.random() * math.pi
        q = (math.cos(t) * math.cos(a), math.sin(t) * math.cos(a), math.sin(t) * math.sin(a), math.cos(t) * math.sin(a))
        z = radius + random.random() * (height - 2 * radius)
        out.write("%.6f,%.6f,%.6f,%.8f,%.8f,%.8f,%.8f\n" % (random.uniform(-half, half), random.uniform(-half, half), z, *q))

cases = {"red": (0.660, 0.0546, 0.0149, 0.127), "nir": (0.850, 0.4957, 0.4409, 0.159)}
for name, (um, rho, tau, soil) in cases.items():
    with open(os.path.join(args.folder, "scene_%s.yaml" % name), "w") as out:
        out.write(f"""scene: 1
name: HOM03 {name}
description: Homogeneous erectophile canopy of RAMI, leaf area index 3, {count} discs
materials:
  leaf: {{model: lambert, reflectance: {rho}, transmittance: {tau}}}
  soil: {{model: lambert, reflectance: {soil}}}
objects:
  disc: {{disk: {{radius: {radius}}}, material: leaf}}
  ground: {{plane: {{width: {2 * half}, depth: {2 * half}}}, material: soil}}
world:
  - {{place: disc, table: leaves.csv, tag: leaves}}
  - {{place: ground, tag: soil}}
""")
    for sun in (20, 50):
        with open(os.path.join(args.folder, "sim_%s_%d.yaml" % (name, sun)), "w") as out:
            out.write(f"""scene: scene_{name}.h5
max_nodes: 64
sun: {{direction: {{zenith_deg: {sun}, azimuth_deg: 90}}, irradiance: 1, collimated: true}}
periodic: {{origin_m: [{-half}, {-half}], size_m: [{2 * half}, {2 * half}]}}
sensors:
  - kind: rami
    name: hom03_{name}_{sun}
    bands: [{{name: {name}, center_um: {um}, fwhm_um: 0.01, shape: rectangular}}]
    patch: {{origin_m: [{-half}, {-half}], size_m: [{2 * half}, {2 * half}]}}
    top_m: {height}
    sun_zenith_deg: {sun}
    sun_azimuth_deg: 90
    irradiance: 1
    ground_reflectance: {soil}
    truth: []
    paths: 16384
""")
