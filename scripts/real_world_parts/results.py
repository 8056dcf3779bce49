"""What a data set yields: rows of the page, pictures, and remarks on what explains the rest."""
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np


@dataclass
class Context:
    """What a run is given. continuum: a file of MT_CKD for water vapour, or None; held_out: run what was kept apart as well."""
    data: Path
    program: Path
    work: Path
    build: Path
    continuum: Path = None
    held_out: bool = False
    paths: int = 500


@dataclass
class Row:
    """One comparison. bias, rms: mean and root mean square of ours less the instrument's, in `unit`; share: of the values within two
    standard deviations of both together, NaN where no uncertainty is known."""
    data: str
    place: str
    bands: str
    given: str
    fitted: str
    unit: str
    bias: float
    rms: float
    share: float
    rest: str
    count: int = 0
    held_out: bool = False
    details: dict = field(default_factory=dict)


@dataclass
class Result:
    rows: list = field(default_factory=list)
    pictures: dict = field(default_factory=dict)  # name -> SVG
    notes: list = field(default_factory=list)     # lines of Markdown under the table
    seconds: float = 0


def judged(ours, theirs, sigma=None):
    """bias, rms, share within 2 sigma of values in one unit. sigma: of ours and theirs in quadrature."""
    difference = np.asarray(ours) - np.asarray(theirs)
    share = np.nan if sigma is None else float(np.mean(abs(difference) <= 2 * np.asarray(sigma)))
    return dict(bias=float(difference.mean()), rms=float(np.sqrt((difference**2).mean())), share=share, count=difference.size)


def columns(path, count):
    """The first columns of a text of numbers; `#` starts a comment. Error: names the file and what is wrong."""
    try:
        table = np.loadtxt(path, ndmin=2)
    except (OSError, ValueError) as fault:
        raise RuntimeError("%s: not a table of numbers (%s)" % (path, fault)) from None
    if table.shape[1] < count:
        raise RuntimeError("%s: %d columns, %d are needed" % (path, table.shape[1], count))
    return table[:, :count].T
