"""Rows of what stands in a world: shapes, things (bodies of media, glass, nested, touching), floors, what fills space."""
import rows_map
import shapes

CLOSED = {"what": ("closed",)}


# --- shapes, within 1 m of the origin ---
def plane(d, m):
    return {"plane": {"width": d.u(0.6, 1.3), "depth": d.u(0.6, 1.3)}, "material": m}


def disk(d, m):
    return {"disk": {"radius": d.u(0.5, 0.95), "inner_radius": d.one(0, 0.2)}, "material": m}


def box(d, m):
    x, y, z = d.u(0.25, 0.57), d.u(0.25, 0.57), d.u(0.25, 0.57)
    return {"box": {"x0": -x, "y0": -y, "z0": -z, "x1": x, "y1": y, "z1": z}, "material": m}


def sphere(d, m):
    return {"sphere": {"radius": d.u(0.4, 0.95)}, "material": m}


def cone(d, m):
    return {"cone": {"radius": d.u(0.3, 0.6), "top_radius": d.one(0, 0.2), "height": d.u(0.4, 0.75), "capped": 1}, "material": m}


def cylinder(d, m):
    return {"cylinder": {"radius": d.u(0.2, 0.6), "height": d.u(0.4, 0.75), "capped": 1}, "material": m}


def pipe(d, m):
    return {"cylinder": {"radius": d.u(0.2, 0.6), "height": d.u(0.4, 0.75), "capped": 0}, "material": m}


def sinusoid(d, m):
    terms = [{"amplitude": d.u(0.02, 0.08), "kx": d.u(1, 6), "ky": d.u(0, 6), "phase": d.u(0, 6)} for _ in range(d.one(1, 2))]
    return {"sinusoid": {"width": d.u(0.6, 1.2), "depth": d.u(0.6, 1.2), "terms": terms}, "material": m}


def mesh_box(d, m):
    x, y, z = d.u(0.25, 0.57), d.u(0.25, 0.57), d.u(0.25, 0.57)
    return {"obj_text": shapes.box_mesh(-x, -y, -z, x, y, z), "normals": "facet", "material": m}


def mesh_ball(d, m):
    return {"obj_text": shapes.ball_mesh(d.u(0.4, 0.95)), "normals": "facet", "material": m}


def mesh_smooth(d, m):
    return {"obj_text": shapes.ball_mesh(d.u(0.4, 0.95)), "normals": "smooth", "material": m}


def mesh_quad(d, m):
    return {"obj_text": shapes.quad_mesh(d.u(0.6, 1.3), d.u(0.6, 1.3)), "normals": "facet", "material": m}


def solid_voxels(d, m):
    name = f"solid{len(d.world.files)}.vox"
    filled = [d.one(0, 1) for _ in range(8)]
    d.world.files[name] = shapes.voxels((2, 2, 2), 0.5, {"material": filled[:-1] + [1]})
    return {"voxels": name, "materials": {"1": m}}


# --- things ---
def an_object(d, material, closed):
    row = d.pick("shape", lambda r: not closed or "closed" in r.what)
    return d.world.add("objects", "o", row.make(d, material))


def around(d):
    """Name and index of the medium around; (None, 1): nothing. Index None: no plain number."""
    return d.surround[-1] if d.surround else (None, 1)


def medium(d, index):
    """-> name, index of a new medium; index None: any that bends light."""
    if index is None:
        outer = around(d)[1]  # the front side of a surface looks into what bends less
        row = d.pick("medium", lambda r: r.name not in ("clear", "leaves") and (outer == 1 or "refracts" not in r.what))
        index = 1 if "refracts" in row.what else d.u(max(1.2, (outer or 1) + 0.03), 1.9)
        return d.world.add("media", "g", row.make(d, index)), None if "refracts" in row.what else index
    row = d.pick("medium", lambda r: "refracts" not in r.what and (index == 1 or r.name != "leaves"))
    return d.world.add("media", "h", row.make(d, index)), index


def opaque(d):
    return [{"place": an_object(d, d.opaque(), False)}]


def haze_body(d):
    name, index = medium(d, around(d)[1])
    return [{"place": an_object(d, d.material({"inside": name}), True)}], (name, index)


def interface(d, rough, own):
    """-> material, (medium, index) of a surface that bends light."""
    name, index = around(d)
    rough = rough or "reciprocal" in d.traits
    spec = {"model": "ggx_dielectric", "roughness": d.roughness} if rough else {"model": "dielectric"}
    if own:
        inner, inner_index = medium(d, None)
        spec["inside"] = inner
        if name and (d.maybe("names_outside", 0.4) or index != 1):
            spec["outside"] = name
            d.take("names_outside")
        return d.material(spec), (inner, inner_index)
    n = d.u(1.2, 1.8)
    w = d.wavelength
    if d.maybe("glass_dispersion", 0.3):
        spec["index"] = {"wavelength_um": [w * 0.5, w, w * 2], "value": [round(n * 1.02, 4), n, round(n * 0.98, 4)], "outside": "hold"}
    else:
        spec["index"] = n
    return d.material(spec), (None, n)


