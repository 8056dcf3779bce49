"""Tables for atmospheric correction, as their users read them: netCDF by other people's readers, stopped runs, faults with
their place, and the radiance of a rendered ground put together from the table. air_lut_test.py BIN FOLDER
"""
import csv
import json
import math
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time
import unittest

import netCDF4
import numpy
import xarray

BIN, FOLDER = (pathlib.Path(p).resolve() for p in sys.argv[1:3])
REFLECTANCE, SUN = 0.3, 40
BANDS = "[{name: b, center_um: 0.45, fwhm_um: 0.01}, {name: r, center_um: 0.67, fwhm_um: 0.01}, {name: n, center_um: 0.87, fwhm_um: 0.01}, " \
        "{name: w, center_um: 0.94, fwhm_um: 0.01}, {name: s, center_um: 1.65, fwhm_um: 0.02}]"
AIR = "{profile: midlatitude_summer, ground_albedo: 0.3, aerosol: {model: rural, optical_depth_550: 0.2}}"
SCENE = f"""scene: 1
materials: {{ground: {{model: lambert, reflectance: {REFLECTANCE}}}}}
objects: {{plane: {{plane: {{width: 0, depth: 0}}, material: ground}}}}
world: [{{place: plane}}]
"""
SIM = f"""scene: scene.h5
atmosphere: {AIR}
sun: {{direction: {{zenith_deg: {SUN}, azimuth_deg: 0}}}}
sensors:
  - {{name: eye, kind: frame_camera, columns: 3, rows: 3, pitch_um: 10, focal_length_mm: 100, position_m: [3000, 0, 3000], look_at_m: [0, 0, 0],
     up: [0, 0, 1], paths: 64, bands: {BANDS}}}
"""
GRID = f"""air_lut: 1
AOT550: [0.2, 0.4]
observer_altitude_km: 3
observer_zenith: 45
solar_zenith: {SUN}
relative_azimuth: [0, 90]
zarr: true
"""


def run(*words, code=0):
    done = subprocess.run([BIN / words[0], *map(str, words[1:])], cwd=FOLDER, capture_output=True, text=True)
    assert done.returncode == code, (words, done.stdout, done.stderr)
    return done.stdout + done.stderr


def image(path):
    header = pathlib.Path(str(path) + ".hdr").read_text()
    bands = int(re.search(r"bands *= *(\d+)", header)[1])
    return numpy.fromfile(path, "<f4").reshape(bands, -1), header


