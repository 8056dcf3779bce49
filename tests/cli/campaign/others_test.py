"""Programs of others. Launchers and executors: the ranks that mpirun starts, the tasks of an array of Slurm, which the test starts, and of a stand-in for
its sbatch, and Dask's workers make the same bytes as one process. Readers: rasterio on GeoTIFF and COG, with the labels of the map upon them; zarr, pystac, mlcroissant and pycocotools without an
error. What is not installed is skipped."""
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

import numpy as np
import slurm_kit
from kit import CAMPAIGN, SIMULATION, Case, hashes
from remote_scenes.campaign import run

SAMPLES = 6
TEXT = CAMPAIGN.replace("samples: 5", f"samples: {SAMPLES}\nformats: [coco]")
COMMAND = [sys.executable, "-B", "-m", "remote_scenes.campaign"]


class Launch(Case):
    def setUp(self):
        super().setUp()
        self.path = self.write(TEXT)
        run(self.path, self.folder / "alone", workers=0)

    def same(self, folder):
        self.assertEqual(hashes(folder), hashes(self.folder / "alone"))
        self.assertEqual((folder / "annotations.json").read_bytes(), (self.folder / "alone/annotations.json").read_bytes())

    @unittest.skipUnless(shutil.which("mpirun"), "needs mpirun")
    def test_ranks_of_mpirun(self):
        done = subprocess.run(["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", "3", *COMMAND, self.path, "-o", self.folder / "ranks", "--shard", "rank",
                               "--workers", "1", "-q"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.same(self.folder / "ranks")

    def test_an_array_of_tasks(self):
        """sbatch is a script here: it reads the array from the text and starts each task, the last one twice, as after a requeue."""
        text = subprocess.run([*COMMAND, self.path, "-o", self.folder / "array", "--slurm", "3", "--workers", "1"], capture_output=True, text=True, check=True).stdout
        (self.folder / "array").mkdir(exist_ok=True)
        (self.folder / "job").write_text(text)
        first, last = map(int, re.search(r"^#SBATCH --array=(\d+)-(\d+)$", text, re.M).groups())
        for task in [*range(first, last + 1), last]:
            subprocess.run(["sh", self.folder / "job"], env={**os.environ, "SLURM_ARRAY_TASK_ID": str(task)}, check=True, capture_output=True)
        self.same(self.folder / "array")

    @unittest.skipIf(slurm_kit.missing(), f"needs Slurm: no {slurm_kit.missing()}")
    def test_an_array_of_slurm(self):
        """Slurm itself: of an array of two tasks one is requeued while it works, the other one is killed with SIGKILL and requeued after its end."""
        folder = self.folder / "by slurm"
        text = subprocess.run([*COMMAND, self.path, "-o", folder, "--slurm", "2", "--workers", "1"], capture_output=True, text=True, check=True).stdout
        (self.folder / "job").write_text(text)
        with slurm_kit.Slurm() as slurm:
            job = slurm.call("sbatch", "--parsable", "--time=60", self.folder / "job").strip()
            self.until(lambda: self.made(folder, 1) >= 1)
            slurm.call("scontrol", "requeue", f"{job}_1")
            os.kill(self.until(lambda: self.task_at_work(folder, 2)), signal.SIGKILL)
            self.until(lambda: slurm.states(job)[2][0] in ("FAILED", "NODE_FAIL", "COMPLETED"))
            slurm.call("scontrol", "requeue", f"{job}_2")
            self.until(lambda: {state for state, _ in slurm.states(job).values()} == {"COMPLETED"})
            self.assertEqual(slurm.states(job), {1: ("COMPLETED", 1), 2: ("COMPLETED", 1)})
            # All of its samples may have been there when it was killed.
            self.assertRegex((self.folder / f"by slurm-slurm-{job}_2.log").read_text(), "samples made|samples were there")
            print(f"Slurm {slurm.version()}", file=sys.stderr)
        subprocess.run([*COMMAND, self.path, "-o", folder, "-q"], check=True, capture_output=True)
        self.same(folder)

    def until(self, reached, seconds=300):
        end = time.monotonic() + seconds
        while not (found := reached()):
            self.assertLess(time.monotonic(), end, "too late")
            time.sleep(0.02)
        return found

    def made(self, folder, task):
        """Samples of one of two tasks that are there."""
        return sum(p.name.isdecimal() and int(p.name) % 2 == task - 1 for p in folder.glob("samples/*"))

    def task_at_work(self, folder, task):
        """The process of one of two tasks, once its worker makes a sample: what is unfinished has the worker's number in its name."""
        for path in folder.glob("samples/.0*"):
            _, sample, *_, worker = path.name.split(".")
            if int(sample) % 2 == task - 1:
                try:
                    return int(Path(f"/proc/{worker}/stat").read_text().rpartition(")")[2].split()[1])
                except OSError:
                    pass  # it has just ended
        return None

    def test_dask(self):
        try:
            from distributed import Client, LocalCluster
        except ImportError:
            self.skipTest("needs distributed")
        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
            self.assertTrue(run(self.path, self.folder / "dask", executor=client.get_executor()).complete)
        self.same(self.folder / "dask")


class Readers(Case):
    def test_labels_on_geotiff(self):
        """GeoJSON and GeoTIFF meet by their coordinates alone: footprints from longitude and latitude lie on the oriented boxes within half a pixel; the
        cloud-optimised file is tiled, its header comes first, and it has the same numbers."""
        try:
            import rasterio
            import rasterio.warp
        except ImportError:
            self.skipTest("needs rasterio")
        text = CAMPAIGN.replace("samples: 5", "samples: 2\nformats: [coco, geojson, zarr, cog, stac, croissant]")
        folder = self.folder / "out"
        self.assertTrue(run(self.write(text, simulation=SIMULATION + "output: {also: [geotiff]}\n"), folder, workers=0).complete)
        labels = {(a["image_id"], a["object"]): a for a in json.loads((folder / "annotations.json").read_text())["annotations"]}
        features = json.loads((folder / "labels.geojson").read_text())["features"]
        self.assertEqual(len(features), len(labels))
        for feature in features:
            sample = int(feature["properties"]["image"][:6])
            with rasterio.open(folder / f"samples/{sample:06d}/chip.tif") as image, rasterio.open(folder / f"cog/{sample:06d}_chip.tif") as cog:
                self.assertEqual((cog.read() == image.read()).all(), True)
                self.assertTrue(cog.profile["tiled"] and cog.transform == image.transform and cog.crs == image.crs)
                ring = rasterio.warp.transform_geom("EPSG:4326", image.crs, feature["geometry"])["coordinates"][0]
                at = np.array([~image.transform * corner[:2] for corner in ring[:4]])
            box = np.array(labels[sample + 1, feature["properties"]["object"]]["obb"])
            for corner in at:
                self.assertLess(np.abs(box - corner).max(axis=1).min(), 0.5)
            data = (folder / f"cog/{sample:06d}_chip.tif").read_bytes()
            self.assertLess(int.from_bytes(data[4:8], "little"), 300)  # the first directory
        item = json.loads((folder / "stac/items/000001_chip.json").read_text())
        self.assertEqual(item["assets"]["cog"]["type"], "image/tiff; application=geotiff; profile=cloud-optimized")
        self.validators(folder)

    def validators(self, folder):
        try:
            import mlcroissant
            import pystac
            import zarr
        except ImportError:
            return
        self.assertEqual(pystac.Collection.from_file(str(folder / "stac/collection.json")).validate_all(), 2)
        issues = mlcroissant.Dataset(str(folder / "croissant.json")).metadata.issues
        self.assertEqual(list(issues.errors), [])
        group = zarr.open_group(folder / "dataset.zarr", mode="r")
        self.assertEqual((group["chip/radiance"].shape, group["chip/radiance"].metadata.dimension_names), ((2, 1, 32, 32), ("sample", "band", "y", "x")))
        self.assertEqual(group["chip/radiance"][1].tobytes(), (folder / "samples/000001/chip.img").read_bytes())


if __name__ == "__main__":
    unittest.main()
