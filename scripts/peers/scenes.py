"""The scenes, in the order of the table: each a function (folder, size) -> Scene that writes the files it needs into the folder."""
import math
import os
import random
import struct

from peers.texts import Scene, diffuse, leaf, ply, rgb, turned_xml, write_mesh

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SATIN = os.path.join(ROOT, "sample_scenes/calibration_range/satin_purple_rgb.bsdf")
CHROME = os.path.join(ROOT, "tests/data/brdf/chm_mint_rgb.bsdf")


def height(x, y):
    z, a, f = 0, 40, 0.006
    for k in range(6):
        z += a * math.sin(1.3 * f * x + k) * math.cos(f * y + 1.7 * k)
        a, f = a * 0.5, f * 2.1
    return z


def grid(n, extent, z):
    at = [-extent / 2 + extent * i / (n - 1) for i in range(n)]
    points = [(x, y, z(x, y)) for y in at for x in at]
    triangles = []
    for j in range(n - 1):
        for i in range(n - 1):
            v = j * n + i
            triangles += [(v, v + 1, v + n + 1), (v, v + n + 1, v + n)]
    return points, triangles


def terrain(folder, vertices):
    write_mesh(f"{folder}/terrain", *grid(vertices, 1000, height))
    return Scene("terrain", (0, -600, 500), (0, 0, 0), 60, ply("terrain", diffuse(0.5)),
                 "grey: {model: lambert, reflectance: 0.5}", "thing: {obj: terrain.obj, material: grey}", ["{place: thing}"],
                 'Material "diffuse" "spectrum reflectance" [300 0.5 900 0.5]\nShape "plymesh" "string filename" "terrain.ply"', sun=3, sky=0.3)


def furnace(folder, _):
    return Scene("furnace", (0, -8, 0), (0, 0, 0), 10, f'<shape type="sphere"><float name="radius" value="1"/>{diffuse(0.5)}</shape>',
                 "grey: {model: lambert, reflectance: 0.5}", "thing: {sphere: {radius: 1}, material: grey}", ["{place: thing}"],
                 'Material "diffuse" "spectrum reflectance" [300 0.5 900 0.5]\nShape "sphere" "float radius" 1', sky=0.3, exact=0.15)


def satin(folder, _):
    """sqt-fit is to take measured files as Mitsuba does, the viewer's direction for the incident one: the data are not reciprocal."""
    path = os.path.relpath(SATIN, folder)
    return Scene("satin", (0, -8, 4), (0, 0, 0), 16,
                 f'<shape type="sphere"><float name="radius" value="1"/><bsdf type="measured"><string name="filename" value="{path}"/></bsdf></shape>',
                 "fit: {model: sqt, file: satin.sqt}", "thing: {sphere: {radius: 1}, material: fit}", ["{place: thing}"],
                 f'Material "measured" "string filename" "{path}"\nShape "sphere" "float radius" 1', sun=3, sky=0.3, channels="rgb",
                 fitted=(("satin", SATIN, "--max-error", "0.005"),))


def chrome(folder, _):
    """A sphere with a narrow lobe under lamps of three sizes, which reflect nothing. Without red: the file has negative values there,
    which Mitsuba adds and sqt-fit counts as 0."""
    path, lamps = os.path.relpath(CHROME, folder), ((-2.5, 0, 3.5, 2.0, 3), (0, -1, 4, 0.5, 30), (2, -1.5, 3.5, 0.12, 300))
    panes = "".join(f'<shape type="rectangle">{turned_xml((side / 2, side / 2, 1), [("x", 180)], (x, y, z))}{diffuse(0)}'
                    f'<emitter type="area">{rgb("radiance", radiance)}</emitter></shape>' for x, y, z, side, radiance in lamps)
    return Scene("chrome", (0, -8, 3), (0, 0, 0), 18,
                 f'<shape type="sphere"><float name="radius" value="1"/><bsdf type="measured"><string name="filename" value="{path}"/></bsdf></shape>{panes}',
                 "fit: {model: sqt, file: chrome.sqt}, " + ", ".join(f"lamp{i}: {{model: lambert, reflectance: 0}}" for i in range(3)),
                 "ball: {sphere: {radius: 1}, material: fit}, "
                 + ", ".join(f"pane{i}: {{plane: {{width: {lamp[3]}, depth: {lamp[3]}}}, material: lamp{i}}}" for i, lamp in enumerate(lamps)),
                 ["{place: ball}"]
                 + ["{place: pane%d, rotate: {axis: [1, 0, 0], angle_deg: 180}, translate: [%g, %g, %g]}" % (i, *lamp[:3]) for i, lamp in enumerate(lamps)],
                 sky=0.3, channels="gb", fitted=(("chrome", CHROME, "--max-error", "0.015"),),
                 lamps="lamps:\n" + "".join(f"  - {{kind: surface, name: lamp{i}, material: lamp{i}, radiance: {lamp[4]}}}\n" for i, lamp in enumerate(lamps)))


