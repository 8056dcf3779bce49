"""Houses with roofs, windows and chimneys, blocks round a courtyard, cars, the bridge, masts and solar panels, as meshes."""
from trees import Mesh


def box(x0, y0, z0, x1, y1, z1, bottom=False):
    c = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    faces = [[(*c[i], z0), (*c[(i + 1) % 4], z0), (*c[(i + 1) % 4], z1), (*c[i], z1)] for i in range(4)]
    faces.append([(x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)])
    if bottom:
        faces.append([(x0, y1, z0), (x1, y1, z0), (x1, y0, z0), (x0, y0, z0)])
    return faces


def windows(x0, x1, y, z_top, face):
    """Panes 2 cm before a wall along x at y that faces +y or -y."""
    out, floors, n = [], int((z_top - 0.4) / 2.8), max(1, int((x1 - x0) / 2.6))
    off = y + 0.02 * face
    for f in range(floors):
        for k in range(n):
            x = x0 + (x1 - x0) * (k + 0.5) / n
            a, b, z = x - 0.55 * face, x + 0.55 * face, 0.9 + 2.8 * f
            out.append([(b, off, z), (a, off, z), (a, off, z + 1.35), (b, off, z + 1.35)])
    return out


def turned(polygons):
    """By a quarter turn about z."""
    return [[(-p[1], p[0], p[2]) for p in polygon] for polygon in polygons]


def gabled(mesh, x, y, eaves, ridge):
    """A house of 2x by 2y, ridge along x."""
    over, top = 0.45, eaves - 0.03
    corners = [(-x, -y), (x, -y), (x, y), (-x, y)]
    walls = [[(*corners[i], -1), (*corners[(i + 1) % 4], -1), (*corners[(i + 1) % 4], top), (*corners[i], top)] for i in range(4)]
    walls += [[(x, -y, top), (x, y, top), (x, 0, ridge - 0.03)], [(-x, y, top), (-x, -y, top), (-x, 0, ridge - 0.03)]]
    drop = over * (ridge - eaves) / y
    mesh.add("wall", walls)
    mesh.add("tile", [[(-x - over, -y - over, eaves - drop), (x + over, -y - over, eaves - drop), (x + over, 0, ridge), (-x - over, 0, ridge)],
                      [(x + over, y + over, eaves - drop), (-x - over, y + over, eaves - drop), (-x - over, 0, ridge), (x + over, 0, ridge)]])
    panes = windows(-x, x, -y, eaves, -1) + windows(-x, x, y, eaves, 1)
    ends = turned(windows(-y, y, -x, eaves, -1) + windows(-y, y, x, eaves, 1))
    mesh.add("pane", panes + ends)
    mesh.add("brick", box(0.4 * x - 0.35, 0.35 * y - 0.3, eaves, 0.4 * x + 0.35, 0.35 * y + 0.3, ridge + 0.7))


def house(x, y, eaves, ridge):
    mesh = Mesh()
    gabled(mesh, x, y, eaves, ridge)
    return mesh


def panels(x, y, eaves, ridge):
    """Solar panels 12 cm over the southern half of that house's roof."""
    mesh, slope = Mesh(), (ridge - eaves) / y
    for k in range(3):
        x0 = -0.75 * x + k * 0.5 * x
        x1, y0, y1 = x0 + 0.46 * x, -0.8 * y, -0.25 * y
        mesh.add("solar", [[(x0, y0, eaves + slope * (y + y0) + 0.12), (x1, y0, eaves + slope * (y + y0) + 0.12),
                            (x1, y1, eaves + slope * (y + y1) + 0.12), (x0, y1, eaves + slope * (y + y1) + 0.12)]])
    return mesh


def courtyard(half, wing, height):
    """Four wings with flat roofs round a court."""
    mesh, inner = Mesh(), half - wing
    for x0, y0, x1, y1 in ((-half, -half, half, -inner), (-half, inner, half, half), (-half, -inner, -inner, inner), (inner, -inner, half, inner)):
        faces = box(x0, y0, -1, x1, y1, height)
        mesh.add("wall", faces[:4])
        mesh.add("gravel", faces[4:])
    outside = windows(-half, half, -half, height, -1) + windows(-half, half, half, height, 1)
    court = windows(-inner, inner, -inner, height, 1) + windows(-inner, inner, inner, height, -1)
    mesh.add("pane", outside + court + turned(outside) + turned(court))
    mesh.add("brick", box(half - 2.5, half - 2.5, height, half - 1.7, half - 1.7, height + 1.5))
    return mesh


def car():
    """From the middle of the front bumper backwards, heading north."""
    mesh = Mesh()
    mesh.add("paint", box(-0.9, -4.4, 0.35, 0.9, 0, 0.85, True))
    low, high = [(-0.85, -3.7), (0.85, -3.7), (0.85, -1.0), (-0.85, -1.0)], [(-0.7, -3.2), (0.7, -3.2), (0.7, -1.9), (-0.7, -1.9)]
    mesh.add("pane", [[(*low[i], 0.85), (*low[(i + 1) % 4], 0.85), (*high[(i + 1) % 4], 1.4), (*high[i], 1.4)] for i in range(4)])
    mesh.add("paint", [[(*p, 1.4) for p in high]])
    for x in (-0.8, 0.62):
        for y in (-3.8, -1.3):
            mesh.add("dark", box(x, y, 0.01, x + 0.18, y + 0.62, 0.6))
    return mesh


def bridge(length, deck):
    mesh, n = Mesh(), 5
    mesh.add("paving", box(-5.5, -length / 2, deck - 0.8, 5.5, length / 2, deck - 0.02, True))
    mesh.add("asphalt", [[(-4, -length / 2, deck), (4, -length / 2, deck), (4, length / 2, deck), (-4, length / 2, deck)]])
    for side in (-5.5, 5.2):
        mesh.add("paving", box(side, -length / 2, deck, side + 0.3, length / 2, deck + 1))
    for k in range(1, n):
        y = -length / 2 + k * length / n
        mesh.add("paving", box(-5, y - 1.2, -5, 5, y + 1.2, deck - 0.8))
    return mesh


def mast():
    mesh = Mesh()
    mesh.tube("steel", [([0, 0, -1], 0.35), ([0, 0, 24], 0.12)], 6)
    for z in (16.0, 20.0):
        mesh.add("steel", box(-4, -0.1, z, 4, 0.1, z + 0.2, True))
    return mesh


def wires(span, sag):
    """Six wires between two masts at y = 0 and y = span, level."""
    mesh = Mesh()
    for x in (-3.8, 3.8):
        for z in (15.9, 19.9, 23.5):
            xx = x if z < 23 else 0.02 * x
            mesh.tube("steel", [([xx, span * s / 8, z - 4 * sag * (s / 8) * (1 - s / 8)], 0.025) for s in range(9)], 3)
    return mesh
