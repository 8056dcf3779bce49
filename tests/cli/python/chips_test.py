"""Chips with labels: held against the truth by decoders of the tests' own."""
import json
import unittest

import numpy as np

import remote_scenes as rs
from kit import BANDS, Case, by_day, lawn_with_things, png_pixels
from remote_scenes.chips import _polygons, _run_lengths


def decoded(segmentation):
    """The mask of run lengths, down the columns."""
    rows, columns = segmentation["size"]
    flat, value = [], False
    for count in segmentation["counts"]:
        flat += [value] * count
        value = not value
    assert len(flat) == rows * columns
    return np.array(flat).reshape(columns, rows).T


def filled(rings, shape):
    """Pixels whose centres lie inside an odd number of outlines."""
    mask = np.zeros(shape, bool)
    for ring in rings:
        corners = list(zip(ring[::2], ring[1::2]))
        for (x0, y0), (x1, y1) in zip(corners, corners[1:] + corners[:1]):
            if x0 == x1:
                for y in range(min(y0, y1), max(y0, y1)):
                    mask[y, x0:] ^= True
    return mask


class Shapes(unittest.TestCase):
    def test_codes_of_random_masks_come_back(self):
        rng = np.random.default_rng(2)
        holes = 0
        for i in range(300):
            mask = rng.random((rng.integers(1, 12), rng.integers(1, 12))) < rng.choice([0.2, 0.5, 0.8, 1.0])
            code = {"size": mask.shape, "counts": _run_lengths(mask)}
            np.testing.assert_array_equal(decoded(code), mask)
            rings = _polygons(mask)
            holes += rings is None
            if rings is not None:
                np.testing.assert_array_equal(filled(rings, mask.shape), mask)
        self.assertGreater(holes, 10)

    def test_holes_have_no_polygon(self):
        ring = np.ones((3, 3), bool)
        ring[1, 1] = False
        self.assertIsNone(_polygons(ring))
        self.assertIsNotNone(_polygons(np.array([[1, 0], [0, 1]], bool)))
        self.assertEqual(_polygons(np.ones((2, 3), bool)), [[3, 0, 3, 2, 0, 2, 0, 0]])


