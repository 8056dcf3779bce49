#!/usr/bin/env python3
"""Makes plume.u8, cloud.u8 and their .vox texts; needs Python 3 and its standard library only.

Both are invented: a Gaussian plume that rises, widens and meanders with the wind, and a heap of spheres with a flat base,
each roughened by a few octaves of value noise.
"""
import math
import os

HERE = os.path.dirname(os.path.abspath(__file__))


def mix(*n):
    h = 0x9E3779B97F4A7C15
    for x in n:
        h = (h ^ (x & 0xFFFFFFFF)) * 0xBF58476D1CE4E5B9 & 0xFFFFFFFFFFFFFFFF
        h ^= h >> 29
    return (h >> 11) / 2**53


def noise(x, y, z, seed):
    i, j, k = math.floor(x), math.floor(y), math.floor(z)
    u, v, w = (t * t * (3 - 2 * t) for t in (x - i, y - j, z - k))
    total = 0
    for di, dj, dk in ((a, b, c) for a in (0, 1) for b in (0, 1) for c in (0, 1)):
        weight = (u if di else 1 - u) * (v if dj else 1 - v) * (w if dk else 1 - w)
        total += weight * mix(i + di, j + dj, k + dk, seed)
    return total


def octaves(x, y, z, seed):
    return sum(noise(x * 2**o, y * 2**o, z * 2**o, seed + o) / 2**o for o in range(4)) / 1.875


def write(name, cells, cell, origin, density, scale):
    nx, ny, nz = cells
    data = bytearray()
    for k in range(nz):
        for j in range(ny):
            for i in range(nx):
                p = [origin[a] + (n + 0.5) * cell for a, n in enumerate((i, j, k))]
                data.append(max(0, min(255, round(density(*p) / scale))))
    with open(os.path.join(HERE, name + ".u8"), "wb") as f:
        f.write(data)
    with open(os.path.join(HERE, name + ".vox"), "w") as f:
        f.write("# Made by make_inputs.py.\nvoxels: 1\ncells: [%d, %d, %d]\ncell_m: %g\norigin_m: [%g, %g, %g]\n" % (*cells, cell, *origin))
        f.write("fields:\n  density: {file: %s.u8, type: uint8, scale: %g}\n" % (name, scale))


def plume(x, y, z):
    """x: along the wind from the stack's mouth, m."""
    if x < 0:
        return 0
    radius = 4 + 0.11 * x
    across = 6 * math.sin(x / 55) * min(1, x / 80)
    height = 70 * (1 - math.exp(-x / 140)) + 4 * math.sin(x / 30)
    r = math.hypot(y - across, z - height) / radius
    if r > 2.5:
        return 0
    rough = octaves(x / 24, y / 24, z / 24, 1)
    return 16 / radius**2 * 10 * math.exp(-2 * r * r) * max(0, 2.4 * rough - 0.6)


PUFFS = [(0, 0, 60, 70), (75, 20, 45, 55), (-70, 30, 40, 50), (20, -65, 45, 55), (-30, 70, 40, 48), (30, 30, 105, 48), (-30, -25, 90, 45)]


def cloud(x, y, z):
    inside = max(1 - math.dist((x, y, z), p[:3]) / p[3] for p in PUFFS)
    rough = octaves(x / 45, y / 45, z / 45, 9)
    return max(0, min(1, 3 * (inside + 0.7 * (rough - 0.45)))) if z > 6 else 0


write("plume", (96, 40, 32), 5.0, (0, -100, -30), plume, 1 / 64)
write("cloud", (40, 40, 22), 8.0, (-160, -160, 0), cloud, 1 / 255)
