"""Trees grown after Weber & Penn 1995 (Creation and Rendering of Realistic Trees): a stem, two orders of branches whose lengths follow the
crown's shape, turned by 140 degrees from one to the next, and leaves on the last."""
import math
import random


def _unit(v):
    n = math.sqrt(sum(c * c for c in v))
    return [c / n for c in v]


def _cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def _frame(axis):
    u = _unit(_cross(axis, [0, 0, 1] if abs(axis[2]) < 0.9 else [1, 0, 0]))
    return u, _cross(axis, u)


def _shape(kind, ratio):
    """Length of branches over the height of the crown; ratio 1 at its foot (Weber & Penn's ShapeRatio)."""
    return {"conical": 0.12 + 0.88 * ratio, "spherical": 0.2 + 0.8 * math.sin(math.pi * ratio),
            "tapered": 0.5 + 0.5 * math.sin(math.pi * min(1, ratio * 1.1))}[kind]


class Mesh:
    def __init__(self):
        self.points, self.faces = [], {}

    def add(self, material, polygons):
        faces = self.faces.setdefault(material, [])
        for polygon in polygons:
            first = len(self.points) + 1
            self.points += polygon
            faces.append(range(first, first + len(polygon)))

    def tube(self, material, path, sides):
        """path: (point, radius) of the axis."""
        rings = []
        for k, (p, r) in enumerate(path):
            ahead, behind = path[min(k + 1, len(path) - 1)][0], path[max(k - 1, 0)][0]
            u, v = _frame(_unit([a - b for a, b in zip(ahead, behind)]))
            first = len(self.points) + 1
            for s in range(sides):
                c, w = math.cos(2 * math.pi * s / sides) * r, math.sin(2 * math.pi * s / sides) * r
                self.points.append([p[i] + c * u[i] + w * v[i] for i in range(3)])
            rings.append(first)
        faces = self.faces.setdefault(material, [])
        for a, b in zip(rings, rings[1:]):
            for s in range(sides):
                t = (s + 1) % sides
                faces.append((a + s, a + t, b + t, b + s))

    def write(self, path):
        with open(path, "w") as out:
            out.writelines("v %.3f %.3f %.3f\n" % tuple(p) for p in self.points)
            for material, faces in self.faces.items():
                out.write("usemtl %s\n" % material)
                out.writelines("f " + " ".join(map(str, f)) + "\n" for f in faces)


KINDS = {  # height, crown's foot (share), branches, their length (share of height), down angle, shape, twigs, leaves a twig, leaf (m)
    "beech": dict(height=17, foot=0.22, branches=46, length=0.34, down=62, shape="spherical", twigs=9, leaves=17, leaf=(0.26, 0.17), needles=False),
    "oak": dict(height=14, foot=0.25, branches=40, length=0.42, down=70, shape="tapered", twigs=10, leaves=17, leaf=(0.24, 0.16), needles=False),
    "spruce": dict(height=21, foot=0.08, branches=92, length=0.21, down=98, shape="conical", twigs=8, leaves=9, leaf=(0.5, 0.1), needles=True)}


def grow(kind, seed):
    k, rnd, mesh = KINDS[kind], random.Random(seed), Mesh()
    height = k["height"]
    stem = [([0.25 * math.sin(0.9 * t + seed) * t * (not k["needles"]), 0.25 * math.cos(1.3 * t) * t * (not k["needles"]), height * t * 0.97 - 0.3],
             height * 0.016 * (1 - 0.93 * t) * (1 + 0.5 * max(0, 0.08 - t) / 0.08)) for t in [s / 8 for s in range(9)]]
    mesh.tube("bark", stem, 7)
    leaf = k["needles"] and "needle" or "leaf"
    turn = rnd.uniform(0, 360)
    for b in range(k["branches"]):
        t = k["foot"] + (0.97 - k["foot"]) * (b + rnd.random()) / k["branches"]
        turn += 140 + rnd.uniform(-20, 20)
        ratio = (1 - t) / (1 - k["foot"])
        length = height * k["length"] * _shape(k["shape"], ratio) * rnd.uniform(0.85, 1.1)
        _branch(mesh, k, leaf, rnd, _along(stem, t), math.radians(turn), math.radians(k["down"] - (0 if k["needles"] else 28 * t) + rnd.uniform(-8, 8)), length)
    return mesh


def _along(stem, t):
    f = t * (len(stem) - 1)
    i = min(int(f), len(stem) - 2)
    return [a + (b - a) * (f - i) for a, b in zip(stem[i][0], stem[i + 1][0])]


def _branch(mesh, k, leaf, rnd, start, turn, down, length):
    d = [math.sin(down) * math.cos(turn), math.sin(down) * math.sin(turn), math.cos(down)]
    curve = 0.12 if k["needles"] else 0.22
    path = [([start[i] + d[i] * length * s + (curve * length * s * s if i == 2 else 0) for i in range(3)], 0.012 * length * (1 - 0.85 * s) + 0.004)
            for s in (0, 0.5, 1)]
    mesh.tube("bark", path, 4)
    u, v = _frame(d)
    for w in range(k["twigs"]):
        s = 0.25 + 0.75 * (w + rnd.random()) / k["twigs"]
        a = math.radians(140 * w + rnd.uniform(-30, 30)) if not k["needles"] else (0 if w % 2 else math.pi) + rnd.uniform(-0.35, 0.35)
        across = [math.cos(a) * u[i] + math.sin(a) * v[i] for i in range(3)] if not k["needles"] else _level(d, a)
        e = _unit([0.6 * d[i] + 0.8 * across[i] for i in range(3)])
        root = _along(path, s)
        reach = length * (0.32 if k["needles"] else 0.42) * (1.15 - s)  + 0.15
        tip = [root[i] + e[i] * reach for i in range(3)]
        mesh.tube("bark", [(root, 0.006), (tip, 0.003)], 3)
        mesh.add(leaf, [_leaf(k, rnd, root, e, reach * (n + rnd.random()) / k["leaves"] * 1.1, n) for n in range(k["leaves"])])


def _level(d, a):
    side = _unit([-d[1], d[0], 0])
    return [side[0] * math.cos(a), side[1] * math.cos(a), math.sin(a) * 0.3]


def _leaf(k, rnd, root, e, at, n):
    length, width = k["leaf"]
    if k["needles"]:  # a flat spray of needles along the twig
        u = _unit([-e[1] + rnd.uniform(-0.3, 0.3), e[0] + rnd.uniform(-0.3, 0.3), rnd.uniform(-0.5, 0.5)])
        f = _unit([e[i] + u[i] * (0.8 if n % 2 else -0.8) for i in range(3)])
    else:
        z, a = rnd.uniform(-0.4, 0.9), rnd.uniform(0, 2 * math.pi)
        f = _unit([math.cos(a), math.sin(a), -0.25])
        u = _unit(_cross(_unit([0.7 * math.cos(a + 1), 0.7 * math.sin(a + 1), z + 0.2]), f))
    p = [root[i] + e[i] * at for i in range(3)]
    mid = [p[i] + f[i] * length / 2 for i in range(3)]
    return [p, [mid[i] + u[i] * width / 2 for i in range(3)], [p[i] + f[i] * length for i in range(3)], [mid[i] - u[i] * width / 2 for i in range(3)]]
