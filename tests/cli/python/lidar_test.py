"""Laser radars: written as a sensor, their responses and points read."""
import unittest

import numpy as np

import remote_scenes as rs
from kit import Case

LASER = {"wavelength_um": 1.064, "pulse_energy_j": 1e-5, "rate_hz": 100, "pulse": {"kind": "gaussian", "fwhm_ns": 4},
         "beam": {"kind": "gaussian", "full_angle_1_e2_mrad": 0.2}}
POINTS = {"kind": "linear", "name": "points", "quantum_efficiency": 0.8, "receiver_fwhm_ns": 1, "amplifier_noise_e_per_ns": 10,
          "returns": {"by": "gaussian", "threshold_e_per_ns": 100}}


class Lidar(Case):
    def test_written_traced_and_read(self):
        scene = rs.Scene("step")
        scene.add("ground", rs.plane(width=100, depth=100), material=rs.Material("lambert", reflectance=0.3))
        scene.add("table", rs.box([0, -50, 0], [50, 50, 3]), material=rs.Material("lambert", reflectance=0.3))
        lidar = rs.Lidar(name="als", motion={"kind": "static", "position_m": [0, 0, 200]}, tasks=[{"start": 0, "pulses": 10}], laser=LASER,
                         receiver={"aperture_mm": 100, "field_of_view_mrad": 1}, gate={"start_m": 190, "stop_m": 205, "bin_ns": 0.1},
                         scanner={"kind": "triangle", "half_angle_deg": 1, "rate_hz": 10, "turn_share": 0, "phase_deg": 18}, orders=1, paths=8,
                         detectors=[POINTS])
        rs.Simulation(scene.prepare(self.folder / "scene.h5"), [lidar]).render(self.folder / "out")
        responses = rs.open_response(self.folder / "out/als_response.h5")
        self.assertEqual(responses.sizes["pulse"], 10)
        self.assertEqual(list(responses.channel.values), ["single", "multiple"])
        one = rs.response_of(responses, 0)
        self.assertAlmostEqual(float(one.sum()), float(responses.value.values[responses.entry_row.values == 0].sum()), places=6)
        middle = float((one.sum("channel") * one.range).sum() / one.sum())
        self.assertAlmostEqual(middle, 197 / np.cos(np.radians(0.2)), delta=0.01)
        points = rs.read_points(self.folder / "out/als/points.las")
        self.assertEqual(points.sizes["point"], 10)
        np.testing.assert_allclose(points.z, np.where(points.x > 0, 3, 0), atol=2e-3)
        np.testing.assert_allclose(np.diff(points.gps_time), 0.01, atol=1e-6)
        self.assertIn("deviation_m", points)
        self.assertRaises(IndexError, rs.response_of, responses, 10)
        # Within the process: the same bits, also of a part of the pulses.
        with rs.open_lidar(self.folder / "out.yaml") as opened:
            self.assertEqual((opened.pulses, opened.paths, opened.channels), (10, 8, ("single", "multiple")))
            whole, part = opened.trace(), opened.trace(4, 3)
            for name in whole.data_vars:
                np.testing.assert_array_equal(whole[name], responses[name], name)
            np.testing.assert_array_equal(part.time, whole.time[4:7])
            of_part = (whole.entry_row.values >= 4) & (whole.entry_row.values < 7)
            np.testing.assert_array_equal(part.value, whole.value[of_part])
            other = opened.trace(seed=2)
            self.assertFalse(np.array_equal(other.value, whole.value))
            self.assertEqual(opened.trace(0, 0).sizes["pulse"], 0)
            self.assertRaises(ValueError, opened.trace, paths=1)
        self.assertRaises(ValueError, opened.trace)
        with self.assertRaisesRegex(rs.InputError, "no sensor of radiance"):
            rs.open_simulation(self.folder / "out.yaml")
        with self.assertRaisesRegex(rs.InputError, "no laser radar 'x'"):
            rs.open_lidar(self.folder / "out.yaml", "x")

    def test_other_files_are_refused(self):
        self.assertRaises(FileNotFoundError, rs.open_response, self.folder / "none.h5")
        (self.folder / "x.las").write_bytes(b"LASF" + bytes(400))
        self.assertRaises(rs.FormatError, rs.read_points, self.folder / "x.las")
        (self.folder / "x.h5").write_bytes(b"no")
        self.assertRaises(rs.FormatError, rs.open_response, self.folder / "x.h5")


if __name__ == "__main__":
    unittest.main()
