"""Substitutions: the same world said in other words, or with other pieces that are the same. Each row: rewrite(world, rng) -> note or None."""
import math

import rows_map
import shapes
from world import Draw


def materials(world, wanted):
    """Names of materials that objects carry and wanted(text) takes."""
    carried = {o["material"] for o in world.scene["objects"].values() if "material" in o}
    return [k for k, m in world.scene["materials"].items() if k in carried and wanted(m)]


def plain(m):
    return "model" in m and "maps" not in m and "map" not in m and "inside" not in m and m["model"] not in ("dielectric", "ggx_dielectric")


def not_lamps(world, names):
    lamps = {lamp.get("material") for lamp in world.sim["lamps"]}
    return [n for n in names if n not in lamps]


def constant_map(world, spec, value, bands=1, wavelengths=None):
    """A map of one value, draped."""
    d = Draw(0, (), {})
    d.world = world
    values = value if isinstance(value, list) else [value] * bands
    file = rows_map.envi(d, [[v] * 16 for v in values], wavelengths, spec["type"] in ("class", "curve_index"))
    return rows_map.add(d, {**spec, "file": file})


def one_of(world, rng, wanted):
    names = not_lamps(world, materials(world, wanted))
    return rng.choice(names) if names else None


def mixture_of_equals(world, rng):
    name = one_of(world, rng, lambda m: plain(m) and m["model"] != "mirror")
    if not name:
        return None
    m = world.scene["materials"][name]
    parts = [world.add("materials", "equal", dict(m)) for _ in range(2)]
    at = constant_map(world, {"type": "mixture", "materials": parts}, [0.3, 0.7])
    world.scene["materials"][name] = {"model": "lambert", "reflectance": 0, "maps": [at]}
    return f"'{name}' ({m['model']}) as a mixture of equals"


def class_of_one(world, rng):
    name = one_of(world, rng, plain)
    if not name:
        return None
    part = world.add("materials", "equal", world.scene["materials"][name])
    world.scene["materials"][name] = {"map": constant_map(world, {"type": "class", "materials": {"1": part}}, 1)}
    return f"'{name}' by a class map of one value"


def map_of_nothing(world, rng):
    name = one_of(world, rng, plain)
    if not name:
        return None
    m = world.scene["materials"][name]
    kind = rng.choice(["opacity", "bump", "normal"] + ["temperature"] * ("temperature_k" in m))
    value = {"opacity": 1, "bump": 0.7, "normal": [0, 0, 1], "temperature": m.get("temperature_k", 0)}[kind]
    m["maps"] = [constant_map(world, {"type": kind}, value)]
    return f"'{name}' with a {kind} map of one value"


def reflectance_by_map(world, rng):
    name = one_of(world, rng, lambda m: plain(m) and m["model"] in ("lambert", "oren_nayar", "mirror") and isinstance(m["reflectance"], float))
    if not name:
        return None
    m = world.scene["materials"][name]
    r = m["reflectance"]
    kind = rng.choice(("curve_index", "cube", "texture"))
    if kind == "curve_index":
        at = constant_map(world, {"type": kind, "family": [r, r]}, 1)
    elif kind == "cube":
        at = constant_map(world, {"type": kind, "outside": "hold"}, [r, r], wavelengths=[0.3, 15])
    else:
        at = constant_map(world, {"type": kind, "family": [r, r], "bands_um": [[0.5, 0.6]]}, 20)
    m.update(maps=[at], reflectance=round(1 - r, 4) if kind != "texture" else r)
    m.pop("transmittance", None)
    return None if "lambert_through" in world.rows else f"reflectance of '{name}' by a map: {kind}"


def curve_for_number(world, rng):
    found = [(m, k) for table in ("materials", "media") for m in world.scene[table].values() for k in ("reflectance", "diffuse", "absorption", "scattering", "index", "isotropic")
             if isinstance(m.get(k), float)]
    if not found:
        return None
    m, k = rng.choice(found)
    m[k] = rng.choice(({"constant": m[k]}, {"points": [[0.1, m[k]], [100, m[k]]]}, {"wavelength_um": [0.2, 0.5, 3, 40], "value": [m[k]] * 4, "outside": "hold"}))
    return f"{k} by a curve"


def exact_by_mesh(world, rng):
    names = []
    for n, o in world.scene["objects"].items():
        if set(o) == {"box", "material"} and "x0" in o["box"] or "plane" in o and o["plane"]["width"]:
            m = world.scene["materials"].get(o["material"], {})
            maps = [world.scene["maps"][k] for k in m.get("maps", [])] + ([world.scene["maps"][m["map"]]] if "map" in m else [])
            if all(k.get("projection") != "uv" for k in maps) and not m.get("roughness_y") and not m.get("directed"):
                names.append(n)
    if not names:
        return None
    name = rng.choice(names)
    o = world.scene["objects"][name]
    b = o.get("box")
    text = shapes.box_mesh(*(b[k] for k in ("x0", "y0", "z0", "x1", "y1", "z1"))) if b else shapes.quad_mesh(o["plane"]["width"], o["plane"]["depth"], rng.choice((1, 2)))
    world.scene["objects"][name] = {"obj_text": text, "normals": "facet", "material": o["material"]}
    return f"'{name}' as a mesh"


