#!/usr/bin/env python3
"""page.py FOLDER: a page of what `run` left in FOLDER, valley.html, and the table of what it cost, on the screen and in cost.md.

For every instrument its picture, the relative standard error at its reference band in colours, and what the pixels show (classes of the truth
over the picture). Python's standard library only.
"""
import base64
import html
import json
import os
import struct
import sys
import zlib

import envi

SHOWN = {"thermal": ("dawn", "noon", "sunset"), "drone": ("drone",), "strip": ("strip",), "satellite": ("satellite",), "night": ("night",), "canopy": ("canopy",),
         "mat": ("canopy",)}
REFERENCE = {"dawn": "thermal", "noon": "thermal", "sunset": "thermal", "drone": "green", "strip": "b025", "satellite": "red", "night": "green", "canopy": "near infrared"}
STEPS = ((0.005, (49, 54, 149)), (0.01, (116, 173, 209)), (0.02, (224, 243, 248)), (0.05, (254, 224, 144)), (0.2, (244, 109, 67)), (1e30, (165, 0, 38)))
STYLE = ("body{font:15px sans-serif;margin:2em auto;max-width:1200px;color:#222}img{image-rendering:pixelated;height:300px;margin:2px}figure{display:inline-block;"
         "margin:4px;vertical-align:top}figcaption{font-size:12px;max-width:560px}table{border-collapse:collapse}td,th{padding:2px 10px;border-bottom:1px solid #ccc;"
         "text-align:right}td:first-child{text-align:left}b{display:inline-block;width:1em;height:1em;vertical-align:middle;margin:0 3px 0 9px}")


def png(width, height, pixels):
    """pixels: bytes of red, green, blue."""
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    rows = b"".join(b"\0" + pixels[3 * width * r:3 * width * (r + 1)] for r in range(height))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")


def figure(data, caption):
    return '<figure><img src="data:image/png;base64,%s"><figcaption>%s</figcaption></figure>' % (base64.b64encode(data).decode(), caption)


def swatch(colour, text):
    return '<b style="background:rgb(%d,%d,%d)"></b>%s' % (*colour, html.escape(text))


def relative_errors(folder, name):
    """Of the radiance of all pixels at the reference band; of temperatures by the slope of Planck's law at 10.5 um."""
    cube, error = envi.Cube("%s/%s.img" % (folder, name)), envi.Cube("%s/%s_error.img" % (folder, name))
    band = REFERENCE[name]
    if cube.header.get("data units") == "K":
        return cube, [e * 14387.77 / (10.5 * v * v) for v, e in zip(cube[band], error[band])]
    return cube, [e / abs(v) if v else 1e9 for v, e in zip(cube[band], error[band])]


def error_figure(cube, errors):
    pixels = bytes(c for e in errors for c in next(colour for limit, colour in STEPS if e <= limit))
    good = sum(e <= 0.02 for e in errors) / len(errors)
    legend, low = "", 0
    for limit, colour in STEPS:
        legend += swatch(colour, "to %g %%" % (100 * limit) if limit < 1e9 else "more")
    return figure(png(cube.samples, cube.lines, pixels), "Standard error, relative: %s<br>%.1f %% of the pixels within 2 %%" % (legend, 100 * good)), good


def overlay(folder, name, cube):
    """Colours of the classes, as bright as the picture is there."""
    classes = envi.Cube("%s/%s_material.img" % (folder, name))
    table = [int(v) for v in classes.header["class lookup"].split(",")]
    colours = [table[3 * k:3 * k + 3] for k in range(len(classes.classes))]
    band, kinds = cube[REFERENCE[name]], classes[0]
    order = sorted(band)
    low, high = order[len(order) // 100], order[-1 - len(order) // 50]
    pixels = bytearray()
    for v, k in zip(band, kinds):
        bright = 0.35 + 0.65 * min(1, max(0, (v - low) / (high - low or 1)))
        pixels += bytes(int(c * bright) for c in colours[k])
    there = sorted(set(kinds), key=lambda k: -sum(1 for v in kinds if v == k))[:14]
    return figure(png(cube.samples, cube.lines, bytes(pixels)), "What it shows: " + "".join(swatch(colours[k], classes.classes[k]) for k in there))


def article(folder, simulation):
    with open(os.path.join(folder, simulation, "render.json")) as text:
        log = json.load(text)
    user, system, real = (float(v) for v in open(os.path.join(folder, simulation, "seconds.txt")).read().split())
    out, good = ["<h2>%s</h2>" % simulation], []
    for name in SHOWN[simulation]:
        where = os.path.join(folder, simulation)
        cube, errors = relative_errors(where, name)
        with open("%s/%s.png" % (where, name), "rb") as picture:
            out.append(figure(picture.read(), name))
        drawn, share = error_figure(cube, errors)
        good.append(share)
        out += [drawn, overlay(where, name, cube)]
    flagged = sum(q["flagged"] for q in log["quality"]) / sum(q["pixels"] for q in log["quality"])
    row = (simulation, user + system, real, log["peak_bytes"] / 2 ** 20, 100 * log["median_relative_error"], 100 * sum(good) / len(good), 100 * flagged)
    return row, "\n".join(out)


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    folder, rows, body = sys.argv[1], [], []
    for simulation in SHOWN:
        if os.path.exists(os.path.join(folder, simulation, "seconds.txt")):
            row, text = article(folder, simulation)
            rows.append(row)
            body.append(text)
    for name in ("forest", "fit"):
        path = os.path.join(folder, name, "seconds.txt")
        if os.path.exists(path):
            user, system, real = (float(v) for v in open(path).read().split())
            rows.append((name, user + system, real, None, None, None, None))
    heads = ("simulation", "CPU s", "s", "MiB", "median error, %", "pixels within 2 %, %", "flagged, %")
    cell = lambda v: "" if v is None else v if isinstance(v, str) else "%.3g" % v
    lines = ["| %s |" % " | ".join(heads), "|---|%s" % ("---:|" * 6)] + ["| %s |" % " | ".join(cell(v) for v in row) for row in rows]
    lines.append("| all | %.0f | %.0f | | | | |" % (sum(r[1] for r in rows), sum(r[2] for r in rows)))
    with open(os.path.join(folder, "cost.md"), "w") as out:
        out.write("\n".join(lines) + "\n")
    print("\n".join(lines))
    table = "<table>%s</table>" % "".join("<tr>%s</tr>" % "".join("<td>%s</td>" % html.escape(c.strip()) for c in line.strip("|").split("|")) for line in lines if "---" not in line)
    with open(os.path.join(folder, "valley.html"), "w") as out:
        out.write('<!doctype html><html lang="en"><meta charset="utf-8"><title>Valley</title><style>%s</style><h1>One valley, six instruments</h1>%s%s</html>'
                  % (STYLE, table, "\n".join(body)))


main()
