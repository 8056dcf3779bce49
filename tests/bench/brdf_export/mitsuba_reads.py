#!/usr/bin/env python3
"""mitsuba_reads.py BIN FILE.sqt [PAIRS [OPTIONS OF --export]]

Exports a BRDF as .bsdf, has Mitsuba's `measured` evaluate, sample and weigh it, and compares with the fit: l1 as sqt-fit has it
over PAIRS (20000) of directions in each colour (or at the middle wavelength), and the energy of Mitsuba's own samples at 30 deg beside the
total. Needs the wheel mitsuba (pip install mitsuba ./python) and the suite's library (target remote_scenes)."""
import json
import math
import random
import subprocess
import sys
import tempfile

import mitsuba as mi
import numpy as np

from pairs import Difference, draw, fitted, vector

COLOURS = [0.65, 0.55, 0.45]  # um; Mitsuba takes such files in its RGB variants alone, and others in spectral ones


def main(binaries, sqt, pairs="20000", *options):
    inspect = binaries + "/sqt-inspect"
    header = subprocess.run([inspect, sqt, "--json"], capture_output=True, text=True, check=True).stdout
    waves = json.loads(header)["wavelength_um"]
    colours = waves == COLOURS
    mi.set_variant("scalar_rgb" if colours else "scalar_spectral")
    channels = [waves.index(um) for um in COLOURS] if colours else [len(waves) // 2]
    asked = [waves[c] for c in channels]
    with tempfile.TemporaryDirectory() as folder:
        file = folder + "/x.bsdf"
        told = subprocess.run([inspect, sqt, "--export", file, *options], capture_output=True, text=True, check=True)
        print(told.stderr.strip())
        bsdf = mi.load_dict({"type": "measured", "filename": file})

    def interaction(wi):
        si = mi.SurfaceInteraction3f()
        si.wi = mi.Vector3f(*wi)
        if not colours:
            si.wavelengths = [asked[0] * 1000] * 4
        return si

    rng, differences = random.Random(1), [Difference() for _ in asked]
    drawn = [draw(rng) for _ in range(int(pairs))]
    for (out, into, weight), f in zip(drawn, fitted(binaries, sqt, drawn)):
        theirs = np.ravel(np.array(bsdf.eval(mi.BSDFContext(), interaction(out), mi.Vector3f(*into))))
        for k, c in enumerate(channels):
            differences[k].add(float(theirs[k]), f[c] * into[2], weight)
    for um, difference in zip(asked, differences):
        print(f"Mitsuba's values at {um} um: {difference.text()}")
    weights = []
    for _ in range(4000):
        u = [rng.uniform(0, 1) for _ in range(3)]
        _, weight = bsdf.sample(mi.BSDFContext(), interaction(vector(math.radians(30), 0.4)), u[0], mi.Point2f(u[1], u[2]))
        weights.append(np.ravel(np.array(weight))[: len(asked)])
    for k, um in enumerate(asked):
        drawn = [float(w[k]) for w in weights]
        text = subprocess.run([inspect, sqt, "--eval", f"30,0,10,180,{um}"], capture_output=True, text=True, check=True).stdout
        print(f"total at 30 deg, {um} um: {float(text.split('total')[1]):.4f}, of Mitsuba's samples {np.mean(drawn):.4f} "
              f"+- {np.std(drawn) / np.sqrt(len(drawn)):.4f}")


if __name__ == "__main__":
    main(*sys.argv[1:])
