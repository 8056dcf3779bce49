"""What objects are written as, and what is refused before it is written."""
import datetime
import unittest
from pathlib import Path

import numpy as np
import xarray as xr
import yaml

import remote_scenes as rs
from kit import Case
from remote_scenes.tree import plain, to_text


class Texts(Case):
    def test_values_become_those_of_the_grammar(self):
        noon = datetime.datetime(2026, 6, 21, 12, 30, tzinfo=datetime.timezone(datetime.timedelta(hours=2)))
        scene = rs.Scene("a: b", epoch=noon, windows_um=np.array([[0.4, 1.0]]))
        measured = xr.DataArray([0.3, 0.1], dims="band", coords={"wavelength_um": ("band", [0.9, 0.4])})
        scene.add("x", rs.sphere(np.float32(0.5)), material=rs.Material("lambert", reflectance=measured), translate=(1, 2, 3))
        scene.materials["y"] = rs.Material("mirror", reflectance=rs.Curve(np.array([0.4, 1]), [0.5, 0.6], outside="hold"))
        scene.materials["z"] = rs.Material("lambert", reflectance=rs.CurveFile("z.txt", column=2))
        tree = yaml.safe_load(to_text(scene, self.folder / "s.yaml"))
        self.assertEqual(tree["scene"], 1)
        self.assertEqual(tree["name"], "a: b")
        self.assertEqual(tree["epoch"], "2026-06-21T10:30:00Z")
        self.assertEqual(tree["windows_um"], [[0.4, 1.0]])
        self.assertEqual(tree["materials"]["x"], {"model": "lambert", "reflectance": {"wavelength_um": [0.4, 0.9],
                                                                                     "value": [0.1, 0.3]}})
        self.assertEqual(tree["materials"]["y"]["reflectance"], {"wavelength_um": [0.4, 1.0], "value": [0.5, 0.6],
                                                                 "outside": "hold"})
        self.assertEqual(tree["materials"]["z"]["reflectance"], {"file": "z.txt", "column": 2})
        self.assertEqual(tree["objects"]["x"], {"sphere": {"radius": 0.5}, "material": "x"})
        self.assertEqual(tree["world"], [{"place": "x", "translate": [1, 2, 3]}])
        self.assertNotIn("groups", tree)

    def test_every_float_comes_back(self):
        numbers = [0.1, 1 / 3, 1e-5, 6.02e23, -1e22, 5e-324, 123456789.123456789]
        curve = rs.Simulation("s.h5", more={"numbers": numbers})
        self.assertEqual(yaml.safe_load(to_text(curve, "x.yaml"))["numbers"], numbers)

    def test_paths_count_from_the_working_folder_and_names_from_the_text(self):
        scene = rs.Scene()
        scene.add("a", rs.mesh(Path("a.obj")), tag="a")
        scene.add("b", rs.mesh("b.obj"))
        text = self.folder / "sub/s.yaml"
        tree = yaml.safe_load(to_text(scene, text))
        self.assertEqual((text.parent / tree["objects"]["a"]["obj"]).resolve(), Path("a.obj").resolve())
        self.assertEqual(tree["objects"]["b"]["obj"], "b.obj")

    def test_names_are_of_one_thing(self):
        scene = rs.Scene()
        shape, grey = rs.box([0, 0, 0], [1, 1, 1]), rs.Material("lambert", reflectance=np.array([0.3]).item())
        scene.add("a", shape, material=grey)
        scene.add("b", shape, material=rs.Material("lambert", reflectance=rs.Curve(np.array([0.4, 0.7]), np.array([0.2, 0.5]))))
        scene.add("a", shape, material=grey, translate=[5, 0, 0])  # the same once more
        scene.add("a", translate=[9, 0, 0])
        self.assertEqual([scene.objects[name].material for name in "ab"], ["a", "b"])
        self.assertIsNone(shape.material)
        self.assertEqual([p.place for p in scene.world], ["a", "b", "a", "a"])
        for thing, material, said in ((rs.sphere(1), None, "objects has another 'a'"), (shape, None, "objects has another 'a'"),
                                      (shape, rs.Material("lambert", reflectance=0.9), "materials has another 'a'")):
            with self.assertRaisesRegex(ValueError, said):
                scene.add("a", thing, material=material)
        with self.assertRaisesRegex(TypeError, "plane.material='grey'"):
            scene.add("c", rs.plane(), material="grey")
        self.assertEqual(len(scene.world), 4)

    def test_what_has_no_place_in_a_text_is_refused_with_its_key(self):
        for value, said in ((object(), "world.0.tag: a object has no place"), (datetime.datetime(2026, 1, 1), "no time zone"),
                            (xr.DataArray([1.0, 2.0], dims="band"), "wavelength_um")):
            with self.assertRaisesRegex((TypeError, ValueError), said):
                plain({"world": [{"tag": value}]})

    def test_unknown_keys_are_refused_and_more_is_written(self):
        camera = rs.Orthographic(columns=1, rows=1, gsd_m=1)
        with self.assertRaisesRegex(AttributeError, "no key 'gsd'"):
            camera.gsd = 2
        with self.assertRaises(TypeError):
            rs.Orthographic(columns=1, rows=1, gsd=1)
        camera.more["flip"] = ["columns"]
        self.assertEqual(plain(camera)["flip"], ["columns"])

    def test_a_misspelt_key_names_the_nearest(self):
        with self.assertRaisesRegex(TypeError, "Orthographic has no key 'column'; did you mean 'columns'"):
            rs.Orthographic(column=3, rows=2, gsd_m=1)

    def test_texts_by_hand_are_never_replaced(self):
        path = self.folder / "s.yaml"
        scene = rs.Scene("one")
        scene.write(path)
        scene.name = "two"
        scene.write(path)
        self.assertIn("two", path.read_text())
        with self.assertRaises(FileExistsError):  # the text of a scene is none of a simulation
            rs.Simulation("s.h5").write(path)
        path.write_text("scene: 1\nworld: []\n")
        with self.assertRaises(FileExistsError):
            scene.write(path)
        self.assertEqual(path.read_text(), "scene: 1\nworld: []\n")
        self.assertEqual([p.name for p in self.folder.iterdir()], ["s.yaml"])

    def test_bands_are_even(self):
        made = rs.bands(0.4, 0.5, 3, fwhm_um=0.01)
        self.assertEqual([(b.name, b.center_um, b.fwhm_um) for b in made],
                         [("400 nm", 0.4, 0.01), ("450 nm", 0.45, 0.01), ("500 nm", 0.5, 0.01)])


if __name__ == "__main__":
    unittest.main()
