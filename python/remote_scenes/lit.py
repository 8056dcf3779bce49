"""Simulations within this process: the radiance that comes along rays."""
from __future__ import annotations

import os
from ctypes import POINTER, byref, c_double, c_uint8
from dataclasses import dataclass
from typing import Optional, Union

import numpy as np
import numpy.typing as npt

from .library import Numbers, Opened, SimulationInfo, c_text, doubles, library, opened, rows, told, whole


@dataclass(frozen=True)
class Radiance:
    """What comes along rays: (..., bands) each, in the shape of the rays."""

    radiance: Numbers
    """W/(m2 sr um)."""
    standard_error: Numbers
    """W/(m2 sr um)."""
    quality: npt.NDArray[np.uint8]
    """(...): flags, as in dirsig-render's quality image."""


class LitScene(Opened):
    """A simulation's scene under its lights and air, seen in the bands of one of its sensors."""

    def __init__(self, path: Union[str, os.PathLike[str]], sensor: Optional[str] = None) -> None:
        self.path = os.fspath(path)
        super().__init__(opened("rs_simulation_open", self.path, None if sensor is None else c_text(sensor, "the sensor's name")),
                         "rs_simulation_close")
        told()
        info, centre = SimulationInfo(), c_double()
        library().rs_simulation_describe(self._open, byref(info))
        names, centres = [], []
        for i in range(info.bands):
            names.append(library().rs_simulation_band(self._open, i, byref(centre)).decode())
            centres.append(centre.value)
        self.bands: tuple[str, ...] = tuple(names)
        self.wavelength_um: Numbers = np.array(centres)
        """Centres of the bands."""
        self.paths: int = info.paths
        """Of a ray at most, unless a call says otherwise."""
        self.seed: int = info.seed
        self.begin_s: float = info.begin
        """When rays are that are given no time."""

    def __enter__(self) -> "LitScene":
        return self

    def radiance(self, origin: npt.ArrayLike, direction: npt.ArrayLike, time_s: Optional[npt.ArrayLike] = None,
                 paths: Optional[int] = None, seed: Optional[int] = None) -> Radiance:
        """Radiance from where rays look, with its standard error. Places and directions are ENU (..., 3), broadcast
        against each other. paths: of each ray; without, as the sensor has it. What a result lacks is a ProgramWarning.
        Every call builds optics and lights again: ask for arrays of rays."""
        shape, (o, d) = rows("origin and direction", origin, direction)
        n = len(o)
        time = None if time_s is None else np.ascontiguousarray(np.broadcast_to(np.asarray(time_s, np.float64), shape)).reshape(-1)
        if paths is not None and whole(paths, "paths", 1 << 30) == 0:
            raise ValueError(f"paths={paths}: 1 to 2^30")
        seed = self.seed if seed is None else whole(seed, "seed", 1 << 53)
        mean, error, quality = np.empty((n, len(self.bands))), np.empty((n, len(self.bands))), np.empty(n, np.uint8)
        self._check(library().rs_simulation_radiance(self._open, n, doubles(o), doubles(d), doubles(time), paths or 0, seed,
                                                     doubles(mean), doubles(error), quality.ctypes.data_as(POINTER(c_uint8))))
        told()
        return Radiance(mean.reshape(*shape, len(self.bands)), error.reshape(*shape, len(self.bands)), quality.reshape(shape))


def open_simulation(path: Union[str, os.PathLike[str]], sensor: Optional[str] = None) -> LitScene:
    """Opens a simulation's text, as dirsig-render reads it, for the bands of a sensor (by name; without, its only one).
    InputError: what dirsig-render would refuse, or temperatures that follow from weather where a band sees them."""
    return LitScene(path, sensor)