def spheres(folder, _):
    """Two measured spheres side by side on a grey plane: they light it, it lights them. Of satin: what chrome throws there of a sun
    without width is found by chance alone, by every program, and no error says anything after so few paths."""
    path = os.path.relpath(SATIN, folder)
    balls = "".join(f'<shape type="sphere"><point name="center" x="{x}" y="0" z="1"/><float name="radius" value="1"/><bsdf type="measured">'
                    f'<string name="filename" value="{path}"/></bsdf></shape>' for x in (-1.1, 1.1))
    return Scene("spheres", (0, -9, 4), (0, 0, 0.7), 32, balls + f'<shape type="rectangle">{turned_xml((20, 20, 1))}{diffuse(0.4)}</shape>',
                 "grey: {model: lambert, reflectance: 0.4}, fit: {model: sqt, file: spheres.sqt}",
                 "ground: {plane: {width: 40, depth: 40}, material: grey}, ball: {sphere: {radius: 1}, material: fit}",
                 ["{place: ground}"] + ["{place: ball, translate: [%g, 0, 1]}" % x for x in (-1.1, 1.1)],
                 sun=3, sky=0.3, channels="rgb", fitted=(("spheres", SATIN, "--max-error", "0.005"),))


def tree(leaves, rnd):
    """A crown of loose triangles between 2 and 8 m above the ground, over a trunk of six sides."""
    points, triangles = [], []
    for k in range(6):
        a, b = math.pi * k / 3, math.pi * (k + 1) / 3
        at = len(points)
        points += [(0.15 * math.cos(a), 0.15 * math.sin(a), 0), (0.15 * math.cos(b), 0.15 * math.sin(b), 0), (0, 0, 6)]
        triangles.append((at, at + 1, at + 2))
    wood = len(triangles)
    while len(triangles) < wood + leaves:
        x, y, z = (rnd.uniform(-1, 1) for _ in range(3))
        if x * x + y * y + z * z > 1:
            continue
        centre, at = (2 * x, 2 * y, 5 + 3 * z), len(points)
        points += [tuple(c + rnd.gauss(0, 0.1) for c in centre) for _ in range(3)]
        triangles.append((at, at + 1, at + 2))
    return points, triangles, wood


def forest(folder, _):
    rnd = random.Random(11)
    points, triangles, wood = tree(4000, rnd)
    write_mesh(f"{folder}/trunk", points[:3 * wood], triangles[:wood])
    write_mesh(f"{folder}/crown", points[3 * wood:], [tuple(v - 3 * wood for v in t) for t in triangles[wood:]])
    places = [(5.0 * i + rnd.uniform(-1.5, 1.5), 5.0 * j + rnd.uniform(-1.5, 1.5), rnd.uniform(0, 360), rnd.uniform(0.7, 1.2))
              for i in range(-10, 10) for j in range(-10, 10)]
    with open(f"{folder}/forest.csv", "w") as out:
        out.write("x,y,z,heading_deg,scale\n")
        out.writelines("%.9g,%.9g,0,%.9g,%.9g\n" % row for row in places)
    # A heading turns clockwise.
    trees = "".join(f'<shape type="instance"><ref id="tree"/>{turned_xml((s, s, s), [("z", -h)], (x, y, 0))}</shape>' for x, y, h, s in places)
    group = f'<shape type="shapegroup" id="tree">{ply("crown", leaf(0.4, 0.4))}{ply("trunk", diffuse(0.2))}</shape>'
    ground = f'<shape type="rectangle">{turned_xml((200, 200, 1))}{diffuse(0.25)}</shape>'
    return Scene("forest", (0, -70, 45), (0, 0, 3), 40, group + trees + ground,
                 "leaf: {model: lambert, reflectance: 0.4, transmittance: 0.4}, bark: {model: lambert, reflectance: 0.2}, "
                 "soil: {model: lambert, reflectance: 0.25}",
                 "crown: {obj: crown.obj, material: leaf}, trunk: {obj: trunk.obj, material: bark}, ground: {plane: {width: 400, depth: 400}, material: soil}",
                 ["{place: ground}", "{place: crown, table: forest.csv}", "{place: trunk, table: forest.csv}"], sun=3, sky=0.3)


