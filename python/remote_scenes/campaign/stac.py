"""STAC: a collection and an item for every image (STAC specification 1.0.0, with the picture's footprint where the scene has an origin)."""
from __future__ import annotations

import datetime
import json
from pathlib import Path
from typing import Any

from .campaign import Campaign
from .cog import TYPE
from .exports import Image, images, own_files
from .whole_files import write_whole

VERSION = "1.0.0"
_NO_DATE = "1970-01-01T00:00:00Z"
_TYPES = {".png": ("image/png", "overview"), ".tif": ("image/tiff; application=geotiff", "data"), ".img": ("application/octet-stream", "data"),
          ".hdr": ("text/plain", "metadata"), ".json": ("application/json", "metadata")}


def write_stac(campaign: Campaign, folder: Path) -> None:
    """`stac/collection.json` and `stac/items/KEY.json`. Items without a date in their simulation have 1970-01-01 and say so (`date_is_given`)."""
    dates, boxes, links = [], [], []
    name = "".join(c if c.isalnum() else "-" for c in campaign.name)
    for image in images(folder):
        item = _item(image, folder, name)
        write_whole(folder / "stac/items" / f"{image.key}.json", json.dumps(item, indent=1).encode())
        dates.append(item["properties"]["datetime"])
        boxes += [item["bbox"]] if "bbox" in item else []
        links.append({"rel": "item", "href": f"./items/{image.key}.json", "type": "application/geo+json"})
    whole = [min(b[0] for b in boxes), min(b[1] for b in boxes), max(b[2] for b in boxes), max(b[3] for b in boxes)] if boxes else [-180, -90, 180, 90]
    collection: dict[str, Any] = {
        "type": "Collection", "stac_version": VERSION, "id": name, "title": campaign.name,
        "description": campaign.description or campaign.name, "license": "other" if campaign.license else "proprietary",
        "extent": {"spatial": {"bbox": [whole]}, "temporal": {"interval": [[min(dates), max(dates)] if dates else [None, None]]}},
        "summaries": {"classes": campaign.classes},
        "links": [{"rel": "root", "href": "./collection.json", "type": "application/json"}, *links]}
    if campaign.license:
        collection["links"].append({"rel": "license", "href": campaign.license})
    write_whole(folder / "stac/collection.json", json.dumps(collection, indent=1).encode())


def _item(image: Image, folder: Path, collection: str) -> dict[str, Any]:
    corners = image.about.get("corners_lon_lat")
    date = image.about.get("time")
    if date:
        date = datetime.datetime.fromisoformat(date.replace("Z", "+00:00")).strftime("%Y-%m-%dT%H:%M:%SZ")
    item: dict[str, Any] = {"type": "Feature", "stac_version": VERSION, "id": image.key, "geometry": None,
                            "properties": {"datetime": date or _NO_DATE, "date_is_given": bool(date), "sample": image.sample,
                                           "objects": len(image.labels), "flagged": image.about["flagged"],
                                           "median_relative_error": image.about["median_relative_error"]}}
    if corners:
        ring = [[float(v) for v in corner] for corner in corners]
        item["geometry"] = {"type": "Polygon", "coordinates": [[*ring, ring[0]]]}
        xs, ys = [c[0] for c in ring], [c[1] for c in ring]
        item["bbox"] = [min(xs), min(ys), max(xs), max(ys)]
    item["links"] = [{"rel": "root", "href": "../collection.json", "type": "application/json"},
                     {"rel": "parent", "href": "../collection.json", "type": "application/json"},
                     {"rel": "collection", "href": "../collection.json", "type": "application/json"}]
    item["collection"] = collection
    item["assets"] = {}
    for file in sorted([*(file for _, file in own_files(folder, image)), (folder / image.file).with_name("sample.json")]):
        kind, role = _TYPES.get(file.suffix, ("application/octet-stream", "data"))
        item["assets"][file.name] = {"href": f"../../samples/{image.sample:06d}/{file.name}", "type": kind, "roles": [role]}
    if (folder / "cog" / f"{image.key}.tif").exists():
        item["assets"]["cog"] = {"href": f"../../cog/{image.key}.tif", "type": TYPE, "roles": ["data", "cloud-optimized"]}
    return item
