"""Texts of campaigns: what is wrong is said with file, line and what would be right; the schema that is shipped takes what the reader takes."""
import json
import re
import unittest
from unittest import mock

from kit import CAMPAIGN, ROOT, SIMULATION, Case
from remote_scenes.campaign import CampaignError, read_campaign
from remote_scenes.campaign.settings import FORMATS, KEPT
from remote_scenes.campaign.text import read_text

# What is put in the place of what, the line that is named, what is said, and whether a schema can know.
WRONG = [
    ("campaign: 1", "campaign: 2", 1, "version 2 of this grammar", True),
    ("seed: 3", "sed: 3", 2, "unknown key 'sed'; did you mean 'seed'", True),
    ("seed: 3", "seed: 3\nseed: 4", 3, "stands there twice", False),
    ("samples: 5", "samples: 0", 3, "0 is out of range; 1 to 1e\\+07", True),
    ("samples: 5\n", "", 1, "the key 'samples' is missing", True),
    ("scene: scene.yaml", "scene: none.yaml", 4, "is not there", False),
    ("scene: scene.yaml", "scene: simulation.yaml", 4, "has no 'world'", False),
    ("zenith_deg: {uniform: [20, 60]}", "zenith_deg: {uniform: [60, 20]}", 7, "from 60 to 20 is no range; the lower end first", False),
    ("zenith_deg: {uniform: [20, 60]}", "zenith_deg: {uniform: [20, 60, 3]}", 7, "'uniform' has 3 numbers; it has 2", True),
    ("zenith_deg: {uniform: [20, 60]}", "zenith_deg: {uniform: [20, a]}", 7, "neither a number nor a date", False),
    ("zenith_deg: {uniform: [20, 60]}", "zenith_deg: {log_uniform: [0, 60]}", 7, "above 0", False),
    ("zenith_deg: {uniform: [20, 60]}", "zenith_deg: {normal: [20, 0]}", 7, "the deviation above 0", False),
    ("zenith_deg: {uniform: [20, 60]}", "zenith_deg: {normal: [20, 1], within: [90, 95]}", 7, "holds none of the draws", False),
    ("zenith_deg: {uniform: [20, 60]}", "zenith_deg: {uniform: [20, 60], drawn: latin}", 7, "unknown key 'drawn'; did you mean 'draw'", True),
    ("zenith_deg: {uniform: [20, 60]}", "zenith_deg: {uniform: [20, 60], draw: sobl}", 7, "did you mean 'sobol'", True),
    ("zenith_deg: {uniform: [20, 60]}", "zenith_deg: {uniform: [0, 1], choice: [1]}", 7, "exclude each other", True),
    ("zenith_deg: {uniform: [20, 60]}", "zenith_deg: $zenit", 7, "there is no variable 'zenit'", False),
    ("zenith_deg: {uniform: [20, 60]}", "zenith_deg: {choice: [1, 2], weights: [0, 0]}", 7, "all weights are 0", False),
    ("zenith_deg: {uniform: [20, 60]}", "zenith_deg: {choice: [1, 2], weights: [1]}", 7, "1 weights for 2 choices", False),
    ("zenith_deg: {uniform: [20, 60]}", "zenith_deg: {mixture: [0.1]}", 7, "1 items are too few; at least 2", True),
    ("zenith_deg: {uniform: [20, 60]}", "zenith_deg: {mixture: [0.1, 0.2], shares: [1]}", 7, "1 shares for 2 spectra", True),
    ("zenith_deg: {uniform: [20, 60]}", "zenith_deg: {mixture: [0.1, 0.2], shares: [0, 0]}", 7, "all shares are 0", False),
    ("zenith_deg: {uniform: [20, 60]}", "zenith_deg: {mixture: [0.1, none.csv]}", 7, "neither a curve of the scene nor a file", False),
    ("zenith_deg: {uniform: [20, 60]}", "zenith_deg: {variability: scene.yaml}", 7, "is no table of spectra", False),
    ("zenith_deg: {uniform: [20, 60]}", "zenith_deg: {mixture: [{wavelength_um: [1, 2], value: [1, 1]}, {wavelength_um: [3, 4], value: [1, 1]}]}", 7,
     "no wavelengths in common", False),
    ("zenith_deg: {uniform: [20, 60]}", "zenith_deg: {mixture: [{wavelength_um: [2, 1], value: [1, 1]}, 1]}", 7, "do not ascend", False),
    ("zenith_deg: {uniform: [20, 60]}", "zenith_deg: {variability: [0.1, 0.2], within: [1, 0]}", 7, "no width", False),
    ("paint: {choice: [paint, white]}", "paint: {material: {reflectance: {grid: [1]}}}", 12, "drawn at random", False),
    ("place: truck}", "place: truck, class: car, keypoints: {front: [0, 1, 0]}}", 13, "has the keypoints front here, elsewhere none", False),
    ("samples: 5", "samples: 5\nformats: [kitti]", 4, "'kitti' needs a frame camera", False),
    ("samples: 5", "samples: 5\nkeep: [flow]", 4, "'flow' needs a sequence", False),
    ("samples: 5", "samples: 5\nlabels: {stuff: {soil: [grund]}}", 4, "no material 'grund'; did you mean 'ground'", False),
    ("samples: 5", "samples: 5\npair: {again: [zenith]}", 4, "there is no variable 'zenith'", False),
    ("samples: 5", "samples: 5\npair: {leave: 1.5}", 4, "1.5 is out of range", True),
    ("samples: 5", "samples: 5\npair: {}\nsequence: {frames: 2}", 4, "exclude each other", False),
    ("samples: 5", "samples: 5\nsequence: {frames: 0}", 4, "0 is out of range", True),
    ("samples: 5", "samples: 5\nsequence: {step_s: 1}", 4, "'frames' is missing", True),
    ("zenith_deg: {uniform: [20, 60]}", "zenith_deg: {choice: []}", 7, "0 items are too few", True),
    ("simulation.sun.direction.zenith_deg: {uniform: [20, 60]}", "a: $b\n  b: $a", 8, "refer to each other", False),
    ("simulation.sun.direction.zenith_deg: {uniform: [20, 60]}", "a: {by: b, cases: {x: 1}}\n  b: y", 7, "no case", False),
    ("simulation.sun.direction.zenith_deg: {uniform: [20, 60]}", "a: {zip: [1, 2]}\n  b: {zip: [1]}", 8, "1 items, another one of the same zip 2", False),
    ("simulation.sun.direction.zenith_deg", "simulation.sun.directon.zenith_deg", 7, "no 'directon' in 'sun'; did you mean 'direction'", False),
    ("simulation.sun.direction.zenith_deg", "simulation.sensors.1.gsd_m", 7, "'sensors' has no item '1'", False),
    ("simulation.sun.direction.zenith_deg", "simulaton.sun.direction.zenith_deg", 7, "in neither text", False),
    ("      car: {place: car, weight: 2, materials: {paint: {choice: [paint, white]}}}\n      truck: {place: truck}\n", "      {}\n", 11,
     "the catalogue is empty", True),
    ("place: truck", "place: truc", 13, "no object or group 'truc'; did you mean 'truck'", False),
    ("choice: [paint, white]", "choice: [paint, whit]", 12, "no material 'whit'; did you mean 'white'", False),
    ("count: {integers: [3, 5]}", "count: {integers: [3, 5.5]}", 14, "a whole number is wanted", True),
    ("count: {integers: [3, 5]}", "count: {grid: [3, 5]}", 14, "drawn at random", False),
    ("where: {polygons", "where: {polygon", 15, "unknown key 'polygon'; did you mean 'polygons'", True),
    ("[[[-12, -12], [12, -12], [12, 12], [-12, 12]]]", "[[[-12, -12], [12, -12]]]", 15, "2 items are too few; at least 3", False),
    ("[[[-12, -12], [12, -12], [12, 12], [-12, 12]]]", "map.geojson", 15, "is no GeoJSON map", False),
    ("on: lot", "on: lott", 17, "places no 'lott'; did you mean 'lot'", False),
    ("on: lot", "on: lot\n    height_m: 1", 17, "exclude each other", False),
    ("spacing_m: 0.5", "spacing_m: -1", 18, "-1 is out of range", True),
    ("spacing_m: 0.5", "spacing_m: [", 19, "expected", False),
    ("samples: 5", "samples: 5\nformats: [coca]", 4, "did you mean 'coco'", True),
    ("samples: 5", "samples: 5\nkeep: [image, polarisation]", 4, "'polarisation' needs Stokes vectors; a sensor with", False),
    ("samples: 5", "samples: 5\nkeep: [points]", 4, "'points' needs a laser radar; a sensor of kind lidar", False),
    ("samples: 5", "samples: 5\npicture: {range: [3, 1]}", 4, "the lower number first", False),
]


