"""Fitted scattering functions (.sqt) within this process: evaluate, sample, integrate whole arrays of directions."""
from __future__ import annotations

import json
import operator
import os
from ctypes import byref
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from .library import Numbers, Opened, SqtInfo, doubles, library, opened, rows

_DIRAC = {0: None, 1: "mirror", 2: "retro", 3: "through"}


def direction(zenith_deg: npt.ArrayLike, azimuth_deg: npt.ArrayLike = 0.0) -> Numbers:
    """Unit vectors (..., 3) of angles from the normal and around it (mathematical: from x towards y), in degrees."""
    theta, phi = np.broadcast_arrays(np.radians(np.asarray(zenith_deg, float)), np.radians(np.asarray(azimuth_deg, float)))
    return np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)


class FittedFunction(Opened):
    """A BRDF, BSDF, phase function or lamp that sqt-fit has made. Directions are unit vectors (..., 3) that point away from
    the surface, z its normal; they are broadcast against each other. Answers have the channels last, in the order of
    `wavelength_um`, and are those of sqt-inspect to the last bit."""

    def __init__(self, path: Union[str, os.PathLike[str]]) -> None:
        self.path = os.fspath(path)
        super().__init__(opened("rs_sqt_open", self.path), "rs_sqt_close")
        info = SqtInfo()
        library().rs_sqt_describe(self._open, byref(info))
        self.wavelength_um: Numbers = np.array(info.wavelength_um[:info.channels])
        """At which the shape is kept, um."""
        self.total_um: Numbers = np.array(info.total_um[:info.totals])
        """Of the finer table of totals, um, ascending."""
        self.cosine_weighted: bool = bool(info.cosine)
        """Whether it is a BSDF: the weight of a direction is f |cos|. Otherwise it is f."""
        self.both_sides: bool = bool(info.sphere)
        """Whether light comes from both sides."""
        self.dirac: Optional[str] = _DIRAC[info.dirac]
        """Where a Dirac lobe points: "mirror", "retro", "through" or None."""
        self.header: dict[str, Any] = json.loads(library().rs_sqt_header(self._open).decode())
        """What was fitted, how and from what, as the file has it (formats/sqt/FORMAT.md)."""

    def __enter__(self) -> "FittedFunction":
        return self

    @property
    def errors(self) -> Optional[dict[str, Any]]:
        """The errors of the fit that the file states: `overall` and `channels` with `l1`, `rmse` and others (sqt-fit's
        USAGE.md); None where it states none."""
        return self.header.get("errors")

    def evaluate(self, out: npt.ArrayLike, in_: npt.ArrayLike) -> Numbers:
        """f(out, in), 1/sr, without cosine: (..., channels)."""
        return self._ask("rs_sqt_evaluate", len(self.wavelength_um), out, in_)

    def weight(self, out: npt.ArrayLike, in_: npt.ArrayLike) -> Numbers:
        """f |cos in| of a BSDF, else f; 1/sr: (..., channels)."""
        f = self.evaluate(out, in_)
        return f * np.abs(np.asarray(in_, float)[..., 2, None]) if self.cosine_weighted else f

    def total(self, out: npt.ArrayLike) -> Numbers:
        """The integral of the weight over `in`, Dirac lobe included: of a reflector the directional-hemispherical
        reflectance. (..., channels)."""
        return self._ask("rs_sqt_total", len(self.wavelength_um), out)

    def magnitude(self, out: npt.ArrayLike) -> Numbers:
        """The same at the wavelengths `total_um`: (..., totals)."""
        return self._ask("rs_sqt_magnitude", len(self.total_um), out)

    def albedo(self, zeniths: int = 32, azimuths: int = 16) -> Numbers:
        """The mean of the total over all directions of the upper side, weighted by their cosine: of a reflector its
        albedo under an even sky (bihemispherical reflectance). By Gauss-Legendre quadrature in the squared cosine,
        midpoints around the normal. (channels)."""
        x, w = np.polynomial.legendre.leggauss(zeniths)
        theta = np.degrees(np.arccos(np.sqrt(0.5 * (x + 1))))
        phi = (np.arange(azimuths) + 0.5) * 360 / azimuths
        mean = self.total(direction(theta[:, None], phi[None, :])).mean(axis=1)
        return np.asarray(np.tensordot(0.5 * w, mean, axes=1))

    def sample(self, out: npt.ArrayLike, channel: int = 0, u: Optional[npt.ArrayLike] = None,
               seed: Optional[int] = None) -> tuple[Numbers, Numbers]:
        """Directions drawn for each of `out`, (..., 3), and their densities, 1/sr, (...): E[weight / density] = total, but
        for the Dirac lobe. u: three numbers in [0, 1) each (..., 3); without, random ones of the seed. A draw may fail:
        NaN with density 0."""
        if u is None:
            shape = np.shape(out)
            u = np.random.default_rng(seed).random(shape if shape else (3,))
        shape, (o, numbers) = rows("out and u", out, u)
        drawn, density = np.empty_like(o), np.empty(len(o))
        self._check(library().rs_sqt_sample(self._open, len(o), doubles(o), self._channel(channel), doubles(numbers),
                                            doubles(drawn), doubles(density)))
        return drawn.reshape(*shape, 3), density.reshape(shape)

    def density(self, out: npt.ArrayLike, in_: npt.ArrayLike) -> Numbers:
        """The density with which `sample` draws, 1/sr: (..., channels)."""
        return self._ask("rs_sqt_pdf", len(self.wavelength_um), out, in_)

    def dirac_lobe(self, out: npt.ArrayLike, channel: int = 0) -> tuple[Numbers, Numbers]:
        """The directions of the Dirac lobe (..., 3) and its part of the total (...); NaN and 0 where there is none."""
        shape, (o,) = rows("out", out)
        there, part = np.empty_like(o), np.empty(len(o))
        self._check(library().rs_sqt_dirac(self._open, len(o), doubles(o), self._channel(channel), doubles(there), doubles(part)))
        return there.reshape(*shape, 3), part.reshape(shape)

    def _channel(self, channel: int) -> int:
        if not 0 <= operator.index(channel) < len(self.wavelength_um):
            raise IndexError(f"there is no channel {channel}; channels are 0 to {len(self.wavelength_um) - 1}")
        return channel

    def _ask(self, function: str, channels: int, *directions: npt.ArrayLike) -> Numbers:
        shape, arrays = rows("directions", *directions)
        answer = np.empty((len(arrays[0]), channels))
        self._check(getattr(library(), function)(self._open, len(answer), *map(doubles, arrays), doubles(answer)))
        return answer.reshape(*shape, channels)


def open_sqt(path: Union[str, os.PathLike[str]]) -> FittedFunction:
    """Opens a fitted function. InputError: no such file, or a damaged one."""
    return FittedFunction(path)
