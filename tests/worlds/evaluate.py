"""One world: drawn, rendered, judged in three steps (judge.py)."""
import os
import random
from dataclasses import asdict, dataclass, field

import judge
from programs import Refused, cpu_seconds, kept
from relations import SECONDS, relation_of
from rows import TABLE
from world import draw_world


FLOOR = 0.1                    # of the level of light; times the tolerance 1e-5: what is below 1e-4 of the light has no bins of its own (SENSORS.md)
KNOWN_BOUND = 1e-4             # of a known fault, judged by the spread between its seeds
LEAST_MORE = {2: 2, 3: 4}      # times the paths of the screening, however long it takes: means of few paths are not normal
PILOT, MOST = 3, 64            # times the relation's paths
GROUNDLESS = 1e-2              # of the air below its own ground: its source is interpolated over all of the way there
BENT = 1e-2                    # of surfaces whose normals are turned by t: (1 - cos t) / 2 of what they scatter goes below them
START = 0.04                   # s of CPU that starting takes


@dataclass
class Result:
    seed: str
    relation: str
    status: str = "holds"          # holds, fails, none (nothing to take hold of), refused (exit 1 or 2), crash
    rows: list = field(default_factory=list)
    note: str = ""
    where: str = ""
    p: float = 1.0
    size: float = 0.0              # relative difference at the least probable test
    seen: float = 0.0              # relative difference that is seen with a chance of 90 %
    score: float = 0.0
    step: int = 1                  # 1: screened, 2, 3: judged by seeds
    cpu: float = 0.0
    worlds: int = 0
    factor: int = 0                # times the relation's paths in the screening

    def plain(self):
        return asdict(self)


def draw(seed, relation, table=TABLE):
    """-> world, case (or None) of a seed."""
    world = draw_world(f"{relation.name} {seed}", relation.traits, table, relation.paths)
    return world, case_of(world, relation, seed)


def has_row(seed, relation, rows):
    """Whether the world of a seed was drawn from one of these rows."""
    return bool(draw(seed, relation)[0].rows & set(rows))


def groundless(world):
    """Whether rays may run on below the ground that real air stands on: nothing ends them there."""
    return "profile" in world.sim.get("atmosphere", {}) and "floor_none" in world.rows


def case_of(world, relation, seed):
    case = relation.make(world.copy(), random.Random(f"relation {seed}"))
    if case:
        case.floor = FLOOR * world.facts["level"]
        case.tolerance = max(case.tolerance, world.facts.get("spectral_error", 0), GROUNDLESS if groundless(world) else 0,
                             BENT if "furnace" in relation.traits and world.rows & {"normal_map", "bump", "mesh_smooth"} else 0)
    return case


def pictures_of(programs, case, folder, seeds, factor=1, pilot=None):
    """-> for each seed a list, a term each, of {sensor: Picture}. pilot: those of the first term, if they are there.

    All terms have the same seed: what takes the same paths has the same noise, which cancels. judge.py does not count on it."""
    terms = []
    for k, (_, world, *names) in enumerate(case.terms):
        runs = pilot if pilot and k == 0 else programs.pictures(world, os.path.join(folder, f"term{k}"), [s * 16 for s in seeds], factor)
        renamed = names[0] if names else {}
        terms.append([{renamed.get(n, n): p for n, p in run.items()} for run in runs])
    for others in terms[1:]:
        if set(others[0]) != set(terms[0][0]):
            raise Refused(0, f"other pictures: {sorted(others[0])} for {sorted(terms[0][0])}")
    return [list(run) for run in zip(*terms)]


def factor_of(programs, case, folder, seed, fixed, wanted=SECONDS):
    """-> times the relation's paths that take about so many seconds a term, pictures of the first term if it took them."""
    if fixed:
        return fixed, None, 0.05
    programs.prepare(case.terms[0][1], os.path.join(folder, "term0"), PILOT)
    before = cpu_seconds()
    pilot = [kept(programs.render(os.path.join(folder, "term0"), seed * 16), case.terms[0][1].facts.get("kept"))]
    spent = max(cpu_seconds() - before - START, 0.005)
    factor = min(MOST, int(PILOT * wanted / spent))
    return (PILOT, pilot, spent / PILOT) if factor < 2 * PILOT else (factor, None, spent / PILOT)