def fits(tree, schema, root):
    """Whether a tree fits a schema: the words of JSON Schema 2020-12 that ours has, and no others."""
    if "$ref" in schema:
        return fits(tree, root["$defs"][schema["$ref"].rpartition("/")[2]], root)
    known = {"$schema", "$defs", "title", "description", "type", "properties", "required", "additionalProperties", "items", "minItems", "maxItems",
             "minProperties", "uniqueItems", "enum", "const", "anyOf", "not", "minimum", "maximum", "pattern"}
    assert set(schema) <= known, set(schema) - known
    types = {"object": dict, "array": list, "string": str, "boolean": bool, "null": type(None), "number": (int, float), "integer": int}
    if kinds := schema.get("type"):
        kinds = [kinds] if isinstance(kinds, str) else kinds
        if not any(isinstance(tree, types[k]) and (k == "boolean" or not isinstance(tree, bool)) for k in kinds):
            return False
    good = not ("enum" in schema and tree not in schema["enum"] or "const" in schema and tree != schema["const"])
    good &= not ("anyOf" in schema and not any(fits(tree, s, root) for s in schema["anyOf"]) or "not" in schema and fits(tree, schema["not"], root))
    if isinstance(tree, dict):
        inner, more = schema.get("properties", {}), schema.get("additionalProperties", True)
        good &= all(k in tree for k in schema.get("required", ())) and len(tree) >= schema.get("minProperties", 0)
        for key, value in tree.items():
            good &= fits(value, inner[key], root) if key in inner else more is True or more is not False and fits(value, more, root)
    elif isinstance(tree, list):
        good &= schema.get("minItems", 0) <= len(tree) <= schema.get("maxItems", 1e9) and all(fits(v, schema.get("items", {}), root) for v in tree)
        good &= not schema.get("uniqueItems") or len(set(map(str, tree))) == len(tree)
    elif isinstance(tree, str):
        good &= re.search(schema.get("pattern", ""), tree) is not None
    elif isinstance(tree, (int, float)) and not isinstance(tree, bool):
        good &= schema.get("minimum", tree) <= tree <= schema.get("maximum", tree)
    return bool(good)


