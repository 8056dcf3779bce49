"""Scenes: the objects of a scene text (formats/scene_text/FORMAT.md), and what scene-prep makes of them.

Lengths are metres, angles degrees, wavelengths micron, places scene ENU (x east, y north, z up).
"""
from __future__ import annotations

import datetime
import json
from dataclasses import KW_ONLY, dataclass, field
from pathlib import Path
from typing import Any, Mapping, Sequence, Union

from .errors import Finding, InputError, with_keys
from .programs import Progress, run_program
from .tree import CurveLike, FileName, Keys, OpenKeys, beside, plain, write

Time = Union[float, str, datetime.datetime]
"""Seconds, or a date: a datetime with a time zone, or text as 2026-06-21T10:30:00Z."""
Vector = Sequence[float]


@dataclass
class Origin(Keys):
    """Where on the Earth the scene's origin is (WGS84)."""

    latitude_deg: float
    longitude_deg: float
    height_m: float | None = None


class Material(OpenKeys):
    """A surface: a scattering model with its parameters (`scene-prep --list-models`), curves where these are spectral.

    Material("lambert", reflectance=0.3, temperature_k=290)
    """

    def __init__(self, model: str | None = None, *, temperature_k: float | None = None, temperature: Any = None,
                 thermal: Any = None, map: str | None = None, maps: Sequence[str] | None = None, inside: str | None = None,
                 outside: str | None = None, description: str | None = None, **parameters: Any) -> None:
        super().__init__(model=model, **parameters, temperature_k=temperature_k, temperature=temperature, thermal=thermal,
                         map=map, maps=maps, inside=inside, outside=outside, description=description)


@dataclass(kw_only=True)
class Medium(Keys):
    """What fills space: two of absorption, scattering, extinction (1/m) and albedo, or one of the first two."""

    absorption: CurveLike | None = None
    scattering: CurveLike | None = None
    extinction: CurveLike | None = None
    albedo: CurveLike | None = None
    phase: Mapping[str, Any] | None = None
    index: CurveLike | None = None
    temperature_k: float | None = None
    priority: int | None = None
    description: str | None = None


class Object(OpenKeys):
    """A thing that may be placed. The functions below make the usual kinds; any keys of the text's grammar may be given."""


def plane(width: float = 0, depth: float = 0, *, material: str | None = None) -> Object:
    """A level plane about the origin, m; both 0 = without end."""
    return Object(plane={"width": width, "depth": depth}, material=material)


def disk(radius: float, *, inner_radius: float | None = None, material: str | None = None) -> Object:
    """A level disk about the origin, m."""
    return Object(disk={"radius": radius, **({"inner_radius": inner_radius} if inner_radius else {})}, material=material)


def box(low: Vector, high: Vector, *, material: str | None = None) -> Object:
    """A box between two corners, m."""
    names = ("x0", "y0", "z0", "x1", "y1", "z1")
    return Object(box=dict(zip(names, (*low, *high), strict=True)), material=material)


def layer(bottom: float, top: float, *, material: str | None = None) -> Object:
    """A layer between two heights, m, without end."""
    return Object(box={"z0": bottom, "z1": top}, material=material)


def sphere(radius: float, *, material: str | None = None) -> Object:
    """A sphere about the origin, m."""
    return Object(sphere={"radius": radius}, material=material)


def cylinder(radius: float, height: float, *, capped: bool | None = None, material: str | None = None) -> Object:
    """An upright cylinder, m."""
    return Object(cylinder={"radius": radius, "height": height, **({} if capped is None else {"capped": capped})},
                  material=material)


def mesh(file: FileName, *, material: str | None = None, materials: Mapping[str, str] | None = None,
         unit_m: float | None = None, up: str | None = None, normals: str | None = None, **more: Any) -> Object:
    """An OBJ file. materials: what its `usemtl` names stand for."""
    return Object(obj=file, material=material, materials=materials, unit_m=unit_m, up=up, normals=normals, **more)


def terrain(file: FileName, *, material: str | None = None, **more: Any) -> Object:
    """A raster of heights: GeoTIFF, or with `local={"origin": [x, y], "gsd": g}` any image."""
    return Object(terrain=file, material=material, **more)


