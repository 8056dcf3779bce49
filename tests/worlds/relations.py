"""Relations: what must hold between a world and what is made of it.

make(world, rng) -> Case, or None where the world has nothing that the relation can take hold of. Same world and rng: same case.
"""
import math
from dataclasses import dataclass, field
from typing import Callable, Dict, FrozenSet, List, Optional

import change
import change_sensor
import change_stokes
import judge
import lidar
import rewrite
from world import band_mean, planck


@dataclass
class Case:
    """sum of coefficient x picture of world = expected; terms: (coefficient, world[, {sensor's name: name in the first term}])."""
    terms: List
    expected: Optional[Dict] = None
    tolerance: float = judge.TOLERANCE
    note: str = ""
    floor: float = 0.0                   # radiance below which nothing is told apart (bins are chosen for what shines brightest)
    exact: Optional[Callable] = None     # in place of the sum: exact(programs, folder, seed) -> text of what is wrong, or ''


SECONDS = 0.12  # of CPU that the paths of a term take


@dataclass(frozen=True)
class Relation:
    name: str
    make: Callable
    weight: float = 1
    traits: FrozenSet[str] = field(default_factory=frozenset)
    paths: int = 4
    seconds: float = SECONDS
    quick: bool = True                  # among the relations of the default tests


def pixels_of(sensor):
    kind = sensor["kind"]
    if kind == "point":
        return len(sensor["collectors"])
    if kind == "fisheye":
        return sensor["size"] ** 2
    if kind == "platform":
        return None
    return sensor["columns"] * sensor["rows"]


class Furnace(dict):
    """Expected picture of any shape: factor x B; behind its bands so many times as many of which nothing is expected."""

    def __init__(self, world, dark=0):
        super().__init__()
        self.facts, self.dark = world.facts, dark

    def __missing__(self, name):
        factors, facts = self.facts["factors"][name], self.facts
        half = facts["width"] / 2

        class Band:
            def __init__(self, center, scale=1):
                self.value = scale * band_mean(center - half, center + half, lambda w: planck(w, facts["kelvin"]))

            def __getitem__(self, i):
                return self.value * (factors[i] if isinstance(factors, list) else factors)

        centers = (facts["wavelength"], round(facts["wavelength"] * 1.2, 4))[:facts.get("bands", 1) if self.dark else 2]
        return [Band(w) for w in centers] + [Band(w, 0) for _ in range(self.dark) for w in centers]


def furnace(world, rng):
    """All at one temperature under a sky of its blackbody: every pixel is B, irradiances pi B, actinic fluxes 4 pi B."""
    return Case([(1, world)], Furnace(world), note="B(T)")


def pair(changed, note, tolerance=judge.TOLERANCE):
    return lambda world, partner: Case([(1, world), (-1, partner)], tolerance=tolerance, note=note)


def same_as(make):
    """Relation of a world with one that must look the same: make(world, rng) -> (partner, note) or None."""
    def case(world, rng):
        made = make(world.copy(), rng)
        return made and Case([(1, world), (-1, made[0])], note=made[1])
    case.__doc__ = make.__doc__
    return case


def superposition(world, rng):
    """Lights A and B together and none: what A alone and B alone give in all."""
    lights = change.lights_of(world)
    if not lights:
        return None
    first = {k for k in lights if rng.random() < 0.5} or {lights[0]}
    if len(first) == len(lights) and len(lights) > 1:
        first.discard(lights[-1])
    a, b, none = (change.with_lights(world, keep) for keep in (first, set(lights) - first, set()))
    if set(lights) == first and world.sim.get("sky", {}).get("kind") == "thermal":
        return None
    if set(lights) == first:  # one light: against twice of it
        return Case([(1, change.brighter(world, 2)), (-2, world), (1, none)], note="twice the light")
    return Case([(1, world), (1, none), (-1, a), (-1, b)], note=f"{sorted(first)} and the rest of {lights}")


def sensors_agree(world, rng):
    """A framing camera and a platform's at the same place, or a pixel of a map or camera and a point that looks along it."""
    made = change_sensor.other_sensor(world.copy(), rng)
    return made and Case([(1, made[0]), (-1, made[1], made[3])], note=made[2])


def channels(world, rng):
    """Parts of the light add up to all of it, pixel by pixel, within rounding."""
    cameras = [s for s in world.sim["sensors"] if s["kind"] in ("frame_camera", "orthographic", "fisheye")]
    if not cameras:
        return None
    partner = world.copy()
    partner.sim["sensors"] = [dict(s, channels=["single_scattering", "multiple_scattering", "unscattered", "direct", "diffuse", "adjacency", "emitted"])
                              for s in world.copy().sim["sensors"] if s["name"] == cameras[0]["name"]]

    def exact(programs, folder, seed):
        picture = programs.pictures(partner, folder, [seed])[0][cameras[0]["name"]]
        bands, v = len(cameras[0]["bands"]), picture.values
        for b in range(bands):
            for i, all_light in enumerate(v[b]):
                part = [v[b + bands * k][i] for k in range(8)]
                size = max(sum(abs(p) for p in part[3:7]), abs(all_light))
                for what, total in (("single + multiple", part[1] + part[2]), ("unscattered + direct + diffuse + adjacency", sum(part[3:7]))):
                    if abs(total - all_light) > 2e-5 * size:
                        return f"{what} = {total:.7g}, all {all_light:.7g} (pixel {i}, band {b})"
                if part[7] > all_light * (1 + 1e-5) + 1e-5 * size and part[6] >= 0:
                    return f"emitted {part[7]:.7g} of {all_light:.7g} (pixel {i}, band {b})"
        return ""
    return Case([(1, partner)], exact=exact, note="parts of the light")