def medium_in_other_words(world, rng):
    names = [k for k, m in world.scene["media"].items() if isinstance(m.get("absorption"), (int, float)) or "extinction" in m]
    if not names:
        return None
    m = world.scene["media"][rng.choice(names)]
    if "extinction" in m:
        s, a = m["extinction"] * m["albedo"], m["extinction"] * (1 - m["albedo"])
        del m["extinction"], m["albedo"]
        m.update(scattering=s, absorption=a)
    elif isinstance(m.get("scattering", 0), (int, float)):
        m.update(extinction=m["absorption"] + m.pop("scattering", 0))
        m["scattering"] = m["extinction"] - m.pop("absorption")
    else:
        return None
    if "phase" not in m:
        m["phase"] = rng.choice(({"model": "hg", "g": 0}, {"model": "double_hg", "g1": 0, "g2": 0, "share": 0.5}, {"model": "tabulated", "table": "0 1, 180 1"}))
    elif m["phase"]["model"] == "hg" and isinstance(m["phase"]["g"], float):
        m["phase"] = {"model": "double_hg", "g1": m["phase"]["g"], "g2": 0.1, "share": 1}
    return "a medium in other words"


def voxels_for_box(world, rng):
    """A box of a medium that bends no light, at rest in the world, as a grid of even density; and layers of halves for denser ones."""
    scene, found = world.scene, []
    for i, p in enumerate(scene["world"]):
        o = scene["objects"].get(p["place"], {})
        m = scene["materials"].get(o.get("material"), {})
        if set(o) == {"box", "material"} and "x0" in o["box"] and set(m) == {"inside"} and set(p) <= {"place", "translate", "rotate", "scale"}:
            found.append((i, o["box"], m["inside"]))
    if not found or "ambient" in scene or "layer" in world.rows or "two_layers" in world.rows:
        return None
    i, b, medium = rng.choice(found)
    if scene["media"][medium].get("index", 1) != 1 or "priority" in scene["media"][medium]:
        return None
    file = f"even{len(world.files)}.vox"
    world.files[file] = (f"voxels: 1\ncells: [2, 2, 2]\ncell_m: {[b[k + '1'] for k in 'xyz']}\norigin_m: {[b[k + '0'] for k in 'xyz']}\n"
                         f"fields: {{density: {rng.choice((1, {'values': [1] * 8}))}}}\n").replace("'", "").encode()
    p = scene["world"].pop(i)
    scene["volumes"].append({**p, "place": world.add("grids", "even", {"voxels": file, "medium": medium})})
    return "a box of a medium as voxels"


def glass_of_index_one(world, rng):
    """A surface of index 1 that bends nothing, or that is not there."""
    if "ambient" in world.scene or "layer" in world.rows or "two_layers" in world.rows:
        return None
    m = world.add("materials", "one", {"model": "dielectric", "index": 1})
    o = world.add("objects", "one", rng.choice(({"sphere": {"radius": 0.5}, "material": m}, {"box": {"x0": -.4, "y0": -.4, "z0": -.4, "x1": .4, "y1": .4, "z1": .4}, "material": m})))
    world.scene["world"].append({"place": o, "translate": [0, 0, 1.6]})
    return "a body of index 1"


def turns_in_other_words(world, rng):
    found = []
    for group in [world.scene["world"], *world.scene["groups"].values()]:
        found += [p for p in group if isinstance(p.get("rotate"), dict) and ("heading_deg" in p["rotate"] or "axis" in p["rotate"])]
    if not found:
        return None
    p = rng.choice(found)
    r = p["rotate"]
    if "heading_deg" in r:
        axis, degrees = [0, 0, 1], -r["heading_deg"]
    else:
        axis, degrees = r["axis"], r["angle_deg"]
    n = math.sqrt(sum(c * c for c in axis))
    s = math.sin(math.radians(degrees) / 2) / n
    p["rotate"] = rng.choice(({"quaternion": [math.cos(math.radians(degrees) / 2), *(c * s for c in axis)]},
                              [{"axis": axis, "angle_deg": degrees / 2}] * 2, {"axis": [-c for c in axis], "angle_deg": -degrees}))
    return "a turn in other words"


def still_motion(world, rng):
    """Things at rest as moving ones that stay where they are."""
    found = [p for p in world.scene["world"] if "motion" not in p and "table" not in p and "schedule" not in p and "appears" not in p]
    found = [p for p in found if "plane" not in (o := world.scene["objects"].get(p["place"], {})) and not ("box" in o and "x0" not in o["box"])]
    if not found or "rest_only" in world.facts:
        return None
    p = rng.choice(found)
    place = p.pop("translate", [0, 0, 0])
    p["motion"] = rng.choice(({"kind": "static", "position_m": place}, {"kind": "straight", "position_m": place, "heading_deg": 0, "speed_m_s": 0},
                              {"kind": "spin", "position_m": place, "axis": [0, 0, 1], "rate_deg_s": 0}))
    return f"'{p['place']}' at rest by a motion ({p['motion']['kind']})"


def sky_by_table(world, rng):
    """A sky that is the same everywhere by a table, which is asked for, where else it is met by chance."""
    sky = world.sim.get("sky", {})
    if "radiance" not in sky or "table" in sky:
        return None
    sky["table"] = [[1, 1, 1], [1, 1, 1]]
    return "an even sky by a table"


REWRITES = {f.__name__: f for f in (mixture_of_equals, class_of_one, map_of_nothing, reflectance_by_map, curve_for_number, exact_by_mesh,
                                    medium_in_other_words, voxels_for_box, glass_of_index_one, turns_in_other_words, still_motion, sky_by_table)}


def substitute(world, rng):
    """One piece of the world by another that is the same."""
    names = list(REWRITES)
    rng.shuffle(names)
    for name in names:
        made = world.copy()
        note = REWRITES[name](made, rng)
        if note:
            made.rows.add(name)
            return made, note
    return None
