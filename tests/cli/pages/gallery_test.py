"""The gallery of the sample scenes in a browser: every picture is there, and it stands alone."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from browser import Browser, local_only

ROOT = Path(__file__).resolve().parents[3]


class Gallery(unittest.TestCase):
    def test_all_samples_are_shown(self):
        samples = sorted(p.parent.name for p in (ROOT / "sample_scenes").glob("*/README.md"))
        with tempfile.TemporaryDirectory() as folder:
            page = Path(folder) / "gallery.html"
            subprocess.run([ROOT / "scripts/gallery", page], check=True, capture_output=True)
            with Browser() as browser:
                browser.open(page)
                self.assertEqual(browser.run("[...document.querySelectorAll('article')].map(a => a.id)"), samples)
                self.assertTrue(browser.run("[...document.querySelectorAll('article')].every(a => [...a.querySelectorAll('img')].length > 0"
                                            " && [...a.querySelectorAll('img')].every(i => i.naturalWidth > 0))"))
                self.assertEqual(browser.faults, [])
                self.assertTrue(local_only(browser.requests), browser.requests)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
