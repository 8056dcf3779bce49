"""Faults that random worlds have found, each as a small world with what is right. They are run by `run --known` and the default tests.

Each is a Case as relations make them: pictures of worlds against each other, against a blackbody or against a closed form.
"""
import math

from relations import Case
from world import World, planck

W = 0.55


def world(scene, sim, files=None):
    w = World()
    w.scene.update(scene)
    w.sim.update(sim)
    w.files = files or {}
    return w


def camera(position, target, focal_mm, paths, **keys):
    return {"kind": "frame_camera", "name": "f", "columns": 6, "rows": 4, "pitch_um": 200, "focal_length_mm": focal_mm, "position_m": position, "look_at_m": target,
            "up": [0, 0, 1], "paths": paths, "truth": [], "spectral_error": 1e-5, "bands": [BAND], **keys}


BAND = {"name": "b", "center_um": W, "fwhm_um": 0.002, "shape": "rectangular"}
KELVIN = 3000.0
WARM = {"temperature_k": KELVIN}
SKY = {"radiance": {"wavelength_um": [0.54, 0.545, 0.549, 0.55, 0.551, 0.555, 0.56], "value": [planck(w, KELVIN) for w in (0.54, 0.545, 0.549, 0.55, 0.551, 0.555, 0.56)],
                    "outside": "hold"}, "full_sphere": True}
QUAD = "v -0.5 -0.5 0\nv 0.5 -0.5 0\nv 0.5 0.5 0\nv -0.5 0.5 0\nf 1 4 3 2\n"


class Even(dict):
    """One value for every pixel."""

    def __init__(self, value):
        super().__init__()
        self.value = value

    def __missing__(self, name):
        outer = self

        class All:
            def __getitem__(self, i):
                return outer.value
        return [All()]


def lamp_mesh_beside_sphere():
    """A square metre that glows downwards, 2 m over a receiver, with a black ball far off: 4 L A times the view factor."""
    scene = {"materials": {"dark": {"model": "lambert", "reflectance": 0}, "glow": {"model": "lambert", "reflectance": 0}},
             "objects": {"ball": {"sphere": {"radius": 0.1}, "material": "dark"}, "panel": {"obj_text": QUAD, "material": "glow"}},
             "world": [{"place": "ball", "translate": [50, 0, 0]}, {"place": "panel", "translate": [0, 0, 2]}]}
    sim = {"lamps": [{"kind": "surface", "material": "glow", "radiance": 100}],
           "sensors": [{"kind": "point", "name": "m", "paths": 2048, "bands": [BAND], "truth": [], "collectors": [
               {"name": "level", "quantity": "irradiance", "position_m": [0, 0, 0], "normal": [0, 0, 1]}]}]}
    a = 0.5 / 2  # half edge over distance; H. C. Hottel: corner element against a parallel rectangle, four times
    quarter = (a / math.hypot(1, a)) * math.atan(a / math.hypot(1, a)) / math.pi
    return Case([(1, world(scene, sim))], Even(4 * quarter * math.pi * 100))


def pair(scene, sim, without):
    """With and without the object `without` in the world."""
    less = {**scene, "world": [p for p in scene["world"] if p["place"] != without]}
    return Case([(1, world(scene, sim)), (-1, world(less, sim))])


def layer_in_layered_air():
    """A layer of next to nothing over flat water and its bed, in layered air."""
    scene = {"media": {"b": {"absorption": 1e-6}, "w": {"absorption": 0.7, "index": 1.33}},
             "materials": {"b": {"inside": "b"}, "top": {"model": "dielectric", "inside": "w"}, "bed": {"model": "lambert", "reflectance": 0.3}},
             "objects": {"b": {"box": {"z0": 0.5, "z1": 2}, "material": "b"}, "top": {"plane": {"width": 0, "depth": 0}, "material": "top"},
                         "bed": {"plane": {"width": 0, "depth": 0}, "material": "bed"}},
             "world": [{"place": "top"}, {"place": "bed", "translate": [0, 0, -1.5]}, {"place": "b", "translate": [0, 0, 1.7]}]}
    air = {"heights_m": [0, 1000], "temperature_k": [280], "rayleigh": False}
    return pair(scene, {"sky": {"radiance": 100}, "atmosphere": air, "sensors": [camera([6, 0, 4], [0, 0, 1], 4, 512)]}, "b")


def layer_in_profile_air():
    """The same over a pit of four walls, in real air."""
    wall = {"model": "lambert", "reflectance": 0.8}
    scene = {"media": {"b": {"absorption": 1e-6}}, "materials": {"w": wall, "edge": {"inside": "b"}},
             "objects": {"f": {"plane": {"width": 2, "depth": 2}, "material": "w"}, "l": {"box": {"z0": 0.5, "z1": 2}, "material": "edge"},
                         "wx": {"box": {"x0": -1.1, "y0": -1.1, "z0": -4, "x1": -1, "y1": 1.1, "z1": 0}, "material": "w"},
                         "wy": {"box": {"x0": -1.1, "y0": -1.1, "z0": -4, "x1": 1.1, "y1": -1, "z1": 0}, "material": "w"}},
             "world": [{"place": "f", "translate": [0, 0, -4]}, {"place": "wx"}, {"place": "wx", "translate": [2.1, 0, 0]}, {"place": "wy"},
                       {"place": "wy", "translate": [0, 2.1, 0]}, {"place": "l"}]}
    air = {"profile": "us_standard", "gases": "none", "streams": 4, "ground_albedo": 0.2, "aerosol": {"model": "rural", "visibility_km": 10}}
    sun = {"direction": {"zenith_deg": 20, "azimuth_deg": 90}, "irradiance": 1000}
    return pair(scene, {"sun": sun, "atmosphere": air, "sensors": [camera([0, 0.2, 9], [0, 0, -4], 9, 64)]}, "l")


