"""Failures made small: things are dropped from the world as long as the relation goes on failing (delta debugging)."""
import json
import os
import random

import judge
from evaluate import case_of, draw, pictures_of
from programs import Refused

MOST_TRIES = 150


def write(programs, case, folder, text):
    for k, (_, world, *_) in enumerate(case.terms):
        programs.write(world, os.path.join(folder, f"term{k}") if k else folder)
    with open(os.path.join(folder, "README"), "w") as file:
        file.write(text)


def show(programs, seed, relation, folder):
    world, case = draw(seed, relation)
    if case:
        write(programs, case, folder, f"{relation.name} {seed}: {case.note}\nrows: {', '.join(sorted(world.rows))}\n")
        print(f"{relation.name}: {case.note}; terms {[c for c, *_ in case.terms]}; rows {', '.join(sorted(world.rows))}")


class Failing:
    """Does the relation still fail, and with what size? Fewer seeds than the last judgement, since many questions are asked."""

    def __init__(self, programs, relation, seed, scratch, like):
        self.programs, self.relation, self.seed, self.scratch, self.like = programs, relation, seed, scratch, like
        self.tries, self.found = 0, ""

    def __call__(self, world):
        self.tries += 1
        try:
            case = case_of(world, self.relation, self.seed)
            if not case:
                return False
            if case.exact:
                self.found = case.exact(self.programs, os.path.join(self.scratch, "term0"), 1)
                return bool(self.found) and self.like.status == "fails"
            runs = pictures_of(self.programs, case, self.scratch, range(1, 9), max(4, self.like.factor))
        except Refused as refused:
            self.found = refused.text
            same = refused.text.splitlines()[-1][:40] == self.like.where.splitlines()[-1][:40] if refused.text and self.like.where else False
            return self.like.status == "crash" and refused.code not in (0, 1, 2) or self.like.status == "refused" and same
        except Exception:
            return False
        finding = judge.by_seeds(case, runs)
        self.found = f"{100 * finding.size:+.3g} % at {finding.where} (p {finding.p:.1g})"
        big = abs(finding.size) > 0.2 * abs(self.like.size)
        return self.like.status == "fails" and finding.p < 1e-4 and big


def without(world, change):
    made = world.copy()
    return made if change(made) is not False else None


def candidates(world):
    """Ways to make the world smaller, the largest steps first; each a function that changes a copy."""
    ways = []

    def drop(table, k):
        return lambda w: table(w).pop(k)

    walls = {"room"} if world.facts["furnace"] else set()  # without them, or the sky, it is no furnace
    for k in range(len(world.scene["world"])):
        if world.scene["world"][k]["place"].rstrip("0123456789") in walls:
            continue
        ways.append((f"world {k}", drop(lambda w: w.scene["world"], k)))
    for k in range(len(world.scene["volumes"])):
        ways.append((f"volume {k}", drop(lambda w: w.scene["volumes"], k)))
    for k in range(0 if world.facts["furnace"] else len(world.sim["lamps"])):
        ways.append((f"lamp {k}", drop(lambda w: w.sim["lamps"], k)))
    for k in range(len(world.sim["sensors"])):
        if len(world.sim["sensors"]) > 1:
            ways.append((f"sensor {k}", drop(lambda w: w.sim["sensors"], k)))
    for key in ("sun", "moon", "sky", "night_sky", "atmosphere"):
        if key in world.sim and not (key == "sky" and world.facts["furnace"]):
            ways.append((key, drop(lambda w: w.sim, key)))
    for name, group in world.scene["groups"].items():
        if len(group) > 1:
            ways += [(f"{name} {k}", drop(lambda w, n=name: w.scene["groups"][n], k)) for k in range(len(group))]
    for table in ("ambient",):
        if table in world.scene:
            ways.append((table, drop(lambda w: w.scene, table)))
    return ways + simpler(world)


