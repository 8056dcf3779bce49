"""READMEs, pages of docs and notebooks run as they stand, and the way to a first spectrum is short."""
import contextlib
import io
import json
import math
import os
import re
import resource
import shutil
import subprocess
import unittest
import warnings

import remote_scenes as rs
from kit import ROOT, Case

BLOCK = re.compile(r"^```(python|console)\n(.*?)^```", re.S | re.M)
BLOCKS = BLOCK.findall((ROOT / "python/README.md").read_text())
SECONDS = 20  # of CPU, for a notebook
OWN_FILES = "own_files.md"


def seconds():
    return sum(u.ru_utime + u.ru_stime for u in map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)))


class Documents(Case):
    def run_code(self, parts, name):
        """Runs texts one after the other in one namespace; what they print."""
        said, space, begun = io.StringIO(), {}, seconds()
        with contextlib.redirect_stdout(said), warnings.catch_warnings():
            warnings.simplefilter("error", rs.ProgramWarning)
            for i, part in enumerate(parts):
                exec(compile(part, f"{name}, part {i}", "exec"), space)
        return said.getvalue(), seconds() - begun

    def in_folder(self):
        before = os.getcwd()
        self.addCleanup(os.chdir, before)
        os.chdir(self.folder)

    def test_the_readme_runs(self):
        self.in_folder()
        said, _ = self.run_code([text for kind, text in BLOCKS if kind == "python"], "README.md")
        self.assertIn("materials.lawn.reflectence", said)
        self.assertIn("750 nm", said)
        self.assertTrue((self.folder / "chips/annotations.json").exists())

    def test_the_pages_of_docs_run(self):
        pages = {page: BLOCK.findall(page.read_text()) for page in sorted((ROOT / "docs").rglob("*.md"))}
        pages = {page: [text for kind, text in blocks if kind == "python"] for page, blocks in pages.items() if page.name != OWN_FILES}
        self.assertGreater(sum(map(len, pages.values())), 0)
        self.in_folder()
        for page, parts in pages.items():
            with self.subTest(page.name):
                _, cpu = self.run_code(parts, page.name)
                self.assertLess(cpu, SECONDS)

    @unittest.skipUnless(shutil.which("gdal_translate"), "needs gdal-bin")
    def test_the_page_on_own_files_makes_a_cube(self):
        """With a hill, a pyramid and two flat spectra in the place of a user's files, a tenth of the pixels to a side and two paths."""
        self.in_folder()
        section = (ROOT / "docs/guide" / OWN_FILES).read_text().split("\n## ")[1]
        name, text = re.search(r"^```yaml\n# (\S+)\n(.*?)^```", section, re.S | re.M).groups()
        (self.folder / name).write_text(text)
        heights = "\n".join(" ".join(f"{150 + 10 * math.sin(row / 5) * math.cos(column / 7):.2f}" for column in range(41)) for row in range(41))
        (self.folder / "dem.asc").write_text(f"ncols 41\nnrows 41\nxllcorner 475650\nyllcorner 5472900\ncellsize 50\n{heights}\n")
        subprocess.run(["gdal_translate", "-q", "-a_srs", "EPSG:25832", "dem.asc", "dem.tif"], check=True)
        (self.folder / "thing.obj").write_text("v -5 0 -5\nv 5 0 -5\nv 5 0 5\nv -5 0 5\nv 0 8 0\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nf 1 4 3 2\n")
        for kind, value in (("grass", 0.3), ("metal", 0.5)):
            (self.folder / f"{kind}.spectrum.txt").write_text("".join(f"{0.3 + 0.1 * i:.2f},{value}\n" for i in range(25)))
        code = re.search(r"^```python\n(.*?)^```", section, re.S | re.M)[1]
        small = code.replace("columns=120, rows=80, gsd_m=20", "columns=12, rows=8, gsd_m=200").replace('"pixel_m": 20', '"pixel_m": 200')
        small = small.replace("paths=16", "paths=2")
        self.assertEqual((small.count("200"), small.count("paths=2")), (2, 1))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", rs.ProgramWarning)  # bins that miss 0.1 % by little
            exec(compile(small, OWN_FILES, "exec"), {})
        told = json.loads(subprocess.run(["gdalinfo", "-json", "out/map_map.tif"], capture_output=True, text=True, check=True).stdout)
        self.assertEqual(len(told["bands"]), 60)
        self.assertIn('ID["EPSG",25832]', told["coordinateSystem"]["wkt"])
        self.assertEqual(told["geoTransform"][1], 200)
        self.assertEqual(told["geoTransform"][2], 0)  # north-up

    def test_the_main_readme_runs(self):
        self.in_folder()
        said, _ = self.run_code([text for _, text in BLOCK.findall((ROOT / "README.md").read_text())], "README.md")
        self.assertIn("750 nm", said)

    def test_a_first_spectrum_takes_ten_lines(self):
        self.assertEqual([kind for kind, _ in BLOCKS[:2]], ["console", "python"])
        lines = [line for _, text in BLOCKS[:2] for line in text.splitlines()]
        self.assertLessEqual(len(lines), 10)
        self.assertLessEqual(max(map(len, lines)), 132)
        self.in_folder()
        said, cpu = self.run_code([BLOCKS[1][1]], "README.md")
        values = re.findall(r"^(\d+) nm +([\d.]+)$", said, re.M)
        self.assertEqual(len(values), 26)
        self.assertGreater(float(dict(values)["750"]), 4 * float(dict(values)["670"]))
        self.assertLess(cpu, 60)

    def test_notebooks_run_and_carry_no_results(self):
        notebooks = sorted((ROOT / "python/notebooks").glob("*.ipynb"))
        self.assertEqual(len(notebooks), 6)
        for path in notebooks:
            with self.subTest(path.name):
                document = json.loads(path.read_text())
                self.assertEqual((document["nbformat"], document["nbformat_minor"]), (4, 5))
                cells = [c for c in document["cells"] if c["cell_type"] == "code"]
                self.assertEqual([c for c in cells if c["outputs"] or c["execution_count"]], [])
                quiet = [c for c in cells if "plot" not in c["metadata"].get("tags", [])]
                _, cpu = self.run_code(["".join(c["source"]) for c in quiet], path.name)
                self.assertLess(cpu, SECONDS)


if __name__ == "__main__":
    unittest.main()
