#!/usr/bin/env python3
"""Writes the valley into a folder: make_scene.py FOLDER [TREES]

Ground from the shipped elevation raster, a river, a lake, a town, fields, forest, traffic, the weather of a clear day in June, and scene.yaml.
TREES (default 30000, more than there are places) is the most that are planted. Needs Python 3 and its standard library only; some 20 seconds.
"""
import lzma
import math
import os
import random
import struct
import sys

import ground
import materials
import town
import trees

HERE = os.path.dirname(os.path.abspath(__file__))
EPOCH_DAY = 171 + 0.0                        # of the year: 20 June
LATITUDE, LONGITUDE = 49.41277, 8.69613      # of the bend of the river
HEAD = os.path.join(HERE, "head.yaml")           # curves and media


def plant(land, cover, most):
    """-> species -> (x, y, z, heading, scale): forest on a jittered grid, single trees along the streets and the river."""
    rnd, out, step = random.Random(11), {kind: [] for kind in trees.KINDS}, 8.0
    x0, y0, x1, y1 = ground.NEAR
    places = []
    for j in range(int((y1 - y0) / step)):
        for i in range(int((x1 - x0) / step)):
            x, y = x0 + (i + rnd.uniform(0.1, 0.9)) * step, y0 + (j + rnd.uniform(0.1, 0.9)) * step
            if cover.at(x, y) == ground.FOREST:
                high = land.at(x, y) > 60 + 60 * ground.noise(x / 90, y / 90)
                places.append(("spruce" if rnd.random() < (0.75 if high else 0.15) else rnd.choice(("beech", "beech", "oak")), x, y))
            elif cover.at(x, y) == ground.MEADOW and 45 < ground.distance_to_line(ground.RIVER, x, y) < 54 and rnd.random() < 0.3:
                places.append(("oak", x, y))
    rnd.shuffle(places)
    for y in ground.STREETS_Y:
        for x in range(-500, 280, 26):
            if min(abs(x - s) for s in ground.STREETS_X) > 10:
                places.insert(0, ("oak", x, y + 5.3))
    for kind, x, y in places[:most]:
        scale = rnd.uniform(0.75, 1.15) * (0.5 if kind == "oak" and ground.TOWN[1] < y < ground.TOWN[3] and ground.TOWN[0] < x < ground.TOWN[2] else 1)
        out[kind].append((x, y, land.at(x, y) - 0.1, rnd.uniform(0, 2 * math.pi), scale))
    return out


def write_table(path, rows):
    with open(path, "wb") as out:
        for x, y, z, turn, scale in rows:
            out.write(struct.pack("<8d", x, y, z, math.cos(turn / 2), 0, 0, math.sin(turn / 2), scale))


TEXTS = ("drone", "strip", "satellite", "thermal", "night", "forest", "canopy", "mat")
HOUSES = {"small": (5.0, 4.0, 4.2, 7.2), "wide": (7.5, 4.6, 5.6, 9.2), "tall": (5.5, 4.6, 8.4, 12.0), "shed": (4.0, 3.2, 2.9, 4.6)}


