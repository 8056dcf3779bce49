#!/usr/bin/env python3
"""Writes the leaves, the trees and the simulations of this sample into a folder.

    make_inputs.py [FOLDER] [--trees N] [--leaves N] [--paths N]

A tree is N discs, uniform in an ellipsoid, over a trunk. A tile of 40 m x 40 m carries N trees at random (no two crowns' axes
nearer than 1.2 m, across its edges too), each turned about its axis; it repeats itself without end. The goniometer sees that forest as
one surface.
"""
import argparse
import math
import os
import random

parser = argparse.ArgumentParser()
parser.add_argument("folder", nargs="?", default=".")
parser.add_argument("--trees", type=int, default=160, help="on a tile")
parser.add_argument("--leaves", type=int, default=220, help="of a tree")
parser.add_argument("--paths", type=int, default=3000000, help="of the goniometer, for each view zenith")
parser.add_argument("--views", type=int, default=4096, help="paths of each view of the comparison, for each side of the sun")
args = parser.parse_args()
random.seed(5)
TILE, CROWN, MIDDLE, LEAF = 40.0, (1.4, 1.4, 2.2), 3.6, 0.12
TOP = MIDDLE + CROWN[2] + LEAF
SIDES = 12  # from which the trees are seen and lit: those of one tile are no even forest


def write(name, text):
    with open(os.path.join(args.folder, name), "w") as out:
        out.write(text)


def quaternion(turn, tilt):
    """Of a disc in its x-y plane that is tilted about x, then turned about z."""
    c, s, ch, sh = math.cos(turn / 2), math.sin(turn / 2), math.cos(tilt / 2), math.sin(tilt / 2)
    return c * ch, c * sh, s * sh, s * ch


rows = ["x,y,z,qw,qx,qy,qz"]
while len(rows) <= args.leaves:
    p = [random.uniform(-1, 1) for _ in range(3)]
    if sum(v * v for v in p) > 1:
        continue
    q = quaternion(random.uniform(0, 2 * math.pi), math.acos(random.uniform(0, 1)))  # spherical leaves
    rows.append("%.4f,%.4f,%.4f,%.6f,%.6f,%.6f,%.6f" % (*(v * r for v, r in zip(p, CROWN)), *q))
write("leaves.csv", "\n".join(rows) + "\n")

places = []
while len(places) < args.trees:
    x, y = random.uniform(-TILE / 2, TILE / 2), random.uniform(-TILE / 2, TILE / 2)
    gap = lambda a, b: abs((a - b + TILE / 2) % TILE - TILE / 2)
    if all(math.hypot(gap(x, u), gap(y, v)) > 1.2 for u, v in places):
        places.append((x, y))
write("trees.csv", "x,y,z,heading_deg\n" + "".join("%.4f,%.4f,0,%.2f\n" % (x, y, random.uniform(0, 360)) for x, y in places))

materials = """materials:
  leaf: {model: lambert, reflectance: {points: [[0.6, 0.06], [0.7, 0.06], [0.78, 0.46], [0.95, 0.46]]},
         transmittance: {points: [[0.6, 0.03], [0.7, 0.03], [0.78, 0.42], [0.95, 0.42]]}}
  bark: {model: lambert, reflectance: 0.2}
  soil: {model: lambert, reflectance: {points: [[0.6, 0.12], [0.95, 0.2]]}}
"""
tree = f"""  leaf: {{disk: {{radius: {LEAF}}}, material: leaf}}
  trunk: {{cylinder: {{radius: 0.08, height: {MIDDLE}, capped: 0}}, material: bark}}
"""
groups = f"""groups:
  tree: [{{place: leaf, table: leaves.csv, translate: [0, 0, {MIDDLE}]}}, {{place: trunk}}]
  tile: [{{place: tree, table: trees.csv}}]
"""
write("forest.yaml", f"""scene: 1
name: a tile of forest, {args.trees} trees of {args.leaves} leaves
{materials}objects:
{tree}  ground: {{plane: {{width: {TILE}, depth: {TILE}}}, material: soil}}
{groups}world: [{{place: tile, tag: trees}}, {{place: ground, tag: soil}}]
""")
write("surface.yaml", f"""scene: 1
name: the same forest as one surface
materials: {{canopy: {{model: sqt, file: canopy.sqt}}}}
objects: {{ground: {{plane: {{width: {TILE}, depth: {TILE}}}, material: canopy}}}}
world: [{{place: ground, tag: canopy}}]
""")

