"""What relations make of a world: partners that must look the same. Each takes a copy and answers (partner, note), or None."""
import math

import shapes

EMPTY = ({"absorption": 0}, {"extinction": 0, "albedo": 0}, {"scattering": 0, "absorption": 0, "phase": {"model": "hg", "g": 0.6}}, {"absorption": 1e-9})


def rounded(v):
    return [round(c, 6) for c in v]


def closed_object(world, rng, material, size):
    """A closed object of about that size; a layer without end for size None."""
    if size is None:
        z = round(rng.uniform(0.2, 3.2), 3)
        spec = {"box": {"z0": z, "z1": round(z + rng.uniform(0.2, 3), 3)}}
    else:
        spec = rng.choice(({"sphere": {"radius": size}}, {"box": {"x0": -size, "y0": -size, "z0": -size, "x1": size, "y1": size, "z1": size}},
                           {"obj_text": shapes.ball_mesh(size), "normals": "facet"},
                           {"obj_text": shapes.box_mesh(-size, -size, -size, size, size, size), "normals": "facet"},
                           {"cylinder": {"radius": size, "height": size, "capped": 1}}))
    return world.add("objects", "new", dict(spec, material=material))


def body_of_nothing(world, rng):
    """A body of a medium that does nothing, anywhere, changes nothing. Its priority is the lowest, so whatever it overlaps stays."""
    medium = dict(world.scene["media"][world.scene["ambient"]]) if "ambient" in world.scene else dict(rng.choice(EMPTY))
    name = world.add("media", "nothing", {**medium, "priority": -5})
    material = world.add("materials", "nothing", {"inside": name})
    kind = rng.choice(("layer", "box", "shell", "around"))
    size = {"layer": None, "box": rng.uniform(0.2, 1.5), "shell": rng.uniform(0.5, 1.5), "around": 40.0}[kind]
    place = [0, 0, 0] if kind in ("layer", "around") else [rng.uniform(-3, 3), rng.uniform(-3, 3), rng.uniform(0.5, 5)]
    thing = closed_object(world, rng, material, size)
    placement = {"place": thing, "translate": rounded(place)}
    if kind != "layer":
        placement["rotate"] = {"euler_deg": rounded([rng.uniform(-180, 180) for _ in range(3)]), "order": "xyz"}
    world.scene["world"].insert(rng.randrange(len(world.scene["world"]) + 1), placement)
    if kind == "shell":
        world.scene["world"].append({**placement, "scale": 0.6})
    return world, f"a {kind} of nothing"


def body_of_the_same(world, rng):
    """A body of the same medium within a layer, a pool or the ambient medium changes nothing; so does a refracting surface of it."""
    scene, hosts = world.scene, []
    if "ambient" in scene:
        hosts.append((scene["ambient"], [0, 0, 1.6], 0.4, False))
    for name, o in scene["objects"].items():
        inside = scene["materials"][o["material"]].get("inside") if "material" in o else None
        placed = [p for p in scene["world"] if p["place"] == name]
        if placed and inside and "plane" in o:
            hosts.append((inside, [0, -2.4, -0.75], 0.5, True))
        if placed and inside and "box" in o and "x0" not in o["box"] and o["box"]["z0"] < 1 < 2 < o["box"]["z1"]:
            hosts.append((inside, [0, 0, 1.6], 0.4, False))
    if not hosts:
        return None
    medium, place, size, refracts = rng.choice(hosts)
    if not refracts and rng.random() < 0.4:
        return hidden_body(world, rng, medium, place, size)
    same = world.add("media", "same", dict(scene["media"][medium])) if rng.random() < 0.5 else medium
    kind = rng.choice(("boundary", "boundary with outside", "dielectric") if refracts else ("boundary", "boundary with outside"))
    spec = {"inside": same}
    if kind != "boundary":
        spec["outside"] = medium
    if kind == "dielectric":
        spec["model"] = "dielectric"
    o = closed_object(world, rng, world.add("materials", "same", spec), size)
    world.scene["world"].append({"place": o, "translate": place})
    return world, f"a body of '{medium}' in it: {kind}"


