"""The valley's ground: heights from the shipped elevation raster, a carved river and lake, level ground under the town, and a map of what
covers it. Positions are metres east and north of the bend of the river; heights are metres above its water."""
import math
import struct
import zlib

STEP = 10.0                                        # of the heights, m
WEST, SOUTH, EAST, NORTH = -3750.0, -1250.0, 1170.0, 1690.0  # of the ground, m: the whole raster but its rim
NEAR = (-1000.0, -700.0, 1000.0, 900.0)            # what is planted and built on
WATER_M = 106.0                                    # of the raster's heights: the river's surface
RIVER = [(-4000, -330), (-1500, -250), (-1000, -150), (-625, -50), (-125, 0), (125, 12), (375, 50), (550, 100), (700, 175), (950, 200), (1400, 290)]
RIVER_HALF, RIVER_DEPTH = 38.0, 3.5
LAKE, LAKE_RADIUS, LAKE_DEPTH = (-800.0, -420.0), 110.0, 6.0
BANK = 120.0                                       # m beside the water that lie at least 3 m above it
TOWN = (-520.0, -340.0, 280.0, -70.0)              # level ground, and its height
TOWN_M = 6.0

MEADOW, FOREST, WHEAT, MAIZE, SOIL, ROAD, PAVING, BED, ROCK, PASTURE = range(1, 11)
NAMES = {MEADOW: "meadow", FOREST: "forest_floor", WHEAT: "wheat", MAIZE: "maize", SOIL: "soil", ROAD: "asphalt", PAVING: "paving",
         BED: "bed", ROCK: "rock", PASTURE: "pasture"}
PIXEL = 1.0                                        # of the map, m
STREETS_Y = [-100.0, -190.0, -280.0]               # of the town: east to west
STREETS_X = [-460.0, -330.0, -200.0, -70.0, 60.0, 190.0]
BRIDGE_X = -200.0
COUNTRY_ROADS = [[(-520, -190), (-700, -230), (-1000, -300), (-1600, -420), (-3700, -700)], [(280, -100), (420, -60), (600, 10), (760, 85), (1160, 120)],
                 [(-200, 75), (-170, 100), (60, 95), (330, 130), (520, 185), (690, 260), (1160, 330)], [(-200, 75), (-500, 60), (-1000, -40), (-3700, -150)]]


def read_raster(path):
    """Rows of an uncompressed single-band float32 TIFF."""
    data = open(path, "rb").read()
    end = "<" if data[:2] == b"II" else ">"
    (ifd,) = struct.unpack(end + "I", data[4:8])
    (count,) = struct.unpack(end + "H", data[ifd:ifd + 2])
    tags = {}
    for k in range(count):
        tag, kind, n, value = struct.unpack(end + "HHI4s", data[ifd + 2 + 12 * k:ifd + 14 + 12 * k])
        size, code = {3: (2, "H"), 4: (4, "I")}.get(kind, (0, ""))
        if size:
            at = value if size * n <= 4 else data[struct.unpack(end + "I", value)[0]:]
            tags[tag] = struct.unpack(end + code * n, at[:size * n])
    if tags[259][0] != 1 or tags[258][0] != 32:
        raise ValueError(path + ": an uncompressed float32 raster is expected")
    width, height = tags[256][0], tags[257][0]
    raw = b"".join(data[o:o + n] for o, n in zip(tags[273], tags[279]))
    values = struct.unpack(end + "f" * (width * height), raw[:4 * width * height])
    return [list(values[r * width:(r + 1) * width]) for r in range(height)]


def smoothed(rows, times):
    """Binomial smoothing: the raster saw houses and trees, which stand here again."""
    for _ in range(times):
        rows = [[(r[max(i - 1, 0)] + 2 * r[i] + r[min(i + 1, len(r) - 1)]) / 4 for i in range(len(r))] for r in rows]
        rows = [[(a + 2 * b + c) / 4 for a, b, c in zip(rows[max(j - 1, 0)], rows[j], rows[min(j + 1, len(rows) - 1)])] for j in range(len(rows))]
    return rows


