"""Oriented boxes: the smallest around points, and the one along a direction."""
from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

Numbers = npt.NDArray[np.float64]


def corners_of(mask: npt.NDArray[np.bool_]) -> Numbers:
    """The corners of a mask's pixels that can lie on its hull: those of the first and the last pixel of every row."""
    out = []
    for row in np.flatnonzero(mask.any(axis=1)):
        columns = np.flatnonzero(mask[row])
        out += [(x, y) for x in (columns[0], columns[-1] + 1) for y in (row, row + 1)]
    return np.array(out, dtype=float).reshape(-1, 2)


def hull(points: Numbers) -> Numbers:
    """The convex hull, counted one way round (A. M. Andrew's monotone chain, 1979)."""
    ordered = sorted({(float(x), float(y)) for x, y in points})
    if len(ordered) < 3:
        return np.array(ordered)

    def half(items: list[tuple[float, float]]) -> list[tuple[float, float]]:
        chain: list[tuple[float, float]] = []
        for p in items:
            while len(chain) > 1 and (chain[-1][0] - chain[-2][0]) * (p[1] - chain[-2][1]) <= (chain[-1][1] - chain[-2][1]) * (p[0] - chain[-2][0]):
                chain.pop()
            chain.append(p)
        return chain[:-1]

    return np.array(half(ordered) + half(ordered[::-1]))


def along(points: Numbers, direction: Numbers, margin: float = 0.0) -> Numbers:
    """The smallest box around points with two sides along a direction, wider by a margin all round. (4, 2): the corners clockwise in the picture,
    beginning ahead on the left (for whoever looks along the direction)."""
    ahead = np.asarray(direction, float) / math.hypot(*direction)
    right = np.array([-ahead[1], ahead[0]])  # y goes down: a quarter turn clockwise in the picture
    a, r = points @ ahead, points @ right
    a0, a1, r0, r1 = a.min() - margin, a.max() + margin, r.min() - margin, r.max() + margin
    return np.array([ahead * p + right * q for p, q in ((a1, r0), (a1, r1), (a0, r1), (a0, r0))])


def smallest(points: Numbers) -> Numbers:
    """The box of the smallest area around points; one of its sides lies on the hull (H. Freeman and R. Shapira 1975)."""
    corners = hull(points)
    best, area = along(corners, np.array([0.0, -1.0])), math.inf
    for (x0, y0), (x1, y1) in zip(corners, np.roll(corners, -1, axis=0)):
        if (x0, y0) != (x1, y1):
            box = along(corners, np.array([x1 - x0, y1 - y0]))
            size = math.dist(box[0], box[1]) * math.dist(box[1], box[2])
            if size < area - 1e-12:
                best, area = box, size
    return best