def hidden_body(world, rng, medium, place, size):
    """A body of a lower priority within one of a higher changes nothing, whatever it is of."""
    scene = world.scene
    if scene.get("ambient") == medium:  # gives way to any body
        return None
    spec = {"absorption": rng.uniform(0.5, 3), "scattering": rng.uniform(0, 2), "priority": scene["media"][medium].get("priority", 0) - 1}
    o = closed_object(world, rng, world.add("materials", "hidden", {"inside": world.add("media", "hidden", spec)}), size)
    scene["world"].insert(rng.randrange(len(scene["world"]) + 1), {"place": o, "translate": place})
    return world, f"a hidden body in '{medium}'"


def bystander(world, rng):
    """Small black things far off, things that are absent, lamps that are dark change nothing."""
    black = world.add("materials", "black", {"model": "lambert", "reflectance": 0})
    kind = rng.choice(("ball", "mesh", "absent", "dark lamp"))
    far = [rng.choice((-1, 1)) * 70, rng.uniform(-60, 60), rng.uniform(-40, -20)]
    if kind == "dark lamp":
        lamp = {"kind": "point", "position_m": [0.1, 0.1, 3], "intensity": 100, "schedule": [{"time_s": -5000, "on": False}]}
        world.sim["lamps"].append(lamp)
    elif kind == "absent":
        o = world.add("objects", "new", {"sphere": {"radius": 2}, "material": black})
        world.scene["world"].append({"place": o, "translate": [0, 0, 2], "appears": 5000, "disappears": 5001})
    else:
        o = world.add("objects", "new", {"sphere": {"radius": 0.05}, "material": black} if kind == "ball" else
                      {"obj_text": shapes.box_mesh(-0.05, -0.05, -0.05, 0.05, 0.05, 0.05), "normals": "facet", "material": black})
        world.scene["world"].insert(0, {"place": o, "translate": rounded(far)})
    return world, f"bystander: {kind}"


# --- lights ---
def lights_of(world):
    texts = world.texts()[0]
    keys = [k for k in ("sun", "moon", "sky", "night_sky") if k in world.sim]
    if world.sim.get("sky", {}).get("kind") == "clear":
        keys = [k for k in keys if k != "sky"]  # goes with the sun
    return keys + [f"lamp {i}" for i, lamp in enumerate(world.sim["lamps"]) if f'"{lamp.get("material", "")}"' in texts or "material" not in lamp]


def with_lights(world, keep):
    made = world.copy()
    clear = world.sim.get("sky", {}).get("kind") == "clear"
    for key in ("sun", "moon", "sky", "night_sky"):
        if key in made.sim and key not in keep and not (key == "sky" and clear and "sun" in keep):
            del made.sim[key]
    made.sim["lamps"] = [lamp for i, lamp in enumerate(made.sim["lamps"]) if f"lamp {i}" in keep]
    return made


def times_number(value, factor):
    if isinstance(value, dict):
        return {**value, "value": [v * factor for v in value["value"]]}
    return value * factor


def brighter(world, factor):
    made = world.copy()
    for key, what in (("sun", "irradiance"), ("moon", "irradiance"), ("sky", "radiance")):
        if what in made.sim.get(key, {}):
            made.sim[key][what] = times_number(made.sim[key][what], factor)
    if "night_sky" in made.sim:
        made.sim["night_sky"]["scale"] = {part: by * factor for part, by in made.sim["night_sky"]["scale"].items()}
        for satellite in made.sim["night_sky"].get("satellites", []):
            satellite["area_m2"] *= factor
    for lamp in made.sim["lamps"]:
        if "map" in lamp:  # whose unit says how much it is
            lamp["map"]["scale"] *= factor
            continue
        what = "radiance" if "radiance" in lamp else "intensity"
        lamp[what] = times_number(lamp[what], factor)
    return made


