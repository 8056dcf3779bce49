"""The engine: the same bytes with any number of workers, after kill -9 and by shards; refusals that leave nothing half-written; and what is written
when all samples are there, read by decoders of the tests' own."""
import contextlib
import gzip
import io
import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import tarfile
import time
import unittest
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from unittest import mock

import numpy as np

from kit import CAMPAIGN, SCENE, SIMULATION, SOME_REFUSED, Case, hashes
from remote_scenes.campaign import CampaignError, forecast, read_campaign, run
from remote_scenes.campaign.__main__ import main
from remote_scenes.campaign.engine import IN_A_ROW, Tally, prepare_folder, run_samples
from remote_scenes.campaign.exports import images
from remote_scenes.campaign.label_files import write_coco
from remote_scenes.campaign.launch import RANKS, shard_of_rank
from remote_scenes.campaign.sheet import read_png, write_sheet
from remote_scenes.campaign.slurm import slurm_script
from remote_scenes.campaign.zarr_store import write_zarr

SAMPLES = 4
FORMATS = "formats: [coco, panoptic, dota, yolo, yolo_obb, geojson, webdataset, zarr, stac, croissant]\n"


def command(path, folder, *more):
    return [sys.executable, "-B", "-m", "remote_scenes.campaign", str(path), "-o", str(folder), *more]


def children(pid):
    try:
        return [int(p) for p in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]
    except OSError:
        return []


def count(folder):
    samples = folder / "samples"
    return sum(p.name.isdecimal() for p in samples.iterdir()) if samples.is_dir() else 0


