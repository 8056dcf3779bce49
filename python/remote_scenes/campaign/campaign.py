"""A campaign: its text, the two texts that it varies, and the draws of every sample."""
from __future__ import annotations

import copy
import hashlib
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Mapping

from ..tree import FileName
from .draws import hashed
from .objects import Group, keypoints_of, read_objects
from .pairs import Pair, read_pair
from .places import NoSuchPlace, put
from .sequence import Frames, read_frames
from .settings import Labels, Picture, read_formats, read_keep, read_labels, read_picture
from .text import CampaignError, Node, near, read_text
from .variables import Draw, Variables, read_variables

KEYS = ("campaign", "name", "description", "license", "seed", "samples", "scene", "simulation", "vary", "objects", "picture", "labels", "formats",
        "keep", "sequence", "pair")
MOST_SAMPLES = 10_000_000


@dataclass(frozen=True)
class Campaign:
    """A campaign as its text says. scene, simulation: the two texts as trees, which are never changed."""

    path: Path
    name: str
    description: str
    license: str
    seed: int
    samples: int
    scene: dict[str, Any]
    simulation: dict[str, Any]
    scene_path: Path
    simulation_path: Path
    variables: Variables
    groups: tuple[Group, ...]
    picture: Picture
    labels: Labels
    formats: tuple[str, ...]
    keep: tuple[str, ...]
    digest: str
    """Of the three texts."""
    keypoints: dict[str, list[str]]
    """Names, of the classes that have some."""
    frames: Frames
    pair: Pair | None

    @property
    def classes(self) -> list[str]:
        """Names of the classes, in the order of their numbers from 1."""
        there = list(dict.fromkeys(item.class_name for group in self.groups for item in group.items))
        return [*self.labels.classes, *(c for c in there if c not in self.labels.classes)]

    @property
    def stuff(self) -> dict[str, str]:
        """The class of the ground of every material of the scene's text that has one, in the order of the classes."""
        if self.labels.stuff is None:
            return {name: name for name in self.scene.get("materials", {})}
        return {material: name for name, materials in self.labels.stuff.items() for material in materials}

    @property
    def scenes_return(self) -> bool:
        """Whether samples have scenes in common: nothing that the scene's text gets is continuous."""
        return not any(name.startswith("scene.") and self.variables.continuous(name) for name in self.variables.rules)

    @property
    def shapes_return(self) -> bool:
        """Whether samples have the shapes of their scenes in common: only materials vary continuously, and none that has holes by a map."""
        varied = [name for name in self.variables.rules if name.startswith("scene.") and self.variables.continuous(name)]
        plain = {name for name, m in self.scene.get("materials", {}).items() if not (isinstance(m, dict) and ("map" in m or "maps" in m))}
        return all(name.startswith("scene.materials.") and name.split(".")[2] in plain for name in varied)

    def draw(self, sample: int, forced: Mapping[str, Any] | None = None, again: frozenset[str] | None = None) -> Draw:
        """All variables of a sample; forced: values in place of some draws; again: those that the second picture of a pair draws again."""
        values = self.variables.values(self.seed, sample, self.samples, forced, again)
        return Draw(self.variables, self.seed, sample, self.samples, values, again)

    def texts(self, draw: Draw) -> tuple[dict[str, Any], dict[str, Any]]:
        """The scene's and the simulation's text of a sample, as trees, without objects. CampaignError: a place is not there."""
        trees = {"scene": copy.deepcopy(self.scene), "simulation": copy.deepcopy(self.simulation)}
        trees["simulation"]["seed"] = hashed(self.seed, draw.sample, "render again" if draw.later else "render") % (1 << 31)
        for name, rule in self.variables.rules.items():
            text, dot, place = name.partition(".")
            if dot and text in trees:
                try:
                    put(trees[text], place, copy.deepcopy(draw.known[name]))
                except NoSuchPlace as missing:
                    raise rule.node.error(str(missing.args[0]), str(missing.args[1])) from None
        return trees["scene"], trees["simulation"]


