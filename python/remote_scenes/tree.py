"""Typed trees of keys that are written as the suite's YAML texts.

Whether values make sense is for the programs to say; here only what has no place in a text is refused (TypeError or
ValueError, with the key).
"""
from __future__ import annotations

import datetime
import difflib
import os
from dataclasses import dataclass, field, fields, is_dataclass
from pathlib import Path
from typing import Any, Mapping, Sequence, TypeVar, Union

import numpy as np
import xarray as xr
import yaml

FileName = Union[str, os.PathLike[str]]
"""A name of a file. In a tree a `str` counts from the folder of the text, as in a text written by hand; a `pathlib.Path`
from the working folder."""

_K = TypeVar("_K", bound="Keys")

MARK = "# Written by remote_scenes"


@dataclass(kw_only=True)
class Keys:
    """Keys of a text. None = the key is not written. `more`: keys that this class does not know, written as they are."""

    more: dict[str, Any] = field(default_factory=dict)

    def __new__(cls: type[_K], *args: Any, **keys: Any) -> _K:
        """TypeError with the nearest key for one that this class does not know."""
        known = [f.name for f in fields(cls)]
        for name in keys:
            if name not in known and (near := difflib.get_close_matches(name, known, 1)):
                raise TypeError(f"{cls.__name__} has no key '{name}'; did you mean '{near[0]}'?")
        return super().__new__(cls)

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in {f.name for f in fields(self)}:
            raise AttributeError(f"{type(self).__name__} has no key '{name}'; further ones go into `more`")
        super().__setattr__(name, value)

    def keys(self) -> dict[str, Any]:
        """The keys that are written, with their values as given."""
        own = {f.name.rstrip("_"): getattr(self, f.name) for f in fields(self) if f.name != "more"}
        return {**{k: v for k, v in own.items() if v is not None}, **self.more}


class OpenKeys:
    """Keys of a text that depend on a kind, such as the parameters of a model: all are written as they are given."""

    def __init__(self, **keys: Any) -> None:
        self.__dict__.update(keys)

    def keys(self) -> dict[str, Any]:
        """The keys that are written, with their values as given."""
        return {k.rstrip("_"): v for k, v in self.__dict__.items() if v is not None}

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{k}={v!r}' for k, v in self.__dict__.items())})"

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and self.__dict__ == other.__dict__


@dataclass(frozen=True)
class Curve:
    """Values at wavelengths (micron, ascending), linear in between. outside: "error", "hold" or "zero", what holds beyond."""

    wavelength_um: Sequence[float] | np.ndarray[Any, Any]
    value: Sequence[float] | np.ndarray[Any, Any]
    outside: str | None = None

    def keys(self) -> dict[str, Any]:
        """The keys that are written."""
        outside = {"outside": self.outside} if self.outside else {}
        return {"wavelength_um": self.wavelength_um, "value": self.value, **outside}


@dataclass(frozen=True)
class CurveFile:
    """A curve in a file (formats/curve/FORMAT.md). spectrum: name or number in a spectral library."""

    file: FileName
    column: int | None = None
    scale: float | None = None
    spectrum: str | int | None = None
    outside: str | None = None

    def keys(self) -> dict[str, Any]:
        """The keys that are written."""
        return {f.name: getattr(self, f.name) for f in fields(self) if getattr(self, f.name) is not None}


CurveLike = Union[float, FileName, Curve, CurveFile, xr.DataArray, Mapping[str, Any], Sequence[Any]]
"""What stands for a curve: a number, the name of a curve or file, a Curve or CurveFile, a DataArray with a coordinate
`wavelength_um`, a map of the text's own grammar, or a list of these, which are joined."""


def _curve_of(array: xr.DataArray, key: str) -> dict[str, Any]:
    if array.ndim != 1 or "wavelength_um" not in array.coords or array["wavelength_um"].dims != array.dims:
        raise ValueError(f"{key}: a curve has one dimension with a coordinate 'wavelength_um', not {array.dims}")
    ordered = array.sortby("wavelength_um")
    return {"wavelength_um": plain(ordered["wavelength_um"].values, key), "value": plain(ordered.values, key)}


