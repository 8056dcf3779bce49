"""KITTI-like labels of frame cameras: a line an object with its box in space in the camera's axes, and the camera's matrix.

Based on: A. Geiger, P. Lenz and R. Urtasun, "Are we ready for autonomous driving? The KITTI vision benchmark suite", CVPR 2012 (development kit of the
object benchmark: axes x right, y down, z ahead; the place is the middle of the box's floor; rotation_y about the camera's y, 0 = the front to the right).
"""
from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from .campaign import Campaign
from .exports import Image, images
from .whole_files import write_whole

LARGELY = 0.5
"""Occluded by more than this: KITTI's mark 2 (largely); 1 partly, 0 fully visible."""
LEAST = 0.02


def write_kitti(campaign: Campaign, folder: Path) -> None:
    """`kitti/label_2/KEY.txt`, `kitti/calib/KEY.txt` and links `kitti/image_2/KEY.png`, of images of frame cameras alone."""
    for image in images(folder):
        camera = image.about.get("camera")
        if camera is None:
            continue
        lines = "".join(_line(label, camera) + "\n" for label in image.labels if "box_3d_m" in label)
        write_whole(folder / "kitti/label_2" / f"{image.key}.txt", lines.encode())
        write_whole(folder / "kitti/calib" / f"{image.key}.txt", _calibration(image, camera).encode())
        picture = folder / "kitti/image_2" / f"{image.key}.png"
        picture.parent.mkdir(parents=True, exist_ok=True)
        if not picture.is_symlink():
            picture.symlink_to(Path("../..") / image.file)


def _calibration(image: Image, camera: dict[str, Any]) -> str:
    """P2 (3 x 4) of the picture, whose coordinates count from the outer corner of the first pixel; the others of KITTI's matrices are 1."""
    f, (w, h) = float(camera["focal_px"]), image.size
    matrix = [f, 0, w / 2, 0, 0, f, h / 2, 0, 0, 0, 1, 0]
    return "P2: " + " ".join(f"{v:.9e}" for v in matrix) + "\nR0_rect: 1 0 0 0 1 0 0 0 1\n"


def _line(label: dict[str, Any], camera: dict[str, Any]) -> str:
    axes, corners = np.array(camera["axes"], float), np.array(label["box_3d_m"], float)
    local = (corners - np.array(camera["position_m"], float)) @ axes.T
    x, y, z = local[:4].mean(axis=0)
    ahead = local[2] - local[0]
    turn = math.atan2(-ahead[2], ahead[0])
    left, top, width, height = label["bbox"]
    wide, long, high = label["size_m"]
    hidden = label.get("occlusion")
    occluded = 3 if hidden is None else 2 if hidden > LARGELY else 1 if hidden > LEAST else 0
    cut = label.get("truncation")
    alpha = math.remainder(turn - math.atan2(x, z), math.tau)
    numbers = [left, top, left + width - 1, top + height - 1, high, wide, long, x, y, z, turn]
    return f"{label['class'].replace(' ', '_')} {-1 if cut is None else cut:.2f} {occluded} {alpha:.4f} " + " ".join(f"{v:.4f}" for v in numbers)
