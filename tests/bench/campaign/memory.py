#!/usr/bin/env python3
"""memory.py [--samples 3000]
The memory of a worker over many samples, at a tenth of their cost: one sample of the parking lot (sample_scenes/campaigns) is prepared and rendered; for
all others, whose objects are the same, copies of its files stand in for what the programs would write. Whatever a worker itself does is done: draws, texts,
placement, labels by rays, pictures, records. Prints the resident memory about the 500th sample and at the end.

Needs the package on PYTHONPATH and the programs (REMOTE_SCENES_BIN), numpy, xarray and PyYAML."""
import argparse
import os
import shutil
import statistics
import sys
import tempfile
from pathlib import Path

import yaml

from kit import parking_lot
from remote_scenes import campaign
from remote_scenes.campaign import sample as sample_module
from remote_scenes.campaign import shared
from remote_scenes.campaign.answers import answer_of
from remote_scenes.campaign.engine import prepare_folder
from remote_scenes.campaign.sample import Maker


def one_lot(folder, samples):
    """The parking lot with six cars that stand the same in every sample."""
    path = parking_lot(folder, samples, 1)
    text = yaml.safe_load(path.read_text())
    text["objects"] = {"cars": {"catalogue": {"car": {"place": "car"}}, "count": 6, "where": {"slots": [[-6 + 2.4 * i, 1.5, 0] for i in range(6)]}}}
    text["vary"] = {"simulation.sun.direction.zenith_deg": {"uniform": [20, 60], "draw": "latin"}, "scene.materials.asphalt.reflectance": {"uniform": [0.05, 0.15]}}
    path.write_text(yaml.safe_dump(text, sort_keys=False))
    return path


class StandIn:
    """Runs a program for the first sample, and copies what it wrote for all others."""

    def __init__(self, run, store):
        self.run, self.store, self.done = run, store, set()

    def __call__(self, name, arguments, cwd=None, **more):
        made = Path(cwd, "out") if name == "dirsig-render" else Path(arguments[2])
        kept = self.store / made.name.rpartition(".")[2]
        if name != "dirsig-render" and made.name != "things.h5":
            return self.run(name, arguments, cwd=cwd, **more)  # what is shared
        if name not in self.done:
            self.done.add(name)
            told = self.run(name, arguments, cwd=cwd, **more)
            (shutil.copytree if made.is_dir() else shutil.copy)(made, kept)
            return told
        (shutil.copytree if kept.is_dir() else shutil.copy)(kept, made)
        return None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--samples", type=int, default=3000)
    options = parser.parse_args()
    if options.samples < 600:
        parser.error("at least 600 samples")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        text = campaign.read_campaign(one_lot(folder / "texts", options.samples))
        maker = Maker(text, folder / "data", prepare_folder(text, folder / "data"))
        sample_module.run_program = shared.run_program = StandIn(shared.run_program, folder / "texts")
        memory, labels = [], 0
        for i in range(options.samples):
            answer = answer_of(maker, i)
            if "error" in answer:
                sys.exit(answer["error"])
            memory.append(answer["rss_kb"])
            labels += os.path.getsize(maker.path(i) / "sample.json") > 5000
            shutil.rmtree(maker.path(i))
        early, late = statistics.median(memory[480:520]), statistics.median(memory[-40:])
        print(f"{options.samples} samples, {labels} with labels: {memory[0] / 1024:.1f} MiB after the first, {early / 1024:.1f} about the 500th, {late / 1024:.1f} at the end: "
              f"{100 * (late / early - 1):+.2f} %")
    return 0


if __name__ == "__main__":
    sys.exit(main())
