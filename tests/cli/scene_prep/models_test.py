"""scene-prep on models by themselves and in scenes: the same triangles as assimp, an independent reader, and faults.

models_test.py BIN DATA WORK. Needs numpy and assimp's program (scripts/packages-test.txt). Lengths are
made 1000 times larger, so that the six decimals of --export-obj stand for nanometres; the bound of 5e-7 m is that of
the file's own metres.
"""
import json
import os
import re
import struct
import subprocess
import sys
import unittest
import zlib

try:
    import numpy as np
except ImportError:
    if os.path.realpath(sys.executable) == os.path.realpath("/usr/bin/python3"):
        raise
    os.execv("/usr/bin/python3", ["/usr/bin/python3", "-B"] + sys.argv)

BIN, DATA, WORK = (os.path.abspath(p) for p in sys.argv[1:4])
SCALE = 1000.0
BOUND = 5e-7


def prepare(model, *options):
    """Runs scene-prep; its exit code and all that it said."""
    done = subprocess.run([BIN + "/scene-prep", model, "-o", WORK + "/m.h5", "--force", *options],
                          capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def read_obj(path):
    """Triangles of an OBJ file, and the materials of each."""
    places, faces, materials, material = [], [], [], ""
    with open(path, encoding="utf-8") as f:
        for line in f:
            word = line.split()
            if word and word[0] == "v":
                places.append([float(w) for w in word[1:4]])
            elif word and word[0] == "usemtl":
                material = line.split(maxsplit=1)[1].strip()
            elif word and word[0] == "f":
                faces.append([int(w.split("/")[0]) - 1 for w in word[1:]])
                materials.append(material)
    return np.array(places)[np.array(faces)], materials


def exported():
    """Triangles of the scene that was prepared last, m of the file, and the materials of each."""
    subprocess.run([BIN + "/scene-prep", WORK + "/m.h5", "--export-obj", WORK + "/m.obj"], check=True)
    triangles, materials = read_obj(WORK + "/m.obj")
    return triangles / SCALE, materials


def by_assimp(path, y_up):
    """The same by assimp, its nodes flattened."""
    subprocess.run(["assimp", "export", path, WORK + "/assimp.obj", "-tri"], check=True, stdout=subprocess.DEVNULL)
    t, _ = read_obj(WORK + "/assimp.obj")
    return np.stack([t[..., 0], -t[..., 2], t[..., 1]], axis=-1) if y_up else t


def in_order(triangles):
    """Triangles, and the corners of each, in an order that does not depend on the reader."""
    grid = np.floor(triangles * 1e4 + 0.38196601)  # no corner of these files lies on its lines
    made = []
    for t, g in zip(triangles, grid):
        first = min(range(3), key=lambda k: tuple(tuple(g[(k + i) % 3]) for i in range(3)))
        turn = [(first + i) % 3 for i in range(3)]
        made.append((tuple(g[turn].ravel()), t[turn]))
    made.sort(key=lambda row: row[0])
    return np.array([t for _, t in made])


def apart(some, others):
    """How far the farthest triangle's centre is from the nearest of others."""
    a, b = some.mean(1), others.mean(1)
    return max(np.linalg.norm(b - p, axis=1).min() for p in a)


def area(triangles):
    return np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1).sum() / 2


