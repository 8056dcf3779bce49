"""Labels against a plain ray caster of the tests' own: masks, oriented boxes, 3-D boxes, occlusion, truncation; and spectra against the image."""
import json
import unittest

import numpy as np

import remote_scenes as rs
from kit import CAMPAIGN, SCENE, SIMULATION, Boxes, Case
from remote_scenes.campaign import read_campaign, run
from remote_scenes.campaign.boxes import smallest
from remote_scenes.campaign.kitti import write_kitti
from remote_scenes.campaign.label_files import write_coco
from remote_scenes.campaign.panoptic import write_panoptic
from remote_scenes.campaign.sample import Maker
from remote_scenes.campaign.sheet import read_png

SENSORS = """\
scene: none.h5
sun: {direction: {zenith_deg: 40, azimuth_deg: 120}}
sky: {kind: clear}
max_nodes: 2
sensors:
  - {kind: orthographic, name: chip, columns: 56, rows: 44, gsd_m: 0.4, center_m: [1, 0], paths: 4, bands: &b [{name: red, center_um: 0.65, fwhm_um: 0.03}, {name: nir, center_um: 0.85, fwhm_um: 0.03}]}
  - {kind: frame_camera, name: drone, columns: 60, rows: 48, pitch_um: 100, focal_length_mm: 10, position_m: [4, -22, 20], look_at_m: [0, -3, 0], paths: 4, bands: *b}
"""
PARTS = {"car": [((-0.9, -2.2, 0), (0.9, 2.2, 1.4))], "truck": [((-1.2, -4, 0.9), (1.2, 2, 3.4)), ((-1, 2.1, 0), (1, 4, 2.6))]}
WHOLE = {"car": ((-0.9, -2.2, 0), (0.9, 2.2, 1.4)), "truck": ((-1.2, -4, 0), (1.2, 4, 3.4))}
ROOF = ((-8, -1, 5), (8, 1.5, 5.2))
FINE = 6  # rays of the caster across a pixel


def rays(name, x, y):
    """Origins and directions of places in the pictures of the two sensors, from their definitions."""
    if name == "chip":
        origin = np.stack([1 + (x - 28) * 0.4, (22 - y) * 0.4, np.full_like(x, 1000.0)], axis=-1)
        return origin, np.broadcast_to([1e-12, 1e-12, -1.0], origin.shape)
    position, target = np.array([4.0, -22, 20]), np.array([0.0, -3, 0])
    ahead = (target - position) / np.linalg.norm(target - position)
    right = np.cross(ahead, [0, 0, 1])
    right /= np.linalg.norm(right)
    down = np.cross(ahead, right)
    d = ahead * 0.01 + ((x - 30) * 1e-4)[:, None] * right + ((y - 24) * 1e-4)[:, None] * down
    return np.broadcast_to(position, d.shape), d


def projected(name, place):
    """A place in the picture: by intersecting with the plane of the sensor, not by a matrix."""
    if name == "chip":
        return np.array([(place[0] - 1) / 0.4 + 28, 22 - place[1] / 0.4])
    origin, d = rays(name, np.array([30.0, 31.0, 30.0]), np.array([24.0, 24.0, 25.0]))
    # origin + t (d0 + u (d1 - d0) + v (d2 - d0)) = place
    solved = np.linalg.solve(np.stack([d[0], d[1] - d[0], d[2] - d[0]], axis=1), place - origin[0])
    return np.array([30 + solved[1] / solved[0], 24 + solved[2] / solved[0]])


def placed(point, one):
    a = np.radians(one["heading_deg"])
    x, y, z = np.array(point) * one["scale"]
    return np.array(one["position_m"]) + [x * np.cos(a) + y * np.sin(a), -x * np.sin(a) + y * np.cos(a), z]


