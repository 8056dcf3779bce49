"""One sample: its texts are drawn, prepared and rendered, its objects labelled, and all of it put into its folder at once."""
from __future__ import annotations

import contextlib
import os
import shutil
import socket
import warnings
from dataclasses import asdict
from pathlib import Path
from typing import Any, Sequence

import numpy as np
import xarray as xr

from ..chips import _picture, _write_png
from ..programs import run_program
from ..traced import TracedScene
from .camera import Camera, camera_of, name_of
from .campaign import Campaign, as_json
from .drawing import Drawer, Drawn
from .earth import Frame
from .flow import depth, flow, middles, write_flo, write_pfm
from .labels import Sight, degrees, label_image, rounded
from .pairs import LATER, changes, write_change
from .panoptic import write_segments
from .rendered import rendered
from .text import CampaignError

_KEPT = {"image": ("",), "error": ("_error",), "quality": ("_quality",), "truth": ("_truth",), "classes": ("_tag", "_material"),
         "depth": (), "flow": ()}


class Maker:
    """Makes samples of a campaign in a folder. A sample's bytes depend on the campaign, its seed and the sample's number alone."""

    def __init__(self, campaign: Campaign, folder: Path, version: str) -> None:
        """version: of the programs."""
        self.campaign, self.folder, self.version = campaign, folder, version
        self.drawer = Drawer(campaign, folder, version)

    def path(self, sample: int) -> Path:
        """The folder of a sample; it is there when the sample is finished."""
        return self.folder / "samples" / f"{sample:06d}"

    def make(self, sample: int) -> Path:
        """Makes a sample unless it is there. CampaignError, InputError or OSError: it cannot be made, and leaves nothing."""
        target = self.path(sample)
        if target.is_dir():
            return target
        new = target.with_name(f".{target.name}.{socket.gethostname()}.{os.getpid()}")
        shutil.rmtree(new, ignore_errors=True)
        try:
            (new / "work").mkdir(parents=True)
            self._make(sample, new)
            shutil.rmtree(new / "work")
            try:
                os.rename(new, target)
            except OSError:
                if not target.is_dir():  # else another worker was faster, with the same bytes
                    raise
        finally:
            shutil.rmtree(new, ignore_errors=True)
        return target

    def _make(self, sample: int, new: Path) -> None:
        work = new / "work"
        drawn = self.drawer.draw(sample, work)
        images, messages, datasets = self._pictures(drawn, work, new, "")
        record = {"campaign": self.campaign.digest, "version": self.version, "seed": self.campaign.seed, "sample": sample,
                  "values": drawn.draw.known, "objects": [asdict(p) for p in drawn.placed]}
        if self.campaign.pair:
            (work / "later").mkdir()
            later = self.drawer.draw_later(drawn, work / "later")
            more, said, others = self._pictures(later, work / "later", new, LATER)
            change = changes(drawn.placed, later.placed)
            for image in [*images, *more]:
                image["labels"] = [{**label, "change": change[f"{label['class']}.{label['object']}"]} for label in image["labels"]]
            for name in datasets:
                if "tag" in datasets[name] and "tag" in others[name]:
                    write_change(datasets[name], others[name], change, new / f"{name}_change.png")
            images, messages = [*images, *more], sorted({*messages, *said})
            record |= {"values_later": later.draw.known, "objects_later": [asdict(p) for p in later.placed]}
        (new / "sample.json").write_text(as_json({**record, "images": images, "messages": messages}), encoding="utf-8")

    def _pictures(self, drawn: Drawn, work: Path, new: Path, ending: str) -> tuple[list[dict[str, Any]], list[str], dict[str, xr.Dataset]]:
        """Renders, and puts what is kept of it into `new`; returns the images' records, the messages, and the images. ending: of the images' names."""
        messages = _render(work, [work, self.folder, self.drawer.search])
        images, datasets = [], {}
        for name, dataset in rendered(work / "out"):
            picture, own = self.campaign.picture, name + ending
            try:
                pixels = _picture(dataset, picture.bands, picture.stretch, picture.range)
            except ValueError as wrong:
                raise CampaignError(f"picture of '{name}': {wrong}", file=str(self.campaign.path)) from None
            _write_png(new / f"{own}.png", pixels)
            pair = {"moment": int(bool(ending))} if self.campaign.pair else {}
            images.append({**rounded(_about(own, dataset)), **pair, **self._seen(name, own, dataset, drawn, new)})
            datasets[name] = dataset
            endings = [e for part in self.campaign.keep for e in _KEPT[part]]
            for e, kind in ((e, kind) for e in endings for kind in (".img", ".img.hdr", ".tif")):
                if (work / "out" / f"{name}{e}{kind}").exists():
                    os.replace(work / "out" / f"{name}{e}{kind}", new / f"{own}{e}{kind}")
        _keep_pulses(drawn, work / "out", new, ending)
        return images, messages, datasets

    def _seen(self, name: str, own: str, dataset: xr.Dataset, drawn: Drawn, new: Path) -> dict[str, Any]:
        """What an image shows: its labels, and where its corners are on the Earth. Writes what is made by rays or of the truth into `new`, named by
        `own`."""
        camera, frame, settings = _camera(name, drawn), _frame(drawn.scene), self.campaign.labels
        time = camera.time_s if camera else 0.0
        with contextlib.ExitStack() as stack:
            backdrop = stack.enter_context(self.drawer.opened(drawn.backdrop, time))
            things = stack.enter_context(TracedScene(drawn.things, time)) if drawn.things else None
            seen: dict[str, Any] = {"corners_lon_lat": _corners(camera, backdrop, frame)} if camera and frame else {}
            if (number := self.campaign.frames.frame_of(name)) is not None:
                seen["frame"] = number
            if camera:
                seen |= {"camera": rounded(camera.record())} if camera.record() else {}
                self._by_rays(name, own, camera, drawn, things, backdrop, new)
            if "panoptic" in self.campaign.formats and "material" in dataset and "tag" in dataset:
                seen["segments"] = write_segments(dataset, drawn.placed, self.campaign.classes, self.campaign.stuff, new / f"{own}_panoptic.png")
            if not things or "tag" not in dataset:
                return {**seen, "labels": []}
            items = {p.place: drawn.items(p.place) for p in drawn.placed}
            sight = Sight(camera, things, backdrop, settings.rays) if camera else None
            labels = label_image(dataset, drawn.placed, items, self.campaign.classes, sight, frame, settings.min_pixels, settings.segmentation)
        return {**seen, "labels": labels}

    def _by_rays(self, name: str, own: str, camera: Camera, drawn: Drawn, things: TracedScene | None, backdrop: TracedScene, new: Path) -> None:
        """Depth, and the flow to the next frame, where they are to be kept."""
        later = _camera(self.campaign.frames.next_of(name) or "", drawn) if "flow" in self.campaign.keep else None
        if later or "depth" in self.campaign.keep:
            places, tag, distance = middles(camera, things, backdrop)
            if "depth" in self.campaign.keep:
                write_pfm(new / f"{own}_depth.pfm", depth(camera, places, distance))
            if later:
                write_flo(new / f"{own}_flow.flo", flow(camera, later, places, tag, things.tags if things else (), drawn.placed))


