"""A random world: the text of a scene and of a simulation as plain data, the files they name, and the rows it was drawn from.

Draw is what rows (rows*.py) are given to draw with: a seeded generator, what is fixed for the whole world (wavelength,
temperature, level of light), and helpers that put a piece into the text. world() draws one.
"""
import copy
import json
import math
import random

C1, C2 = 1.191042972397188e8, 1.438776877503933e4  # W um4 / (m2 sr), um K (CODATA 2018)


def planck(wavelength_um, kelvin):
    """Spectral radiance of a blackbody, W/(m2 sr um)."""
    return C1 / wavelength_um ** 5 / math.expm1(C2 / (wavelength_um * kelvin))


def band_mean(low, high, value, steps=16):
    """Mean of value(wavelength) over a rectangular band, Simpson's rule."""
    h = (high - low) / (2 * steps)
    return sum((1 if i in (0, 2 * steps) else 4 if i % 2 else 2) * value(low + i * h) for i in range(2 * steps + 1)) / (6 * steps)


class World:
    def __init__(self):
        self.scene = {"scene": 1, "materials": {}, "media": {}, "maps": {}, "grids": {}, "volumes": [], "objects": {}, "groups": {}, "world": []}
        self.sim = {"scene": "scene.h5", "seed": 1, "lamps": [], "sensors": []}
        self.files = {}       # name -> bytes
        self.rows = set()     # names of what was drawn
        self.facts = {}       # what relations need to know: see Draw

    def copy(self):
        return copy.deepcopy(self)

    def add(self, table, prefix, value):
        entries = self.scene[table]
        n = len(entries)
        while f"{prefix}{n}" in entries:
            n += 1
        entries[f"{prefix}{n}"] = value
        return f"{prefix}{n}"

    def texts(self, paths_factor=1):
        """-> scene text, simulation text; tables that hold nothing are left out, and lamps whose material nothing carries."""
        scene = {k: v for k, v in prune(self.scene).items() if v not in ({}, [])}
        sim = dict(self.sim)
        sim["lamps"] = [lamp for lamp in sim["lamps"] if "material" not in lamp or lamp["material"] in scene.get("materials", {})]
        if paths_factor != 1:
            sim = with_paths(sim, paths_factor)
        return json.dumps(scene, indent=1), json.dumps({k: v for k, v in sim.items() if v != []}, indent=1)


def with_paths(value, factor):
    """The text with so many times the paths."""
    if isinstance(value, list):
        return [with_paths(v, factor) for v in value]
    if not isinstance(value, dict):
        return value
    return {k: (factor * v if isinstance(v, int) else {**v, "min": factor * v["min"], "max": factor * v["max"]}) if k == "paths" else
            with_paths(v, factor) for k, v in value.items()}


