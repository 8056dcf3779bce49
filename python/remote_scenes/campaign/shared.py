"""Prepared scenes that samples share: made once, named by the hash of all that goes into them, found again by any worker."""
from __future__ import annotations

import copy
import hashlib
import json
import os
import socket
from collections import OrderedDict
from pathlib import Path
from typing import Any

import yaml

from ..programs import run_program
from ..traced import TracedScene
from .campaign import as_json
from .text import leaves


UNUSED = ("--mute", "SP103", "--mute", "SP403")
"""What a catalogue offers need not stand in every scene: unused materials, objects and groups are no news."""


class _Dumper(yaml.SafeDumper):
    def ignore_aliases(self, data: Any) -> bool:
        return True


def write_json(tree: Any, path: Path) -> None:
    """A tree as JSON, which YAML holds: for programs, forty times as fast."""
    path.write_text(json.dumps(tree, ensure_ascii=False, allow_nan=False), encoding="utf-8")


def write_tree(tree: Any, path: Path) -> None:
    """A tree as YAML, to be read."""
    path.write_text(yaml.dump(tree, Dumper=_Dumper, sort_keys=False, allow_unicode=True, width=120, default_flow_style=None), encoding="utf-8")


def with_files(tree: Any, folder: Path) -> Any:
    """A tree in which names of files that count from a folder are absolute, so that the text may lie anywhere."""
    out = copy.deepcopy(tree)
    for path, value in list(leaves(out)):
        if isinstance(value, str) and _file(folder, value):
            at = out
            for key in path[:-1]:
                at = at[int(key) if isinstance(at, list) else key]
            at[int(path[-1]) if isinstance(at, list) else path[-1]] = os.path.abspath(folder / value)
    return out


def _file(folder: Path, text: str) -> Path | None:
    """The file that a text of a tree names; names of other things have no ending."""
    if not text or len(text) > 1000 or "\n" in text or "\0" in text or not Path(text).suffix:
        return None
    path = folder / text
    try:
        return path if path.is_file() else None
    except OSError:
        return None


class Shared:
    """A folder of prepared scenes, and the last few of them that were opened."""

    def __init__(self, folder: Path, search: Path, version: str, opened: int = 32) -> None:
        """search: where the scene's text names files from; version: of the programs, which is part of the hash."""
        self.folder, self._search, self._version, self._most = folder, search, version, opened
        self._open: OrderedDict[Path, TracedScene] = OrderedDict()
        self._hashes: dict[tuple[str, int, int], str] = {}

    def prepare(self, scene: dict[str, Any]) -> Path:
        """The prepared scene of a text; InputError when scene-prep refuses it, and nothing is left then."""
        path = self.folder / f"{self._digest(scene)}.h5"
        if not path.exists():
            self.folder.mkdir(parents=True, exist_ok=True)
            new = self.folder / f".{path.stem}.{socket.gethostname()}.{os.getpid()}.h5"
            try:
                prepare_tree(scene, new, self._search)
                os.replace(new, path)
            finally:
                new.unlink(missing_ok=True)
        return path

    def open(self, path: Path, time_s: float = 0.0) -> TracedScene:
        """A prepared scene within this process; those least recently used are closed when there are too many."""
        key = path.with_name(f"{path.name}@{time_s!r}")
        if key not in self._open:
            self._open[key] = TracedScene(path, time_s)
            while len(self._open) > self._most:
                self._open.popitem(last=False)[1].close()
        self._open.move_to_end(key)
        return self._open[key]

    def _digest(self, scene: dict[str, Any]) -> str:
        names = sorted({v for _, v in leaves(scene) if isinstance(v, str)})
        files = [(name, self._hash(file)) for name in names if (file := _file(self._search, name))]
        return hashlib.sha256(as_json([self._version, scene, files]).encode()).hexdigest()[:32]

    def _hash(self, file: Path) -> str:
        """Of a file and of those beside it that share its name (headers, material libraries)."""
        parts = []
        for one in sorted(p for p in file.parent.iterdir() if p.name.startswith(file.stem + ".") and p.is_file()):
            about = one.stat()
            key = (str(one), about.st_size, about.st_mtime_ns)
            if key not in self._hashes:
                with one.open("rb") as content:
                    self._hashes[key] = hashlib.file_digest(content, "sha256").hexdigest() if hasattr(hashlib, "file_digest") else \
                        hashlib.sha256(content.read()).hexdigest()
            parts.append((one.name, self._hashes[key]))
        return as_json(parts)


def prepare_tree(scene: dict[str, Any], path: Path, search: Path) -> None:
    """Has scene-prep prepare a tree as `path`, with its text beside it meanwhile. InputError: it was refused."""
    text = path.with_suffix(".yaml")
    try:
        write_json(scene, text)
        run_program("scene-prep", [text, "-o", path, "--path", search, "-q", "-j", "1", *UNUSED])
    finally:
        text.unlink(missing_ok=True)
