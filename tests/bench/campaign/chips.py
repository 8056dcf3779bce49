#!/usr/bin/env python3
"""chips.py FOLDER [--samples 10000] [--first N] [--paths 8] [--workers 1] [--kills 0] [--seconds N]
Makes chips of 64 x 64 pixels in four bands of vehicles on a parking lot (sample_scenes/campaigns) and prints what one takes of the processor, its
errors, and the memory of a worker; the same command goes on where it was ended. --kills: so many workers are killed at random moments. --first: the
first so many of the samples alone. --seconds: no longer than that.
chips.py --compare FOLDER OTHER
Compares two datasets by the hashes of all files of all samples that both have.

Needs the package on PYTHONPATH and the programs (REMOTE_SCENES_BIN), and numpy, xarray and PyYAML. FOLDER/log.tsv keeps what every sample took."""
import argparse
import json
import re
import statistics
import sys
import time
from pathlib import Path

from kit import Killer, digest, parking_lot
from remote_scenes import campaign
from remote_scenes.campaign.engine import prepare_folder, run_samples
from remote_scenes.campaign.exports import finished

SETTLED = 500  # samples after which memory is to be flat


class Ended(Exception):
    """The time is over."""


def make(folder, samples, first, paths, workers, kills, seconds):
    text = campaign.read_campaign(parking_lot(folder / "texts", samples, paths))
    data, begun = folder / "data", time.monotonic()
    version = prepare_folder(text, data)
    killer = Killer(len(finished(data)), first, kills)
    killer.start()
    with open(folder / "log.tsv", "a", encoding="utf-8") as log:
        log.write(f"# {workers} workers, {len(finished(data))} samples were there\n")

        def tell(line):
            if match := re.fullmatch(r"sample (\d+): .* in ([\d.]+) s of the processor, ([\d.]+) MiB in worker (\d+)", line):
                log.write("\t".join(match.groups()) + "\n")
                killer.made += 1
            else:
                log.write(f"# {line}\n")
            log.flush()
            if seconds and time.monotonic() - begun > seconds:
                raise Ended

        try:
            run_samples(text, data, range(first), workers, version, tell)
        except Ended:
            print(f"ended after {seconds} s")
    with open(folder / "log.tsv", "a", encoding="utf-8") as log:
        log.write(f"# {killer.killed} workers were killed\n")


def report(folder, samples):
    rows, kills = [], 0
    for line in (folder / "log.tsv").read_text().splitlines():
        if line.startswith("#"):
            kills += int(line.split()[1]) if line.endswith("workers were killed") else 0
        else:
            sample, cpu, memory, worker = line.split("\t")
            rows.append((int(sample), float(cpu), float(memory), int(worker)))
    there = finished(folder / "data")
    cpu = [r[1] for r in rows]
    errors = {}
    for number in there:
        record = json.loads((folder / f"data/samples/{number:06d}/sample.json").read_text())
        for band, value in record["images"][0]["median_relative_error"].items():
            errors.setdefault(band, []).append(value)
    print(f"{len(there)} of {samples} chips, {len(cpu)} with their cost: {statistics.mean(cpu):.3f} s of the processor each (median {statistics.median(cpu):.3f}, "
          f"largest {max(cpu):.3f}); {kills} workers killed")
    print("median relative standard error, median of all chips: " + ", ".join(f"{b} {100 * statistics.median(v):.2f} %" for b, v in errors.items()))
    for worker in dict.fromkeys(r[3] for r in rows):
        memory = [r[2] for r in rows if r[3] == worker]
        if len(memory) > SETTLED:
            early, late = statistics.median(memory[SETTLED - 20:SETTLED + 20]), statistics.median(memory[-40:])
            print(f"worker {worker}: {len(memory)} chips; {early:.1f} MiB about the {SETTLED}th, {late:.1f} MiB at the end: {100 * (late / early - 1):+.2f} %")


def compare(first, second):
    both = sorted(set(finished(first / "data")) & set(finished(second / "data")))
    other = [n for n in both if digest(first / f"data/samples/{n:06d}") != digest(second / f"data/samples/{n:06d}")]
    print(f"{len(both)} samples in both, {len(both) - len(other)} with the same bytes" + (f"; the first other one is {other[0]}" if other else ""))
    return 1 if other or not both else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, nargs="?")
    parser.add_argument("--samples", type=int, default=10_000)
    parser.add_argument("--first", type=int)
    parser.add_argument("--paths", type=int, default=8)
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--kills", type=int, default=0)
    parser.add_argument("--seconds", type=float)
    parser.add_argument("--compare", type=Path, nargs=2, metavar=("FOLDER", "OTHER"))
    options = parser.parse_args()
    if options.compare:
        return compare(*options.compare)
    if not options.folder or options.workers < 1:
        parser.error("a FOLDER is wanted, and at least one worker")
    make(options.folder, options.samples, options.first or options.samples, options.paths, options.workers, options.kills, options.seconds)
    report(options.folder, options.samples)
    return 0


if __name__ == "__main__":
    sys.exit(main())
