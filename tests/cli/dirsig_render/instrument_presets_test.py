"""Instruments by published numbers: every preset renders, and its noise at a reference radiance is the published one within 10 %, by the
electrons of an even field and the noise of its detector's text; its MTF at Nyquist, by a slanted edge, the published one within 5 %. A sensor that names a preset may change every value of it.
SUITE_LONG=1 instrument_presets_test.py BIN TEXTS FOLDER     # without SUITE_LONG every fourth array of instruments with many

Published: the lines "#: snr ARRAY UM W/(m2 sr um) RATIO", "#: nedt ARRAY UM K K" and "#: mtf ARRAY DIRECTION VALUE" of each text, whose sources the text names.
"""
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

import numpy
import yaml

BIN, TEXTS, FOLDER = (pathlib.Path(p).resolve() for p in sys.argv[1:4])
SCENE = """scene: 1
materials: {grey: {model: lambert, reflectance: 0.1}}
objects: {plate: {plane: {width: 1, depth: 1}, material: grey}}
world: [{place: plate, translate: [90000, 0, 0]}]
"""
WITH_FIGURES = {"aviris_ng", "ecostress", "emit", "hytes", "modis", "msi", "oli_2", "tirs_2", "viirs"}
SAMPLES = 2  # to a side
EVERY = 1 if os.environ.get("SUITE_LONG") else 4


EDGE = """scene: 1
materials: {white: {model: lambert, reflectance: 1}}
objects: {half: {plane: {width: 400000, depth: 800000}, material: white}}
world: [{place: half, rotate: {axis: [0, 0, 1], angle_deg: %.6f}, translate: [%.3f, %.3f, 0]}]
"""
LEAN = math.atan(1 / 11.3)  # a column in eleven rows, at ever other phases
SIDE, PATHS = 48, 512
# All of them where time is no matter; an edge takes some seconds.
MTF_ARRAYS = {"msi": None, "modis": None, "viirs": None} if os.environ.get("SUITE_LONG") else {"msi": ["B4"]}


def run(*words, code=0):
    done = subprocess.run([BIN / words[0], *map(str, words[1:])], cwd=FOLDER, capture_output=True, text=True)
    assert done.returncode == code, (words, done.stdout, done.stderr)
    return done.stdout + done.stderr


def simulate(sensors, out, *words, scene="scene.h5", **keys):
    (FOLDER / (out + ".yaml")).write_text(json.dumps({"scene": scene, "sky": {"radiance": 1, "full_sphere": True}, "sensors": sensors, **keys}))
    shutil.rmtree(FOLDER / out, ignore_errors=True)
    return run("dirsig-render", out + ".yaml", "-o", out, *words)


def image(path):
    """By band, and wavelengths in um."""
    header = pathlib.Path(str(path) + ".hdr").read_text()
    bands, kind = int(re.search(r"bands *= *(\d+)", header)[1]), re.search(r"data type *= *(\d+)", header)[1]
    um = numpy.array([float(x) for x in re.search(r"wavelength *= *\{([^}]*)\}", header)[1].split(",")])
    return numpy.fromfile(path, {"4": "<f4", "12": "<u2"}[kind]).reshape(bands, -1).astype(float), um / (1000 if um.max() > 100 else 1)


def planck(um, kelvin):
    return 1.191042972e8 / um**5 / math.expm1(14387.76877 / (um * kelvin))


def narrow(sensor):
    """Few detectors and lines of every array, a path each."""
    for instrument in sensor["instruments"]:
        instrument["arrays"] = instrument["arrays"][::EVERY if len(instrument["arrays"]) > 9 else 1]
    for array in (a for i in sensor["instruments"] for a in i["arrays"]):
        readout = array["readout"]
        if readout["kind"] == "whisk":
            array["rows"], readout["samples"] = SAMPLES, SAMPLES
        else:
            array["columns"], readout["lines_per_capture"] = SAMPLES, SAMPLES
        array["paths"] = 1
    for task in sensor["tasks"]:
        rate = sensor["instruments"][0]["arrays"][0]["readout"].get("line_rate_hz")
        task["stop"] = (SAMPLES - 0.5) / rate if rate else task["stop"]
    return sensor


