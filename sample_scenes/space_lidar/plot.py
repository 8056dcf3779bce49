#!/usr/bin/env python3
"""Draws photons along the track and one waveform beside them: plot.py OUT PULSE PICTURE.svg

OUT is the folder of the run; PULSE that of its CSV. Heights are those over the scene's origin."""
import csv
import math
import struct
import sys
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lidar_survey"))
from cloud import points_of  # noqa: E402

ORBIT_M, ORIGIN_M, SOUTH_M, TRACK_M = 410000.0, 100.0, -700.0, 1400.0  # of sim.yaml and scene.yaml
PANELS = [(310, 430, 40, 250), (-30, 50, 290, 560)]  # heights (m) and pixels of the cloud and of the forest
LEFT, RIGHT, WAVE = 60, 640, (670, 950)
INK = 'font-family="sans-serif" font-size="13" fill="#222"'


def photons(path):
    """-> (m along the track, height over the origin, whether it is the laser's) of each count; the latter is the extra byte `signal`, the truth."""
    points, raw = list(points_of(path)), Path(path).read_bytes()
    at, size = struct.unpack_from("<I", raw, 96)[0], struct.unpack_from("<H", raw, 105)[0]
    south = min(p[1] for p in points)
    return [(p[1] - south, p[2] - ORIGIN_M, raw[at + k * size + size - 1]) for k, p in enumerate(points)]


def waveform(path):
    with open(path) as rows:
        return [(ORBIT_M - float(r["range_m"]), float(r["sample"]), float(r["ideal"]), float(r["ideal_error"])) for r in csv.DictReader(rows)]


def scale(panel, height):
    low, high, top, bottom = panel
    return bottom - (height - low) / (high - low) * (bottom - top)


def axes(panel, step):
    low, high, top, bottom = panel
    out = ['<rect x="%d" y="%d" width="%d" height="%d" fill="#fff" stroke="#bbb"/>' % (x0, top, x1 - x0, bottom - top) for x0, x1 in ((LEFT, RIGHT), WAVE)]
    for height in range(math.ceil(low / step) * step, high, step):
        out.append('<text x="%d" y="%.1f" text-anchor="end" %s>%d</text>' % (LEFT - 6, scale(panel, height) + 4, INK, height))
    return out


def dots(panel, counts, laser, style):
    low, high = panel[:2]
    path = "".join("M%.1f %.1fh0" % (LEFT + along / TRACK_M * (RIGHT - LEFT), scale(panel, h))
                   for along, h, signal in counts if signal == laser and low < h < high and along < TRACK_M)
    return '<path d="%s" %s stroke-linecap="round" fill="none"/>' % (path, style)


def trace(panel, samples, base, most):
    """Noisy samples as dots, what is expected as a line, and its 95 % band by the paths."""
    inside = [s for s in samples if panel[0] < s[0] < panel[1]]
    across = lambda v: min(max(WAVE[0] + 30 + (v - base) / most * (WAVE[1] - WAVE[0] - 50), WAVE[0]), WAVE[1])  # noqa: E731
    line = lambda values: " ".join("%.1f,%.1f" % (across(v), scale(panel, s[0])) for s, v in values)  # noqa: E731
    band = line([(s, s[2] - 1.96 * s[3]) for s in inside]) + " " + line([(s, s[2] + 1.96 * s[3]) for s in reversed(inside)])
    noisy = "".join("M%.1f %.1fh0" % (across(s[1]), scale(panel, s[0])) for s in inside)
    return ['<path d="%s" stroke="#999" stroke-width="2" stroke-linecap="round" fill="none"/>' % noisy, '<polygon points="%s" fill="#e08a3c" fill-opacity="0.55"/>' % band,
            '<polyline points="%s" fill="none" stroke="#a33b00" stroke-width="1.2"/>' % line([(s, s[2]) for s in inside])]


def main():
    out, pulse, target = Path(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
    counts, samples = photons(out / "photons/strong.las"), waveform(out / "waveforms" / ("waveform_pulse_%d.csv" % pulse))
    base = sorted(s[2] for s in samples)[len(samples) // 3]
    most = max(s[2] - base for s in samples) * 1.15
    svg = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 970 610" width="970" height="610"><rect width="970" height="610" fill="#f7f7f5"/>']
    for panel, step in zip(PANELS, (50, 10)):
        svg += axes(panel, step) + [dots(panel, counts, 0, 'stroke="#b9c2cc" stroke-width="1.6"'), dots(panel, counts, 1, 'stroke="#1b4f8a" stroke-width="2.2"')]
        svg += trace(panel, samples, base, most)
    place = LEFT + (pulse * 7200 / 242) / TRACK_M * (RIGHT - LEFT)
    svg += ['<path d="M%.1f %dv%d" stroke="#e08a3c" stroke-width="1.5" stroke-dasharray="4 4"/>' % (place, top, bottom - top) for _, _, top, bottom in PANELS]
    svg += ['<text x="%d" y="%d" text-anchor="middle" %s>%d</text>' % (LEFT + m / TRACK_M * (RIGHT - LEFT), 577, INK, m) for m in range(0, 1401, 200)]
    svg += ['<text x="%d" y="600" text-anchor="middle" %s>m along the track. Counts at 532 nm: dark of the laser, pale of the sun</text>' % ((LEFT + RIGHT) / 2, INK),
            '<text x="%d" y="600" text-anchor="middle" %s>1064 nm, where the line is dashed</text>' % (sum(WAVE) / 2, INK),
            '<text x="%d" y="24" %s>height, m: cloud above, forest below</text>' % (LEFT, INK),
            '<text x="%d" y="24" %s>dots: samples; line: expected, 95 %% band</text>' % (WAVE[0], INK), "</svg>"]
    Path(target).write_text("\n".join(svg) + "\n")


if __name__ == "__main__":
    main()
