"""What the readers of exports share: pairs of directions, and what the fit has there."""
import math
import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "python"))
import remote_scenes

LIMIT = math.cos(math.radians(80))  # where the measure of l1 ends
SHARP = 1e-3  # of the lobe of directions around the mirror direction


def vector(theta, phi):
    return math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta)


def around(axis, drop, turn):
    """The unit vector whose cosine to the axis is 1 - drop."""
    x, y, z = axis
    s = math.hypot(x, y)
    a = (x * z / s, y * z / s, -s) if s > 1e-9 else (1, 0, 0)
    b = (-y / s, x / s, 0) if s > 1e-9 else (0, 1, 0)
    r = math.sqrt(drop * (2 - drop))
    return tuple((1 - drop) * k + r * (math.cos(turn) * i + math.sin(turn) * j) for i, j, k in zip(a, b, axis))


def draw(rng):
    """(out, in, weight) up to 80 degrees: half of the pairs uniform, half near the mirror direction, weighed to uniform solid angles."""
    while True:
        out = vector(math.acos(rng.uniform(LIMIT, 1)), rng.uniform(0, 2 * math.pi))
        mirror = (-out[0], -out[1], out[2])
        if rng.uniform(0, 1) < 0.5:
            into = vector(math.acos(rng.uniform(0, 1)), rng.uniform(0, 2 * math.pi))
        else:
            drop = SHARP * (1 / (1 - rng.uniform(0, 1) * 2 / (2 + SHARP)) - 1)
            into = around(mirror, min(drop, 2), rng.uniform(0, 2 * math.pi))
        if into[2] >= LIMIT:
            break
    drop = 1 - sum(a * b for a, b in zip(mirror, into))
    density = 0.5 / (2 * math.pi) + 0.5 * SHARP / (SHARP + drop) ** 2 * (2 + SHARP) / 2 / (2 * math.pi)
    return out, into, 1 / density


def fitted(binaries, sqt, pairs):
    """f without cosine of the fit, (pairs, channels), by the library of these programs."""
    os.environ["REMOTE_SCENES_BIN"] = binaries
    with remote_scenes.open_sqt(sqt) as fit:
        return fit.evaluate([p[0] for p in pairs], [p[1] for p in pairs])


class Difference:
    """Relative l1 with the standard error of its draws."""

    def __init__(self):
        self.rows = []

    def add(self, theirs, ours, weight):
        self.rows.append((weight * abs(theirs - ours), weight * ours))

    def text(self):
        n = len(self.rows)
        error, total = (sum(r[k] for r in self.rows) for k in (0, 1))
        l1 = error / total
        spread = math.sqrt(sum((e - l1 * t) ** 2 for e, t in self.rows)) / total
        return f"l1 {100 * l1:.3g} +- {100 * spread:.2g} % over {n} pairs up to 80 deg"