def names_in(value):
    """All texts within a piece of data."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        for v in value.values():
            yield from names_in(v)
    elif isinstance(value, list):
        for v in value:
            yield from names_in(v)


def prune(scene):
    """The scene without materials, media, maps, grids, objects and groups that nothing names."""
    kept, roots = dict(scene), [scene["world"], scene["volumes"], scene.get("ambient", "")]
    tables = ("groups", "objects", "grids", "materials", "maps", "media")
    used, todo = set(), [n for root in roots for n in names_in(root)]
    while todo:
        name = todo.pop()
        if name not in used:
            used.add(name)
            todo += [n for t in tables if name in scene[t] for n in names_in(scene[t][name])]
    for t in tables:
        kept[t] = {k: v for k, v in scene[t].items() if k in used}
    return kept


class Draw:
    """What rows draw with. traits: what the relation wants ('furnace', 'reciprocal', ...)."""

    def __init__(self, seed, traits, table):
        self.rng = random.Random(f"worlds {seed}")
        self.traits, self.table, self.world = set(traits), table, World()
        self.wavelength, self.width, self.kelvin, self.level = 0.55, 0.01, 1800.0, 100.0  # the spectrum row says which
        self.surround = []    # names of the media around what is being drawn, the innermost last; None: a body without a name
        self.moving = False   # something moves: the capture has a duration
        self.roughness = self.u(0.15, 0.6)  # of all facets: one table a world
        self.wind = self.u(3, 12)

    # --- numbers ---
    def u(self, low, high):
        return round(self.rng.uniform(low, high), 4)

    def chance(self, p):
        return self.rng.random() < p

    def one(self, *choices):
        return self.rng.choice(choices)

    def curve(self, value, low=0.0, high=1.0):
        """A number, or (row 'curves') a curve through it."""
        if not self.maybe("curves", 0.15):
            return value
        other = min(max(value * self.u(0.9, 1.1), low), high)
        return {"wavelength_um": [self.wavelength * 0.5, self.wavelength, self.wavelength * 2], "value": [value, value, round(other, 5)],
                "outside": "hold"}

    # --- rows ---
    def may(self, name):
        row = self.table[name]
        taken = self.world.rows | self.traits
        return not (row.without & taken) and not any(name in self.table[r].without for r in self.world.rows)

    def take(self, name):
        self.world.rows.add(name)
        return self.table[name]

    def pick(self, group, ok=lambda row: True):
        """A row of the group that goes with all that is there; None where none does."""
        rows = [r for r in self.table.values() if r.group == group and self.may(r.name) and ok(r)]
        if not rows:
            return None
        row = self.rng.choices(rows, [r.weight for r in rows])[0]
        return self.take(row.name)

    def maybe(self, name, p):
        """Takes a row of details with that chance, where it may be."""
        if not self.chance(p) or not self.may(name):
            return False
        self.take(name)
        return True

    @property
    def furnace(self):
        return "furnace" in self.traits

    # --- pieces of the text ---
    def emission(self, warm=None):
        """-> entries for a material that may be warm; always in a furnace."""
        if self.furnace or (warm if warm is not None else self.chance(0.3)):
            row = self.pick("temperature")
            return row.make(self, self.kelvin if self.furnace else round(self.kelvin * self.u(0.93, 1.0), 1))
        return {}

    def material(self, spec):
        return self.world.add("materials", "m", spec)

    def opaque(self):
        """A material that nothing is looked through, with maps perhaps."""
        spec = dict(self.pick("model").make(self))
        spec.update(self.emission())
        if self.chance(0.8):
            row = self.pick("map")
            if row:
                spec = row.make(self, spec)
        return self.material(spec)

    def place(self, name, **placement):
        self.world.scene["world"].append({"place": name, **placement})

    def blackbody_curve(self, scale=1.0):
        """B(T) of the furnace times scale, over all bands."""
        low, high = self.wavelength * 0.97, self.wavelength * 1.33
        grid = [low + (high - low) * i / 240 for i in range(241)]
        return {"wavelength_um": [round(w, 7) for w in grid], "value": [scale * planck(round(w, 7), self.kelvin) for w in grid], "outside": "hold"}

    def light_curve(self, radiance):
        return radiance


# --- drawing a whole world ---
SLOTS = [(x, y) for x in (-3.2 / 2, 3.2 / 2) for y in (-1.6, 1.6)]  # middles of cells of 3.2 m in which things stand


def place_thing(d, slot):
    """Draws a thing and puts it into a slot, which it does not leave whatever it is turned or scaled by."""
    d.pending_volume = d.pending_lamp = None
    made = d.pick("thing").make(d)
    parts = made[0] if isinstance(made, tuple) else made
    place = [slot[0], slot[1], 1.6]
    if d.pending_volume:
        d.world.scene["volumes"].append({**d.pending_volume, "rotate": {"heading_deg": d.u(0, 360)}, "translate": place})
        return
    d.holds_media = any("inside" in m for m in d.world.scene["materials"].values())
    if not d.holds_media:
        del d.holds_media
    single = len(parts) == 1 and set(parts[0]) == {"place"}
    name = parts[0]["place"] if single else d.world.add("groups", "thing", parts)
    row = d.pick("placing", lambda r: not d.pending_lamp or "about_middle" in r.what)
    d.world.scene["world"].append(row.make(d, name, place))
    if d.pending_lamp:
        d.world.sim["lamps"].append({**d.pending_lamp, "position_m": place})
    d.__dict__.pop("holds_media", None)


def add_lights(d):
    if d.furnace:
        if not d.world.facts.get("room"):
            d.pick("light_furnace").make(d)
        return
    sky = d.pick("sky") if d.chance(0.95) else None
    if sky:
        sky.make(d)
    for _ in range(d.one(1, 1, 2)):
        row = d.pick("light")
        if row:
            row.make(d)


def draw_world(seed, traits, table, paths=4):
    d = Draw(seed, traits, table)
    d.world.facts.update(paths=paths, furnace=d.furnace)
    d.pick("spectrum").make(d)
    if d.maybe("two_bands", 0.2):
        table["two_bands"].make(d)
    d.pick("air").make(d)
    host = d.one("pool", "fill") if "wants_media" in d.traits else None
    d.pick("floor", lambda r: host != "pool" or r.name == "pool").make(d)
    if d.surround:
        d.surround = []
    d.pick("fill", lambda r: host != "fill" or r.name != "fill_none").make(d)
    slots = SLOTS[:]
    d.rng.shuffle(slots)
    for slot in slots[:d.one(2, 3, 3, 4)]:
        place_thing(d, slot)
    if not d.world.scene["world"]:  # volumes alone are no scene
        d.place(d.world.add("objects", "o", {"sphere": {"radius": 0.3}, "material": d.opaque()}), translate=[0, 0, 0.5])
    add_lights(d)
    for k in range(d.one(1, 2, 2)):
        cameras = k == 0 and "wants_camera" in traits
        row = d.pick("sensor", lambda r: r.name not in d.world.rows and (not cameras or r.name in ("frame", "orthographic")))
        if row:
            row.make(d)
    if "periodic" in d.traits:
        d.world.sim["periodic"] = {"origin_m": [-4.0, -4.0], "size_m": [8.0, 8.0]}
    windows = {"windows_um": [[round(d.wavelength * 0.98, 5), round(d.wavelength * (1.22 if "two_bands" in d.world.rows else 1.02), 5)]]}
    d.world.scene.update(windows)
    d.world.facts.update(level=d.level, wavelength=d.wavelength, width=d.width, kelvin=d.kelvin, moving=d.moving)
    return d.world