def distance_to_line(points, x, y, farthest=math.inf):
    """Of a place; those beyond `farthest` may be told as infinite."""
    best = math.inf
    for (ax, ay), (bx, by) in zip(points, points[1:]):
        if y < min(ay, by) - farthest or y > max(ay, by) + farthest or x < min(ax, bx) - farthest or x > max(ax, bx) + farthest:
            continue
        dx, dy = bx - ax, by - ay
        t = min(1.0, max(0.0, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy)))
        best = min(best, (x - ax - t * dx) ** 2 + (y - ay - t * dy) ** 2)
    return math.sqrt(best)


def ramp(t):
    t = min(1.0, max(0.0, t))
    return t * t * (3 - 2 * t)


class Ground:
    def __init__(self, raster):
        # The bend lies in column 150, row 68 of a raster of 25 m; the grid's north is taken as north (0.2 degrees off).
        raw = smoothed(read_raster(raster), 3)
        self.columns, self.rows = int((EAST - WEST) / STEP) + 1, int((NORTH - SOUTH) / STEP) + 1
        self.heights = []
        for j in range(self.rows):
            y = NORTH - j * STEP
            fr = min(max(68 - y / 25, 0), len(raw) - 1.001)
            r, v = int(fr), fr % 1
            row = []
            for i in range(self.columns):
                x = WEST + i * STEP
                fc = min(max(150 + x / 25, 0), len(raw[0]) - 1.001)
                c, u = int(fc), fc % 1
                h = ((raw[r][c] * (1 - u) + raw[r][c + 1] * u) * (1 - v) + (raw[r + 1][c] * (1 - u) + raw[r + 1][c + 1] * u) * v) - WATER_M
                row.append(self._shaped(x, y, h))
            self.heights.append(row)

    @staticmethod
    def _shaped(x, y, h):
        x0, y0, x1, y1 = TOWN
        out = math.hypot(max(x0 - x, x - x1, 0), max(y0 - y, y - y1, 0))
        h = TOWN_M + (max(h, 3.0) - TOWN_M) * ramp(out / 120)
        for d, half, depth in ((distance_to_line(RIVER, x, y, RIVER_HALF + BANK), RIVER_HALF, RIVER_DEPTH),
                               (math.hypot(x - LAKE[0], y - LAKE[1]), LAKE_RADIUS, LAKE_DEPTH)):
            if d < half:
                h = -depth * (1 - (d / half) ** 2)
            elif d < half + BANK:
                h = max(h, 3.0) * ramp((d - half) / 30) if d < half + 30 else max(h, 3.0)
        return h

    def at(self, x, y):
        fc = min(max((x - WEST) / STEP, 0), self.columns - 1.001)
        fr = min(max((NORTH - y) / STEP, 0), self.rows - 1.001)
        c, r, u, v = int(fc), int(fr), fc % 1, fr % 1
        a, b = self.heights[r], self.heights[r + 1]
        return (a[c] * (1 - u) + a[c + 1] * u) * (1 - v) + (b[c] * (1 - u) + b[c + 1] * u) * v

    def slope(self, x, y):
        return math.hypot(self.at(x + 10, y) - self.at(x - 10, y), self.at(x, y + 10) - self.at(x, y - 10)) / 20

    def write(self, path):
        with open(path + ".hdr", "w") as out:
            out.write("ENVI\nsamples = %d\nlines = %d\nbands = 1\nheader offset = 0\ndata type = 4\ninterleave = bsq\nbyte order = 0\n" % (self.columns, self.rows))
        with open(path, "wb") as out:
            for row in self.heights:
                out.write(struct.pack("<%df" % len(row), *row))


