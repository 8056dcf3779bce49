#!/usr/bin/env python3
"""A grid of spheres over a diffuse background, one fitted material each: make_scene.py FOLDER OUT [--bin BIN]

Takes every .sqt file of FOLDER; a .bsdf, .binary or .brdf file without a .sqt of the same name is fitted first (into OUT). Writes
scene.yaml and sim.yaml into OUT, prepares and renders them; the picture is OUT/out/spheres.png. Without FOLDER (or with "-") the
materials are a few parametric models, fitted by the way. Needs Python 3 and its standard library only.
"""
import argparse
import math
import os
import shutil
import subprocess

MODELS = {  # shown when no folder is given
    "matte": "oren_nayar:reflectance=0.5,sigma=0.5",
    "gloss": "ward:diffuse=0.15,specular=0.25,roughness=0.12",
    "satin": "ward:diffuse=0.3,specular=0.1,roughness=0.25",
    "mirror": "mirror:reflectance=0.8",
    "brushed": "ward:diffuse=0.05,specular=0.6,roughness=0.08,roughness_y=0.3",
    "soil": "rpv:rho0=0.2,k=0.7,asymmetry=-0.2,rho_c=0.2",
}

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("folder", nargs="?", default="-")
parser.add_argument("out")
parser.add_argument("--bin", default="", help="where sqt-fit, scene-prep and dirsig-render are (default: the PATH)")
parser.add_argument("--paths", type=int, default=32, help="paths per pixel")
parser.add_argument("--columns", type=int, default=640, help="pixels across")
args = parser.parse_args()


def run(program, *rest):
    subprocess.run([os.path.join(args.bin, program), *rest], check=True)


def materials():
    os.makedirs(args.out, exist_ok=True)
    found = {}
    if args.folder == "-":
        for name, model in MODELS.items():
            found[name] = os.path.join(args.out, name + ".sqt")
            run("sqt-fit", "--model", model, "-o", found[name])
        return found
    files = sorted(os.listdir(args.folder))
    for f in files:
        if f.endswith(".sqt"):
            target = os.path.join(args.out, f)
            if os.path.abspath(target) != os.path.abspath(os.path.join(args.folder, f)):
                shutil.copy(os.path.join(args.folder, f), target)
            found[f[:-4]] = target
    for f in files:
        stem, kind = os.path.splitext(f)
        if kind in (".bsdf", ".binary", ".brdf") and stem not in found:
            found[stem] = os.path.join(args.out, stem + ".sqt")
            run("sqt-fit", os.path.join(args.folder, f), "-o", found[stem])
    if not found:
        raise SystemExit("%s holds no .sqt, .bsdf, .binary or .brdf file" % args.folder)
    return found


def identifier(name):
    return "m_" + "".join(c if c.isalnum() else "_" for c in name)


found = materials()
names = sorted(found)
across = math.ceil(math.sqrt(1.6 * len(names)))
down = math.ceil(len(names) / across)
with open(os.path.join(args.out, "scene.yaml"), "w") as scene:
    print("scene: 1\nname: spheres\norigin: {latitude_deg: 43.1, longitude_deg: -77.6, height_m: 150}", file=scene)
    print("windows_um: [[0.4, 0.7]]\nmaterials:\n  backdrop: {model: lambert, reflectance: 0.2}", file=scene)
    for name in names:
        print("  %s: {model: sqt, file: %s, outside: hold}" % (identifier(name), os.path.basename(found[name])), file=scene)
    print("objects:\n  backdrop: {plane: {width: 0, depth: 0}, material: backdrop}", file=scene)
    print("  ball: {sphere: {radius: 1}, material: backdrop}", file=scene)
    print("world:\n  - {place: backdrop, translate: [0, 0, -1], tag: backdrop}", file=scene)
    for n, name in enumerate(names):
        x, y = 2.5 * (n % across - (across - 1) / 2), -2.5 * (n // across - (down - 1) / 2)
        print("  - {place: ball, translate: [%g, %g, 0], material: %s, tag: %s}" % (x, y, identifier(name), identifier(name)),
              file=scene)

# Seen from above through a long lens; the sun from the upper left, a sky three times as bright in the west as in the east.
height = 60.0
width = 2.5 * across + 0.8
rows = round(args.columns * (2.5 * down + 0.8) / width)
focal = 0.01 * args.columns * height / width  # mm, of 10 um detectors
with open(os.path.join(args.out, "sim.yaml"), "w") as sim:
    print("scene: scene.h5\nseed: 1\nmax_nodes: 6", file=sim)
    print("sun:\n  direction: {zenith_deg: 40, azimuth_deg: 300}\n  irradiance: 1500", file=sim)
    print("sky:\n  radiance: 60\n  table: [[1, 1, 1, 1], [0.5, 1, 1.5, 1], [0.5, 1, 1.5, 1]]", file=sim)
    print("sensors:\n  - kind: frame_camera\n    name: spheres\n    columns: %d\n    rows: %d" % (args.columns, rows), file=sim)
    print("    pitch_um: 10\n    focal_length_mm: %g\n    position_m: [0, -12, %g]\n    look_at_m: [0, 0, 0]" % (focal, height), file=sim)
    print("    bands:", file=sim)
    for name, um in (("blue", 0.45), ("green", 0.55), ("red", 0.65)):
        print("      - {name: %s, center_um: %g, fwhm_um: 0.02, shape: rectangular}" % (name, um), file=sim)
    print("    paths: %d" % args.paths, file=sim)

run("scene-prep", os.path.join(args.out, "scene.yaml"), "-o", os.path.join(args.out, "scene.h5"))
run("dirsig-render", os.path.join(args.out, "sim.yaml"), "-o", os.path.join(args.out, "out"))
print("from the upper left, row by row: " + ", ".join(names))
