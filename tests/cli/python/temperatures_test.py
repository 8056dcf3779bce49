"""Temperatures that follow from weather: found once, read, used by a run."""
import unittest

import numpy as np

import remote_scenes as rs
from kit import ROOT, Case

SLAB = {"layers": [{"thickness_m": 0.3, "density_kg_m3": 2000, "specific_heat_j_kg_k": 900, "conductivity_w_m_k": 1.0}]}


class Temperatures(Case):
    def simulation(self):
        scene = rs.Scene("ground", origin=rs.Origin(39.83, -104.65, 1650))
        ground = rs.Material("lambert", reflectance=0.1, thermal=SLAB, temperature={"model": "heat", "convection": "mcadams"})
        scene.add("ground", rs.plane(width=20, depth=20), material=ground)
        camera = rs.Orthographic(name="map", columns=4, rows=4, gsd_m=2, bands=[rs.Band("thermal", 10.5, 1, "rectangular")],
                                 paths=16, time_s=46800, truth=["temperature"])
        return rs.Simulation(scene.prepare(self.folder / "scene.h5"), [camera], epoch="2001-07-14T07:00:00Z",
                             weather={"file": ROOT / "sample_scenes/summer_street/denver_july.epw", "year": 2001},
                             heat={"elements": 16, "paths": 8})

    def test_found_read_and_rendered(self):
        simulation = self.simulation()
        found = simulation.find_temperatures(self.folder / "warm")
        kelvin = found.temperature
        self.assertEqual(kelvin.dims, ("face", "moment"))
        self.assertEqual(kelvin.units, "K")
        self.assertEqual(set(found.material.values), {"ground"})
        self.assertAlmostEqual(float(found.area.sum()), 400, places=3)
        self.assertEqual(float(found.time_s[-1] - found.time_s[0]), 86400)
        by_time = kelvin.mean("face").swap_dims(moment="time_s")
        self.assertGreater(float(by_time.sel(time_s=46800, method="nearest") - by_time.sel(time_s=18000, method="nearest")), 10)
        result = simulation.render(self.folder / "view", heat=self.folder / "warm/heat.h5")
        self.assertFalse((self.folder / "view/heat.csv").exists())  # not found again
        # Where a face is at the map's time, between moments.
        expected = np.interp(46800, found.time_s, kelvin.mean("face"))
        self.assertAlmostEqual(float(result["map"].truth_temperature.mean()), expected, delta=0.5)

    def test_other_files_are_refused(self):
        simulation = self.simulation()
        with self.assertRaises(rs.FormatError):
            rs.open_temperatures(self.folder / "scene.h5")
        with self.assertRaises(FileNotFoundError):
            rs.open_temperatures(self.folder / "none.h5")
        with self.assertRaises(rs.InputError):
            simulation.render(self.folder / "view", heat=self.folder / "scene.h5")


if __name__ == "__main__":
    unittest.main()