def _keep_pulses(drawn: Drawn, out: Path, new: Path, ending: str) -> None:
    """What laser radars have made: responses, and the folder of what detectors make of them. ending: of the names of what is kept."""
    for name in (name_of(s) for s in drawn.simulation["sensors"] if s.get("kind") == "lidar"):
        for made, kept in ((f"{name}_response.h5", f"{name}{ending}_response.h5"), (name, f"{name}{ending}")):
            if (out / made).exists():
                os.replace(out / made, new / kept)


def _camera(name: str, drawn: Drawn) -> Camera | None:
    """The geometry of the sensor whose image has this name."""
    return camera_of(next((s for s in drawn.simulation["sensors"] if name_of(s) == name), {}))


def _frame(scene: dict[str, Any]) -> Frame | None:
    origin = scene.get("origin")
    return Frame(float(origin["latitude_deg"]), float(origin["longitude_deg"]), float(origin.get("height_m", 0))) if origin else None


def _corners(camera: Camera, scene: TracedScene, frame: Frame) -> list[list[str]] | None:
    """Longitude and latitude of what the picture's corners show, from the lower left one against the clock; None where one shows nothing."""
    w, h = float(camera.columns), float(camera.rows)
    hits = scene.trace(*camera.rays(np.array([0, w, w, 0]), np.array([h, h, 0, 0])))
    if not hits.hit.all():
        return None
    return [degrees(frame, place) for place in hits.position]


def _render(work: Path, folders: Sequence[Path]) -> list[str]:
    """Renders within the folder, by names that are the same for every sample: they stand in the images' headers. Returns what was warned of, without
    the names of folders, which are not a sample's own."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        run_program("dirsig-render", ["simulation.yaml", "-o", "out", "-j", "1", "-q"], cwd=work)
    said = {str(w.message) for w in caught}
    for name in [form + os.sep for folder in folders for form in (str(folder), os.path.abspath(folder))]:
        said = {message.replace(name, "") for message in said}
    return sorted(said)


def _about(name: str, dataset: xr.Dataset) -> dict[str, Any]:
    """What a list of images wants to know: size, place on a map, date, and the statistics of the errors."""
    quantity = str(next(iter(dataset.data_vars)))
    values, errors = dataset[quantity].values.astype(float), dataset["standard_error"].values.astype(float)
    bands = [str(b) for b in dataset["band"].values]
    about: dict[str, Any] = {"name": name, "width": dataset.sizes["x"], "height": dataset.sizes["y"], "bands": bands, "quantity": quantity,
                             "unit": dataset[quantity].attrs.get("units", "1")}
    if "wavelength_um" in dataset.coords:
        about["wavelength_um"] = dataset["wavelength_um"].values.tolist()
    if "acquisition_time" in dataset.attrs:
        about["time"] = dataset.attrs["acquisition_time"]
    relative = errors / np.where(values > 0, values, np.nan)
    about["median_relative_error"] = dict(zip(bands, (_median(r) for r in relative)))
    about["flagged"] = float((dataset["quality"].values != 0).mean())
    return about


def _median(values: Any) -> float:
    known = values[~np.isnan(values)]
    return float(np.partition(known, len(known) // 2)[len(known) // 2]) if len(known) else float("nan")


def refusal(sample: int, problem: Exception) -> str:
    """One message of what stopped a sample."""
    if isinstance(problem, CampaignError):
        return str(problem)
    if isinstance(problem, OSError):
        return f"error: sample {sample} cannot be written: {problem}"
    return f"error: sample {sample} was refused: {str(problem).splitlines()[0]}; `--texts {sample}` writes its texts"
