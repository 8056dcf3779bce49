"""What the tests of the package share: folders, a small scene, and readers that know nothing of the package."""
import os
import struct
import tempfile
import unittest
import zlib
from pathlib import Path

import remote_scenes as rs

ROOT = Path(os.environ["SUITE_SOURCE"])
BANDS = [rs.Band("red", 0.65, 0.03), rs.Band("nir", 0.85, 0.04), rs.Band("green", 0.55, 0.03)]
_TYPES = {1: "B", 2: "h", 3: "i", 4: "f", 5: "d", 12: "H", 13: "I", 14: "q", 15: "Q"}


class Case(unittest.TestCase):
    """A test with a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)


def lawn_with_things():
    """A lawn with an origin, two cars and a ring (which has a hole)."""
    scene = rs.Scene("lawn", origin=rs.Origin(49.4, 8.7, 120))
    scene.add("lawn", rs.plane(), material=rs.Material("lambert", reflectance=0.2))
    scene.add("car", rs.box([-1, -2, 0], [1, 2, 1.5]), material=rs.Material("lambert", reflectance=0.6), tag="car",
              translate=[5, 5, 0])
    scene.world.append(rs.Placement("car", translate=[-6, 3, 0], rotate={"heading_deg": 30}, tag="car"))
    scene.add("ring", rs.disk(3, inner_radius=1.5), material=rs.Material("lambert", reflectance=0.9), tag="ring, big",
              translate=[0, -5, 0.1])
    return scene


def by_day(prepared, sensors, **more):
    """A sun by date and a clear sky."""
    return rs.Simulation(prepared, sensors, sun=rs.Sun(time_utc="2026-06-21T10:30:00Z"), sky=rs.Sky("clear"), **more)


def envi_values(path):
    """Every number of an image as [band][line][sample] by struct alone, and the keys of its header."""
    keys, text = {}, Path(str(path) + ".hdr").read_text()
    while "=" in text:
        key, _, text = text.partition("=")
        text = text.lstrip()
        value, _, text = text[1:].partition("}") if text.startswith("{") else text.partition("\n")
        keys[key.split("\n")[-1].strip()] = value.strip()
    samples, lines, bands = (int(keys[k]) for k in ("samples", "lines", "bands"))
    order = "<>"[int(keys["byte order"])]
    raw = Path(path).read_bytes()[int(keys.get("header offset", 0)):]
    flat = struct.unpack(f"{order}{samples * lines * bands}{_TYPES[int(keys['data type'])]}", raw)
    place = {"bsq": lambda b, l, s: (b * lines + l) * samples + s, "bil": lambda b, l, s: (l * bands + b) * samples + s,
             "bip": lambda b, l, s: (l * samples + s) * bands + b}[keys["interleave"]]
    return [[[flat[place(b, l, s)] for s in range(samples)] for l in range(lines)] for b in range(bands)], keys


def png_pixels(path):
    """Rows of bytes of a PNG whose rows are not filtered, its width and channels."""
    data = Path(path).read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed, header = 8, b"", b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        assert zlib.crc32(kind + body) == struct.unpack(">I", data[at + 8 + size:at + 12 + size])[0]
        header, packed = (body, packed) if kind == b"IHDR" else (header, packed + body if kind == b"IDAT" else packed)
        at += 12 + size
    width, height, depth, colour = struct.unpack(">IIBB", header[:10])
    channels = {0: 1, 2: 3}[colour]
    assert depth == 8
    rows, stride = zlib.decompress(packed), 1 + width * channels
    assert len(rows) == height * stride and not any(rows[::stride])
    return [rows[r * stride + 1:(r + 1) * stride] for r in range(height)], width, channels
