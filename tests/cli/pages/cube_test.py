"""The page of dirsig-render --view in a browser: what it shows is what the images hold, and it asks nobody for anything."""
import json
import os
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import numpy as np
from browser import Browser, local_only

BIN = Path(os.environ["SUITE_BIN"])
KEEP = os.environ.get("SUITE_KEEP")  # a folder for screenshots and pages, for people to look at
SCENE = """scene: 1
name: yard
materials:
  grass: {model: lambert, reflectance: 0.3}
  tin: {model: lambert, reflectance: 0.6}
objects:
  lawn: {plane: {}, material: grass}
  box: {box: {x0: -2, y0: -2, z0: 0, x1: 2, y1: 2, z1: 3}, material: tin}
world: [{place: lawn}, {place: box, tag: shed}]
"""


def write_envi(path, array, extra, kind):
    """array: [band][line][sample], little-endian as it is."""
    bands, lines, samples = array.shape
    array.tofile(path)
    head = (f"ENVI\nsamples = {samples}\nlines = {lines}\nbands = {bands}\nheader offset = 0\nfile type = ENVI Standard\n"
            f"data type = {kind}\ninterleave = bsq\nbyte order = 0\n{extra}")
    Path(f"{path}.hdr").write_text(head)


def make_cube(folder, bands, size, seed=7):
    """A folder like that of a run: a scene of waves, dark to bright over three decades, with errors and flags."""
    rng = np.random.default_rng(seed)
    y, x = np.mgrid[0:size, 0:size] / size
    um = np.linspace(0.4, 2.5, bands)
    shape = 10 ** (3 * x[None] - 2) * (1.2 + np.sin(9 * y[None] + 4 * um[:, None, None]))
    noise = rng.standard_normal((bands, size, size), dtype=np.float32)
    values = (shape * (1 + 0.01 * noise)).astype("<f4")
    errors = (0.01 * shape).astype("<f4")
    common = "description = {%s of sensor 'cam'\nsuite 0: dirsig-render sim.yaml -o out}\n"
    lists = (f"wavelength units = Micrometers\nwavelength = {{{', '.join(f'{v:.6f}' for v in um)}}}\n"
             f"band names = {{{', '.join(f'b{i}' for i in range(bands))}}}\n"
             f"data units = W/(m2 sr um)\ndefault bands = {{{bands // 2}, {bands // 3}, {bands // 5 or 1}}}\n")
    write_envi(folder / "cam.img", values, common % "radiance" + lists, 4)
    write_envi(folder / "cam_error.img", errors,
               common % "standard error; an interval of 95 % reaches 2.18 standard errors to either side," + lists, 4)
    flags = (rng.random((1, size, size)) < 0.02).astype("u1")
    write_envi(folder / "cam_quality.img", flags, common % "quality", 1)
    return values, errors, flags


def view(*arguments, **more):
    return subprocess.run([BIN / "dirsig-render", *map(str, arguments)], capture_output=True, text=True, **more)


