"""What pages offer beside pictures: regions and CSV, frames, places, kelvin, one colour for a class everywhere, layouts."""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import numpy as np
from browser import Browser
from cube_test import make_cube, view

BIN = Path(os.environ["SUITE_BIN"])
KEEP = os.environ.get("SUITE_KEEP")
SCENE = """scene: 1
name: yard
epoch: 2026-03-01T09:30:00Z
origin: {latitude_deg: 49.4, longitude_deg: 8.7, height_m: 120}
materials:
  grass: {model: lambert, reflectance: 0.03, temperature: {model: constant, kelvin: 290}}
  tin: {model: lambert, reflectance: 0.03, temperature: {model: constant, kelvin: 310}}
objects:
  lawn: {plane: {width: 300, depth: 300}, material: grass}
  box: {box: {x0: -2, y0: -2, z0: 0, x1: 2, y1: 2, z1: 3}, material: tin}
world: [{place: lawn}, {place: box, tag: shed, translate: [40, 20, 0]}]
"""
SIM = """scene: scene.h5
sky: {radiance: 0}
sensors:
  - {name: map, kind: orthographic, columns: 40, rows: 30, gsd_m: 0.4, center_m: [40, 20], paths: 16, geolocation: true,
     bands: [{name: lwir, center_um: 10, fwhm_um: 0.1}], truth: [material, tag, location]}
  - {name: tilted, kind: frame_camera, columns: 60, rows: 40, pitch_um: 40, focal_length_mm: 8, position_m: [0, 0, 40], look_at_m: [40, 20, 0],
     paths: 8, geolocation: true, bands: [{name: lwir, center_um: 10, fwhm_um: 0.1}, {name: mwir, center_um: 4, fwhm_um: 0.1}]}
"""


