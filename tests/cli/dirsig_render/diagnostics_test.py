"""Diagnostics as a user meets them: their codes in the text, muted, in render.json and in the list; every code is in the
list of some test. diagnostics_test.py BIN SOURCES FOLDER
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

BIN, SOURCES, FOLDER = (pathlib.Path(p).resolve() for p in sys.argv[1:4])

SCENE = """scene: 1
origin: {latitude_deg: 43.1, longitude_deg: -77.6, height_m: 120}
materials:
  ground:
    model: lambert
    reflectance: {points: [[0.4, 0.2], [0.7, 0.3], [0.75, 0], [14, 0]], outside: hold}
    temperature: {model: constant, kelvin: 300}
objects:
  plane: {plane: {width: 4000, depth: 4000}, material: ground}
world:
  - {place: plane}
"""
ROOF = """scene: 1
origin: {latitude_deg: 39.83, longitude_deg: -104.65, height_m: 1650}
materials:
  concrete:
    model: lambert
    reflectance: {points: [[0.4, 0.2], [0.7, 0.3]], outside: hold}
    thermal: {thickness_m: 0.2, density_kg_m3: 2300, specific_heat_j_kg_k: 900, conductivity_w_m_k: 1.4}
    temperature: {model: heat}
  edge: {inside: mist}
media:
  mist: {extinction: 0.01, albedo: 0.5}
objects:
  cloud: {box: {x0: -2, y0: -2, z0: 5, x1: 2, y1: 2, z1: 6}, material: edge}
  yard: {plane: {width: 20, depth: 20}, material: concrete}
  wall: {box: {x0: -1, y0: -1, z0: 0, x1: 1, y1: 1, z1: 3}, material: concrete}
world:
  - {place: cloud}
  - {place: yard}
  - {place: wall}
"""
# A wide yard that air does not warm, under a sky far colder than the air: elements that are left out are put as warm as
# the air, and what is in view is much colder.
COLD_YARD = """scene: 1
origin: {latitude_deg: 39.83, longitude_deg: -104.65, height_m: 1650}
materials:
  concrete:
    model: lambert
    reflectance: {points: [[0.4, 0.2], [0.7, 0.3], [4, 0.1], [30, 0.1]], outside: hold}
    thermal: {thickness_m: 0.002, density_kg_m3: 2300, specific_heat_j_kg_k: 900, conductivity_w_m_k: 1.4}
    temperature: {model: heat, convection: none}
objects:
  yard: {plane: {width: 20, depth: 20}, material: concrete}
  wall: {box: {x0: 8, y0: -1, z0: 0, x1: 9, y1: 1, z1: 3}, material: concrete}
world:
  - {place: yard}
  - {place: wall}
