"""The MODTRAN 5.2.1 paths of the package pybsm, and ours along the same ones (bench/path_bench): what compare and scripts/real_world share."""
import csv
import subprocess
from pathlib import Path

import numpy as np
import pybsm

WINDOWS = [(0.4, 0.7), (0.7, 1.1), (1.1, 1.35), (1.35, 1.5), (1.5, 1.8), (1.8, 2.0), (2.0, 2.4), (2.4, 2.9), (2.9, 3.4), (3.4, 4.15),
           (4.15, 4.6), (4.6, 5.3), (5.3, 7.2), (7.2, 8.2), (8.2, 9.3), (9.3, 10.15), (10.15, 12.4), (12.4, 14.0)]
C1, C2 = 1.191042972e8, 14387.76877  # W um4/(m2 sr), um K
VISIBILITY = {1: 23, 2: 5}


def planck(um, kelvin):
    return C1 / um**5 / np.expm1(C2 / (um * kelvin))


def brightness(um, radiance):
    return C2 / (um * np.log1p(C1 / (um**5 * radiance)))


class Paths:
    """The paths of the package, and ours along the same ones."""

    def __init__(self, build, continuum):
        self.program, self.words = Path(build) / "bench/path_bench", [continuum] if continuum else []
        self.folder = Path(pybsm.__file__).parent / "atms"
        table = csv.reader(open(self.folder / "fileDecoder.csv"))
        self.rows = [[float(x) for x in r[:4]] for r in table if r and r[0].strip().isdigit()]

    def theirs(self, rows):
        return np.array([np.fromfile(self.folder / ("%d.bin" % r[0]), dtype=np.float32).reshape(5, -1).T for r in rows])

    def ask(self, first, text=""):
        out = subprocess.run([str(self.program), *first, *self.words], input=text, capture_output=True, text=True, check=True)
        return out.stdout

    def ours(self, rows, first=()):
        text = "".join("%g %g %g\n" % (r[1], r[2], VISIBILITY[r[3]]) for r in rows)
        blocks = self.ask(first, text).split("path ")[1:]
        return np.array([[[float(x) for x in line.split()] for line in block.splitlines()[1:]] for block in blocks])

    def reported(self):
        return [[float(x) for x in line.split()] for line in self.ask(["--limits"]).splitlines()]


def drawn(paths, count, seed, nadir=False):
    """Rows of paths that lie below 100 km, by cosines of the view down to 0.1, in the order of their visibility."""
    rows = [r for r in paths.rows if r[1] < 100 and (r[2] == 0 if nadir else r[2] <= 10 * r[1] + 0.5)]
    chosen = [rows[i] for i in np.random.default_rng(seed).choice(len(rows), min(count, len(rows)), replace=False)]
    return sorted(chosen, key=lambda r: r[3]), len(rows)


def smooth(values):
    """By MODTRAN's slit, a triangle of 0.02 um, over steps of 0.01 um."""
    return 0.25 * np.roll(values, 1, 1) + 0.5 * values + 0.25 * np.roll(values, -1, 1)


class Window:
    """Means over pieces of a window that are as wide as the gas tables: 0.03 um, or 20 cm-1."""

    def __init__(self, um, low, high):
        self.inside = (um >= low) & (um <= high)
        self.each = max(3, round(20 * (0.5 * (low + high)) ** 2 / 1e4 / 0.01))

    def __call__(self, values):
        n = int(self.inside.sum()) // self.each * self.each
        return values[:, self.inside][:, :n].reshape(len(values), -1, self.each).mean(2)


def limit_of(limits, low, high):
    """What is reported in a window: rms and largest of transmittance, of brightness straight down and slanted; zeros where nothing is."""
    return next((l[2:] for l in limits if l[0] < high - 1e-3 and l[1] > low + 1e-3), [0] * 6)