def ball_in_pool():
    """A ball of the same water that names the water as its outside, under a warm dome: as if it were not there."""
    water = {"absorption": 0.3, "scattering": 0, "index": 1.33}
    scene = {"media": {"w": water, "g": dict(water)},
             "materials": {"top": {"model": "dielectric", "inside": "w"}, "bed": {"model": "lambert", "reflectance": 0.5},
                           "ball": {"model": "dielectric", "inside": "g", "outside": "w"}, "room": {"model": "lambert", "reflectance": 0, **WARM}},
             "objects": {"top": {"plane": {"width": 0, "depth": 0}, "material": "top"}, "bed": {"plane": {"width": 0, "depth": 0}, "material": "bed"},
                         "ball": {"sphere": {"radius": 0.4}, "material": "ball"}, "room": {"sphere": {"radius": 25}, "material": "room"}},
             "world": [{"place": "top"}, {"place": "bed", "translate": [0, 0, -1.5]}, {"place": "ball", "translate": [0, 0, -0.7]}, {"place": "room"}]}
    return pair(scene, {"sensors": [camera([0, -3, 3], [0, 0, -0.7], 2.5, 256)]}, "ball")


def furnace(scene, eye, target, focal_mm, sim=None, paths=64):
    return Case([(1, world(scene, {"sky": SKY, **(sim or {}), "sensors": [camera(eye, target, focal_mm, paths)]}))], Even(planck(W, KELVIN)))


def warm_ball_in_glass():
    """A warm black ball in a ball of glass that is given by its index alone, in a furnace."""
    scene = {"materials": {"glass": {"model": "dielectric", "index": 1.5}, "b": {"model": "lambert", "reflectance": 0, **WARM}},
             "objects": {"s": {"sphere": {"radius": 1}, "material": "glass"}, "b": {"sphere": {"radius": 0.5}, "material": "b"}},
             "world": [{"place": "s"}, {"place": "b"}]}
    return furnace(scene, [0, -6, 3], [0, 0, 0], 6)


def glass_in_haze():
    """A ball of glass that is given by its index alone in a layer of warm haze that scatters, in a furnace."""
    scene = {"media": {"haze": {"absorption": 0.3, "scattering": 0.1, **WARM}},
             "materials": {"glass": {"model": "dielectric", "index": 1.5}, "edge": {"inside": "haze"}},
             "objects": {"s": {"sphere": {"radius": 1}, "material": "glass"}, "l": {"box": {"z0": -2, "z1": 2}, "material": "edge"}},
             "world": [{"place": "l"}, {"place": "s"}]}
    return furnace(scene, [0, -4, 1.5], [0, 0, 0], 6, paths=1024)


def glowing_sphere():
    """Within a sphere that glows and reflects half: 0.5 / (1 - 0.5)."""
    scene = {"materials": {"g": {"model": "lambert", "reflectance": 0.5}}, "objects": {"s": {"sphere": {"radius": 25}, "material": "g"}}, "world": [{"place": "s"}]}
    sim = {"lamps": [{"kind": "surface", "material": "g", "radiance": 0.5, "both_sides": True}], "sensors": [camera([3, 0, 15], [0, 0, 0], 1.5, 256)]}
    return Case([(1, world(scene, sim))], Even(1.0))


def priority_over_glass():
    """Haze of a higher priority around a ball of glass, in a furnace: right, or reported."""
    scene = {"media": {"haze": {"absorption": 0.5, "priority": 2, **WARM}, "g": {"absorption": 0.5, "index": 1.6, **WARM}},
             "materials": {"edge": {"inside": "haze"}, "glass": {"model": "dielectric", "inside": "g"}, "f": {"model": "lambert", "reflectance": 0.5, **WARM}},
             "objects": {"l": {"box": {"z0": -0.5, "z1": 4}, "material": "edge"}, "s": {"sphere": {"radius": 1}, "material": "glass"},
                         "f": {"plane": {"width": 0, "depth": 0}, "material": "f"}},
             "world": [{"place": "f"}, {"place": "l"}, {"place": "s", "translate": [0, 0, 1.5]}]}
    return furnace(scene, [0, -6, 3], [0, 0, 1.5], 6)


def down_through_the_centre():
    """Straight down beside the only thing, through the air and the middle of the Earth: the same three metres away."""
    scene = {"materials": {"m": {"model": "lambert", "reflectance": 0.5}}, "objects": {"o": {"sphere": {"radius": 0.3}, "material": "m"}},
             "world": [{"place": "o", "translate": [0, 40, 1]}]}
    air = {"profile": "subarctic_winter", "gases": "none", "streams": 4, "ground_albedo": 0.03, "adjacency": False}
    sun = {"direction": {"zenith_deg": 60, "azimuth_deg": 338}, "irradiance": 234}
    sensor = {"kind": "orthographic", "name": "f", "columns": 4, "rows": 4, "gsd_m": 0.02, "height_m": 7, "paths": 4, "truth": [], "spectral_error": 1e-5, "bands": [BAND]}
    return Case([(k, world(scene, {"sun": sun, "atmosphere": air, "sensors": [{**sensor, "center_m": [x, 0]}]})) for k, x in ((1, 0), (-1, 3))])


KNOWN = {f.__name__: f for f in (lamp_mesh_beside_sphere, layer_in_layered_air, layer_in_profile_air, ball_in_pool, warm_ball_in_glass, glass_in_haze,
                                 glowing_sphere, priority_over_glass, down_through_the_centre)}
REPORTED = {"priority_over_glass": "but behind it there is"}  # a warning with this text will do as well
OPEN = frozenset()  # names that are not mended yet: they are printed, and no error
