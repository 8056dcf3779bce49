"""What the measurements of campaigns share: the parking lot of sample_scenes with other numbers, and runs in which workers are killed."""
import hashlib
import os
import random
import re
import signal
import threading
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]


def parking_lot(folder, samples, paths, seed=56):
    """The texts of sample_scenes/campaigns for so many chips of 64 x 64 x 4: radiance, errors and labels, without GeoTIFF and lists. Returns the
    campaign's path."""
    source = ROOT / "sample_scenes/campaigns"
    folder.mkdir(parents=True, exist_ok=True)
    for name, changes in {
            "scene.yaml": [], "simulation.yaml": [(r"paths: 16", f"paths: {paths}"), (r"output: \{also: \[geotiff\]\}\n", "")],
            "campaign.yaml": [(r"samples: 200", f"samples: {samples}"), (r"seed: 56", f"seed: {seed}"), (r"formats: .*", "formats: []\nkeep: [image, error]")]}.items():
        text = (source / name).read_text()
        for old, new in changes:
            text, found = re.subn(old, new, text)
            if found != 1:
                raise SystemExit(f"{source / name} has '{old}' {found} times")
        (folder / name).write_text(text)
    return folder / "campaign.yaml"


def digest(sample):
    """Of all files of a sample, by name."""
    whole = hashlib.sha256()
    for file in sorted(sample.iterdir()):
        whole.update(file.name.encode() + b"\0" + hashlib.sha256(file.read_bytes()).digest())
    return whole.hexdigest()


class Killer(threading.Thread):
    """Kills one worker of this process at a time with SIGKILL, once the dataset has grown to each of some random sizes."""

    def __init__(self, there, samples, kills, seed=1):
        super().__init__(daemon=True)
        dice = random.Random(seed)
        self.at = sorted(dice.sample(range(there + 1, samples), min(kills, max(samples - there - 1, 0))))
        self.dice, self.killed, self.made = dice, 0, there

    def run(self):
        while self.at:
            if self.made >= self.at[0]:
                time.sleep(self.dice.uniform(0, 0.2))  # at whatever the worker does then
                workers = [p for p in children(os.getpid()) if "remote_scenes.campaign.worker" in command_of(p)]
                if workers:
                    os.kill(self.dice.choice(workers), signal.SIGKILL)
                    self.killed += 1
                    self.at.pop(0)
            time.sleep(0.02)


def children(pid):
    """Of all threads of a process."""
    found = []
    for thread in Path(f"/proc/{pid}/task").iterdir():
        try:
            found += [int(p) for p in (thread / "children").read_text().split()]
        except OSError:
            pass
    return found


def command_of(pid):
    try:
        return Path(f"/proc/{pid}/cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace")
    except OSError:
        return ""