def build():
    """-> lines of placements of the town."""
    rnd, out = random.Random(5), []
    walls = ["plaster_white", "plaster_yellow", "brick", "plaster_grey"]
    courts = {(1, 0), (3, 1)}
    for b, (xa, xb) in enumerate(zip(ground.STREETS_X, ground.STREETS_X[1:])):
        for c, (ya, yb) in enumerate(zip(ground.STREETS_Y[1:], ground.STREETS_Y)):
            if (b, c) in courts:
                out.append("{place: court, translate: [%.1f, %.1f, %g], tag: courtyard}" % ((xa + xb) / 2, (ya + yb) / 2, ground.TOWN_M))
                continue
            for side, y, heading in ((0, ya + 15.5, 180), (1, yb - 15.5, 0)):
                x = xa + 16
                while x < xb - 14:
                    kind = rnd.choice(("small", "wide", "tall", "small"))
                    half = HOUSES[kind][0]
                    name = "%s_%s" % (kind, rnd.choice(walls))
                    out.append("{place: %s, translate: [%.1f, %.1f, %g], rotate: {heading_deg: %g}, tag: house}" % (name, x + half, y, ground.TOWN_M, heading))
                    if rnd.random() < 0.3:  # on the roof's southern half
                        out.append("{place: panels_%s, translate: [%.1f, %.1f, %g], tag: solar panels}" % (kind, x + half, y, ground.TOWN_M))
                    x += 2 * half + rnd.uniform(3, 8)
            if rnd.random() < 0.7:
                out.append("{place: shed_brick, translate: [%.1f, %.1f, %g], rotate: {heading_deg: 90}, tag: house}" % ((xa + xb) / 2, (ya + yb) / 2, ground.TOWN_M))
    return out


def drive():
    """-> lines of cars: parked ones, and those that drive for two minutes about noon and about ten at night."""
    rnd, out, paints = random.Random(3), [], ("red", "blue", "white", "grey", "black")
    z = ground.TOWN_M + 0.05
    for y in ground.STREETS_Y:
        for k in range(14):
            x = rnd.uniform(ground.TOWN[0] + 10, ground.TOWN[2] - 10)
            if min(abs(x - s) for s in ground.STREETS_X) > 12:
                out.append("{place: car_%s, translate: [%.1f, %.1f, %.2f], rotate: {heading_deg: 90}, tag: parked car}" % (rnd.choice(paints), x, y - 3.1, z))
    for name, noon in (("day", 43200), ("night", 82800)):
        for y in ground.STREETS_Y:
            for k in range(6):
                east = k % 2 == 0
                x, v = rnd.uniform(-480, 240), rnd.uniform(8, 13)
                out.append("{place: car_%s, motion: {kind: straight, position_m: [%.1f, %.1f, %.2f], heading_deg: %d, speed_m_s: %.1f, t0_s: %d}, "
                           "appears: %d, disappears: %d, tag: %s traffic}" % (rnd.choice(paints), x, y + (-1.6 if east else 1.6), z, 90 if east else 270, v, noon,
                                                                            noon - 10, noon + 10, name))
    return out


def lamps():
    """Places of the street lamps, and of their poles, which stand behind the pavement, so that they throw no shadow on it and are not lit from near."""
    lights, poles = [], []
    for y in ground.STREETS_Y:
        for x in range(-505, 280, 30):
            lights.append((x, y - 4.6, ground.TOWN_M + 7))
            poles.append((x, y - 7.0))
    for x in ground.STREETS_X:
        for y in (-235, -145):
            lights.append((x + 4.6, y, ground.TOWN_M + 7))
            poles.append((x + 7.0, y))
    return lights, poles


def weather(path):
    """A clear day in June and those beside it: temperature, humidity and wind invented, sunlight after Meinel & Meinel 1976."""
    with open(path, "w") as out:
        out.write("# A clear day in June, written by make_scene.py: invented, no measurement.\nsite: %.4f %.4f 110\n" % (LATITUDE, LONGITUDE))
        out.write("time_utc, air_temperature [C], relative_humidity [%], wind_speed [m/s], wind_from [deg], pressure [hPa], "
                  "direct_normal [W/m2], diffuse [W/m2], cloud_cover [1]\n")
        for h in range(0, 97):
            day = 20 + h // 24
            direct = diffuse = 0.0
            for k in range(12):  # means of the hour that ends here
                t = h - (k + 0.5) / 12
                declination = math.radians(23.45) * math.sin(2 * math.pi * (284 + EPOCH_DAY + t / 24) / 365)
                hour = math.radians(15 * ((t % 24) + LONGITUDE / 15 - 0.03 - 12))
                up = math.sin(math.radians(LATITUDE)) * math.sin(declination) + math.cos(math.radians(LATITUDE)) * math.cos(declination) * math.cos(hour)
                if up > 0.01:
                    mass = 1 / (up + 0.15 * (math.degrees(math.asin(up)) + 3.885) ** -1.253)
                    direct += 1325 * 0.7 ** (mass ** 0.678) / 12
                    diffuse += (35 + 75 * up) * min(1, up / 0.05) / 12
            local = (h + LONGITUDE / 15) % 24
            air = 19.5 + 6.5 * math.cos(2 * math.pi * (local - 15.2) / 24)
            humid = 100 * math.exp(17.62 * 11.5 / (243.12 + 11.5) - 17.62 * air / (243.12 + air))
            wind = 1.4 + 1.3 * max(0, math.sin(math.pi * (local - 7) / 14))
            out.write("2026-06-%02dT%02d:00Z, %.2f, %.1f, %.2f, 240, 1000, %.1f, %.1f, 0\n" % (day, h % 24, air, humid, wind, direct, diffuse))