def ply(kind, path, faces=((0, 1, 4), (0, 1, 2, 3))):
    """A PLY file of five places, a triangle and a concave polygon, which can be cut in one way only."""
    places = [(0, 0, 0), (2, 0, 0), (0.5, 0.5, 0), (0, 2.125, 0), (2, 2, 2)]
    head = (f"ply\nformat {kind} 1.0\ncomment a test\nelement vertex {len(places)}\nproperty double x\nproperty double y\n"
            f"property double z\nelement face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
    with open(path, "wb") as f:
        f.write(head.encode())
        if kind == "ascii":
            f.write("".join("%.12g %.12g %.12g\n" % p for p in places).encode())
            f.write("".join(f"{len(c)} {' '.join(map(str, c))}\n" for c in faces).encode())
        else:
            order = "<" if kind == "binary_little_endian" else ">"
            f.write(b"".join(struct.pack(order + "3d", *p) for p in places))
            f.write(b"".join(struct.pack(order + f"B{len(c)}i", len(c), *c) for c in faces))
    return path


def textured_box():
    """DATA's Box.glb with texture coordinates (its positions' x and y) and an image of one red texel."""
    with open(DATA + "/gltf/Box.glb", "rb") as f:
        data = f.read()
    length = struct.unpack("<I", data[12:16])[0]
    root = json.loads(data[20:20 + length])
    chunk = lambda kind, body: struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    png = (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 1, 1, 8, 2, 0, 0, 0))
           + chunk(b"IDAT", zlib.compress(b"\0\xff\0\0")) + chunk(b"IEND", b""))
    binary = data[28 + length:]
    binary += b"\0" * (-len(binary) % 4)
    count = root["accessors"][root["meshes"][0]["primitives"][0]["attributes"]["POSITION"]]["count"]
    root["bufferViews"] += [{"buffer": 0, "byteOffset": len(binary), "byteLength": 8 * count},
                            {"buffer": 0, "byteOffset": len(binary) + 8 * count, "byteLength": len(png)}]
    root["accessors"].append({"bufferView": len(root["bufferViews"]) - 2, "componentType": 5126, "count": count, "type": "VEC2"})
    root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = len(root["accessors"]) - 1
    root["images"] = [{"bufferView": len(root["bufferViews"]) - 1, "mimeType": "image/png"}]
    root["textures"] = [{"source": 0}]
    root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {"index": 0}
    binary += struct.pack("<2f", 0.25, 0.75) * count + png
    binary += b"\0" * (-len(binary) % 4)
    root["buffers"][0]["byteLength"] = len(binary)
    text = json.dumps(root).encode()
    text += b" " * (-len(text) % 4)
    path = WORK + "/textured.glb"
    with open(path, "wb") as f:
        f.write(b"glTF" + struct.pack("<II", 2, 28 + len(text) + len(binary)) + struct.pack("<I", len(text)) + b"JSON" + text
                + struct.pack("<I", len(binary)) + b"BIN\0" + binary)
    return path


