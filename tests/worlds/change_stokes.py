"""Relations of polarisation: Stokes vectors of cameras in a furnace, beside a camera that knows none, and of a camera that is rolled."""
import math

from change_sensor import cross, unit
from world import prune

I, Q, U, V = range(4)
# Models and phase functions that polarise unpolarised light: behind two of them intensities are others than without polarisation.
POLARISE = ("mirror", "ggx", "priest_germer", "beard_maxwell", "shell", "sea", "coated", "dielectric", "ggx_dielectric", "rayleigh")


def camera_of(world):
    cameras = [s for s in world.sim["sensors"] if s["kind"] in ("frame_camera", "orthographic", "fisheye")]
    return cameras[0] if cameras else None


def seen(world, camera, first=I, last=V, frame="meridian", **keys):
    """The world with that camera alone, which sees Stokes vectors; of them the components from first to last are kept."""
    made = world.copy()
    made.sim["sensors"] = [{**camera, "stokes": ["i", "q", "u", "v"], "stokes_frame": frame, **keys}]
    bands = len(camera["bands"])
    made.facts["kept"] = (first * bands, (last + 1) * bands)
    return made


def furnace(world):
    """-> world or None: what is expected is B in I, and nothing in Q, U and V."""
    camera = camera_of(world)
    return camera and seen(world, camera)


def models_in(value):
    """Names of all models and phase functions within a piece of data."""
    if isinstance(value, dict):
        if isinstance(value.get("model"), str):
            yield value["model"]
        for v in value.values():
            yield from models_in(v)
    elif isinstance(value, list):
        for v in value:
            yield from models_in(v)


def polarises(world):
    """Whether anything in the text does, natural water and ground with a polarised part included."""
    scene = prune(world.scene)
    return any("bpdf" in m for m in scene["materials"].values()) or any(m in POLARISE for m in models_in(scene)) or any("water" in m for m in scene["media"].values())


def matte(world):
    """Materials that polarise become matte and opaque, molecules scatter evenly."""
    for m in world.scene["materials"].values():
        m.pop("bpdf", None)
        if m.get("model") in POLARISE:
            kept = {k: v for k, v in m.items() if "temperature" in k or k == "thermal"}
            m.clear()
            m.update({"model": "lambert", "reflectance": 0.4, **kept})
    for m in world.scene["media"].values():
        if m.get("phase", {}).get("model") in POLARISE:
            del m["phase"]


def beside_scalar(world):
    """-> world, its partner: the same camera without polarisation; or None."""
    camera = camera_of(world)
    matte(world)
    if not camera or polarises(world):
        return None
    plain = world.copy()
    plain.sim["sensors"] = [camera]
    return seen(world, camera, I, I), plain


def lit_air_around_media(world):
    """Whether the light of air is asked for around media, which is refused where the air is not traced (libs/light)."""
    air = world.sim.get("atmosphere")
    return air is not None and air.get("scattering") != "traced" and bool(world.scene["media"])


def rolled(world, rng):
    """-> world, coefficient of the partner, partner, note; or None. A pixel of a camera that is rolled by a quarter about its axis."""
    cameras = [s for s in world.sim["sensors"] if s["kind"] == "frame_camera"]
    if not cameras or lit_air_around_media(world):
        return None
    camera = dict(cameras[0])
    view = unit([b - a for a, b in zip(camera["position_m"], camera["look_at_m"])])
    aside = cross(view, [0, 0, 1])
    if math.sqrt(sum(c * c for c in aside)) < 1e-3:
        return None
    far = math.dist(camera["position_m"], camera["look_at_m"])
    camera.update(columns=1, rows=1, pitch_um=0.1, focal_length_mm=min(max(1000, 100 * far), 1e6), paths=16 * camera["paths"])
    frame = rng.choice(("meridian", "image"))
    first, last = (I, V) if frame == "meridian" else (Q, U)
    made = [seen(world, {**camera, "up": up}, first, last, frame) for up in (camera["up"], unit(aside))]
    if frame == "meridian":
        return made[0], -1, made[1], "rolled by 90 deg: the same about the vertical"
    return made[0], 1, made[1], "rolled by 90 deg: Q and U of the picture turn their signs"
