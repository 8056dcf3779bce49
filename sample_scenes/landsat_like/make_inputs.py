#!/usr/bin/env python3
"""Writes patches.png and sim.yaml of a Landsat-like push-broom into a folder: make_inputs.py [FOLDER]

Nine bands in rows of their own, 3 mm apart in the focal plane, each of seven sub-chip assemblies that are staggered by
2 mm to either side and overlap their neighbours by four columns.
"""
import os
import random
import struct
import sys
import zlib

folder = sys.argv[1] if len(sys.argv) > 1 else "."
random.seed(11)

COLUMNS, ROWS = 500, 300
soft = [[random.random() for _ in range(COLUMNS)] for _ in range(ROWS)]
for _ in range(1):  # neighbours resemble each other, so that there is something to match between two pixels
    soft = [[sum(soft[(r + i) % ROWS][(c + j) % COLUMNS] for i in (-1, 0, 1) for j in (-1, 0, 1)) / 9 for c in range(COLUMNS)] for r in range(ROWS)]
low, high = min(map(min, soft)), max(map(max, soft))
raw = b""
for row in soft:
    values = [round(255 * (v - low) / (high - low)) for v in row]
    raw += b"\0" + bytes(b for v in values for b in (255 - v, v, 0))


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


with open(os.path.join(folder, "patches.png"), "wb") as out:
    out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", COLUMNS, ROWS, 8, 2, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))

BANDS = [("coastal", 0.443), ("blue", 0.482), ("green", 0.561), ("red", 0.655), ("nir", 0.865), ("swir1", 1.609), ("swir2", 2.201), ("pan", 0.59), ("cirrus", 1.373)]
CHIP, OVERLAP, PITCH_MM, STAGGER_MM, BAND_MM = 10, 4, 0.01, 2.0, 3.0
arrays = ""
for b, (name, um) in enumerate(BANDS):
    arrays += f"""      - name: {name}
        pitch_um: {1000 * PITCH_MM:g}
        readout: {{kind: line, line_rate_hz: 1500, lines_per_capture: 512}}
        paths: 8
        bands: [{{name: {name}, center_um: {um}, fwhm_um: 0.02}}]
        chips:
"""
    for c in range(7):
        ahead = (4 - b) * BAND_MM + (STAGGER_MM if c % 2 == 0 else -STAGGER_MM)
        arrays += f"          - {{columns: {CHIP}, offset_mm: [{(c - 3) * (CHIP - OVERLAP) * PITCH_MM:g}, {ahead:g}]}}\n"
with open(os.path.join(folder, "sim.yaml"), "w") as out:
    out.write(f"""# Lines of 5 m from 705 km: 10 um pixels behind 1.41 m, 7.5 km/s, 1500 lines a second. From 7 km south of the
# terrain to 7 km north of it: the outermost rows look 7 km ahead and behind.
scene: scene.h5
seed: 1
max_nodes: 1
sun: {{direction: {{zenith_deg: 40, azimuth_deg: 140}}}}
sensors:
  - kind: platform
    name: oli
    motion: {{kind: straight, position_m: [1000, -8900, 705000], heading_deg: 0, speed_m_s: 7500}}
    tasks: [{{name: pass, start: 0, stop: 2.28}}]
    truth: [location]
    instruments:
    - name: telescope
      focal_length_mm: 1410
      arrays:
{arrays}""")
