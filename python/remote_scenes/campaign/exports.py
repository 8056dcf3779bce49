"""What lists of images and labels are made of: the records of finished samples, in the order of their numbers, one at a time."""
from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Iterable, Iterator


PARTS = ("error", "quality", "truth", "tag", "material", "depth", "flow", "panoptic", "change", "polarisation")
"""What files beside an image add to its name."""


@dataclass(frozen=True)
class Image:
    """An image of a sample. key: its name in the dataset, as 000012_chip; file: its picture, from the dataset's folder."""

    key: str
    file: str
    sample: int
    about: dict[str, Any]
    values: dict[str, Any]

    @property
    def labels(self) -> list[dict[str, Any]]:
        """Its labels (docs/guide/campaigns.md)."""
        found: list[dict[str, Any]] = self.about["labels"]
        return found

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        return int(self.about["width"]), int(self.about["height"])


def own_files(folder: Path, image: Image) -> list[tuple[str, Path]]:
    """The files of an image in its sample, by name, each with what it adds to the image's name: empty, or error, quality, panoptic ..."""
    name, found = str(image.about["name"]), []
    for file in sorted((folder / image.file).parent.iterdir()):
        stem = file.name.partition(".")[0]
        part = stem[len(name):].lstrip("_") if stem.startswith(name) else "-"
        if stem == name or (stem == f"{name}_{part}" and part in PARTS):
            found.append((part, file))
    return found


def joined(entries: Iterable[dict[str, Any]]) -> Iterator[str]:
    """Entries of a JSON list, a line each."""
    for i, entry in enumerate(entries):
        yield (",\n" if i else "\n") + json.dumps(entry)


def finished(folder: Path) -> list[int]:
    """Numbers of the samples that are there."""
    return sorted(int(p.name) for p in (folder / "samples").iterdir() if p.name.isdecimal())


def record_of(folder: Path, sample: int) -> dict[str, Any]:
    """What a sample is (sample.json)."""
    record: dict[str, Any] = json.loads((folder / "samples" / f"{sample:06d}" / "sample.json").read_text(encoding="utf-8"))
    return record


def images(folder: Path) -> Iterator[Image]:
    """All images, one in memory at a time."""
    for sample in finished(folder):
        record = record_of(folder, sample)
        for about in record["images"]:
            yield Image(f"{sample:06d}_{about['name']}", f"samples/{sample:06d}/{about['name']}.png", sample, about, record["values"])
