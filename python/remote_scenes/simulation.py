"""Simulations: the objects of a simulation text (formats/sim_text/FORMAT.md, apps/dirsig-render/SENSORS.md), and rendering.

Wavelengths are micron, radiance W/(m2 sr um), irradiance W/(m2 um), azimuths compass degrees, places scene ENU metres.
"""
from __future__ import annotations

import datetime
from dataclasses import KW_ONLY, dataclass, field
from pathlib import Path
from typing import Any, Mapping, Sequence, Union

import xarray as xr

from .programs import Progress, run_program
from .results import Result
from .scene import PreparedScene, Time, Vector, _options, _settings
from .temperatures import open_temperatures
from .tree import CurveLike, FileName, Keys, OpenKeys, beside, write


@dataclass(kw_only=True)
class Sun(Keys):
    """The sun: by its angles, or by a date (`time_utc`), which needs a scene with an origin."""

    zenith_deg: float | None = None
    azimuth_deg: float | None = None
    time_utc: datetime.datetime | str | None = None
    irradiance: CurveLike | None = None
    half_angle_deg: float | None = None
    collimated: bool | None = None

    def keys(self) -> dict[str, Any]:
        """The keys that are written."""
        keys = super().keys()
        direction = {k: keys.pop(k) for k in ("zenith_deg", "azimuth_deg", "time_utc") if k in keys}
        return {**({"direction": direction} if direction else {}), **keys}


@dataclass(kw_only=True)
class Moon(Sun):
    """The moon; phase_deg: angle Sun-Moon-observer, 0 = full."""

    phase_deg: float | None = None


class Sky(OpenKeys):
    """The sky: `kind` None (a table), "clear", "image" or "thermal", and the keys of that kind."""

    def __init__(self, kind: str | None = None, *, radiance: CurveLike | None = None, **keys: Any) -> None:
        super().__init__(kind=kind, radiance=radiance, **keys)


class Atmosphere(OpenKeys):
    """The air: real air with `profile="us_standard"`, other programs' with `tables`, else plane-parallel layers."""


class Lamp(OpenKeys):
    """A lamp: "point", "spot" or "surface", and the keys of that kind."""

    def __init__(self, kind: str, **keys: Any) -> None:
        super().__init__(kind=kind, **keys)


@dataclass
class Band(Keys):
    """A band: by its centre, full width at half maximum and shape (gaussian, rectangular, triangular), or by its response."""

    name: str
    center_um: float | None = None
    fwhm_um: float | None = None
    shape: str | None = None
    response: CurveLike | None = None


def bands(low_um: float, high_um: float, count: int, *, fwhm_um: float | None = None, shape: str | None = None) -> list[Band]:
    """Bands with even centres from low_um to high_um; fwhm_um: as far as they are apart unless given."""
    if count < 2 or not high_um > low_um:
        raise ValueError("bands wants a range and at least two bands")
    step = (high_um - low_um) / (count - 1)
    centers = [low_um + i * step for i in range(count)]
    return [Band(f"{round(1000 * c, 3):g} nm", round(c, 9), round(fwhm_um or step, 9), shape) for c in centers]


@dataclass(kw_only=True)
class _Sensor(Keys):
    """Keys that imaging sensors share."""

    name: str | None = None
    bands: Sequence[Union[Band, Mapping[str, Any]]] = ()
    paths: int | Mapping[str, Any] | None = None
    truth: Sequence[str] | None = None
    channels: Sequence[str] | None = None
    units: str | None = None
    geolocation: bool | Mapping[str, Any] | None = None
    spectral_error: float | None = None
    spectral_step_um: float | None = None
    reference_um: float | None = None
    hero_wavelengths: int | None = None
    knots: int | None = None  # the old name of hero_wavelengths
    time_s: float | None = None
    integration_time_s: float | None = None

    kind = ""

    def keys(self) -> dict[str, Any]:
        """The keys that are written."""
        return {"kind": self.kind, **super().keys()}


@dataclass(kw_only=True)
class FrameCamera(_Sensor):
    """A camera at a place that looks at another."""

    kind = "frame_camera"
    columns: int
    rows: int
    pitch_um: float
    focal_length_mm: float
    position_m: Vector
    look_at_m: Vector
    up: Vector | None = None


@dataclass(kw_only=True)
class Orthographic(_Sensor):
    """A map, north up, with pixels of gsd_m about the place center_m (east, north)."""

    kind = "orthographic"
    columns: int
    rows: int
    gsd_m: float
    center_m: Vector = (0, 0)
    height_m: float | None = None


@dataclass(kw_only=True)
class Fisheye(_Sensor):
    """A spherical collector of size x size pixels that looks "up" or "down"."""

    kind = "fisheye"
    size: int
    position_m: Vector
    look: str
    max_angle_deg: float | None = None


@dataclass(kw_only=True)
class Points(_Sensor):
    """Instruments at points: dicts with name, quantity (irradiance, radiance, actinic_flux), position_m, normal or look."""

    kind = "point"
    collectors: Sequence[Mapping[str, Any]]