# --- the same thing elsewhere, or in other words ---
def turned(v, phi):
    c, s = math.cos(phi), math.sin(phi)
    return [c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]]


def rigid_motion(world, rng):
    """The whole world with lights and sensors, moved and turned about the vertical: the same pictures."""
    sim, kinds = world.sim, {s["kind"] for s in world.sim["sensors"]}
    draped = any(m["type"] == "normal" and m["projection"] == "drape" for m in world.scene["maps"].values())  # its axes are the scene's
    level = draped or kinds & {"orthographic", "fisheye"}
    degrees = 0 if level else rng.choice((90, 180)) if "table" in sim.get("sky", {}) else round(rng.uniform(-170, 170), 3)
    phi = math.radians(degrees)
    shift = [round(rng.uniform(-50, 50), 3), round(rng.uniform(-50, 50), 3), 0 if "atmosphere" in sim else round(rng.uniform(-3, 30), 3)]

    def moved(v):
        return rounded(a + b for a, b in zip(turned(v, phi), shift))

    whole = world.add("groups", "whole", world.scene["world"])
    world.scene["world"] = [{"place": whole, "rotate": {"heading_deg": -degrees}, "translate": shift}]
    for v in world.scene["volumes"]:
        v.update(rotate={"heading_deg": v.get("rotate", {"heading_deg": 0})["heading_deg"] - degrees}, translate=moved(v["translate"]))
    for key in ("sun", "moon"):
        if key in sim:
            sim[key]["direction"]["azimuth_deg"] = (sim[key]["direction"]["azimuth_deg"] - degrees) % 360
    if "table" in sim.get("sky", {}):
        n = degrees // 90
        sim["sky"]["table"] = [row[-n:] + row[:-n] for row in sim["sky"]["table"]]
    for lamp in sim["lamps"]:
        if "position_m" in lamp:
            lamp["position_m"] = moved(lamp["position_m"])
        if "axis" in lamp:
            lamp["axis"] = turned(lamp["axis"], phi)
    for s in sim["sensors"]:
        move_sensor(s, moved, phi, degrees, shift)
    return world, f"turned by {degrees}, moved by {shift}"


def move_sensor(s, moved, phi, degrees, shift):
    for key in ("position_m", "look_at_m"):
        if key in s:
            s[key] = moved(s[key])
    for c in s.get("collectors", []):
        c["position_m"] = moved(c["position_m"])
        for key in ("normal", "look"):
            if key in c:
                c[key] = turned(c[key], phi)
    if s["kind"] == "orthographic":
        s["center_m"] = [s["center_m"][0] + shift[0], s["center_m"][1] + shift[1]]
        s["height_m"] += shift[2]
    if s["kind"] == "platform":
        s["motion"]["position_m"] = moved(s["motion"]["position_m"])
        s["motion"]["heading_deg"] = (s["motion"]["heading_deg"] - degrees) % 360


def scaled(world, rng):
    """The whole world some times as large, with matter as many times thinner and lamps with the square of the light: the same pictures."""
    scene, sim = world.scene, world.sim
    factor = rng.choice((1e-3, 0.1, 0.37, 3.0, 10.0, 1e3))
    if any("leaves" in m or "water" in m for m in scene["media"].values()) or any(m["type"] == "bump" for m in scene["maps"].values()):
        return None  # in metres of their own
    for m in scene["media"].values():
        for key in ("absorption", "scattering", "extinction"):
            if key in m:
                m[key] = times_number(m[key], 1 / factor)
    for m in scene["maps"].values():
        if "drape" in m:
            m["drape"].update(origin=[c * factor for c in m["drape"]["origin"]], gsd=m["drape"]["gsd"] * factor)
    place = {"place": world.add("groups", "whole", scene["world"]), "scale": factor}
    scene["world"] = [place]
    for v in scene["volumes"]:
        v.update(scale=factor * v.get("scale", 1), translate=[c * factor for c in v["translate"]])
    for lamp in sim["lamps"]:
        if "position_m" in lamp:
            lamp.update(position_m=[c * factor for c in lamp["position_m"]], intensity=lamp["intensity"] * factor ** 2)
    for s in sim["sensors"]:
        for c in [s, *s.get("collectors", [])]:
            for key in ("position_m", "look_at_m", "center_m"):
                if key in c:
                    c[key] = [x * factor for x in c[key]]
        for key in ("gsd_m", "height_m"):
            if key in s:
                s[key] *= factor
        if s["kind"] == "platform":
            m = s["motion"]
            m["position_m"] = [x * factor for x in m["position_m"]]
            if "speed_m_s" in m:
                m["speed_m_s"] *= factor
            for i in s["instruments"]:
                if "focus_distance_m" in i:
                    return None  # the aperture stays as wide
    return world, f"{factor} times as large"


