"""Finds the suite's programs and runs them."""
from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
import threading
import warnings
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import IO, Callable, Sequence, Union

from .errors import Finding, ProgramMissing, ProgramWarning, error_of, findings_of, with_keys

Progress = Union[bool, Callable[[str], None], None]
"""Where a program's lines go while it works: True = all to standard error, False = nowhere, a function = there, one line a
call. None: lines of progress to standard error in a terminal or a notebook, nowhere else."""

FOLDER_VARIABLE = "REMOTE_SCENES_BIN"
PROGRAMS = ("scene-prep", "dirsig-render", "sqt-fit", "sqt-inspect")
_PERCENT = re.compile(r"^.*: \d+ % \(.* left\)$")


@dataclass(frozen=True)
class Found:
    """Where a program is, and why that one was taken."""

    path: str
    why: str


def find_program(name: str) -> str:
    """The path of a program: in the folder that REMOTE_SCENES_BIN names, else of the wheel that is installed beside this
    package, else on the PATH, else in `build/release/bin` of the checkout that holds this package, else in that of the working
    folder or of one above it, which a ProgramWarning names once. `where_is` also says which of these it was. ProgramMissing
    when it is in none of them (or not in the folder that is named).
    """
    return where_is(name).path


def where_is(name: str) -> Found:
    """As find_program, with the reason; `python -m remote_scenes` prints it of all programs."""
    if folder := os.environ.get(FOLDER_VARIABLE):
        found = shutil.which(name, path=folder)
        if not found:
            raise ProgramMissing(f"{name} is not in {folder}, which {FOLDER_VARIABLE} names")
        return Found(found, f"{FOLDER_VARIABLE} names its folder")
    if installed := _installed_folder():
        if found := shutil.which(name, path=installed):
            return Found(found, "it was installed with this package")
        if name in PROGRAMS:
            raise ProgramMissing(f"{name} is not in {installed}, where the wheels put it: pip install --force-reinstall "
                                 f"{'remote-scenes-prep' if name == 'scene-prep' else 'remote-scenes'}, or name another folder in {FOLDER_VARIABLE}")
    if found := shutil.which(name):
        return Found(found, "it is on the PATH")
    if found := shutil.which(name, path=str(Path(__file__).resolve().parents[2] / "build/release/bin")):
        return Found(found, "it is of the checkout that holds this package")
    here = Path.cwd()
    for above in (here, *here.parents):
        if found := shutil.which(name, path=str(above / "build/release/bin")):
            _tell_found(str(above / "build/release/bin"))
            return Found(found, "it was found from the working folder upwards")
    raise ProgramMissing(f"{name} was found nowhere: install the wheels (pip install remote-scenes), or build the suite (scripts/build) and "
                         f"put its build/release/bin on the PATH, or name that folder in {FOLDER_VARIABLE}")


def _installed_folder() -> str | None:
    """Of the programs that wheels have brought; None where there are none, as in a checkout."""
    try:
        from remote_scenes_programs import folder  # type: ignore[import-not-found,unused-ignore]
    except ImportError:
        return None
    return str(folder())


@lru_cache(maxsize=None)
def _tell_found(folder: str) -> None:
    """Nobody has named the folder: whoever started Python somewhere below it may mean other programs, or trust none there."""
    warnings.warn(f"the programs of {folder} are used, which was found from the working folder upwards; put it on the PATH, "
                  f"or name it in {FOLDER_VARIABLE}", ProgramWarning, stacklevel=_caller())


@dataclass(frozen=True)
class Run:
    """What a program that ended well has said."""

    command: tuple[str, ...]
    stdout: str
    messages: tuple[str, ...]
    findings: tuple[Finding, ...]


def _teller(progress: Progress) -> Callable[[str], None]:
    if callable(progress):
        return progress

    def tell(line: str) -> None:
        if progress or _PERCENT.match(line):
            print(line, file=sys.stderr, flush=True)

    watched = sys.stderr.isatty() or "ipykernel" in sys.modules
    return tell if progress or (progress is None and watched) else lambda _: None


def _caller() -> int:
    """The `stacklevel` with which a warning of run_program points to the first line that is none of this package."""
    level, frame = 1, sys._getframe(1)
    while frame.f_back and Path(frame.f_code.co_filename).parent == Path(__file__).parent:
        level, frame = level + 1, frame.f_back
    return level


def run_program(name: str, arguments: Sequence[Union[str, os.PathLike[str]]], progress: Progress = None,
                cwd: Union[str, os.PathLike[str], None] = None) -> Run:
    """Runs a program to its end. What it warns of becomes a ProgramWarning; when it fails, InputError, UsageError,
    ProgramBug or Interrupted is raised. Ctrl-C lets the program end in good order (states are kept) before
    KeyboardInterrupt goes on.
    """
    command = [find_program(name), *(os.fspath(a) for a in arguments)]
    tell = _teller(progress)
    # A session of its own: a Ctrl-C reaches the program once, from here.
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True,
                               encoding="utf-8", errors="replace", cwd=cwd, start_new_session=True)
    out: list[str] = []
    said: list[str] = []

    def read(stream: IO[str], lines: list[str], heard: bool) -> None:
        for line in stream:
            lines.append(line.rstrip("\n"))
            if heard:
                tell(lines[-1])

    assert process.stdout and process.stderr
    reader = threading.Thread(target=read, args=(process.stdout, out, False), daemon=True)
    reader.start()
    try:
        read(process.stderr, said, True)
        process.wait()
    except BaseException as stopped:
        process.send_signal(signal.SIGINT if isinstance(stopped, KeyboardInterrupt) else signal.SIGTERM)
        for _ in process.stderr:
            pass
        process.wait()
        raise
    finally:
        reader.join()
        process.stdout.close()
        process.stderr.close()
    lines = said + out
    if process.returncode:
        error = error_of(name, process.returncode, lines)
        error.stdout = "\n".join(out)
        raise error
    findings = with_keys(f for f in findings_of(lines) if f.severity != "error")
    for finding in findings:
        if finding.severity == "warning":
            warnings.warn(str(finding).removeprefix("warning: "), ProgramWarning, stacklevel=_caller())
    return Run(tuple(command), "\n".join(out), tuple(said), findings)


def version() -> str:
    """The version of the programs that are found, as `0.9.0`."""
    return run_program("scene-prep", ["--version"]).stdout.split()[1]
