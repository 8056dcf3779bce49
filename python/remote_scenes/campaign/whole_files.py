"""Files that are there whole or not at all."""
from __future__ import annotations

import os
import socket
from pathlib import Path
from typing import Iterable


def write_whole(path: Path, content: bytes) -> None:
    """A file whole or not at all; one that holds the same stays as it is."""
    if path.exists() and path.read_bytes() == content:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    new = path.with_name(f".{path.name}.{socket.gethostname()}.{os.getpid()}")
    try:
        new.write_bytes(content)
        os.replace(new, path)
    finally:
        new.unlink(missing_ok=True)


def write_parts(path: Path, parts: Iterable[str]) -> None:
    """As write_whole, of a text that is never in memory as a whole."""
    path.parent.mkdir(parents=True, exist_ok=True)
    new = path.with_name(f".{path.name}.{socket.gethostname()}.{os.getpid()}")
    try:
        with new.open("w", encoding="utf-8") as file:
            file.writelines(parts)
        os.replace(new, path)
    finally:
        new.unlink(missing_ok=True)