class Sensor(OpenKeys):
    """Any other kind of sensor (`dirsig-render --list-sensors`): "platform", "goniometer", "rami", a plug-in's."""

    def __init__(self, kind: str, *, name: str | None = None, bands: Sequence[Union[Band, Mapping[str, Any]]] = (),
                 **keys: Any) -> None:
        super().__init__(kind=kind, name=name, bands=list(bands) or None, **keys)


AnySensor = Union[_Sensor, Sensor, Mapping[str, Any]]


@dataclass(kw_only=True)
class Output(Keys):
    """How results are written; `also`: "geotiff", "exr"."""

    type: str | None = None
    scale: float | None = None
    units: str | None = None
    files: str | None = None
    also: Sequence[str] | None = None
    interleave: str | None = None
    preview: Any = None
    previews: Mapping[str, Any] | None = None


@dataclass
class Simulation(Keys):
    """What shines on a prepared scene, and what measures it."""

    scene: PreparedScene | FileName | None = None
    sensors: list[AnySensor] = field(default_factory=list)
    _: KW_ONLY
    scenes: Sequence[Any] | None = None
    seed: int | None = None
    max_nodes: int | None = None
    max_scatterings: int | None = None
    sun: Sun | Mapping[str, Any] | None = None
    moon: Moon | Mapping[str, Any] | None = None
    sky: Sky | Mapping[str, Any] | None = None
    lamps: Sequence[Lamp | Mapping[str, Any]] | None = None
    atmosphere: Atmosphere | Mapping[str, Any] | None = None
    earth: Mapping[str, Any] | None = None
    periodic: Mapping[str, Any] | None = None
    weather: FileName | Mapping[str, Any] | None = None
    heat: Mapping[str, Any] | None = None
    epoch: Time | None = None
    dut1_s: float | None = None
    output: Output | Mapping[str, Any] | None = None

    def write(self, path: FileName) -> Path:
        """Writes the simulation text. Texts that were not written by this package are not replaced (FileExistsError)."""
        return write(self, path)

    def check(self, path: FileName, **options: Any) -> str:
        """Writes the text and has dirsig-render check it without rendering; returns what would be rendered."""
        return run_program("dirsig-render", [self.write(path), "--dry-run", *_render_options(**options)]).stdout

    def render(self, folder: FileName, **options: Any) -> Result:
        """Writes the text beside the folder (with the ending .yaml; _simulation.yaml where a scene's text has that name) and
        renders it into the folder; see render."""
        folder = Path(folder)
        return render(self.write(beside(self, folder.with_name(folder.name + ".yaml"))), folder, **options)

    def find_temperatures(self, folder: FileName, *, progress: Progress = None, **options: Any) -> xr.Dataset:
        """Finds the temperatures that follow from `weather` and writes them into the folder (heat.h5, heat.csv, heat.html),
        without rendering; further runs take them with `heat=folder/"heat.h5"`. Returns them; see open_temperatures.
        """
        folder = Path(folder)
        text = self.write(beside(self, folder.with_name(folder.name + ".yaml")))
        run_program("dirsig-render", [text, "-o", folder, "--heat-only", *_render_options(**options)], progress)
        return open_temperatures(folder / "heat.h5")


def _render_options(*, paths: int | str | None = None, target_error: float | None = None, target_floor: float | None = None,
                    target_bands: str | None = None, time: str | None = None, seed: int | None = None,
                    threads: int | None = None, memory: str | None = None, state: bool = False, resume: bool = False,
                    more_paths: int | None = None, plugins: Sequence[FileName] = (), heat: FileName | None = None,
                    settings: Mapping[str, Any] | None = None) -> list[str]:
    error = None if target_error is None else f"{100 * target_error:.9g}%"
    return _options({"--paths": paths, "--target-error": error, "--target-floor": target_floor, "--target-bands": target_bands,
                     "--time": time, "--seed": seed, "--threads": threads, "--memory": memory, "--state": state,
                     "--resume": resume, "--more": more_paths, "--plugin": list(plugins), "--heat": heat}) + _settings(settings)


def render(text: FileName, folder: FileName, *, progress: Progress = None, **options: Any) -> Result:
    """Renders a simulation text into a folder with dirsig-render, and returns what is there.

    paths: per pixel; target_error: relative, 0.01 = 1 % (with target_floor, target_bands); time: "10min"; seed; threads;
    memory: "8GiB"; state, resume, more_paths: of runs that go on; plugins; heat: a file of temperatures that were found
    before; settings: values in place of the text's by their place (`sensors.0.columns`). InputError: it was refused; warnings are ProgramWarnings.
    """
    run = run_program("dirsig-render", [text, "-o", folder, *_render_options(**options)], progress)
    wrote = [Path(line.removeprefix("wrote ")).name for line in run.messages if line.startswith("wrote ")]
    return Result(folder, wrote)
