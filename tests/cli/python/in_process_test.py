"""Fitted functions and prepared scenes within this process: the values of sqt-inspect to the last bit, places in closed form."""
import csv
import math
import os
import shutil
import subprocess
import sys
import tempfile
import threading
import unittest
from ctypes import byref
from pathlib import Path
from unittest import mock

import numpy as np

import remote_scenes as rs
from kit import ROOT, Case, lawn_with_things
from remote_scenes.library import NAME, HitArrays, SceneInfo, find_library, library


def run(program, *arguments):
    return subprocess.run([rs.find_program(program), *map(str, arguments)], check=True, capture_output=True, text=True).stdout


def as_programs_do(theta_deg, phi_deg):
    theta, phi = theta_deg * (math.pi / 180), phi_deg * (math.pi / 180)
    return [math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta)]


class Fitted(Case):
    @classmethod
    def setUpClass(cls):
        cls.kept = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.kept.cleanup)
        cls.path = Path(cls.kept.name) / "satin.sqt"
        run("sqt-fit", "-q", "--model", "ward:diffuse=0.2,specular=0.1,roughness=0.2", "--views", 9, "--order", 6,
            "--min-peak", 0, "-o", cls.path)

    def test_values_are_those_of_sqt_inspect_to_the_last_bit(self):
        run("sqt-inspect", self.path, "-q", "--export", self.folder / "t.csv")
        with open(self.folder / "t.csv", encoding="ascii") as text:
            rows = list(csv.DictReader(line for line in text if not line.startswith("#")))
        out = np.array([as_programs_do(float(r["theta_o_deg"]), float(r["phi_o_deg"])) for r in rows])
        in_ = np.array([as_programs_do(float(r["theta_i_deg"]), float(r["phi_i_deg"])) for r in rows])
        wanted = np.array([float(r["value"]) for r in rows])
        self.assertGreater(len(rows), 1000)
        with rs.open_sqt(self.path) as satin:
            self.assertEqual(satin.wavelength_um.tolist(), [0.55])
            got = satin.evaluate(out, in_)[:, 0]
            np.testing.assert_array_equal(got, wanted)
            for threads in (1, 3, 0):
                rs.set_threads(threads)
                np.testing.assert_array_equal(satin.evaluate(out, in_)[:, 0], wanted)
            # The control: other directions have other values.
            self.assertGreater(np.count_nonzero(satin.evaluate(out, in_[::-1])[:, 0] != wanted), len(rows) // 2)
            f, w, pdf, total = (line.split()[1] for line in run("sqt-inspect", self.path, "--eval", "30,0,40,170,0.55").splitlines())
            o, i = as_programs_do(30, 0), as_programs_do(40, 170)
            self.assertEqual([f"{v:.9g}" for v in (satin.evaluate(o, i)[0], satin.weight(o, i)[0], satin.density(o, i)[0],
                                                    satin.total(o)[0])], [f, w, pdf, total])

    def test_draws_have_the_density_and_bring_the_total(self):
        with rs.open_sqt(self.path) as satin:
            n = 200_000
            for zenith in (0, 50, 80):
                out = rs.direction(zenith, 20)
                drawn, density = satin.sample(np.broadcast_to(out, (n, 3)), seed=5)
                there = density > 0
                self.assertTrue(np.isnan(drawn[~there]).all())
                np.testing.assert_array_equal(satin.density(out, drawn[there])[:, 0], density[there])
                share = np.zeros(n)
                share[there] = satin.weight(out, drawn[there])[:, 0] / density[there]
                mean, error = share.mean(), share.std() / math.sqrt(n)
                self.assertLess(abs(mean - satin.total(out)[0]), 4 * error + 1e-4)
                # The control: a density that is wrong by 2 % is seen.
                self.assertGreater(abs(mean * 1.02 - satin.total(out)[0]), 4 * error + 1e-4)
            again, _ = satin.sample(np.broadcast_to(out, (n, 3)), seed=5)
            np.testing.assert_array_equal(again, drawn)

    def test_integrals_and_stated_errors(self):
        with rs.open_sqt(self.path) as satin:
            # The total by another way: even light from all of the upper side, with weights.
            x, w = np.polynomial.legendre.leggauss(200)
            mu, phi = 0.5 * (x + 1), (np.arange(400) + 0.5) * 0.9
            in_ = rs.direction(np.degrees(np.arccos(mu))[:, None], phi[None, :])
            out = rs.direction(35)
            total = (satin.weight(out, in_)[..., 0].mean(axis=1) * 2 * math.pi * 0.5 * w).sum()
            self.assertLess(abs(total / satin.total(out)[0] - 1), 0.01)
            albedo = satin.albedo()[0]
            self.assertTrue(0.2 < albedo < 0.31, albedo)
            self.assertLess(abs(satin.albedo(8, 4)[0] / albedo - 1), 0.01)
            self.assertEqual(satin.magnitude(out).shape, (len(satin.total_um),))
            self.assertGreater(satin.errors["overall"]["l1"], 0)
            self.assertIsNone(satin.dirac)
            self.assertEqual(satin.dirac_lobe(out)[1], 0)
        run("sqt-fit", "-q", "--model", "mirror:reflectance=0.8", "-o", self.folder / "m.sqt")
        with rs.open_sqt(self.folder / "m.sqt") as mirror:
            self.assertEqual(mirror.dirac, "mirror")
            there, part = mirror.dirac_lobe(rs.direction([20, 60], 30))
            np.testing.assert_allclose(there, rs.direction([20, 60], 210), atol=1e-12)
            np.testing.assert_allclose(part, 0.8, rtol=1e-3)

    def test_shapes_are_broadcast(self):
        with rs.open_sqt(self.path) as satin:
            f = satin.evaluate(rs.direction([0, 20, 40])[:, None], rs.direction([10, 30], 180))
            self.assertEqual(f.shape, (3, 2, 1))
            self.assertEqual(f[1, 1, 0], satin.evaluate(rs.direction(20), rs.direction(30, 180))[0])
            self.assertEqual(satin.evaluate(np.empty((0, 3)), np.empty((0, 3))).shape, (0, 1))

    def test_threads_may_ask_at_once(self):
        with rs.open_sqt(self.path) as satin:
            out, in_ = rs.direction(30), rs.direction(np.linspace(0, 89, 4000), 180)
            wanted, answers = satin.evaluate(out, in_), [None] * 6

            def ask(k):
                answers[k] = satin.evaluate(out, in_)
            threads = [threading.Thread(target=ask, args=(k,)) for k in range(6)]
            for t in threads:
                t.start()
            for t in threads:
                t.join()
            for answer in answers:
                np.testing.assert_array_equal(answer, wanted)

    def test_what_is_wrong_is_told_as_the_programs_do(self):
        def refused(path):
            with self.assertRaises(rs.InputError) as caught:
                rs.open_sqt(path)
            said = subprocess.run([rs.find_program("sqt-inspect"), path], capture_output=True, text=True)
            self.assertEqual(said.returncode, 1)
            self.assertEqual(caught.exception.output, said.stderr.strip())
            return caught.exception
        self.assertEqual(refused(self.folder / "gone.sqt").file, str(self.folder / "gone.sqt"))
        bytes_ = bytearray(self.path.read_bytes())
        bytes_[len(bytes_) // 2] ^= 4
        (self.folder / "bad.sqt").write_bytes(bytes_)
        refused(self.folder / "bad.sqt")
        (self.folder / "bad.sqt").write_bytes(bytes_[:100])
        refused(self.folder / "bad.sqt")
        with rs.open_sqt(self.path) as satin:
            for out, in_ in (([0, 0, 2], [0, 0, 1]), ([0, 0, 1], [0, math.nan, 1])):
                with self.assertRaisesRegex(rs.InputError, "is no unit vector"):
                    satin.evaluate(out, in_)
            with self.assertRaisesRegex(rs.InputError, r"row 1 has 1; \[0, 1\)"):
                satin.sample([[0, 0, 1]] * 2, u=[[0, 0, 0], [0, 1, 0]])
            self.assertRaises(IndexError, satin.sample, [0, 0, 1], 7)
            self.assertRaisesRegex(ValueError, "shape", satin.evaluate, [0, 1], [0, 1])
        self.assertRaisesRegex(ValueError, "closed", satin.total, [0, 0, 1])
        with self.assertRaises(rs.InputError):
            rs.set_threads(-1)


class Traced(Case):
    def setUp(self):
        super().setUp()
        scene = lawn_with_things()
        scene.add("ball", rs.sphere(2), material=rs.Material("lambert", reflectance=0.4), translate=[20, 0, 6])
        scene.prepare(self.folder / "lawn.h5")
        self.path = self.folder / "lawn.h5"

    def test_what_rays_meet_has_its_closed_form(self):
        with rs.open_scene(self.path) as scene:
            self.assertEqual(scene.origin, (49.4, 8.7, 120))
            # A sphere of radius 2 at (20, 0, 6), from above at offsets from its axis.
            x = np.linspace(-1.9, 1.9, 2001)
            origin = np.stack([20 + x, 0 * x, 0 * x + 50], axis=-1)
            hits = scene.trace(origin, [0, 0, -1])
            z = 6 + np.sqrt(4 - x ** 2)
            np.testing.assert_allclose(hits.position, np.stack([20 + x, 0 * x, z], axis=-1), atol=1e-9)
            np.testing.assert_allclose(hits.distance, 50 - z, atol=1e-9)
            np.testing.assert_allclose(hits.normal, np.stack([x / 2, 0 * x, (z - 6) / 2], axis=-1), atol=1e-9)
            self.assertEqual({scene.materials[m] for m in hits.material}, {"ball"})
            self.assertEqual(len(set(hits.instance)), 1)
            self.assertTrue((hits.triangle == -1).all())

    def test_one_ray_has_one_answer(self):
        """It was a TypeError."""
        with rs.open_scene(self.path) as scene:
            one, many = scene.trace([20, 0, 50], [0, 0, -1]), scene.trace([[20, 0, 50]], [0, 0, -1])
            for name in ("distance", "position", "normal", "material", "instance", "tag", "triangle", "hit"):
                self.assertEqual(getattr(one, name).shape, getattr(many, name).shape[1:], name)
                np.testing.assert_array_equal(getattr(one, name), getattr(many, name)[0])
            self.assertAlmostEqual(float(one.distance), 42, places=9)
            self.assertEqual(scene.visible([20, 0, 50], [20, 0, 9]).shape, ())

    def test_closed_while_others_use_it(self):
        """The process ended by a signal, four times of four."""
        (self.folder / "use.py").write_text("""
import sys, threading, time
import numpy as np
import remote_scenes as rs

scene, satin, wrong = rs.open_scene(sys.argv[1]), rs.open_sqt(sys.argv[2]), []
rays = np.random.default_rng(1).random((2000, 3)) * 20 + [0, 0, 9]
begun = threading.Barrier(9)

def use(thing, ask):
    begun.wait()
    try:
        while True:
            ask()
    except ValueError as e:
        if str(e) != "it has been closed":
            wrong.append(e)
    except BaseException as e:
        wrong.append(e)

def fewer_threads():
    for k in range(200):
        rs.set_threads(1 + k % 3)

asked = [(scene, lambda: scene.trace(rays, [0, 0, -1])), (scene, lambda: scene.visible(rays, [0, 0, 50])),
         (satin, lambda: satin.evaluate(rs.direction(np.linspace(0, 80, 2000)), rs.direction(30)))]
threads = [threading.Thread(target=use, args=asked[k % 3]) for k in range(8)]
for t in threads:
    t.start()
begun.wait()
fewer_threads()
scene.close()
satin.close()
for t in threads:
    t.join()
assert not wrong, wrong
scene.close()
""")
        run("sqt-fit", "-q", "--model", "lambert:reflectance=0.3", "-o", self.folder / "grey.sqt")
        for _ in range(3):
            done = subprocess.run([sys.executable, self.folder / "use.py", self.path, self.folder / "grey.sqt"],
                                  capture_output=True, text=True, timeout=300)
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_handles_of_the_library_that_are_closed_are_refused(self):
        lib, scene = library(), rs.open_scene(self.path)
        handle = scene._open
        scene.close()
        again = rs.open_scene(self.path)
        for call in (lambda: lib.rs_scene_trace(handle, 1, None, None, None, None, byref(HitArrays())),
                     lambda: lib.rs_scene_visible(handle, 1, None, None, 0, None, None)):
            self.assertEqual(call(), 1)
            self.assertIn(b"scene has been closed", lib.rs_message())
        self.assertIsNone(lib.rs_scene_material(handle, 0))
        info = SceneInfo(materials=7)
        lib.rs_scene_describe(handle, byref(info))
        self.assertEqual(info.materials, 0)
        lib.rs_scene_close(handle)
        lib.rs_scene_close(None)
        self.assertEqual(again.trace([20, 0, 50], [0, 0, -1]).hit, True)
        again.close()

    def test_numbers_and_names_that_c_would_cut(self):
        """2^32 + 1 threads were one, a draw of -1 or 2^32 another one, and a path ended at its NUL."""
        for threads in (2 ** 32 + 1, 2 ** 70, -2 ** 32):
            self.assertRaisesRegex(ValueError, "threads=.*: -2147483648 to 2147483647", rs.set_threads, threads)
        self.assertRaisesRegex(rs.InputError, "0 to 4096", rs.set_threads, 5000)
        self.assertRaisesRegex(TypeError, "threads=1.5: a whole number", rs.set_threads, 1.5)
        with rs.open_scene(self.path) as scene:
            for draw in (-1, 2 ** 32, np.array([2 ** 40]), 0.5, 2 ** 70, [1.0]):
                self.assertRaisesRegex(ValueError, "draw: whole numbers from 0 to 4294967295", scene.trace, [[0, 0, 9]], [0, 0, -1],
                                       draw=draw)
            scene.trace([[0, 0, 9]], [0, 0, -1], draw=2 ** 32 - 1)
            scene.trace(np.empty((0, 3)), [0, 0, -1], draw=[])
        nul = str(self.path) + "\0.png"
        for open_ in (rs.open_scene, rs.open_sqt, rs.open_simulation):
            self.assertRaisesRegex(ValueError, "NUL", open_, nul)
        self.assertRaisesRegex(ValueError, "the sensor's name .* NUL", rs.open_simulation, self.path, "cam\0era")

    def test_names_tags_and_nothing(self):
        with rs.open_scene(self.path) as scene:
            hits = scene.trace([[5, 5, 30], [5, 5, 30], [0, -5, 30], [0, -7.5, 30], [-30, 20, 30]],
                               [[0, 0, -1], [0, 0, 1], [0, 0, -1], [0, 0, -1], [0, 0, -1]])
            self.assertEqual(hits.hit.tolist(), [True, False, True, True, True])
            names = [scene.materials[m] if m >= 0 else None for m in hits.material]
            self.assertEqual(names, ["car", None, "lawn", "ring", "lawn"])
            self.assertEqual([scene.tags[t] if t >= 0 else None for t in hits.tag], ["car", None, None, "ring, big", None])
            np.testing.assert_allclose(hits.distance[[0, 2, 3]], [28.5, 30, 29.9], atol=1e-6)
            self.assertTrue(np.isinf(hits.distance[1]) and np.isnan(hits.position[1]).all() and hits.instance[1] == -1)
            # The same as scene-prep says.
            said = run("scene-prep", self.path, "--raycast", "5 5 30 0 0 -1")
            self.assertIn(f"instance {hits.instance[0]})", said)
            self.assertIn(f"distance  {hits.distance[0]:.6f} m", said)

    def test_one_sees_another(self):
        with rs.open_scene(self.path) as scene:
            ground = [20, 0, 0]  # under the ball
            self.assertEqual(scene.visible(ground, [[20, 0, 50], [40, 0, 5], [20, 0, 3.9]]).tolist(), [False, True, True])
            self.assertFalse(scene.visible([0, 0, 1], [0, 0, -1]))
            self.assertTrue(scene.visible([0, 0, 1], [0, 0, 0]))
            self.assertFalse(scene.visible([0, 0, 1], [0, 0, -1e-2], gap_m=0))

    def test_what_moves_is_where_it_is(self):
        (self.folder / "m.yaml").write_text("""scene: 1
name: moving
materials: {grey: {model: lambert, reflectance: 0.5}}
objects: {ball: {sphere: {radius: 1}, material: grey}}
world:
  - place: ball
    motion: {kind: keyframes, keys: [{time_s: 0, position_m: [0, 0, 0]}, {time_s: 10, position_m: [50, 0, 0]}]}
""")
        rs.prepare_scene(self.folder / "m.yaml", self.folder / "m.h5")
        with rs.open_scene(self.folder / "m.h5", 0, 10) as scene:
            hits = scene.trace([[0, 0, 9], [25, 0, 9], [50, 0, 9], [0, 0, 9]], [0, 0, -1], time_s=[0, 5, 10, 5])
            self.assertEqual(hits.hit.tolist(), [True, True, True, False])
            np.testing.assert_allclose(hits.distance[:3], 8, atol=1e-6)
            with self.assertRaisesRegex(rs.InputError, "was opened for 0 to 10 s"):
                scene.trace([0, 0, 9], [0, 0, -1], time_s=11)
        with self.assertRaises(rs.InputError):
            rs.open_scene(self.folder / "m.h5", 0, 99)  # the motion does not cover it
        with self.assertRaisesRegex(rs.InputError, "no span"):
            rs.open_scene(self.folder / "m.h5", 5, 1)

    def test_what_is_wrong_is_told(self):
        with self.assertRaises(rs.InputError) as caught:
            rs.open_scene(self.folder / "gone.h5")
        self.assertEqual(caught.exception.file, str(self.folder / "gone.h5"))
        bytes_ = self.path.read_bytes()
        (self.folder / "half.h5").write_bytes(bytes_[:len(bytes_) // 2])
        self.assertRaises(rs.InputError, rs.open_scene, self.folder / "half.h5")
        with rs.open_scene(self.path) as scene:
            with self.assertRaisesRegex(rs.InputError, "unit vector"):
                scene.trace([0, 0, 9], [0, 0, -3])
            with self.assertRaisesRegex(rs.InputError, "origin: row 1 has inf"):
                scene.trace([[0, 0, 9], [0, math.inf, 9]], [0, 0, -1])


SIMULATION = """scene: lawn.h5
seed: 11
sun: {direction: {azimuth_deg: 140, zenith_deg: 35}}
sky: {radiance: 40}
sensors:
  - {kind: point, name: eyes, paths: 48, bands: [{name: blue, center_um: 0.45, fwhm_um: 0.02}, {name: red, center_um: 0.65, fwhm_um: 0.02}], collectors: [COLLECTORS]}
  - {kind: frame_camera, name: camera, columns: 4, rows: 4, pitch_um: 100, focal_length_mm: 10, position_m: [0, -40, 30], look_at_m: [0, 0, 0], bands: [{name: green, center_um: 0.55, fwhm_um: 0.02}]}
"""


class Lit(Case):
    """Rays that are rendered here are pixels of dirsig-render: those of a sensor that looks along the same rays."""

    def setUp(self):
        super().setUp()
        scene = lawn_with_things()
        scene.add("ball", rs.sphere(2), material=rs.Material("lambert", reflectance=0.4), translate=[20, 0, 6])
        scene.prepare(self.folder / "lawn.h5")
        spread = np.linspace(-1, 1, 40)
        self.origin = np.stack([20 * spread, 0 * spread, 30 + 0 * spread], axis=-1)
        look = np.stack([0.1 * spread, 0.2 * spread ** 2, -1 + 0 * spread], axis=-1)
        self.direction = look / np.linalg.norm(look, axis=-1, keepdims=True)
        self.path = self.folder / "view.yaml"
        self.path.write_text(SIMULATION.replace("COLLECTORS", ", ".join(
            f"{{quantity: radiance, position_m: {o.tolist()}, look: {d.tolist()}}}" for o, d in zip(self.origin, self.direction))))

    def rendered(self, *arguments):
        rs.run_program("dirsig-render", [self.path, "-q", "-o", self.folder / "out", *arguments])
        with open(self.folder / "out/eyes.csv", encoding="ascii") as text:
            rows = list(csv.DictReader(line for line in text if not line.startswith("#")))
        return [np.array([r[key] for r in rows]).reshape(-1, 2) for key in ("value", "standard_error")]

    def test_the_bits_of_dirsig_render(self):
        value, error = self.rendered()
        with rs.open_simulation(self.path, "eyes") as lit:
            self.assertEqual((lit.bands, lit.wavelength_um.tolist(), lit.paths, lit.seed, lit.begin_s),
                             (("blue", "red"), [0.45, 0.65], 48, 11, 0))
            first = lit.radiance(self.origin, self.direction)
            self.assertEqual([f"{v:.9g}" for v in first.radiance.flat], value.ravel().tolist())
            self.assertEqual([f"{v:.9g}" for v in first.standard_error.flat], error.ravel().tolist())
            self.assertGreater(len(set(value[:, 1])), 15)
            for threads in (1, 3, 0):
                rs.set_threads(threads)
                np.testing.assert_array_equal(lit.radiance(self.origin, self.direction).radiance, first.radiance)
            # Two seeds agree within the errors of more paths (5 standard errors: 5e-5 for all 80 values by chance); the
            # control: other rays do not.
            one, other = (lit.radiance(self.origin, self.direction, seed=seed, paths=4096) for seed in (12, 13))
            self.assertLess(other.standard_error.mean(), first.standard_error.mean() / 5)
            noisy = one.standard_error > 1e-6 * one.radiance
            self.assertGreater(noisy.mean(), 0.5)
            off = np.abs(other.radiance - one.radiance)[noisy] / np.hypot(one.standard_error, other.standard_error)[noisy]
            self.assertGreater(off.max(), 0.5)
            self.assertLess(off.max(), 5)
            moved = lit.radiance(self.origin + [0.5, 0, 0], self.direction)
            self.assertGreater((np.abs(moved.radiance - first.radiance) > 1).mean(), 0.05)
            np.testing.assert_array_equal(lit.radiance(np.empty((0, 3)), [0, 0, -1]).radiance, np.empty((0, 2)))

    def test_the_same_under_the_sun_of_a_time(self):
        """Each time is rendered by itself, and rays that meet nothing are told."""
        text = self.path.read_text().replace("sun: {direction: {azimuth_deg: 140, zenith_deg: 35}}\nsky: {radiance: 40}\n",
                                             'sun: {direction: {time_utc: "2026-06-21T11:00:00Z"}}\n')
        self.path.write_text(text)
        with rs.open_simulation(self.path, "eyes") as lit:
            ray = [[0, -20, 30]] * 2, [0, 0, -1]  # lawn in the open: a Lambert surface under the sun alone
            both = lit.radiance(*ray, time_s=[4 * 3600.0, 0], paths=256)
            late = lit.radiance(*ray, time_s=4 * 3600.0, paths=256)
            self.assertGreater(both.radiance[1, 1], 1.2 * both.radiance[0, 1])
            error = np.hypot(both.standard_error[0], late.standard_error[0])
            self.assertLess((np.abs(both.radiance[0] - late.radiance[0]) / error).max(), 5)
            with self.assertWarnsRegex(rs.ProgramWarning, "none of its paths met anything"):
                lit.radiance([0, 0, 30], [0, 0, 1])

    def test_what_is_wrong_is_told(self):
        with self.assertRaisesRegex(rs.InputError, "2 sensors.*eyes, camera"):
            rs.open_simulation(self.path)
        with self.assertRaisesRegex(rs.InputError, "no sensor 'nose'"):
            rs.open_simulation(self.path, "nose")
        self.assertRaises(rs.InputError, rs.open_simulation, self.folder / "gone.yaml")
        with rs.open_simulation(self.path, "camera") as lit:
            self.assertRaisesRegex(rs.InputError, "unit vector", lit.radiance, [0, 0, 9], [0, 0, -3])
            self.assertRaises(ValueError, lit.radiance, [0, 0, 9], [0, 0, -1], paths=0)
            self.assertRaises(ValueError, lit.radiance, [0, 0, 9], [0, 0, -1], seed=-1)
            for wrong in (2 ** 64 + 5, 2 ** 53 + 1):
                self.assertRaisesRegex(ValueError, "seed=", lit.radiance, [0, 0, 9], [0, 0, -1], seed=wrong)
                self.assertRaisesRegex(ValueError, "paths=", lit.radiance, [0, 0, 9], [0, 0, -1], paths=wrong)
            self.assertRaisesRegex(TypeError, "paths=2.5", lit.radiance, [0, 0, 9], [0, 0, -1], paths=2.5)
            self.assertEqual(lit.radiance([0, 0, 9], [0, 0, -1], paths=1).radiance.shape, (len(lit.bands),))


class Border(Case):
    def test_a_missing_library_is_told(self):
        for name in ("sqt-inspect", "scene-prep"):
            (self.folder / "bin").mkdir(exist_ok=True)
            shutil.copy(rs.find_program(name), self.folder / "bin")
        with mock.patch.dict("os.environ", {"REMOTE_SCENES_BIN": str(self.folder / "bin")}):
            with self.assertRaisesRegex(rs.ProgramMissing, NAME):
                find_library()

    def test_only_the_header_can_be_seen(self):
        declared = set()
        for line in (ROOT / "apps/in-process/remote_scenes.h").read_text().splitlines():
            if "(" in line and not line.startswith(("/", " ", "#")):
                declared.add(line.partition("(")[0].split()[-1].lstrip("*"))
        exported = {line.split()[-1].partition("@")[0] for line in
                    subprocess.run(["nm", "-D", "--defined-only", find_library()], check=True, capture_output=True,
                                   text=True).stdout.splitlines() if " T " in line or " W " in line or " V " in line}
        self.assertGreater(len(declared), 15)
        self.assertEqual(exported, declared)

    def test_the_header_is_plain_c(self):
        compiler = shutil.which("gcc") or shutil.which("cc")
        if not compiler:
            self.skipTest("there is no compiler of C")
        (self.folder / "x.c").write_text("""#include <stdio.h>
#include "remote_scenes.h"
int main(int n, char** given) {
  rs_sqt* sqt = 0;
  double up[3] = {0, 0, 1}, f[64];
  rs_sqt_info info;
  if (rs_interface() < RS_INTERFACE || rs_sqt_open(n > 1 ? given[1] : 0, &sqt)) { puts(rs_message()); return 1; }
  rs_sqt_describe(sqt, &info);
  if (info.channels > 64 || rs_sqt_evaluate(sqt, 1, up, up, f)) return 2;
  printf("%.17g\\n", f[0]);
  rs_sqt_close(sqt);
  return rs_sqt_evaluate(0, 1, up, up, f) == RS_INPUT && rs_message()[0] ? 0 : 3;
}
""")
        library = find_library()
        # Beside a library built for the address sanitizer the program has to be, too: a sanitizer that starts with the first allocation
        # of a library (p11-kit's of a locale, under the lock of locales) leaves that lock broken, and the program waits for it at its end.
        sanitizer = ["-fsanitize=address"] if "libasan" in os.environ.get("LD_PRELOAD", "") else []
        subprocess.run([compiler, "-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", *sanitizer, f"-I{ROOT}/apps/in-process", "x.c",
                        "-o", "x", str(library), f"-Wl,-rpath,{library.parent}"], cwd=self.folder, check=True)
        run("sqt-fit", "-q", "--model", "lambert:reflectance=0.5", "-o", self.folder / "l.sqt")
        done = subprocess.run([self.folder / "x", self.folder / "l.sqt"], capture_output=True, text=True, check=True)
        with rs.open_sqt(self.folder / "l.sqt") as lambert:
            self.assertEqual(float(done.stdout), lambert.evaluate([0, 0, 1], [0, 0, 1])[0])
        refused = subprocess.run([self.folder / "x"], capture_output=True, text=True)
        self.assertEqual((refused.returncode, refused.stdout), (1, "error: path is NULL\n"))


if __name__ == "__main__":
    unittest.main()