@dataclass
class Placement(Keys):
    """An object or group at a place: scaled, then rotated, then translated; `tag` names it in truth images."""

    place: str | None = None
    _: KW_ONLY
    scale: float | Vector | None = None
    rotate: Mapping[str, Any] | Sequence[Mapping[str, Any]] | None = None
    translate: Vector | None = None
    matrix: Sequence[Any] | None = None
    material: str | None = None
    tag: str | None = None
    on: str | None = None
    table: FileName | None = None
    scatter: Mapping[str, Any] | None = None
    motion: Mapping[str, Any] | None = None
    appears: Time | None = None
    disappears: Time | None = None
    schedule: Any = None
    traffic: FileName | None = None


@dataclass
class Scene(Keys):
    """A scene. `materials`, `objects` and so on are dicts by name; `add` fills in an object and its placement at once."""

    name: str | None = None
    _: KW_ONLY
    description: str | None = None
    author: str | None = None
    origin: Origin | None = None
    curvature: str | Mapping[str, Any] | None = None
    epoch: datetime.datetime | str | None = None
    times_s: Sequence[float] | None = None
    windows_um: Sequence[Sequence[float]] | None = None
    curves: dict[str, CurveLike] = field(default_factory=dict)
    materials: dict[str, Union[Material, Mapping[str, Any]]] = field(default_factory=dict)
    media: dict[str, Union[Medium, Mapping[str, Any]]] = field(default_factory=dict)
    ambient: str | None = None
    grids: dict[str, Mapping[str, Any]] = field(default_factory=dict)
    volumes: list[Mapping[str, Any]] = field(default_factory=list)
    maps: dict[str, Mapping[str, Any]] = field(default_factory=dict)
    objects: dict[str, Union[Object, Mapping[str, Any]]] = field(default_factory=dict)
    groups: dict[str, list[Union[Placement, Mapping[str, Any]]]] = field(default_factory=dict)
    world: list[Union[Placement, Mapping[str, Any]]] = field(default_factory=list)

    def keys(self) -> dict[str, Any]:
        """The keys that are written; empty dicts and lists are not."""
        given = super().keys().items()
        return {"scene": 1, **{k: v for k, v in given if k == "world" or not isinstance(v, (dict, list)) or v}}

    def add(self, name: str, thing: Object | None = None, *, material: Material | None = None, **placement: Any) -> Placement:
        """Places an object or group of this name in the world, and returns the placement. thing: the object, if it is new;
        material: a new one of the object's name, which the object gets; `thing` itself stays as it is. The rest are keys of
        Placement. ValueError for a name that something else has already.
        """
        if material is not None:
            if thing is None:
                raise ValueError(f"the material of '{name}' needs its object beside it")
            if isinstance(material, str):
                raise TypeError(f"material of '{name}': a Material; an object names one that is there itself, as "
                                f"plane(material={material!r})")
            thing = type(thing)(**{**thing.__dict__, "material": name})
            self._put(self.materials, "materials", name, material)
        if thing is not None:
            self._put(self.objects, "objects", name, thing)
        placed = Placement(place=name, **placement)
        self.world.append(placed)
        return placed

    @staticmethod
    def _put(table: dict[str, Any], kind: str, name: str, thing: Any) -> None:
        if name in table and plain(table[name]) != plain(thing):
            raise ValueError(f"{kind} has another '{name}' already; give this one a name of its own, or set {kind}['{name}']")
        table[name] = thing

    def write(self, path: FileName) -> Path:
        """Writes the scene text. Texts that were not written by this package are not replaced (FileExistsError)."""
        return write(self, path)

    def check(self, path: FileName, **options: Any) -> Report:
        """Writes the text and has scene-prep check all of it; see check_scene."""
        return check_scene(self.write(path), **options)

    def prepare(self, path: FileName, **options: Any) -> PreparedScene:
        """Writes the text beside `path` (with the ending .yaml; _scene.yaml where a simulation's text has that name) and prepares
        it as `path` (.h5); see prepare_scene."""
        return prepare_scene(self.write(beside(self, Path(path).with_suffix(".yaml"))), path, **options)


