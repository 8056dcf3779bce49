"""Launchers and executors: the ranks that mpirun starts, the tasks of an array as a stand-in for Slurm's sbatch starts them, and Dask's workers make the
same bytes as one process."""
import os
import re
import shutil
import subprocess
import sys
import unittest

from kit import CAMPAIGN, Case, hashes
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

    def test_dask(self):
        try:
            from distributed import Client, LocalCluster
        except ImportError:
            self.skipTest("needs distributed")
        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
            self.assertTrue(run(self.path, self.folder / "dask", executor=client.get_executor()).complete)
        self.same(self.folder / "dask")


if __name__ == "__main__":
    unittest.main()
