"""Cameras whose detectors see polarisation: a micro-grid (2 x 2, and 4 x 4 with colours), a wheel, four lenses, two arms of a beam splitter and
a channelled spectrum recover the Stokes vectors that paths bring; noise is that of counts; frames turn with the camera.
analysers_test.py BIN PYTHON FOLDER

The scene is an even plate of absorbing metal under an even sky: polarised, and nearly without noise of paths.
"""
import json
import pathlib
import shutil
import subprocess
import sys
import unittest

import numpy as np

BIN, PYTHON, FOLDER = (pathlib.Path(p).resolve() for p in sys.argv[1:4])
sys.dont_write_bytecode = True
sys.path.insert(0, str(PYTHON / "remote_scenes"))
sys.path.insert(0, str(PYTHON.parent / "sample_scenes"))
import polarimetry  # noqa: E402  by itself: the package wants xarray
import side_by_side  # noqa: E402

SCENE = """scene: 1
materials: {metal: {model: ggx, roughness: 0.02, n: 1.2, k: 1.0}}
objects: {plate: {plane: {width: 0, depth: 0}, material: metal}}
world: [{place: plate}]
"""
GREEN = {"name": "green", "center_um": 0.55, "fwhm_um": 0.02, "shape": "rectangular"}
CCD = {"kind": "ccd", "quantum_efficiency": 0.6, "gain_e_per_dn": 1, "read_noise_e": 5, "bias_dn": 100, "bits": 16}
TILT = 57  # degrees from the vertical: near Brewster's angle


def run(*words, code=0):
    done = subprocess.run([BIN / words[0], *map(str, words[1:])], cwd=FOLDER, capture_output=True, text=True)
    assert done.returncode == code, (words, done.stdout, done.stderr)
    return done.stdout + done.stderr


def array(**keys):
    return {"columns": 8, "rows": 8, "pitch_um": 4, "integration_time_s": 0.01, "paths": 16, "bands": [GREEN], "detector": CCD, **keys}


def instrument(arrays, roll=0, **keys):
    """Of a camera that is rolled about its axis."""
    return {"focal_length_mm": 2000, "f_number": 2, "rotate_deg": [0, 0, roll], "arrays": arrays, **keys}


def platform(name, instruments, **keys):
    return {"kind": "platform", "name": name, "motion": {"kind": "static", "position_m": [0, 0, 10]}, "tasks": [{"start": 0}],
            "stokes": "linear", "stokes_frame": "image", "truth": [], "attachments": [{"rotate_deg": [TILT, 0, 0], "instruments": instruments}], **keys}


def simulate(out, sensors, code=0):
    (FOLDER / (out + ".yaml")).write_text(json.dumps({"scene": "scene.h5", "sky": {"radiance": 100}, "sensors": sensors}))
    return run("dirsig-render", out + ".yaml", "-o", out, "-q", code=code)


def image(path):
    """[band, row, column]."""
    header = dict(line.split(" = ", 1) for line in pathlib.Path(str(path) + ".hdr").read_text().splitlines() if " = " in line)
    kind = {"4": "<f4", "12": "<u2"}[header["data type"].strip()]
    return np.fromfile(path, kind).reshape(int(header["bands"]), int(header["lines"]), int(header["samples"])).astype(float)


