"""Cities, point clouds and voxels of plants through scene-prep, beside readers in Python that share nothing with it.

places_test.py BIN DATA WORK, as models_test.py, whose helpers are used. Areas of surfaces are those of their rings (shoelace, holes
taken off), places go from UTM to the scene by Krueger's series and the ellipsoid, heights of the ground are those of the triangles.
"""
import json
import math
import os
import struct
import unittest

from models_test import WORK, np, prepare, read_obj
import models_test

A, F = 6378137.0, 1 / 298.257223563


def geodetic_of_utm(zone, easting, northing):
    """Degrees. C. F. F. Karney, J. Geodesy 85, 2011, equation 36 to fourth order."""
    n = F / (2 - F)
    beta = [n / 2 - 2 * n**2 / 3 + 37 * n**3 / 96 - n**4 / 360, n**2 / 48 + n**3 / 15 - 437 * n**4 / 1440,
            17 * n**3 / 480 - 37 * n**4 / 840, 4397 * n**4 / 161280]
    radius = A / (1 + n) * (1 + n**2 / 4 + n**4 / 64) * 0.9996
    xi, eta = northing / radius, (easting - 500000) / radius
    x = xi - sum(b * math.sin(2 * (j + 1) * xi) * math.cosh(2 * (j + 1) * eta) for j, b in enumerate(beta))
    e = eta - sum(b * math.cos(2 * (j + 1) * xi) * math.sinh(2 * (j + 1) * eta) for j, b in enumerate(beta))
    tau1 = math.sin(x) / math.hypot(math.sinh(e), math.cos(x))
    ecc, tau = math.sqrt(F * (2 - F)), tau1
    for _ in range(8):
        sigma = math.sinh(ecc * math.atanh(ecc * tau / math.hypot(1, tau)))
        value = tau * math.hypot(1, sigma) - sigma * math.hypot(1, tau)
        tau += (tau1 - value) / math.hypot(1, value) * (1 + (1 - ecc**2) * tau**2) / ((1 - ecc**2) * math.hypot(1, tau))
    return math.degrees(math.atan(tau)), 6 * zone - 183 + math.degrees(math.atan2(math.sinh(e), math.cos(x)))


def ecef(latitude, longitude, height):
    p, l = math.radians(latitude), math.radians(longitude)
    e2 = F * (2 - F)
    radius = A / math.sqrt(1 - e2 * math.sin(p)**2)
    return np.array([(radius + height) * math.cos(p) * math.cos(l), (radius + height) * math.cos(p) * math.sin(l),
                     (radius * (1 - e2) + height) * math.sin(p)])


def enu_of_utm(zone, origin, place):
    """Scene ENU of (easting, northing, height) around such a place."""
    lat, lon = geodetic_of_utm(zone, origin[0], origin[1])
    p, l = math.radians(lat), math.radians(lon)
    axes = np.array([[-math.sin(l), math.cos(l), 0],
                     [-math.sin(p) * math.cos(l), -math.sin(p) * math.sin(l), math.cos(p)],
                     [math.cos(p) * math.cos(l), math.cos(p) * math.sin(l), math.sin(p)]])
    return axes @ (ecef(*geodetic_of_utm(zone, place[0], place[1]), place[2]) - ecef(lat, lon, origin[2]))


def area(ring):
    """Of a flat ring in space."""
    r = np.asarray(ring) - ring[0]
    return np.linalg.norm(sum(np.cross(r[k], r[k + 1]) for k in range(1, len(r) - 1))) / 2


