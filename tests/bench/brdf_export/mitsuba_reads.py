#!/usr/bin/env python3
"""mitsuba_reads.py BIN FILE.sqt [SIDE]

Exports a BRDF as .bsdf, has Mitsuba's `measured` evaluate, sample and weigh it, and compares with sqt-inspect --eval:
the mean relative difference of f cos over pairs of directions, and the energy of Mitsuba's own samples at 30 deg beside
the total. Needs the wheel mitsuba (pip install mitsuba numpy)."""
import subprocess
import sys
import tempfile

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_spectral")


def direction(theta, phi):
    return mi.Vector3f(*map(float, (np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta))))


def interaction(wi, um):
    si = mi.SurfaceInteraction3f()
    si.wi = wi
    si.wavelengths = [um * 1000] * 4
    return si


def main(binaries, sqt, side="64"):
    inspect = binaries + "/sqt-inspect"
    with tempfile.TemporaryDirectory() as folder:
        file = folder + "/x.bsdf"
        told = subprocess.run([inspect, sqt, "--export", file, "--export-size", side], capture_output=True, text=True, check=True)
        print(told.stderr.strip())
        bsdf = mi.load_dict({"type": "measured", "filename": file})
    um = 0.55
    rng = np.random.default_rng(1)
    error = total = 0.0
    for _ in range(200):
        to, ti = np.arccos(rng.uniform(0.17, 1, 2))
        po, pi = rng.uniform(0, 2 * np.pi, 2)
        text = subprocess.run([inspect, sqt, "--eval", ",".join(f"{v:.9f}" for v in (*np.degrees([to, po, ti, pi]), um))],
                              capture_output=True, text=True, check=True).stdout
        ours = float(text.split("w_per_sr")[1].split()[0])
        theirs = float(np.ravel(np.array(bsdf.eval(mi.BSDFContext(), interaction(direction(to, po), um),
                                                   direction(ti, pi))))[0])
        error += abs(theirs - ours)
        total += ours
    print(f"eval: mean difference {100 * error / total:.3f} % of the mean over 200 pairs up to 80 deg")
    wi = direction(np.radians(30), 0.4)
    weights = []
    for u in rng.uniform(size=(4000, 3)):
        _, weight = bsdf.sample(mi.BSDFContext(), interaction(wi, um), float(u[0]), mi.Point2f(float(u[1]), float(u[2])))
        weights.append(float(np.ravel(np.array(weight))[0]))
    text = subprocess.run([inspect, sqt, "--eval", f"30,0,10,180,{um}"], capture_output=True, text=True, check=True).stdout
    print(f"total at 30 deg: {float(text.split('total')[1]):.4f}, of Mitsuba's samples {np.mean(weights):.4f} "
          f"+- {np.std(weights) / np.sqrt(len(weights)):.4f}")


if __name__ == "__main__":
    main(*sys.argv[1:])
