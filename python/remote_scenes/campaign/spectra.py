"""Spectra that are drawn: mixtures of several, and variability within a class of measured ones.

Mixtures are those of the linear model (N. Keshava and J. F. Mustard, "Spectral unmixing", IEEE Signal Process. Mag. 19 (2002), 44-57); their shares
have a Dirichlet distribution, by gamma variables (G. Marsaglia and W. W. Tsang, ACM Trans. Math. Softw. 26 (2000), 363-372). Variability is the normal
model of a class (A. Zare and K. C. Ho, "Endmember variability in hyperspectral analysis", IEEE Signal Process. Mag. 31 (2014), 95-104): mean and
covariance are those of the given spectra.
"""
from __future__ import annotations

import math
import re
from pathlib import Path
from statistics import NormalDist
from typing import Any, Callable, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from .text import CampaignError, Node

Numbers = npt.NDArray[np.float64]
Curves = Mapping[str, Any]
"""The `curves` of the scene's text, by name."""
DIGITS = 7
"""Significant digits of drawn spectra."""
_NORMAL = NormalDist()
_NUMBER = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")


class Spectra:
    """Several spectra at common wavelengths (um, ascending): all that any of them has, within the range that all have. values: (spectra,
    wavelengths). Without wavelengths: constants."""

    def __init__(self, wavelength_um: Numbers, values: Numbers, outside: str | None) -> None:
        self.wavelength_um, self.values, self._outside = wavelength_um, values, outside

    def curve(self, values: Numbers) -> Any:
        """Values at these wavelengths as a curve of the programs' texts."""
        numbers = [float(f"{v:.{DIGITS}g}") for v in values]
        if not len(self.wavelength_um):
            return numbers[0]
        return {"wavelength_um": self.wavelength_um.tolist(), "value": numbers, **({"outside": self._outside} if self._outside else {})}


def read_spectra(node: Node, curves: Curves, least: int, outside: str | None) -> Spectra:
    """A list of curves (a number, the name of one of the scene, a file, a map of `wavelength_um` and `value` or of `file` and `column`), or a file with
    several columns of values. CampaignError: fewer than `least`, no common wavelengths, not readable."""
    if isinstance(node.value, str) and node.value not in curves:
        one = _table(node, node.value)
        known = [(one[:, 0], column) for column in one[:, 1:].T]
    else:
        known = [_curve(item, item.plain(), curves) for item in node.list(least)]
    if len(known) < least:
        raise node.error(f"{len(known)} spectra are too few", f"at least {least}")
    tables = [(w, v) for w, v in known if len(w)]
    if not tables:
        return Spectra(np.empty(0), np.array([v for _, v in known]).reshape(-1, 1), outside)
    low, high = max(w[0] for w, _ in tables), min(w[-1] for w, _ in tables)
    grid = np.unique(np.concatenate([w for w, _ in tables]))
    grid = grid[(grid >= low) & (grid <= high)]
    if len(grid) < 2:
        raise node.error("the spectra have no wavelengths in common", "spectra that overlap")
    return Spectra(grid, np.array([np.interp(grid, w, v) if len(w) else np.full(len(grid), v[0]) for w, v in known]), outside)


def _curve(node: Node, tree: Any, curves: Curves, depth: int = 0) -> tuple[Numbers, Numbers]:
    """Wavelengths and values; a constant has no wavelengths."""
    if isinstance(tree, (int, float)) and not isinstance(tree, bool):
        return np.empty(0), np.array([float(tree)])
    if isinstance(tree, str):
        if tree in curves and depth < 8:
            return _curve(node, curves[tree], curves, depth + 1)
        return _column(node, tree, 1)
    if isinstance(tree, dict) and set(tree) <= {"wavelength_um", "value", "outside"} and {"wavelength_um", "value"} <= set(tree):
        try:
            table = np.stack([np.array(tree[k], float).reshape(-1) for k in ("wavelength_um", "value")], axis=1)
        except (TypeError, ValueError):
            raise node.error("a curve has as many values as wavelengths, all numbers") from None
        if len(table) < 2:
            raise node.error("a curve has one wavelength", "at least two, or a number in its place")
        return _checked(node, table)[:, 0], table[:, 1]
    if isinstance(tree, dict) and set(tree) <= {"file", "column", "scale", "outside"} and isinstance(tree.get("file"), str):
        column = tree.get("column", 1)
        if isinstance(column, bool) or not isinstance(column, int) or column < 1:
            raise node.error(f"{column!r} is no column", "1 is the first one behind the wavelengths")
        wavelength, value = _column(node, tree["file"], column)
        return wavelength, value * float(tree.get("scale", 1))
    raise node.error("this is no curve that can be drawn from", "a number, a name, a file of text, {wavelength_um, value} or {file, column, scale}; known: "
                     + (", ".join(curves) or "none"))


def _column(node: Node, name: str, column: int) -> tuple[Numbers, Numbers]:
    table = _table(node, name)
    if column >= table.shape[1]:
        raise node.error(f"{name} has no column {column}", f"1 to {table.shape[1] - 1}")
    return table[:, 0], table[:, column]


