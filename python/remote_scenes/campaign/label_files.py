"""Labels of a dataset in formats of others: COCO, DOTA, YOLO (boxes and oriented boxes), GeoJSON.

Based on: the data format of the COCO project (object detection); G.-S. Xia et al., "DOTA: A Large-scale Dataset for Object Detection in Aerial
Images", CVPR 2018 (labelTxt: eight coordinates, class, difficult); the label files of YOLO (class from 0, centre and size, or four corners, over the
picture's width and height); RFC 7946 (GeoJSON).
"""
from __future__ import annotations

import json
from itertools import chain
from pathlib import Path
from typing import Any, Callable, Iterator

from .campaign import Campaign
from .exports import Image, images, joined
from .whole_files import write_parts, write_whole

DIFFICULT_OCCLUSION = 0.5
"""DOTA's mark `difficult`: more than this is hidden, or lies beyond the edge."""


def write_coco(campaign: Campaign, folder: Path) -> None:
    """`annotations.json`; keys beyond COCO's are those of our labels."""
    licenses = [{"id": 1, "name": campaign.license, "url": campaign.license}] if campaign.license else []
    categories = [{"id": i, "name": name, "supercategory": "object", **({"keypoints": campaign.keypoints[name], "skeleton": []} if name in campaign.keypoints else {})}
                  for i, name in enumerate(campaign.classes, 1)]
    head = {"info": {"description": campaign.description or campaign.name, "version": "1"}, "licenses": licenses, "categories": categories}

    def pictures() -> Iterator[dict[str, Any]]:
        for number, image in enumerate(images(folder), 1):
            width, height = image.size
            date = {"date_captured": image.about["time"]} if "time" in image.about else {}
            yield {"id": number, "file_name": image.file, "width": width, "height": height, "sample": image.sample, **date, **_of_video(image)}

    def annotations() -> Iterator[dict[str, Any]]:
        number = 0
        for picture, image in enumerate(images(folder), 1):
            for label in image.labels:
                number += 1
                track = {"video_id": image.sample + 1, "track_id": label["object"]} if {"frame", "moment"} & set(image.about) else {}
                yield {"id": number, "image_id": picture, "iscrowd": 0, **track, **label}

    parts = (json.dumps(head)[:-1], ', "images": [')
    write_parts(folder / "annotations.json", chain(parts, joined(pictures()), ['], "annotations": ['], joined(annotations()), ["]}\n"]))


def _of_video(image: Image) -> dict[str, int]:
    """A sequence is a video, and a pair one of two frames; objects keep their numbers."""
    number = image.about.get("frame", image.about.get("moment"))
    return {} if number is None else {"video_id": image.sample + 1, "frame_index": number}


def write_dota(campaign: Campaign, folder: Path) -> None:
    """`labelTxt/KEY.txt`: corners clockwise from the front left one, the class with _ for blanks, and whether it is difficult."""
    def line(image: Image, label: dict[str, Any]) -> str:
        hard = max(label.get("occlusion") or 0, label.get("truncation") or 0) > DIFFICULT_OCCLUSION
        corners = " ".join(f"{v:.2f}" for corner in label["obb"] for v in corner)
        return f"{corners} {label['class'].replace(' ', '_')} {int(hard)}"

    for image in images(folder):
        gsd = next((f"gsd:{label['gsd_m']}\n" for label in image.labels if "gsd_m" in label), "gsd:null\n")
        write_whole(folder / "labelTxt" / f"{image.key}.txt", ("imagesource:simulated\n" + gsd + _lines(image, line)).encode())


def write_yolo(campaign: Campaign, folder: Path) -> None:
    """`yolo/labels/KEY.txt`: class, centre and size of the visible box; with `yolo/data.yaml` and links to the pictures."""
    def line(image: Image, label: dict[str, Any]) -> str:
        (width, height), (x, y, w, h) = image.size, label["bbox"]
        return f"{label['category_id'] - 1} {(x + w / 2) / width:.6f} {(y + h / 2) / height:.6f} {w / width:.6f} {h / height:.6f}"

    _yolo(campaign, folder, "yolo", line)


def write_yolo_obb(campaign: Campaign, folder: Path) -> None:
    """`yolo_obb/labels/KEY.txt`: class and four corners, cut to the picture."""
    def line(image: Image, label: dict[str, Any]) -> str:
        size = image.size
        corners = (min(1.0, max(0.0, corner[i] / size[i])) for corner in label["obb"] for i in (0, 1))
        return f"{label['category_id'] - 1} " + " ".join(f"{v:.6f}" for v in corners)

    _yolo(campaign, folder, "yolo_obb", line)


def _lines(image: Image, line: Callable[[Image, dict[str, Any]], str]) -> str:
    return "".join(line(image, label) + "\n" for label in image.labels)


def _yolo(campaign: Campaign, folder: Path, name: str, line: Callable[[Image, dict[str, Any]], str]) -> None:
    for image in images(folder):
        write_whole(folder / name / "labels" / f"{image.key}.txt", _lines(image, line).encode())
        picture = folder / name / "images" / f"{image.key}.png"
        picture.parent.mkdir(parents=True, exist_ok=True)
        if not picture.is_symlink():
            picture.symlink_to(Path("../..") / image.file)
    names = "".join(f"  {i}: {json.dumps(one)}\n" for i, one in enumerate(campaign.classes))
    write_whole(folder / name / "data.yaml", f"path: .\ntrain: images\nval: images\nnames:\n{names}".encode())


def write_geojson(campaign: Campaign, folder: Path) -> None:
    """`labels.geojson`: the footprint of every object that is seen, in longitude and latitude; nothing of scenes without an origin."""
    def features() -> Iterator[dict[str, Any]]:
        for image in images(folder):
            for label in image.labels:
                if "footprint_lon_lat" in label:
                    ring = [[float(v) for v in corner] for corner in label["footprint_lon_lat"]]
                    kept = ("object", "class", "area", "heading_deg", "occlusion", "truncation", "size_m")
                    yield {"type": "Feature", "geometry": {"type": "Polygon", "coordinates": [[*ring, ring[0]]]},
                           "properties": {"image": image.key, "file": image.file, **{k: label[k] for k in kept if k in label}}}

    write_parts(folder / "labels.geojson", chain(['{"type": "FeatureCollection", "features": ['], joined(features()), ["\n]}\n"]))