def noise(x, y):
    """Smooth value noise from 0 to 1 on a unit lattice."""
    def corner(i, j):
        h = (i * 374761393 + j * 668265263) & 0xFFFFFFFF
        h = ((h ^ (h >> 13)) * 1274126177) & 0xFFFFFFFF
        return ((h ^ (h >> 16)) & 0xFFFF) / 65535.0
    i, j = math.floor(x), math.floor(y)
    u, v = x - i, y - j
    u, v = u * u * (3 - 2 * u), v * v * (3 - 2 * v)
    return (corner(i, j) * (1 - u) + corner(i + 1, j) * u) * (1 - v) + (corner(i, j + 1) * (1 - u) + corner(i + 1, j + 1) * u) * v


class Cover:
    """What covers the ground, in pixels of PIXEL metres, rows from the north."""

    def __init__(self, ground):
        self.columns, self.rows = int((EAST - WEST) / PIXEL), int((NORTH - SOUTH) / PIXEL)
        self.map = []
        for j in range(int((NORTH - SOUTH) / STEP)):
            y = NORTH - (j + 0.5) * STEP
            kinds = [self._kind(ground, WEST + (i + 0.5) * STEP, y) for i in range(int((EAST - WEST) / STEP))]
            row = b"".join(bytes([k]) * int(STEP / PIXEL) for k in kinds)
            self.map += [bytearray(row) for _ in range(int(STEP / PIXEL))]
        for x0, x1, kind, y0, y1 in self._parcels():
            self._paint(x0, y0, x1, y1, kind, over=(MEADOW,))
        for line in COUNTRY_ROADS:
            self._stroke(line, 3.25, ROAD)
        x0, y0, x1, y1 = TOWN
        for y in STREETS_Y:
            self._paint(x0, y - 6.5, x1, y + 6.5, PAVING)
        for x in STREETS_X:
            self._paint(x - 6.5, STREETS_Y[-1], x + 6.5, STREETS_Y[0], PAVING)
        for y in STREETS_Y:
            self._paint(x0, y - 4, x1, y + 4, ROAD)
        for x in STREETS_X:
            self._paint(x - 4, STREETS_Y[-1], x + 4, STREETS_Y[0], ROAD)
        self._paint(BRIDGE_X - 4, STREETS_Y[0], BRIDGE_X + 4, -50, ROAD)
        self._paint(BRIDGE_X - 4, 45, BRIDGE_X + 4, 80, ROAD)

    @staticmethod
    def _kind(ground, x, y):
        h = ground.at(x, y)
        if h < 0.6:
            return BED
        x0, y0, x1, y1 = TOWN
        if x0 - 30 < x < x1 + 30 and y0 - 30 < y < y1 + 30:
            return MEADOW
        s = ground.slope(x, y)
        if s > 0.9:
            return ROCK
        if s > 0.16 and h > 8 or noise(x / 140, y / 140) > 0.8:
            return FOREST
        return MEADOW

    @staticmethod
    def _parcels():
        """Fields of the plain in the west and of the shelf in the south-east."""
        kinds = (WHEAT, MAIZE, SOIL, PASTURE)
        out = []
        for j in range(-1250, 1600, 150):
            for i in range(-3750, 1100, 230):
                if noise(i * 0.37, j * 0.73) > 0.35 and not (TOWN[0] - 60 < i + 115 < TOWN[2] + 60 and TOWN[1] - 60 < j + 75 < TOWN[3] + 90):
                    out.append((i + 4, i + 226, kinds[int(noise(i * 1.7, j * 2.3) * 3.99)], j + 4, j + 146))
        return out

    def _paint(self, x0, y0, x1, y1, kind, over=None):
        i0, i1 = max(0, round((x0 - WEST) / PIXEL)), max(0, min(self.columns, round((x1 - WEST) / PIXEL)))
        painted = bytes(kind if over is None or k in over else k for k in range(256))
        for j in range(max(0, round((NORTH - y1) / PIXEL)), min(self.rows, round((NORTH - y0) / PIXEL))):
            row = self.map[j]
            row[i0:i1] = row[i0:i1].translate(painted)

    def _stroke(self, line, half, kind):
        for (ax, ay), (bx, by) in zip(line, line[1:]):
            n = int(math.hypot(bx - ax, by - ay) / (PIXEL / 2)) + 1
            for k in range(n + 1):
                x, y = ax + (bx - ax) * k / n, ay + (by - ay) * k / n
                j = int((NORTH - y) / PIXEL)
                for dj in range(-int(half / PIXEL) - 1, int(half / PIXEL) + 2):
                    w = half * half - ((dj * PIXEL) ** 2)
                    if w > 0 and 0 <= j + dj < self.rows:
                        w = math.sqrt(w)
                        i0, i1 = max(0, int((x - w - WEST) / PIXEL)), min(self.columns, int((x + w - WEST) / PIXEL) + 1)
                        if i0 < i1:
                            self.map[j + dj][i0:i1] = bytes([kind]) * (i1 - i0)

    def at(self, x, y):
        return self.map[int((NORTH - y) / PIXEL)][int((x - WEST) / PIXEL)]

    def write(self, path):
        write_png(path, self.map)