class CubePage(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def keep(self, browser, name):
        if KEEP:
            browser.screenshot(Path(KEEP) / f"{name}.png")

    def click_pixel(self, browser, column, row, columns, rows, **more):
        x, y, width, height = browser.box("#picture")
        browser.click(x + (column + 0.5) * width / columns, y + (row + 0.5) * height / rows, **more)

    def picked(self, browser, number=-1):
        """Value and error of every band of a chosen pixel, as the page has them."""
        points = browser.run(f"state.picks.at({number}).spectrum.points.map(p => [p.band, p.value, p.error])")
        return np.array(sorted(points)).T[1:]

    def test_a_rendered_folder(self):
        (self.folder / "scene.yaml").write_text(SCENE)
        subprocess.run([BIN / "scene-prep", "scene.yaml", "-o", "scene.h5", "-q"], cwd=self.folder, check=True)
        bands = ", ".join(f"{{name: {n}, center_um: {c}, fwhm_um: 0.04}}" for n, c in
                          (("blue", 0.45), ("green", 0.55), ("red", 0.65), ("nir", 0.85)))
        (self.folder / "sim.yaml").write_text(f"""scene: scene.h5
sun: {{direction: {{zenith_deg: 40, azimuth_deg: 150}}, irradiance: 1500}}
sky: {{radiance: 60}}
sensors:
  - {{name: cam, kind: orthographic, columns: 40, rows: 30, gsd_m: 0.4, center_m: [0, 0], paths: 16, bands: [{bands}],
     truth: [material, tag, range, location, paths]}}
""")
        done = view("sim.yaml", "-o", "out", "--view", "pages/out.html", "-q", cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        again = view("-o", "out", "--view", "again.html", "-q", cwd=self.folder)
        self.assertEqual(again.returncode, 0, again.stderr)
        values = np.fromfile(self.folder / "out/cam.img", "<f4").reshape(4, 30, 40)
        errors = np.fromfile(self.folder / "out/cam_error.img", "<f4").reshape(4, 30, 40)
        with Browser() as browser:
            browser.open(self.folder / "pages/out.html")
            self.click_pixel(browser, 20, 14, 40, 30)
            got = self.picked(browser)
            np.testing.assert_allclose(got[0], values[:, 14, 20], rtol=2 ** -11)
            np.testing.assert_allclose(got[1], errors[:, 14, 20], rtol=0.03)
            self.click_pixel(browser, 3, 2, 40, 30, modifiers=8)  # Shift: one more
            self.assertEqual(browser.run("state.picks.length"), 2)
            self.assertEqual(browser.run("document.querySelectorAll('#plot svg .spectrum').length"), 2)
            table = browser.run("document.getElementById('table').innerText")
            for word in ("tin", "grass", "shed"):
                self.assertIn(word, table)
            self.assertIn("W/(m2 sr um)", browser.run("document.getElementById('legend').innerText"))
            picture = "document.getElementById('picture').toDataURL()"
            first = browser.run(picture)
            browser.set("#band", 3)
            self.assertNotEqual(browser.run(picture), first)
            self.assertIn("nir", browser.run("document.getElementById('bandName').textContent"))
            before = browser.run("document.getElementById('overlay').toDataURL()")
            for over in ("q", "t0", "t2"):
                browser.set("#over", over)
                self.assertNotEqual(browser.run("document.getElementById('keys').innerText"), "")
            self.assertNotEqual(browser.run("document.getElementById('overlay').toDataURL()"), before)
            browser.set("#over", "t0")
            self.keep(browser, "cube_rendered")
            self.assertEqual(browser.faults, [])
            self.assertTrue(local_only(browser.requests), browser.requests)

    def test_the_picture_is_that_of_the_numbers(self):
        values, _, _ = make_cube(self.folder, 5, 32)
        done = view("-o", self.folder, "--view", self.folder / "x.html", "-q")
        self.assertEqual(done.returncode, 0, done.stderr)
        with Browser() as browser:
            browser.open(self.folder / "x.html")
            browser.set("#band", 4)
            browser.set("#low", 0)
            browser.set("#high", 100)
            browser.run("document.getElementById('srgb').click()")
            grey = np.array(browser.run("Array.from(ui.canvas.getContext('2d').getImageData(0, 0, 32, 32).data)"))
            low, high = values[4].min(), values[4].max()
            wanted = 255 * (values[4] - low) / (high - low)
            self.assertLess(np.abs(grey.reshape(32, 32, 4)[..., 0] - wanted).max(), 1.5)
            # Flags are counted, and drawn where they are.
            browser.set("#over", "q")
            flags = np.fromfile(self.folder / "cam_quality.img", "u1")
            self.assertIn(f"heavy_tail: {flags.sum()} of {flags.size}", browser.run("document.getElementById('keys').innerText"))
            drawn = np.array(browser.run("Array.from(ui.over.getContext('2d').getImageData(0, 0, 32, 32).data)")).reshape(-1, 4)
            np.testing.assert_array_equal(drawn[:, 3] > 0, flags > 0)
            self.assertEqual(browser.faults, [])

    def test_every_number_is_the_binary16_of_the_file(self):
        """What steps between neighbours and bands lose: nothing, in all bands and pixels, whatever stands in them."""
        values, errors, _ = make_cube(self.folder, 21, 37)  # no multiples of 64 and 8
        rng = np.random.default_rng(3)
        values[rng.random(values.shape) < 0.05] *= -1e-3
        values[rng.random(values.shape) < 0.02] = np.nan
        values[4, 5:9], values[5], errors[7], errors[8, ::3] = np.inf, 0, np.nan, 0
        values.tofile(self.folder / "cam.img")
        errors.tofile(self.folder / "cam_error.img")
        done = view("-o", self.folder, "--view", self.folder / "x.html", "-q")
        self.assertEqual(done.returncode, 0, done.stderr)
        with Browser() as browser:
            browser.open(self.folder / "x.html")
            for band in range(21):
                listed = browser.run(f"Array.from(numbersKept('i0.v{band}'), String)")
                got = np.array([float(v.replace("Infinity", "inf")) for v in listed])
                plain = values[band].ravel()
                finite = np.abs(plain[np.isfinite(plain)]).max()
                first = np.floor(np.log2(finite)) - 14 if finite else 0
                np.testing.assert_array_equal(got, (plain / 2 ** first).astype(np.float16).astype(float) * 2 ** first)
                single = browser.run(f"Array.from({{length: 37 * 37}}, (_, i) => String(numberAt('i0.v{band}', i)))")
                self.assertEqual(single, listed)
                listed = browser.run(f"Array.from(numbersKept('i0.e{band}'), String)")
                got, wanted = np.array([float(v) for v in listed]), errors[band].ravel()
                np.testing.assert_allclose(got, wanted, rtol=0.03)
                self.assertTrue(((got == 0) == (wanted == 0)).all())
            self.assertEqual(browser.faults, [])

    def test_224_bands(self):
        """Of 512 x 512 pixels with SUITE_LONG, of a quarter without: a page a quarter as large."""
        size = 512 if os.environ.get("SUITE_LONG") else 256
        values, errors, _ = make_cube(self.folder, 224, size)
        page = Path(KEEP or self.folder) / "big.html"
        done = view("-o", self.folder, "--view", page, "-q")
        self.assertEqual(done.returncode, 0, done.stderr)
        # 24 bits a value and its error took 224 MiB; waves under noise of 1 % take 10 bits.
        self.assertLess(page.stat().st_size, 100 * 4 * size ** 2)
        with Browser() as browser:
            begin = time.monotonic()
            browser.open(page)
            seconds = time.monotonic() - begin
            cpu = browser.cpu_seconds()
            picture, ready = browser.when("window.pictureAt") / 1000, browser.when("window.readyAt") / 1000
            begin = time.monotonic()
            self.click_pixel(browser, 150, 100, size, size)
            got = self.picked(browser)
            click = time.monotonic() - begin
            print(f"{page.stat().st_size / 2 ** 20:.0f} MiB: picture after {picture:.3f} s, all after {ready:.3f} s "
                  f"(opened in {seconds:.2f} s, {cpu:.2f} s of CPU), a spectrum in {click:.2f} s")
            column, row = browser.run("[state.picks[0].column, state.picks[0].row]")
            self.assertLessEqual(max(abs(column - 150), abs(row - 100)), 1)  # places of clicks are whole pixels of the window
            np.testing.assert_allclose(got[0], values[:, row, column], rtol=2 ** -11)
            np.testing.assert_allclose(got[1], errors[:, row, column], rtol=0.03)
            self.keep(browser, "cube_big")
            # The first picture waits for nothing but its own bands; when the browser paints it is up to the machine's load.
            content = page.read_bytes()
            self.assertLess(content.index(b"<script>begin();"), 0.05 * len(content))
            if os.environ.get("SUITE_LONG"):  # a bound of seconds is one of the machine, too
                self.assertLess(cpu, 3)
                self.assertLess(picture, ready)
            self.assertEqual(browser.faults, [])

    def test_what_does_not_fit_is_told(self):
        values, _, _ = make_cube(self.folder, 9, 100)
        page = self.folder / "x.html"
        done = view("-o", self.folder, "--view", page, "--view-size", "180KiB")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("one in 2 columns and rows", done.stderr)
        with Browser() as browser:
            browser.open(page)
            self.assertIn("Only one in 2 columns and rows", browser.run("document.getElementById('losses').innerText"))
            self.click_pixel(browser, 10, 20, 50, 50)
            np.testing.assert_allclose(self.picked(browser)[0], values[:, 40, 20], rtol=2 ** -11)
            self.assertEqual(browser.faults, [])

    def test_refusals(self):
        def fails(code, text, *arguments):
            done = view(*arguments)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(text, done.stderr)
            self.assertEqual(len(done.stderr.splitlines()), 1 + (code == 2), done.stderr)
            self.assertFalse((self.folder / "x.html").exists())
        page = self.folder / "x.html"
        fails(1, "no image", "-o", self.folder, "--view", page)
        fails(1, "no folder of results", "-o", self.folder / "none", "--view", page)
        make_cube(self.folder, 3, 8)
        fails(2, "--paths", "-o", self.folder, "--view", page, "--paths", "3")
        fails(2, "--view-size", "-o", self.folder, "--view", page, "--view-size", "12")
        fails(1, "--view-size", "-o", self.folder, "--view", page, "--view-size", "0KiB")
        (self.folder / "cam_error.img").write_bytes(b"")
        fails(1, "cam_error.img", "-o", self.folder, "--view", page)

    def test_the_test_sees_faults(self):
        """Negative control: a page that throws, complains and asks the network is found out."""
        page = self.folder / "bad.html"
        page.write_text("<link rel=icon href='data:,'><img src='http://127.0.0.1:9/x.png'>"
                        "<script>console.error('a'); undefinedName();</script>")
        with Browser() as browser:
            browser.open(page)
            self.assertGreaterEqual(len(browser.faults), 3, browser.faults)
            self.assertFalse(local_only(browser.requests))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