class Engine(Case):
    @unittest.skipUnless(Path("/proc/self/task").is_dir(), "needs /proc")
    def test_same_bytes_however_it_is_made(self):
        text = CAMPAIGN.replace("seed: 3", FORMATS + "seed: 3").replace("samples: 5", f"samples: {SAMPLES}")
        path = self.write(text)
        first = self.folder / "first"
        outcome = run(path, first, workers=0)
        self.assertTrue(outcome.complete and outcome.tally.made == SAMPLES)
        self.assertEqual(len(list((first / "shared").iterdir())), 2 + 2 + 1)  # two grounds, two objects, what they stand on: prepared once
        # Two workers, of which one is killed while it works; then all of it is.
        second = self.folder / "second"
        with open(self.folder / "log", "w") as log:
            process = subprocess.Popen(command(path, second, "--workers", "2"), stdout=log, stderr=log, text=True)
            self.kill_one(process, second)
            while count(second) < 2 and process.poll() is None:
                time.sleep(0.02)
            process.kill()
            process.wait()
        self.assertIn("a worker ended with -9", (self.folder / "log").read_text())
        time.sleep(0.1)
        # What is left goes on in shards, by other numbers of workers, and by an executor.
        self.assertLess(count(second), SAMPLES)
        run(path, second, workers=0, shard=(2, 2))
        with ProcessPoolExecutor(1) as executor:
            last = run(path, second, executor=executor)
        self.assertTrue(last.complete)
        self.assertEqual(hashes(first), hashes(second))
        self.assertFalse([p for p in (second / "samples").iterdir() if p.name.startswith(".")])
        # The control: samples differ.
        self.assertEqual(len({(first / f"samples/{i:06d}/chip.img").read_bytes() for i in range(SAMPLES)}), SAMPLES)
        self.lists(first)
        told = forecast(read_campaign(self.write(text)), "v", 1)
        size = sum(p.stat().st_size for p in (first / "samples").rglob("*") if p.is_file())
        self.assertEqual((told.samples, told.pilots), (SAMPLES, 1))
        self.assertAlmostEqual(told.bytes / size, 1, delta=0.1)
        self.assertRegex(str(told), r"4 samples: [\d.e-]+ h of one processor, .*\nmedian relative standard error: chip/red [\d.]+ %")
        write_sheet(first, list(images(first)), self.folder / "sheet.png")
        sheet = read_png(self.folder / "sheet.png")
        self.assertEqual(sheet.shape, (6 + 262, 6 + 4 * 262, 3))
        self.assertTrue((sheet == (255, 220, 0)).all(axis=2).any())  # the frame of a car

    def kill_one(self, process, folder):
        """One worker, once it has begun a sample."""
        while process.poll() is None:
            busy = [p.name for p in (folder / "samples").glob(".0*")] if (folder / "samples").is_dir() else []
            workers = [int(name.rpartition(".")[2]) for name in busy]
            mine = [w for w in workers if w in children(process.pid)]
            if mine:
                os.kill(mine[0], signal.SIGKILL)
                return
            time.sleep(0.01)

    def lists(self, folder):
        records = [json.loads((folder / f"samples/{i:06d}/sample.json").read_text()) for i in range(SAMPLES)]
        labels = [(i, label) for i, record in enumerate(records) for image in record["images"] for label in image["labels"]]
        self.assertGreater(len(labels), 6)
        coco = json.loads((folder / "annotations.json").read_text())
        self.assertEqual([(a["image_id"] - 1, a["bbox"], a["area"]) for a in coco["annotations"]], [(i, a["bbox"], a["area"]) for i, a in labels])
        self.assertEqual([c["name"] for c in coco["categories"]], ["car", "truck"])
        self.assertTrue(all((folder / i["file_name"]).is_file() for i in coco["images"]))
        dota = [(i, line.split()) for i in range(SAMPLES) for line in (folder / f"labelTxt/{i:06d}_chip.txt").read_text().splitlines()[2:]]
        boxes = [(i, line.split()) for i in range(SAMPLES) for line in (folder / f"yolo/labels/{i:06d}_chip.txt").read_text().splitlines()]
        turned = [(i, line.split()) for i in range(SAMPLES) for line in (folder / f"yolo_obb/labels/{i:06d}_chip.txt").read_text().splitlines()]
        features = json.loads((folder / "labels.geojson").read_text())["features"]
        self.assertEqual({len(dota), len(boxes), len(turned), len(features)}, {len(labels)})
        for (i, label), (j, d), (_, b), (_, t), feature in zip(labels, dota, boxes, turned, features):
            self.assertEqual((i, label["class"]), (j, d[8]))
            np.testing.assert_allclose(np.array(d[:8], float).reshape(4, 2), label["obb"], atol=0.006)
            x, y, w, h = label["bbox"]
            np.testing.assert_allclose(np.array(b[1:], float) * 32, [x + w / 2, y + h / 2, w, h], atol=1e-4)
            np.testing.assert_allclose(np.array(t[1:], float).reshape(4, 2) * 32, np.clip(label["obb"], 0, 32), atol=1e-4)
            self.on_the_map(feature, label)
        self.shards(folder, labels)
        self.store(folder)
        self.cards(folder)

    def on_the_map(self, feature, label):
        """Longitude and latitude by the radii of curvature at the origin, onto the pixels of the map: within half a pixel of the oriented box."""
        a, e2, lat = 6378137.0, 0.00669437999014, np.radians(49.4)
        w = np.sqrt(1 - e2 * np.sin(lat) ** 2)
        east = lambda lon: np.radians(lon - 8.7) * (a / w + 112) * np.cos(lat)
        north = lambda latitude: np.radians(latitude - 49.4) * (a * (1 - e2) / w ** 3 + 112)
        ring = [((east(x) / 0.6) + 16, 16 - north(y) / 0.6) for x, y in feature["geometry"]["coordinates"][0][:4]]
        # The ring begins behind on the left, the oriented box ahead on the left.
        behind_left, behind_right, ahead_right, ahead_left = map(np.array, ring)
        for corner, place in zip(label["obb"], (ahead_left, ahead_right, behind_right, behind_left)):
            self.assertLess(np.abs(place - corner).max(), 0.5)

    def shards(self, folder, labels):
        sizes = json.loads((folder / "shards/sizes.json").read_text())
        self.assertEqual(sum(sizes.values()), SAMPLES)
        found = {}
        for name in sizes:
            with tarfile.open(folder / "shards" / name) as tar:
                for member in tar:
                    key, _, ending = member.name.partition(".")
                    found.setdefault(key, {})[ending] = tar.extractfile(member).read()
        self.assertEqual(list(found), [f"{i:06d}_chip" for i in range(SAMPLES)])
        self.assertEqual(set(found["000003_chip"]), {"png", "json", "img", "img.hdr", "error.img", "error.img.hdr", "quality.img", "quality.img.hdr",
                                                       "panoptic.png"})
        self.assertEqual(found["000003_chip"]["img"], (folder / "samples/000003/chip.img").read_bytes())
        self.assertEqual([a for i in range(SAMPLES) for a in json.loads(found[f"{i:06d}_chip"]["json"])["labels"]], [a for _, a in labels])

    def store(self, folder):
        """The arrays by their own description, a chunk an image."""
        store = folder / "dataset.zarr"
        for product, kind, bands in (("radiance", "<f4", 1), ("standard_error", "<f4", 1), ("quality", "u1", 1)):
            about = json.loads((store / "chip" / product / "zarr.json").read_text())
            self.assertEqual((about["zarr_format"], about["shape"], about["chunk_grid"]["configuration"]["chunk_shape"]), (3, [SAMPLES, bands, 32, 32], [1, bands, 32, 32]))
            self.assertEqual([c["name"] for c in about["codecs"]], ["bytes", "gzip"])
            ending = {"radiance": "", "standard_error": "_error", "quality": "_quality"}[product]
            for i in range(SAMPLES):
                self.assertEqual(gzip.decompress((store / f"chip/{product}/c/{i}/0/0/0").read_bytes()), (folder / f"samples/{i:06d}/chip{ending}.img").read_bytes())
        try:
            import zarr
        except ImportError:
            return
        group = zarr.open_group(store, mode="r")
        self.assertEqual(group["chip/sample"][:].tolist(), list(range(SAMPLES)))
        self.assertEqual(group["chip/radiance"][3].tobytes(), (folder / "samples/000003/chip.img").read_bytes())
        self.assertEqual(group["chip/radiance"].metadata.dimension_names, ("sample", "band", "y", "x"))

    def cards(self, folder):
        collection = json.loads((folder / "stac/collection.json").read_text())
        items = [link["href"] for link in collection["links"] if link["rel"] == "item"]
        self.assertEqual(len(items), SAMPLES)
        for href in items:
            item = json.loads((folder / "stac" / href).read_text())
            self.assertEqual(item["collection"], collection["id"])
            for asset in item["assets"].values():
                self.assertTrue(((folder / "stac" / href).parent / asset["href"]).resolve().is_file(), asset)
            # 32 pixels of 0.6 m.
            west, south, east, north = item["bbox"]
            self.assertAlmostEqual((north - south) * 111_226, 19.2, delta=0.02)
            self.assertAlmostEqual((east - west) * 72_600, 19.2, delta=0.05)
        card = json.loads((folder / "croissant.json").read_text())
        self.assertEqual((card["rs:seed"], card["rs:statistics"]["samples"], card["rs:distributions"]["simulation.sun.direction.zenith_deg"]),
                         (3, SAMPLES, {"uniform": [20, 60]}))
        try:
            import pystac
        except ImportError:
            pass
        else:
            pystac.Collection.from_file(str(folder / "stac/collection.json")).validate_all()
        try:
            import mlcroissant
        except ImportError:
            pass
        else:
            self.assertEqual(len(mlcroissant.Dataset(str(folder / "croissant.json")).metadata.issues.errors), 0)
        try:
            from pycocotools import mask
            from pycocotools.coco import COCO
        except ImportError:
            pass
        else:
            found = COCO(folder / "annotations.json")
            for one in found.loadAnns(found.getAnnIds()):
                runs = mask.frPyObjects(one["segmentation"], *one["segmentation"]["size"])
                self.assertEqual((int(mask.area(runs)), mask.toBbox(runs).tolist()), (one["area"], one["bbox"]))

    def test_lists_are_written_whole(self):
        """A list that stands there is not touched when writing the new one fails."""
        path = self.write()
        folder = self.folder / "d"
        (folder / "samples").mkdir(parents=True)
        (folder / "annotations.json").write_text("old")
        limit = resource.getrlimit(resource.RLIMIT_FSIZE)
        old = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        try:
            resource.setrlimit(resource.RLIMIT_FSIZE, (50, limit[1]))
            for write in (write_coco, write_zarr):
                with self.assertRaises(OSError):
                    write(read_campaign(path), folder)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limit)
            signal.signal(signal.SIGXFSZ, old)
        self.assertEqual(sorted((p.name, p.read_text() if p.is_file() else "") for p in folder.iterdir()), [("annotations.json", "old"), ("samples", "")])