# Narrow: between its two wavelengths the surface is linear, where leaves are not.
bands = "[{name: red, center_um: 0.66, fwhm_um: 0.002, shape: rectangular}, {name: nir, center_um: 0.85, fwhm_um: 0.002, shape: rectangular}]"
half = TILE / 2
patch = f"{{origin_m: [{-half}, {-half}], size_m: [{TILE}, {TILE}]}}"
write("measure.yaml", f"""scene: forest.h5
max_nodes: 64
sky: {{radiance: 1, full_sphere: true}}
periodic: {patch}
sensors:
  - kind: goniometer
    name: canopy
    bands: {bands}
    patch: {patch}
    height_m: {TOP}
    view_zenith_deg: [0, 7.5, 15, 22.5, 30, 37.5, 45, 52.5, 60, 67.5, 75, 82.5]
    rings: 24
    azimuths: 24
    view_azimuths: {SIDES}
    bilateral: true
    paths: {args.paths // SIDES}
""")
for scene, azimuths in (("forest", range(0, 360, 360 // SIDES)), ("surface", (90,))):
    for sun in (30, 55):
        for azimuth in azimuths:
            write(f"view_{scene}_{sun}_{azimuth}.yaml", f"""scene: {scene}.h5
max_nodes: 64
sun: {{direction: {{zenith_deg: {sun}, azimuth_deg: {azimuth}}}, irradiance: 1, collimated: true}}
periodic: {patch}
sensors:
  - kind: rami
    name: {scene}_{sun}_{azimuth}
    bands: {bands}
    patch: {patch}
    top_m: {TOP if scene == "forest" else 0.01}
    sun_zenith_deg: {sun}
    sun_azimuth_deg: {azimuth}
    irradiance: 1
    truth: []
    paths: {args.views}
""")

# Two stands of 200 m x 200 m: 25 tiles of trees in the west, the surface in the east, a road between them.
tiles = ["x,y,z"] + [f"{-20 - TILE * (i + 0.5)},{-100 + TILE * (j + 0.5)},0" for i in range(5) for j in range(5)]
write("tiles.csv", "\n".join(tiles) + "\n")
write("landscape.yaml", f"""scene: 1
name: one stand of trees, one of the surface that was measured
{materials}  canopy: {{model: sqt, file: canopy.sqt}}
  road: {{model: lambert, reflectance: 0.1}}
objects:
{tree}  ground: {{plane: {{width: 600, depth: 300}}, material: soil}}
  road: {{plane: {{width: 40, depth: 300}}, material: road}}
  stand: {{plane: {{width: 200, depth: 200}}, material: canopy}}
{groups}world:
  - {{place: ground, tag: soil}}
  - {{place: road, translate: [0, 0, 0.05], tag: road}}
  - {{place: tile, table: tiles.csv, tag: trees}}
  - {{place: stand, translate: [120, 0, {TOP}], tag: canopy}}
""")
write("landscape_view.yaml", f"""scene: landscape.h5
max_nodes: 64
sun: {{direction: {{zenith_deg: 40, azimuth_deg: 150}}, irradiance: 1, collimated: true}}
sensors:
  - {{kind: orthographic, name: landscape, columns: 250, rows: 110, gsd_m: 2, center_m: [0, 0], paths: 64, bands: {bands}}}
output: {{preview: [nir, red, red]}}
""")
