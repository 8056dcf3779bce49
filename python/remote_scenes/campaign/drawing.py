"""One sample before it is rendered: its values, its objects, and what the programs are given."""
from __future__ import annotations

import contextlib
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Iterator

from ..traced import TracedScene
from .campaign import Campaign
from .pairs import place_later
from .placement import Bounds, Ground, Placed, place_all
from .shared import Shared, prepare_tree, with_files, write_json
from .text import CampaignError
from .things import backdrop_shapes, ground_scene, item_scene, placed_scene, whole_scene
from .variables import Draw

_TRUTH = ("tag", "tag_fraction", "instance", "range")
_OF_SUN = ("incidence", "sun_visibility")
HIGHEST_M = 1e5
"""Where rays begin that look for what is below an object."""
Write = Callable[[Any, Path], None]


@dataclass(frozen=True)
class Drawn:
    """A sample before it is rendered: its draws and texts, the prepared scenes, and its objects."""

    draw: Draw
    scene: dict[str, Any]
    simulation: dict[str, Any]
    backdrop: Path
    """The scene without objects, or its shape alone."""
    things: Path | None
    """Of the objects alone, or with the scene around them."""
    placed: list[Placed]
    items: Callable[[str], TracedScene]
    """What is placed, by the names that are placed, alone where it is defined."""


class Drawer:
    """Draws samples of a campaign, and prepares their scenes. What returns is prepared once, in `shared`:

    - A scene whose text takes few values, as a whole; the objects of a sample are prepared beside it.
    - Else its shape, where only materials vary; the scene is prepared with the objects, for each sample.
    - Else nothing but what is placed.
    """

    def __init__(self, campaign: Campaign, folder: Path, version: str) -> None:
        """folder: of the dataset; version: of the programs."""
        self.campaign = campaign
        self.search = campaign.scene_path.parent.resolve()
        self._scenes_return, self._shapes_return = campaign.scenes_return, campaign.shapes_return
        self._shared = Shared(folder / "shared", self.search, version)

    def draw(self, sample: int, folder: Path, write: Write = write_json) -> Drawn:
        """Draws a sample and writes simulation.yaml (and what is prepared for it alone) into a folder, ready to be rendered. write: how the text is
        written."""
        draw = self.campaign.draw(sample)
        return self._prepared(draw, folder, write, lambda bounds, ground: place_all(self.campaign.groups, draw, bounds, ground))

    def draw_later(self, first: Drawn, folder: Path, write: Write = write_json) -> Drawn:
        """The second picture of a pair, as draw does the first."""
        pair = self.campaign.pair
        assert pair is not None
        draw = self.campaign.draw(first.draw.sample, again=pair.again)
        return self._prepared(draw, folder, write, lambda bounds, ground: place_later(self.campaign.groups, draw, bounds, ground, first.placed, pair))

    def _prepared(self, draw: Draw, folder: Path, write: Write, place: Callable[[Callable[[str], Bounds], Ground], list[Placed]]) -> Drawn:
        campaign = self.campaign
        scene, simulation = campaign.texts(draw)
        if self._scenes_return or self._shapes_return:
            backdrop = self._shared.prepare(scene if self._scenes_return else backdrop_shapes(scene))
        else:
            backdrop = folder / "backdrop.h5"
            prepare_tree(scene, backdrop, self.search)
        items, placed = self._items(scene), list[Placed]()
        if campaign.groups:
            with self.opened(backdrop) as below:
                placed = place(lambda name: self._bounds(items, name), lambda on, x, y: _ground(
                    self._shared.open(self._shared.prepare(ground_scene(scene, on))) if on else below, x, y))
        things, beside = None, self._scenes_return or not self._shapes_return
        if placed or not beside:
            things = folder / "things.h5"
            prepare_tree((placed_scene if beside else whole_scene)(scene, placed), things, self.search)
        simulation = with_files(simulation, campaign.simulation_path.parent)
        self._complete(simulation)
        if "scenes" not in simulation:
            simulation.pop("scene", None)
            rendered = (backdrop, things) if beside else (things,)
            simulation = {"scenes": [os.path.abspath(p) for p in rendered if p], **simulation}
        write(simulation, folder / "simulation.yaml")
        return Drawn(draw, scene, simulation, backdrop, things, placed, items)

    def _complete(self, simulation: dict[str, Any]) -> None:
        """The truth that labels need, and the frames of a sequence."""
        if self.campaign.groups:
            more = ("material",) if "panoptic" in self.campaign.formats else ()
            for sensor in simulation["sensors"]:
                if sensor.get("kind") not in ("point", "goniometer", "rami", "lidar"):
                    wanted = [*(sensor.get("truth") or []), *_TRUTH, *(_OF_SUN if simulation.get("sun") else ()), *more]
                    sensor["truth"] = list(dict.fromkeys(wanted))
        simulation["sensors"] = self.campaign.frames.expanded(simulation["sensors"])

    @contextlib.contextmanager
    def opened(self, backdrop: Path, time_s: float = 0.0) -> Iterator[TracedScene]:
        """A backdrop: a shared one stays open, a sample's own is closed."""
        if backdrop.parent == self._shared.folder:
            yield self._shared.open(backdrop, time_s)
        else:
            with TracedScene(backdrop, time_s) as scene:
                yield scene

    def _items(self, scene: dict[str, Any]) -> Callable[[str], TracedScene]:
        """Opens what is placed; each name is looked for one time a sample."""
        known: dict[str, Path] = {}

        def item(place: str) -> TracedScene:
            if place not in known:
                known[place] = self._shared.prepare(item_scene(scene, place))
            return self._shared.open(known[place])

        return item

    def _bounds(self, items: Callable[[str], TracedScene], place: str) -> Bounds:
        low, high = items(place).bounds.tolist()
        if not all(abs(v) < 1e6 for v in (*low, *high)):
            raise CampaignError(f"'{place}' has no end, and cannot be placed as an object", "something with bounds", str(self.campaign.path))
        return (low[0], low[1], low[2]), (high[0], high[1], high[2])


def _ground(scene: TracedScene, x: float, y: float) -> float | None:
    """The height of what is first met from above."""
    top = float(scene.bounds[1, 2])
    hits = scene.trace([x, y, top + 1 if abs(top) < HIGHEST_M else HIGHEST_M], [0, 0, -1])
    # To the micrometre: what is left of the ray's length is no height.
    return round(float(hits.position[2]), 6) + 0.0 if bool(hits.hit) else None