class Tools(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def keep(self, browser, name):
        if KEEP:
            browser.screenshot(Path(KEEP) / f"{name}.png")

    def show(self, *more):
        page = self.folder / "x.html"
        done = view("-o", self.folder, "--view", page, "-q", *more)
        self.assertEqual(done.returncode, 0, done.stderr)
        return page

    def test_regions_and_csv(self):
        values, errors, _ = make_cube(self.folder, 5, 32)
        values[1, 7, 6] = np.nan
        values.tofile(self.folder / "cam.img")
        with Browser() as browser:
            browser.open(self.show())
            x, y, width, height = browser.box("#picture")
            browser.drag(x + 4.5 * width / 32, y + 6.5 * height / 32, 7 * width / 32, 3 * height / 32)
            got = browser.run("state.region && [state.region.from, state.region.to]")
            self.assertEqual([got[0]["column"], got[0]["row"], got[1]["column"], got[1]["row"]], [4, 6, 11, 9])
            for band in range(5):
                inside, error = values[band, 6:10, 4:12].ravel(), errors[band, 6:10, 4:12].ravel()
                known = np.isfinite(inside)
                s = browser.run(f"state.region.bands[{band}]")
                self.assertEqual(s["n"], known.sum())
                np.testing.assert_allclose([s["mean"], s["deviation"], s["least"], s["most"]],
                                           [inside[known].mean(), inside[known].std(ddof=1), inside[known].min(), inside[known].max()], rtol=1e-3)
                self.assertAlmostEqual(s["error"] / (np.sqrt((error[known] ** 2).sum()) / known.sum()), 1, delta=0.03)
            browser.click(x + 20.5 * width / 32, y + 20.5 * height / 32)
            self.assertEqual(browser.run("state.picks.length"), 1)
            browser.run("document.getElementById('csv').click()")
            saved = browser.run("window.lastSaved")
            rows = [line.split(",") for line in saved["text"].splitlines() if not line.startswith("#")]
            self.assertEqual(saved["name"], "cam.csv")
            self.assertEqual(len(rows), 6)
            self.assertEqual(rows[0][:3], ["band", "wavelength_um", "fwhm_um"])
            mean = rows[0].index("mean [W/(m2 sr um)]")
            self.assertAlmostEqual(float(rows[3][mean]) / values[2, 6:10, 4:12].mean(), 1, delta=1e-3)
            self.assertAlmostEqual(float(rows[3][3]) / values[2, 20, 20], 1, delta=1e-3)
            self.keep(browser, "region")
            self.assertEqual(browser.faults, [])

    def test_frames_play_under_one_stretch(self):
        make_cube(self.folder, 3, 24)
        for number in range(3):
            for part in ("", "_error", "_quality"):
                to = self.folder / f"cam_{number:04d}{part}.img"
                shutil.copy(self.folder / f"cam{part}.img", to)
                shutil.copy(self.folder / f"cam{part}.img.hdr", f"{to}.hdr")
            frame = np.fromfile(self.folder / "cam.img", "<f4") * (1 + number)
            frame.astype("<f4").tofile(self.folder / f"cam_{number:04d}.img")
        for file in self.folder.glob("cam.img*"):
            file.unlink()
        with Browser() as browser:
            browser.open(self.show())
            self.assertFalse(browser.run("ui.player.hidden"))
            one = "JSON.stringify(rangesShown())"
            first = browser.run(one)
            # Before anything is touched, too: the numbers of the other frames come after the first picture.
            legend = "document.getElementById('legend').innerText"
            at_first = browser.run(legend)
            browser.run("draw()")
            self.assertEqual(browser.run(legend), at_first)
            browser.set("#frame", 2)
            self.assertEqual(browser.run("state.image"), 2)
            self.assertEqual(browser.run("ui.images.value"), "2")
            self.assertEqual(browser.run(one), first)
            browser.set("#rate", 20)
            browser.run("document.getElementById('play').click()")
            seen, end = set(), time.monotonic() + 20
            while len(seen) < 3 and time.monotonic() < end:
                seen.add(browser.run("state.image"))
            self.assertEqual(seen, {0, 1, 2})
            browser.run("document.getElementById('play').click()")
            self.assertFalse(browser.run("!!player.timer"))
            self.keep(browser, "frames")
            self.assertEqual(browser.faults, [])

    def test_places_kelvin_and_colours(self):
        (self.folder / "scene.yaml").write_text(SCENE)
        (self.folder / "sim.yaml").write_text(SIM)
        subprocess.run([BIN / "scene-prep", "scene.yaml", "-o", "scene.h5", "--view", "scene.html", "-q"], cwd=self.folder, check=True)
        done = view("sim.yaml", "-o", "out", "--view", "x.html", "-q", cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        header = (self.folder / "out/map_material.img.hdr").read_text()
        lookup = [int(n) for n in re.search(r"class lookup = \{([^}]*)\}", header)[1].split(",")][3:]  # without "nothing"
        igm = {name: np.fromfile(self.folder / f"out/{name}_igm.img", "<f8").reshape(3, rows, columns)
               for name, rows, columns in (("map", 30, 40), ("tilted", 40, 60))}
        with Browser(1600, 900) as browser:
            browser.open(self.folder / "x.html")
            names = browser.run("about.images.map(i => i.name)")
            for number, name in enumerate(names):
                columns = igm[name].shape[2]
                for row, column in ((5, 7), (20, 30)):
                    got = browser.run(f"geodeticOf(enuOf({number}, {row * columns + column}), about.images[{number}].origin)")
                    np.testing.assert_allclose(got[:2], igm[name][:2, row, column], atol=1e-7)
                    self.assertAlmostEqual(got[2], igm[name][2, row, column], delta=0.01)
            # A map: north is up, and the bar is as long as it says.
            browser.set("#images", names.index("map"))
            self.assertIn("rotate(0.0)", browser.run("document.getElementById('north').innerHTML").replace("-0.0", "0.0"))
            metres = browser.run("parseFloat(document.getElementById('scalebar').style.width) * 0.4 / state.zoom")
            text = browser.run("document.getElementById('scalebar').nextSibling.data")
            self.assertAlmostEqual(metres, float(text.split()[0]), delta=1e-3)
            # The camera looks 63 degrees from the north and 42 down, which shortens what lies ahead: atan(tan(63.4) / sin(41.8)).
            browser.set("#images", names.index("tilted"))
            turn = float(re.search(r"rotate\(([-0-9.]+)\)", browser.run("document.getElementById('north').innerHTML"))[1])
            self.assertAlmostEqual(turn, -71.6, delta=3)
            self.assertIn("sensor 'tilted'", browser.run("document.getElementById('losses').innerText"))
            # Thermal bands in kelvin and in their colours.
            self.assertTrue(browser.run("state.colours && inKelvin()"))
            low, high = browser.run("rangesShown() || percentiles([valuesOf(state.band).map(v => kelvinOf(image(), state.band, v))], 0, 100)")
            self.assertTrue(284 < low < 291 and 284 < high < 311, (low, high))
            self.assertIn("K", browser.run("document.getElementById('legend').innerText"))
            colours = [round(c) for i in range(2) for c in browser.run(f"classColour({i})")]
            self.assertLessEqual(max(abs(a - b) for a, b in zip(colours, lookup)), 1)
            self.keep(browser, "places")
            self.assertEqual(browser.faults, [])
        with Browser(1600, 900) as browser:
            browser.open(self.folder / "scene.html")
            self.assertEqual([round(c) for i in range(2) for c in browser.run(f"classColour({i})")], colours)
            # What is drawn is that colour, shaded: hues of the pixel on the box's top.
            self.assertEqual(browser.run("ui.when.value"), "2026-03-01T09:30")
            target = browser.run("add(view.target, about.middle)")
            self.assertLess(np.hypot(target[0] - 40, target[1] - 20), 1)
            self.assertLess(browser.run("view.distance"), 30)
            self.keep(browser, "near_the_tags")
            self.assertEqual(browser.faults, [])

    def test_layouts(self):
        make_cube(self.folder, 9, 60)
        page = self.show()
        for width, height in ((1600, 900), (1000, 800), (800, 900), (390, 844)):
            with Browser(width, height) as browser:
                browser.open(page)
                x, y, w, h = browser.box("#picture")
                browser.click(x + w / 3, y + h / 3)
                self.assertLessEqual(browser.run("document.documentElement.scrollWidth"), width)
                px, py, pw, ph = browser.box("#plot")
                if width >= 600:
                    self.assertGreaterEqual(px, x + w - 1, width)   # beside it
                    self.assertLess(py, y + h, width)
                else:
                    self.assertGreaterEqual(py, y + h - 1, width)   # below it
                self.keep(browser, f"layout_{width}")
                self.assertEqual(browser.faults, [])

    def test_ticks_have_the_digits_that_tell_them_apart(self):
        make_cube(self.folder, 3, 8)
        with Browser() as browser:
            browser.open(self.show())
            for low, high in ((300.01, 300.06), (1234567, 1234570), (1e-7, 3e-7), (0, 1), (-2e-3, 2e-3)):
                labels = browser.run(f"tickLabels({low}, {high}).map(t => [t.at, t.text])")
                self.assertEqual(len({text for _, text in labels}), len(labels))
                step = labels[1][0] - labels[0][0]
                for at, text in labels:
                    self.assertLess(abs(float(text) - at), 1e-3 * step, labels)

    def test_the_size_is_kept(self):
        make_cube(self.folder, 9, 100)
        for size in ("90KiB", "100KiB", "200KiB"):
            page = self.show("--view-size", size)
            self.assertLessEqual(page.stat().st_size, int(size[:-3]) << 10)
        done = view("-o", self.folder, "--view", self.folder / "y.html", "--view-size", "20KiB")
        self.assertEqual(done.returncode, 1)
        self.assertIn("give it more room", done.stderr)
        self.assertFalse((self.folder / "y.html").exists())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