def night(folder, _):
    """Four streets with 200 lamps between rows of houses with 80 lit windows; no other light."""
    rnd = random.Random(7)
    points, triangles, windows = [], [], []
    for row in range(3):
        for side in (-1, 1):
            x = -75.0
            while x < 70:
                w, h, y = rnd.uniform(8, 14), rnd.choice((6, 9, 12)), (row - 1) * 30 + side * 5
                corners = [(x + w * (k & 1), y - 4 + 8 * (k >> 1 & 1), h * (k >> 2)) for k in range(8)]
                at = len(points)
                points += corners
                for a, b, c, d in ((0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6), (4, 5, 7, 6)):
                    triangles += [(at + a, at + b, at + c), (at + a, at + c, at + d)]
                windows += [(x + rnd.uniform(1, w - 1), y + side * 4.02, 3 * floor + 1.5, side) for floor in range(h // 3)]
                x += w + rnd.uniform(1, 5)
    windows = rnd.sample(windows, 80)
    write_mesh(f"{folder}/houses", points, triangles)
    lamps = [(-72 + 6 * i + rnd.uniform(-1, 1), street + side, 7) for street in (-45, -15, 15, 45) for i in range(25) for side in (-2, 2)]
    panes = "".join(f'<shape type="rectangle">{turned_xml((0.6, 0.7, 1), [("x", -90 * side)], (x, y, z))}'
                    f'{diffuse(0.05)}<emitter type="area">{rgb("radiance", 1)}</emitter></shape>' for x, y, z, side in windows)
    points_xml = "".join(f'<emitter type="point"><point name="position" x="{x:.9g}" y="{y:.9g}" z="{z:.9g}"/>{rgb("intensity", 40)}</emitter>' for x, y, z in lamps)
    ground = f'<shape type="rectangle">{turned_xml((100, 100, 1))}{diffuse(0.15)}</shape>'
    return Scene("night", (0, -110, 60), (0, -5, 0), 50, ply("houses", diffuse(0.4)) + panes + points_xml + ground,
                 "wall: {model: lambert, reflectance: 0.4}, window: {model: lambert, reflectance: 0.05}, asphalt: {model: lambert, reflectance: 0.15}",
                 "houses: {obj: houses.obj, material: wall}, pane: {plane: {width: 1.2, depth: 1.4}, material: window}, "
                 "ground: {plane: {width: 200, depth: 200}, material: asphalt}",
                 ["{place: houses}", "{place: ground}"] +
                 ["{place: pane, rotate: {axis: [1, 0, 0], angle_deg: %d}, translate: [%.9g, %.9g, %.9g]}" % (-90 * side, x, y, z) for x, y, z, side in windows],
                 lamps="lamps:\n  - {kind: surface, name: windows, material: window, radiance: 1}\n  - {kind: point, name: street, intensity: 40, positions_m: [%s]}\n"
                       % ", ".join("[%.9g, %.9g, %.9g]" % p for p in lamps))


def cloud(folder, _):
    """A heap of 24 x 24 x 16 cells of droplets (albedo 1, asymmetry 0.8), vertical depth up to some 10, over matte ground."""
    n, rnd = (24, 24, 16), random.Random(3)
    balls = [(rnd.uniform(6, 18), rnd.uniform(6, 18), rnd.uniform(3, 8), rnd.uniform(3, 6)) for _ in range(14)]
    density = [max(0.0, *(1 - ((i + 0.5 - x) ** 2 + (j + 0.5 - y) ** 2 + (k + 0.5 - z) ** 2) / r ** 2 for x, y, z, r in balls))
               for k in range(n[2]) for j in range(n[1]) for i in range(n[0])]
    cell, extinction = 10.0, 0.12
    with open(f"{folder}/cloud.f32", "wb") as out:
        out.write(struct.pack(f"<{len(density)}f", *density))
    with open(f"{folder}/cloud.vol", "wb") as out:
        out.write(b"VOL\x03" + struct.pack("<5i6f", 1, *n, 1, 0, 0, 0, 1, 1, 1) + struct.pack(f"<{len(density)}f", *density))
    with open(f"{folder}/cloud.vox", "w") as out:
        out.write(f"voxels: 1\ncells: [{n[0]}, {n[1]}, {n[2]}]\ncell_m: {cell}\norigin_m: [{-cell * n[0] / 2}, {-cell * n[1] / 2}, 60]\n"
                  "fields: {density: {file: cloud.f32, type: float32}}\n")
    size, low = [cell * c for c in n], (-cell * n[0] / 2, -cell * n[1] / 2, 60)
    middle = [low[k] + size[k] / 2 for k in range(3)]
    medium = (f'<medium type="heterogeneous" name="interior"><volume type="gridvolume" name="sigma_t"><string name="filename" value="cloud.vol"/>'
              f'<string name="filter_type" value="nearest"/>{turned_xml(size, (), low)}</volume>{rgb("albedo", 1)}<float name="scale" value="{extinction}"/>'
              f'<phase type="hg"><float name="g" value="0.8"/></phase></medium>')
    box = f'<shape type="cube">{turned_xml([c / 2 for c in size], (), middle)}<bsdf type="null"/>{medium}</shape>'
    ground = f'<shape type="rectangle">{turned_xml((2000, 2000, 1))}{diffuse(0.2)}</shape>'
    return Scene("cloud", (0, -420, 260), (0, 0, 110), 40, box + ground, "soil: {model: lambert, reflectance: 0.2}",
                 "ground: {plane: {width: 4000, depth: 4000}, material: soil}", ["{place: ground}"], sun=3, sky=0.3, volumetric=True,
                 volumes=f"media: {{droplets: {{scattering: {extinction}, phase: {{model: hg, g: 0.8}}}}}}\ngrids: {{heap: {{voxels: cloud.vox, medium: droplets}}}}\n"
                         "volumes: [{place: heap}]\n")


SCENES = {f.__name__: f for f in (terrain, furnace, satin, chrome, spheres, forest, night, cloud)}
