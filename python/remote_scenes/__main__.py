"""python -m remote_scenes: the versions of the package and of the programs, where they are and why these were taken."""
from __future__ import annotations

import subprocess
import sys

from . import __version__
from .errors import ProgramMissing
from .library import find_library
from .programs import PROGRAMS, where_is


def main() -> int:
    """0, or 1 where something is missing."""
    print(f"remote_scenes {__version__}")
    missing = 0
    for name in PROGRAMS:
        try:
            found = where_is(name)
            told = subprocess.run([found.path, "--version"], capture_output=True, text=True, check=False)
            print(f"{(told.stdout or told.stderr).strip()}: {found.path} ({found.why})")
            missing += told.returncode != 0
        except (ProgramMissing, OSError) as problem:
            print(f"{name}: {problem}", file=sys.stderr)
            missing += 1
    try:
        print(f"libremote_scenes: {find_library()}")
    except ProgramMissing as problem:
        print(f"libremote_scenes: {problem}", file=sys.stderr)
        missing += 1
    return 1 if missing else 0


sys.exit(main())
