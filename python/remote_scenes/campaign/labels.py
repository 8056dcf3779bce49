"""Labels of one image: what its truth says of every placed object, and what geometry adds where the sensor's is known.

By truth: mask, box, spectrum, range, incidence, share in shadow, temperature. By geometry (maps and frame cameras): oriented and 3-D box,
occlusion, truncation, GSD. Keys are described in docs/guide/campaigns.md.
"""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Sequence

import numpy as np
import numpy.typing as npt
import xarray as xr

from ..chips import _polygons, _run_lengths
from ..traced import TracedScene
from .boxes import along, corners_of, smallest
from .camera import Camera
from .earth import Frame
from .keypoints import keypoints
from .placement import Placed
from .silhouettes import Pose, Silhouette, box_corners, silhouette

DIGITS = 7
"""Significant digits of numbers in labels."""


@dataclass(frozen=True)
class Sight:
    """What is needed to look at objects by rays: the sensor's geometry, the objects of the sample, and what stands around them."""

    camera: Camera
    things: TracedScene
    backdrop: TracedScene
    rays: int


def label_image(dataset: xr.Dataset, placed: Sequence[Placed], items: dict[str, TracedScene], classes: Sequence[str], sight: Sight | None,
                frame: Frame | None, min_pixels: int, segmentation: str) -> list[dict[str, Any]]:
    """The labels of all objects of which at least min_pixels pixels are seen, in the order in which they were placed. items: each object's own
    prepared scene by the name that is placed. frame: of a scene with an origin."""
    names = dataset["tag"].attrs["class_names"]
    tag = dataset["tag"].values
    out = []
    for one in placed:
        mask = tag == names.index(one.tag) if one.tag in names else np.zeros(tag.shape, bool)
        if int(mask.sum()) < min_pixels:
            continue
        label = {"object": one.number, "class": one.class_name, "category_id": classes.index(one.class_name) + 1, **_of_mask(mask, segmentation),
                 **_pose(one, items[one.place], frame, sight.camera.time_s if sight else 0.0), **_measured(dataset, mask)}
        label |= _geometry(one, items[one.place], mask, sight)
        out.append(rounded(label))
    return out


def degrees(frame: Frame, place: Any) -> list[str]:
    """Longitude and latitude of a place in scene ENU, as text: the digits of labels would be metres of a longitude, these are 0.01 mm."""
    return [f"{v:.10f}" for v in frame.to_geodetic(*(float(c) for c in place))[:2]]


