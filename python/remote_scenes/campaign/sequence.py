"""Sequences of frames: the same sensors at one time after another, still or moving with a constant velocity."""
from __future__ import annotations

import copy
from dataclasses import dataclass
from typing import Any, Sequence

from .camera import name_of
from .text import Node

MOST_FRAMES = 10_000
KINDS = ("orthographic", "frame_camera")


@dataclass(frozen=True)
class Frames:
    """count: of frames; step_s: from one to the next; move_m_s: velocity of the sensors, scene ENU."""

    count: int = 1
    step_s: float = 1.0
    move_m_s: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def expanded(self, sensors: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
        """Every sensor once a frame, as NAME_0000 and so on, at its time and place; as they are where there is one frame."""
        if self.count == 1:
            return list(sensors)
        return [self._at(sensor, k) for sensor in sensors for k in range(self.count)]

    def _at(self, sensor: dict[str, Any], k: int) -> dict[str, Any]:
        frame, after = copy.deepcopy(sensor), k * self.step_s
        frame["name"] = f"{name_of(sensor)}_{k:04d}"
        frame["time_s"] = float(sensor.get("time_s", 0)) + after
        for key in ("center_m", "position_m", "look_at_m"):
            if key in frame:
                frame[key] = [float(v) + after * m for v, m in zip(frame[key], self.move_m_s)]
        return frame

    def frame_of(self, name: str) -> int | None:
        """The number of the frame that an image is; None where there are no sequences."""
        return int(name.rpartition("_")[2]) if self.count > 1 else None

    def next_of(self, name: str) -> str | None:
        """The name of the image of the next frame; None of the last one."""
        k = self.frame_of(name)
        return None if k is None or k + 1 == self.count else f"{name.rpartition('_')[0]}_{k + 1:04d}"


def read_frames(node: Node | None, simulation: dict[str, Any]) -> Frames:
    """`{frames: N, step_s: S, move_m_s: [E, N, U]}`. CampaignError: a sensor whose geometry is not known here."""
    if node is None:
        return Frames()
    keys = node.map(("frames", "step_s", "move_m_s"), ("frames",))
    for sensor in simulation["sensors"] or ():
        if isinstance(sensor, dict) and sensor.get("kind") not in KINDS:
            raise node.error(f"a sequence of a sensor of kind '{sensor.get('kind')}'", " or ".join(KINDS))
    move = keys["move_m_s"].numbers(3) if "move_m_s" in keys else (0.0, 0.0, 0.0)
    return Frames(keys["frames"].integer(1, MOST_FRAMES), keys["step_s"].number(1e-6, 1e6) if "step_s" in keys else 1.0, (move[0], move[1], move[2]))