def glass(rough, own):
    def make(d):
        m, inner = interface(d, rough, own)
        return [{"place": an_object(d, m, True)}], inner
    return make


def pane(d):
    m, _ = interface(d, False, d.chance(0.5))
    name = d.world.add("objects", "o", {"box": {"x0": -0.65, "y0": -0.65, "z0": -d.u(0.02, 0.1), "x1": 0.65, "y1": 0.65, "z1": d.u(0.02, 0.1)}, "material": m})
    return [{"place": name}]


def body(d):
    """A closed body of a medium: haze or glass. -> placements, (medium, index) in it."""
    rough = any(m.get("model") == "ggx_dielectric" for m in d.world.scene["materials"].values())  # each index has tables, which take time
    row = d.pick("body", lambda r: not rough or "reciprocal" in d.traits or not r.name.startswith("rough_")) or d.pick("body")
    return row.make(d)


def a_body(d):
    return body(d)[0]


def shrink(d, parts, scale, place=(0, 0, 0)):
    name = d.world.add("groups", "in", parts)
    return {"place": name, "scale": scale, "translate": [round(c, 4) for c in place]}


def inner_things(d):
    """What lies in a body: opaque things, or bodies again, two deep at most."""
    name, index = around(d)
    if d.maybe("glows_within", 0.4):
        return glowing(d)
    if name is None and index != 1 or index is None or len(d.surround) > 3:
        return opaque(d)
    if d.maybe("nested_deep", 0.55):
        return nested(d)
    return a_body(d) if d.chance(0.55) else opaque(d)


def nested(d):
    outer, inner = body(d)
    # The largest ball about the origin that lies in every closed shape: small, since cones begin at the origin.
    shape = d.world.scene["objects"][outer[0]["place"]]
    d.surround.append(inner)
    place = (0, 0, 0)
    for kind in ("cone", "cylinder"):
        if kind in shape:
            place = (0, 0, 0.3 * shape[kind]["height"])
    parts = outer + [shrink(d, inner_things(d), d.u(0.06, 0.13), place)]
    d.surround.pop()
    return parts


def half_box(d, side, material):
    x0, x1 = (-0.6, 0) if side == 0 else (0, 0.6)
    return {"place": d.world.add("objects", "o", {"box": {"x0": x0, "y0": -0.5, "z0": -0.5, "x1": x1, "y1": 0.5, "z1": 0.5}, "material": material})}


def touching(d):
    index = around(d)[1]
    return [half_box(d, side, d.material({"inside": medium(d, index)[0]})) for side in (0, 1)]


def glass_on_opaque(d):
    return [half_box(d, 0, interface(d, False, d.chance(0.5))[0]), half_box(d, 1, d.opaque())]


def overlapping(d):
    index, parts = around(d)[1], []  # refracting surfaces that overlap in part would need an index to each side that changes along them
    for shift, priority in zip((-0.25, 0.25), d.rng.sample((1, 2, 3), 2)):  # equal ones that overlap in part are not defined
        name, _ = medium(d, index)
        d.world.scene["media"][name]["priority"] = priority
        o = d.world.add("objects", "o", box(d, d.material({"inside": name})))
        parts.append({"place": o, "translate": [shift, 0.1 * shift, 0]})
    return parts


def lit_glass(d):
    """Glass with a lamp in its middle."""
    made = d.pick("body", lambda r: r.name != "haze_body").make(d)[0]
    shape = d.world.scene["objects"][made[0]["place"]]
    made[0]["translate"] = [0, 0, -0.4 * next((shape[k]["height"] for k in ("cone", "cylinder") if k in shape), 0)]  # these begin at the origin
    d.pending_lamp = {"kind": "point", "intensity": round(d.level * d.u(2, 20), 3)}
    return [{"place": d.world.add("groups", "lit", made)}]


def volume(d):
    """Voxels of a medium; they stand in the scene itself, wherever the thing is placed: world.py moves them there."""
    name, _ = medium(d, 1)
    d.world.scene["media"][name].pop("priority", None)  # volumes add to whatever is there
    file = f"grid{len(d.world.files)}.vox"
    fields = {"density": [d.u(0, 2) for _ in range(8)]}
    if d.furnace and d.chance(0.5):
        fields["temperature_k"] = d.kelvin
    d.world.files[file] = shapes.voxels((2, 2, 2), 0.5, fields)
    grid = d.world.add("grids", "v", {"voxels": file, "medium": name})
    d.pending_volume = {"place": grid}
    return []


