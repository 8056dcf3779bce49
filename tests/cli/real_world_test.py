"""scripts/real_world on the extract of measurements that ships: the stored figures, what has to be seen when an input is wrong, faults with
their place. real_world_test.py BUILD SOURCE FOLDER [--store]
"""
import csv
import json
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

BUILD, SOURCE, FOLDER = (pathlib.Path(p).resolve() for p in sys.argv[1:4])
DATA = SOURCE / "tests/data/real"
TOLERANCE = 0.02  # of a stored figure, and of its unit


def run(*words, data=DATA, out="out", code=0):
    done = subprocess.run([sys.executable, SOURCE / "scripts/real_world", "--build", BUILD, "--data", data, "--out", FOLDER / out, *words],
                          capture_output=True, text=True)
    assert done.returncode == code, (words, done.stdout, done.stderr)
    return done.stdout + done.stderr


def figures(out="out"):
    rows = json.loads((FOLDER / out / "rows.json").read_text())
    return {(name, row["place"], row["bands"]): row for name, many in rows.items() for row in many}


def changed(name, path, pattern, value):
    """A copy of the extract with a pattern of one file replaced."""
    copy = FOLDER / name
    shutil.copytree(DATA, copy)
    text = (copy / path).read_text()
    new = re.sub(pattern, value, text, flags=re.MULTILINE)
    assert new != text, (path, pattern)
    (copy / path).write_text(new)
    return copy


class RealWorld(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.said = run("--only", "pasadena,mfrsr,hytes")

    def test_the_stored_figures(self):
        found = figures()
        with open(DATA / "expected.csv") as file:
            stored = list(csv.DictReader(file))
        self.assertEqual(len(stored), len(found))
        for row in stored:
            now = found[row["data"], row["place"], row["bands"]]
            for key in ("bias", "rms"):
                self.assertAlmostEqual(now[key], float(row[key]), delta=TOLERANCE * (1 + abs(float(row[key]))), msg=(row["place"], key))

    def test_the_page_has_a_row_and_a_picture_for_each(self):
        page = (FOLDER / "out/real_world.md").read_text()
        self.assertEqual(page.count("\n| AVIRIS-NG |"), 2)
        for picture in re.findall(r"real_world/(\w+)\.svg", page):
            self.assertIn("<polyline" if "mfrsr" not in picture else "<circle", (FOLDER / "out" / (picture + ".svg")).read_text())

    def test_four_times_the_aerosol_is_seen(self):
        """Path radiance over the red field, which is dark."""
        wrong = changed("hazy", "pasadena/aod20171108_0C.txt", r"^(\d\s.*\s)0\.0(\d+)$", r"\g<1>0.3\2")
        run("--only", "pasadena", data=wrong, out="out_hazy")
        for key, row in figures("out_hazy").items():
            if "red field" in key[1]:
                self.assertGreater(row["details"]["windows"][0], 5 + next(v for k, v in figures().items() if k[1] == key[1])["details"]["windows"][0])

    def test_a_wrong_height_of_the_sun_is_seen(self):
        """Five degrees lower: the Langley plot of the morning no longer fits the diffuse light."""
        copy = FOLDER / "low_sun"
        shutil.copytree(DATA, copy)
        lines = (copy / "mfrsr/extract.csv").read_text().splitlines()
        low = ["%s,%.4f,%s" % (h, float(z) + 5, rest) for h, z, rest in (line.split(",", 2) for line in lines[2:])]
        (copy / "mfrsr/extract.csv").write_text("\n".join(lines[:2] + low) + "\n")
        run("--only", "mfrsr", data=copy, out="out_low_sun")
        for key, row in figures("out_low_sun").items():
            right = next(v for k, v in figures().items() if k[:2] == key[:2])
            self.assertGreater(row["rms"], 1.5 * right["rms"], key)

    def test_faults_have_their_place(self):
        self.assertRegex(run("--only", "pasadna", code=2), "no data set 'pasadna'; there are: pasadena, mfrsr")
        self.assertRegex(run("--paths", "0", code=2), "give 1 or more")
        self.assertRegex(run(data=FOLDER / "nowhere", code=2), "no folder")
        broken = changed("broken", "pasadena/wavelength_fit.txt", r"^(\d+\s+)0\.43\d*", r"\g<1>word")
        self.assertRegex(run("--only", "pasadena", data=broken, out="out_broken", code=1), r"wavelength_fit.txt: not a table of numbers")
        (FOLDER / "broken/mfrsr/extract.csv").write_text("hours_utc,zenith_deg\n14,60\n")
        self.assertRegex(run("--only", "mfrsr", data=FOLDER / "broken", out="out_broken", code=1), "mfrsr: what stands in .*direct_1")
        self.assertRegex(run("--continuum", FOLDER / "none.csv", code=1), "--continuum: no file")
        shutil.rmtree(FOLDER / "broken/hytes")
        self.assertRegex(run("--only", "hytes", data=FOLDER / "broken", out="out_broken", code=1), "hytes is not there")


def store():
    run("--only", "pasadena,mfrsr,hytes")
    with open(DATA / "expected.csv", "w") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["data", "place", "bands", "bias", "rms", "fitted"])
        for (name, place, bands), row in figures().items():
            table.writerow([name, place, bands, "%.4f" % row["bias"], "%.4f" % row["rms"], row["fitted"]])


if __name__ == "__main__":
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    if "--store" in sys.argv:
        store()
    else:
        unittest.main(argv=sys.argv[:1])