class Analysers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(FOLDER, ignore_errors=True)
        FOLDER.mkdir(parents=True)
        (FOLDER / "scene.yaml").write_text(SCENE)
        run("scene-prep", "scene.yaml", "-o", "scene.h5", "-q")
        spectrum = [{"name": f"b{i}", "center_um": 0.6 + 0.001 * i, "fwhm_um": 0.001, "shape": "rectangular"} for i in range(40)]
        train = [{"retarder_deg": 90, "axis_deg": 0}, {"retarder_um": 30, "axis_deg": 45}, {"polarizer_deg": 0}]
        colours = [{**GREEN, "name": name, "center_um": um} for name, um in (("red", 0.65), ("green", 0.55), ("blue", 0.45))]
        bayer = [[red, red, green, green] for red, green in (("red", "green"),) * 2] + [["green", "green", "blue", "blue"]] * 2
        simulate("all", [
            platform("grid", [instrument([array(columns=64, rows=64, analyser={"grid": [[90, 45], [135, 0]], "extinction": 300})])]),
            platform("colours", [instrument([array(bands=colours, mosaic=bayer, analyser={"grid": [[90, 45], [135, 0]]})])]),
            platform("wheel", [instrument([array(analyser={"wheel": [0, 60, 120]})], clock={"rate_hz": 1})], tasks=[{"start": 0, "stop": 2}]),
            platform("lenses", [instrument([array(analyser={"polarizer_deg": a})], name=f"at{a}", offset_m=[0.1 * i, 0, 0])
                                for i, a in enumerate((0, 45, 90, 135))]),
            platform("arms", [instrument([array(name=f"arm{a}", analyser={"elements": [{"transmission": 0.5}, {"polarizer_deg": a}]})
                                          for a in (0, 45, 90)])]),
            platform("channelled", [instrument([array(columns=2, rows=2, bands=spectrum, analyser={"elements": train})], roll=20)]),
            platform("rolled", [instrument([array()], roll=30)]),
            platform("level", [instrument([array()])]),
            platform("meridian", [instrument([array()], roll=30)], stokes_frame="meridian"),
        ])

    def electrons(self, name):
        return image(FOLDER / "all" / f"{name}_electrons.img")

    def truth(self, name):
        """I, Q, U of a sensor's mean pixel."""
        return image(FOLDER / "all" / f"{name}.img")[:3].mean(axis=(1, 2))

    def holds(self, found, name, tolerance=5e-3):
        truth = self.truth(name)
        np.testing.assert_allclose(found[1:] / found[0], truth[1:] / truth[0], atol=tolerance)

    def test_a_micro_grid_recovers_stokes(self):
        e = self.electrons("grid")[0]
        S = polarimetry.demosaic(e, [[90, 45], [135, 0]], 300)
        self.holds(S.mean(axis=(1, 2)), "grid")
        wrong = polarimetry.demosaic(e, [[0, 45], [135, 90]], 300).mean(axis=(1, 2))  # negative control: another order
        self.assertGreater(abs(wrong[1] / wrong[0] - self.truth("grid")[1] / self.truth("grid")[0]), 0.5)

    def test_its_noise_is_that_of_counts(self):
        e, dn = self.electrons("grid")[0], image(FOLDER / "all/grid_dn.img")[0] - 100
        z = (dn - e) / np.sqrt(e + 25 + 1 / 12)
        self.assertLess(abs(z.var() - 1), 4 * np.sqrt(2 / z.size))
        self.assertGreater(abs(((dn - e) / np.sqrt(e.mean() + 25)).reshape(32, 2, 32, 2).var(axis=(0, 2)).max() - 1), 0.3)  # not the mean's
        # S by least squares: the variance of Q is N0 + N90.
        cells = [(dn - e)[j::2, i::2] for j, i in ((1, 1), (0, 1), (0, 0), (1, 0))]
        value, _ = polarimetry.stokes(cells, polarimetry.rows([0, 45, 90, 135], 300))
        q = value[1]
        wanted = (e[1::2, 1::2] + e[0::2, 0::2] + 50 + 1 / 6).mean() / (2 * polarimetry.rows(0, 300)[1]) ** 2
        self.assertLess(abs(q.var() / wanted - 1), 4 * np.sqrt(2 / q.size))

    def test_a_mosaic_counts_one_band_a_detector(self):
        dn, mosaic = image(FOLDER / "all/colours_dn.img"), image(FOLDER / "all/colours_mosaic.img")[0]
        self.assertEqual(mosaic[0, 1], dn[0, 0, 1])
        self.assertEqual(mosaic[1, 6], dn[1, 1, 6])
        self.assertEqual(mosaic[7, 3], dn[2, 7, 3])

    def test_wheels_lenses_and_arms_recover_stokes(self):
        for name, files, angles in (("wheel", [f"wheel_{i:04d}" for i in range(3)], (0, 60, 120)),
                                    ("lenses", [f"lenses_at{a}" for a in (0, 45, 90, 135)], (0, 45, 90, 135)),
                                    ("arms", [f"arms_arm{a}" for a in (0, 45, 90)], (0, 45, 90))):
            with self.subTest(name):
                frames = [self.electrons(f)[0] for f in files]
                S, _ = polarimetry.stokes(frames, polarimetry.rows(angles))
                self.holds(S.mean(axis=(1, 2)), files[0])
        # A beam splitter of one half takes half the light.
        self.assertAlmostEqual(self.electrons("arms_arm0").mean() / self.electrons("lenses_at0").mean(), 0.5, delta=0.01)

    def test_a_channelled_spectrum_recovers_q_and_u(self):
        e = self.electrons("channelled").mean(axis=(1, 2))
        um = 0.6 + 0.001 * np.arange(40)
        photons = um / um.mean()  # an even radiance: electrons go with the wavelength
        found = polarimetry.channelled(um, e / photons, 30, 0.03)[:, 20]
        truth = image(FOLDER / "all/channelled.img").mean(axis=(1, 2))
        i, q, u = truth[20], truth[40 + 20], truth[80 + 20]
        np.testing.assert_allclose(found[1:], [q / i, u / i], atol=0.02)
        self.assertGreater(abs(u / i), 0.2, "negative control: a wrong sign of U is seen")

    def test_frames_turn_with_the_camera(self):
        level, rolled, meridian = (self.truth(n) for n in ("level", "rolled", "meridian"))
        angle = {n: np.degrees(np.arctan2(S[2], S[1])) / 2 % 180 for n, S in (("level", level), ("rolled", rolled), ("meridian", meridian))}
        # Turned counter-clockwise as it looks, the camera sees the world turned clockwise.
        self.assertAlmostEqual((angle["level"] - angle["rolled"]) % 180, 30, delta=0.5)
        self.assertAlmostEqual(angle["meridian"], 90, delta=0.5)  # metal reflects light across the plane of incidence
        self.assertAlmostEqual(angle["level"], 90, delta=0.5)
        for S in (rolled, meridian):
            self.assertAlmostEqual(np.hypot(*S[1:]) / S[0], np.hypot(*level[1:]) / level[0], delta=5e-3)

    def test_previews_show_the_angle_in_hue(self):
        """Cyan is 90 degrees, green 60: of a rolled camera."""
        for name, most, least in (("level", (1, 2), (0,)), ("rolled", (1,), (0, 2))):
            picture = side_by_side.read(FOLDER / "all" / f"{name}_polarisation.png")
            mean = np.array([list(pixel) for row in picture for pixel in row], float).mean(axis=0)
            self.assertGreater(min(mean[i] for i in most), 1.3 * max(mean[i] for i in least), (name, mean))

    def test_what_cannot_be_is_refused(self):
        for keys, sensor, wanted in (
                ({"analyser": {"grid": [[0, 45], [90]]}}, {}, "rows of one length"),
                ({"analyser": {"elements": [{"mueller": [1] * 15}]}}, {}, "16 numbers"),
                ({"analyser": {"elements": [{"mueller": [1, 1, 1, 0] + [0] * 12}]}}, {}, "no optics has this matrix"),
                ({"analyser": {"elements": [{"lens": 1}]}}, {}, "no optical element"),
                ({"analyser": {"polarizer_deg": 0, "retarder_deg": 90, "axis_deg": 45}}, {}, "this analyser sees V"),
                ({"analyser": {"polarizer_deg": 0}, "detector": None}, {}, "no detectors behind it"),
                ({"analyser": {"polarizer_deg": 0}}, {"stokes_frame": "meridian"}, "frame of the picture"),
                ({"mosaic": [["green", "red"]]}, {}, "there is no band 'red'"),
                ({}, {"analyser": {"polarizer_deg": 0}}, "of an array")):
            one = {k: v for k, v in array(**keys).items() if v is not None}
            self.assertIn(wanted, simulate("refused", [platform("bad", [instrument([one])], **sensor)], code=1), wanted)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