def seconds_of_paths(programs, folder, world, seed, factor, seconds):
    """CPU that once the relation's paths take, without what tables take that are made first; seconds: with that."""
    programs.prepare(world, folder, 4 * factor)
    before = cpu_seconds()
    programs.render(folder, seed * 16)
    return max((cpu_seconds() - before - seconds * factor) / (3 * factor), 1e-4)


def judged(programs, case, folder, first_seed, fixed=None, wanted=SECONDS):
    """-> Finding of the last step taken, which that was (4: fails), and the factor of its paths."""
    factor, pilot, seconds = factor_of(programs, case, folder, first_seed, fixed, wanted)
    found = judge.screen(case, pictures_of(programs, case, folder, [first_seed], factor, pilot)[0])
    if found.p > judge.SCREEN:
        return found, 1, factor
    seen, score = found.seen, found.score
    each = seconds_of_paths(programs, os.path.join(folder, "term0"), case.terms[0][1], first_seed, factor, seconds)
    for step, seeds, more, bound, most in ((2, judge.RETEST_SEEDS, judge.RETEST_PATHS, judge.RETEST, 10), (3, judge.FINAL_SEEDS, judge.FINAL_PATHS, judge.FINAL, 60)):
        paths = max(factor * LEAST_MORE[step], min(factor * more, int(most / (each * seeds * len(case.terms)))))
        runs = pictures_of(programs, case, folder, range(first_seed + 100 * step, first_seed + 100 * step + seeds), paths)
        again = judge.by_seeds(case, runs)
        again.seen, again.score = seen, score
        if again.p > bound:
            return again, step, factor
        found = again
    return found, 4, factor


def evaluate(programs, seed, relation, folder, fixed=None):
    before = cpu_seconds()
    programs.forget()
    result = Result(str(seed), relation.name)
    try:
        world, case = draw(seed, relation)
        result.rows = sorted(world.rows)
        if case is None:
            result.status = "none"
        else:
            result.worlds, result.note = len(case.terms), case.note
            run_case(programs, case, result, folder, seed, fixed, relation.seconds)
    except Refused as refused:
        result.status = "refused" if refused.code in (0, 1, 2) else "crash"
        result.where = refused.text
    except Exception as fault:  # a fault of the generator is a finding, too
        result.status, result.where = "broken", f"{type(fault).__name__}: {fault}"
    result.cpu = cpu_seconds() - before
    return result


def run_case(programs, case, result, folder, seed, fixed, seconds):
    first = random.Random(f"paths {seed}").randrange(1, 10 ** 6)
    if case.exact:
        result.where = case.exact(programs, os.path.join(folder, "term0"), first)
        result.status = "fails" if result.where else "holds"
        result.p = 0.0 if result.where else 1.0
        return
    found, step, result.factor = judged(programs, case, folder, first, fixed, seconds)
    result.p, result.where, result.size, result.seen, result.score = found.p, found.where, found.size, found.seen, found.score
    result.step = min(step, 3)
    result.status = "fails" if step == 4 else "holds"


def known(programs, name, make, reported, folder, seeds=6):
    """-> Result of a known fault: judged by seeds at once."""
    before, result = cpu_seconds(), Result(name, "known")
    try:
        programs.forget()
        case = make()
        result.note, result.worlds, programs.warnings = make.__doc__, len(case.terms), {}
        found = judge.by_seeds(case, pictures_of(programs, case, folder, range(1, 1 + seeds)))
        result.p, result.where, result.size = found.p, found.where, found.size
        told = reported and any(reported in text for text in programs.warnings)
        result.status = "fails" if found.p < KNOWN_BOUND and not told else "holds"
    except Refused as refused:
        result.status, result.where = "refused" if refused.code in (0, 1, 2) else "crash", refused.text
    result.cpu = cpu_seconds() - before
    return result


def named(seed, only=None):
    return relation_of(seed, only)
