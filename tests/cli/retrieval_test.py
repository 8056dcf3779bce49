"""scripts/retrieval on the extract that ships: reflectance comes back from our tables. retrieval_test.py BUILD SOURCE FOLDER

Bounds: 0.004 where paths and table share the air; 0.02 over all windows of the targets in Pasadena, as required of such a retrieval. Negative
control: without correction the rendered ground is further off. (The targets in Pasadena are not: they are about as bright as the air over them.)
"""
import json
import pathlib
import subprocess
import sys
import unittest

BUILD, SOURCE, FOLDER = (pathlib.Path(p).resolve() for p in sys.argv[1:4])


class Retrieval(unittest.TestCase):
    def test_known_reflectance_comes_back(self):
        done = subprocess.run([sys.executable, "-B", SOURCE / "scripts/retrieval", "--data", SOURCE / "tests/data/real", "--build", BUILD, "--out", FOLDER],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = {(row["spectrum"], row["by"]): row["rmse"][-1] for row in json.loads((FOLDER / "rows.json").read_text())}
        for name, bound in (("rendered ground", 0.004), ("horse arena", 0.02), ("red field", 0.02)):
            print(f"{name}: {rows[name, 'algebra']:.4f}, without correction {rows[name, 'no correction']:.4f}")
            self.assertLess(rows[name, "algebra"], bound, name)
        self.assertGreater(rows["rendered ground", "no correction"], 0.01)

    def test_faults_are_named(self):
        done = subprocess.run([sys.executable, "-B", SOURCE / "scripts/retrieval", "--data", FOLDER / "nowhere"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("nowhere/pasadena is not there", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