def upright(sensor, array, side):
    """One array alone over the edge of edge.yaml, which its middle sees at noon of its capture: `side` detectors and lines, radiance without noise."""
    sensor, whole = json.loads(json.dumps(sensor)), 0
    instrument = next(i for i in sensor["instruments"] if any(a["name"] == array for a in i["arrays"]))
    instrument["arrays"] = [a for a in instrument["arrays"] if a["name"] == array]
    sensor["instruments"], (one,) = [instrument], instrument["arrays"]
    one.pop("detector", None)
    one["paths"] = PATHS
    height, speed = sensor["motion"]["position_m"][2], sensor["motion"]["speed_m_s"]
    readout = one["readout"]
    if readout["kind"] == "whisk":
        one["rows"], readout["samples"] = side, side
        whole = side / readout["sample_rate_hz"]
        instrument["mount"]["start_deg"] = -0.5 * whole * instrument["mount"]["rate_deg_s"]
        sensor["tasks"] = [{"start": 0, "stop": 0.5 * whole}]
    else:
        one["columns"], readout["lines_per_capture"] = side, side
        whole = side / readout["line_rate_hz"]
        sensor["tasks"] = [{"start": 0, "stop": whole * (1 - 0.5 / side)}]
    sensor["motion"] = {"kind": "straight", "position_m": [0, -0.5 * whole * speed, height], "heading_deg": 0, "speed_m_s": speed, "follow_earth": False}
    return sensor


def mtf_at_nyquist(picture):
    """Across columns, of an edge that leans by some columns over the rows: the sampled edge of all rows in one, its derivative's Fourier sum at half a cycle a column."""
    rows, columns = picture.shape
    middle = numpy.arange(columns - 1) + 0.5
    steps = numpy.diff(picture, axis=1)
    places = (steps * middle).sum(1) / steps.sum(1)
    slope, start = numpy.polyfit(numpy.arange(rows), places, 1)
    distance = (numpy.arange(columns) - start - slope * numpy.arange(rows)[:, None]).ravel()
    near = abs(distance) < 3.25  # beyond there is no edge, but noise
    order = numpy.argsort(distance[near])
    distance, edge = distance[near][order], picture.ravel()[near][order]
    # Phases of neighbours differ by the lean alone: their steps stand halfway.
    at = 0.5 * (distance[1:] + distance[:-1])
    steps = numpy.diff(edge)
    return abs((steps * numpy.exp(-1j * numpy.pi * at)).sum()) / abs(steps.sum()) / numpy.sinc(0.5 * math.tan(LEAN))


