"""READMEs, pages of docs and notebooks run as they stand, and the way to a first spectrum is short."""
import contextlib
import io
import json
import os
import re
import resource
import unittest
import warnings

import remote_scenes as rs
from kit import ROOT, Case

BLOCK = re.compile(r"^```(python|console)\n(.*?)^```", re.S | re.M)
BLOCKS = BLOCK.findall((ROOT / "python/README.md").read_text())
SECONDS = 20  # of CPU, for a notebook


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
        pages = {page: [text for kind, text in blocks if kind == "python"] for page, blocks in pages.items()}
        self.assertGreater(sum(map(len, pages.values())), 0)
        self.in_folder()
        for page, parts in pages.items():
            with self.subTest(page.name):
                _, cpu = self.run_code(parts, page.name)
                self.assertLess(cpu, SECONDS)

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
