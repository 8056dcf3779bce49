#!/usr/bin/env python3
"""Writes a strip of ../valley into a folder: make_scene.py FOLDER

From the town over the bridge and the river into the forest on the slope: ground, houses, cars and lamp posts as there, trees by the same
rules in other places. Needs Python 3 and its standard library only; a second.
"""
import os
import re
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
VALLEY = os.path.join(HERE, "..", "valley")
sys.dont_write_bytecode = True
sys.path.insert(0, VALLEY)
import ground  # noqa: E402
import make_scene as valley  # noqa: E402
import materials  # noqa: E402
import town  # noqa: E402
import trees  # noqa: E402

ground.WEST, ground.SOUTH, ground.EAST, ground.NORTH = -340.0, -370.0, 30.0, 400.0
ground.NEAR = (ground.WEST, ground.SOUTH, ground.EAST, ground.NORTH)


def inside(x, y):
    return ground.WEST < x < ground.EAST and ground.SOUTH < y < ground.NORTH


def plain_materials():
    """The valley's, without textures of the fields and the fitted gloss of the panels: a few square metres of a narrow line see neither."""
    for name, keys in materials.MATERIALS.items():
        keys.pop("maps", None)
        if keys.get("model") == "sqt":
            materials.MATERIALS[name] = {"model": "ward", "diffuse": 0.03, "specular": 0.05, "roughness": 0.05}
    return materials.text()


def objects(folder, planted):
    """-> lines of the objects; their meshes are written."""
    meshes = {"house_" + kind: town.house(*size) for kind, size in valley.HOUSES.items()}
    meshes |= {"panels_" + kind: town.panels(*size) for kind, size in valley.HOUSES.items() if kind != "shed"}
    meshes |= {"court": town.courtyard(34, 11, 9.5), "car": town.car(), "bridge": town.bridge(150, 6.1)}
    meshes |= {kind: trees.grow(kind, 1) for kind in planted}
    for name, mesh in meshes.items():
        mesh.write(os.path.join(folder, name + ".obj"))
    walls = {kind: ("brick",) if kind == "shed" else ("plaster_white", "plaster_yellow", "plaster_grey", "brick") for kind in valley.HOUSES}
    out = ["%s_%s: {obj: house_%s.obj, normals: facet, materials: {wall: %s}}" % (kind, wall, kind, wall) for kind in walls for wall in walls[kind]]
    out += ["car_%s: {obj: car.obj, normals: facet, materials: {paint: paint_%s}}" % (paint, paint) for paint in materials.PAINTS]
    out += ["court: {obj: court.obj, normals: facet, materials: {wall: plaster_yellow}}"]
    out += ["%s: {obj: %s.obj, normals: facet}" % (name, name) for name in meshes if name.startswith("panels") or name in planted or name == "bridge"]
    return out


def placements(land, planted, folder):
    out = ["{place: ground, tag: ground}", "{place: water, translate: [-155, 20, 0], tag: water}", "{place: bridge, translate: [%g, 0, 0], tag: bridge}" % ground.BRIDGE_X]
    for line in valley.build() + [car for car in valley.drive() if "motion" not in car]:
        x, y = map(float, re.search(r"translate: \[(\S+), (\S+),", line).groups())
        if inside(x, y):
            out.append(line)
    out += ["{place: pole, translate: [%.1f, %.1f, %g], tag: pole}" % (x, y, ground.TOWN_M) for x, y in valley.lamps()[1] if inside(x, y)]
    for kind, rows in planted.items():
        valley.write_table(os.path.join(folder, kind + ".f64"), rows)
        out.append("{place: %s, table: %s.f64, tag: tree}" % (kind, kind))
    return out


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    folder = sys.argv[1]
    os.makedirs(folder, exist_ok=True)
    land = ground.Ground(os.path.join(HERE, "..", "calibration_range", "dem_hd_sub.tif"))
    land.write(os.path.join(folder, "heights.img"))
    cover = ground.Cover(land)
    cover.write(os.path.join(folder, "cover.png"))
    planted = {kind: [row for row in rows if inside(*row[:2])] for kind, rows in valley.plant(land, cover, 30000).items()}
    planted = {kind: rows for kind, rows in planted.items() if rows}
    with open(valley.HEAD) as head, open(os.path.join(folder, "scene.yaml"), "w") as out:
        out.write("# Written by make_scene.py.\n" + head.read() + "\n" + plain_materials())
        out.write("\nmaps:\n  cover:\n    type: class\n    file: cover.png\n    materials: {%s}\n    projection: drape\n"
                  "    drape: {origin: [%g, %g], gsd: %g, extend: clamp}\n" % (", ".join("%d: %s" % item for item in ground.NAMES.items()), ground.WEST, ground.NORTH, ground.PIXEL))
        out.write("\nobjects:\n  ground: {terrain: heights.img, local: {origin: [%g, %g], gsd: %g}, material: covered}\n"
                  % (ground.WEST - ground.STEP / 2, ground.NORTH + ground.STEP / 2, ground.STEP))
        out.write("  water: {plane: {width: 370, depth: 200}, material: water}\n  pole: {cylinder: {radius: 0.08, height: 6.8}, material: steel}\n")
        out.writelines("  %s\n" % line for line in objects(folder, planted))
        out.write("\nworld:\n")
        out.writelines("  - %s\n" % line for line in placements(land, planted, folder))


if __name__ == "__main__":
    main()