class Presets(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(FOLDER, ignore_errors=True)
        FOLDER.mkdir(parents=True)
        (FOLDER / "scene.yaml").write_text(SCENE)
        run("scene-prep", "scene.yaml", "-o", "scene.h5", "-q")
        (FOLDER / "edge.yaml").write_text(EDGE % (math.degrees(LEAN), 2e5 * math.cos(LEAN), 2e5 * math.sin(LEAN)))
        run("scene-prep", "edge.yaml", "-o", "edge.h5", "-q")
        cls.names = [line.split()[0] for line in run("dirsig-render", "--list-presets").splitlines()]
        cls.texts = {path.stem: path.read_text() for path in TEXTS.glob("*.yaml")}
        cls.figures = {name: [line.split()[1:] for line in text.splitlines() if line.startswith("#: ")] for name, text in cls.texts.items()}

    def test_every_preset_names_its_sources(self):
        self.assertEqual(sorted(self.names), sorted([*self.texts, "viirs_dnb_like"]))
        for name in ("emit", "vlp_16"):
            self.assertEqual(run("dirsig-render", "--preset", name), self.texts[name])
        for name, text in self.texts.items():
            self.assertRegex(text, r"(?m)^# Source: ", name)
            self.assertEqual(yaml.safe_load(text)[0]["name"], name)
        self.assertEqual({name for name, rows in self.figures.items() if rows}, WITH_FIGURES)
        self.assertIn("did you mean 'emit'", run("dirsig-render", "--preset", "emitt", code=1))

    def ratios(self, sensors, out):
        """Noise over the published one, of each figure, by the electrons of an even field; of thermal bands also what the header states over ours."""
        simulate(sensors, out, "-q", "-j", "2")
        for sensor in sensors:
            arrays = {a["name"]: a for i in sensor["instruments"] for a in i["arrays"]}
            for what, array, um, reference, published in (row for row in self.figures[sensor["name"]] if row[0] != "mtf" and row[1] in arrays):
                um, reference, published = float(um), float(reference), float(published)
                files = sorted((FOLDER / out).glob(f"{sensor['name']}*_electrons.img"))
                path, = files if len(files) == 1 else [f for f in files if f"_{array}_electrons" in f.name]
                electrons, at = image(path)
                of_unit = electrons[int(numpy.argmin(abs(at - um)))].mean()
                detector = arrays[array]["detector"]
                radiance = reference if what == "snr" else planck(um, reference)
                shot = 0 if detector.get("shot_noise") is False else of_unit * radiance
                noise = math.sqrt(shot + detector.get("read_noise_e", 0) ** 2 + detector["gain_e_per_dn"] ** 2 / 12)
                if what == "snr":
                    yield sensor["name"], array, um, published * noise / (of_unit * radiance)
                    continue
                slope = of_unit * (planck(um, reference + 0.01) - planck(um, reference - 0.01)) / 0.02
                header = pathlib.Path(str(path).replace("_electrons", "") + ".hdr").read_text()
                whole, own = (float(x) for x in re.search(r"NETD at %g K: \S+ (\S+) K \((\S+) K of it" % reference, header).groups())
                yield sensor["name"], array, um, whole / published
                yield sensor["name"], array, um, own * slope / noise

    def test_noise_is_the_published_one(self):
        sensors = [narrow(yaml.safe_load(self.texts[name])[0]) for name in sorted(WITH_FIGURES)]
        for name, array, um, ratio in self.ratios(sensors, "all"):
            print(f"{name} {array} {um:.3f} um: noise over the published {ratio:.3f}")
            self.assertLess(abs(ratio - 1), 0.1, (name, array, um))

    def mtfs(self, name, arrays, change=lambda array: None):
        """Array, MTF that an edge shows over the published one."""
        for what, array, _, published in (row for row in self.figures[name] if row[0] == "mtf" and row[1] in arrays):
            sensor = upright(yaml.safe_load(self.texts[name])[0], array, SIDE)
            change(sensor["instruments"][0]["arrays"][0])
            simulate([sensor], "edge", "-q", "-j", "2", scene="edge.h5", sky={"radiance": 1})
            path, = [f for f in (FOLDER / "edge").glob(f"{name}*.img") if not re.search("_(error|quality)[.]img$", f.name)]
            yield array, mtf_at_nyquist(image(path)[0][0].reshape(-1, SIDE)) / float(published)

    def test_an_edge_shows_the_published_mtf(self):
        for name, arrays in MTF_ARRAYS.items():
            for array, ratio in self.mtfs(name, arrays or [row[1] for row in self.figures[name] if row[0] == "mtf"]):
                print(f"{name} {array}: MTF at Nyquist over the published {ratio:.3f}")
                self.assertLess(abs(ratio - 1), 0.05, (name, array))

    def test_without_its_psf_the_edge_is_sharper(self):
        """The control: the same measure refuses detectors alone."""
        for _, ratio in self.mtfs("msi", ["B4"], lambda array: array.pop("psf")):
            self.assertGreater(ratio, 1.5)

    def test_the_list_names_what_each_holds(self):
        said = run("dirsig-render", "--list-presets")
        self.assertRegex(said, r"(?m)^msi .*\[noise: all; MTF: 12 of 13 arrays; bands: rectangular\]$")
        self.assertRegex(said, r"(?m)^emit .*\[noise: all; MTF: none; bands: Gaussian\]$")

    def test_half_the_light_is_seen(self):
        """The same check refuses half the light."""
        sensor = narrow(yaml.safe_load(self.texts["msi"])[0])
        sensor["instruments"][0]["f_number"] *= 1.42
        self.assertTrue(all(abs(ratio - 1) > 0.1 for *_, ratio in self.ratios([sensor], "dark")))

    def polarimeter(self, name):
        """Electrons of each image of a preset under an even sky that is not polarised, of few detectors."""
        sensor = yaml.safe_load(self.texts[name])[0]
        held = [sensor, *sensor.get("attachments", [])]
        for array in (a for part in held for i in part.get("instruments", []) for a in i["arrays"]):
            array["columns"], array["paths"] = SAMPLES, 1
            if array["readout"]["kind"] == "line":
                array["readout"]["lines_per_capture"] = 1
            else:
                array["rows"] = SAMPLES
        simulate([sensor], name, "-q", "-j", "2")
        return {path.stem: numpy.fromfile(path, "<f4").astype(float) for path in sorted((FOLDER / name).glob("*_electrons.img"))}

    def test_polarimeters_split_unpolarised_light(self):
        for name, beams in (("polder_like", 3), ("3mi_like", 3), ("spexone_like", 2)):
            electrons = self.polarimeter(name)
            alike = {}
            for stem, values in electrons.items():
                alike.setdefault((values.shape, re.sub(r"_(\d+|s|p)_electrons$|_electrons$", "", stem)), []).append(values)
            several = [group for group in alike.values() if len(group) > 1]
            print(name, sorted(electrons))
            self.assertTrue(several, (name, sorted(electrons)))
            for group in several:
                self.assertEqual(len(group), beams, (name, sorted(electrons)))
                for values in group:
                    self.assertTrue(numpy.allclose(values, group[0], rtol=1e-4), name)

    def test_a_sensor_names_a_preset_and_changes_it(self):
        small = {"kind": "platform", "preset": "msi", "name": "mine", "tasks": [{"start": 0, "stop": 0.001}],
                 "instruments": [{"name": "imager", "f_number": None, "aperture_mm": 75,
                                  "arrays": [{"name": "B4", "columns": 2}, {"name": "B3", "columns": 3, "detector": {"quantum_efficiency": 0.25}}]}]}
        simulate([small, {"preset": "vlp_16", "name": "spinning", "tasks": [{"start": 0, "pulses": 1}]}], "named", "-q", "--paths", "2")
        found = {f.name for f in (FOLDER / "named").glob("mine*_electrons.img")}
        self.assertEqual(found, {"mine_B4_electrons.img", "mine_B3_electrons.img"})
        # Electrons of f/8 and an efficiency of 0.25, where the preset has f/4 and 0.5429.
        simulate([{"preset": "msi", "tasks": [{"start": 0, "stop": 0.001}], "instruments": [{"name": "imager", "arrays": [{"name": "B3", "columns": 2}]}]}], "whole", "-q")
        at = lambda name: image(FOLDER / name)[0].mean()
        self.assertAlmostEqual(at("named/mine_B3_electrons.img") / at("whole/msi_electrons.img"), 0.25 / 0.5429 * (1 + 4 * 16) / (1 + 4 * 64), 3)
        simulate([{"preset": "emit"}], "set", "--dry-run", "--set", "sensors.0.preset=msi", "--set", "sensors.0.instruments.imager.arrays.B2.columns=7")

    def test_faults_have_their_place(self):
        for sensors, said in (('[{preset: emitt}]', r"bad.yaml:2:\d+.*did you mean 'emit'"),
                              ('[{preset: emit, kind: lidar}]', r"bad.yaml:2:\d+.*is a sensor of kind 'platform'"),
                              ('[{preset: emit, taks: []}]', r"bad.yaml:2.*did you mean 'tasks'"),
                              ('[{preset: emit, instruments: [{name: spectrometer, f_number: -1}]}]', r"bad.yaml:2.*-1"),
                              ('[{preset: emit, instruments: [{name: spectrometer, aperture_mm: 100}]}]', r"aperture_mm|f_number")):
            (FOLDER / "bad.yaml").write_text("scene: scene.h5\nsensors: " + sensors + "\n")
            self.assertRegex(run("dirsig-render", "bad.yaml", "--dry-run", "-o", "bad", code=1).replace("\n", " "), said)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