class Labels(Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        case = cls("made")
        case.setUp()
        cls.addClassCleanup(case.doCleanups)
        text = CAMPAIGN.replace("{integers: [3, 5]}", "13").replace("[-12, -12], [12, -12], [12, 12], [-12, 12]",
                                                                    "[-11, -10], [13, -10], [13, 10], [-11, 10]").replace("spacing_m: 0.5", "spacing_m: 0.1")
        text = text.replace("truck: {place: truck}", "truck: {place: truck, scale: {uniform: [0.7, 1.1]}}").replace("seed: 3", "seed: 4\nkeep: [image, error, truth, classes, depth]\nformats: [panoptic, kitti]")
        text = text.replace("car: {place: car,", "car: {place: car, keypoints: {front: [0, 2.3, 0.7], left: [-1, 0, 0.7], roof: [0, 0, 1.4]},")
        text = text.replace("truck: {place: truck,", "truck: {place: truck, keypoints: {nose: [0, 4.1, 1.3]},")
        campaign = read_campaign(case.write(text, SCENE, SENSORS))
        cls.path = Maker(campaign, case.folder / "out", "v").make(2)
        write_kitti(campaign, case.folder / "out")
        write_panoptic(campaign, case.folder / "out")
        cls.record = json.loads((cls.path / "sample.json").read_text())
        cls.caster = Boxes()
        cls.caster.add(99, *ROOF)
        cls.caster.add(98, (-30, -30, -1), (30, 30, 0))
        for number, one in enumerate(cls.record["objects"], 1):
            for low, high in PARTS[one["item"]]:
                cls.caster.add(number, low, high, one["position_m"], one["heading_deg"], one["scale"])
        cls.traced = {}
        cls.images = {i["name"]: i for i in cls.record["images"]}

    def made(self):
        pass

    @classmethod
    def seen(cls, name):
        """The owner of every fine place, as (rows, FINE, columns, FINE)."""
        if name not in cls.traced:
            w, h = cls.images[name]["width"], cls.images[name]["height"]
            x, y = np.meshgrid((np.arange(w * FINE) + 0.5) / FINE, (np.arange(h * FINE) + 0.5) / FINE)
            cls.traced[name] = cls.caster.trace(*rays(name, x.ravel(), y.ravel())).reshape(h, FINE, w, FINE)
        return cls.traced[name]

    @classmethod
    def alone(cls, name, number):
        """Fine places (x, y) of the picture, and beyond its edges, at which an object is met when there is nothing else."""
        if (name, number) not in cls.traced:
            one = cls.record["objects"][number - 1]
            (x0, y0, z0), (x1, y1, z1) = WHOLE[one["item"]]
            corners = np.array([projected(name, placed([x, y, z], one)) for x in (x0, x1) for y in (y0, y1) for z in (z0, z1)])
            low, high = np.floor(corners.min(axis=0)) - 1, np.ceil(corners.max(axis=0)) + 1
            x, y = (g.ravel() for g in np.meshgrid(*(np.arange(low[i] + 0.5 / FINE, high[i], 1 / FINE) for i in (0, 1))))
            met = cls.caster.trace(*rays(name, x, y), number) == number
            cls.traced[name, number] = np.stack([x[met], y[met]], axis=-1)
        return cls.traced[name, number]

    @staticmethod
    def mask(label):
        rows, columns = label["segmentation"]["size"]
        flat = np.repeat(np.arange(len(label["segmentation"]["counts"])) % 2, label["segmentation"]["counts"])
        return flat.reshape(columns, rows).T.astype(bool)

    def test_masks_and_shares(self):
        hidden = cut = 0
        for name, image in self.images.items():
            seen = self.seen(name)
            labels = {label["object"]: label for label in image["labels"]}
            self.assertGreater(len(labels), 7)
            for number in range(1, len(self.record["objects"]) + 1):
                share = (seen == number).mean(axis=(1, 3))
                if number not in labels:
                    self.assertLess(share.max(), 1)  # no pixel shows nothing else
                    continue
                label, mask = labels[number], self.mask(labels[number])
                self.assertTrue(mask[share == 1].all(), (name, number))
                self.assertFalse(mask[share == 0].any(), (name, number))
                rows, columns = np.nonzero(mask)
                self.assertEqual(label["bbox"], [columns.min(), rows.min(), np.ptp(columns) + 1, np.ptp(rows) + 1])
                self.assertEqual(label["area"], mask.sum())
                alone = self.alone(name, number)
                inside = ((alone > 0) & (alone < [image["width"], image["height"]])).all(axis=1).sum()
                occlusion, truncation = 1 - (seen == number).sum() / inside, 1 - inside / len(alone)
                self.assertAlmostEqual(label["occlusion"], occlusion, delta=0.02, msg=(name, number))
                self.assertAlmostEqual(label["truncation"], truncation, delta=0.02, msg=(name, number))
                hidden += 0.05 < occlusion < 0.95
                cut += 0.05 < truncation < 0.95
        self.assertGreater(min(hidden, cut), 2)  # both happen

    def test_oriented_boxes(self):
        for name, image in self.images.items():
            for label in image["labels"]:
                one = self.record["objects"][label["object"] - 1]
                points = self.alone(name, label["object"])
                middle = np.mean(WHOLE[one["item"]], axis=0)
                step = projected(name, placed(middle + [0, 1e-3, 0], one)) - projected(name, placed(middle, one))
                ahead = step / np.linalg.norm(step)
                right = np.array([-ahead[1], ahead[0]])
                box = np.array(label["obb"])
                self.assertEqual(label["obb_of"], "silhouette")
                self.assertGreater(((box[0] - box[3]) / np.linalg.norm(box[0] - box[3])) @ ahead, 0.9995)
                for axis, first, second in ((ahead, box[0], box[3]), (right, box[1], box[0])):
                    self.assertAlmostEqual(first @ axis, (points @ axis).max(), delta=0.5, msg=name)
                    self.assertAlmostEqual(second @ axis, (points @ axis).min(), delta=0.5, msg=name)

    def test_boxes_in_space(self):
        for name, image in self.images.items():
            for label in image["labels"]:
                one = self.record["objects"][label["object"] - 1]
                low, high = WHOLE[one["item"]]
                for k, (place, at) in enumerate(zip(label["box_3d_m"], label["box_3d_px"])):
                    wanted = placed([(low, high)[k & 1][0], (low, high)[k >> 1 & 1][1], (low, high)[k >> 2][2]], one)
                    np.testing.assert_allclose(place, wanted, atol=1e-5)
                    np.testing.assert_allclose(at, projected(name, wanted), atol=1e-4)
                self.assertEqual(one["position_m"][2], 0)
                if name == "drone":
                    self.assertAlmostEqual(label["gsd_m"], label["range_m"] / 100, delta=0.02 * label["gsd_m"])

    def test_spectra_are_those_of_the_mask(self):
        for name, image in self.images.items():
            radiance, error = rs.open_envi(self.path / f"{name}.img").values, rs.open_envi(self.path / f"{name}_error.img").values
            for label in image["labels"]:
                mask = self.mask(label)
                for i, band in enumerate(("red", "nir")):
                    self.assertAlmostEqual(label["spectrum"][band] / radiance[i][mask].mean(), 1, places=5)
                    self.assertAlmostEqual(label["spectrum_error"][band] / (np.sqrt((error[i][mask].astype(float) ** 2).sum()) / mask.sum()), 1, places=5)
                self.assertTrue(0 <= label["incidence_deg"] <= 180)

    def test_share_in_shadow(self):
        """Rays from what is seen of an object to the middle of the sun: the share that meets something, itself included."""
        zenith, azimuth = np.radians(self.record["values"]["simulation.sun.direction.zenith_deg"]), np.radians(120)
        sun = np.array([np.sin(zenith) * np.sin(azimuth), np.sin(zenith) * np.cos(azimuth), np.cos(zenith)])
        shares = []
        for name, image in self.images.items():
            seen = self.seen(name)
            for label in image["labels"]:
                rows, a, columns, b = np.nonzero((seen == label["object"]) & self.mask(label)[:, None, :, None])
                origin, d = rays(name, columns + (b + 0.5) / FINE, rows + (a + 0.5) / FINE)
                d = d / np.linalg.norm(d, axis=1, keepdims=True)
                place = origin + d * (self.caster.first(origin, d)[1] - 1e-5)[:, None]
                shares.append((self.caster.trace(place, np.broadcast_to(sun, place.shape)) >= 0).mean())
                # Means over pixels hold what else their pixels show, and the four samples of each are random.
                others, noise = 1 - len(rows) / (label["area"] * FINE ** 2), np.sqrt(max(shares[-1] * (1 - shares[-1]), 0.02) / (4 * label["area"]))
                self.assertAlmostEqual(label["in_shadow"], shares[-1], delta=others + 4.5 * noise, msg=(name, label["object"]))
        self.assertGreater(np.ptp(shares), 0.3)

    def test_keypoints(self):
        """Where each is by intersection with the sensor's plane; visible where the caster meets nothing before it."""
        points = {"car": [(0, 2.3, 0.7), (-1, 0, 0.7), (0, 0, 1.4)], "truck": [(0, 4.1, 1.3)]}
        marks = set()
        for name, image in self.images.items():
            for label in image["labels"]:
                one = self.record["objects"][label["object"] - 1]
                self.assertEqual(label["num_keypoints"], sum(m > 0 for m in label["keypoints"][2::3]))
                for k, point in enumerate(points[one["item"]]):
                    x, y, mark = label["keypoints"][3 * k:3 * k + 3]
                    place = placed(point, one)
                    at = projected(name, place)
                    marks.add((one["item"], k, mark))
                    if not ((at >= 0) & (at < [image["width"], image["height"]])).all():
                        self.assertEqual((x, y, mark), (0, 0, 0))
                        continue
                    np.testing.assert_allclose((x, y), at, atol=1e-4)
                    origin, d = rays(name, at[:1], at[1:])
                    d = d / np.linalg.norm(d)
                    before = np.linalg.norm(place - origin[0]) - self.caster.first(origin, d)[1][0]
                    if abs(before - 0.05) > 0.02:
                        self.assertEqual(mark, 1 if before > 0.05 else 2, (name, one["item"], k))
        self.assertLessEqual({1, 2}, {mark for item, _, mark in marks if item == "car"})

    def test_panoptic_pictures(self):
        """Segments of objects are their masks; where the caster sees nothing but ground and roof they are of its material."""
        lists = json.loads((self.path.parents[1] / "panoptic.json").read_text())
        self.assertEqual([(c["name"], c["isthing"]) for c in lists["categories"]], [("car", 1), ("truck", 1), ("ground", 0), ("paint", 0), ("white", 0)])
        for entry, (name, image) in zip(lists["annotations"], self.images.items()):
            colours = read_png(self.path.parents[1] / entry["file_name"]).astype(int)
            number = colours @ [1, 256, 65536]
            segments = {s["id"]: s for s in entry["segments_info"]}
            self.assertEqual(set(segments), set(np.unique(number)) - {0})
            for label in image["labels"]:
                self.assertTrue(((number == label["object"]) == self.mask(label)).all())
                self.assertEqual((segments[label["object"]]["category_id"], segments[label["object"]]["bbox"]), (label["category_id"], label["bbox"]))
            around = (self.seen(name) >= 98).all(axis=(1, 3))
            self.assertEqual({segments[n]["category_id"] for n in np.unique(number[around])}, {3})
            self.assertEqual(sum(s["area"] for s in segments.values()), (number > 0).sum())

    def test_kitti(self):
        """Of the camera alone: the floor's middle through the matrix is where the picture shows it; sizes and turn by their definitions."""
        folder = self.path.parents[1] / "kitti"
        self.assertEqual([p.name for p in (folder / "label_2").iterdir()], ["000002_drone.txt"])
        matrix = np.array((folder / "calib/000002_drone.txt").read_text().splitlines()[0].split()[1:], float).reshape(3, 4)
        lines = (folder / "label_2/000002_drone.txt").read_text().splitlines()
        self.assertEqual(len(lines), len(self.images["drone"]["labels"]))
        origin, d = rays("drone", np.array([30.0, 31, 30]), np.array([24.0, 24, 25]))
        axes = np.array([v / np.linalg.norm(v) for v in (d[1] - d[0], d[2] - d[0], d[0])])
        for line, label in zip(lines, self.images["drone"]["labels"]):
            kind, cut, hidden, alpha, *numbers = line.split()
            one, n = self.record["objects"][label["object"] - 1], np.array(numbers, float)
            low, high = np.array(WHOLE[one["item"]])
            middle = placed([(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2]], one)
            at = matrix @ [*n[7:10], 1]
            np.testing.assert_allclose(at[:2] / at[2], projected("drone", middle), atol=0.01)
            np.testing.assert_allclose(n[4:7], (np.array(high) - low)[[2, 0, 1]] * one["scale"], atol=1e-4)
            self.assertEqual(n[:4].tolist(), [label["bbox"][0], label["bbox"][1], label["bbox"][0] + label["bbox"][2] - 1, label["bbox"][1] + label["bbox"][3] - 1])
            x, _, z = axes @ (placed([0, 1, 0], one) - placed([0, 0, 0], one))
            self.assertAlmostEqual(np.cos(n[10]) * x - np.sin(n[10]) * z, np.hypot(x, z), places=4)
            self.assertAlmostEqual(np.exp(1j * (n[10] - float(alpha))), np.exp(1j * np.arctan2(n[7], n[9])), places=3)
            self.assertEqual((kind, int(hidden)), (label["class"], 2 if label["occlusion"] > 0.5 else 1 if label["occlusion"] > 0.02 else 0))
            self.assertAlmostEqual(float(cut), label["truncation"], delta=0.006)

    def test_depth(self):
        for name, image in self.images.items():
            depth = read_pfm(self.path / f"{name}_depth.pfm")
            x, y = (g.ravel() for g in np.meshgrid(np.arange(image["width"]) + 0.5, np.arange(image["height"]) + 0.5))
            origin, d = rays(name, x, y)
            ahead = np.array([0.0, 0, -1]) if name == "chip" else rays(name, np.array([30.0]), np.array([24.0]))[1][0] * 100
            wanted = (d * self.caster.first(origin, d)[1][:, None]) @ ahead + (19000 if name == "chip" else 0)
            off = np.abs(depth.ravel() - wanted)
            self.assertLess(np.mean(off > 1e-3), 0.003, name)  # rays along edges

    def test_objects_keep_apart(self):
        """Footprints from the records: no corner of one lies within another."""
        def own(place, one):
            dx, dy = np.array(place[:2]) - one["position_m"][:2]
            a = np.radians(one["heading_deg"])
            return np.array([dx * np.cos(a) - dy * np.sin(a), dx * np.sin(a) + dy * np.cos(a)]) / one["scale"]

        for a in self.record["objects"]:
            low, high = WHOLE[a["item"]]
            for x in np.linspace(low[0], high[0], 5):
                for y in np.linspace(low[1], high[1], 9):
                    place = placed([x, y, 0], a)
                    self.assertTrue(-11 <= place[0] <= 13 and -10 <= place[1] <= 10)
                    for b in self.record["objects"]:
                        if b is not a:
                            near = own(place, b)
                            (x0, y0, _), (x1, y1, _) = WHOLE[b["item"]]
                            self.assertFalse(x0 <= near[0] <= x1 and y0 <= near[1] <= y1)


class Sequences(Case):
    def test_frames_and_flow(self):
        """Cars that drive and a camera that flies: labels and flow of every frame against the caster at its time."""
        text = CAMPAIGN.replace("seed: 3", "seed: 5\nkeep: [image, error, flow]\nsequence: {frames: 2, step_s: 0.5, move_m_s: [1, 4, 0]}")
        text = text.replace("    spacing_m: 0.5", "    spacing_m: 0.5\n    speed_m_s: {uniform: [2, 6]}")
        campaign = read_campaign(self.write(text, SCENE, SENSORS.replace("paths: 4", "paths: 1")))
        path = Maker(campaign, self.folder / "out", "v").make(0)
        record = json.loads((path / "sample.json").read_text())
        self.assertEqual([(i["name"], i["frame"]) for i in record["images"]], [("chip_0000", 0), ("chip_0001", 1), ("drone_0000", 0), ("drone_0001", 1)])
        self.assertEqual(sorted(p.name for p in path.glob("*.flo")), ["chip_0000_flow.flo", "drone_0000_flow.flo"])
        write_coco(campaign, self.folder / "out")
        coco = json.loads((self.folder / "out/annotations.json").read_text())
        self.assertEqual([(i["video_id"], i["frame_index"]) for i in coco["images"]], [(1, 0), (1, 1)] * 2)
        self.assertTrue(all(a["track_id"] == a["object"] for a in coco["annotations"]))
        step = {n: o["speed_m_s"] * 0.5 * np.array([np.sin(np.radians(o["heading_deg"])), np.cos(np.radians(o["heading_deg"])), 0])
                for n, o in enumerate(record["objects"], 1)}
        self.assertGreater(min(np.linalg.norm(s) for s in step.values()), 1)
        flight = np.array([0.5, 2, 0])
        for image in record["images"]:
            name, frame = image["name"].split("_")[0], image["frame"]
            caster = Boxes()
            caster.add(99, *ROOF)
            caster.add(98, (-30, -30, -1), (30, 30, 0))
            for number, one in enumerate(record["objects"], 1):
                for low, high in PARTS[one["item"]]:
                    caster.add(number, low, high, one["position_m"] + frame * step[number], one["heading_deg"], one["scale"])
            fine = (np.stack(np.meshgrid(np.arange(image["width"] * 3) + 0.5, np.arange(image["height"] * 3) + 0.5)) / 3).reshape(2, -1)
            origin, d = rays(name, *fine)
            owner = caster.trace(origin + frame * flight, d).reshape(image["height"], 3, image["width"], 3)
            for label in image["labels"]:
                mask, share = Labels.mask(label), (owner == label["object"]).mean(axis=(1, 3))
                near = np.lib.stride_tricks.sliding_window_view(np.pad(share, 1, mode="edge"), (3, 3))  # a pixel and those around it
                self.assertTrue(mask[near.min(axis=(2, 3)) == 1].all() and not mask[near.max(axis=(2, 3)) == 0].any(), image["name"])
                self.assertGreater((near.min(axis=(2, 3)) == 1).sum() + (label["area"] < 60), 0)
                np.testing.assert_allclose(label["position_m"], record["objects"][label["object"] - 1]["position_m"] + frame * step[label["object"]], atol=1e-4)
            if frame == 0:
                self.flow(path, name, image, caster, step, flight)

    def test_pairs(self):
        """The same place under another sun: who stays stands as before, and the change's picture is where the caster sees who left and who came."""
        text = CAMPAIGN.replace("seed: 3", "seed: 8\nkeep: [image, error]\npair: {again: [simulation.sun.direction.zenith_deg], leave: 0.5, arrive: 0.5}")
        campaign = read_campaign(self.write(text.replace("{integers: [3, 5]}", "6"), SCENE, SENSORS))
        path = Maker(campaign, self.folder / "out", "v").make(1)
        record = json.loads((path / "sample.json").read_text())
        first, later = ({o["tag"]: o for o in record[key]} for key in ("objects", "objects_later"))
        stay, left, came = set(first) & set(later), set(first) - set(later), set(later) - set(first)
        self.assertTrue(stay and left and came)
        self.assertTrue(all(first[t] == later[t] for t in stay))
        self.assertEqual(sorted(int(t.split(".")[1]) for t in came), list(range(7, 7 + len(came))))
        varied = [key for key in record["values"] if record["values"][key] != record["values_later"][key]]
        self.assertEqual(varied, ["simulation.sun.direction.zenith_deg"])
        self.assertEqual([(i["name"], i["moment"]) for i in record["images"]], [("chip", 0), ("drone", 0), ("chip_later", 1), ("drone_later", 1)])
        for image in record["images"]:
            for label in image["labels"]:
                tag = f"{label['class']}.{label['object']}"
                self.assertEqual(label["change"], "stays" if tag in stay else "leaves" if tag in left else "arrives")
                self.assertIn(tag, later if image["moment"] else first)
        for name in ("chip", "drone"):
            change = read_png(path / f"{name}_change.png")[..., 0]
            owners = []
            for objects, changed in ((first, left), (later, came)):
                caster = Boxes()
                caster.add(-2, *ROOF)
                caster.add(-2, (-30, -30, -1), (30, 30, 0))
                for tag, one in objects.items():
                    for low, high in PARTS[one["item"]]:
                        caster.add(int(tag in changed), low, high, one["position_m"], one["heading_deg"], one["scale"])
                x, y = np.meshgrid((np.arange(change.shape[1] * 4) + 0.5) / 4, (np.arange(change.shape[0] * 4) + 0.5) / 4)
                owners.append((caster.trace(*rays(name, x.ravel(), y.ravel())) == 1).reshape(change.shape[0], 4, change.shape[1], 4).mean(axis=(1, 3)))
            for bit, share in zip((1, 2), owners):
                self.assertTrue((change[share == 1] & bit).all() and not (change[share == 0] & bit).any())
                self.assertGreater((share == 1).sum(), 5)

    def flow(self, path, name, image, caster, step, flight):
        data = (path / f"{name}_0000_flow.flo").read_bytes()
        self.assertEqual((data[:4], *np.frombuffer(data[4:12], "<i4")), (b"PIEH", image["width"], image["height"]))
        found = np.frombuffer(data[12:], "<f4").reshape(-1, 2)
        at = np.stack(np.meshgrid(np.arange(image["width"]) + 0.5, np.arange(image["height"]) + 0.5)).reshape(2, -1)
        origin, d = rays(name, *at)
        owner, length = caster.first(origin, d)
        places = origin + d * length[:, None] + np.array([step.get(n, np.zeros(3)) for n in owner])
        wanted = np.array([projected(name, p - flight) for p in places]) - at.T
        self.assertGreater(np.isin(owner, list(step)).sum(), 50)
        self.assertLess(np.mean(np.abs(found - wanted).max(axis=1) > 2e-3), 0.003)  # rays along edges
        self.assertGreater(np.ptp(found[:, 0]), 1)


def read_pfm(path):
    kind, size, scale, data = path.read_bytes().split(b"\n", 3)
    columns, rows = map(int, size.split())
    return np.frombuffer(data, "<f4").reshape(rows, columns)[::-1]


class Shapes(unittest.TestCase):
    def test_the_smallest_box(self):
        rng = np.random.default_rng(3)
        for angle in rng.uniform(0, np.pi, 20):
            turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
            points = np.vstack([rng.uniform([-4, -1], [4, 1], (50, 2)), [[-4, -1], [4, -1], [4, 1], [-4, 1]]]) @ turn.T
            box = smallest(points)
            self.assertAlmostEqual(np.linalg.norm(box[0] - box[1]) * np.linalg.norm(box[1] - box[2]), 16)
            for corner in np.array([[-4, -1], [4, -1], [4, 1], [-4, 1]]) @ turn.T:
                self.assertLess(np.linalg.norm(box - corner, axis=1).min(), 1e-9)


class LaserRadars(Case):
    def test_pulses_stand_beside_images(self):
        """A laser radar has no truth, and its responses and points are kept with the sample."""
        radar = """\
  - kind: lidar
    name: als
    position_m: [0, 0, 100]
    look_at_m: [0, 0, 0]
    tasks: [{start: 0, pulses: 2}]
    laser: {wavelength_um: 0.65, pulse_energy_j: 1.0e-5, rate_hz: 200, pulse: {kind: gaussian, fwhm_ns: 4}, beam: {kind: gaussian, full_angle_1_e2_mrad: 0.5}}
    receiver: {aperture_mm: 100, field_of_view_mrad: 1.5, filter_nm: 1}
    gate: {start_m: 90, stop_m: 105, bin_ns: 1}
    orders: 1
    paths: 4
    detectors: [{kind: linear, name: points, quantum_efficiency: 0.8, receiver_fwhm_ns: 1, returns: {by: gaussian, threshold_e_per_ns: 100}}]
    output: [csv]
"""
        run(self.write(CAMPAIGN.replace("samples: 5", "samples: 1"), simulation=SIMULATION + radar), self.folder / "set", workers=0)
        sample = self.folder / "set/samples/000000"
        record = json.loads((sample / "sample.json").read_text())
        self.assertEqual([image["name"] for image in record["images"]], ["chip"])
        self.assertGreater(len(record["images"][0]["labels"]), 0)
        self.assertEqual(rs.open_response(sample / "als_response.h5").sizes["pulse"], 2)
        self.assertTrue(any((sample / "als").iterdir()))


if __name__ == "__main__":
    unittest.main()
