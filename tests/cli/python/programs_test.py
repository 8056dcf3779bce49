"""The programs' messages as exceptions and warnings, with their places."""
import json
import os
import shlex
import shutil
import signal
import stat
import subprocess
import sys
import threading
import time
import unittest
import warnings
from pathlib import Path
from unittest import mock

import remote_scenes as rs
from kit import BANDS, Case, by_day, lawn_with_things
from remote_scenes.errors import findings_of


class Programs(Case):
    def prepared(self):
        return lawn_with_things().prepare(self.folder / "lawn.h5")

    def test_a_refused_scene_tells_all_places_in_text_and_tree(self):
        scene = lawn_with_things()
        scene.materials["lawn"] = rs.Material("lambert", reflectence=0.2)
        scene.objects["ring"] = rs.sphere(-1, material="ring")
        with self.assertRaises(rs.InputError) as caught:
            scene.prepare(self.folder / "wrong.h5")
        refused = caught.exception
        text = (self.folder / "wrong.yaml").read_text().splitlines()
        places = {f.key: f for f in refused.findings if f.severity == "error"}
        self.assertEqual(set(places), {"materials.lawn.reflectence", "objects.ring.sphere.radius"})
        for key, found in places.items():
            self.assertEqual(Path(found.file), self.folder / "wrong.yaml")
            there = text[found.line - 1][found.column - 1:]
            self.assertTrue(there.startswith("reflectence" if "lawn" in key else "-1"), there)
        self.assertIn("did you mean 'reflectance'", places["materials.lawn.reflectence"].message)
        self.assertEqual(places["materials.lawn.reflectence"].code, "SP101")
        self.assertEqual(refused.exit_code, 1)
        self.assertEqual(refused.line, refused.findings[0].line)
        self.assertFalse((self.folder / "wrong.h5").exists())

    def test_a_check_returns_all_findings(self):
        scene = lawn_with_things()
        self.assertTrue(scene.check(self.folder / "a.yaml").accepted)
        scene.materials["spare"] = rs.Material("lambert", reflectance=0.1)
        report = scene.check(self.folder / "a.yaml")
        self.assertEqual((report.accepted, report.errors, report.warnings), (True, 0, 1))
        self.assertEqual([(f.code, f.key) for f in report.findings], [("SP103", "materials.spare")])
        self.assertFalse(scene.check(self.folder / "a.yaml", strict=True).accepted)
        (self.folder / "broken.yaml").write_text("scene: [1\n")
        broken = rs.check_scene(self.folder / "broken.yaml")
        self.assertFalse(broken.accepted)
        self.assertEqual(Path(broken.findings[0].file).name, "broken.yaml")

    def test_a_refused_simulation_tells_its_place(self):
        camera = rs.Orthographic(columns=4, rows=4, gsd_m=1, bands=BANDS, paths=4)
        camera.columns = -3
        with self.assertRaises(rs.InputError) as caught:
            by_day(self.prepared(), [camera]).render(self.folder / "out")
        self.assertEqual(caught.exception.key, "sensors.0.columns")
        self.assertIn("-3", caught.exception.message)
        self.assertIn("whole number", caught.exception.hint)
        self.assertFalse((self.folder / "out").exists())
        with self.assertRaisesRegex(rs.InputError, "--set sensors.0.rows"):
            rs.render(self.folder / "out.yaml", self.folder / "out", settings={"sensors.0.columns": 4, "sensors.0.rows": "x"})
        with self.assertRaises(rs.InputError):
            rs.render(self.folder / "nowhere.yaml", self.folder / "out")

    def test_warnings_point_to_the_caller(self):
        scene = lawn_with_things()
        scene.materials["spare"] = rs.Material("lambert", reflectance=0.1)
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            scene.prepare(self.folder / "a.h5")
        self.assertEqual([w.category for w in told], [rs.ProgramWarning])
        self.assertIn("'spare' is not used", str(told[0].message))
        self.assertEqual(Path(told[0].filename).name, "programs_test.py")
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            scene.prepare(self.folder / "a.h5")  # up to date
        self.assertEqual(told, [])

    def test_usage_and_programs_that_are_missing(self):
        with self.assertRaisesRegex(rs.UsageError, "unknown option '--paths_'; did you mean '--paths'"):
            rs.run_program("dirsig-render", ["--paths_"])
        with mock.patch.dict(os.environ, {"REMOTE_SCENES_BIN": str(self.folder)}):
            with self.assertRaisesRegex(rs.ProgramMissing, "REMOTE_SCENES_BIN"):
                rs.run_program("scene-prep", ["--version"])
        self.assertEqual(rs.version(), rs.__version__)

    def test_programs_above_the_working_folder_are_named(self):
        """Any folder above the working one was taken without a word."""
        programs, below = self.folder / "build/release/bin", self.folder / "a/b"
        for folder in (programs, below):
            folder.mkdir(parents=True)
        (programs / "scene-prep").write_text("#!/bin/sh\necho scene-prep 9.9\n")
        (programs / "scene-prep").chmod(0o755)
        code = "import remote_scenes as rs; print(rs.find_program('scene-prep'), rs.version())"
        shutil.copytree(Path(rs.__file__).parent, self.folder / "deep/package/remote_scenes")  # in no checkout
        env = {k: v for k, v in os.environ.items() if k != "REMOTE_SCENES_BIN"} | {
            "PATH": "/usr/bin:/bin", "PYTHONPATH": str(self.folder / "deep/package")}
        done = subprocess.run([sys.executable, "-c", code], cwd=below, env=env, capture_output=True, text=True)
        self.assertEqual(done.stdout.split(), [str(programs.resolve() / "scene-prep"), "9.9"], done.stderr)
        self.assertEqual(done.stderr.count(f"ProgramWarning: the programs of {programs.resolve()} are used"), 1, done.stderr)
        # Named, there is nothing to say.
        done = subprocess.run([sys.executable, "-c", code], cwd=below, env=env | {"REMOTE_SCENES_BIN": str(programs)},
                              capture_output=True, text=True)
        self.assertEqual(done.stderr, "")

    def test_programs_of_the_wheel_go_before_those_on_the_path(self):
        """The wheels' console scripts stand on the PATH, and start a Python for each program."""
        (self.folder / "site/remote_scenes_programs").mkdir(parents=True)
        for place, version in (("site/remote_scenes_programs/bin", "9.1"), ("path", "9.2"), ("named", "9.3")):
            (self.folder / place).mkdir()
            (self.folder / place / "scene-prep").write_text(f"#!/bin/sh\necho scene-prep {version}\n")
            (self.folder / place / "scene-prep").chmod(0o755)
        (self.folder / "site/remote_scenes_programs/__init__.py").write_text(
            "import pathlib\ndef folder(): return pathlib.Path(__file__).resolve().parent / 'bin'\n")
        package = str(Path(rs.__file__).parents[1])
        env = {k: v for k, v in os.environ.items() if k != "REMOTE_SCENES_BIN"} | {"PATH": f"{self.folder / 'path'}:/usr/bin:/bin"}

        def found(code="", **more):
            code = code or "import remote_scenes as rs; print(rs.version(), rs.where_is('scene-prep').why)"
            return subprocess.run([sys.executable, "-W", "error", "-c", code], cwd=self.folder, env=env | more, capture_output=True, text=True)

        site = {"PYTHONPATH": f"{self.folder / 'site'}:{package}"}
        self.assertEqual(found(**site).stdout, "9.1 it was installed with this package\n")
        self.assertEqual(found(PYTHONPATH=package).stdout, "9.2 it is on the PATH\n")
        self.assertEqual(found(**site, REMOTE_SCENES_BIN=str(self.folder / "named")).stdout, "9.3 REMOTE_SCENES_BIN names its folder\n")
        (self.folder / "site/remote_scenes_programs/bin/scene-prep").unlink()
        self.assertIn("pip install --force-reinstall remote-scenes-prep", found(**site).stderr)

    def test_a_scene_and_a_simulation_of_one_name_have_texts_of_their_own(self):
        """prepare("s00.h5") and render("s00") wanted the same s00.yaml."""
        sensor = rs.Orthographic(name="map", columns=4, rows=4, gsd_m=1, bands=BANDS[:1], paths=1)
        with self.subTest("scene first"):
            prepared = lawn_with_things().prepare(self.folder / "s00.h5")
            text = (self.folder / "s00.yaml").read_text()
            for _ in range(2):
                by_day(prepared, [sensor]).render(self.folder / "s00")
            self.assertEqual((self.folder / "s00.yaml").read_text(), text)
            self.assertTrue((self.folder / "s00_simulation.yaml").exists())
        with self.subTest("simulation first"):
            by_day(prepared, [sensor]).render(self.folder / "s01")
            lawn_with_things().prepare(self.folder / "s01.h5")
            self.assertTrue((self.folder / "s01_scene.yaml").exists())
        (self.folder / "s02.yaml").write_text("scene: s00.h5\n")  # by hand
        self.assertRaises(FileExistsError, by_day(prepared, [sensor]).render, self.folder / "s02")

    def test_maps_far_from_a_high_origin_are_told(self):
        """Coordinates of maps are on the ellipsoid to other programs: 3000 m / 6381 km of 20 km are 9.4 m."""
        scene = lawn_with_things()
        scene.origin = rs.Origin(49.4, 8.7, 3000)
        far = rs.Orthographic(columns=2, rows=2, gsd_m=1, center_m=[20000, 0], bands=BANDS, paths=1)
        simulation = by_day(scene.prepare(self.folder / "high.h5"), [far])
        with self.assertWarnsRegex(rs.ProgramWarning, r"farthest corner 9.4 m off.*\[DR803\]"):
            simulation.render(self.folder / "far")
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            far.gsd_m = 20
            rs.Simulation(simulation.scene, [far], sky=rs.Sky(radiance=1)).render(self.folder / "coarse")
        self.assertNotIn("farthest corner", " ".join(str(t.message) for t in told))

    def test_commands_in_results_can_be_given_again(self):
        camera = rs.Orthographic(columns=2, rows=2, gsd_m=1, bands=BANDS, paths=1)
        out = self.folder / "it's \"a\" 'view'"
        by_day(self.prepared(), [camera]).render(out)
        command = json.loads((out / "render.json").read_text())["command"]
        self.assertIn(str(out), shlex.split(command))

    def stand_in(self, script):
        """A program of ours in the place of scene-prep."""
        program = self.folder / "scene-prep"
        program.write_text("#!/bin/sh\n" + script)
        program.chmod(program.stat().st_mode | stat.S_IXUSR)
        return mock.patch.dict(os.environ, {"REMOTE_SCENES_BIN": str(self.folder)})

    def test_bugs_and_stops_are_told_apart(self):
        for script, kind in (("echo 'scene-prep: bug: x' >&2; exit 3", rs.ProgramBug), ("kill -ABRT $$", rs.ProgramBug),
                             ("exit 130", rs.Interrupted), ("exit 143", rs.Interrupted)):
            with self.stand_in(script), self.assertRaises(kind):
                rs.run_program("scene-prep", [])

    def test_lines_come_while_the_program_works(self):
        heard = []
        with self.stand_in("echo one >&2; sleep 1; echo two >&2"):
            rs.run_program("scene-prep", [], lambda line: heard.append((line, time.monotonic())))
        self.assertEqual([line for line, _ in heard], ["one", "two"])
        self.assertGreater(heard[1][1] - heard[0][1], 0.5)

    def test_an_interrupt_reaches_the_program_once_and_is_waited_for(self):
        with self.stand_in(f"trap 'echo x >> {self.folder}/stopped; exit 130' INT\necho ready >&2\nwhile :; do sleep 0.05; done"):
            stop = threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT))
            with self.assertRaises(KeyboardInterrupt):
                rs.run_program("scene-prep", [], lambda line: line == "ready" and stop.start())
        self.assertEqual((self.folder / "stopped").read_text(), "x\n")

    def test_lines_of_texts_are_no_findings(self):
        report = ["s.yaml: error [SP101] x1: a material is described wrongly", "    s.yaml:4:26: unknown key 'a'",
                  "    lawn: error: {model: lambert, a: 0.2}", "                                  ^", "    hint: leave it out",
                  "verdict: refused (1 errors, 0 warnings)"]
        found = findings_of(report)
        self.assertEqual([(f.line, f.column, f.message, f.hint) for f in found], [(4, 26, "unknown key 'a'", "leave it out")])


if __name__ == "__main__":
    unittest.main()
