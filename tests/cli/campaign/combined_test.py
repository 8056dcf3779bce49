"""Campaigns with what simulations have besides cameras in sunlight: presets of instruments, Stokes vectors, laser radars, the night's sky;
and with samples that are refused."""
import json
import subprocess
import sys
import unittest

import numpy as np
from kit import CAMPAIGN, SCENE, SIMULATION, SOME_REFUSED, Case, hashes
from remote_scenes.campaign import CampaignError, forecast, preview, read_campaign, run
from remote_scenes.envi import read_values
from remote_scenes.lidar import read_points

FORMATS = "formats: [coco, panoptic, dota, yolo, yolo_obb, geojson, webdataset, zarr, stac, croissant]\n"
HEAD = "scene: none.h5\nsun: {direction: {zenith_deg: 40, azimuth_deg: 120}}\nsky: {kind: clear}\nmax_nodes: 3\nsensors:\n"
MAP = SIMULATION.partition("sensors:\n")[2]


class Combined(Case):
    def made(self, simulation, campaign=CAMPAIGN, scene=SCENE, formats=FORMATS):
        """Two samples in all formats, the same by one worker; the folder and their records."""
        path = self.write(campaign.replace("samples: 5", "samples: 2\n" + formats), scene, simulation)
        folder = self.folder / "out"
        self.assertTrue(run(path, folder, workers=0).complete)
        run(path, self.folder / "again", workers=1)
        self.assertEqual(hashes(folder), hashes(self.folder / "again"))
        self.assertGreater(forecast(read_campaign(path), "v", 1).bytes, 0)
        self.assertGreater(len(json.loads((folder / "annotations.json").read_text())["annotations"]), 1)
        return folder, [json.loads((folder / f"samples/{i:06d}/sample.json").read_text()) for i in range(2)]

    def test_presets(self):
        """A band of a platform by its preset, of which a key is varied; a laser radar by its preset."""
        sensor = ("  - preset: msi\n    name: sentinel\n    motion: {kind: straight, position_m: [0, -12, 60000], heading_deg: 0, speed_m_s: 500}\n    tasks: [{start: 0, stop: 0.05}]\n"
                  "    instruments: [{name: imager, arrays: [{name: B4, columns: 32}]}]\n")
        place = "simulation.sensors.sentinel.instruments.imager.arrays.B4.columns"
        folder, records = self.made(HEAD + sensor + "  - {preset: vlp_16, motion: {kind: static, position_m: [0, -14, 2]}, tasks: [{start: 0, stop: 0.002}], gate: {start_m: 1, stop_m: 40, bin_ns: 1}}\n",
                                    CAMPAIGN.replace("vary:\n", f"vary:\n  {place}: {{grid: [30, 32]}}\n"), formats=FORMATS.replace("zarr, ", ""))  # images of two sizes
        for record in records:
            self.assertEqual({i["width"] for i in record["images"]}, {record["values"][place]})
            self.assertTrue(all(label["obb_of"] == "mask" for i in record["images"] for label in i["labels"]))
            self.assertEqual([one["name"] for one in record["lidars"]], ["vlp_16"])

    def test_stokes(self):
        """I, Q and U of a band, of glossy roofs seen at a slant: labels have the spectra of all, signs are no hindrance, and degree and angle stay beside the image."""
        camera = ("  - {kind: frame_camera, name: chip, columns: 32, rows: 32, pitch_um: 40, focal_length_mm: 1.5, position_m: [0, -24, 16], look_at_m: [0, 0, 0], paths: 4, stokes: linear,\n"
                  "     bands: [{name: red, center_um: 0.65, fwhm_um: 0.03}]}\n")
        shiny = SCENE.replace("paint: {model: lambert, reflectance: 0.5}", "paint: {model: dielectric, index: 1.5}")
        folder, records = self.made(HEAD + camera, CAMPAIGN.replace("seed: 3", "seed: 3\nkeep: [image, error, polarisation]"), shiny)
        files = {p.name for p in (folder / "samples/000000").iterdir()}
        self.assertTrue({"chip_polarisation.img", "chip_polarisation.img.hdr"} <= files, files)
        image = records[0]["images"][0]
        self.assertEqual(image["bands"], ["red I", "red Q", "red U", "red depolarised"])
        self.assertEqual(set(image["labels"][0]["spectrum"]), {*image["bands"]})
        values = read_values(folder / "samples/000000/chip.img")
        self.assertGreater(np.abs(values[1]).max(), 0.01 * values[0].max())
        self.assertTrue(all(label["snr"]["red Q"] is None or label["snr"]["red Q"] >= 0 for label in image["labels"]))

    def test_lidar(self):
        """A laser radar beside the map: its points are of the sample, and have the numbers of its objects."""
        lidar = ("  - kind: lidar\n    name: als\n    motion: {kind: straight, position_m: [0, -8, 300], heading_deg: 0, speed_m_s: 60}\n    tasks: [{start: 0, stop: 0.2}]\n"
                 "    laser: {wavelength_um: 1.064, pulse_energy_j: 1.0e-5, rate_hz: 3000, pulse: {kind: gaussian, fwhm_ns: 4}, beam: {kind: gaussian, full_angle_1_e2_mrad: 0.5}}\n"
                 "    receiver: {aperture_mm: 100, field_of_view_mrad: 1.5, filter_nm: 1}\n    scanner: {kind: sweep, half_angle_deg: 2, rate_hz: 40}\n"
                 "    gate: {start_m: 280, stop_m: 310, bin_ns: 0.25}\n    orders: 2\n    paths: 16\n"
                 "    detectors: [{kind: linear, name: points, quantum_efficiency: 0.8, receiver_fwhm_ns: 1, amplifier_noise_e_per_ns: 10, returns: {by: gaussian, threshold_e_per_ns: 100}}]\n")
        campaign = CAMPAIGN.replace("vary:\n", "vary:\n  simulation.sensors.als.laser.pulse_energy_j: {uniform: [0.5e-5, 1.5e-5]}\n")
        folder, records = self.made(HEAD + MAP + lidar, campaign)
        hits = []
        for i, record in enumerate(records):
            (als,) = record["lidars"]
            self.assertEqual((als["name"], als["files"], {*als["tags"]}), ("als", ["als_detect.json", "als_points.las"], {o["tag"] for o in record["objects"]}))
            cloud = read_points(folder / f"samples/{i:06d}/als_points.las")
            of = {o["tag"]: cloud["tag"].values == als["tags"][o["tag"]] for o in record["objects"]}
            middles = [np.array([float(cloud[c].values[of[o["tag"]]].mean()) for c in "xy"]) - o["position_m"][:2] for o in record["objects"] if of[o["tag"]].sum() > 2]
            # From the scene's to the map's metres is a shift, but for 5 cm.
            hits += [np.abs(m - np.median(middles, axis=0)).max() for m in middles]
            self.assertGreater((cloud["tag"].values == 0).sum(), 100)  # the ground
        self.assertGreater(len(hits), 4)
        self.assertLess(max(hits), 3)

    def test_night_sky(self):
        """Samples are as bright as the airglow that is drawn for them."""
        night = ("scene: none.h5\nepoch: 2026-03-20T23:00:00Z\nnight_sky: {scale: {airglow: 1.3}}\nmax_nodes: 3\nsensors:\n" + MAP.replace("paths: 4", "paths: 16"))
        campaign = CAMPAIGN.replace("simulation.sun.direction.zenith_deg: {uniform: [20, 60]}", "simulation.night_sky.scale.airglow: {grid: [0.5, 3]}")
        folder, records = self.made(night, campaign.replace("{choice: [0.08, 0.12]}", "0.1"))
        dim, bright = (float(np.mean(read_values(folder / f"samples/{i:06d}/chip.img"))) for i in range(2))
        self.assertTrue(1e-7 < 1.5 * dim < bright < 1e-4, (dim, bright))
        self.assertEqual([r["values"]["simulation.night_sky.scale.airglow"] for r in records], [0.5, 3])


class Refused(Case):
    def test_samples_that_a_worker_refuses(self):
        """As by the process itself (engine_test.py); the forecast and the preview take what can be made."""
        path = self.write(SOME_REFUSED)
        done = subprocess.run([sys.executable, "-B", "-m", "remote_scenes.campaign", path, "-o", self.folder / "out", "--workers", "2", "-q"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 1, done)
        self.assertRegex(done.stderr, r"^\S*campaign.yaml:\d+:\d+: error: sample 0: .*\(2 of 3 samples were refused: 0, 2; the others are there\)\n$")
        self.assertEqual([p.name for p in (self.folder / "out/samples").iterdir()], ["000001"])
        self.assertEqual(forecast(read_campaign(path), "v", 1).pilots, 1)
        with self.assertRaisesRegex(CampaignError, "2 of 3 samples were refused"):
            preview(path, self.folder / "sheet.png", workers=1)
        self.assertTrue((self.folder / "sheet.png").is_file())


if __name__ == "__main__":
    unittest.main()
