"""What the tests of campaigns share: folders, a small campaign, and a ray caster that knows nothing of the package."""
import hashlib
import os
import tempfile
import unittest
from pathlib import Path

import numpy as np

ROOT = Path(os.environ["SUITE_SOURCE"])

SCENE = """\
scene: 1
origin: {latitude_deg: 49.4, longitude_deg: 8.7, height_m: 112}
materials:
  ground: {model: lambert, reflectance: 0.1}
  paint: {model: lambert, reflectance: 0.5}
  white: {model: lambert, reflectance: 0.7}
objects:
  lot: {plane: {width: 60, depth: 60}, material: ground}
  roof: {box: {x0: -8, x1: 8, y0: -1, y1: 1.5, z0: 5, z1: 5.2}, material: ground}
  body: {box: {x0: -0.9, x1: 0.9, y0: -2.2, y1: 2.2, z0: 0, z1: 1.4}, material: paint}
  load: {box: {x0: -1.2, x1: 1.2, y0: -4, y1: 2, z0: 0.9, z1: 3.4}, material: paint}
  cab: {box: {x0: -1, x1: 1, y0: 2.1, y1: 4, z0: 0, z1: 2.6}, material: paint}
groups:
  car: [{place: body}]
  truck: [{place: load}, {place: cab}]
world: [{place: lot}, {place: roof}]
"""
SIMULATION = """\
scene: none.h5
sun: {direction: {zenith_deg: 40, azimuth_deg: 120}}
sky: {kind: clear}
max_nodes: 3
sensors:
  - {kind: orthographic, name: chip, columns: 32, rows: 32, gsd_m: 0.6, center_m: [0, 0], paths: 4, bands: [{name: red, center_um: 0.65, fwhm_um: 0.03}]}
"""
CAMPAIGN = """\
campaign: 1
seed: 3
samples: 5
scene: scene.yaml
simulation: simulation.yaml
vary:
  simulation.sun.direction.zenith_deg: {uniform: [20, 60]}
  scene.materials.ground.reflectance: {choice: [0.08, 0.12]}
objects:
  cars:
    catalogue:
      car: {place: car, weight: 2, materials: {paint: {choice: [paint, white]}}}
      truck: {place: truck}
    count: {integers: [3, 5]}
    where: {polygons: [[[-12, -12], [12, -12], [12, 12], [-12, 12]]]}
    heading_deg: {uniform: [0, 360]}
    on: lot
    spacing_m: 0.5
"""

# Two slots: samples 0 and 2 have three and four cars.
SOME_REFUSED = (CAMPAIGN.replace("samples: 5", "samples: 3\nformats: [coco]").replace("{uniform: [20, 60]}", "30").replace("{choice: [0.08, 0.12]}", "0.1")
                .replace("{polygons: [[[-12, -12], [12, -12], [12, 12], [-12, 12]]]}", "{rows: [{from: [-9, 0], to: [9, 0], count: 2, heading_deg: 0}]}")
                .replace("vary:\n", "vary:\n  n: {grid: [3, 1, 4]}\n").replace("{integers: [3, 5]}", "$n"))


class Case(unittest.TestCase):
    """A test with a folder of its own, which holds a small campaign."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def write(self, campaign=CAMPAIGN, scene=SCENE, simulation=SIMULATION):
        """The three texts; returns the campaign's path."""
        for name, text in (("campaign.yaml", campaign), ("scene.yaml", scene), ("simulation.yaml", simulation)):
            (self.folder / name).write_text(text)
        return self.folder / "campaign.yaml"


def hashes(folder):
    """Of every file of every sample."""
    return {str(p.relative_to(folder)): hashlib.sha256(p.read_bytes()).hexdigest() for p in sorted((Path(folder) / "samples").rglob("*")) if p.is_file()}


def chi_square_bound(cells, significance=1e-5):
    """The value that chi-square of so many cells passes once in 1 / significance (E. B. Wilson and M. M. Hilferty 1931)."""
    from statistics import NormalDist
    k = cells - 1
    return k * (1 - 2 / (9 * k) + NormalDist().inv_cdf(1 - significance) * (2 / (9 * k)) ** 0.5) ** 3


def chi_square(counts, expected):
    return sum((c - e) ** 2 / e for c, e in zip(counts, expected))


class Boxes:
    """A plain caster of rays against upright boxes that are turned about the vertical: slabs, one box after the other, no package."""

    def __init__(self):
        self.boxes = []

    def add(self, owner, low, high, position=(0, 0, 0), heading_deg=0.0, scale=1.0):
        self.boxes.append((owner, np.array(low, float), np.array(high, float), np.array(position, float), np.radians(heading_deg), scale))

    def trace(self, origin, direction, only=None):
        """The owner of what each ray meets first, or -1."""
        return self.first(origin, direction, only)[0]

    def first(self, origin, direction, only=None):
        """The owner, and how many lengths of its direction a ray goes there."""
        best, owner = np.full(len(origin), np.inf), np.full(len(origin), -1)
        for who, low, high, position, heading, scale in self.boxes:
            if only is not None and who != only:
                continue
            # Compass heading: +y of the box points to (sin, cos).
            ex, ey = np.array([np.cos(heading), -np.sin(heading), 0]), np.array([np.sin(heading), np.cos(heading), 0])
            frame = np.stack([ex, ey, [0, 0, 1]])
            o, d = (origin - position) @ frame.T / scale, direction @ frame.T / scale
            with np.errstate(divide="ignore", invalid="ignore"):
                a, b = (low - o) / d, (high - o) / d
            near, far = np.nanmax(np.minimum(a, b), axis=1), np.nanmin(np.maximum(a, b), axis=1)
            met = (near <= far) & (far > 0) & (near < best)
            best[met], owner[met] = near[met], who
        return owner, best
