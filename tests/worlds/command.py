"""The command: many worlds, a log that is gone on from, a summary, failures minimised to small texts."""
import argparse
import concurrent.futures
import json
import os
import shutil
import sys
import tempfile

import evaluate
import minimise
import report
from known import KNOWN, OPEN, REPORTED
from programs import Programs
from relations import RELATIONS
from rows import TABLE

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))


QUICK = (900001, 900003, 900004, 900005, 900006, 900007, 900029, 900010, 900011, 900012, 900013, 900014, 900015, 900050, 900017, 900019, 900022, 900023, 900024, 900026, 900027, 900028)  # of the default tests: quick ones


def options(words):
    p = argparse.ArgumentParser(prog="tests/worlds/run", description="Random worlds and what must hold of them. README.md says what for.")
    p.add_argument("--seeds", default="0:200", metavar="A:B", help="worlds A to B - 1 (default 0:200)")
    p.add_argument("--jobs", type=int, default=1, metavar="N", help="processes (default 1)")
    p.add_argument("--relation", choices=sorted(RELATIONS), help="this one for all worlds; by weights unless given")
    p.add_argument("--rows", nargs="+", choices=sorted(TABLE), metavar="ROW", help="only worlds that are drawn from one of these")
    p.add_argument("--binaries", default=os.path.join(ROOT, "build/release/bin"), metavar="DIR", help="scene-prep, dirsig-render, sqt-fit")
    p.add_argument("--log", metavar="FILE", help="a line of JSON a world; worlds that are in it are not run again")
    p.add_argument("--keep", metavar="DIR", help="failures, minimised: scene.yaml, sim.yaml and what is wrong")
    p.add_argument("--no-minimise", action="store_true", help="keep failures as they were drawn")
    p.add_argument("--summary", action="store_true", help="print the summary of --log and stop")
    p.add_argument("--pairs", metavar="FILE", help="write the table of pairs of rows as CSV")
    p.add_argument("--show", metavar="SEED", help="write the worlds of this seed to --keep and stop")
    p.add_argument("--factor", type=int, metavar="N", help="so many times the relation's paths (default: what takes about 0.2 s)")
    p.add_argument("--known", action="store_true", help="the known faults of known.py alone")
    p.add_argument("--quick", action="store_true", help="the set of the default tests: fixed seeds, any failure is an error")
    return p.parse_args(words)


def one(job):
    """In a process of its own: a world, and if it fails its smallest form."""
    seed, name, binaries, keep, small, factor = job
    scratch = os.path.join(tempfile.gettempdir(), f"worlds_{os.getpid()}")
    programs = Programs(binaries, scratch)
    relation = evaluate.named(seed, name)
    result = evaluate.evaluate(programs, seed, relation, scratch + "/now", factor)
    if keep and result.status not in ("holds", "none"):
        folder = os.path.join(keep, f"{result.relation}_{seed}")
        minimise.keep(programs, result, relation, folder, scratch + "/small", small)
    shutil.rmtree(scratch + "/now", ignore_errors=True)
    return result.plain(), programs.warnings


def run_all(o, seeds, log):
    done = report.read(log)
    seeds = [s for s in seeds if str(s) not in done and (not o.rows or evaluate.has_row(s, evaluate.named(s, o.relation), o.rows))]
    results, warnings = list(done.values()), {}
    jobs = ((s, o.relation, o.binaries, o.keep, not o.no_minimise, o.factor) for s in seeds)
    with concurrent.futures.ProcessPoolExecutor(o.jobs) as pool:
        for result, told in pool.map(one, jobs):
            results.append(result)
            for k, n in told.items():
                warnings[k] = warnings.get(k, 0) + n
            if log:
                with open(log, "a") as file:
                    file.write(json.dumps(result) + "\n")
            if result["status"] not in ("holds", "none"):
                print(report.line(result), flush=True)
    return results, warnings


def run_known(o):
    results = []
    with tempfile.TemporaryDirectory() as scratch:
        programs = Programs(o.binaries, scratch)
        for name, make in KNOWN.items():
            r = evaluate.known(programs, name, make, REPORTED.get(name), scratch + "/now").plain()
            if r["status"] == "fails" and name in OPEN:
                r["status"] = "open"
            results.append(r)
            print(f"  {r['status']:8} {name:26} {100 * r['size']:+9.3f} % at {r['where']} (p {r['p']:.1g})  {r['cpu']:5.1f} s", flush=True)
    return results


def main(words=None):
    o = options(words)
    if o.keep:
        o.keep = os.path.realpath(o.keep)
    if o.summary:
        print(report.summary(list(report.read(o.log).values()), o.pairs))
        return 0
    if o.show:
        relation = evaluate.named(int(o.show), o.relation)
        programs = Programs(o.binaries, tempfile.mkdtemp())
        minimise.show(programs, int(o.show), relation, o.keep)
        return 0
    if o.known:
        return 1 if any(r["status"] not in ("holds", "open") for r in run_known(o)) else 0
    if o.quick:
        o.factor, o.jobs, o.relation = 2, 1, "quick"
        results, _ = run_all(o, QUICK, None)
        print(report.summary(results))
        return 1 if any(r["status"] not in ("holds", "none") for r in results) else 0
    low, high = (int(x) for x in o.seeds.split(":"))
    results, warnings = run_all(o, range(low, high), o.log)
    print(report.summary(results, o.pairs))
    for text, n in sorted(warnings.items(), key=lambda x: -x[1])[:12]:
        print(f"  {n:5} x {text}")
    return 1 if any(r["status"] not in ("holds", "none") for r in results) else 0


if __name__ == "__main__":
    sys.exit(main())
