#!/usr/bin/env python3
"""tests/unit/lidar/hot_spot_figure.py PROFILE.csv
Draws docs/pictures/lidar/hot_spot.svg of the mean waveforms that the test HotSpot.Canopies... writes where SUITE_PROFILE names a file."""
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "scripts/real_world_parts"))
from pictures import spectra  # noqa: E402

if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
    sys.exit(__doc__)
names = open(sys.argv[1]).readline().strip().split(",")[1:]
table = np.genfromtxt(sys.argv[1], delimiter=",", skip_header=1)
SUM = 8  # bins of the picture
n = len(table) // SUM * SUM
table = table[:n].reshape(-1, SUM, table.shape[1])
height, photons = 100 - table[:, :, 0].mean(axis=1), table[:, :, 1:].sum(axis=1)
# The ground is 100 times as bright as a layer of leaves: up to twice the canopy's brightest.
top = 2 * photons[height > 0.5].max()
curves = [(name.replace("_", " "), height, np.minimum(photons[:, k], top), None) for k, name in enumerate(names)]
target = ROOT / "docs/pictures/lidar/hot_spot.svg"
target.parent.mkdir(exist_ok=True)
target.write_text(spectra("mean of 64 canopies", "height, m (the ground's peak is cut off)", "photons in %d bins" % SUM, curves))
print("ground:", {name: float(photons[np.abs(height) < 0.1, k].sum()) for k, name in enumerate(names)})
