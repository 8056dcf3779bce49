"""Rows of sensors. Every pixel of each is compared; facts['sensors'] says of each how its values follow from radiance in a furnace."""
import math

COLUMNS, ROWS_OF_PIXELS = 6, 4


def common(d, name, **keys):
    w = d.wavelength
    bands = [{"name": "b", "center_um": w, "fwhm_um": d.width, "shape": "rectangular"}]
    if d.world.facts.get("bands", 1) == 2:
        bands.append({"name": "c", "center_um": round(w * 1.2, 4), "fwhm_um": d.width, "shape": "rectangular"})
    return {"name": name, "bands": bands, "paths": d.world.facts["paths"], "spectral_error": d.world.facts.get("spectral_error", 1e-5), "truth": [], **keys}


def add(d, sensor, factors=None):
    d.world.sim["sensors"].append(sensor)
    d.world.facts.setdefault("factors", {})[sensor["name"]] = factors or 1.0


def times(d):
    """Of a capture: within 0 to 1 s."""
    t = d.world.facts.setdefault("times", {"time_s": d.u(0, 0.4), "integration_time_s": d.one(0, 0.3)} if d.moving else {"time_s": 0})
    return dict(t)


def viewpoint(d):
    """-> position, point looked at."""
    if d.world.scene["world"] and d.maybe("camera_within", 0.4):  # among the things, under the top of a layer
        return [d.u(-0.1, 0.1), d.u(-0.1, 0.1), 3.3], [d.u(-3, 3), d.u(-3, 3), d.u(0, 1.5)]
    a, r, z = math.radians(d.u(0, 360)), d.u(1, 9), d.u(6.5, 11)
    if d.maybe("camera_far", 0.65):
        r, z = 1e4 * r, 1e4 * z
    return [round(r * math.cos(a), 3), round(r * math.sin(a), 3), z], [d.u(-0.8, 0.8), d.u(-0.8, 0.8), d.u(0, 1)]


def frame(d):
    position, target = viewpoint(d)
    tele = 1e4 if "camera_far" in d.world.rows and abs(position[2]) > 1000 else 1
    add(d, common(d, "frame", kind="frame_camera", columns=COLUMNS, rows=ROWS_OF_PIXELS, pitch_um=200, focal_length_mm=round(tele * d.u(1.2, 2.5), 3), position_m=position,
                  look_at_m=target, up=[0, 0, 1], **times(d)))


def orthographic(d):
    add(d, common(d, "ortho", kind="orthographic", columns=COLUMNS, rows=ROWS_OF_PIXELS, gsd_m=d.u(0.6, 1.3), center_m=[d.u(-1, 1), d.u(-1, 1)],
                  height_m=d.one(7, 12), **times(d)))


def platform(d, name, motion, array, task, lens=None):
    keys = {k: v for k, v in common(d, "a").items() if k not in ("truth", "name")}
    add(d, {"kind": "platform", "name": name, "truth": [], "motion": motion, "tasks": [task],
            "instruments": [{"focal_length_mm": d.u(1.2, 2.5), **(lens or {}), "arrays": [{**keys, **array}]}]})


def platform_frame(d):
    t = times(d)
    motion = {"kind": "static", "position_m": [d.u(-1, 1), d.u(-1, 1), d.u(7, 11)], "heading_deg": d.u(0, 360), "pitch_deg": d.u(-10, 10)}
    array = {"columns": COLUMNS, "rows": ROWS_OF_PIXELS, "pitch_um": 200, "integration_time_s": t.get("integration_time_s", 0)}
    lens = {}
    if d.maybe("lens", 0.6):
        lens = d.one({"distortion": {"k1": d.u(-0.3, 0.3), "p1": d.u(-0.02, 0.02)}}, {"f_number": d.u(0.5, 8), "focus_distance_m": d.one(0.5, 5, 1000)},
                     {"psf": {"kind": "gaussian", "sigma_um": d.one(10, 150)}}, {"f_number": d.u(1, 16), "psf": {"kind": "airy"}})
    platform(d, "platform", motion, array, {"start": t["time_s"]}, lens)


def pushbroom(d):
    t = times(d)["time_s"]
    h = d.u(0, 360)
    back = [round(-1.5 * math.sin(math.radians(h)), 3), round(-1.5 * math.cos(math.radians(h)), 3), d.u(7, 11)]
    motion = {"kind": "straight", "position_m": back, "heading_deg": h, "speed_m_s": 6, "t0_s": t}
    platform(d, "broom", motion, {"columns": COLUMNS, "pitch_um": 200, "readout": {"kind": "line", "line_rate_hz": 8}}, {"start": t, "stop": t + 0.5})


def fisheye(d):
    add(d, common(d, "fish", kind="fisheye", size=5, position_m=[d.u(-0.1, 0.1), d.u(-0.1, 0.1), 3.3], look=d.one("up", "down"), max_angle_deg=d.one(60, 90), **times(d)),
        [1.0 if math.hypot(k % 5 - 2, k // 5 - 2) < 1.79 else math.nan for k in range(25)])  # pixels that the circle cuts are not known


def unit(d):
    v = [d.rng.gauss(0, 1) for _ in range(3)]
    length = math.sqrt(sum(c * c for c in v))
    return [round(c / length, 6) for c in v]


def points(quantity, factor):
    def make(d):
        collectors = []
        for k, place in enumerate(([0, 0, 3.3], [0.05, 3.4, 1.2], [-3.35, -0.05, 0.4])):
            spec = {"name": f"p{k}", "quantity": quantity, "position_m": place}
            spec.update({"normal": unit(d)} if quantity == "irradiance" else {"look": unit(d)} if quantity == "radiance" else {})
            collectors.append(spec)
        factors = [factor] * 3
        index = d.world.facts.get("pool_index")
        if index:
            d.take("point_in_water")
            collectors.append(dict(collectors[0], name="w", position_m=[2.5, 2.5, -0.6]))
            factors.append(factor * index * index)
        sensor = common(d, "point_" + quantity, kind="point", collectors=collectors, **times(d))
        sensor["paths"] *= 16
        add(d, sensor, factors)
    return make


def two_bands(d):
    d.world.facts["bands"] = 2


ROWS = [
    ("two_bands", "bands", two_bands), ("camera_within", "detail", None), ("lens", "detail", None), ("camera_far", "detail", None, {"without": ("layered_air", "ambient", "room_sphere", "room_box", "room_glows", "camera_within", "fisheye")}), ("point_in_water", "detail", None, {"without": ("floor_none", "floor_plane", "floor_infinite", "floor_sinusoid", "floor_mesh", "room_sphere", "room_box")}),
    ("frame", "sensor", frame, {"weight": 3}),
    ("orthographic", "sensor", orthographic), ("platform_frame", "sensor", platform_frame, {"weight": 1.8}), ("pushbroom", "sensor", pushbroom),
    ("fisheye", "sensor", fisheye), ("irradiance", "sensor", points("irradiance", math.pi), {"weight": 1.5}), ("radiance", "sensor", points("radiance", 1), {"weight": 1.5}),
    ("actinic_flux", "sensor", points("actinic_flux", 4 * math.pi), {"weight": 1.5}),
]