def rounded(value: Any) -> Any:
    """Numbers to the digits that labels have; NaN is null."""
    if isinstance(value, dict):
        return {k: rounded(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [rounded(v) for v in value]
    if isinstance(value, np.ndarray):
        return rounded(value.tolist())
    if isinstance(value, (float, np.floating)):
        return float(f"{value:.{DIGITS}g}") if np.isfinite(value) else None
    return value.item() if isinstance(value, np.generic) else value


def _of_mask(mask: npt.NDArray[np.bool_], segmentation: str) -> dict[str, Any]:
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    polygons = _polygons(mask) if segmentation == "polygon" else None
    return {"area": int(mask.sum()),
            "bbox": [int(columns[0]), int(rows[0]), int(columns[-1] - columns[0] + 1), int(rows[-1] - rows[0] + 1)],
            "segmentation": polygons or {"size": list(mask.shape), "counts": _run_lengths(mask)}}


def pose_of(one: Placed, time_s: float) -> Pose:
    """The pose of an object at a time."""
    return Pose(np.array(one.at(time_s)), one.heading_deg, one.scale)


def _pose(one: Placed, item: TracedScene, frame: Frame | None, time_s: float) -> dict[str, Any]:
    corners = box_corners(item.bounds, pose_of(one, time_s))
    pose: dict[str, Any] = {"position_m": one.at(time_s), "heading_deg": one.heading_deg, "scale": one.scale,
                            "size_m": (item.bounds[1] - item.bounds[0]) * one.scale, "box_3d_m": corners}
    if frame:
        pose["footprint_lon_lat"] = [degrees(frame, corners[i]) for i in (0, 1, 3, 2)]
    return pose


def _measured(dataset: xr.Dataset, mask: npt.NDArray[np.bool_]) -> dict[str, Any]:
    """Means over the mask. Pixels have random numbers of their own, so that the variance of a mean is that of its pixels over their number squared."""
    quantity = str(next(iter(dataset.data_vars)))
    values, errors = (dataset[name].values[:, mask].astype(np.float64) for name in (quantity, "standard_error"))
    mean, error = values.mean(axis=1), np.sqrt((errors ** 2).sum(axis=1)) / mask.sum()
    with np.errstate(divide="ignore", invalid="ignore"):
        snr = np.median(np.abs(values) / errors, axis=1)  # Stokes vectors have signs
    bands = [str(b) for b in dataset["band"].values]
    out: dict[str, Any] = {"spectrum": dict(zip(bands, mean.tolist())), "spectrum_error": dict(zip(bands, error.tolist())),
                           "snr": dict(zip(bands, snr.tolist()))}
    for key, name in (("range_m", "truth_range"), ("incidence_deg", "truth_incidence_angle"), ("temperature_k", "truth_temperature")):
        if name in dataset:
            out[key] = _mean(dataset[name].values[mask])
    if "truth_sun_visibility" in dataset:
        lit = _mean(dataset["truth_sun_visibility"].values[mask])
        out["in_shadow"] = None if lit is None else 1 - lit
    return out


def _mean(values: npt.NDArray[Any]) -> float | None:
    known = values[np.isfinite(values)]
    return float(known.mean()) if len(known) else None


def _geometry(one: Placed, item: TracedScene, mask: npt.NDArray[np.bool_], sight: Sight | None) -> dict[str, Any]:
    """Where the sensor's geometry is not known the oriented box is the smallest around the mask."""
    if sight is None:
        return _by_mask(mask)
    pose = pose_of(one, sight.camera.time_s)
    corners = box_corners(item.bounds, pose)
    seen = silhouette(sight.camera, item, pose, corners, sight.things.tags.index(one.tag), sight.things, sight.backdrop, sight.rays)
    if seen is None:
        return _by_mask(mask)
    at, distance = sight.camera.project(corners)
    geometry: dict[str, Any] = {"box_3d_px": at, "box_3d_range_m": distance, "occlusion": seen.occlusion, "truncation": seen.truncation}
    if one.keypoints:
        geometry |= keypoints(sight.camera, pose, one.keypoints, sight.things, sight.backdrop)
    if np.isfinite(seen.range_m):
        geometry["gsd_m"] = sight.camera.gsd_m(seen.range_m)
    return {**(_by_mask(mask) if not len(seen.x) else {"obb": _oriented(seen, pose, corners, sight.camera), "obb_of": "silhouette"}), **geometry}


def _by_mask(mask: npt.NDArray[np.bool_]) -> dict[str, Any]:
    return {"obb": smallest(corners_of(mask)), "obb_of": "mask"}


def _oriented(seen: Silhouette, pose: Pose, corners: npt.NDArray[np.float64], camera: Camera) -> npt.NDArray[np.float64]:
    """Along the object's +y as the picture shows it; around the silhouette as it would be without other things and edges."""
    middle = corners.mean(axis=0)
    ends, _ = camera.project(np.stack([middle, middle + 0.01 * pose.rotation[:, 1] * np.linalg.norm(corners[7] - corners[0])]))
    points = np.stack([seen.x, seen.y], axis=-1)
    direction = ends[1] - ends[0]
    if not np.isfinite(direction).all() or np.hypot(*direction) < 1e-6:
        return smallest(points)
    return along(points, direction, seen.cell / 2)