class Refusals(Case):
    def refused(self, said, line=None, **texts):
        """One message, no sample, nothing half-written."""
        path = self.write(**texts)
        with self.assertRaises(CampaignError) as caught:
            run(path, self.folder / "out", workers=0)
        message = str(caught.exception)
        self.assertRegex(message, said)
        self.assertEqual(len(message.splitlines()), 1)
        if line:
            self.assertIn(f"campaign.yaml:{line}:", message)
        self.assertEqual([p for p in self.folder.glob("out/samples/*")], [])
        self.assertEqual([p for p in self.folder.glob("out/shared/.*")], [])

    def test_impossible_placements(self):
        tight = CAMPAIGN.replace("{integers: [3, 5]}", "60").replace("    spacing_m: 0.5", "    attempts: 40\n    spacing_m: 5")
        # The simulation's own check comes first: variables are tried by it.
        self.refused("sample 0: object \\d+ of 'cars': no place has room in 40 attempts; fewer objects", 10, campaign=tight)

    def test_a_distribution_that_leaves_its_range(self):
        wide = CAMPAIGN.replace("{choice: [0.08, 0.12]}", "{uniform: [0.3, 1.2]}").replace("{integers: [3, 5]}", "0")
        self.refused("'scene.materials.ground.reflectance' of 1.2, which this distribution reaches, is refused: .*; a narrower distribution", 8, campaign=wide)

    def test_a_variable_that_others_refer_to(self):
        """Its own range is any; the key that gets it has one."""
        wide = CAMPAIGN.replace("{choice: [0.08, 0.12]}", "$r\n  r: {normal: [0.5, 0.2]}").replace("{integers: [3, 5]}", "0")
        self.refused("'r' of -0.45.*, which this distribution reaches, is refused", 9, campaign=wide)

    def test_templates_that_a_program_refuses(self):
        """In the scene's text with its own line, in the simulation's with the key."""
        self.refused(r"scene.yaml:4:\d+: error: .*reflectance", scene=SCENE.replace("reflectance: 0.1}", "reflectance: 1.1}"))
        self.refused(r"simulation.yaml: error: the first sample is refused: .*paths", simulation=SIMULATION.replace("paths: 4", "paths: -4"))

    def test_a_sample_that_is_refused_once_its_objects_are_drawn(self):
        path = self.write(CAMPAIGN.replace("samples: 5", "samples: 1").replace("place: car, ", "place: car, scale: {choice: [$s]}, ").replace("vary:\n", "vary:\n  s: -1\n"))
        with self.assertRaisesRegex(CampaignError, "campaign.yaml:13:\\d+: error: sample 0: the scale -1 is out of range"):
            run(path, self.folder / "out", workers=0)
        self.assertEqual([p for p in self.folder.glob("out/samples/*")], [])

    def test_one_sample_of_many_is_refused(self):
        """The first and the last: the others are made and in the lists, one message names them, and the command ends with 1. By a worker: combined_test.py."""
        path, folder, said = self.write(SOME_REFUSED), self.folder / "out", io.StringIO()
        with contextlib.redirect_stderr(said):
            self.assertEqual(main([str(path), "-o", str(folder), "--workers", "0", "-q"]), 1)
        self.assertRegex(said.getvalue(), r"^\S*campaign.yaml:\d+:\d+: error: sample 0: .*\(2 of 3 samples were refused: 0, 2; the others are there\)\n$")
        self.assertEqual([p.name for p in (folder / "samples").iterdir()], ["000001"])
        self.assertEqual([i["file_name"][8:14] for i in json.loads((folder / "annotations.json").read_text())["images"]], ["000001"])

    def test_workers_that_end_without_an_answer(self):
        """After three of them a sample counts as refused, and the others have their turn."""
        campaign = read_campaign(self.write())
        prepare_folder(campaign, self.folder / "out")
        with mock.patch.object(sys, "executable", shutil.which("false")):
            tally = run_samples(campaign, self.folder / "out", range(2), 2, "v", lambda _: None)
        self.assertEqual((tally.made, tally.deaths, sorted(tally.refused)), (0, 6, [0, 1]))
        self.assertIn("3 workers ended without an answer at sample 1 (the last one with 1); memory", tally.refused[1])

    def test_many_refusals_end_the_run(self):
        """Ten in a row: what they have in common is not looked for in all others. One that is made begins the count anew."""
        tally = Tally()
        for sample in range(IN_A_ROW - 1):
            tally.refuse(sample, f"error: sample {sample}")
        with self.assertRaisesRegex(CampaignError, "error: sample 0 .10 samples in a row"):
            tally.refuse(20, "error: sample 20")

    def test_texts_that_change_under_way(self):
        """A worker that begins after the change makes no sample of it."""
        path = self.write()
        campaign = read_campaign(path)
        prepare_folder(campaign, self.folder / "out")
        self.write(CAMPAIGN.replace("seed: 3", "seed: 4"))
        with self.assertRaisesRegex(CampaignError, "the texts were changed while the run went on"):
            run_samples(campaign, self.folder / "out", range(2), 1, "v", lambda _: None)
        self.assertEqual(list((self.folder / "out/samples").iterdir()), [])

    def test_folders(self):
        path = self.write()
        (self.folder / "file").write_text("")
        with self.assertRaisesRegex(CampaignError, "the dataset cannot be written"):
            run(path, self.folder / "file/out", workers=0)
        (self.folder / "other").mkdir()
        (self.folder / "other/mine").write_text("")
        with self.assertRaisesRegex(CampaignError, "holds something else"):
            run(path, self.folder / "other", workers=0)
        # Another shard has begun a moment ago, and has written no record yet.
        (self.folder / "begun/samples").mkdir(parents=True)
        (self.folder / "begun/.campaign.json.host.1").write_text("")
        prepare_folder(read_campaign(path), self.folder / "begun")
        self.assertTrue((self.folder / "begun/campaign.json").is_file())
        (self.folder / "made/samples/000000").mkdir(parents=True)
        (self.folder / "made/campaign.json").write_text('{"campaign": "x"}')
        with self.assertRaisesRegex(CampaignError, "a campaign with other texts; give another folder"):
            run(path, self.folder / "made", workers=0)

    def test_a_full_disk(self):
        """No file may have more than 3 kB: one message, nothing half-written; with room the same command goes on."""
        path = self.write(CAMPAIGN.replace("samples: 5", "samples: 1").replace("{integers: [3, 5]}", "0").replace("  simulation.sun.direction.zenith_deg: {uniform: [20, 60]}\n", "").replace("{choice: [0.08, 0.12]}", "0.1"))

        def full():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (3000, 3000))

        done = subprocess.run(command(path, self.folder / "out", "--workers", "0"), capture_output=True, text=True, preexec_fn=full)
        self.assertEqual(done.returncode, 1, done)
        errors = [line for line in done.stderr.splitlines() if "error" in line]
        self.assertEqual(len(errors), 1, done.stderr)
        self.assertNotIn("Traceback", done.stderr)
        self.assertEqual([p.name for p in self.folder.glob("out/samples/*")] + [p.name for p in self.folder.glob("out/shared/*")], [])
        self.assertTrue(run(path, self.folder / "out", workers=0).complete)

    def test_ranks(self):
        """Of each launcher the shard that a rank makes; one message where there is none."""
        for rank, size in RANKS:
            self.assertEqual([shard_of_rank({rank: str(i), size: "3"}) for i in range(3)], [(1, 3), (2, 3), (3, 3)])
        for wrong in ({}, {"PMI_RANK": "1"}, {"PMI_RANK": "3", "PMI_SIZE": "3"}, {"PMI_RANK": "x", "PMI_SIZE": "3"}):
            with self.assertRaises(CampaignError):
                shard_of_rank(wrong)

    def test_slurm(self):
        """The script makes every shard once; `sbatch` is not there, so that a shell takes its place."""
        campaign = read_campaign(self.write())
        (self.folder / "a b").mkdir()
        text = slurm_script(campaign, self.folder / "a b", 3, 1)
        self.assertIn("#SBATCH --array=1-3\n", text)
        (self.folder / "job").write_text(text.replace("exec ", "exec echo "))
        said = [subprocess.run(["sh", str(self.folder / "job")], capture_output=True, text=True, env={**os.environ, "SLURM_ARRAY_TASK_ID": str(i)}).stdout
                for i in (1, 2, 3)]
        self.assertEqual([s.partition("--shard ")[2].split()[0] for s in said], ["1/3", "2/3", "3/3"])
        self.assertTrue(all(f"-o {self.folder}/a b --shard" in s for s in said))
        # What Slurm writes is not in the dataset, which would hold something else then.
        self.assertIn(f'#SBATCH --output="{self.folder}/a b-slurm-%A_%a.log"\n', text)


if __name__ == "__main__":
    unittest.main()
