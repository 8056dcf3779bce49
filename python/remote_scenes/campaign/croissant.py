"""A Croissant card of a dataset: what it is, where its files are, and by which distributions and seed it was made.

Based on: the Croissant format specification 1.0 of MLCommons (JSON-LD over schema.org). Keys of our own stand under `rs:`.
"""
from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

from .campaign import Campaign
from .figures import statistics
from .whole_files import write_whole

_CONTEXT: dict[str, Any] = {
    "@language": "en", "@vocab": "https://schema.org/", "cr": "http://mlcommons.org/croissant/", "sc": "https://schema.org/",
    "dct": "http://purl.org/dc/terms/", "rs": "urn:remote-scenes:campaign:", "rai": "http://mlcommons.org/croissant/RAI/", "equivalentProperty": "cr:equivalentProperty", "samplingRate": "cr:samplingRate",
    "citeAs": "cr:citeAs", "column": "cr:column", "conformsTo": "dct:conformsTo",
    "data": {"@id": "cr:data", "@type": "@json"}, "dataType": {"@id": "cr:dataType", "@type": "@vocab"}, "extract": "cr:extract", "field": "cr:field",
    "fileObject": "cr:fileObject", "fileProperty": "cr:fileProperty", "fileSet": "cr:fileSet", "format": "cr:format", "includes": "cr:includes",
    "isLiveDataset": "cr:isLiveDataset", "jsonPath": "cr:jsonPath", "key": "cr:key", "md5": "cr:md5", "parentField": "cr:parentField", "path": "cr:path",
    "recordSet": "cr:recordSet", "references": "cr:references", "regex": "cr:regex", "repeated": "cr:repeated", "replace": "cr:replace",
    "separator": "cr:separator", "source": "cr:source", "subField": "cr:subField", "transform": "cr:transform",
    "examples": {"@id": "cr:examples", "@type": "@json"}}


def write_croissant(campaign: Campaign, folder: Path, version: str) -> None:
    """`croissant.json`. The annotations are a record set where COCO is among the formats."""
    card: dict[str, Any] = {
        "@context": _CONTEXT, "@type": "sc:Dataset", "conformsTo": "http://mlcommons.org/croissant/1.0", "name": campaign.name,
        "description": campaign.description or campaign.name, "version": "1.0.0",
        "url": "urn:remote-scenes:campaign:" + campaign.digest, "isLiveDataset": False,
        "distribution": [
            {"@type": "cr:FileSet", "@id": "pictures", "name": "pictures", "encodingFormat": "image/png",
             "includes": "samples/*/*.png"},
            {"@type": "cr:FileSet", "@id": "records", "name": "records", "encodingFormat": "application/json",
             "includes": "samples/*/sample.json"}],
        "recordSet": [
            {"@type": "cr:RecordSet", "@id": "images", "name": "images", "field": [
                {"@type": "cr:Field", "@id": "images/picture", "name": "images/picture", "dataType": "sc:ImageObject",
                 "source": {"fileSet": {"@id": "pictures"}, "extract": {"fileProperty": "content"}}},
                {"@type": "cr:Field", "@id": "images/path", "name": "images/path", "dataType": "sc:Text",
                 "source": {"fileSet": {"@id": "pictures"}, "extract": {"fileProperty": "fullpath"}}}]}],
        "rs:seed": campaign.seed, "rs:programs": version, "rs:campaign": campaign.digest, "rs:classes": campaign.classes,
        "rs:distributions": {name: rule.node.plain() for name, rule in campaign.variables.rules.items()},
        "rs:objects": {group.name: group.node.plain() for group in campaign.groups}, "rs:statistics": statistics(folder)}
    if campaign.license:
        card["license"] = campaign.license
    annotations = folder / "annotations.json"
    if annotations.exists():
        with annotations.open("rb") as content:
            digest = hashlib.sha256(content.read()).hexdigest()
        card["distribution"].append({"@type": "cr:FileObject", "@id": "annotations", "name": "annotations", "contentUrl": "annotations.json",
                                     "encodingFormat": "application/json", "sha256": digest})
        card["recordSet"].append({"@type": "cr:RecordSet", "@id": "labels", "name": "labels", "field": [
            {"@type": "cr:Field", "@id": f"labels/{key}", "name": f"labels/{key}", "dataType": kind,
             "source": {"fileObject": {"@id": "annotations"}, "extract": {"jsonPath": f"$.annotations[*].{key}"}}}
            for key, kind in (("image_id", "sc:Integer"), ("category_id", "sc:Integer"), ("bbox", "cr:BoundingBox"), ("area", "sc:Float"))]})
    write_whole(folder / "croissant.json", json.dumps(card, indent=1, ensure_ascii=False).encode())
