"""The page of scene-prep --view in a browser: what a click tells is what a ray meets, and markers stand where faults are."""
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from browser import Browser, local_only

BIN = Path(os.environ["SUITE_BIN"])
KEEP = os.environ.get("SUITE_KEEP")
SCENE = """scene: 1
name: yard
origin: {latitude_deg: 49.4, longitude_deg: 8.7, height_m: 120}
materials:
  grass: {model: lambert, reflectance: 0.3}
  tin: {model: lambert, reflectance: 0.5}
  paint: {model: lambert, reflectance: 0.7}
objects:
  lawn: {plane: {width: 60, depth: 40}, material: grass}
  ball: {sphere: {radius: 3}, material: tin}
  roof: {obj: roof.obj, material: tin}
world:
  - {place: lawn}
  - {place: ball, translate: [0, 0, 3], tag: dome}
  - {place: roof, translate: [15, 5, 2], tag: shed}
  - {place: roof, translate: [-15, 5, 2], tag: painted, material: paint}
"""
# A slope, and a sliver of height 0.0005 at (0, 6, 0).
ROOF = "v -4 -4 0\nv 4 -4 0\nv 4 4 3\nv -4 4 3\nv -1 6 0\nv 1 6 0\nv 0 6.0005 0\nf 1 2 3\nf 1 3 4\nf 5 6 7\n"


def prep(*arguments, **more):
    return subprocess.run([BIN / "scene-prep", *map(str, arguments)], capture_output=True, text=True, **more)


