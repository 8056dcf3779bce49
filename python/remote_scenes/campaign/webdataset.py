"""WebDataset shards: tar files in which the files of one image follow each other and share a name (POSIX ustar; no times, no owners)."""
from __future__ import annotations

import io
import json
import os
import tarfile
from pathlib import Path

from .campaign import Campaign
from .exports import Image, images, own_files
from .whole_files import write_whole

SHARD_BYTES = 256 << 20


def write_webdataset(campaign: Campaign, folder: Path, shard_bytes: int = SHARD_BYTES) -> None:
    """`shards/NAME-000000.tar` and so on, each of at least shard_bytes but for the last one, and `shards/sizes.json` with the images in each. Of every
    image: KEY.png, KEY.json (labels and what the image is), and the files that are kept, as KEY.img, KEY.img.hdr, KEY.error.img ..."""
    target = folder / "shards"
    target.mkdir(exist_ok=True)
    stem, sizes = "".join(c if c.isalnum() else "_" for c in campaign.name), dict[str, int]()
    waiting = images(folder)
    image = next(waiting, None)
    while image is not None:
        name = f"{stem}-{len(sizes):06d}.tar"
        new, count, size = target / f".{name}.{os.getpid()}", 0, 0
        try:
            with tarfile.open(new, "w", format=tarfile.USTAR_FORMAT) as tar:
                while image is not None and size < shard_bytes:
                    size += _add(tar, folder, image)
                    count += 1
                    image = next(waiting, None)
            os.replace(new, target / name)
        finally:
            new.unlink(missing_ok=True)
        sizes[name] = count
    for old in target.glob(f"{stem}-*.tar"):
        if old.name not in sizes:
            old.unlink()
    write_whole(target / "sizes.json", json.dumps(sizes).encode())


def _add(tar: tarfile.TarFile, folder: Path, image: Image) -> int:
    size = 0
    record = json.dumps({"key": image.key, "sample": image.sample, "values": image.values, **image.about}, sort_keys=True).encode()
    parts = [(f"{image.key}.json", record)]
    for part, file in own_files(folder, image):
        parts.append((f"{image.key}.{part + '.' if part else ''}{file.name.partition('.')[2]}", file.read_bytes()))
    for path, content in sorted(parts):
        about = tarfile.TarInfo(path)
        about.size, about.mode = len(content), 0o644
        tar.addfile(about, io.BytesIO(content))
        size += len(content) + 512
    return size
