"""What a dataset holds in figures: images, labels by class, and the errors of the radiance."""
from __future__ import annotations

from pathlib import Path
from typing import Any

from .exports import finished, images
from .labels import rounded


def statistics(folder: Path) -> dict[str, Any]:
    """Counts, and of every band of every sensor the median, the 90th percentile and the largest of the images' median relative standard errors."""
    errors: dict[str, list[float]] = {}
    classes: dict[str, int] = {}
    count, flagged = 0, 0.0
    for image in images(folder):
        count += 1
        flagged += image.about["flagged"]
        for band, value in image.about["median_relative_error"].items():
            if value is not None:
                errors.setdefault(f"{image.about['name']}/{band}", []).append(value)
        for label in image.labels:
            classes[label["class"]] = classes.get(label["class"], 0) + 1
    spread = {}
    for band, values in errors.items():
        values.sort()
        spread[band] = {"median": values[len(values) // 2], "p90": values[int(0.9 * (len(values) - 1))], "largest": values[-1]}
    found: dict[str, Any] = rounded({"samples": len(finished(folder)), "images": count, "labels": dict(sorted(classes.items())),
                                     "mean_share_flagged": flagged / count if count else 0.0, "relative_standard_error": spread})
    return found