def read_campaign(path: FileName) -> Campaign:
    """Reads a campaign and the two texts that it names, and checks all that needs no program. CampaignError with file and line."""
    root = read_text(path)
    keys = root.map(KEYS, ("campaign", "samples", "scene", "simulation"))
    if keys["campaign"].value != 1:
        raise keys["campaign"].error(f"version {keys['campaign'].value!r} of this grammar is not known", "campaign: 1")
    path = Path(path)
    scene_path, scene = _template(keys["scene"], path.parent, "world")
    simulation_path, simulation = _template(keys["simulation"], path.parent, "sensors")
    variables = read_variables(keys.get("vary"), scene.get("curves") if isinstance(scene.get("curves"), dict) else {})
    for name, rule in variables.rules.items():
        if "." in name and name.partition(".")[0] not in ("scene", "simulation"):
            raise rule.node.error(f"'{name}' is in neither text", "scene.PLACE, simulation.PLACE, or a name without dots")
    groups = read_objects(keys.get("objects"), scene, variables, path.parent)
    if groups and "scenes" in simulation:
        raise keys["objects"].error("a simulation with `scenes` takes no objects", "a simulation with `scene`, whatever it says there")
    digest = hashlib.sha256(b"\0".join(p.read_bytes() for p in (path, scene_path, simulation_path))).hexdigest()
    frames = read_frames(keys.get("sequence"), simulation)
    campaign = Campaign(
        path, keys["name"].text() if "name" in keys else path.stem, keys["description"].text() if "description" in keys else "",
        keys["license"].text() if "license" in keys else "", keys["seed"].integer(0, (1 << 53) - 1) if "seed" in keys else 1,
        keys["samples"].integer(1, MOST_SAMPLES), scene, simulation, scene_path, simulation_path, variables, groups,
        read_picture(keys.get("picture")), read_labels(keys.get("labels")), read_formats(keys.get("formats")), read_keep(keys.get("keep")), digest,
        keypoints_of(groups), frames, read_pair(keys.get("pair"), variables, groups, frames.count))
    campaign.texts(campaign.draw(0))
    _check_products(campaign, keys)
    return campaign


def _check_products(campaign: Campaign, keys: dict[str, Node]) -> None:
    """CampaignError: a product that this campaign cannot have, or a class of the ground of a material that is not there."""
    sensors = [s for s in campaign.simulation["sensors"] or () if isinstance(s, dict)]
    kinds = [s.get("kind") for s in sensors]
    by_laser = any(s.get("kind") == "lidar" or "preset" in s for s in sensors)
    wrong = (("formats", "kitti", campaign.formats, "frame_camera" in kinds, "a frame camera", "a sensor of kind frame_camera"),
             ("formats", "panoptic", campaign.formats, bool(campaign.groups), "objects", "`objects`"),
             ("keep", "flow", campaign.keep, campaign.frames.count > 1, "a sequence", "`sequence: {frames: 2}` or more"),
             ("keep", "depth", campaign.keep, bool({"frame_camera", "orthographic"} & {*kinds}), "a sensor of known geometry", "orthographic or frame_camera"),
             ("keep", "polarisation", campaign.keep, any("stokes" in s or "preset" in s for s in sensors), "Stokes vectors", "a sensor with `stokes: linear`"),
             *(("keep", what, campaign.keep, by_laser, "a laser radar", "a sensor of kind lidar") for what in ("points", "response")))
    for key, name, chosen, there, needed, right in wrong:
        if name in chosen and not there and key in keys:
            raise keys[key].error(f"'{name}' needs {needed}", right)
    for material in campaign.stuff:
        if material not in campaign.scene.get("materials", {}):
            raise keys["labels"].error(f"the scene has no material '{material}'", near(material, campaign.scene.get("materials", {})))


def _template(node: Node, folder: Path, wanted: str) -> tuple[Path, dict[str, Any]]:
    path = folder / node.text()
    if not path.is_file():
        raise node.error(f"{path} is not there")
    tree = read_text(path).plain()
    if wanted not in tree:
        raise node.error(f"{path} has no '{wanted}'", "a scene's text under `scene`, a simulation's under `simulation`")
    return path, tree


def as_json(value: Any) -> str:
    """JSON in one form, for hashes and files that must be the same to the byte."""
    return json.dumps(value, sort_keys=True, ensure_ascii=False, allow_nan=False, separators=(",", ":"))


__all__ = ["Campaign", "CampaignError", "as_json", "read_campaign"]