class Chips(Case):
    def image(self, **more):
        sensor = rs.Orthographic(**{"name": "map", "columns": 60, "rows": 44, "gsd_m": 0.4, "bands": BANDS, "paths": 4,
                                    "truth": ["tag", "material", "instance"], **more})
        return by_day(lawn_with_things().prepare(self.folder / "lawn.h5"), [sensor]).render(self.folder / "out")["map"]

    def test_labels_are_the_truth(self):
        image = self.image()
        for segmentation in ("rle", "polygon"):
            labels = rs.write_chips({"a": image}, self.folder / "chips", size=40, segmentation=segmentation, cubes=True)
            self.assertEqual(json.loads((self.folder / "chips/annotations.json").read_text()), labels)
            self.assertEqual([c["name"] for c in labels["categories"]], ["car", "ring; big"])
            self.assertEqual([(c["left"], c["top"]) for c in labels["images"]], [(0, 0), (20, 0), (0, 4), (20, 4)])
            self.assertEqual([a["id"] for a in labels["annotations"]], list(range(1, len(labels["annotations"]) + 1)))
            kinds = set()
            for chip in labels["images"]:
                window = (slice(chip["top"], chip["top"] + 40), slice(chip["left"], chip["left"] + 40))
                tag, instance = image.truth_tag.values[window], image.truth_instance.values[window]
                objects = {(int(i), int(t)) for t, i in zip(tag.ravel(), instance.ravel()) if np.isfinite(t)}
                mine = [a for a in labels["annotations"] if a["image_id"] == chip["id"]]
                self.assertEqual({(a["instance"], a["category_id"] - 1) for a in mine}, objects)
                for a in mine:
                    mask = (instance == a["instance"]) & (tag == a["category_id"] - 1)
                    code = a["segmentation"]
                    kinds.add(type(code))
                    np.testing.assert_array_equal(decoded(code) if isinstance(code, dict) else filled(code, mask.shape), mask)
                    rows, columns = np.nonzero(mask)
                    self.assertEqual(a["bbox"], [columns.min(), rows.min(), np.ptp(columns) + 1, np.ptp(rows) + 1])
                    self.assertEqual((a["area"], a["iscrowd"]), (mask.sum(), 0))
                    whole = (image.truth_instance.values == a["instance"]).sum()
                    self.assertAlmostEqual(a["share_in_chip"], mask.sum() / whole)
                np.testing.assert_array_equal(np.load(self.folder / "chips/images" / chip["cube"]), image.radiance.values[:, *window])
            # The ring has a hole where it is whole, which is no polygon.
            self.assertEqual(kinds, {dict} if segmentation == "rle" else {dict, list})

    def test_a_group_under_one_tag_is_one_object(self):
        """A truck of two boxes, placed twice, had four labels."""
        scene = rs.Scene("group")
        for name, share in (("grey", 0.2), ("white", 0.7)):
            scene.materials[name] = rs.Material("lambert", reflectance=share)
        scene.objects.update(ground=rs.plane(100, 100, material="grey"), body=rs.box([-1, -2.5, 0], [1, 2.5, 1.5], material="white"),
                             cab=rs.box([-1, 1, 1.5], [1, 2.5, 2.5], material="grey"))
        scene.groups["truck"] = [rs.Placement("body"), rs.Placement("cab")]
        scene.groups["convoy"] = [rs.Placement("truck", tag="vehicle", translate=[20 * k, 0, 0]) for k in (0, 1)]
        scene.world += [rs.Placement("ground", tag="ground"), rs.Placement("truck", tag="vehicle", translate=[-10, 0, 0]),
                        rs.Placement("convoy", translate=[0, 0, 0])]
        for truth in (["tag", "instance", "material"], ["tag", "object", "instance"]):
            sensor = rs.Orthographic(name="chip", columns=128, rows=32, gsd_m=0.5, bands=BANDS[:1], paths=16, truth=truth)
            image = rs.Simulation(scene.prepare(self.folder / "g.h5"), [sensor], sky=rs.Sky(radiance=10)).render(
                self.folder / "out")["chip"]
            labels = rs.write_chips(image, self.folder / "chips", size=128, category="tag", names=["vehicle"], segmentation="polygon")
            # 2 m x 5 m of 0.5 m pixels each, the cab on top of its body, one outline.
            self.assertEqual([(a["area"], a["bbox"][2:], len(a["segmentation"])) for a in labels["annotations"]], [(40, [4, 10], 1)] * 3)
            self.assertEqual([a["bbox"][0] for a in labels["annotations"]], [42, 62, 102])
            self.assertEqual([a["instance"] for a in labels["annotations"]], [1, 3, 5])
            by_part = image.truth_instance.values
            self.assertEqual(sorted(set(by_part[np.isfinite(by_part)].tolist())), [0, 1, 2, 3, 4, 5, 6])
            material = rs.write_chips(image, self.folder / "m", size=128, category="material") if "material" in truth else None
            if material:  # by material, parts stay parts
                self.assertEqual(len(material["annotations"]), 7)

    def test_pictures_are_stretched_alike(self):
        image = self.image()
        labels = rs.write_chips(image, self.folder / "chips", size=32, bands=["red"], value_range=(0, 200))
        red = image.radiance.sel(band="red").values.astype(float)
        for chip in labels["images"]:
            rows, width, channels = png_pixels(self.folder / "chips/images" / chip["file_name"])
            self.assertEqual((width, channels, len(rows)), (32, 1, 32))
            shown = np.frombuffer(b"".join(rows), np.uint8).reshape(32, 32) / 255
            linear = np.where(shown <= 0.04045, shown / 12.92, ((shown + 0.055) / 1.055) ** 2.4)
            wanted = np.clip(red[chip["top"]:chip["top"] + 32, chip["left"]:chip["left"] + 32] / 200, 0, 1)
            np.testing.assert_allclose(linear, wanted, atol=0.006)
        labels = rs.write_chips(image, self.folder / "colour", size=1000)
        rows, width, channels = png_pixels(self.folder / "colour/images" / labels["images"][0]["file_name"])
        self.assertEqual((width, channels, len(rows)), (60, 3, 44))

    def test_choices_and_refusals(self):
        image = self.image()
        some = rs.write_chips(image, self.folder / "some", size=20, stride=10, names=["ring; big"], keep_empty=False, min_area=5)
        self.assertEqual({a["category_id"] for a in some["annotations"]}, {1})
        self.assertEqual(len(some["images"]), len({a["image_id"] for a in some["annotations"]}))
        self.assertGreaterEqual(min(a["area"] for a in some["annotations"]), 5)
        by_material = rs.write_chips(image, self.folder / "material", size=64, category="material")
        self.assertEqual([c["name"] for c in by_material["categories"]], ["lawn", "car", "ring"])
        for wrong, said in (({"bands": ["blue"]}, "red, nir, green, not blue"), ({"size": 0}, "size must be at least 1"),
                            ({"stride": 0}, "stride must be at least 1"), ({"segmentation": "mask"}, "'rle' or 'polygon'"),
                            ({"value_range": (5, 1)}, "the lower first"), ({"names": ["bus"]}, "named bus; there is: car, ring; big"),
                            ({"names": []}, "names is empty"), ({"category": "instance"}, "category is 'tag' or 'material'")):
            with self.assertRaisesRegex(ValueError, said):
                rs.write_chips(image, self.folder / "wrong", **wrong)
        one = rs.write_chips(image, self.folder / "one", size=64, bands="red", names=["bus", "car"])
        self.assertEqual(png_pixels(self.folder / "one/images" / one["images"][0]["file_name"])[2], 1)
        self.assertEqual({a["category_id"] for a in one["annotations"]}, {2})
        whole = rs.write_chips(rs.Result(self.folder / "out"), self.folder / "whole", size=64)
        self.assertEqual([i["source"] for i in whole["images"]], ["map"])
        for truth, said in ((["material", "instance"], "no classes by tag"), (["tag"], "which instance")):
            with self.assertRaisesRegex(ValueError, said):
                rs.write_chips(self.image(truth=truth), self.folder / "wrong")


if __name__ == "__main__":
    unittest.main()
