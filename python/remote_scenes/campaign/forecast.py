"""What a campaign will cost: hours, bytes and errors, from a few samples that are made and thrown away; and whether the programs take the ends of
all ranges."""
from __future__ import annotations

import copy
import os
import tempfile
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Sequence

from ..errors import InputError
from ..programs import run_program
from .campaign import Campaign
from .exports import images
from .places import put
from .sample import Maker
from .shared import with_files, write_tree
from .figures import statistics
from .text import CampaignError

PILOTS = 2


@dataclass(frozen=True)
class Forecast:
    """Of a whole campaign. cpu_hours: of one processor; bytes: of the samples; errors: by sensor and band, relative, median of the pilots."""

    samples: int
    pilots: int
    cpu_hours: float
    bytes: int
    labels: float
    errors: dict[str, float]

    def __str__(self) -> str:
        errors = ", ".join(f"{band} {100 * value:.2g} %" for band, value in self.errors.items())
        return (f"{self.samples} samples: {self.cpu_hours:.3g} h of one processor, {self.bytes / 1e6:.4g} MB, {self.labels:.3g} labels a sample\n"
                f"median relative standard error: {errors or 'not known'}\n(from {self.pilots} samples that were made and thrown away)")


def forecast(campaign: Campaign, version: str, pilots: int = PILOTS) -> Forecast:
    """Makes the first and the middle sample (pilots: how many, evenly) in a folder of its own, which goes again."""
    numbers = sorted({i * campaign.samples // pilots for i in range(pilots)})
    with tempfile.TemporaryDirectory(prefix="campaign-") as name:
        folder = Path(name)
        maker = Maker(campaign, folder, version)
        begun = sum(os.times()[:4])
        size = sum(p.stat().st_size for n in numbers for p in maker.make(n).iterdir())
        seconds = (sum(os.times()[:4]) - begun) / len(numbers)
        found = statistics(folder)
        labels = sum(len(image.labels) for image in images(folder)) / len(numbers)
    errors = {band: value["median"] for band, value in found["relative_standard_error"].items()}
    return Forecast(campaign.samples, len(numbers), seconds * campaign.samples / 3600, size * campaign.samples // len(numbers), labels, errors)


def check_ends(campaign: Campaign, version: str) -> None:
    """Has the programs check the first sample's texts with every variable at both ends of its range. CampaignError: a distribution leaves the range
    of its key, with the line of the distribution and what the program says."""
    with tempfile.TemporaryDirectory(prefix="campaign-") as name:
        folder = Path(name)
        drawn = Maker(campaign, folder, version).draw(0, folder)
        simulation = {**with_files(drawn.simulation, campaign.simulation_path.parent)}
        for key, rule in campaign.variables.rules.items():
            text, dot, place = key.partition(".")
            for value in _ends(rule.ends) if dot else ():
                tree = copy.deepcopy(drawn.scene if text == "scene" else simulation)
                put(tree, place, value)
                write_tree(tree, folder / "checked.yaml")
                if said := _refused(text, folder, campaign):
                    raise rule.node.error(f"'{key}' of {value!r}, which this distribution reaches, is refused: {said}", "a narrower distribution")


def _ends(values: Sequence[Any]) -> list[Any]:
    """Of numbers the lowest and the highest; else all."""
    if len(values) > 2 and all(isinstance(v, (int, float)) and not isinstance(v, bool) for v in values):
        return [min(values), max(values)]
    return [v for i, v in enumerate(values) if v not in values[:i]]


def _refused(text: str, folder: Path, campaign: Campaign) -> str:
    """What the program says; empty when it takes the text."""
    search = campaign.scene_path.parent.resolve()
    arguments = ["checked.yaml", "--path", search, "-q", "--mute", "SP103", "--mute", "SP403"] if text == "scene" else ["checked.yaml", "--dry-run", "-q"]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            run_program("scene-prep" if text == "scene" else "dirsig-render", arguments, cwd=folder)
        except InputError as refused:
            return refused.message or str(refused).splitlines()[0]
    return ""


__all__ = ["Forecast", "check_ends", "forecast"]