def cluster(d):
    parts = []
    for at in ((0.5, 0.3, 0.1), (-0.5, -0.3, 0), (0.1, -0.2, 0.7))[:d.one(2, 3)]:
        make = d.pick("thing", lambda r: r.name not in ("cluster", "volume", "lit_glass")).make
        things = make(d)
        parts.append(shrink(d, things[0] if isinstance(things, tuple) else things, 0.3, at))
    return parts


# --- floors and rooms ---
def ground(d, spec):
    d.place(d.world.add("objects", "floor", dict(spec, material=d.opaque())))


def floor_none(d):
    pass


def floor_plane(d):
    ground(d, {"plane": {"width": 14, "depth": 14}})


def floor_infinite(d):
    ground(d, {"plane": {"width": 0, "depth": 0}})


def floor_sinusoid(d):
    ground(d, {"sinusoid": {"width": 14, "depth": 14, "terms": [{"amplitude": 0.1, "kx": d.u(0.3, 2), "ky": d.u(0.3, 2), "phase": d.u(0, 6)}]}})


def floor_mesh(d):
    ground(d, {"obj_text": shapes.quad_mesh(14, 14, 3), "normals": "facet"})


def pool(d):
    """Water without end over a bed; something in it, perhaps."""
    name = d.world.add("media", "g", d.pick("medium", lambda r: r.name not in ("clear", "scattering", "leaves")).make(d, d.u(1.2, 1.5)))
    index = d.world.scene["media"][name].get("index")
    rough = d.chance(0.3) or "reciprocal" in d.traits
    top = d.material({"model": "ggx_dielectric", "roughness": d.roughness, "inside": name} if rough else {"model": "dielectric", "inside": name})
    d.place(d.world.add("objects", "top", {"plane": {"width": 0, "depth": 0}, "material": top}))
    d.place(d.world.add("objects", "bed", {"plane": {"width": 0, "depth": 0}, "material": d.opaque()}), translate=[0, 0, -1.5])
    d.surround.append((name, index if isinstance(index, float) else None))
    if d.maybe("in_water", 0.6):
        known = isinstance(index, float)
        make = d.pick("thing", lambda r: r.name in (("opaque", "a_body", "nested") if known else ("opaque",))).make
        d.world.scene["world"].append(dict(shrink(d, make(d), 0.5), translate=[d.u(-1, 1), d.u(-1, 1), -0.75]))
    d.surround.pop()
    d.world.facts["pool"] = name
    if isinstance(index, float):
        d.world.facts["pool_index"] = index


def room(kind):
    def make(d):
        spec = {"sphere": {"radius": 25}} if kind == "sphere" else {"box": {"x0": -14, "y0": -14, "z0": -3, "x1": 14, "y1": 14, "z1": 14}}
        row = d.pick("model", lambda r: r.name not in ("lambert_through", "leaf", "coated_through", "mirror"))
        material = row.make(d)
        if d.maybe("room_glows", 0.6):
            material = glow(d, d.u(0, 0.6))
        else:
            material = d.material({**material, **d.emission(True)})
        d.place(d.world.add("objects", "room", dict(spec, material=material)))
        d.world.facts["room"] = True
    return make


def glow(d, reflectance):
    """A material that a lamp of kind surface makes glow; in a furnace just as a warm one would."""
    m = d.world.add("materials", "glow", {"model": "lambert", "reflectance": reflectance})
    radiance = d.blackbody_curve(1 - reflectance) if d.furnace else round(d.level * d.u(0.5, 5), 3)
    both = d.furnace or d.chance(0.5)
    lamp = {"kind": "surface", "material": m, "radiance": radiance, **({"both_sides": True} if both else {})}
    if not d.furnace and not {"moved", "periodic"} & d.traits and d.maybe("lamp_map", 0.4):  # stands in scene ENU
        w, scale = d.wavelength, round(d.level * d.width * d.u(0.5, 5), 5)
        lamp.update(radiance=1, map={"file": rows_map.tiff(d, [d.one(0, 0.3, 1) for _ in range(rows_map.SIDE ** 2)]), "scale": scale,
                                     "band_um": [round(w * 0.9, 4), round(w * 1.1, 4)], "local": {"origin": [rows_map.ORIGIN, -rows_map.ORIGIN], "gsd": rows_map.GSD}})
    d.world.sim["lamps"].append(lamp)
    return m


def glowing(d):
    return [{"place": an_object(d, glow(d, d.u(0, 0.6) if d.chance(0.5) else 0), False)}]


# --- what fills space ---
def fill_none(d):
    pass