"""
# Provoked by no test.
NOT_PROVOKED = []
SUN = "sun: {direction: {zenith_deg: 40, azimuth_deg: 90}, irradiance: 1000}\n"
RED = "[{name: red, center_um: 0.6, fwhm_um: 0.05, shape: rectangular}]"
WARM = "[{name: warm, center_um: 10, fwhm_um: 1, shape: rectangular}]"


def camera(bands=RED, more="", kind="frame_camera", position="[0, -20, 30]"):
    return (f"sensors:\n  - {{kind: {kind}, name: eye, columns: 8, rows: 6, pitch_um: 100, focal_length_mm: 50, position_m: "
            f"{position}, look_at_m: [0, 0, 0], paths: 4, bands: {bands}{more}}}\n")


def heat(keys=", paths: 8"):
    return ("epoch: 2001-07-14T07:00:00Z\nweather: {file: denver.epw, year: 2001}\n"
            f"heat: {{elements: 12, step_s: 1800{keys}}}\n" + camera(WARM, ", time_s: 43200"))


class Diagnostics(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(FOLDER, ignore_errors=True)
        FOLDER.mkdir(parents=True)
        shutil.copy(SOURCES / "sample_scenes/summer_street/denver_july.epw", FOLDER / "denver.epw")
        for name, text in (("scene", SCENE), ("cold", SCENE.replace("    temperature: {model: constant, kelvin: 300}\n", "")), ("roof", ROOF),
                           ("yard", COLD_YARD), ("mild", COLD_YARD.replace("convection: none", "convection: mcadams"))):
            (FOLDER / f"{name}.yaml").write_text(text)
            cls.run_program("scene-prep", f"{name}.yaml", "-o", f"{name}.h5", "-q")

    @classmethod
    def run_program(cls, program, *arguments):
        done = subprocess.run([BIN / program, *arguments], cwd=FOLDER, capture_output=True, text=True, timeout=120)
        if done.returncode:
            raise AssertionError(done.stderr)
        return done.stderr if program == "dirsig-render" and "--list-diagnostics" not in arguments else done.stdout

    def said(self, text, *options, scene="scene", out="out"):
        (FOLDER / "sim.yaml").write_text(f"scene: {scene}.h5\n{text}")
        return self.run_program("dirsig-render", "sim.yaml", "-o", out, *options)

    def expect(self, code, text, *options, severity="warning", times=1, **where):
        said = self.said(text, *options, **where)
        self.assertEqual(said.count(f"[{code}]"), times, said)
        line = next(line for line in said.splitlines() if f"[{code}]" in line)
        self.assertEqual(line.startswith("warning: "), severity == "warning", line)
        return said

    def test_each_is_reported_with_its_code(self):
        self.expect("DR105", SUN.replace("{zenith_deg: 40, azimuth_deg: 90}", "{time_utc: '2026-06-21T17:00:00Z'}") +
                    camera(more=", integration_time_s: 1800"))
        self.expect("DR111", scene="cold", text=SUN + camera("[{name: red, center_um: 0.6, fwhm_um: 0.05, shape: rectangular}, "
                                          "{name: black, center_um: 1.6, fwhm_um: 0.05, shape: rectangular}]"))
        self.expect("DR112", camera(WARM))
        lamp = "lamps:\n  - {kind: point, name: lamp, positions_m: [[0, 0, 9]], intensity: 10, stokes: [1, 0.5, 0, 0]}\n"
        self.expect("DR210", lamp + camera(), severity="info")
        self.assertNotIn("[DR210]", self.said(lamp + camera(more=", stokes: linear")))
        self.expect("DR501", "sun: {direction: {zenith_deg: 40, azimuth_deg: 90}}\natmosphere: {profile: midlatitude_summer}\n" +
                    camera("[{name: water, center_um: 0.94, fwhm_um: 0.01, shape: rectangular}]", ", spectral_step_um: 0.02"))
        self.expect("DR502", SUN + camera("[{name: edge, center_um: 0.72, fwhm_um: 0.1, shape: rectangular}]",
                                          ", spectral_step_um: 0.1, spectral_error: 0"))

    def test_of_heat(self):
        self.expect("DR601", heat(", target_error_k: 0.001"), scene="roof")
        self.expect("DR603", heat(), scene="roof", out="found")  # media are passed by
        self.expect("DR604", heat(", paths: 8, from: 2001-07-14T07:00:00Z, to: 2001-07-15T13:00:00Z"), "--heat", "found/heat.h5", scene="roof")
        self.expect("DR605", heat())

    def test_of_elements_that_are_left_out(self):
        rows = (FOLDER / "denver.epw").read_text().split("\n")
        for k, row in enumerate(rows[8:], 8):
            if words := row.strip() and row.split(","):
                words[12:16] = ["40", "0", "0", "0"]  # W/m2 of the sky's infrared; no sun
                rows[k] = ",".join(words)
        (FOLDER / "cold.epw").write_text("\n".join(rows))
        asked = heat(", paths: 64, elements_by: area, influence_cutoff_k: CUTOFF").replace("elements: 12", "elements: 200")
        asked = asked.replace("denver.epw", "cold.epw")
        said = self.expect("DR602", asked.replace("CUTOFF", "0.01"), "--heat-only", scene="yard")
        self.assertIn("elements that are left out matter by more than the 0.01 K", said)
        self.assertRegex(said, r"elements are left out, \d+ are in view and within 0\.0\d+ K")
        self.assertIn("has no bound here", self.expect("DR602", asked.replace("CUTOFF", "0.1"), "--heat-only", scene="yard"))
        # Where air keeps the yard about as warm as it is: the negative control.
        self.assertNotIn("[DR602]", self.said(asked.replace("CUTOFF", "0.01"), "--heat-only", scene="mild"))

    def test_of_imports(self):
        shutil.copytree(SOURCES / "tests/data/dirsig", FOLDER / "dirsig")
        asked = json.loads((FOLDER / "dirsig/plane.jsim").read_text())
        asked[0] |= {f"not_known_{n}": n for n in range(20)}
        (FOLDER / "dirsig/more.jsim").write_text(json.dumps(asked))
        said = self.run_program("dirsig-render", "dirsig/more.jsim", "-o", "imported")
        self.assertGreaterEqual(said.count("[DR701]"), 1, said)
        self.assertEqual(said.count("[DR702]"), 1, said)

    def test_of_pages(self):
        self.said(SUN + camera(), out="one")
        self.expect("DR806", SUN + camera().replace("columns: 8, rows: 6", "columns: 200, rows: 200"), "--view", "p.html",
                    "--view-size", "256KiB", out="two")
        shutil.copy(FOLDER / "one/eye_material.img", FOLDER / "two/eye_material.img")
        shutil.copy(FOLDER / "one/eye_material.img.hdr", FOLDER / "two/eye_material.img.hdr")
        self.assertIn("[DR805]", self.run_program("dirsig-render", "-o", "two", "--view", "q.html"))

    def test_muted_ones_stay_in_the_log(self):
        self.assertNotIn("[DR112]", self.said(camera(WARM), "--mute", "DR112", out="muted"))
        kept = [d for d in json.loads((FOLDER / "muted/render.json").read_text())["diagnostics"] if d["code"] == "DR112"]
        self.assertEqual(len(kept), 1)
        self.assertTrue(kept[0]["muted"])
        self.assertEqual(kept[0]["severity"], "warning")
        self.assertTrue(kept[0]["text"] and kept[0]["condition"] and kept[0]["cure"])
        done = subprocess.run([BIN / "dirsig-render", "sim.yaml", "-o", "x", "--mute", "DR113x"], cwd=FOLDER, capture_output=True,
                              text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("unknown diagnostic code 'DR113x'", done.stderr)
        self.assertIn("DR113", done.stderr)

    def test_a_code_is_explained(self):
        listed = self.run_program("dirsig-render", "--list-diagnostics")
        done = subprocess.run([BIN / "dirsig-render", "--explain", "DR402"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        condition, cure = re.search(r"^DR402  info +(.*)\n +(.*)$", listed, re.M).groups()
        self.assertEqual(done.stdout, f"DR402: info: {condition}\n  {cure}\n")
        wrong = subprocess.run([BIN / "dirsig-render", "--explain", "DR499"], capture_output=True, text=True)
        self.assertEqual(wrong.returncode, 1)
        self.assertIn("unknown diagnostic code 'DR499'", wrong.stderr)

    def test_the_page_of_codes_is_the_programs_list(self):
        listed = self.run_program("dirsig-render", "--list-diagnostics")
        rows = re.findall(r"^(DR\d+)  (\w+) +(.*)\n +(.*)$", listed, re.M)
        page = (SOURCES / "docs/reference/diagnostics.md").read_text()
        self.assertEqual(re.findall(r"^\| (DR\d+) \| (\w+) \| (.*) \| (.*) \|$", page, re.M), rows)

    def test_every_code_is_listed_documented_and_provoked(self):
        listed = re.findall(r"^(DR\d+)  ", self.run_program("dirsig-render", "--list-diagnostics"), re.M)
        self.assertEqual(len(set(listed)), len(listed))
        header = (SOURCES / "libs/base/diagnostics.h").read_text()
        self.assertEqual(listed, [f"DR{n}" for n in re.findall(r"^  \w+ = (\d+),", header, re.M)])
        tests = "\n".join(p.read_text() for p in (SOURCES / "tests").rglob("*_test.*"))
        self.assertEqual([code for code in listed if not re.search(rf"[\[\"]{code}\\?[\]\"]", tests)], NOT_PROVOKED)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
