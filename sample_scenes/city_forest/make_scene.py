#!/usr/bin/env python3
"""Makes a city-and-forest scene of any size into a folder: make_scene.py FOLDER [OBJECTS [GRID [INSTANCES]]]

Defaults: 200 objects of 158 x 158 cells (50 k triangles each, 10 million stored), 100 000 instances, 40 materials, 3 maps.
Every object is a closed, bumpy torus-like surface with normals and texture coordinates, so that nothing in it is degenerate. Needs
Python 3 and its standard library only.
"""
import math
import os
import random
import struct
import sys
import zlib

FOLDER = sys.argv[1] if len(sys.argv) > 1 else "."
OBJECTS = int(sys.argv[2]) if len(sys.argv) > 2 else 200
GRID = int(sys.argv[3]) if len(sys.argv) > 3 else 158
INSTANCES = int(sys.argv[4]) if len(sys.argv) > 4 else 100000
MATERIALS = 40


def faces(n):
    rows = []
    for j in range(n):
        for i in range(n):
            a, b = j * n + i + 1, j * n + (i + 1) % n + 1
            c, d = (j + 1) % n * n + (i + 1) % n + 1, (j + 1) % n * n + i + 1
            rows.append("f %d/%d/%d %d/%d/%d %d/%d/%d\nf %d/%d/%d %d/%d/%d %d/%d/%d\n" % (a, a, a, c, c, c, b, b, b, a, a, a, d, d, d, c, c, c))
    return rows


def write_object(path, n, k, face_rows):
    rnd = random.Random(k)
    major, minor, lobes, depth = 2 + rnd.random(), 0.8 + 0.4 * rnd.random(), rnd.randint(3, 9), 0.05 + 0.1 * rnd.random()
    angles = [2 * math.pi * i / n for i in range(n)]
    circle = [(math.cos(a), math.sin(a)) for a in angles]
    bumps = [1 + depth * math.sin(lobes * a) for a in angles]
    v, vn, vt = [], [], []
    for j in range(n):
        cj, sj = circle[j]
        r = minor * bumps[j]
        for i in range(n):
            ci, si = circle[i]
            q = r * bumps[i]
            ring = major + q * ci
            v.append("v %.5f %.5f %.5f\n" % (ring * cj, ring * sj, minor * 1.2 + q * si))
            vn.append("vn %.4f %.4f %.4f\n" % (ci * cj, ci * sj, si))
            vt.append("vt %.5f %.5f\n" % (i / n, j / n))
    half = len(face_rows) // 2
    with open(path, "w") as out:
        out.writelines(v)
        out.writelines(vn)
        out.writelines(vt)
        out.write("g lower\nusemtl m%02d\n" % (k % MATERIALS))
        out.writelines(face_rows[:half])
        out.write("g upper\nusemtl m%02d\n" % ((7 * k + 3) % MATERIALS))
        out.writelines(face_rows[half:])


def write_png(path, width, height, value):
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    rows = b"".join(b"\0" + bytes(value(i, j) for i in range(width)) for j in range(height))
    with open(path, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
                  + chunk(b"IDAT", zlib.compress(rows, 6)) + chunk(b"IEND", b""))


def main():
    os.makedirs(FOLDER, exist_ok=True)
    face_rows = faces(GRID)
    for k in range(OBJECTS):
        write_object(os.path.join(FOLDER, "o%03d.obj" % k), GRID, k, face_rows)
    for m in range(3):
        write_png(os.path.join(FOLDER, "map%d.png" % m), 512, 512, lambda i, j: 1 + (i // 16 * 7 + j // 16 * 3 + m) % 8)
    rnd = random.Random(1)
    side = 3000.0
    per = max(1, INSTANCES // OBJECTS)
    for k in range(OBJECTS):
        with open(os.path.join(FOLDER, "t%03d.f64" % k), "wb") as out:
            for _ in range(per):
                a = rnd.random() * math.pi
                out.write(struct.pack("<8d", rnd.uniform(-side, side), rnd.uniform(-side, side), 0, math.cos(a), 0, 0, math.sin(a), 0.5 + rnd.random()))
    with open(os.path.join(FOLDER, "ground.obj"), "w") as out:
        for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
            out.write("v %g %g 0\n" % (x * side, y * side))
        out.write("usemtl ground0\nf 1 2 3 4\n")
    with open(os.path.join(FOLDER, "scene.yaml"), "w") as out:
        out.write("scene: 1\nname: city and forest\nmaterials:\n")
        for m in range(MATERIALS):
            out.write("  m%02d: {model: lambert, reflectance: %.3f}\n" % (m, 0.05 + 0.02 * m))
        for m in range(3):
            out.write("  ground%d: {map: map%d}\n" % (m, m))
        out.write("maps:\n")
        for m in range(3):
            classes = ", ".join("%d: m%02d" % (c, (c * 5 + m) % MATERIALS) for c in range(1, 9))
            out.write("  map%d: {type: class, file: map%d.png, materials: {%s}, drape: {origin: [%g, %g], gsd: %.6f}}\n" % (m, m, classes, -side, side, 2 * side / 512))
        out.write("objects:\n  ground: {obj: ground.obj}\n")
        for k in range(OBJECTS):
            out.write("  o%03d: {obj: o%03d.obj}\n" % (k, k))
        out.write("world:\n  - {place: ground}\n  - {place: ground, translate: [6000, 0, 0], material: ground1}\n  - {place: ground, translate: [0, 6000, 0], material: ground2}\n")
        for k in range(OBJECTS):
            out.write("  - {place: o%03d, table: t%03d.f64, tag: kind%03d}\n" % (k, k, k))


main()
