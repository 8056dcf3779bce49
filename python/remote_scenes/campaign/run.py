"""Runs of a campaign: all samples of a shard, then the lists of images and labels when everything is there."""
from __future__ import annotations

import os
import tempfile
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

from ..errors import ProgramError
from ..programs import version as program_version
from ..tree import FileName
from .campaign import Campaign, read_campaign
from .cog import check_cog, write_cog
from .croissant import write_croissant
from .engine import Tally, Tell, of_shard, prepare_folder, run_samples
from .exports import finished, images
from .forecast import check_ends
from .kitti import write_kitti
from .label_files import write_coco, write_dota, write_geojson, write_yolo, write_yolo_obb
from .panoptic import write_panoptic
from .settings import FORMATS
from .sheet import write_sheet
from .stac import write_stac
from .text import CampaignError, Refused
from .webdataset import write_webdataset
from .zarr_store import write_zarr

PREVIEWED = 12
NAMED = 10
"""Refused samples that a message names."""
_WRITERS: dict[str, Callable[[Campaign, Path], None]] = {
    "coco": write_coco, "panoptic": write_panoptic, "dota": write_dota, "yolo": write_yolo, "yolo_obb": write_yolo_obb, "kitti": write_kitti, "geojson": write_geojson,
    "webdataset": write_webdataset, "zarr": write_zarr, "cog": write_cog,
    "stac": write_stac}


@dataclass(frozen=True)
class Outcome:
    """What a run has left. complete: all samples of the campaign are there, and the lists are written."""

    folder: Path
    tally: Tally
    complete: bool


def run(campaign: FileName | Campaign, folder: FileName, *, workers: int | None = None, shard: tuple[int, int] = (1, 1),
        tell: Tell | None = None, executor: Executor | None = None) -> Outcome:
    """Makes the samples of a campaign that are not there yet, and writes its lists when all are. workers: processes, one per core unless given,
    0 = within this process; shard: (i, n), every n-th sample from the i-th on; executor: makes samples in place of workers, where the same files are
    seen (concurrent.futures; of Dask `Client.get_executor()`). CampaignError: something is refused; what is finished stays. Samples that are refused
    alone are named once all others are made and in the lists."""
    campaign = campaign if isinstance(campaign, Campaign) else read_campaign(campaign)
    folder = Path(folder)
    if not 1 <= shard[0] <= shard[1]:
        raise ValueError(f"shard {shard[0]}/{shard[1]}: the first is 1/{shard[1]}, the last {shard[1]}/{shard[1]}")
    if "cog" in campaign.formats:
        check_cog(campaign)
    version = prepare_folder(campaign, folder)
    speak = tell or (lambda _: None)
    if not finished(folder):
        check_ends(campaign, version)
    try:
        tally = run_samples(campaign, folder, of_shard(campaign.samples, shard), os.cpu_count() or 1 if workers is None else workers, version, speak,
                            executor)
        there = len(finished(folder))
        complete = there == campaign.samples
        # The lists hold what there is once nothing more will come.
        if there and there + len(tally.refused) == campaign.samples:
            _write_lists(campaign, folder, version)
    except OSError as problem:
        raise CampaignError(f"the dataset cannot be written: {problem}", "room, and the right to write; the same command goes on", str(folder)) from None
    _tell_refused(tally)
    return Outcome(folder, tally, complete)


def _tell_refused(tally: Tally) -> None:
    """Refused: some samples were, with the first message and the numbers."""
    if count := len(tally.refused):
        samples = tally.made + tally.there + count
        numbers = ", ".join(map(str, sorted(tally.refused)[:NAMED])) + (" ..." if count > NAMED else "")
        raise Refused(f"{tally.first_refusal()} ({count} of {samples} samples {'was' if count == 1 else 'were'} refused: {numbers}; the others are there)")


def _write_lists(campaign: Campaign, folder: Path, version: str) -> None:
    for name in FORMATS:  # cards after what they name
        if name in campaign.formats and name in _WRITERS:
            _WRITERS[name](campaign, folder)
    if "croissant" in campaign.formats:
        write_croissant(campaign, folder, version)


def preview(campaign: FileName | Campaign, path: FileName, *, workers: int | None = None) -> Path:
    """Twelve samples, evenly from the whole campaign, with their oriented boxes on one sheet (PNG); they are thrown away."""
    campaign = campaign if isinstance(campaign, Campaign) else read_campaign(campaign)
    count = min(PREVIEWED, campaign.samples)
    with tempfile.TemporaryDirectory(prefix="campaign-") as name:
        folder = Path(name)
        version = program_version()
        (folder / "samples").mkdir()
        check_ends(campaign, version)
        tally = run_samples(campaign, folder, [i * campaign.samples // count for i in range(count)], os.cpu_count() or 1 if workers is None else workers,
                            version, lambda _: None)
        if tally.made:
            write_sheet(folder, list(images(folder)), Path(path))
        _tell_refused(tally)
    return Path(path)


__all__ = ["Outcome", "ProgramError", "preview", "run"]