class ScenePage(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def write_yard(self):
        (self.folder / "scene.yaml").write_text(SCENE)
        (self.folder / "roof.obj").write_text(ROOF)

    def settle(self, browser):
        browser.run("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def click_on(self, browser, enu):
        """Clicks where a place is seen."""
        x, y, _, _ = browser.box("#picture")
        at = browser.run(f"windowOf(cameraOf(view, ui.canvas.width, ui.canvas.height), sub({list(enu)}, about.middle))")
        browser.click(x + at[0], y + at[1])
        self.settle(browser)
        return browser.run("state.hit")

    def test_what_is_clicked_on(self):
        self.write_yard()
        done = prep("scene.yaml", "-o", "scene.h5", "--view", "pages/yard.html", cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        with Browser() as browser:
            browser.open(self.folder / "pages/yard.html")
            self.settle(browser)
            browser.run("view.elevation = 80, view.azimuth = 180, view.distance = 90, draw()")
            for enu, name, material, tag in (([10, -15, 0], "lawn", "grass", "none"), ([0, 0, 6], "ball", "tin", "dome"),
                                             ([15, 5, 3.5], "roof", "tin", "shed"), ([-15, 5, 3.5], "roof", "paint", "painted")):
                hit = self.click_on(browser, enu)
                self.assertEqual((hit["object"], hit["material"], hit["tag"]), (name, material, tag))
                for got, wanted in zip(hit["place"][:2], enu):
                    self.assertAlmostEqual(got, wanted, delta=0.15)  # a pixel is 0.09 m wide
                ray = prep("scene.h5", "--raycast", " ".join(map(str, [*hit["place"][:2], 50, 0, 0, -1])), cwd=self.folder).stdout
                self.assertIn(f"object    {name} (instance {hit['instance']})", ray)
                self.assertIn(f"material  {material}", ray)
                up = float(re.search(r"place +\S+ \S+ (\S+) m", ray)[1])
                self.assertAlmostEqual(hit["place"][2], up, delta=0.02)  # a ball of 48 by 24 facets is up to 13 mm too small
            # The sliver is marked on both roofs, and both marks stand on it.
            places = browser.run("state.findings.filter(f => f.text.includes('SP303')).flatMap(f => f.places.map(p => add(p, about.middle)))")
            self.assertEqual(len(places), 2)
            for got, wanted in zip(sorted(places), ([-15, 11, 2], [15, 11, 2])):
                for a, b in zip(got, wanted):
                    self.assertAlmostEqual(a, b, delta=0.01)
            self.assertIn("roof.obj:10", browser.run("document.getElementById('findings').innerText"))
            # Turning changes the picture; the colours follow the material that is clicked on.
            before = browser.run("ui.canvas.toDataURL()")
            x, y, width, height = browser.box("#picture")
            browser.drag(x + width / 2, y + height / 3, 120, -40)
            self.settle(browser)
            self.assertNotEqual(browser.run("ui.canvas.toDataURL()"), before)
            browser.set("#colour", "tag")
            self.assertIn("painted", browser.run("document.getElementById('keys').innerText"))
            self.settle(browser)
            if KEEP:
                browser.screenshot(Path(KEEP) / "scene.png")
            self.assertEqual(browser.faults, [])
            self.assertTrue(local_only(browser.requests), browser.requests)

    def test_the_sun_stands_where_the_renderer_has_it(self):
        self.write_yard()
        self.assertEqual(prep("scene.yaml", "-o", "scene.h5", "--view", "yard.html", "-q", cwd=self.folder).returncode, 0)
        with Browser() as browser:
            browser.open(self.folder / "yard.html")
            for utc in ("2026-06-21T10:30", "2030-12-01T07:45"):
                (self.folder / "sim.yaml").write_text(
                    f"scene: scene.h5\nepoch: '{utc}:00Z'\nsun: {{direction: {{time_utc: '{utc}:00Z'}}}}\nsensors:\n"
                    "  - {name: cam, kind: orthographic, columns: 1, rows: 1, gsd_m: 1, center_m: [0, 0], paths: 4, bands: [{name: g, center_um: 0.55, fwhm_um: 0.02}]}\n")
                done = subprocess.run([BIN / "dirsig-render", "sim.yaml", "-o", "out", "-q"], cwd=self.folder, capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, done.stderr)
                header = (self.folder / "out/cam.img.hdr").read_text()
                browser.set("#when", utc)
                sun = browser.run("state.sunAt")
                for key in ("azimuth", "elevation"):
                    self.assertAlmostEqual(sun[key], float(re.search(rf"sun {key} = (\S+)", header)[1]), delta=0.03)
            self.assertEqual(browser.faults, [])

    def test_a_scene_without_a_date_begins_by_day(self):
        self.write_yard()
        text = (self.folder / "scene.yaml").read_text()
        self.assertNotIn("epoch", text)
        for longitude in (-104.65, 8.7, 151.2):
            (self.folder / "far.yaml").write_text(re.sub(r"longitude_deg: [-0-9.]+", f"longitude_deg: {longitude}", text))
            self.assertEqual(prep("far.yaml", "-o", "far.h5", "--view", "far.html", "-q", cwd=self.folder).returncode, 0)
            with Browser() as browser:
                browser.open(self.folder / "far.html")
                sun = browser.run("state.sunAt")
                self.assertGreater(sun["elevation"], 30)
                self.assertAlmostEqual(sun["azimuth"], 180, delta=10)  # noon by the sun, but for the equation of time

    def test_a_large_mesh_and_many_instances_stay_small(self):
        n = 800  # 1.3 million triangles, twice as many as a page holds
        with open(self.folder / "hill.obj", "w", encoding="ascii") as f:
            f.writelines(f"v {i % n} {i // n} {20 * ((i % n) / n) ** 2:.4f}\n" for i in range(n * n))
            f.writelines(f"f {r * n + c + 1} {r * n + c + 2} {r * n + c + n + 2}\nf {r * n + c + 1} {r * n + c + n + 2} {r * n + c + n + 1}\n"
                         for r in range(n - 1) for c in range(n - 1))
        (self.folder / "scene.yaml").write_text("""scene: 1
name: hill
materials: {grass: {model: lambert, reflectance: 0.3}}
objects: {hill: {obj: hill.obj, material: grass}, pin: {sphere: {radius: 0.2}, material: grass}}
groups: {row: [%s]}
world: [{place: hill}, %s]
""" % (", ".join(f"{{place: pin, translate: [{i}, 0, 30]}}" for i in range(400)),
            ", ".join(f"{{place: row, translate: [0, {i}, 0]}}" for i in range(300))))
        page = Path(KEEP or self.folder) / "hill.html"
        done = prep("scene.yaml", "-o", "scene.h5", "--no-crossing-check", "--view", page, cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(f"of {2 * (n - 1) ** 2 + 2 * 8 * 4} triangles", done.stderr)
        self.assertIn("one in 3 of the 120001 instances", done.stderr)
        self.assertLess(page.stat().st_size, 20e6)
        with Browser() as browser:
            browser.open(page)
            self.settle(browser)
            print(f"{page.stat().st_size / 1e6:.1f} MB: {browser.when('window.readyAt') / 1000:.2f} s, {browser.cpu_seconds():.2f} s of CPU")
            lacks = browser.run("document.getElementById('lacks').innerText")
            moved = float(re.search(r"moved by up to (\S+) m", lacks)[1])
            self.assertLess(moved, 3)  # cells of some two metres
            self.assertIn("one in 3 of the 120001", lacks)
            # A parabola is still one: heights within the slope times what moved.
            browser.run("view.elevation = 89.9, draw()")
            hit = self.click_on(browser, [500.5, 200.5, 20 * (500.5 / n) ** 2])
            self.assertIn(hit["object"], ("hill", "pin"))
            self.assertAlmostEqual(hit["place"][2] if hit["object"] == "hill" else 8.1, 20 * (hit["place"][0] / n) ** 2 if hit["object"] == "hill" else 8.1, delta=0.1)
            if KEEP:
                browser.screenshot(Path(KEEP) / "hill.png")
            self.assertEqual(browser.faults, [])

    def test_refusals(self):
        self.write_yard()
        page = self.folder / "x.html"
        done = prep(self.folder / "none.h5", "--view", page)
        self.assertEqual(done.returncode, 1, done.stderr)
        done = prep(self.folder / "scene.yaml", "--view", self.folder / "roof.obj")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual((self.folder / "roof.obj").read_text(), ROOF)
        self.assertFalse(page.exists())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