def simpler(world):
    ways = []

    def put(path, value):
        def change(w):
            at = w
            for key in path[:-1]:
                at = at[key] if isinstance(at, (dict, list)) else getattr(at, key)
            if value is None:
                if path[-1] not in at:
                    return False
                del at[path[-1]]
            elif at.get(path[-1]) == value:
                return False
            else:
                at[path[-1]] = value
        return change

    def placements():
        yield from ((("scene", "world", k), p) for k, p in enumerate(world.scene["world"]))
        for g, group in world.scene["groups"].items():
            yield from ((("scene", "groups", g, k), p) for k, p in enumerate(group))

    for at, p in placements():
        ways += [(f"{at} {k}", put((*at, k), None)) for k in ("rotate", "scale", "appears", "disappears", "schedule") if k in p]
    for name, m in world.scene["materials"].items():
        ways += [(f"{name} {k}", put(("scene", "materials", name, k), None)) for k in ("maps", "roughness_y", "transmittance", "outside") if k in m]
        if m.get("model") not in (None, "lambert", "dielectric", "ggx_dielectric"):
            plain = {"model": "lambert", "reflectance": 0.5, **{k: v for k, v in m.items() if k.startswith(("temperature", "thermal"))}}
            ways.append((f"{name} lambert", put(("scene", "materials", name), plain)))
        if m.get("model") == "ggx_dielectric":
            ways.append((f"{name} smooth", put(("scene", "materials", name, "model"), "dielectric")))
            ways[-1] = (f"{name} smooth", lambda w, n=name: w.scene["materials"][n].update(model="dielectric") or w.scene["materials"][n].pop("roughness", None) and None)
    for name, m in world.scene["media"].items():
        ways += [(f"{name} {k}", put(("scene", "media", name, k), None)) for k in ("phase", "priority", *(() if world.facts["furnace"] else ("temperature_k",))) if k in m]
        if len(m) > 1 or "water" in m or "leaves" in m:
            small = {"absorption": 0.3, **{k: m[k] for k in ("index", "temperature_k", "priority") if k in m}}
            ways.append((f"{name} absorbs", put(("scene", "media", name), small)))
    for name, o in world.scene["objects"].items():
        if not {"plane", "disk", "sphere"} & set(o) and not ("box" in o and "x0" not in o["box"]):
            ways.append((f"{name} sphere", put(("scene", "objects", name), {"sphere": {"radius": 0.6}, "material": o.get("material", "")})))
    return ways


def smallest(world, fails):
    """One-minimal in the candidates, or as small as MOST_TRIES lets it be."""
    again = True
    while again and fails.tries < MOST_TRIES:
        again = False
        k = 0
        while fails.tries < MOST_TRIES:
            ways = candidates(world)
            if k >= len(ways):
                break
            try:
                made = without(world, ways[k][1])
            except (KeyError, IndexError, AttributeError):
                made = None
            if made is not None and json.dumps([made.scene, made.sim]) != json.dumps([world.scene, world.sim]) and fails(made):
                world, again = made, True
            else:
                k += 1
    return world


def keep(programs, result, relation, folder, scratch, small):
    """Writes the failure, as small as it gets."""
    try:
        world, case = draw(int(result.seed), relation)
    except Exception:
        return
    if not case:
        return
    fails = Failing(programs, relation, int(result.seed), scratch, result)
    if small and result.status != "broken" and fails(world):
        world = smallest(world, fails)
        case = case_of(world, relation, int(result.seed))
        fails(world)
    coefficients = " ".join(f"{c:+g}" for c, *_ in case.terms)
    text = (f"{relation.name} {result.seed}: {case.note}\n{relation.make.__doc__}\nterms (this folder, term1, ...): {coefficients}; seen when drawn: {100 * result.size:+.3g} % "
            f"{result.where}\nsmallest: {fails.found}\nrows when drawn: {', '.join(result.rows)}\n")
    random.seed(0)
    write(programs, case, folder, text)
