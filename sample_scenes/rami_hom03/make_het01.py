#!/usr/bin/env python3
"""Writes the floating spheres HET01 (RAMI, third phase), near infrared, from the intercomparison's own files.

    make_het01.py SPHERE.def[.xz] INSTANCES.def FOLDER

SPHERE: lines "R xc yc zc nx ny nz", one disc each, relative to a sphere's centre; INSTANCES: centres of the spheres. They are
published by the Joint Research Centre with the exercise and are not part of this project.
"""
import lzma
import math
import os
import sys

sphere, instances, folder = sys.argv[1:4]
with (lzma.open if sphere.endswith(".xz") else open)(sphere, "rt") as source, open(os.path.join(folder, "discs.csv"), "w") as out:
    out.write("x,y,z,qw,qx,qy,qz,scale\n")
    for line in source:
        r, x, y, z, nx, ny, nz = map(float, line.split()[:7])
        n = math.sqrt(nx * nx + ny * ny + nz * nz)
        nx, ny, nz = nx / n, ny / n, nz / n
        # The turn that takes the vertical to the normal: axis vertical x normal.
        q = (1 + nz, -ny, nx, 0.0) if nz > -0.999999 else (0.0, 1.0, 0.0, 0.0)
        out.write("%g,%g,%g,%.7f,%.7f,%.7f,0,%g\n" % (x, y, z, q[0], q[1], q[2], r))
with open(instances) as source, open(os.path.join(folder, "spheres.csv"), "w") as out:
    out.write("x,y,z\n")
    for line in source:
        if line.split():
            out.write(",".join(line.split()[:3]) + "\n")
with open(os.path.join(folder, "scene_het01.yaml"), "w") as out:
    out.write("""scene: 1
name: HET01 near infrared
materials:
  leaf: {model: lambert, reflectance: 0.4957, transmittance: 0.4409}
  soil: {model: lambert, reflectance: 0.159}
objects:
  disc: {disk: {radius: 1}, material: leaf}
  ground: {plane: {width: 100, depth: 100}, material: soil}
groups:
  sphere: [{place: disc, table: discs.csv}]
world:
  - {place: sphere, table: spheres.csv}
  - {place: ground}
""")
with open(os.path.join(folder, "sim_het01.yaml"), "w") as out:
    out.write("""scene: scene_het01.h5
max_nodes: 64
sun: {direction: {zenith_deg: 20, azimuth_deg: 90}, irradiance: 1, collimated: true}
periodic: {origin_m: [-50, -50], size_m: [100, 100]}
sensors:
  - kind: rami
    name: het01
    bands: [{name: nir, center_um: 0.85, fwhm_um: 0.01, shape: rectangular}]
    patch: {origin_m: [-50, -50], size_m: [100, 100]}
    top_m: 30
    sun_zenith_deg: 20
    sun_azimuth_deg: 90
    irradiance: 1
    ground_reflectance: 0.159
    truth: []
    model: suite
    experiment: HET01_DIS_UNI_NIR_20
    by_reciprocity: true
    planes: [principal]
    strata: 32
    paths: 1024
""")