def write_scene(path, land, planted):
    out = open(path, "w")
    out.write("# Written by make_scene.py.\n" + open(HEAD).read() + "\n" + materials.text() + "\nmaps:\n  cover:\n    type: class\n    file: cover.png\n    materials: {%s}\n"
              % ", ".join("%d: %s" % item for item in ground.NAMES.items()))
    out.write("    projection: drape\n    drape: {origin: [%g, %g], gsd: %g, extend: clamp}\n" % (ground.WEST, ground.NORTH, ground.PIXEL))
    # Pasture: at every place one of 43 measured curves of grass, so that brightness and colour vary together as they were measured.
    out.write("  tufts:\n    type: texture\n    file: tufts.png\n    family: {file: grass_texture.ems, outside: hold}\n    bands_um: [[0.5, 0.6]]\n    projection: drape\n"
              "    drape: {origin: [0, 0], gsd: %g, extend: repeat}\n" % ground.TUFT)
    out.write("  rows:\n    type: mixture\n    file: rows.img\n    materials: [maize_leaf, soil]\n    projection: drape\n    drape: {origin: [0, 0], gsd: %g, extend: repeat}\n"
              % ground.DRILL)
    out.write("\nobjects:\n  ground: {terrain: heights.img, local: {origin: [%g, %g], gsd: %g}, material: covered}\n"
              % (ground.WEST - ground.STEP / 2, ground.NORTH + ground.STEP / 2, ground.STEP))
    # The water's own waves; it lies below the ground beyond its banks.
    out.write("  water: {sinusoid: {width: 5200, depth: 1500, terms: [{amplitude: 0.02, kx: 2.1, ky: 0.7, phase: 0}, {amplitude: 0.015, kx: -1.1, ky: 2.9, phase: 1}, "
              "{amplitude: 0.008, kx: 5.3, ky: 3.1, phase: 2}]}, material: water}\n")
    for kind in trees.KINDS:
        for v in (1, 2):
            trees.grow(kind, v).write(os.path.join(os.path.dirname(path), "%s_%d.obj" % (kind, v)))
            out.write("  %s_%d: {obj: %s_%d.obj, normals: facet}\n" % (kind, v, kind, v))
    for kind, size in HOUSES.items():
        town.house(*size).write(os.path.join(os.path.dirname(path), "house_%s.obj" % kind))
        for wall in ("brick",) if kind == "shed" else ("plaster_white", "plaster_yellow", "plaster_grey", "brick"):
            out.write("  %s_%s: {obj: house_%s.obj, normals: facet, materials: {wall: %s}}\n" % (kind, wall, kind, wall))
        if kind == "shed":
            continue
        town.panels(*size).write(os.path.join(os.path.dirname(path), "panels_%s.obj" % kind))
        out.write("  panels_%s: {obj: panels_%s.obj, normals: facet}\n" % (kind, kind))
    for name, mesh in (("court", town.courtyard(34, 11, 9.5)), ("car", town.car()), ("bridge", town.bridge(150, 6.1)), ("mast", town.mast()), ("wires", town.wires(150, 5))):
        mesh.write(os.path.join(os.path.dirname(path), name + ".obj"))
    out.write("  court: {obj: court.obj, normals: facet, materials: {wall: plaster_yellow}}\n  bridge: {obj: bridge.obj, normals: facet}\n")
    out.write("  mast: {obj: mast.obj, normals: facet}\n  wires: {obj: wires.obj, normals: facet}\n  pole: {cylinder: {radius: 0.08, height: 6.8}, material: steel}\n")
    for paint in ("red", "blue", "white", "grey", "black"):
        out.write("  car_%s: {obj: car.obj, normals: facet, materials: {paint: paint_%s}}\n" % (paint, paint))
    out.write("  plot: {plane: {width: 12, depth: 12}, material: meadow}\n")  # of the weather station: a temperature of its own
    out.write("\nworld:\n  - {place: ground, tag: ground}\n  - {place: water, translate: [-1290, 100, 0], tag: water}\n"
              "  - {place: bridge, translate: [%g, 0, 0], tag: bridge}\n" % ground.BRIDGE_X)
    out.write("  - {place: plot, translate: [-260, -314, %g], tag: weather station}\n" % (ground.TOWN_M + 0.01))
    for k in range(6):  # a power line over the plain in the west
        x, y = -960, -680 + 150 * k
        z = land.at(x, y)
        out.write("  - {place: mast, translate: [%g, %g, %.2f], tag: power line}\n" % (x, y, z))
        if k < 5:
            rise = land.at(x, y + 150) - z
            out.write("  - {place: wires, matrix: [1, 0, 0, %g, 0, 1, 0, %g, 0, %.6f, 1, %.2f], tag: power line}\n" % (x, y, rise / 150, z))
    for line in build() + drive():
        out.write("  - %s\n" % line)
    for x, y in lamps()[1]:
        out.write("  - {place: pole, translate: [%.1f, %.1f, %g]}\n" % (x, y, ground.TOWN_M))
    for kind, rows in planted.items():
        for v in (1, 2):
            name = "%s_%d" % (kind, v)
            if rows[v - 1::2]:
                write_table(os.path.join(os.path.dirname(path), name + ".f64"), rows[v - 1::2])
                out.write("  - {place: %s, table: %s.f64, tag: %s}\n" % (name, name, kind))
    out.close()