TUFT, TUFTS = 0.5, 512                             # pixel (m) and pixels of the pasture's texture, which repeats
DRILL, DRILLS, ROW_PIXELS = 0.25, 384, 3           # those of the maize, whose rows run north and stand 0.75 m apart


def periodic_noise(pixels, cells):
    """Rows of noise that repeats after so many cells, over a square of pixels."""
    lattice = [[noise(float(i), float(j)) for i in range(cells)] for j in range(cells)]
    places = []
    for k in range(pixels):
        x = k * cells / pixels
        i = math.floor(x)
        places.append((i % cells, (i + 1) % cells, (x - i) * (x - i) * (3 - 2 * (x - i))))
    rows = []
    for j, below, v in places:
        a, b = lattice[j], lattice[below]
        rows.append([(a[i] * (1 - u) + a[right] * u) * (1 - v) + (b[i] * (1 - u) + b[right] * u) * v for i, right, u in places])
    return rows


def octaves(pixels, *cells):
    """Rows of a texture that repeats, 0 to 1: noise of so many cells across, each half as strong as the one before."""
    share = [0.5 ** k for k in range(len(cells))]
    layers = [periodic_noise(pixels, n) for n in cells]
    return [[sum(w * v for w, v in zip(share, values)) / sum(share) for values in zip(*rows)] for rows in zip(*layers)]


def write_tufts(path):
    """Dense and thin grass: what picks one of the measured curves at each place."""
    write_png(path, [bytes(round(255 * v) for v in row) for row in octaves(TUFTS, 16, 64, 256)])


def write_rows(path):
    """Shares of leaves and soil in rows of maize, as an ENVI image of two bands: leaves close over the row, more where it grows well."""
    leaves = [[min(1.0, (0.55 + 0.45 * v) * (1.0 if i % ROW_PIXELS == 1 else 0.75)) for i, v in enumerate(row)] for row in octaves(DRILLS, 12, 96)]
    with open(path + ".hdr", "w") as out:
        out.write("ENVI\nsamples = %d\nlines = %d\nbands = 2\nheader offset = 0\ndata type = 1\ninterleave = bsq\nbyte order = 0\n" % (DRILLS, DRILLS))
    with open(path, "wb") as out:
        for soil in (False, True):
            for row in leaves:
                out.write(bytes(round(255 * (1 - v if soil else v)) for v in row))


def write_png(path, rows):
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    with open(path, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 0, 0, 0, 0)))
        out.write(chunk(b"IDAT", zlib.compress(b"".join(b"\0" + bytes(r) for r in rows), 6)) + chunk(b"IEND", b""))
