#!/usr/bin/env python3
"""Makes clouds.u8 and clouds.vox: three invented heaps of cloud with flat bases in one grid. Needs Python 3 alone."""
import math
import os

HERE = os.path.dirname(os.path.abspath(__file__))
CELLS, CELL = (56, 72, 12), 50.0
ORIGIN = (-1400.0, -1800.0, 0.0)
# x, y, z, radius of the spheres that a cloud is made of, m.
PUFFS = [(-650, -1150, 130, 330), (-350, -1000, 160, 290), (-850, -900, 100, 260),
         (350, 50, 150, 340), (650, 250, 120, 280), (150, 350, 110, 260), (450, 150, 330, 190),
         (-500, 1150, 120, 300), (-200, 1250, 160, 270), (-700, 1400, 90, 220)]


def density(x, y, z):
    inside = max(1 - math.dist((x, y, z), p[:3]) / p[3] for p in PUFFS)
    rough = sum(math.sin(x / s + 1.3 * i) * math.sin(y / s - i) * math.cos(z / s + 0.7 * i) * s / 110
                for i, s in enumerate((110.0, 57.0, 31.0)))
    return max(0.0, min(1.0, 4 * (inside + 0.12 * rough)))


data = bytearray()
for k in range(CELLS[2]):
    for j in range(CELLS[1]):
        for i in range(CELLS[0]):
            data.append(round(255 * density(*(o + (n + 0.5) * CELL for o, n in zip(ORIGIN, (i, j, k))))))
with open(os.path.join(HERE, "clouds.u8"), "wb") as f:
    f.write(data)
with open(os.path.join(HERE, "clouds.vox"), "w") as f:
    f.write("# Made by make_inputs.py.\nvoxels: 1\ncells: [%d, %d, %d]\ncell_m: %g\norigin_m: [%g, %g, %g]\n" % (*CELLS, CELL, *ORIGIN))
    f.write("fields:\n  density: {file: clouds.u8, type: uint8, scale: 0.00392157}\n")