def main():
    if len(sys.argv) not in (2, 3) or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    folder = sys.argv[1]
    os.makedirs(folder, exist_ok=True)
    land = ground.Ground(os.path.join(HERE, "..", "calibration_range", "dem_hd_sub.tif"))
    land.write(os.path.join(folder, "heights.img"))
    cover = ground.Cover(land)
    cover.write(os.path.join(folder, "cover.png"))
    ground.write_tufts(os.path.join(folder, "tufts.png"))
    ground.write_rows(os.path.join(folder, "rows.img"))
    with lzma.open(os.path.join(HERE, "grass_texture.ems.xz")) as packed, open(os.path.join(folder, "grass_texture.ems"), "wb") as out:
        out.write(packed.read())
    write_scene(os.path.join(folder, "scene.yaml"), land, plant(land, cover, int(sys.argv[2]) if len(sys.argv) > 2 else 30000))
    weather(os.path.join(folder, "weather.csv"))
    bands = "".join("              - {name: b%03d, center_um: %.4f, fwhm_um: 0.02, shape: rectangular}\n" % (k + 1, 0.4 + 0.02 * k) for k in range(100))
    posts = "".join("      - [%.1f, %.1f, %g]\n" % p for p in lamps()[0])
    for name in TEXTS:
        with open(os.path.join(HERE, name + ".yaml")) as text, open(os.path.join(folder, name + ".yaml"), "w") as out:
            out.write(text.read().replace("BANDS\n", bands).replace("LAMPS\n", posts))


if __name__ == "__main__":
    main()