class Town:
    """Prisms over polygons with courts, windows in their walls, at whole millimetres."""

    def __init__(self, system, base, seed):
        self.random, self.base, self.vertices, self.objects = np.random.default_rng(seed), base, [], {}
        self.system, self.areas, self.triangles = system, {}, 0
        for k in range(12):
            self.house(f"house-{k}", 60.0 * (k % 4), 60.0 * (k // 4))

    def index(self, p):
        self.vertices.append([round(1000 * c) for c in p])
        return len(self.vertices) - 1

    def surface(self, kind, rings, wanted):
        exact = [[np.array(self.vertices[i]) / 1000 for i in ring] for ring in rings]
        one = area(exact[0]) - sum(area(r) for r in exact[1:])
        assert abs(one - wanted) < 0.2 * wanted
        self.areas[kind] = self.areas.get(kind, 0) + one
        self.triangles += sum(len(r) for r in rings) + 2 * (len(rings) - 1) - 2
        return rings

    def house(self, name, x, y):
        n, height = int(self.random.integers(4, 9)), float(self.random.uniform(3, 20))
        angles = np.arange(n) * 2 * np.pi / n
        outer = [(x + 20 * np.cos(a), y + 20 * np.sin(a)) for a in angles]
        court = [(x + 6 * np.cos(a), y + 6 * np.sin(a)) for a in angles[::-1]]
        whole = n / 2 * math.sin(2 * math.pi / n) * (400 - 36)
        at = {(k, z): [self.index((*p, z * height)) for p in ring] for z in (0, 1) for k, ring in enumerate((outer, court))}
        roof = self.surface("RoofSurface", [at[0, 1], at[1, 1]], whole)
        floor = self.surface("GroundSurface", [at[0, 0][::-1], at[1, 0][::-1]], whole)
        shell, values = [roof, floor], [0, 1]
        for k, ring in ((0, outer), (1, court)):
            for i in range(n):
                j = (i + 1) % n
                p, q = np.array([*ring[i], 0]), np.array([*ring[j], 0])
                hole = [self.index(p + (q - p) * u + [0, 0, height * v]) for u, v in ((.3, .4), (.3, .7), (.6, .7), (.6, .4))]
                wall = [at[k, 0][i], at[k, 0][j], at[k, 1][j], at[k, 1][i]]
                shell.append(self.surface("WallSurface", [wall, hole], np.linalg.norm(q - p) * height * 0.91))
                values.append(2)
        self.objects[name] = {"type": "Building", "geometry": [{
            "type": "Solid", "lod": "2.2", "boundaries": [shell],
            "semantics": {"surfaces": [{"type": t} for t in ("RoofSurface", "GroundSurface", "WallSurface")], "values": [values]}}]}

    def write(self, path, sequence=False):
        head = {"type": "CityJSON", "version": "2.0", "transform": {"scale": [0.001] * 3, "translate": list(self.base)},
                "metadata": {"referenceSystem": self.system}, "CityObjects": {}, "vertices": []}
        with open(path, "w", encoding="utf-8") as f:
            if not sequence:
                json.dump(head | {"CityObjects": self.objects, "vertices": self.vertices}, f)
                return path
            f.write(json.dumps(head) + "\n")
            for name, thing in self.objects.items():
                f.write(json.dumps({"type": "CityJSONFeature", "id": name, "CityObjects": {name: thing},
                                    "vertices": self.vertices}) + "\n")
        return path


def exported():
    models_test.subprocess.run([models_test.BIN + "/scene-prep", WORK + "/m.h5", "--export-obj", WORK + "/m.obj"], check=True)
    return read_obj(WORK + "/m.obj")


def areas_of(triangles, materials):
    sums = {}
    for t, m in zip(triangles, materials):
        sums[m] = sums.get(m, 0) + np.linalg.norm(np.cross(t[1] - t[0], t[2] - t[0])) / 2
    return sums


class Cities(unittest.TestCase):
    def check(self, town, path, *options):
        code, said = prepare(path, "--no-crossing-check", *options)
        self.assertEqual(code, 0, said)
        triangles, materials = exported()
        self.assertEqual(len(triangles), town.triangles)
        for kind, one in areas_of(triangles, materials).items():
            self.assertAlmostEqual(one / town.areas[kind], 1, delta=2e-3 if town.base[0] > 1e5 else 1e-6)
        self.assertEqual(set(materials), set(town.areas))
        return said, triangles

    def test_on_the_earth(self):
        base = (648213.0, 5412345.0, 310.0)
        town = Town("urn:ogc:def:crs:EPSG::25832", base, 1)
        for sequence in (False, True):
            path = town.write(WORK + ("/town.city.jsonl" if sequence else "/town.city.json"), sequence)
            said, triangles = self.check(town, path)
            self.assertIn("heights are taken as above the ellipsoid", said)
            places = np.array(town.vertices) / 1000 + base
            origin = [*(places.min(0)[:2] + places.max(0)[:2]) / 2, places[:, 2].min()]
            wanted = np.array([enu_of_utm(32, origin, p) for p in places])
            got = np.unique(np.round(triangles.reshape(-1, 3), 3), axis=0)
            far = max(np.linalg.norm(got - w, axis=1).min() for w in wanted)
            print(f"{os.path.basename(path)}: farthest corner {far:.2g} m from Krueger's series")
            self.assertLess(far, 2e-3)  # the millimetres that corners are rounded to here
            shifted = max(np.linalg.norm(got - w - [0, 0, 0.01], axis=1).min() for w in wanted)
            self.assertGreater(shifted, 2e-3)

    def test_on_a_flat_map(self):
        town = Town("https://www.opengis.net/def/crs/EPSG/0/7415", (85000.0, 446000.0, 0.0), 2)
        said, triangles = self.check(town, town.write(WORK + "/flat.city.json"))
        self.assertIn("is not known here: its map is taken as flat", said)
        wanted = np.array(town.vertices) / 1000
        middle = (wanted.min(0) + wanted.max(0)) / 2
        got = triangles.reshape(-1, 3) + [middle[0], middle[1], wanted[:, 2].min()]
        far = max(np.linalg.norm(got - w, axis=1).min() for w in wanted)
        self.assertLess(far, 1e-3)

    def test_materials_and_faults_in_a_scene(self):
        town = Town("EPSG:25832", (648213.0, 5412345.0, 310.0), 3)
        town.write(WORK + "/scene.city.json")
        head = ("scene: 1\nmaterials: {tiles: {model: lambert, reflectance: 0.3}, plaster: {model: lambert, reflectance: 0.6}}\n")
        def scene(origin, keys):
            with open(WORK + "/city.yaml", "w", encoding="utf-8") as f:
                f.write(head + origin + "objects: {town: {city: scene.city.json, material: plaster, materials: {RoofSurface: tiles, "
                        "WallSurface: plaster, GroundSurface: plaster}" + keys + "}}\nworld: [{place: town}]\n")
            return prepare(WORK + "/city.yaml", "--no-crossing-check")
        origin = "origin: {latitude_deg: 48.85, longitude_deg: 11.02, height_m: 350}\n"
        code, said = scene(origin, ", height: ellipsoid")
        self.assertEqual(code, 0, said)
        self.assertEqual(set(exported()[1]), {"tiles", "plaster"})
        code, said = scene("", ", height: ellipsoid")
        self.assertIn("what is on a map needs the scene's 'origin'", said)
        code, said = scene(origin, ", height: geoid")
        self.assertEqual(code, 1)
        self.assertIn("heights above the geoid need to know how high that is", said)
        code, said = scene(origin.replace("350", "350, geoid: egm96-5.pgm"), ", height: geoid")
        self.assertEqual(code, 1)
        self.assertIn("egm96-5.pgm (19 MB) and others are had from", said)
        code, said = scene(origin, ", height: ellipsoid")
        low = exported()[0][..., 2].min()
        geoid(WORK + "/made.pgm", 45)
        for begin, raised in ((origin.replace("350", "350, geoid: made.pgm"), 45),
                              (origin.replace("350", "350, geoid: made.pgm, height: geoid"), 0)):
            code, said = scene(begin, ", height: geoid")
            self.assertEqual(code, 0, said)
            self.assertAlmostEqual(exported()[0][..., 2].min() - low, raised, delta=5e-3)
        code, said = scene(origin, ", epsg: 999999")
        self.assertIn("EPSG:999999 is not known here, and PROJ ", said)


def geoid(path, height):
    """A grid of GeographicLib's, 30 degrees wide, of one height."""
    head = ("P5\n# Description made for a test\n# DateTime 2024-01-01 00:00:00\n# Offset -108\n# Scale 0.003\n# MaxBilinearError 1\n"
            "# RMSBilinearError 1\n# MaxCubicError 1\n# RMSCubicError 1\n12 7\n65535\n")
    with open(path, "wb") as f:
        f.write(head.encode() + struct.pack(">H", round((height + 108) / 0.003)) * 84)


def las(path, points, kinds):
    """LAS 1.2, point format 0, in centimetres."""
    head = struct.pack("<4sHHIHH8sBB32s32sHHHIIBHI5I3d3d6d", b"LASF", 0, 0, 0, 0, 0, b"", 1, 2, b"", b"", 1, 2024, 227, 227, 0, 0, 20,
                       len(points), 0, 0, 0, 0, 0, 0.01, 0.01, 0.01, 1000, 2000, 0, 0, 0, 0, 0, 0, 0)
    with open(path, "wb") as f:
        f.write(head)
        for p, kind in zip(points, kinds):
            whole = np.rint((np.asarray(p) - (1000, 2000, 0)) * 100).astype(int)
            f.write(struct.pack("<iiiHBBbBH", *(int(c) for c in whole), 0, 0x09, kind, 0, 0, 0))


def geotiff(path, rows, keys=(), kind=(3, 32, "f")):
    """Heights in UTM 33N, pixels of 10 m whose middle one is at (500000, 5000000). kind: sample format, bits, struct's letter."""
    data = b"".join(struct.pack("<" + kind[2], v) for row in rows for v in row)
    flat = [k for key in [(1024, 0, 1, 1), (1025, 0, 1, 1), (3072, 0, 1, 32633), *keys] for k in key]
    west, north = 500000 - 5 * len(rows[0]), 5000000 + 5 * len(rows)
    blobs = {33550: ("d", (10, 10, 0)), 33922: ("d", (0, 0, 0, west, north, 0)), 34735: ("H", (1, 1, 0, len(flat) // 4, *flat))}
    tags = {256: len(rows[0]), 257: len(rows), 258: kind[1], 259: 1, 262: 1, 273: 8, 277: 1, 278: len(rows), 279: len(data),
            339: kind[0]}
    body, entries = data + b"\0" * (-len(data) % 8), []
    for tag in sorted([*tags, *blobs]):
        if tag in tags:
            entries.append(struct.pack("<HHII", tag, 4, 1, tags[tag]))
        else:
            letter, values = blobs[tag]
            entries.append(struct.pack("<HHII", tag, 12 if letter == "d" else 3, len(values), 8 + len(body)))
            body += struct.pack("<%d%s" % (len(values), letter), *values)
            body += b"\0" * (-len(body) % 8)
    with open(path, "wb") as f:
        f.write(b"II*\0" + struct.pack("<I", 8 + len(body)) + body + struct.pack("<H", len(entries)) + b"".join(entries) + bytes(4))


class Terrains(unittest.TestCase):
    ROWS = [[100 + 10 * c + 20 * r for c in range(3)] for r in range(3)]

    def heights(self, more="", **how):
        geotiff(WORK + "/dem.tif", how.pop("rows", self.ROWS), **how)
        latitude, longitude = geodetic_of_utm(33, 500000, 5000000)
        with open(WORK + "/dem.yaml", "w", encoding="utf-8") as f:
            f.write(f"scene: 1\norigin: {{latitude_deg: {latitude}, longitude_deg: {longitude}, height_m: 0}}\nmaterials: {{soil: "
                    "{model: lambert, reflectance: 0.2}}\nobjects: {ground: {terrain: dem.tif, height: ellipsoid, material: soil"
                    f"{more}}}}}\nworld: [{{place: ground}}]\n")
        code, said = prepare(WORK + "/dem.yaml")
        return code, said, exported()[0].reshape(-1, 3) if code == 0 else None

    def test_pixels_of_any_type(self):
        for kind in ((3, 32, "f"), (3, 64, "d"), (2, 16, "h"), (1, 16, "H"), (1, 8, "B"), (2, 32, "i"), (1, 32, "I")):
            code, said, places = self.heights(kind=kind)
            self.assertEqual(code, 0, said)
            for x, y, height in ((0, 0, 120 + 10), (10, 10, 120), (-10, -10, 140)):
                near = places[np.argmin(np.hypot(places[:, 0] - x, places[:, 1] - y))]
                self.assertAlmostEqual(near[2], height, delta=1e-3)

    def test_heights_in_feet_are_not_metres(self):
        for key, metres in (((4099, 0, 1, 9002), 0.3048), ((4099, 0, 1, 9003), 1200 / 3937), ((4096, 0, 1, 6360), 1200 / 3937)):
            code, said, _ = self.heights(keys=[key])
            self.assertEqual(code, 1)
            self.assertIn(f"its heights are in feet of {metres:.7g} m; 'height_scale: {metres:.7g}'", said)
            code, said, places = self.heights(f", height_scale: {metres:.7g}", keys=[key])
            self.assertEqual(code, 0, said)
            self.assertAlmostEqual(max(places[:, 2]), 160 * metres, delta=1e-3)
        self.assertEqual(self.heights(keys=[(4099, 0, 1, 9001), (4096, 0, 1, 5703)])[0], 0)

    def test_marks_of_gaps_are_told(self):
        rows = [[-9999, 110, 120], *self.ROWS[1:]]
        code, said, _ = self.heights(rows=rows)
        self.assertEqual(code, 0)
        self.assertIn("[SP506]", said)
        self.assertIn("1 pixels have the height -9999", said)
        code, said, places = self.heights(", no_data: -9999", rows=rows)
        self.assertEqual(code, 0)
        self.assertNotIn("[SP506]", said)
        self.assertGreater(min(places[:, 2]), 100)


class Clouds(unittest.TestCase):
    def test_ground_within_the_error(self):
        random = np.random.default_rng(4)
        xy = random.uniform(0, 80, (4000, 2)) + (1000, 2000)
        ground = np.column_stack([xy, 4 * np.sin(xy[:, 0] / 12) + 2 * np.cos(xy[:, 1] / 9)])
        ground = np.rint(ground * 100) / 100
        canopy = ground + [0, 0, 12]
        las(WORK + "/stand.las", np.concatenate([ground, canopy]), [2] * len(ground) + [5] * len(canopy))
        with open(WORK + "/stand.yaml", "w", encoding="utf-8") as f:
            f.write("scene: 1\nmaterials: {soil: {model: lambert, reflectance: 0.2}}\nmedia: {foliage: {leaves: {reflectance: 0.45, "
                    "transmittance: 0.4}}}\ngrids: {canopy: {voxels: stand.las, cell_m: 4, density: leaf_area, medium: foliage, local: "
                    "[1000, 2000, 0]}}\nvolumes: [{place: canopy}]\nobjects: {ground: {points: stand.las, material: soil, error_m: 0.2, "
                    "local: [1000, 2000, 0]}}\nworld: [{place: ground}]\n")
        code, said = prepare(WORK + "/stand.yaml", "--no-crossing-check")
        self.assertEqual(code, 0, said)
        self.assertIn("leaf area by contact frequency", said)
        triangles, _ = exported()
        worst, seen = 0, 0
        a, e1, e2 = triangles[:, 0], triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
        twice = e1[:, 0] * e2[:, 1] - e1[:, 1] * e2[:, 0]
        for p in ground - (1000, 2000, 0):
            d = p - a
            u, v = (d[:, 0] * e2[:, 1] - d[:, 1] * e2[:, 0]) / twice, (e1[:, 0] * d[:, 1] - e1[:, 1] * d[:, 0]) / twice
            inside = np.flatnonzero((u > -1e-4) & (v > -1e-4) & (u + v < 1 + 1e-4))
            seen += len(inside) > 0
            worst = max([worst] + [abs(d[k, 2] - u[k] * e1[k, 2] - v[k] * e2[k, 2]) for k in inside[:1]])
        print(f"{len(triangles)} triangles for {len(ground)} points, farthest {worst:.3f} m")
        self.assertGreaterEqual(seen, len(ground) - 2)
        self.assertLess(worst, 0.2 + 0.01)
        self.assertGreater(worst, 0.1)
        self.assertLess(len(triangles), 4000)

    def test_voxels_of_amapvox(self):
        with open(WORK + "/crown.vox", "w", encoding="utf-8") as f:
            f.write("VOXEL SPACE\n#min_corner: 0 0 0\n#max_corner: 2 2 2\n#split: 2 2 2\ni j k PadBVTotal\n"
                    + "".join(f"{i} {j} {k} {0.5 * (i + j + k)}\n" for i in (0, 1) for j in (0, 1) for k in (0, 1)))
        with open(WORK + "/crown.yaml", "w", encoding="utf-8") as f:
            f.write("scene: 1\nmaterials: {soil: {model: lambert, reflectance: 0.2}}\nmedia: {foliage: {leaves: {reflectance: 0.45, "
                    "transmittance: 0.4}}}\ngrids: {crown: {voxels: crown.vox, medium: foliage}}\nvolumes: [{place: crown}]\n"
                    "objects: {ground: {plane: {width: 10, depth: 10}, material: soil}}\nworld: [{place: ground}]\n")
        code, said = prepare(WORK + "/crown.yaml")
        self.assertEqual(code, 0, said)
        code, said = prepare(WORK + "/crown.yaml", "--set", "media.foliage.leaves.reflectance=0.7")
        self.assertEqual(code, 1)
        self.assertIn("leaves that reflect and transmit 1.1 in all", said)


class Helios(unittest.TestCase):
    def test_turned_scaled_moved(self):
        corners = np.array([(1.0, 2, 3), (4, 2, 0), (0, 5, 1)])
        with open(WORK + "/leaf.obj", "w", encoding="utf-8") as f:
            f.write("".join("v %g %g %g\n" % tuple(c) for c in corners) + "f 1 2 3\n")
        with open(WORK + "/plot.xml", "w", encoding="utf-8") as f:
            f.write('<document><scene id="plot" name="plot">\n<part id="a"><filter type="objloader"><param type="string" key="filepath" '
                    'value="leaf.obj"/></filter>\n<filter type="translate"><param type="vec3" key="offset" value="10;-5;2"/></filter>\n'
                    '<filter type="rotate"><param type="rotation" key="rotation"><rot axis="z" angle_deg="30"/><rot axis="pitch" '
                    'angle_deg="10"/></param></filter>\n<filter type="scale"><param type="double" key="scale" value="2"/></filter></part>\n'
                    '<part id="b"><filter type="objloader"><param type="string" key="filepath" value="leaf.obj"/></filter></part>\n'
                    '</scene></document>\n')
        code, said = prepare(WORK + "/plot.xml")
        self.assertEqual(code, 0, said)
        self.assertIn("plot.xml", said)
        c, s = math.cos(math.radians(30)), math.sin(math.radians(30))
        p, q = math.cos(math.radians(10)), math.sin(math.radians(10))
        turn = np.array([[1, 0, 0], [0, p, -q], [0, q, p]]) @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        wanted = np.concatenate([2 * corners @ turn.T + (10, -5, 2), corners])
        self.assertLess(np.abs(exported()[0].reshape(-1, 3) - wanted).max(), 2e-6)

    def test_on_the_ground(self):
        """A slope z = x/2 whose material is ground; a leaf whose corners are 2.5, 0.5 and 2 m above it, moved by -0.5 m."""
        with open(WORK + "/slope.mtl", "w", encoding="utf-8") as f:
            f.write("newmtl soil\nhelios_isGround true\n")
        with open(WORK + "/slope.obj", "w", encoding="utf-8") as f:
            f.write("mtllib slope.mtl\nv 0 0 0\nv 20 0 10\nv 20 20 10\nv 0 20 0\nusemtl soil\nf 1 2 3 4\n")
        corners = np.array([(1.0, 2, 3), (5, 2, 3), (2, 5, 3)])
        with open(WORK + "/leaf.obj", "w", encoding="utf-8") as f:
            f.write("".join("v %g %g %g\n" % tuple(c) for c in corners) + "f 1 2 3\n")
        with open(WORK + "/plot.xml", "w", encoding="utf-8") as f:
            f.write('<document><scene id="plot">\n<part id="b"><filter type="objloader"><param key="filepath" value="leaf.obj"/></filter>\n'
                    '<filter type="translate"><param key="offset" value="0;0;0"/><param key="onGround" value="-1"/></filter></part>\n'
                    '<part id="earth"><filter type="objloader"><param key="filepath" value="slope.obj"/></filter></part></scene></document>\n')
        code, said = prepare(WORK + "/plot.xml")
        self.assertEqual(code, 0, said)
        self.assertIn("'onGround': moved by -0.500 m onto the plane through the ground 'earth'", said)
        self.assertLess(np.abs(exported()[0].reshape(-1, 3)[:3] - corners + (0, 0, 0.5)).max(), 2e-6)


class Leaves(unittest.TestCase):
    """A layer of leaves of AMAPVox, rendered: what comes through black ones, and what stays of an even light in ones that lose nothing."""

    def render(self, leaf, light, paths):
        with open(WORK + "/slab.vox", "w", encoding="utf-8") as f:
            f.write("VOXEL SPACE\n#min_corner: -5000 -5000 0\n#max_corner: 5000 5000 2\n#split: 1 1 2\ni j k PadBVTotal\n0 0 0 1.5\n0 0 1 0.5\n")
        with open(WORK + "/slab.yaml", "w", encoding="utf-8") as f:
            f.write("scene: 1\nmaterials: {white: {model: lambert, reflectance: 1}}\nmedia: {foliage: {leaves: {reflectance: %g, "
                    "transmittance: %g}}}\ngrids: {slab: {voxels: slab.vox, medium: foliage}}\nvolumes: [{place: slab}]\nobjects: {ground: "
                    "{plane: {width: 0, depth: 0}, material: white}}\nworld: [{place: ground, translate: [0, 0, -0.01]}]\n" % leaf)
        with open(WORK + "/level.txt", "w", encoding="utf-8") as f:
            f.write("0.3 1\n2.5 1\n")
        with open(WORK + "/sim.yaml", "w", encoding="utf-8") as f:
            f.write("scene: m.h5\nseed: 1\nmax_nodes: 1000\n" + light + "sensors:\n  - {kind: orthographic, name: map, columns: 8, rows: 8, gsd_m: 1, "
                    "center_m: [0, 0], bands: [{name: nir, center_um: 0.8, fwhm_um: 0.02}], paths: %d}\n" % paths)
        code, said = prepare(WORK + "/slab.yaml")
        self.assertEqual(code, 0, said)
        done = models_test.subprocess.run([models_test.BIN + "/dirsig-render", WORK + "/sim.yaml", "-o", WORK + "/out"], capture_output=True,
                                          text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        seen = np.fromfile(WORK + "/out/map.img", dtype="<f4")
        return seen.mean(), seen.std() / 8

    def test_black_leaves(self):
        sun = "sun: {direction: {zenith_deg: 60, azimuth_deg: 140}, irradiance: level.txt}\n"
        mean, _ = self.render((0, 0), sun, 64)
        # Half of the area of leaves of index 2 lies in the way straight down, twice that on the way of the sun.
        wanted = 0.5 / math.pi * math.exp(-0.5 * 2 * (1 + 2))
        self.assertAlmostEqual(mean / wanted, 1, delta=2e-4)

    def test_nothing_is_lost(self):
        for leaf in ((0.5, 0.5), (0.9, 0.1)):
            mean, error = self.render(leaf, "sky: {radiance: level.txt}\n", 1024)
            print(f"leaves that reflect {leaf[0]} and transmit {leaf[1]}: {mean:.5f} +- {error:.5f} of an even light of 1")
            self.assertLess(error, 2e-3)
            self.assertLess(abs(mean - 1), 4 * error + 2e-4)


if __name__ == "__main__":
    os.makedirs(WORK, exist_ok=True)
    unittest.main(argv=["places_test.py"], verbosity=2)
