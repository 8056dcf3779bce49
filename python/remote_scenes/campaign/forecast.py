"""What a campaign will cost: hours, bytes and errors, from a few samples that are made and thrown away; and whether the programs take the ends of
all ranges."""
from __future__ import annotations

import os
import tempfile
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Sequence

from ..errors import InputError, Interrupted, ProgramError
from ..programs import run_program
from .campaign import Campaign
from .drawing import Drawer, Drawn
from .exports import images
from .sample import Maker, refusal
from .shared import UNUSED, with_files, write_json
from .figures import statistics
from .text import CampaignError, Refused

PILOTS = 2
TRIED = 3
"""Samples of which one is to be taken by the programs before the others are made."""


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
        size = sum(p.stat().st_size for n in numbers for p in _made(maker, n).iterdir())
        seconds = (sum(os.times()[:4]) - begun) / len(numbers)
        found = statistics(folder)
        labels = sum(len(image.labels) for image in images(folder)) / len(numbers)
    errors = {band: value["median"] for band, value in found["relative_standard_error"].items()}
    return Forecast(campaign.samples, len(numbers), seconds * campaign.samples / 3600, size * campaign.samples // len(numbers), labels, errors)


def _made(maker: Maker, sample: int) -> Path:
    """The folder of a sample, or of one of the next ones where it is refused. CampaignError or ProgramError: what is said of it where all are."""
    said = list[Exception]()
    for number in range(sample, min(sample + TRIED, maker.campaign.samples)):
        try:
            return maker.make(number)
        except Interrupted:
            raise
        except (CampaignError, ProgramError) as problem:
            said.append(problem)
    raise said[0]


def check_ends(campaign: Campaign, version: str) -> None:
    """Has the programs check the texts of the first sample that they take, with every variable at both ends of its range, and what refers to it.
    CampaignError: a distribution leaves the range of a key, with the line of the distribution and what the program says."""
    with tempfile.TemporaryDirectory(prefix="campaign-") as name:
        folder = Path(name)
        _check_template(campaign)
        first, drawn = _first_drawn(campaign, folder, version)
        # Parts that do not come from the two texts: the prepared scenes, and truth that labels want.
        parts = {key: drawn.simulation[key] for key in ("scenes",)}
        scene, simulation = campaign.texts(campaign.draw(first))
        for key, rule in campaign.variables.rules.items():
            for value in _ends(rule.ends):
                try:
                    texts = campaign.texts(campaign.draw(first, {key: value}))
                except CampaignError:
                    continue  # another variable has no range then, which its own sample would say
                for text, before, tree, program in (("scene", scene, texts[0], "scene-prep"), ("simulation", simulation, texts[1], "dirsig-render")):
                    if tree == before:
                        continue
                    whole = tree if text == "scene" else {**parts, **{k: v for k, v in with_files(tree, campaign.simulation_path.parent).items() if k != "scene"}}
                    write_json(whole, folder / "checked.yaml")
                    if said := _refused(program, folder, campaign):
                        raise rule.node.error(f"'{key}' of {value!r}, which this distribution reaches, is refused: {said}", "a narrower distribution")


def _first_drawn(campaign: Campaign, folder: Path, version: str) -> tuple[int, Drawn]:
    """The first of the first samples that can be drawn and that the renderer takes: one may be refused alone. CampaignError: what is said of sample 0
    where all are."""
    drawer, said = Drawer(campaign, folder, version), list[CampaignError]()
    for sample in range(min(TRIED, campaign.samples)):
        try:
            drawn = drawer.draw(sample, folder)
            if not (refused := _refused("dirsig-render", folder, campaign, "simulation.yaml")):
                return sample, drawn
            said.append(CampaignError(f"the first sample is refused: {refused}", file=str(campaign.simulation_path)))
        except CampaignError as problem:
            said.append(problem)
        except Interrupted:
            raise
        except ProgramError as problem:
            said.append(Refused(refusal(sample, problem)))
    raise said[0]


def _check_template(campaign: Campaign) -> None:
    """The scene's text as it stands, so that what is wrong there is said with its own line."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            run_program("scene-prep", [campaign.scene_path, "-q", "-j", "1", *UNUSED])
    except InputError as refused:
        raise CampaignError(refused.message, refused.hint, refused.file or str(campaign.scene_path), refused.line, refused.column) from None


def _ends(values: Sequence[Any]) -> list[Any]:
    """Of numbers the lowest and the highest; else all."""
    if len(values) > 2 and all(isinstance(v, (int, float)) and not isinstance(v, bool) for v in values):
        return [min(values), max(values)]
    return [v for i, v in enumerate(values) if v not in values[:i]]


def _refused(program: str, folder: Path, campaign: Campaign, text: str = "checked.yaml") -> str:
    """What the program says; empty when it takes the text."""
    search = campaign.scene_path.parent.resolve()
    arguments: list[str | Path] = [folder / text, "--path", search, "-q", *UNUSED] if program == "scene-prep" else [folder / text, "--dry-run", "-q"]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            run_program(program, arguments, cwd=folder)
        except InputError as refused:
            return (refused.message or str(refused).splitlines()[0]) + (f" (at {refused.key})" if refused.key else "") + (f", {refused.hint}" if refused.hint else "")
    return ""


__all__ = ["Forecast", "check_ends", "forecast"]
