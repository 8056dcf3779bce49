"""Results as datasets: the numbers of the files bit for bit, and what is told about them, held against readers that know
nothing of the package (struct, GDAL)."""
import json
import struct
import subprocess
import unittest
from pathlib import Path

import numpy as np
import xarray as xr

import remote_scenes as rs
from kit import BANDS, Case, by_day, envi_values, lawn_with_things


def bits(array):
    """An array's numbers as bytes, so that NaN equals NaN and 0 is not -0."""
    return np.ascontiguousarray(array).astype(array.dtype.newbyteorder("<"), copy=False).tobytes()


def gdal(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


class Rendered(Case):
    def map(self, **more):
        return rs.Orthographic(**{"name": "map", "columns": 24, "rows": 18, "gsd_m": 0.8, "bands": BANDS, "paths": 4,
                                  "truth": ["tag", "instance", "material", "reflectance", "range"], **more})

    def render(self, *sensors, **more):
        return by_day(lawn_with_things().prepare(self.folder / "lawn.h5"), list(sensors), **more).render(self.folder / "out")

    def test_every_number_has_the_bits_of_the_file(self):
        dataset = self.render(self.map())["map"]
        stored = {"radiance": "map", "standard_error": "map_error", "quality": "map_quality", "material": "map_material",
                  "tag": "map_tag"}
        for variable, name in stored.items():
            values, keys = envi_values(self.folder / f"out/{name}.img")
            array = dataset[variable].values
            array = array if array.ndim == 3 else array[None]
            kind = {"4": "f", "1": "B"}[keys["data type"]]
            self.assertEqual(array.tobytes(), struct.pack(f"<{array.size}{kind}", *(v for b in values for l in b for v in l)))
        truth, keys = envi_values(self.folder / "out/map_truth.img")
        columns = [dataset[f"truth_{n}"].values[None] for n in ("tag", "instance", "material")]
        columns += [dataset["truth_reflectance"].values, dataset["truth_range"].values[None]]
        self.assertEqual(bits(np.concatenate(columns)), struct.pack(f"<{7 * 24 * 18}d", *(v for b in truth for l in b for v in l)))
        self.assertGreater(float(dataset.standard_error.min()), 0)

    def test_pixels_and_places_are_those_of_gdal(self):
        dataset = self.render(self.map())["map"]
        told = json.loads(gdal("gdalinfo", "-json", str(self.folder / "out/map.img")))
        west, dx, _, north, _, dy = told["geoTransform"]
        np.testing.assert_allclose(dataset.x, west + (np.arange(24) + 0.5) * dx, rtol=0, atol=1e-9)
        np.testing.assert_allclose(dataset.y, north + (np.arange(18) + 0.5) * dy, rtol=0, atol=1e-9)
        for column, row in ((0, 0), (23, 0), (5, 17)):
            values = gdal("gdallocationinfo", "-valonly", str(self.folder / "out/map.img"), str(column), str(row)).split()
            np.testing.assert_array_equal(np.array(values, dtype=np.float32), dataset.radiance.values[:, row, column])
        # The place of a pixel is where its rays met the ground.
        located = self.render(self.map(truth=["location"]))["map"]
        np.testing.assert_allclose(located.truth_east, np.broadcast_to(located.x, (18, 24)), atol=0.4)
        np.testing.assert_allclose(located.truth_north, np.broadcast_to(located.y.values[:, None], (18, 24)), atol=0.4)

    def test_wavelengths_units_and_meanings(self):
        dataset = self.render(self.map())["map"]
        self.assertEqual(list(dataset.band.values), ["red", "nir", "green"])
        self.assertEqual(list(dataset.wavelength_um.values), [0.65, 0.85, 0.55])
        self.assertEqual(list(dataset.fwhm_um.values), [0.03, 0.04, 0.03])
        self.assertEqual(dataset.wavelength_um.attrs["units"], "um")
        self.assertEqual(dataset.radiance.attrs["units"], "W m-2 sr-1 um-1")
        self.assertEqual(dataset.standard_error.attrs["units"], "W m-2 sr-1 um-1")
        self.assertEqual(dataset.truth_range.attrs["units"], "m")
        self.assertGreater(dataset.standard_error.attrs["standard_errors_of_95_percent"], 1.9)
        self.assertEqual(dataset.material.attrs["class_names"], ["nothing", "lawn", "car", "ring"])
        self.assertEqual(dataset.tag.attrs["flag_meanings"], "untagged car ring_big")
        self.assertEqual(list(dataset.quality.attrs["flag_masks"]), [1, 2, 4, 8, 16, 32])
        self.assertEqual(dataset.time.values, np.datetime64("2026-06-21T10:30:00"))
        self.assertAlmostEqual(dataset.attrs["sun_azimuth_deg"], 151.5, delta=0.1)
        lawn = dataset.truth_reflectance.where(dataset.material == 1)
        np.testing.assert_allclose(lawn.mean(["x", "y"]), 0.2, atol=0.1)

    def test_counts_come_in_their_unit(self):
        settings = {"seed": 7}
        sensors = [self.map(truth=["range"])]
        exact = self.render(*sensors, output=rs.Output(type="float64"), **settings)["map"].radiance.values.copy()
        counted = self.render(*sensors, output=rs.Output(type="uint16", scale=0.01), **settings)["map"].radiance
        self.assertEqual(exact.dtype, np.float64)
        np.testing.assert_allclose(counted.values, exact, rtol=0, atol=0.005 + 1e-9)
        counts = rs.open_envi(self.folder / "out/map.img")
        self.assertEqual((counts.dtype, counts.attrs["scale_factor"]), (np.uint16, 0.01))

    def test_a_geolocation_puts_pixels_on_the_map(self):
        camera = rs.FrameCamera(name="cam", columns=30, rows=20, pitch_um=500, focal_length_mm=20, position_m=[0, -30, 40],
                                look_at_m=[0, 0, 0], bands=BANDS[:1], paths=4, geolocation=True)
        result = self.render(camera)
        image, table = result["cam"], result.lookup_table("cam")
        self.assertEqual(image.longitude.dims, ("y", "x"))
        self.assertEqual(image.longitude.attrs["units"], "degrees_east")
        np.testing.assert_allclose(image.latitude, 49.4, atol=0.001)
        radiance = result.on_map("cam")
        seen = 0
        for row in range(radiance.sizes["y"]):
            for column in range(radiance.sizes["x"]):
                line, sample = int(table.line[row, column]), int(table.sample[row, column])
                value = radiance.values[0, row, column]
                if line == 0:
                    self.assertTrue(np.isnan(value))
                else:
                    seen += 1
                    self.assertEqual(value, image.radiance.values[0, abs(line) - 1, abs(sample) - 1])
        self.assertGreater(seen, 300)
        told = json.loads(gdal("gdalinfo", "-json", str(self.folder / "out/cam_glt.img")))
        west, dx, _, north, _, dy = told["geoTransform"]
        np.testing.assert_allclose([radiance.x[0], radiance.y[0]], [west + dx / 2, north + dy / 2], rtol=0, atol=1e-6)
        self.assertEqual(radiance.spatial_ref.attrs["longitude_of_central_meridian"], 9)
        self.assertIn('"EPSG","32632"', radiance.spatial_ref.attrs["crs_wkt"])
        classes = result.on_map("cam", "material")
        self.assertEqual(classes.dtype, np.uint8)
        self.assertTrue((classes.values[table.line.values == 0] == 0).all())

    def test_points_have_their_own_units(self):
        points = rs.Points(name="points", bands=BANDS, paths=64, collectors=[
            {"name": "up", "quantity": "irradiance", "position_m": [0, 0, 9], "normal": [0, 0, 1]},
            {"name": "down", "quantity": "radiance", "position_m": [0, 0, 9], "look": [0, 0, -1]}])
        result = self.render(points)
        dataset = result["points"]
        self.assertEqual(list(dataset.unit.values), ["W m-2 um-1", "W m-2 sr-1 um-1"])
        self.assertEqual(list(dataset.collector.values), ["up", "down"])
        self.assertNotIn("units", dataset.value.attrs)
        table = result.table("points")
        np.testing.assert_allclose(dataset.value.values[:, 0, :].T.ravel(), table["value"], rtol=1e-6)
        # A level Lambert plane of 20 % sends back E rho / pi.
        expected = dataset.value[:, 0, 0] * 0.2 / np.pi
        np.testing.assert_allclose(dataset.value[:, 0, 1], expected, rtol=0.03)

    def test_captures_are_joined(self):
        platform = rs.Sensor("platform", name="uas", motion={"kind": "straight", "position_m": [0, -20, 50], "heading_deg": 0,
                                                             "speed_m_s": 10}, tasks=[{"start": 0, "stop": 2}],
                             instruments=[{"focal_length_mm": 10, "clock": {"rate_hz": 1}, "arrays": [
                                 {"columns": 6, "rows": 4, "pitch_um": 200, "paths": 4, "bands": BANDS[:2]}]}])
        result = self.render(platform)
        self.assertGreaterEqual(len(result.images), 2)
        series = result.series("uas")
        self.assertEqual(series.radiance.dims, ("capture", "band", "y", "x"))
        for i, name in enumerate(result.images):
            self.assertEqual(bits(series.radiance.values[i]), bits(result[name].radiance.values))
            self.assertEqual(series.time.values[i], np.datetime64("2026-06-21T10:30:00") + np.timedelta64(i, "s"))
        self.assertIn("captures of 'uas'", series.attrs["description"])
        correlation = result.error_correlation(result.images[0])
        self.assertEqual(float(correlation.sel(band="nir", other_band="nir")), 1)
        with self.assertRaisesRegex(KeyError, "uas_0000"):
            result["uas"]

    def test_what_an_earlier_run_left_is_no_part_of_a_later_one(self):
        self.render(self.map())
        later = self.render(self.map(truth=["range"]))
        self.assertNotIn("tag", later["map"])
        self.assertIn("truth_range", later["map"])
        self.render(self.map(truth=["range"]), seed=2)
        rs.render(self.folder / "out.yaml", self.folder / "out", threads=1)
        with self.assertWarnsRegex(UserWarning, r"map_tag.img is left out: it was made by '.*', map.img by '.* --threads 1'"):
            self.assertNotIn("tag", rs.Result(self.folder / "out")["map"])

    def test_netcdf_keeps_numbers_and_meanings(self):
        dataset = self.render(self.map())["map"]
        path = rs.write_netcdf(dataset, self.folder / "map.nc")
        with xr.open_dataset(path, mask_and_scale=False) as back:
            for name in dataset.data_vars:
                self.assertEqual(back[name].dims, dataset[name].dims)
                self.assertEqual(bits(back[name].values), bits(dataset[name].values), name)
            self.assertEqual(back.attrs["Conventions"], "CF-1.10")
            self.assertIn("dirsig-render", back.attrs["history"])
            self.assertEqual(list(back.set_index(band="band_name").radiance.sel(band="nir").shape), [18, 24])
            for name in back.indexes:  # coordinates of CF are numbers
                self.assertEqual(back[name].dtype.kind, "f")
            self.assertEqual(back.radiance.attrs["units"], "W m-2 sr-1 um-1")
            self.assertEqual(back.tag.attrs["flag_meanings"], "untagged car ring_big")
            self.assertEqual(list(back.quality.attrs["flag_masks"]), [1, 2, 4, 8, 16, 32])
            self.assertEqual(back.time.values, np.datetime64("2026-06-21T10:30:00"))
        told = json.loads(gdal("gdalinfo", "-json", f"NETCDF:{path}:radiance"))
        image = json.loads(gdal("gdalinfo", "-json", str(self.folder / "out/map.img")))
        np.testing.assert_allclose(told["geoTransform"], image["geoTransform"], rtol=0, atol=1e-9)
        self.assertIn("Orthographic", told["coordinateSystem"]["wkt"])
        dataset.to_netcdf(self.folder / "plain.nc")
        with xr.open_dataset(self.folder / "plain.nc") as back:
            self.assertEqual(bits(back.radiance.values), bits(dataset.radiance.values))
        self.assertEqual(sorted(p.name for p in self.folder.glob("*.nc*")), ["map.nc", "plain.nc"])


class Envi(Case):
    """Images of other programs: every type, order of numbers and order of bytes, an offset, other units."""

    def write(self, kind, code, interleave, big, values, more=""):
        bands, lines, samples = values.shape
        axes = {"bsq": (0, 1, 2), "bil": (1, 0, 2), "bip": (1, 2, 0)}[interleave]
        raw = values.transpose(axes).astype(np.dtype(kind).newbyteorder(">" if big else "<")).tobytes()
        (self.folder / "x.img").write_bytes(b"offset!" + raw)
        (self.folder / "x.img.hdr").write_text(
            f"ENVI\nsamples = {samples}\nlines = {lines}\nbands = {bands}\nheader offset = 7\ndata type = {code}\n"
            f"interleave = {interleave}\nbyte order = {int(big)}\n{more}")
        return self.folder / "x.img"

    def test_every_type_and_order(self):
        rng = np.random.default_rng(1)
        for code, kind in {1: "u1", 2: "i2", 3: "i4", 4: "f4", 5: "f8", 12: "u2", 13: "u4", 14: "i8", 15: "u8"}.items():
            raw = rng.integers(0, 256, (3, 4, 5, np.dtype(kind).itemsize), dtype=np.uint8)
            values = raw.view(kind)[..., 0]
            for interleave in ("bsq", "bil", "bip"):
                for big in (False, True):
                    path = self.write(kind, code, interleave, big, values)
                    read = rs.open_envi(path)
                    self.assertEqual(bits(read.values), bits(values), (kind, interleave, big))
                    mine, _ = envi_values(path)
                    theirs = np.array(mine, dtype=kind)
                    self.assertTrue(np.array_equal(theirs, read.values, equal_nan=kind[0] == "f"))

    def test_other_units_of_wavelength_and_turned_maps(self):
        values = np.zeros((2, 3, 4), np.float32)
        path = self.write("f4", 4, "bsq", False, values, "wavelength units = Nanometers\nwavelength = {400.5, 900}\n"
                          "map info = {UTM, 1.5, 1.5, 500000, 4000000, 2, 3, 33, South, WGS-84, units=Meters}\n")
        image = rs.open_envi(path)
        np.testing.assert_allclose(image.wavelength_um, [0.4005, 0.9], rtol=1e-15)
        self.assertEqual([*image.x.values[:2], *image.y.values[:2]], [500000, 500002, 4000000, 3999997])
        self.assertIn("32733", image.spatial_ref.attrs["crs_wkt"])
        path = self.write("f4", 4, "bsq", False, values, "map info = {UTM, 1, 1, 0, 0, 2, 2, 33, North, WGS-84, rotation=30}\n")
        self.assertNotIn("x", rs.open_envi(path).coords)

    def test_damaged_images_are_refused_with_their_place(self):
        values = np.zeros((2, 3, 4), np.float32)
        for more, said in (("samples = 4\n", r"x.img.hdr:9: 'samples' stands there twice"), ("nonsense\n", r":9: 'nonsense' is not"),
                           ("wavelength = {1, 2\n", r":9: the braces of 'wavelength'"), ("wavelength = {1, 2, 3}\n", "3 numbers"),
                           ("wavelength = {1, x}\n", "no list of numbers"), ("wavelength = {1, 2}\n", "wavelength units"),
                           ("band names = {a}\n", "1 band names for 2 bands")):
            with self.assertRaisesRegex(rs.FormatError, said):
                rs.open_envi(self.write("f4", 4, "bsq", False, values, more))
        path = self.write("f4", 4, "bsq", False, values)
        path.write_bytes(path.read_bytes()[:-1])
        with self.assertRaisesRegex(rs.FormatError, "102 bytes; its header says 103"):
            rs.open_envi(path)
        for line, wrong in (("data type = 4", "data type = 6"), ("bands = 2", "bands = 0"), ("interleave = bsq", "interleave = x")):
            header = Path(str(path) + ".hdr")
            text = header.read_text()
            header.write_text(text.replace(line, wrong))
            with self.assertRaises(rs.FormatError):
                rs.open_envi(path)
            header.write_text(text)
        with self.assertRaisesRegex(rs.FormatError, "no header"):
            rs.open_envi(self.folder / "none.img")
        with self.assertRaises(FileNotFoundError):
            rs.Result(self.folder / "none")


if __name__ == "__main__":
    unittest.main()
