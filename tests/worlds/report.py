"""The log, and the summary of it: what failed, how often each relation and pair of rows was drawn, what it would have seen."""
import json
import math
import os
import statistics

from rows import TABLE

LEAST = 20  # worlds in 2,000 that a pair of rows must be in


def read(log):
    """-> {seed: result}"""
    if not log or not os.path.exists(log):
        return {}
    with open(log) as file:
        return {r["seed"]: r for r in map(json.loads, filter(str.strip, file))}


def line(r):
    where = r["where"].replace("\n", " | ")[:300]
    size = f" {100 * r['size']:+.3g} % (p {r['p']:.1g})" if r["status"] == "fails" and r["size"] else ""
    return f"{r['status']:8} {r['relation']} {r['seed']}: {r['note']}:{size} {where}"


def pairs(results):
    """-> {(row, row): worlds}, of worlds that were judged."""
    counts = {}
    for r in results:
        if r["status"] in ("holds", "fails"):
            for i, a in enumerate(r["rows"]):
                for b in r["rows"][i:]:
                    counts[a, b] = counts.get((a, b), 0) + 1
    return counts


def never(a, b):
    """Rows that are not drawn together: two of what a world has one of, or because one says so."""
    a, b = TABLE[a], TABLE[b]
    single = {"spectrum", "floor", "fill", "air", "sky", "light_furnace"}
    furnace = {"sky_furnace"} & {a.name, b.name} and "furnace" in a.without | b.without
    return furnace or a is not b and a.group == b.group and a.group in single or a.name in b.without or b.name in a.without


def rare_pairs(results):
    counts, names = pairs(results), sorted(n for n in TABLE)
    judged = sum(r["status"] in ("holds", "fails") for r in results)
    least = LEAST * judged / 2000
    return [(counts.get((a, b), 0), a, b) for i, a in enumerate(names) for b in names[i:] if not never(a, b) and counts.get((a, b), 0) < least]


def power(results):
    """A line a relation: worlds, what failed, relative difference seen with a chance of 90 % (median, worst), mean of z."""
    lines = [f"  {'relation':18} worlds  holds  fails  other  again   seen at 90 %: median    worst   sum of z   CPU s"]
    for name in sorted({r["relation"] for r in results}):
        rows = [r for r in results if r["relation"] == name]
        seen = [100 * r["seen"] for r in rows if r["status"] in ("holds", "fails") and 0 < r["seen"] < math.inf]
        z = [r["score"] for r in rows if r["status"] == "holds" and r["score"]]
        median, worst = (f"{statistics.median(seen):8.3f} %", f"{max(seen):8.3g} %") if seen else ("   exact", "   exact")
        count = {s: sum(r["status"] == s for r in rows) for s in ("holds", "fails")}
        total = f"{sum(z) / math.sqrt(len(z)):+6.2f}" if z else "      "
        lines.append(f"  {name:18} {len(rows):6} {count['holds']:6} {count['fails']:6} {len(rows) - sum(count.values()):6} "
                     f"{sum(r['step'] > 1 for r in rows):6} {median:>24} {worst:>10} {total:>10} {sum(r['cpu'] for r in rows):7.0f}")
    return lines


def summary(results, table=None):
    lines = [f"{len(results)} worlds, {sum(r['worlds'] for r in results)} scenes, {sum(r['cpu'] for r in results):.0f} s of CPU"] + power(results)
    bad = [r for r in results if r["status"] not in ("holds", "none")]
    lines += [f"{len(bad)} that do not hold:"] + ["  " + line(r) for r in bad[:60]] if bad else ["all hold"]
    rare = sorted(rare_pairs(results))
    counts, names = pairs(results), sorted(TABLE)
    least = sorted((counts.get((a, b), 0), a, b) for i, a in enumerate(names) for b in names[i + 1:] if not never(a, b))[:10]
    lines.append("least pairs of rows: " + ", ".join(f"{a} x {b} {n}" for n, a, b in least))
    lines.append(f"pairs of rows drawn less often than {LEAST} in 2,000: {len(rare)}" + "".join(f"\n  {n:4} {a} x {b}" for n, a, b in rare[10:30]))
    if table:
        write_pairs(results, table)
    return "\n".join(lines)


def write_pairs(results, path):
    counts, names = pairs(results), sorted(TABLE)
    with open(path, "w") as file:
        file.write("," + ",".join(names) + "\n")
        for a in names:
            cells = ["-" if never(*sorted((a, b))) else str(counts.get(tuple(sorted((a, b))), 0)) for b in names]
            file.write(a + "," + ",".join(cells) + "\n")
