"""Builds with setuptools in a copy, so that no installation writes into the checkout (PEP 517 and 660)."""
from __future__ import annotations

import base64
import contextlib
import hashlib
import os
import shutil
import tempfile
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from setuptools import build_meta

PACKAGE = "remote_scenes"


@contextlib.contextmanager
def _copy() -> Iterator[Path]:
    here = Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "source"
        shutil.copytree(here, copy, ignore=shutil.ignore_patterns("build", "dist", "*.egg-info", "__pycache__"))
        os.chdir(copy)
        try:
            yield here
        finally:
            os.chdir(here)


def get_requires_for_build_wheel(config_settings: Any = None) -> list[str]:
    with _copy():
        return build_meta.get_requires_for_build_wheel(config_settings)


def get_requires_for_build_sdist(config_settings: Any = None) -> list[str]:
    with _copy():
        return build_meta.get_requires_for_build_sdist(config_settings)


get_requires_for_build_editable = get_requires_for_build_wheel


def build_wheel(wheel_directory: str, config_settings: Any = None, metadata_directory: str | None = None) -> str:
    to = os.path.abspath(wheel_directory)
    with _copy():
        return build_meta.build_wheel(to, config_settings)


def build_sdist(sdist_directory: str, config_settings: Any = None) -> str:
    to = os.path.abspath(sdist_directory)
    with _copy():
        return build_meta.build_sdist(to, config_settings)


def build_editable(wheel_directory: str, config_settings: Any = None, metadata_directory: str | None = None) -> str:
    """The wheel with a path to the checkout in the package's place."""
    with _copy() as here, tempfile.TemporaryDirectory() as made:
        name = build_meta.build_wheel(made, config_settings)
        with zipfile.ZipFile(Path(made) / name) as old:
            files = {n: old.read(n) for n in old.namelist() if not n.startswith(PACKAGE + "/")}
    record = next(n for n in files if n.endswith(".dist-info/RECORD"))
    files[PACKAGE + "_checkout.pth"] = f"{here}\n".encode()
    lines = []
    for n, data in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        lines.append(f"{n},," if n == record else f"{n},sha256={digest},{len(data)}")
    files[record] = ("\n".join(lines) + "\n").encode()
    with zipfile.ZipFile(Path(wheel_directory) / name, "w", zipfile.ZIP_DEFLATED) as new:
        for n, data in files.items():
            new.writestr(n, data)
    return name