@dataclass(frozen=True)
class Report:
    """What scene-prep found. `accepted`: the scene can be rendered."""

    accepted: bool
    errors: int
    warnings: int
    findings: tuple[Finding, ...]

    def __str__(self) -> str:
        verdict = "accepted" if self.accepted else "refused"
        return "\n".join([*(str(f) for f in self.findings), f"{verdict} ({self.errors} errors, {self.warnings} warnings)"])


@dataclass(frozen=True)
class PreparedScene:
    """A prepared scene (.h5). `findings`: what was reported when it was made; empty when it was up to date."""

    path: Path
    findings: tuple[Finding, ...] = ()

    def __fspath__(self) -> str:
        return str(self.path)

    def summary(self) -> str:
        """What the scene holds, as text."""
        return run_program("scene-prep", [self.path, "--summary"]).stdout

    def raycast(self, origin_m: Vector, direction: Vector) -> str:
        """What a ray meets, as text."""
        return run_program("scene-prep", [self.path, "--raycast", " ".join(f"{v!r}" for v in (*origin_m, *direction))]).stdout

    def quick_look(self, path: FileName, *, at: str | None = None, size_m: float | None = None, pixels: int | None = None,
                   azimuth_elevation_deg: tuple[float, float] | None = None) -> Path:
        """A picture (PNG), from above or from a side. at: an object, a tag, or "X Y [Z]", which needs a size."""
        options = _options({"--look-at": at, "--look-size": size_m, "--pixels": pixels})
        if azimuth_elevation_deg:
            options += ["--look-from", "{!r} {!r}".format(*azimuth_elevation_deg)]
        run_program("scene-prep", [self.path, "--quick-look", path, *options])
        return Path(path)


def _options(values: Mapping[str, Any]) -> list[str]:
    """Options of a command line; None and False are left out, True is a flag."""
    out: list[str] = []
    for name, value in values.items():
        for one in value if isinstance(value, (list, tuple)) else [value]:
            if one is not None and one is not False:
                out += [name] if one is True else [name, str(one)]
    return out


def _settings(settings: Mapping[str, Any] | None) -> list[str]:
    """`--set` of each: YAML on one line, of which JSON is a part."""
    return [part for k, v in (settings or {}).items() for part in ("--set", f"{k}={json.dumps(plain(v, k))}")]


def prepare_scene(text: FileName, path: FileName, *, strict: bool = False, repair: bool = False,
                  search: Sequence[FileName] = (), mute: Sequence[str] = (), compress: str | None = None,
                  settings: Mapping[str, Any] | None = None, force: bool = False, progress: Progress = None) -> PreparedScene:
    """Prepares a scene text as `path` (.h5) with scene-prep. search: folders in which named files are also looked for;
    settings: values in place of the text's, by their place (`materials.grass.reflectance`). Work is skipped when nothing
    changed. InputError: the scene was refused; warnings are ProgramWarnings.
    """
    options = _options({"--strict": strict, "--repair": repair, "--path": list(search), "--mute": list(mute),
                        "--compress": compress, "--force": force})
    run = run_program("scene-prep", [text, "-o", path, *options, *_settings(settings)], progress)
    return PreparedScene(Path(path), run.findings)


def check_scene(text: FileName, *, strict: bool = False, search: Sequence[FileName] = (), mute: Sequence[str] = (),
                settings: Mapping[str, Any] | None = None) -> Report:
    """Has scene-prep check a scene text and everything it names, and returns all findings. Nothing is written."""
    options = _options({"--strict": strict, "--path": list(search), "--mute": list(mute)})
    try:
        text_of_report = run_program("scene-prep", [text, "--report", "-", *options, *_settings(settings)]).stdout
    except InputError as refused:
        if not refused.stdout:  # the text itself could not be read
            return Report(False, len(refused.findings), 0, refused.findings)
        text_of_report = refused.stdout
    report = json.loads(text_of_report)
    findings = []
    for issue in report["issues"]:
        for e in issue["examples"] or [{"file": issue["asset"], "line": 0, "column": 0, "message": issue["summary"]}]:
            findings.append(Finding(issue["severity"], e["message"], e["file"], e["line"], e["column"], issue["code"],
                                    issue["hint"], issue["count"]))
    return Report(report["verdict"] == "accepted", report["errors"], report["warnings"], with_keys(findings))
