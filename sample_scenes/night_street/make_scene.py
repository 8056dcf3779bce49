#!/usr/bin/env python3
"""Writes scene.yaml and sim.yaml of a town at night into a folder: make_scene.py FOLDER [COLUMNS ROWS]

Ten streets of 600 m with 1000 street lamps (two kinds of light), rows of houses with some 300 lit windows, a gibbous moon.
Needs Python 3 and its standard library only.
"""
import os
import random
import sys

folder = sys.argv[1] if len(sys.argv) > 1 else "."
columns, rows = (sys.argv[2:4] + ["480", "270"])[:2] if len(sys.argv) > 3 else ("480", "270")
os.makedirs(folder, exist_ok=True)
rnd = random.Random(7)

STREETS, LENGTH, GAP = 10, 600.0, 60.0
street_y = [(k - (STREETS - 1) / 2) * GAP for k in range(STREETS)]

# Houses: two rows between neighbouring streets, boxes of differing size, windows on the sides that face a street.
houses, windows = [], []
for k in range(STREETS - 1):
    middle = 0.5 * (street_y[k] + street_y[k + 1])
    for side in (-1, 1):
        x = -LENGTH / 2 + 8
        while x < LENGTH / 2 - 20:
            width, height = rnd.uniform(9, 16), rnd.choice((6, 6, 9, 12))
            y = middle + side * 10
            houses.append((x + width / 2, y, width, 12, height, rnd.choice(("brick", "plaster", "concrete"))))
            front = y + side * (6 + 0.02)
            for floor in range(int(height / 3)):
                if rnd.random() < 0.35:
                    windows.append((x + rnd.uniform(1.5, width - 1.5), front, 1.5 + 3 * floor, side))
            x += width + rnd.uniform(2, 7)
windows = rnd.sample(windows, min(300, len(windows)))

lamps = {"sodium": [], "led": []}
for k, y in enumerate(street_y):
    for i in range(50):
        x = -LENGTH / 2 + 6 + i * (LENGTH - 12) / 49
        for side in (-1, 1):
            lamps["sodium" if k % 3 == 0 else "led"].append((x + 3 * side, y + 6 * side, 7.0, side))

with open(os.path.join(folder, "scene.yaml"), "w") as out:
    out.write("""# Written by make_scene.py.
scene: 1
name: night street
description: A town at night, 1000 street lamps and lit windows
origin: {latitude_deg: 48.2, longitude_deg: 11.6, height_m: 500}
windows_um: [[0.4, 0.9]]
materials:
  asphalt: {model: lambert, reflectance: 0.08}
  grass: {model: lambert, reflectance: {points: [[0.4, 0.03], [0.55, 0.08], [0.68, 0.04], [0.72, 0.3], [0.9, 0.45]]}}
  brick: {model: lambert, reflectance: {points: [[0.4, 0.08], [0.55, 0.15], [0.65, 0.3], [0.9, 0.38]]}}
  plaster: {model: lambert, reflectance: {points: [[0.4, 0.35], [0.6, 0.6], [0.9, 0.65]]}}
  concrete: {model: lambert, reflectance: 0.3}
  steel: {model: lambert, reflectance: 0.4}
  window: {model: lambert, reflectance: 0.05}
objects:
  lawn: {plane: {width: 900, depth: 900}, material: grass}
  street: {plane: {width: %g, depth: 16}, material: asphalt}
  house: {box: {x0: -0.5, y0: -0.5, z0: 0, x1: 0.5, y1: 0.5, z1: 1}, material: plaster}
  pane: {plane: {width: 1.2, depth: 1.4}, material: window}
  pole: {cylinder: {radius: 0.08, height: 6.9}, material: steel}
world:
  - {place: lawn}
""" % LENGTH)
    for y in street_y:
        out.write("  - {place: street, translate: [0, %g, 0.05]}\n" % y)
    for x, y, w, d, h, m in houses:
        out.write("  - {place: house, scale: [%.2f, %g, %g], translate: [%.2f, %.2f, 0], material: %s}\n" % (w, d, h, x, y, m))
    for x, y, z, side in windows:
        # A pane faces up; a quarter turn about x lets it face the street.
        out.write("  - {place: pane, rotate: {axis: [1, 0, 0], angle_deg: %d}, translate: [%.2f, %.3f, %.2f]}\n" % (-90 * side, x, y, z))
    for kind in lamps.values():
        for x, y, z, side in kind:
            # The pole stands half a metre behind its lamp, which hangs over the street.
            out.write("  - {place: pole, translate: [%.3f, %.3f, 0]}\n" % (x, y + 0.5 * side))

with open(os.path.join(folder, "sim.yaml"), "w") as out:
    out.write("""# Written by make_scene.py.
scene: scene.h5
max_nodes: 5
moon: {direction: {zenith_deg: 55, azimuth_deg: 215}, phase_deg: 60}
sky: {radiance: 1.0e-4}
lamps:
  - {kind: surface, name: windows, material: window, radiance: {wavelength_um: [0.4, 0.5, 0.7, 0.9], value: [0.02, 0.1, 0.6, 1.2]}}
""")
    spectra = {"sodium": "{wavelength_um: [0.4, 0.56, 0.59, 0.62, 0.7, 0.9], value: [1, 5, 250, 60, 10, 30]}",
               "led": "{wavelength_um: [0.4, 0.45, 0.48, 0.56, 0.64, 0.72, 0.9], value: [1, 90, 25, 80, 50, 8, 0]}"}
    for name, places in lamps.items():
        out.write("  - kind: point\n    name: %s\n    intensity: %s\n" % (name, spectra[name]))
        out.write("    distribution: {table: [[1], [1.3], [1.7], [1.2], [0.05], [0], [0], [0], [0], [0], [0], [0], [0]]}  # steps of 15 degrees\n")
        out.write("    positions_m:\n")
        for x, y, z, side in places:
            out.write("      - [%.3f, %.3f, %g]\n" % (x, y, z))
    out.write("""sensors:
  - kind: frame_camera
    name: night
    columns: %s
    rows: %s
    pitch_um: 20
    focal_length_mm: 8
    position_m: [-330, -60, 90]
    look_at_m: [-60, 20, 0]
    bands:
      - {name: blue, center_um: 0.46, fwhm_um: 0.06, shape: rectangular}
      - {name: green, center_um: 0.55, fwhm_um: 0.06, shape: rectangular}
      - {name: red, center_um: 0.63, fwhm_um: 0.06, shape: rectangular}
    paths: 64
""" % (columns, rows))
