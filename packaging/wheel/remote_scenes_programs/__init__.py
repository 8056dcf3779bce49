"""The suite's programs, as the wheels bring them: `bin`, `lib` and `lib/suite` of an installation stand in this folder.

Apart from `remote_scenes`, whose imports take longer than a program does to start.
"""
from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import NoReturn


def folder() -> Path:
    """Where the programs are."""
    return Path(__file__).resolve().parent / "bin"


def _become(name: str) -> NoReturn:
    program = folder() / name
    try:
        os.execv(program, [name, *sys.argv[1:]])
    except OSError as problem:
        sys.exit(f"{name}: error: {program} cannot be run: {problem.strerror}")


def dirsig_render() -> NoReturn:
    _become("dirsig-render")


def scene_prep() -> NoReturn:
    _become("scene-prep")


def sqt_fit() -> NoReturn:
    _become("sqt-fit")


def sqt_inspect() -> NoReturn:
    _become("sqt-inspect")