# A triangle of one material.
COLLADA = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="common"><phong>EFFECT</phong></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m" name="red"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g" name="g"><mesh>
<source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
<accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor>
</technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1" material="s"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="w"><node id="n"><instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="s" target="#m"/></technique_common></bind_material></instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#w"/></scene>
</COLLADA>
"""


class Whole(int):
    """A number of 32 bits."""


def fbx(path, places, polygon, unit_cm, axes=None, nodes=((2, 0, {}),), shown=(2,)):
    """A binary FBX 7.4 of one polygon; its bytes. axes: up, front, right, each with its sign. nodes: id, parent and
    properties of each; shown: those that hold the polygon."""
    def property_70(key, value):
        if isinstance(value, tuple):
            return ("P", (key, key if key.startswith("Lcl") else "Vector3D", "", "A" if key.startswith("Lcl") else "", *map(float, value)))
        return ("P", (key, "enum", "", "", Whole(value)))

    def property_of(p):
        if isinstance(p, str):
            return b"S" + struct.pack("<I", len(p.encode())) + p.encode()
        if isinstance(p, list):
            kind, code = (b"d", "d") if isinstance(p[0], float) else (b"i", "i")
            data = struct.pack(f"<{len(p)}{code}", *p)
            return kind + struct.pack("<III", len(p), 0, len(data)) + data
        if isinstance(p, float):
            return b"D" + struct.pack("<d", p)
        if isinstance(p, Whole):
            return b"I" + struct.pack("<i", p)
        return b"I" + struct.pack("<i", p) if p > 9 else b"L" + struct.pack("<q", p)  # 0 to 9: ids

    def node(at, name, properties=(), children=()):
        data = b"".join(property_of(p) for p in properties)
        head = 13 + len(name)
        inner, where = b"", at + head + len(data)
        for child in children:
            inner += node(where + len(inner), *child)
        if children:
            inner += bytes(13)
        return struct.pack("<IIIB", where + len(inner), len(properties), len(data), len(name)) + name.encode() + data + inner

    name = "\x00\x01"
    names = ("UpAxis", "UpAxisSign", "FrontAxis", "FrontAxisSign", "CoordAxis", "CoordAxisSign")
    said = [("P", (key, "int", "Integer", "", Whole(value))) for key, value in zip(names, axes or ())]
    all_nodes = [
        ("FBXHeaderExtension", (), [("FBXVersion", (7400,))]),
        ("GlobalSettings", (), [("Properties70", (), [("P", ("UnitScaleFactor", "double", "Number", "", unit_cm))] + said)]),
        ("Objects", (), [("Geometry", (1, "tri" + name + "Geometry", "Mesh"),
                          [("Vertices", ([float(c) for p in places for c in p],)),
                           ("PolygonVertexIndex", (polygon[:-1] + [~polygon[-1]],))]),
                         *(("Model", (n, f"tri{n}" + name + "Model", "Mesh"),
                            [("Version", (232,)), ("Properties70", (), [property_70(*p) for p in more.items()])])
                           for n, _, more in nodes)]),
        ("Connections", (), [("C", ("OO", n, parent)) for n, parent, _ in nodes] + [("C", ("OO", 1, n)) for n in shown])]
    data = b"Kaydara FBX Binary  \x00\x1a\x00" + struct.pack("<I", 7400)
    for one in all_nodes:
        data += node(len(data), *one)
    data += bytes(13)
    with open(path, "wb") as f:
        f.write(data)
    return data


class Models(unittest.TestCase):
    def same(self, path, y_up, name, *options):
        code, said = prepare(path, "--set", f"objects.{name}.unit_m={SCALE:g}", *options)
        self.assertEqual(code, 0, said)
        ours, materials = exported()
        theirs = by_assimp(path, y_up)
        self.assertEqual(ours.shape, theirs.shape)
        worst = np.abs(in_order(ours) - in_order(theirs)).max()
        print(f"{os.path.basename(path)}: {len(ours)} triangles, farthest {worst:.2g} m")
        self.assertLess(worst, BOUND)
        moved = in_order(theirs + [0, 0, 2 * BOUND])  # and a test that could not fail would be none
        self.assertGreater(np.abs(in_order(ours) - moved).max(), BOUND)
        return said, materials

    def test_glb(self):
        said, materials = self.same(DATA + "/gltf/Box.glb", True, "Box")
        self.assertIn("material 'Red': a grey of reflectance 0.18 stands in", said)
        self.assertIn("SP708", said)
        self.assertEqual(set(materials), {"Red"})
        self.same(DATA + "/gltf/ShapeCollection.glb", True, "ShapeCollection")

    def test_fbx_and_collada(self):
        for kind, name in (("fbxa", "fa"), ("collada", "c")):
            path = f"{WORK}/{name}.{'dae' if kind == 'collada' else 'fbx'}"
            subprocess.run(["assimp", "export", DATA + "/gltf/ShapeCollection.glb", path, "-f" + kind], check=True,
                           stdout=subprocess.DEVNULL)
            if kind == "fbxa":  # z up, in inches: what its heading says is done
                with open(path, encoding="utf-8") as f:
                    text = f.read()
                turned = text.replace('P: "UpAxis", "int", "Integer", "", 1', 'P: "UpAxis", "int", "Integer", "", 2')
                turned = turned.replace('"UnitScaleFactor", "double", "Number", "", 1', '"UnitScaleFactor", "double", "Number", "", 2.54')
                self.assertNotEqual(text, turned)
                with open(path, "w", encoding="utf-8") as f:
                    f.write(turned)
            unit = {"fbxa": 100 / 2.54, "collada": 1}[kind]
            code, said = prepare(path, "--set", f"objects.{name}.unit_m={SCALE * unit!r}")
            self.assertEqual(code, 0, said)
            ours, theirs = exported()[0], by_assimp(DATA + "/gltf/ShapeCollection.glb", kind != "fbxa")
            self.assertEqual(len(ours), len(theirs))
            worst = max(apart(ours, theirs), apart(theirs, ours))
            print(f"{os.path.basename(path)}: {len(ours)} triangles, farthest {worst:.2g} m")
            self.assertLess(worst, 1e-5)  # texts have six digits
            self.assertGreater(apart(ours, theirs + [0, 0, 1e-3]), 1e-5)
            self.assertAlmostEqual(area(ours) / area(theirs), 1, delta=1e-5)

    def test_binary_fbx(self):
        places = [(0, 0, 0), (2, 0, 0), (2, 3, 0), (0, 3, 5)]
        whole = fbx(WORK + "/bin.fbx", places, [0, 1, 2, 3], 100.0)
        code, said = prepare(WORK + "/bin.fbx", "--set", f"objects.bin.unit_m={SCALE:g}")
        self.assertEqual(code, 0, said)
        ours = exported()[0]
        wanted = {(x, -z, y) for x, y, z in places}  # y up
        self.assertEqual({tuple(np.round(p, 6)) for p in ours.reshape(-1, 3)}, wanted)
        self.assertEqual(len(ours), 2)
        for bad in (whole[:200], whole[:27] + b"\xff" * 400, whole.replace(b"PolygonVertexIndex", b"PolygonVortexIndex")):
            with open(WORK + "/bad.fbx", "wb") as f:
                f.write(bad)
            code, said = prepare(WORK + "/bad.fbx")
            self.assertEqual(code, 1, said)
            self.assertIn("bad.fbx: error: ", said)

    def test_axes(self):
        """`up` stands in place of what a file says: with Collada it was applied on top of it, and models lay on their sides."""
        subprocess.run(["assimp", "export", DATA + "/gltf/Box.glb", WORK + "/axes.dae", "-fcollada"], check=True, stdout=subprocess.DEVNULL)
        with open(WORK + "/axes.dae", encoding="utf-8") as f:
            text = f.read()
        self.assertEqual(text.count("_UP</up_axis>"), 1)
        text = re.sub(r"(<float_array[^>]*>)([^<]*)", lambda m: m[1] + " ".join(repr(float(v) * (1 + 0.5 * (i % 3)))
                                                                              for i, v in enumerate(m[2].split())), text)

        def stands(up_axis, *options):
            with open(WORK + "/axes.dae", "w", encoding="utf-8") as f:
                f.write(re.sub("._UP", up_axis, text))
            code, said = prepare(WORK + "/axes.dae", *options)
            self.assertEqual(code, 0, said)
            places = exported()[0].reshape(-1, 3)
            return [round(float(v), 4) for v in places.max(0) - places.min(0)]
        y, z = stands("Y_UP"), stands("Z_UP")
        self.assertEqual(sorted(y), sorted(z))
        self.assertNotEqual(y, z)
        for up_axis in ("Y_UP", "Z_UP", "X_UP"):
            self.assertEqual(stands(up_axis, "--set", "objects.axes.up=y"), y)
            self.assertEqual(stands(up_axis, "--set", "objects.axes.up=z"), z)
        # FBX: a wall of 2 m x 3 m x 5 m with the axes that its heading names; it was taken for y up unless z was.
        places = [(0.0, 0, 0), (2.0, 3, 0), (0, 3.0, 5)]
        for axes, wanted in ((None, lambda x, y, z: (x, -z, y)), ((2, 1, 1, -1, 0, 1), lambda x, y, z: (x, y, z)),
                             ((0, 1, 2, 1, 1, -1), lambda x, y, z: (-y, -z, x)), ((2, 1, 0, -1, 1, -1), lambda x, y, z: (-y, x, z)),
                             ((1, -1, 2, 1, 0, -1), lambda x, y, z: (-x, -z, -y)), ((2, 1, 1, 1, 0, 1), lambda x, y, z: (x, -y, z)),
                             ((0, 1, 0, 1, 0, 1), lambda x, y, z: (-y, -z, x))):
            fbx(WORK + "/axes.fbx", places, [0, 1, 2], 100.0, axes)
            code, said = prepare(WORK + "/axes.fbx", "--set", f"objects.axes.unit_m={SCALE:g}")
            self.assertEqual(code, 0, said)
            self.assertEqual({tuple(np.round(p, 5) + 0.0) for p in exported()[0].reshape(-1, 3)},
                             {tuple(np.round(wanted(*p), 5) + 0.0) for p in places}, axes)
            self.assertEqual("left-handed" in said, axes == (2, 1, 1, 1, 0, 1), said)
            self.assertEqual("x is up" in said, axes == (0, 1, 0, 1, 0, 1), said)

    def test_what_fbx_does_with_places(self):
        """Autodesk's chain of transforms: pivots, rotations before and after, transforms of geometry alone, which children
        do not inherit (they did, and PostRotation was not undone); scales that are inherited otherwise are told."""
        places = np.array([(0.0, 0, 0), (2, 0, 0), (0, 3, 5)])

        def move(*t):
            return np.block([[np.eye(3), np.array(t).reshape(3, 1)], [np.zeros((1, 3)), np.ones((1, 1))]])

        def turn(*angles):  # about x first
            m = np.eye(4)
            for k, a in enumerate(np.radians(angles)):
                i, j, one = (k + 1) % 3, (k + 2) % 3, np.eye(4)
                one[i, i] = one[j, j] = np.cos(a)
                one[i, j], one[j, i] = -np.sin(a), np.sin(a)
                m = one @ m
            return m

        def size(*s):
            return np.diag([*s, 1.0])
        undo, t, r, s = np.linalg.inv, (10, 20, 30), (20, 40, 60), (1, 2, 3)
        own = {"Lcl Translation": t, "Lcl Rotation": r, "Lcl Scaling": s, "RotationActive": 1}
        pivots = {"RotationOffset": (4, 5, 6), "RotationPivot": (1, 2, 3), "PreRotation": (90, 0, 0), "PostRotation": (0, 30, 0),
                  "ScalingOffset": (1, 0, 2), "ScalingPivot": (7, 8, 9)}
        chain = (move(*t) @ move(4, 5, 6) @ move(1, 2, 3) @ turn(90, 0, 0) @ turn(*r) @ undo(turn(0, 30, 0)) @ undo(move(1, 2, 3))
                 @ move(1, 0, 2) @ move(7, 8, 9) @ size(*s) @ undo(move(7, 8, 9)))
        alone = {"GeometricTranslation": (1, 2, 3), "GeometricRotation": (0, 0, 90), "GeometricScaling": (2, 2, 2)}
        plain = {"Lcl Translation": (0, 0, 1), "InheritType": 1}
        geometry = move(1, 2, 3) @ turn(0, 0, 90) @ size(2, 2, 2)
        for nodes, wanted, told in (([(2, 0, own)], [move(*t) @ turn(*r) @ size(*s)], False), ([(2, 0, own | pivots)], [chain], False),
                                    ([(2, 0, own | pivots | alone), (3, 2, plain)], [chain @ geometry, chain @ move(0, 0, 1)], False),
                                    ([(2, 0, {"Lcl Scaling": (-1, 1, 1)})], [size(-1, 1, 1)], False),
                                    ([(2, 0, own), (3, 2, {"Lcl Rotation": (0, 0, 90), "InheritType": 1})],
                                     [move(*t) @ turn(*r) @ size(*s), move(*t) @ turn(*r) @ size(*s) @ turn(0, 0, 90)], False),
                                    ([(2, 0, own), (3, 2, {"Lcl Rotation": (0, 0, 90), "InheritType": 0})], None, True),
                                    ([(2, 0, own), (3, 2, {"InheritType": 2})], None, True),
                                    ([(2, 0, {"Lcl Scaling": (2, 2, 2)}), (3, 2, {"Lcl Rotation": (0, 0, 90)})],
                                     [size(2, 2, 2), size(2, 2, 2) @ turn(0, 0, 90)], False)):
            fbx(WORK + "/nodes.fbx", places.tolist(), [0, 1, 2], 100.0, (2, 1, 1, -1, 0, 1), nodes, [n for n, _, _ in nodes])
            code, said = prepare(WORK + "/nodes.fbx", "--set", f"objects.nodes.unit_m={SCALE:g}")
            self.assertEqual(code, 0, said)
            self.assertEqual("InheritType" in said, told, said)
            if wanted:
                there = np.concatenate([places @ m[:3, :3].T + m[:3, 3] for m in wanted])
                ours = exported()[0].reshape(-1, 3)
                self.assertEqual(len(ours), len(there))
                self.assertLess(max(np.linalg.norm(there - p, axis=1).min() for p in ours), 1e-4, nodes)
                self.assertLess(max(np.linalg.norm(ours - p, axis=1).min() for p in there), 1e-4, nodes)

    def test_more_models(self):
        for path in os.environ.get("SUITE_MORE_MODELS", "").split():
            name = os.path.splitext(os.path.basename(path))[0]
            self.same(path, True, name, "--set", f"objects.{name}.animation=none")

    def test_ply_and_stl(self):
        for kind in ("ascii", "binary_little_endian", "binary_big_endian"):
            self.same(ply(kind, f"{WORK}/{kind}.ply"), False, kind)
        with open(WORK + "/bin.stl", "wb") as f:
            f.write(b"solid but binary".ljust(80) + struct.pack("<I", 2))
            f.write(struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0))
            f.write(struct.pack("<12fH", 0, 0, 1, 1, 0, 0, 1, 1, 0.25, 0, 1, 0, 0))
        self.same(WORK + "/bin.stl", False, "bin")
        with open(WORK + "/text.stl", "w", encoding="utf-8") as f:
            f.write("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 1e-1\nendloop\nendfacet\n"
                    "endsolid a\n")
        self.same(WORK + "/text.stl", False, "text")

    def test_spectra(self):
        box = DATA + "/gltf/Box.glb"
        code, said = prepare(box, "--set", "materials.Red.reflectance=0.4")
        self.assertEqual(code, 0, said)
        self.assertNotIn("SP708", said)
        code, said = prepare(box, "--uplift")
        self.assertEqual(code, 0, said)
        self.assertIn("a spectrum is guessed from the display colour (0.800, 0.000, 0.000)", said)

    def test_textures(self):
        """A GLB with an image: its material is made of the texture, and the text says so."""
        made = subprocess.run([BIN + "/scene-prep", textured_box(), "--uplift", "--convert", WORK + "/uplifted"],
                              capture_output=True, text=True, check=False)
        self.assertEqual(made.returncode, 0, made.stderr)
        with open(WORK + "/uplifted/textured.yaml", encoding="utf-8") as f:
            self.assertIn("textures: {uplift: texel}", f.read())
        code, said = prepare(textured_box(), "--uplift")
        self.assertEqual(code, 0, said)
        self.assertIn("its texture is uplifted to spectra", said)
        self.assertIn("1 materials are matte with reflectances uplifted from display colours, 1 of them from textures", said)

    def test_looks_that_are_left_out(self):
        """What a material of Collada says beyond its colour is told in one line; a plain one is not told."""
        def said_of(effect):
            with open(WORK + "/look.dae", "w", encoding="utf-8") as f:
                f.write(COLLADA.replace("EFFECT", effect))
            code, said = prepare(WORK + "/look.dae")
            self.assertEqual(code, 0, said)
            return said
        plain = "<diffuse><color>0.8 0.1 0.1 1</color></diffuse>"
        said = said_of("<emission><color>1 0 0 1</color></emission>" + plain + "<transparency><float>0.5</float></transparency>")
        self.assertIn("left out of how surfaces look: transparency of 1 material (an 'opacity' map makes holes), "
                      "emission of 1 material (temperatures and lamps shine)", said)
        self.assertNotIn("left out of how surfaces look", said_of("<emission><color>0 0 0 1</color></emission>" + plain))

    def test_warnings_of_200_objects(self):
        """Each object has a triangle without area, one has three: told once, with the worst."""
        objects = ""
        for k in range(200):
            with open(f"{WORK}/part_{k}.obj", "w", encoding="utf-8") as f:
                f.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\n" + "f 1 2 4\n" * (3 if k == 123 else 1))
            objects += f"  part_{k}: {{obj: part_{k}.obj, material: paint}}\n"
        with open(WORK + "/parts.yaml", "w", encoding="utf-8") as f:
            f.write("scene: 1\nmaterials: {paint: {model: lambert, reflectance: 0.5}}\nobjects:\n" + objects + "world:\n"
                    + "".join(f"  - {{place: part_{k}, translate: [{3 * k}, 0, 0]}}\n" for k in range(200)))
        code, said = prepare(WORK + "/parts.yaml")
        self.assertEqual(code, 0, said)
        self.assertIn("200 files or objects: warning [SP302] x202: a triangle has no area", said)
        self.assertRegex(said, r"most, x3, in \S*part_123\.obj:")
        self.assertIn("hint: --repair drops it", said)
        self.assertLess(said.count("\n"), 40, said)

    def test_in_a_scene(self):
        with open(WORK + "/scene.yaml", "w", encoding="utf-8") as f:
            f.write("scene: 1\nmaterials: {paint: {model: lambert, reflectance: 0.5}}\n"
                    f"objects:\n  box: {{gltf: {DATA}/gltf/Box.glb, materials: {{Red: paint}}, unit_m: 1000}}\n"
                    "world:\n  - {place: box}\n  - {place: box, translate: [5000, 0, 0]}\n")
        code, said = prepare(WORK + "/scene.yaml")
        self.assertEqual(code, 0, said)
        ours, materials = exported()
        self.assertEqual((len(ours), set(materials)), (24, {"paint"}))
        one = by_assimp(DATA + "/gltf/Box.glb", True)
        both = np.concatenate([one, one + [5, 0, 0]])
        self.assertLess(np.abs(in_order(ours) - in_order(both)).max(), BOUND)

    def test_a_text_to_edit(self):
        code, said = prepare(DATA + "/gltf/Box.glb")
        done = subprocess.run([BIN + "/scene-prep", DATA + "/gltf/Box.glb", "--convert", WORK + "/made"],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        code, said = prepare(WORK + "/made/Box.yaml")
        self.assertEqual(code, 0, said)
        self.assertEqual(len(exported()[0]), 12)

    def test_faults_have_their_place(self):
        def said_of(name, content):
            with open(f"{WORK}/{name}", "wb") as f:
                f.write(content)
            code, said = prepare(f"{WORK}/{name}")
            self.assertEqual(code, 1, said)
            self.assertNotIn("SP001", said)  # the fault is the file's, not a text's
            return said

        def bytes_of(path):
            with open(path, "rb") as f:
                return f.read()

        good = bytes_of(ply("ascii", WORK + "/good.ply"))
        self.assertIn("bad.ply:16:1: vertex 7 of 5", said_of("bad.ply", good.replace(b"3 0 1 4", b"3 0 1 7")))
        self.assertIn("bad.ply:4:1: 'x' is no count", said_of("bad.ply", good.replace(b"vertex 5", b"vertex x")))
        self.assertIn("cannot be in", said_of("bad.ply", good.replace(b"vertex 5", b"vertex 4000000000")))
        self.assertIn("unknown type 'flaot'; did you mean 'float'?",
                      said_of("bad.ply", good.replace(b"double x", b"flaot x")))
        self.assertIn("bad.stl:3:1: 'outer' is expected, found 'inner'",
                      said_of("bad.stl", b"solid a\nfacet normal 0 0 1\ninner loop"))
        self.assertIn("bad.stl: byte 80: declares 16843009 facets", said_of("bad.stl", b"\x01" * 200))
        glb = bytes_of(DATA + "/gltf/Box.glb")
        self.assertIn("a chunk of", said_of("bad.glb", glb[:-40].replace(struct.pack("<I", len(glb)),
                                                                         struct.pack("<I", len(glb) - 40))))
        self.assertIn("bad.glb: error: accessors[0]: 99 values of 2 bytes",
                      said_of("bad.glb", glb.replace(b'"count":36', b'"count":99')))


if __name__ == "__main__":
    os.makedirs(WORK, exist_ok=True)
    unittest.main(argv=[sys.argv[0]], verbosity=2)