def _table(node: Node, name: str) -> Numbers:
    """A file of rows `wavelength value [value ...]` (formats/curve: text, CSV, ECOSTRESS), found from the campaign's folder; um, shares, ascending."""
    path = Path(node.file).parent / name
    try:
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError as problem:
        raise node.error(f"'{name}' is neither a curve of the scene nor a file that can be read: {problem.strerror}", "a name of the scene's `curves`, or a "
                         "file, which counts from the campaign's folder") from None
    rows, head = [], []
    for line in lines:
        cells = re.split(r"[,;\s]+", re.split(r"[#!]", line)[0].strip().strip(",;"))
        if cells[0] and all(_NUMBER.fullmatch(c) for c in cells):
            rows.append([float(c) for c in cells])
        else:
            head.append(line.lower())
    if len(rows) < 2 or len({len(r) for r in rows}) != 1 or len(rows[0]) < 2:
        raise node.error(f"{path} is no table of spectra", "rows of a wavelength and as many values each, at least two")
    table, said = np.array(rows), " ".join(head)
    if table[0, 0] > table[-1, 0]:
        table = table[::-1]
    if re.search(r"\bnm\b|nanomet", said):
        table[:, 0] /= 1000
    if re.search(r"y units:.*percent", said):
        table[:, 1:] /= 100
    return _checked(node, table)


def _checked(node: Node, table: Numbers) -> Numbers:
    if not np.isfinite(table).all() or table[0, 0] < 0.01 or table[-1, 0] > 1e4 or not (np.diff(table[:, 0]) > 0).all():
        raise node.error("the wavelengths of a spectrum do not ascend from 0.01 to 10 000 um, or a value is not finite", "micrometres; nanometres where the head says nm")
    return table


def gamma(shape: float, number: Callable[[str], float]) -> float:
    """A gamma variable of a shape (scale 1); number: numbers within (0, 1) by name. A. shape below 1 by that of shape + 1 and a power."""
    if shape < 1:
        return float(gamma(shape + 1, number) * number("power") ** (1 / shape))
    d = shape - 1 / 3
    for attempt in range(1000):
        x = _NORMAL.inv_cdf(number(f"normal.{attempt}"))
        v = (1 + x / math.sqrt(9 * d)) ** 3
        if v > 0 and math.log(number(f"accept.{attempt}")) < 0.5 * x * x + d - d * v + d * math.log(v):
            return float(d * v)
    raise AssertionError("gamma")  # each attempt is taken with more than 0.95


def shares_of(means: Sequence[float], concentration: float, number: Callable[[str], float]) -> Numbers:
    """Shares that sum to 1, of a Dirichlet distribution: their means m, and variances m (1 - m) / (concentration + 1)."""
    parts = np.array([gamma(concentration * m, lambda name, i=i: number(f"{i}.{name}")) if m > 0 else 0.0  # type: ignore[misc]
                      for i, m in enumerate(means)])
    total = float(parts.sum())
    if total > 0:
        return np.asarray(parts / total)
    only = np.zeros(len(parts))  # all so small that they are 0: one of them is the whole
    only[min(int(number("one") * len(parts)), len(parts) - 1)] = 1
    return only


def normal_member(spectra: Spectra, deviation: float, within: tuple[float, float], number: Callable[[str], float]) -> Numbers:
    """A member of the class whose mean and covariance are those of the given spectra (the latter times deviation squared), cut to `within`."""
    z = np.array([_NORMAL.inv_cdf(number(str(i))) for i in range(len(spectra.values))])
    mean = spectra.values.mean(axis=0)
    away = z @ (spectra.values - mean) / math.sqrt(len(spectra.values) - 1)
    return np.asarray(np.clip(mean + deviation * away, *within))


Number = Callable[[str], float]
"""A number within (0, 1) by name, of one variable of one sample."""


def read_mixture(node: Node, curves: Curves) -> tuple[Callable[[Number], Any], tuple[Any, ...]]:
    """`{mixture: [CURVE, ...], shares: [N, ...], concentration: N, outside}`; returns the draw and the pure spectra."""
    keys = node.map(("mixture", "shares", "concentration", "outside"))
    spectra = read_spectra(keys["mixture"], curves, 2, _outside(keys))
    count = len(spectra.values)
    means = [n.number(0, 1e30) for n in keys["shares"].list()] if "shares" in keys else [1.0] * count
    if len(means) != count:
        raise keys["shares"].error(f"{len(means)} shares for {count} spectra")
    total = math.fsum(means)
    if not total > 0:
        raise keys["shares"].error("all shares are 0", "one above 0")
    means = [m / total for m in means]
    concentration = keys["concentration"].number(1e-3, 1e6) if "concentration" in keys else float(count)
    return lambda number: spectra.curve(shares_of(means, concentration, number) @ spectra.values), tuple(spectra.curve(v) for v in spectra.values)


def read_variability(node: Node, curves: Curves) -> tuple[Callable[[Number], Any], tuple[Any, ...]]:
    """`{variability: [CURVE, ...] or FILE, deviation: 1, within: [0, 1], outside}`; returns the draw and the spectra three deviations off the mean."""
    keys = node.map(("variability", "deviation", "within", "outside"))
    spectra = read_spectra(keys["variability"], curves, 2, _outside(keys))
    deviation = keys["deviation"].number(0, 1e3) if "deviation" in keys else 1.0
    low, high = keys["within"].numbers(2) if "within" in keys else (0.0, 1.0)
    if not low < high:
        raise keys["within"].error("'within' has no width", "the lower number first")
    mean, spread = spectra.values.mean(axis=0), spectra.values.std(axis=0, ddof=1)
    ends = tuple(spectra.curve(np.clip(mean + side * deviation * spread, low, high)) for side in (-3, 3))
    return lambda number: spectra.curve(normal_member(spectra, deviation, (low, high), number)), ends


def _outside(keys: Mapping[str, Node]) -> str | None:
    return keys["outside"].one_of(("error", "hold", "zero")) if "outside" in keys else None


__all__ = ["CampaignError", "Curves", "Spectra", "gamma", "normal_member", "read_mixture", "read_spectra", "read_variability", "shares_of"]