def plain(value: Any, key: str = "", folder: Path | None = None) -> Any:
    """The value in the types of YAML. key: its place, for messages; folder: of the text, which paths are written from.
    TypeError for what has no place in a text, ValueError for dates without a time zone and curves of a wrong shape.
    """
    def inner(item: Any, name: Any) -> Any:
        return plain(item, f"{key}.{name}" if key else str(name), folder)

    if isinstance(value, xr.DataArray) and value.ndim:
        return _curve_of(value, key)
    if isinstance(value, (np.generic, np.ndarray, xr.DataArray)):
        value = np.asarray(value).tolist()
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, datetime.datetime):
        if value.tzinfo is None:
            raise ValueError(f"{key}: the date {value} has no time zone; say tzinfo=datetime.timezone.utc")
        return value.astimezone(datetime.timezone.utc).replace(tzinfo=None).isoformat() + "Z"
    if isinstance(value, os.PathLike):
        path = os.path.abspath(os.fspath(value))
        return os.path.relpath(path, folder) if folder else path
    if isinstance(value, (Keys, OpenKeys, Curve, CurveFile)):
        return inner_map(value.keys(), inner)
    if isinstance(value, Mapping):
        return inner_map(value, inner)
    if isinstance(value, (list, tuple)):
        return [inner(item, i) for i, item in enumerate(value)]
    about = "; make it one of this package's classes" if is_dataclass(value) else ""
    raise TypeError(f"{key}: a {type(value).__name__} has no place in a text{about}")


def inner_map(items: Mapping[Any, Any], inner: Any) -> dict[Any, Any]:
    """A map with its values made plain; keys are names or numbers."""
    return {(k.item() if isinstance(k, np.generic) else k): inner(v, k) for k, v in items.items()}


class _Dumper(yaml.SafeDumper):
    def ignore_aliases(self, data: Any) -> bool:
        return True


def to_text(value: Keys, path: FileName) -> str:
    """The text that `write` puts into a file of this name."""
    folder = Path(os.path.abspath(path)).parent
    body = yaml.dump(plain(value, "", folder), Dumper=_Dumper, sort_keys=False, allow_unicode=True, width=120,
                     default_flow_style=None)
    return f"{_mark(value)}, and rewritten by it.\n{body}"


def _mark(value: Keys) -> str:
    return f"{MARK}, a {type(value).__name__.lower()}"


def beside(value: Keys, path: FileName) -> Path:
    """`path`, for the text that goes with a result: where this package has written a text of another class there,
    `s_scene.yaml` or `s_simulation.yaml` in place of `s.yaml`."""
    target = Path(path)
    if target.exists():
        old = target.read_text(encoding="utf-8", errors="replace")
        if old.startswith(MARK) and not old.startswith(_mark(value)):
            return target.with_stem(f"{target.stem}_{type(value).__name__.lower()}")
    return target


def write(value: Keys, path: FileName) -> Path:
    """Writes the text, whole or not at all; a file that holds it already is left as it is. FileExistsError when something
    stands there that this package has not written, or of another class: a text by hand is never replaced.
    """
    target = Path(path)
    text = to_text(value, target)
    if target.exists():
        old = target.read_text(encoding="utf-8", errors="replace")
        if old == text:
            return target
        if not old.startswith(_mark(value)):
            raise FileExistsError(f"{target} is no {type(value).__name__.lower()} that this package has written, and is not "
                                  "replaced; give another name")
    target.parent.mkdir(parents=True, exist_ok=True)
    temporary = target.with_name(f".{target.name}.{os.getpid()}")
    try:
        temporary.write_text(text, encoding="utf-8")
        os.replace(temporary, target)
    finally:
        temporary.unlink(missing_ok=True)
    return target