class Texts(Case):
    schema = json.loads((ROOT / "python/remote_scenes/campaign/schema.json").read_text())

    def test_what_is_wrong_is_said_with_its_line(self):
        self.assertEqual(read_campaign(self.write()).classes, ["car", "truck"])
        for old, new, line, said, _ in WRONG:
            self.assertIn(old, CAMPAIGN)
            path = self.write(CAMPAIGN.replace(old, new))
            with self.subTest(new), self.assertRaises(CampaignError) as caught:
                campaign = read_campaign(path)
                campaign.draw(1)
            self.assertRegex(str(caught.exception), f"^{re.escape(str(path))}:{line}:\\d+: error: .*{said}", new)

    def test_texts_that_are_none(self):
        for text, said in ((b"\xff\xfe", "not UTF-8"), (b"- 1\n", "no map of keys"), (b"a: &x [*x]\n", "too"), (b"{[1]: 2}", "a key must be a name"),
                           (b"a: &a [1,1]\nb: &b [*a,*a,*a,*a,*a,*a,*a,*a]\n" + b"".join(b"c%d: &c%d [%s]\n" % (i, i, b",".join(
                               [b"*b" if i == 0 else b"*c%d" % (i - 1)] * 9)) for i in range(9)), "too many values")):
            (self.folder / "c.yaml").write_bytes(text)
            with self.assertRaisesRegex(CampaignError, said), mock.patch("remote_scenes.campaign.text.MOST_VALUES", 2000):
                read_campaign(self.folder / "c.yaml")
        with self.assertRaisesRegex(CampaignError, "cannot be read: No such file"):
            read_campaign(self.folder / "none.yaml")

    def test_scalars_are_those_of_the_programs(self):
        path = self.write(CAMPAIGN.replace("samples: 5\n", "samples: 5\nname: on\n"), simulation=SIMULATION + "max_scatterings: 1e3\n")
        campaign = read_campaign(path)
        self.assertEqual((campaign.name, campaign.simulation["max_scatterings"]), ("on", 1000.0))

    def test_values_come_into_both_texts(self):
        text = CAMPAIGN.replace("vary:\n", "vary:\n  gsd: 0.5\n  simulation.sensors.chip.gsd_m: $gsd\n  simulation.sky: null\n")
        campaign = read_campaign(self.write(text))
        scene, simulation = campaign.texts(campaign.draw(2))
        self.assertEqual((simulation["sensors"][0]["gsd_m"], "sky" in simulation), (0.5, False))
        self.assertIn(scene["materials"]["ground"]["reflectance"], (0.08, 0.12))
        self.assertTrue(20 <= simulation["sun"]["direction"]["zenith_deg"] <= 60)
        self.assertEqual(campaign.scene["materials"]["ground"]["reflectance"], 0.1)
        self.assertNotEqual(simulation["seed"], campaign.texts(campaign.draw(3))[1]["seed"])

    def tree(self, text):
        """As YAML 1.2 has it: `on` is a name."""
        (self.folder / "tree.yaml").write_text(text)
        return read_text(self.folder / "tree.yaml").plain()

    def test_the_schema_takes_what_the_reader_takes(self):
        good = [self.tree(CAMPAIGN), self.tree((ROOT / "sample_scenes/campaigns/campaign.yaml").read_text())]
        for tree in good:
            self.assertTrue(fits(tree, self.schema, self.schema))
        for old, new, _, _, seen in WRONG:
            if seen:
                self.assertFalse(fits(self.tree(CAMPAIGN.replace(old, new)), self.schema, self.schema), new)
        self.assertEqual(self.schema["properties"]["formats"]["items"]["enum"], list(FORMATS))
        self.assertEqual(self.schema["properties"]["keep"]["items"]["enum"], list(KEPT))
        try:
            import jsonschema
        except ImportError:
            return
        jsonschema.Draft202012Validator.check_schema(self.schema)
        for tree in good:
            jsonschema.validate(tree, self.schema)


if __name__ == "__main__":
    unittest.main()
