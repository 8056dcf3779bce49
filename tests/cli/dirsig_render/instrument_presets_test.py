"""Imaging instruments by published numbers: every preset renders, and its signal to noise ratio at a reference radiance is the published
one within 10 %, by its electrons and the noise of its detector's text. instrument_presets_test.py BIN FOLDER

Published: noise |a sqrt(b + L) + c| of isofit/isofit-data @9bc569de61c7 (EMIT, AVIRIS-NG; uW/(cm2 sr nm)); ratios and reference radiances of
MSI as the preset's text names them.
"""
import math
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

import numpy

BIN, FOLDER = (pathlib.Path(p).resolve() for p in sys.argv[1:3])
SCENE = """scene: 1
materials: {grey: {model: lambert, reflectance: 0.1}}
objects: {plate: {plane: {width: 1, depth: 1}, material: grey}}
world: [{place: plate, translate: [90000, 0, 0]}]
"""
# nm: a, b of the noise at a band; radiance in uW/(cm2 sr nm)
SPECTROMETERS = {"emit": {544: (0.00462, 1.8954), 873: (0.00399, 1.4133), 1611: (0.00208, 0.3857), 2182: (0.00173, 0.2658)},
                 "aviris_ng": {465: (0.01202, 1.7890), 805: (0.00909, 1.0318), 1570: (0.00357, 0.1577), 2250: (0.00281, 0.0978)}}
RADIANCE = 2.0
# W/(m2 sr um), ratio
MSI = {"B1": (129.11, 129), "B2": (128, 154), "B3": (128, 168), "B4": (108, 142), "B5": (74.6, 117), "B6": (68.23, 89), "B7": (66.7, 105), "B8": (103, 174),
       "B8A": (52.39, 72), "B9": (8.77, 114), "B10": (6, 50), "B11": (4, 100), "B12": (1.7, 100)}


def run(*words, code=0):
    done = subprocess.run([BIN / words[0], *map(str, words[1:])], cwd=FOLDER, capture_output=True, text=True)
    assert done.returncode == code, (words, done.stdout, done.stderr)
    return done.stdout + done.stderr


def narrow(preset):
    """Two columns of every array, lines few."""
    return re.sub(r"columns: \d+", "columns: 2", re.sub(r"paths: \d+", "paths: 1", preset))


def electrons(name, radiance):
    """By image: means of its bands, wavelengths (um). radiance: W/(m2 sr um), everywhere."""
    preset = narrow(run("dirsig-render", "--preset", name)).replace("stop: 0.1", "stop: 0.001")
    (FOLDER / "sim.yaml").write_text("scene: scene.h5\nsky: {radiance: %s, full_sphere: true}\nsensors:\n%s" % (radiance, preset))
    out = FOLDER / ("out_" + name)
    shutil.rmtree(out, ignore_errors=True)
    run("dirsig-render", "sim.yaml", "-o", out, "-q", "-j", "2")
    found = {}
    for path in out.glob("*_electrons.img"):
        header = pathlib.Path(str(path) + ".hdr").read_text()
        bands = int(re.search(r"bands *= *(\d+)", header)[1])
        centers = [float(x) for x in re.search(r"wavelength *= *\{([^}]*)\}", header)[1].split(",")]
        found[path.name] = (numpy.fromfile(path, "<f4").reshape(bands, -1).mean(1), numpy.array(centers))
    return found


def detector(preset, key):
    return float(re.search(key + r": ([\d.]+)", preset)[1])


class Presets(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(FOLDER, ignore_errors=True)
        FOLDER.mkdir(parents=True)
        (FOLDER / "scene.yaml").write_text(SCENE)
        run("scene-prep", "scene.yaml", "-o", "scene.h5", "-q")
        cls.names = [line.split()[0] for line in run("dirsig-render", "--list-presets").splitlines()]

    def test_every_preset_names_its_sources(self):
        self.assertLessEqual({"aviris_ng", "emit", "msi", "viirs_dnb_like"}, set(self.names))
        self.assertEqual(len(self.names), len(set(self.names)))
        for name in self.names:
            self.assertTrue(run("dirsig-render", "--preset", name).startswith("# Source: "), name)
        self.assertIn("did you mean 'emit'", run("dirsig-render", "--preset", "emitt", code=1))

    def ratios(self, name):
        """Ours over the published ratio at the bands of SPECTROMETERS."""
        preset = run("dirsig-render", "--preset", name)
        read, gain = detector(preset, "read_noise_e"), detector(preset, "gain_e_per_dn")
        (values, um), = electrons(name, 10 * RADIANCE).values()
        nm = um * (1000 if um.max() < 100 else 1)
        for center, (a, b) in SPECTROMETERS[name].items():
            signal = values[int(numpy.argmin(abs(nm - center)))]
            ours = signal / math.sqrt(signal + read**2 + gain**2 / 12)
            yield center, ours / (RADIANCE / (a * math.sqrt(b + RADIANCE)))

    def test_spectrometers_have_the_published_noise(self):
        for name in SPECTROMETERS:
            for center, ratio in self.ratios(name):
                print(f"{name} {center} nm: ratio to the published {ratio:.3f}")
                self.assertLess(abs(ratio - 1), 0.1, (name, center))

    def test_msi_has_the_published_ratios(self):
        preset, found = run("dirsig-render", "--preset", "msi"), electrons("msi", 1)
        for band, (radiance, published) in MSI.items():
            gain = detector(re.search(r"name: %s, columns.*?gain_e_per_dn[^}]*" % band, preset, re.S)[0], "gain_e_per_dn")
            name, = (n for n in found if re.search(r"_%s_electrons" % band, n))
            signal = radiance * found[name][0][0]
            ratio = signal / math.sqrt(signal + gain**2 / 12) / published
            print(f"msi {band}: ratio to the published {ratio:.3f}")
            self.assertLess(abs(ratio - 1), 0.1, band)

    def test_half_the_light_is_seen(self):
        """The same check refuses an efficiency that is half of what it should be."""
        global narrow
        whole = narrow
        try:
            narrow = lambda preset: whole(preset).replace("f_number: 1.8", "f_number: 2.6")
            self.assertTrue(any(abs(ratio - 1) > 0.1 for _, ratio in self.ratios("emit")))
        finally:
            narrow = whole


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