def layer(d):
    name, index = medium(d, 1)
    o = d.world.add("objects", "layer", {"box": {"z0": -0.4 if "pool" not in d.world.facts else 0.3, "z1": d.u(3.6, 5)}, "material": d.material({"inside": name})})
    d.place(o)
    d.surround.append((name, index))


def two_layers(d):
    low = -0.4 if "pool" not in d.world.facts else 0.3
    for z0, z1 in ((low, 3.5), (3.5, d.u(4, 6))):
        name, index = medium(d, 1)
        d.place(d.world.add("objects", "layer", {"box": {"z0": z0, "z1": z1}, "material": d.material({"inside": name})}))
        if z0 == low:
            d.surround.append((name, index))


def ambient(d):
    name = d.world.add("media", "h", d.pick("medium", lambda r: r.name in ("absorbing", "hazy", "leaves")).make(d, 1))
    d.world.scene["ambient"] = name
    d.surround.append((name, 1))
    d.world.facts["ambient"] = True


NO_ROOM = {"without": ("room_sphere", "room_box", "periodic")}
AMBIENT = ("layered_air", "profile_air", "profile_no_adjacency", "traced_air", "gases_air", "periodic")
FLOORS = ("floor_none", "floor_plane", "floor_infinite", "floor_sinusoid", "floor_mesh")
NO_POOL = FLOORS + ("room_sphere", "room_box")
NOT_A_ROOM = FLOORS + ("pool", "in_water", "point_in_water", "sun", "sun_collimated", "moon", "sky", "sky_full", "sky_table", "sky_thermal", "clear_sky", "night_sky",
                       "sky_furnace", "layered_air", "profile_air", "profile_no_adjacency", "traced_air", "gases_air")
SMOOTH = {"without": ("reciprocal",)}   # a point's light by a smooth surface is found from one end alone
SHADING = {"without": ("reciprocal",)}  # normals that are not the surface's are not reciprocal
ROWS = [
    ("plane", "shape", plane, {"weight": 1.5}), ("disk", "shape", disk, {"weight": 1.5}), ("box", "shape", box, CLOSED), ("sphere", "shape", sphere, CLOSED),
    ("cone", "shape", cone, CLOSED), ("cylinder", "shape", cylinder, CLOSED), ("pipe", "shape", pipe, {"weight": 1.5}), ("sinusoid", "shape", sinusoid, {"weight": 1.5}),
    ("mesh_box", "shape", mesh_box, CLOSED), ("mesh_ball", "shape", mesh_ball, CLOSED), ("mesh_smooth", "shape", mesh_smooth, {"weight": 2, **SHADING}),
    ("mesh_quad", "shape", mesh_quad, {"weight": 1.5}), ("solid_voxels", "shape", solid_voxels, {"weight": 1.5}),
    ("haze_body", "body", haze_body, {"weight": 2}), ("glass_index", "body", glass(False, False), SMOOTH), ("glass_medium", "body", glass(False, True), SMOOTH),
    ("rough_index", "body", glass(True, False)), ("rough_medium", "body", glass(True, True)),
    ("names_outside", "detail", None), ("glass_dispersion", "detail", None), ("nested_deep", "detail", None), ("in_water", "detail", None, {"without": NO_POOL}),
    ("room_glows", "detail", None, {"without": NOT_A_ROOM}),
    ("opaque", "thing", opaque, {"weight": 3}), ("a_body", "thing", a_body, {"weight": 2}), ("pane", "thing", pane),
    ("nested", "thing", nested, {"weight": 2}), ("touching", "thing", touching), ("glass_on_opaque", "thing", glass_on_opaque),
    ("overlapping", "thing", overlapping), ("volume", "thing", volume, {"without": ("no_volume",)}), ("cluster", "thing", cluster),
    ("lit_glass", "thing", lit_glass, {"without": ("furnace", "reciprocal", "no_lit_glass")}), ("glows_within", "detail", None, {"without": ("furnace",)}),
    ("glowing", "thing", glowing), ("lamp_map", "detail", None),
    ("floor_none", "floor", floor_none, {"weight": 1.5}), ("floor_plane", "floor", floor_plane), ("floor_infinite", "floor", floor_infinite),
    ("floor_sinusoid", "floor", floor_sinusoid), ("floor_mesh", "floor", floor_mesh), ("pool", "floor", pool, {"weight": 2}),
    ("room_sphere", "floor", room("sphere"), {"weight": 2.4, "without": ("no_room",)}),
    ("room_box", "floor", room("box"), {"weight": 2.8, "without": ("no_room",)}),
    ("fill_none", "fill", fill_none, {"weight": 3}), ("layer", "fill", layer, {"weight": 1.5}), ("two_layers", "fill", two_layers),
    ("ambient", "fill", ambient, {"weight": 1.6, "without": AMBIENT}),  # air of the simulation fills all space, too
]
