#!/usr/bin/env python3
"""Writes the meshes of this scene beside it: house.obj (walls and a gable roof), crown.obj (leaves of a tree) and car.obj.
The same bytes every time; only the standard library is needed."""
import math
import random


def write(name, groups):
    """groups: material -> list of polygons, each a list of points."""
    with open(name, "w") as f:
        count = 0
        for material, polygons in groups:
            f.write(f"usemtl {material}\n")
            for polygon in polygons:
                for p in polygon:
                    f.write("v %.4f %.4f %.4f\n" % tuple(p))
                f.write("f " + " ".join(str(count + i + 1) for i in range(len(polygon))) + "\n")
                count += len(polygon)


def wall_quad(a, b, z0, z1):
    return [(a[0], a[1], z0), (b[0], b[1], z0), (b[0], b[1], z1), (a[0], a[1], z1)]


def house():
    x, y, eaves, ridge, over = 5.0, 4.0, 5.0, 8.0, 0.4
    corners = [(-x, -y), (x, -y), (x, y), (-x, y)]
    top = eaves - 0.03  # below the roof
    walls = [wall_quad(corners[i], corners[(i + 1) % 4], 0, top) for i in range(4)]
    walls.append([(x, -y, top), (x, y, top), (x, 0, ridge - 0.03)])
    walls.append([(-x, y, top), (-x, -y, top), (-x, 0, ridge - 0.03)])
    drop = over * (ridge - eaves) / y
    roof = [[(-x - over, -y - over, eaves - drop), (x + over, -y - over, eaves - drop), (x + over, 0, ridge), (-x - over, 0, ridge)],
            [(x + over, y + over, eaves - drop), (-x - over, y + over, eaves - drop), (-x - over, 0, ridge), (x + over, 0, ridge)]]
    write("house.obj", [("brick", walls), ("shingle", roof)])


def crown(leaves=2500, size=0.28):
    random.seed(7)
    polygons = []
    while len(polygons) < leaves:
        p = [random.uniform(-1, 1) for _ in range(3)]
        if sum(v * v for v in p) > 1:
            continue
        centre = (2.2 * p[0], 2.2 * p[1], 5.2 + 2.6 * p[2])
        z = random.uniform(-1, 1)
        phi, turn = random.uniform(0, 2 * math.pi), random.uniform(0, 2 * math.pi)
        s = math.sqrt(1 - z * z)
        n = (s * math.cos(phi), s * math.sin(phi), z)
        t = (-math.sin(phi), math.cos(phi), 0.0)
        b = (n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2], n[0] * t[1] - n[1] * t[0])
        e1 = [math.cos(turn) * t[k] + math.sin(turn) * b[k] for k in range(3)]
        e2 = [-math.sin(turn) * t[k] + math.cos(turn) * b[k] for k in range(3)]
        polygons.append([[centre[k] + size * (a * e1[k] + c * e2[k]) / 2 for k in range(3)] for a, c in ((-1, -0.6), (1, -0.6), (1, 0.6), (-1, 0.6))])
    write("crown.obj", [("leaf", polygons)])


def box(x0, y0, z0, x1, y1, z1):
    c = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    sides = [wall_quad(c[i], c[(i + 1) % 4], z0, z1) for i in range(4)]
    return sides + [[(x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)], [(x0, y1, z0), (x1, y1, z0), (x1, y0, z0), (x0, y0, z0)]]


def car():
    write("car.obj", [("paint", box(-2.1, -0.85, 0.3, 2.1, 0.85, 0.9) + box(-1.2, -0.75, 0.901, 1.0, 0.75, 1.45))])


if __name__ == "__main__":
    house()
    crown()
    car()
