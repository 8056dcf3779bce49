"""Keypoints of objects in a picture: where each is, and whether something hides it (the marks of COCO: 0 not in the picture, 1 hidden, 2 visible)."""
from __future__ import annotations

from typing import Any, Mapping

import numpy as np

from ..traced import TracedScene
from .camera import Camera, Numbers
from .silhouettes import Pose

ABSENT, HIDDEN, VISIBLE = 0, 1, 2
NEAR_M = 0.05
"""What lies no further before a keypoint than this does not hide it: keypoints lie on surfaces, and measured ones not exactly."""


def keypoints(camera: Camera, pose: Pose, points: Mapping[str, Numbers | tuple[float, ...]], things: TracedScene, backdrop: TracedScene) -> dict[str, Any]:
    """`keypoints` (x, y and mark of each, in the order of their names in the text) and `num_keypoints`, those in the picture. points: in the object's
    frame, m."""
    places = pose.to_scene(np.array(list(points.values()), float))
    at, distance = camera.project(places)
    with np.errstate(invalid="ignore"):
        inside = np.asarray(((at >= 0) & (at < [camera.columns, camera.rows])).all(axis=1))
    mark = np.where(inside, HIDDEN, ABSENT)
    if inside.any():
        origin, direction = camera.rays(at[inside, 0], at[inside, 1])
        first = np.minimum(things.trace(origin, direction, camera.time_s).distance, backdrop.trace(origin, direction, camera.time_s).distance)
        mark[inside] = np.where(first >= distance[inside] - NEAR_M, VISIBLE, HIDDEN)
    flat: list[float | int] = []
    for (x, y), m in zip(np.where(inside[:, None], at, 0).tolist(), mark.tolist()):
        flat += [x, y, int(m)]
    return {"keypoints": flat, "num_keypoints": int(inside.sum())}