def reciprocity(world, rng):
    """A lamp that is a point and a small sphere that receives, in each other's places: the same flux."""
    a, b = change_sensor.swapped(world, rng)
    return Case([(1, a), (-1, b)], note="lamp and receiver swapped")


def same_bytes(world, rng):
    """Threads, parts, ranks, little memory, what is loaded, continued runs: same bytes."""
    # Under an atmosphere --more has other noise than a run of all paths at once (libs/transport/known_way.h).
    whats = ("threads", "parts", "memory", "ranks") + (() if "atmosphere" in world.sim else ("more",))
    what = rng.choice(whats)

    def exact(programs, folder, seed):
        return change_sensor.bytes_differ(programs, world, folder, seed, what)
    return Case([(1, world)], exact=exact, note=what)


def radar(world, rng):
    """A laser radar in place of the sensors: twice the energy, another gate or other bins, the same world in other words."""
    made = rng.choice((lidar.twice_the_energy, lidar.moved_gate, lidar.same_world, lidar.same_world))(world, rng)
    return made and Case(made[0], note=made[1])


def radar_ends(world, rng):
    """Paths from the laser and from the receiver, or all bins and a camera under a lamp in the laser's place."""
    terms, note = (lidar.steady_image if rng.random() < 0.4 else lidar.other_start)(world, rng)
    return Case(terms, note=note, tolerance=LAMP if "camera" in note else judge.TOLERANCE)


def stokes_furnace(world, rng):
    """All at one temperature: every pixel's Stokes vector is (B, 0, 0, 0)."""
    made = change_stokes.furnace(world)
    return made and Case([(1, made)], Furnace(world, 3), note="(B, 0, 0, 0)")


def stokes_scalar(world, rng):
    """Where nothing polarises, I is what a camera without polarisation sees."""
    made = change_stokes.beside_scalar(world)
    return made and Case([(1, made[0]), (-1, made[1])], note="I and a camera without polarisation")


def stokes_roll(world, rng):
    """A camera's roll turns the angle of polarisation and leaves its degree."""
    made = change_stokes.rolled(world, rng)
    return made and Case([(1, made[0]), (made[1], made[2])], note=made[3])


LAMP = 5e-4  # a spot lamp is even over angles, a top hat over the plane: 1.5 times the square of 10 mrad at its edge; and wavelengths of a band


def frozen(*traits):
    return frozenset(traits)


RELATIONS = {r.name: r for r in (
    Relation("furnace", furnace, 5, frozen("furnace"), seconds=2 * SECONDS),
    Relation("body_of_nothing", same_as(change.body_of_nothing), 4),
    Relation("body_of_the_same", same_as(change.body_of_the_same), 2.5, frozen("wants_media")),
    Relation("bystander", same_as(change.bystander), 2),
    Relation("rigid_motion", same_as(change.rigid_motion), 3, frozen("moved")),
    Relation("regrouping", same_as(change.regroup), 2, frozen("stars")),
    Relation("splitting", same_as(change.split), 2),
    Relation("scaled", same_as(change.scaled), 2, frozen("no_air", "no_profile", "moved")),
    Relation("superposition", superposition, 3, frozen("stars")),
    Relation("substitution", same_as(rewrite.substitute), 4),
    Relation("switches", same_as(change.switches), 2),
    Relation("time_shift", same_as(change.time_shift), 1, frozen("later")),
    Relation("channels", channels, 1, frozen("wants_camera", "stars")),
    Relation("sensors_agree", sensors_agree, 2, frozen("wants_camera")),
    Relation("periodic", same_as(change.periodic_copies), 1.5, frozen("periodic", "moved", "still_world", "no_room", "no_profile")),
    Relation("reciprocity", reciprocity, 2, frozen("reciprocal", "still_world", "no_profile"), seconds=5 * SECONDS),
    Relation("same_bytes", same_bytes, 1, frozen("stars")),
    Relation("stokes_furnace", stokes_furnace, 2, frozen("furnace", "wants_camera", "no_air"), seconds=2 * SECONDS, quick=False),
    Relation("stokes_scalar", stokes_scalar, 1, frozen("wants_camera", "stars", "no_air", "no_profile"), quick=False),
    Relation("stokes_roll", stokes_roll, 1, frozen("wants_camera", "stars", "no_air"), seconds=2 * SECONDS, quick=False),
    Relation("radar", radar, 2, frozen("later"), paths=8, seconds=2 * SECONDS, quick=False),
    Relation("radar_ends", radar_ends, 2, frozen("reciprocal", "still_world", "no_profile"), paths=8, seconds=2 * SECONDS, quick=False),
)}


def relation_of(seed, only=None):
    """The relation of a world by its seed: by weights, in an order that serves every run of seeds alike. only: its name, or 'quick':
    among those of the default tests."""
    if only and only != "quick":
        return RELATIONS[only]
    among = [r for r in RELATIONS.values() if r.quick or not only]
    total = sum(r.weight for r in among)
    at = (seed * 0.6180339887498949) % 1.0 * total
    for r in among:
        at -= r.weight
        if at < 0:
            return r
    return RELATIONS["furnace"]