class AirLut(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(FOLDER, ignore_errors=True)
        FOLDER.mkdir(parents=True)
        for name, text in (("scene.yaml", SCENE), ("sim.yaml", SIM), ("grid.yaml", GRID)):
            (FOLDER / name).write_text(text)
        run("scene-prep", "scene.yaml", "-o", "scene.h5", "-q")
        cls.said = run("dirsig-render", "sim.yaml", "--air-lut", "grid.yaml", "-o", "lut")

    def test_other_readers_find_axes_and_units(self):
        table = xarray.open_dataset(FOLDER / "lut/air_lut.nc")
        self.assertEqual(dict(table.sizes), {"wl": 5, "AOT550": 2, "relative_azimuth": 2})
        self.assertEqual(table["rhoatm"].dims, ("wl", "AOT550", "relative_azimuth"))
        self.assertEqual(table.attrs["RT_mode"], "transm")
        self.assertAlmostEqual(float(table["coszen"]), math.cos(math.radians(SUN)), 12)
        with netCDF4.Dataset(FOLDER / "lut/air_lut.nc") as plain:
            self.assertEqual(plain["thermal_upwelling"].units, "uW cm-2 sr-1 nm-1")
            self.assertEqual(plain["wl"].units, "nm")
        # The rows of the CSV are the same numbers.
        with open(FOLDER / "lut/air_lut.csv") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 20)
        for row in rows:
            at = table["sphalb"].sel(wl=float(row["wl (nm)"]), AOT550=float(row["AOT550 (1)"]),
                                     relative_azimuth=float(row["relative_azimuth (deg)"]))
            self.assertAlmostEqual(float(row["sphalb (1)"]) / float(at), 1, 5)

    def test_zarr_holds_the_same(self):
        """By the specification of version 2, as no reader of Zarr need be installed: one chunk an array, without compression."""
        store, table = FOLDER / "lut/air_lut.zarr", xarray.open_dataset(FOLDER / "lut/air_lut.nc")
        meta = json.loads((store / ".zmetadata").read_text())["metadata"]
        self.assertEqual(json.loads((store / ".zgroup").read_text()), {"zarr_format": 2})
        self.assertEqual(meta[".zattrs"]["RT_mode"], "transm")
        self.assertEqual({name.split("/")[0] for name in meta if "/" in name}, set(table.variables))
        for name, values in table.variables.items():
            about = json.loads((store / name / ".zarray").read_text())
            self.assertEqual((about, about["shape"], about["dtype"], about["compressor"]), (meta[name + "/.zarray"], list(values.shape), "<f8", None))
            self.assertEqual(meta[name + "/.zattrs"]["_ARRAY_DIMENSIONS"], list(values.dims))
            chunk = ".".join("0" * values.ndim) or "0"
            numpy.testing.assert_array_equal(numpy.fromfile(store / name / chunk, "<f8").reshape(values.shape), values)

    def test_what_is_neglected_is_said_with_its_size(self):
        self.assertIn("rhoatm is within", self.said)
        self.assertIn("rhoatm of 1 band(s) below 0.6 um is without polarisation", self.said)
        table = xarray.open_dataset(FOLDER / "lut/air_lut.nc")
        for name in ("rhoatm", "dir-dir", "sphalb"):
            self.assertTrue(bool((table[name + "_error"] > 0).all()), name)
            self.assertTrue(bool((table[name + "_error"] < 0.01).all()), name)

    def test_it_gives_the_radiance_of_a_rendered_ground(self):
        """By paths through the same air: within 1 % and 4 standard errors; without the ground's own light it is not."""
        run("dirsig-render", "sim.yaml", "-o", "out", "-q", "-j", "2")
        values, _ = image(FOLDER / "out/eye.img")
        errors, _ = image(FOLDER / "out/eye_error.img")
        t = xarray.open_dataset(FOLDER / "lut/air_lut.nc").sel(AOT550=0.2, relative_azimuth=90)
        both = sum(t[k] for k in ("dir-dir", "dif-dir", "dir-dif", "dif-dif"))
        sun = 10 * t["solar_irr"] * math.cos(math.radians(SUN)) / math.pi
        made = sun * (t["rhoatm"] + both * REFLECTANCE / (1 - t["sphalb"] * REFLECTANCE))
        path = sun * t["rhoatm"]
        for b in range(5):
            seen, error = values[b].mean(), errors[b].mean() / 3
            print(f"{float(t.wl[b]):.0f} nm: table {float(made[b]):.5g}, paths {seen:.5g} +- {error:.2g}")
            self.assertLess(abs(float(made[b]) - seen), 0.01 * seen + 4 * error, b)
            self.assertGreater(abs(float(path[b]) - seen), 0.01 * seen + 4 * error, b)

    def test_a_stopped_run_goes_on_to_the_same_bytes(self):
        (FOLDER / "long.yaml").write_text(GRID.replace("[0.2, 0.4]", "[0.05, 0.1, 0.15, 0.2, 0.25, 0.3]").replace("45", "0") + "check: false\nstreams: 8\n")
        words = [BIN / "dirsig-render", "sim.yaml", "--air-lut", "long.yaml", "-j", "1", "-o"]
        subprocess.run([*words, "whole"], cwd=FOLDER, capture_output=True, check=True)
        job = subprocess.Popen([*words, "parts"], cwd=FOLDER, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        kept = FOLDER / "parts/air_lut_states"
        while job.poll() is None and not list(kept.glob("*.bin")):
            time.sleep(0.01)
        job.send_signal(signal.SIGTERM)
        said, _ = job.communicate()
        self.assertEqual(job.returncode, 128 + signal.SIGTERM, said)
        self.assertFalse((FOLDER / "parts/air_lut.nc").exists())
        done = len(list(kept.glob("*.bin")))
        self.assertGreater(done, 0)
        again = subprocess.run([*words, "parts"], cwd=FOLDER, capture_output=True, text=True, check=True)
        self.assertIn(f"{done} of 6 states are kept", again.stdout + again.stderr)
        for name in ("air_lut.nc", "air_lut.csv"):
            self.assertEqual((FOLDER / "parts" / name).read_bytes(), (FOLDER / "whole" / name).read_bytes())
        self.assertFalse(kept.exists())

    def test_faults_have_their_place(self):
        for old, new, said in (("AOT550: [0.2, 0.4]", "AOT550: [0.4, 0.2]", r"bad.yaml:2:\d+.*0.2 follows 0.4"),
                               ("solar_zenith: 40", "sun: 40", "solar_zenith"),
                               ("observer_zenith: 45", "observer_zenith: 80", r"bad.yaml:4:\d+.*0 to 75 deg"),
                               ("observer_zenith: 45", "observer_zenit: 45", r"bad.yaml:4:\d+.*did you mean 'observer_zenith'"),
                               ("air_lut: 1", "air_lut: 1\nsensor: ear", "no sensor 'ear'; give `sensor:` one of: eye"),
                               ("observer_altitude_km: 3", "observer_altitude_km: -0.4", r"bad.yaml.*is not above the ground")):
            self.assertIn(old, GRID)
            (FOLDER / "bad.yaml").write_text(GRID.replace(old, new))
            said_by_run = run("dirsig-render", "sim.yaml", "--air-lut", "bad.yaml", "-o", "bad", code=1)
            self.assertRegex(said_by_run.replace("\n", " "), said)
        (FOLDER / "bare.yaml").write_text(SIM.replace(f"atmosphere: {AIR}\n", ""))
        self.assertIn("no real air", run("dirsig-render", "bare.yaml", "--air-lut", "grid.yaml", "-o", "bad", code=1))
        self.assertFalse((FOLDER / "bad/air_lut.nc").exists())


EDGE = """scene: 1
materials:
  cold: {model: lambert, reflectance: 0}
  hot: {model: lambert, reflectance: 0, temperature_k: 4000}
objects: {dark: {plane: {width: 200000, depth: 400000}, material: cold}, bright: {plane: {width: 200000, depth: 400000}, material: hot}}
world: [{place: dark, translate: [-100000, 0, 0]}, {place: bright, translate: [100000, 0, 0]}]
"""
FROM_EDGE_M = [300, 2000]  # over the dark half
EDGE_SIM = f"""scene: edge.h5
atmosphere: {{profile: midlatitude_summer, aerosol: {{model: rural, optical_depth_550: 0.4}}, scattering: traced}}
sun: {{direction: {{zenith_deg: 40, azimuth_deg: 0}}}}
sensors: [%s]
"""
EYE = "{{name: {name}, kind: frame_camera, columns: 1, rows: 1, pitch_um: 1, focal_length_mm: 100, position_m: [{x}, 0, {z}], look_at_m: [{x}, 0, 0], up: [0, 1, 0], " \
      "paths: {paths}, bands: [{{name: g, center_um: 0.55, fwhm_um: 0.01}}, {{name: n, center_um: 0.87, fwhm_um: 0.01}}]}}"
KERNEL = """air_lut: 1
sensor: s0
observer_altitude_km: 20
solar_zenith: 40
streams: 8
check: false
zarr: true
kernel: {radii_km: [0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.8, 1, 1.25, 1.5, 1.75, 2, 2.5, 3, 4, 5, 6, 8, 10, 13, 17, 22, 30, 45, 70], photons: %d}
"""
MANY = bool(os.environ.get("SUITE_LONG"))


class AdjacencyKernel(unittest.TestCase):
    """Light from around over a step edge, which glows so that the sun's light in the air is nothing beside it: the kernel of the table and traced air."""

    @classmethod
    def setUpClass(cls):
        FOLDER.mkdir(parents=True, exist_ok=True)
        (FOLDER / "edge.yaml").write_text(EDGE)
        eyes = [EYE.format(name=f"s{i}", x=-x, z=20000, paths=400000 if MANY else 30000) for i, x in enumerate(FROM_EDGE_M)]
        (FOLDER / "edge_sim.yaml").write_text(EDGE_SIM % ", ".join(eyes))
        (FOLDER / "kernel.yaml").write_text(KERNEL % (65536 if MANY else 8192))
        run("scene-prep", "edge.yaml", "-o", "edge.h5", "-q")
        cls.said = run("dirsig-render", "edge_sim.yaml", "--air-lut", "kernel.yaml", "-o", "kernel")
        run("dirsig-render", "edge_sim.yaml", "-o", "edge", "-q", "-j", "2")
        cls.table = xarray.open_dataset(FOLDER / "kernel/air_lut.nc")

    def half_plane(self, band, distance_km):
        """Share of the light from around that comes from beyond a straight edge, and its error: each ring even."""
        radii = self.table["radius"].values
        edges = numpy.concatenate([[0], radii, [3 * radii[-1]]])
        within = numpy.concatenate([[0], self.table["kernel_within"].values[band], [1]])
        beyond = []
        for inner, outer in zip(edges[:-1], edges[1:]):
            r = numpy.sqrt(numpy.linspace(inner**2, outer**2, 401)[1:])
            beyond.append(numpy.mean(numpy.arccos(numpy.minimum(1, distance_km / r))) / math.pi)
        return float((numpy.diff(within) * beyond).sum()), float(self.table["kernel_within_error"].values[band].max())

    def test_a_step_edge_is_that_of_traced_air(self):
        """Within 4 standard errors or 3 %, at two distances and in two bands; the kernel of half the distances is not."""
        t = self.table
        for i, metres in enumerate(FROM_EDGE_M):
            values, _ = image(FOLDER / f"edge/s{i}.img")
            errors, _ = image(FOLDER / f"edge/s{i}_error.img")
            for b, um in enumerate((0.55, 0.87)):
                glow = 1.191042972e8 / um**5 / math.expm1(14387.76877 / (um * 4000))
                share, error = self.half_plane(b, 1e-3 * metres)
                total = float(t["kernel_total"][b])
                made, seen = glow * total * share, float(values[b].mean())
                sigma = math.hypot(float(errors[b].mean()), glow * total * error)
                print(f"{um} um, {metres} m from the edge: kernel {made:.5g}, traced {seen:.5g} +- {sigma:.2g}, off {100 * (made / seen - 1):+.1f} %")
                self.assertLess(abs(made - seen), max(4 * sigma, 0.03 * seen), (metres, um))
                wrong = glow * total * self.half_plane(b, 2e-3 * metres)[0]
                if metres > 1000:
                    self.assertGreater(abs(wrong - seen), max(4 * sigma, 0.03 * seen), (metres, um))

    def test_it_is_whole(self):
        t = self.table
        self.assertEqual(t["kernel_within"].dims, ("wl", "radius"))
        within = t["kernel_within"].values
        self.assertTrue((numpy.diff(within, axis=1) >= 0).all() and within.max() <= 1)
        for b in range(2):
            total, error = float(t["kernel_total"][b]), float(t["kernel_total_error"][b])
            self.assertLess(abs(total - float(t["transm_up_dif"][b])), 4 * error + 0.01 * total)
            around = total / (total + float(t["transm_up_dir"][b]))
            self.assertAlmostEqual(float(t["kernel_around"][b]), around, 4)
        rings = numpy.diff(numpy.concatenate([[0], t["radius"].values]) ** 2) * math.pi
        numpy.testing.assert_allclose((t["kernel_density"].values * rings).cumsum(1), within, rtol=1e-9)
        self.assertEqual((t["radius"].attrs["units"], t["kernel_density"].attrs["units"]), ("km", "km-2"))
        self.assertIn("adjacency kernels are of views straight down", self.said)
        meta = json.loads((FOLDER / "kernel/air_lut.zarr/.zmetadata").read_text())["metadata"]
        self.assertEqual(meta["kernel_within/.zattrs"]["_ARRAY_DIMENSIONS"], ["wl", "radius"])

    def test_faults_have_their_place(self):
        for new, said in (("kernel: {radii_km: [1, 0.5]}", r"bad.yaml:9:\d+.*0.5 follows 1"), ("kernel: {photons: 3}", r"bad.yaml:9:\d+.*3"),
                          ("kernel: {radius_km: [1]}", r"bad.yaml:9:\d+.*did you mean 'radii_km'")):
            (FOLDER / "bad.yaml").write_text("\n" + re.sub("(?m)^kernel:.*$", new, KERNEL % 64))
            self.assertRegex(run("dirsig-render", "edge_sim.yaml", "--air-lut", "bad.yaml", "-o", "bad", code=1).replace("\n", " "), said)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
