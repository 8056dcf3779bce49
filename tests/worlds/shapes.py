"""Meshes and voxels as texts: what the exact surfaces have as partners."""
import math


def obj(vertices, faces):
    return "".join(f"v {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in vertices) + "".join("f " + " ".join(str(i + 1) for i in f) + "\n" for f in faces)


def box_mesh(x0, y0, z0, x1, y1, z1):
    v = [(x, y, z) for z in (z0, z1) for y in (y0, y1) for x in (x0, x1)]
    return obj(v, [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)])


def quad_mesh(width, depth, across=1):
    """A level rectangle that faces up, of across x across pairs of triangles."""
    n = across + 1
    v = [(width * (i / across - 0.5), depth * (j / across - 0.5), 0) for j in range(n) for i in range(n)]
    faces = []
    for j in range(across):
        for i in range(across):
            a = j * n + i
            faces += [(a, a + 1, a + n + 1), (a, a + n + 1, a + n)]
    return obj(v, faces)


def ball_mesh(radius, splits=1):
    """An icosahedron whose edges are halved so often, on the sphere."""
    p = (1 + math.sqrt(5)) / 2
    v = [(-1, p, 0), (1, p, 0), (-1, -p, 0), (1, -p, 0), (0, -1, p), (0, 1, p), (0, -1, -p), (0, 1, -p), (p, 0, -1), (p, 0, 1), (-p, 0, -1), (-p, 0, 1)]
    f = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8),
         (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]

    def onto(x):
        scale = radius / math.sqrt(sum(c * c for c in x))
        return tuple(c * scale for c in x)

    v = [onto(x) for x in v]
    for _ in range(splits):
        middle, faces = {}, []

        def between(a, b):
            key = (min(a, b), max(a, b))
            if key not in middle:
                middle[key] = len(v)
                v.append(onto(tuple((s + t) / 2 for s, t in zip(v[a], v[b]))))
            return middle[key]

        for a, b, c in f:
            x, y, z = between(a, b), between(b, c), between(c, a)
            faces += [(a, x, z), (b, y, x), (c, z, y), (x, y, z)]
        f = faces
    return obj(v, f)


def voxels(cells, cell_m, fields):
    """A .vox text about the origin."""
    origin = [-n * cell_m / 2 for n in cells]
    lines = "\n".join(f"  {name}: {{values: {values}}}" if isinstance(values, list) else f"  {name}: {values}" for name, values in fields.items())
    return f"voxels: 1\ncells: {list(cells)}\ncell_m: {cell_m}\norigin_m: {origin}\nfields:\n{lines}\n".encode()