def regroup(world, rng):
    """Things in groups within groups that are turned and turned back; other orders of things and tables."""
    scene, kept = world.scene, []
    for p in scene["world"]:
        if rng.random() < 0.6:
            degrees, shift = rng.uniform(-180, 180), [rng.uniform(-9, 9), rng.uniform(-9, 9), rng.uniform(-2, 2)]
            back = turned([-c for c in shift], math.radians(-degrees))
            inner = world.add("groups", "re", [p])
            p = {"place": world.add("groups", "re", [{"place": inner, "rotate": {"heading_deg": degrees}, "translate": back}]),
                 "rotate": {"heading_deg": -degrees}, "translate": shift}
        kept.append(p)
    rng.shuffle(kept)
    if len(kept) > 2 and rng.random() < 0.5:
        kept = [{"place": world.add("groups", "re", kept[:2])}] + kept[2:]
    scene["world"] = kept
    for table in ("materials", "media", "objects", "groups", "maps", "grids"):
        items = list(scene[table].items())
        rng.shuffle(items)
        scene[table] = dict(items)
    rng.shuffle(world.sim["lamps"])
    return world, "regrouped"


def halves(o, bends):
    """Two objects that are one together, or None."""
    if "plane" in o and o["plane"]["width"]:
        w, d = o["plane"]["width"], o["plane"]["depth"]
        half = {**o, "plane": {"width": w / 2, "depth": d}}
        return [(half, [-w / 4, 0, 0]), (half, [w / 4, 0, 0])]
    if "box" in o and not bends:
        low, high = ("z0", "z1")
        middle = 0.37 * o["box"][low] + 0.63 * o["box"][high]
        return [({**o, "box": {**o["box"], high: middle}}, None), ({**o, "box": {**o["box"], low: middle}}, None)]
    if "disk" in o and o["disk"].get("inner_radius", 0) == 0:
        r = o["disk"]["radius"]
        return [({**o, "disk": {"radius": 0.6 * r}}, None), ({**o, "disk": {"radius": r, "inner_radius": 0.6 * r}}, None)]
    if "sinusoid" in o or "obj_text" not in o or o.get("normals") == "smooth":
        return None
    lines = o["obj_text"].splitlines(True)
    vertices, faces = [x for x in lines if x[0] == "v"], [x for x in lines if x[0] == "f"]
    if len(faces) < 2 or bends is not None:
        return None
    return [({**o, "obj_text": "".join(vertices + part)}, None) for part in (faces[::2], faces[1::2])]


def split(world, rng):
    """A plane, a disk, a box (opaque, or of a medium that bends no light) or an opaque mesh in two objects that touch."""
    scene = world.scene
    choices = []
    for name, o in scene["objects"].items():
        m = scene["materials"].get(o.get("material"), {})
        bends = None if "model" in m or "map" in m else False   # None: opaque; False: a boundary
        if "inside" in m and "model" in m or m.get("model") in ("dielectric", "ggx_dielectric"):
            continue
        if name.startswith("room"):  # seen from within: a half of it has a wall in the middle
            continue
        parts = halves(o, bends)
        if parts and "maps" not in m:
            choices.append((name, parts))
    if not choices:
        return None
    name, parts = rng.choice(choices)
    placements = []
    for part, shift in parts:
        p = {"place": world.add("objects", "half", part)}
        placements.append({**p, "translate": shift} if shift else p)
    del scene["objects"][name]
    scene["groups"][name] = placements
    return world, f"'{name}' in two"


