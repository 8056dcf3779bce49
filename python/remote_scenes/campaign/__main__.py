"""python -m remote_scenes.campaign CAMPAIGN.yaml -o FOLDER: makes a dataset, or goes on with it."""
from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path

from ..errors import ProgramError, ProgramMissing
from ..programs import version as program_version
from .campaign import read_campaign
from .drawing import Drawer
from .forecast import check_ends, forecast
from .launch import leave_launcher, shard_of_rank
from .run import preview, run
from .shared import write_tree
from .slurm import slurm_script
from .text import CampaignError


def _arguments() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m remote_scenes.campaign", description=__doc__,
                                     epilog="exit code: 0 done, 1 something was refused (samples that are refused alone are named when the others are made), 2 wrong usage, "
                                     "130 stopped")
    parser.add_argument("campaign", help="the campaign's text (docs/guide/campaigns.md)")
    parser.add_argument("-o", "--output", metavar="FOLDER", help="the dataset; what is finished there stays, so that the same command goes on")
    parser.add_argument("--workers", type=_count, metavar="N", help="worker processes; one per core unless given; the samples do not depend on it")
    parser.add_argument("--shard", type=_shard, default=(1, 1), metavar="I/N", help="every N-th sample from the I-th on, from 1; `rank`: of the ranks that mpirun or srun has started, "
                        "this one's")
    parser.add_argument("--dry-run", action="store_true", help="check the ends of all distributions and forecast hours, bytes and errors from two samples")
    parser.add_argument("--preview", metavar="FILE.png", help="twelve samples with their labels on one sheet")
    parser.add_argument("--texts", type=_count, metavar="SAMPLE", help="write the texts and prepared scenes of one sample into the folder of -o")
    parser.add_argument("--slurm", type=_count, metavar="N", help="print a script for sbatch: an array of N shards of the folder of -o")
    parser.add_argument("-q", "--quiet", action="store_true", help="no progress")
    return parser


def _count(text: str) -> int:
    if not re.fullmatch(r"\d{1,7}", text):
        raise argparse.ArgumentTypeError(f"'{text}' is no whole number")
    return int(text)


def _shard(text: str) -> tuple[int, int]:
    if text == "rank":
        try:
            shard = shard_of_rank()
            leave_launcher()
            return shard
        except CampaignError as missing:
            raise argparse.ArgumentTypeError(missing.message + "; " + missing.hint) from None
    match = re.fullmatch(r"(\d{1,7})/(\d{1,7})", text)
    if not match or not 1 <= int(match[1]) <= int(match[2]):
        raise argparse.ArgumentTypeError(f"'{text}' is no shard; the first of four is 1/4, the last 4/4")
    return int(match[1]), int(match[2])


def main(arguments: list[str] | None = None) -> int:
    """0 done, 1 something was refused, 2 wrong usage."""
    parser = _arguments()
    options = parser.parse_args(arguments)
    if not options.output and not options.dry_run and not options.preview:
        parser.error("-o FOLDER is missing")
    try:
        return _run(options)
    except (CampaignError, ProgramError, ProgramMissing) as refused:
        print(str(refused) if isinstance(refused, CampaignError) else f"error: {refused}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("stopped; the same command goes on", file=sys.stderr)
        return 130


def _run(options: argparse.Namespace) -> int:
    campaign = read_campaign(options.campaign)
    folder = Path(options.output or ".")
    if options.dry_run:
        version = program_version()
        check_ends(campaign, version)
        print(forecast(campaign, version))
    if options.preview:
        print(f"wrote {preview(campaign, options.preview, workers=options.workers)}")
    if options.texts is not None:
        if options.texts >= campaign.samples:
            raise CampaignError(f"there is no sample {options.texts}", f"0 to {campaign.samples - 1}", str(campaign.path))
        folder.mkdir(parents=True, exist_ok=True)
        Drawer(campaign, folder, program_version()).draw(options.texts, folder, write_tree)
        print(f"wrote {folder / 'simulation.yaml'}")
    elif options.slurm:
        print(slurm_script(campaign, folder, options.slurm, options.workers or 1), end="")
    elif options.output and not options.dry_run and not options.preview:
        outcome = run(campaign, folder, workers=options.workers, shard=options.shard, tell=None if options.quiet else _progress)
        tally = outcome.tally
        print(f"{tally.made} samples made, {tally.there} were there; {tally.cpu_s:.4g} s of the processor" if tally.made else f"{tally.there} samples were there")
        if len(tally.rss_kb) > 1:
            print(f"memory of a worker: {tally.rss_kb[0] / 1024:.0f} MiB after its first sample, at most {max(tally.rss_kb) / 1024:.0f} MiB")
        print(f"wrote {folder}" if outcome.complete else f"{folder} is not complete: other shards are to be made, then this command once more without --shard")
    return 0


def _progress(line: str) -> None:
    print(line, file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main())
