"""The page of sqt-inspect --view in a browser: cells and values are those of the file."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from browser import Browser, local_only

BIN = Path(os.environ["SUITE_BIN"])
KEEP = os.environ.get("SUITE_KEEP")


def run(program, *arguments, **more):
    return subprocess.run([BIN / program, *map(str, arguments)], capture_output=True, text=True, **more)


class LobePage(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_a_glossy_lobe(self):
        fitted = run("sqt-fit", "--model", "ward:diffuse=0.1,specular=0.2,roughness=0.15", "-o", "ward.sqt", "-q", cwd=self.folder)
        self.assertEqual(fitted.returncode, 0, fitted.stderr)
        done = run("sqt-inspect", "ward.sqt", "--view", "pages/lobe.html", cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        page = self.folder / "pages/lobe.html"
        self.assertLess(page.stat().st_size, 21e6)
        with Browser() as browser:
            browser.open(page)
            first = browser.run("ui.canvas.toDataURL()")
            views = browser.run("about.views.length")
            self.assertGreater(views, 3)
            browser.set("#view", views // 2)
            self.assertNotEqual(browser.run("ui.canvas.toDataURL()"), first)
            # All masses are those of draws, which are sure to go somewhere or fail.
            self.assertAlmostEqual(browser.run("cells.masses.reduce((s, m) => s + m, 0)"), 1, delta=0.02)
            # The value at a cell's corner, above the horizon, is what the program answers there.
            theta, phi = browser.run(f"[about.views[{views // 2}].theta, about.views[{views // 2}].phi]")
            um = browser.run("about.channels[0]")
            corners = browser.run("[...Array(cells.count).keys()].filter(i => corner(i, 0)[2] > 0.3).slice(0, 400).filter((_, k) => k % 50 === 0)"
                                  ".map(i => [Math.acos(corner(i, 0)[2]) * 180 / Math.PI, Math.atan2(corner(i, 0)[1], corner(i, 0)[0]) * 180 / Math.PI, cells.values[5 * i]])")
            self.assertGreaterEqual(len(corners), 3)
            near = 0
            for zenith, azimuth, value in corners:
                answer = run("sqt-inspect", "ward.sqt", "--eval", f"{theta},{phi},{zenith},{azimuth},{um}", cwd=self.folder).stdout
                f = float(answer.split("f_per_sr")[1].split()[0])
                # At a corner four cells meet; rounding of the direction may choose another one.
                near += abs(value - f) <= 2e-3 * f
            self.assertGreaterEqual(near, len(corners) // 2)
            # A click on the lobe tells of its cell.
            x, y, _, _ = browser.box("#picture")
            place = browser.run("(() => { const s = shapes.at(-1); return [0, 1].map(k => s.points.reduce((sum, p) => sum + p[k], 0) / 4); })()")
            browser.click(x + place[0], y + place[1])
            self.assertIn("a draw lands in it", browser.run("document.getElementById('picked').innerText"))
            for scale in ("linear", "log", "sphere", "root"):
                before = browser.run("ui.canvas.toDataURL()")
                browser.set("#scale", scale)
                self.assertNotEqual(browser.run("ui.canvas.toDataURL()"), before)
            box = browser.box("#picture")
            before = browser.run("ui.canvas.toDataURL()")
            browser.drag(box[0] + 200, box[1] + 200, 90, 20)
            self.assertNotEqual(browser.run("ui.canvas.toDataURL()"), before)
            # The curve has the signs of the plot that sqt-inspect makes: the mirror direction is on the negative side.
            peak = browser.run("profilesOfView()[0].reduce((a, b) => b[1] > a[1] ? b : a)[0]")
            self.assertGreater(theta, 5)
            self.assertLess(peak, 0)
            if KEEP:
                browser.screenshot(Path(KEEP) / "lobe.png")
            # No text of the curve is cut where a phone's width is all that there is.
            browser.run("ui.profile.style.width = '374px'; drawProfile()")
            cut = browser.run("[...document.querySelectorAll('#profile text')].filter(t => { const b = t.getBoundingClientRect(), s = t.ownerSVGElement"
                              ".getBoundingClientRect(); return b.left < s.left || b.right > s.right; }).map(t => t.textContent)")
            self.assertEqual(cut, [])
            self.assertGreater(browser.run("document.querySelectorAll('#profile text').length"), 8)
            self.assertEqual(browser.faults, [])
            self.assertTrue(local_only(browser.requests), browser.requests)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