def shift_times(value, dt, inside=""):
    """Every time in a piece of text dt later."""
    if isinstance(value, list):
        return [shift_times(v, dt, inside) for v in value]
    if not isinstance(value, dict):
        return value
    made = {}
    for k, v in value.items():
        if k in ("time_s", "t0_s", "appears", "disappears", "start", "stop"):
            made[k] = v + dt
        elif k == "temperature" and isinstance(v, dict) and "table" in v:
            made[k] = {**v, "table": [[t + dt, kelvin] for t, kelvin in v["table"]]}
        else:
            made[k] = shift_times(v, dt)
    if made.get("kind") in ("spin", "straight"):
        made.setdefault("t0_s", dt)
    return made


def time_shift(world, rng):
    """Everything so much later."""
    dt = rng.choice((-100.0, 37.5, 400.0))
    if "sensors" in world.sim:
        for s in world.sim["sensors"]:
            if s["kind"] != "platform":
                s.setdefault("time_s", 0)
    world.scene, world.sim = shift_times(world.scene, dt), shift_times(world.sim, dt)
    return world, f"{dt} s later"


def switches(world, rng):
    """Settings that say how, not what."""
    sim = world.sim
    wide = all(lamp["kind"] == "surface" for lamp in sim["lamps"]) and all(sim[k].get("half_angle_deg", 0) >= 2 for k in ("sun", "moon") if k in sim)
    kind = rng.choice(["caustic_guiding", "hero_wavelengths", "spectral_step", "spectral_error", "min_max"] + ["manifold_nee"] * (2 if wide else 0))
    if kind in ("caustic_guiding", "manifold_nee"):
        sim[kind] = False
    for s in sim["sensors"]:
        a = s["instruments"][0]["arrays"][0] if s["kind"] == "platform" else s
        if kind == "hero_wavelengths":
            a["hero_wavelengths"] = rng.choice((1, 2, 8))
        elif kind == "spectral_step":
            a["spectral_step_um"] = round(a["bands"][0]["fwhm_um"] / 3, 6)
        elif kind == "spectral_error":
            a["spectral_error"] = 1e-4
        elif kind == "min_max":
            a["paths"] = {"min": 4, "max": a["paths"], "relative_error": 0.05}
    return world, kind


def without_bounds(o):
    return "plane" in o and not o["plane"]["width"] or "box" in o and "x0" not in o["box"]


def periodic_copies(world, rng):
    """A scene that repeats itself, and twice as much of it that does."""
    partner, size = world, world.sim["periodic"]["size_m"][0]
    partner.sim["periodic"] = {"origin_m": [-size / 2, -size / 2], "size_m": [2 * size, size]}
    endless = [p for p in partner.scene["world"] if without_bounds(partner.scene["objects"].get(p["place"], {}))]  # once: two holes in one place are fewer
    whole = partner.add("groups", "cell", [p for p in partner.scene["world"] if p not in endless])
    partner.scene["world"] = endless + [{"place": whole}, {"place": whole, "translate": [size, 0, 0]}]
    if not partner.scene["groups"][whole]:
        partner.scene["world"] = endless
    partner.scene["volumes"] += [{**v, "translate": [v["translate"][0] + size, *v["translate"][1:]]} for v in partner.scene["volumes"]]
    partner.sim["lamps"] += [{**lamp, "position_m": [lamp["position_m"][0] + size, *lamp["position_m"][1:]]} for lamp in partner.sim["lamps"] if "position_m" in lamp]
    return partner, "two cells"
