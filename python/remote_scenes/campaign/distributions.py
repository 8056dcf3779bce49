"""What a value may be: a constant, a draw of a kind, a point of a grid, or what another variable decides.

Reading gives a Rule; `Rule.value(context)` is its value for one sample. `$NAME` in a rule is the value of another variable.
"""
from __future__ import annotations

import datetime
import math
from dataclasses import dataclass, field
from statistics import NormalDist
from typing import Any, Callable, Mapping, Protocol

from .draws import latin, sobol, unit
from .spectra import read_mixture, read_variability
from .text import CampaignError, Node, near

REFERENCE = "$"
DRAWN = ("uniform", "integers", "normal", "log_uniform", "choice")
SWEPT = ("grid", "zip")
SPECTRAL = ("mixture", "variability")
HOW = ("random", "latin", "sobol")
_NORMAL = NormalDist()
_DATE = "%Y-%m-%dT%H:%M:%SZ"


class Context(Protocol):
    """What a rule asks of the sample that it is drawn for."""

    def number(self, key: str) -> float:
        """A number within (0, 1) of this sample for a variable."""

    def reference(self, name: str, at: Node) -> Any:
        """The value of another variable."""

    def step(self, axis: str, length: int) -> int:
        """Which item of an axis of the grid this sample has."""


@dataclass(frozen=True)
class Rule:
    """How a value comes about. key: names its draws; names: variables that it refers to; ends: values at the ends of its range."""

    key: str
    node: Node
    kind: str
    value: Callable[[Context], Any] = field(repr=False)
    names: tuple[tuple[str, Node], ...] = ()
    ends: tuple[Any, ...] = ()
    axis: tuple[str, int] | None = None
    how: str = "random"
    continuous: bool = False
    """Whether by itself it takes more values than can be kept ready."""


def read_rule(node: Node, key: str, curves: Mapping[str, Any] | None = None) -> Rule:
    """A rule of the text; curves: those of the scene's text, for spectra. CampaignError with the place of what is wrong."""
    tree = node.value
    if isinstance(tree, dict):
        kinds = [k for k in (*DRAWN, *SWEPT, "by", *SPECTRAL) if k in tree]
        if len(kinds) > 1:
            raise node.error(f"'{kinds[0]}' and '{kinds[1]}' exclude each other", "one kind of distribution")
        if kinds and kinds[0] in DRAWN:
            return _drawn(node, key, kinds[0])
        if kinds and kinds[0] in SWEPT:
            return _swept(node, key, kinds[0])
        if kinds and kinds[0] in SPECTRAL:
            return _spectral(node, key, kinds[0], curves or {})
        if kinds:
            return _conditional(node, key, curves)
        if list(tree) == ["material"] and isinstance(tree["material"].value, dict):
            return _material(node, key, curves)
    names = _references(node)
    return Rule(key, node, "constant", lambda c: _filled(node, c), names, () if names else (node.plain(),))


def _references(node: Node) -> tuple[tuple[str, Node], ...]:
    if isinstance(node.value, str) and node.value.startswith(REFERENCE):
        return ((node.value[1:], node),)
    inner = node.value.values() if isinstance(node.value, dict) else node.value if isinstance(node.value, list) else ()
    return tuple(r for n in inner for r in _references(n))


def _filled(node: Node, context: Context) -> Any:
    """A constant with the values of the variables that it names."""
    if isinstance(node.value, str) and node.value.startswith(REFERENCE):
        return context.reference(node.value[1:], node)
    if isinstance(node.value, dict):
        return {k: _filled(n, context) for k, n in node.value.items()}
    if isinstance(node.value, list):
        return [_filled(n, context) for n in node.value]
    return node.value


def _parameters(node: Node, kind: str, count: int) -> list[Node]:
    items: list[Node] = node.value[kind].list()
    if len(items) != count:
        raise node.value[kind].error(f"'{kind}' has {len(items)} numbers", f"it has {count}")
    for item in items:
        if not _references(item) and kind != "uniform":
            item.number()
    return items


def _drawn(node: Node, key: str, kind: str) -> Rule:
    known = {"normal": ("normal", "within", "draw"), "choice": ("choice", "weights", "draw")}.get(kind, (kind, "draw"))
    keys = node.map(known)
    how = keys["draw"].one_of(HOW) if "draw" in keys else "random"
    read = {"uniform": _uniform, "integers": _integers, "normal": _gauss, "log_uniform": _log_uniform, "choice": _choice}[kind]
    quantile, ends = read(node)
    return Rule(key, node, kind, lambda c: quantile(c, c.number(key)), _references(node), ends, how=how,
                continuous=kind in ("uniform", "normal", "log_uniform"))


Quantile = Callable[[Context, float], Any]


def _two(node: Node, kind: str, least: float = -math.inf) -> tuple[Callable[[Context], tuple[float, float]], tuple[float, ...]]:
    """The ends of a range, which may be those of other variables; checked again for each sample then."""
    low, high = _parameters(node, kind, 2)

    def ends(context: Context) -> tuple[float, float]:
        a, b = _filled(low, context), _filled(high, context)
        for value, at in ((a, low), (b, high)):
            if isinstance(value, bool) or not isinstance(value, (int, float)):
                raise at.error(f"a number is wanted here, not '{value}'")
        if not least < a <= b < math.inf:
            raise node.error(f"'{kind}' from {a!r} to {b!r} is no range", "the lower end first" + (", above 0" if least == 0 else ""))
        return a, b

    if _references(low) or _references(high):
        return ends, ()
    return ends, ends(_NoContext())


class _NoContext:
    """Of rules that refer to nothing."""

    def number(self, key: str) -> float:
        raise AssertionError(key)

    def reference(self, name: str, at: Node) -> Any:
        raise AssertionError(name)

    def step(self, axis: str, length: int) -> int:
        raise AssertionError(axis)


def _date(node: Node) -> datetime.datetime | None:
    if not isinstance(node.value, str) or node.value.startswith(REFERENCE):
        return None
    try:
        return datetime.datetime.strptime(node.value, _DATE)
    except ValueError:
        raise node.error(f"'{node.value}' is neither a number nor a date", "dates are UTC, as 2026-06-21T10:30:00Z") from None


def _uniform(node: Node) -> tuple[Quantile, tuple[Any, ...]]:
    low, high = _parameters(node, "uniform", 2)
    first, last = _date(low), _date(high)
    if first and last:
        if first > last:
            raise node.error("the dates of 'uniform' are in the wrong order", "the earlier one first")
        begin, seconds = first, (last - first).total_seconds()
        return lambda c, u: (begin + datetime.timedelta(seconds=math.floor(u * (seconds + 1)))).strftime(_DATE), (low.value, high.value)
    if first or last:
        raise node.error("'uniform' is between two numbers or two dates", "no mixture of both")
    ends, known = _two(node, "uniform")

    def value(context: Context, u: float) -> float:
        a, b = ends(context)
        return a + u * (b - a)

    return value, known


def _integers(node: Node) -> tuple[Quantile, tuple[Any, ...]]:
    for item in node.value["integers"].list():
        if not _references(item):
            item.integer(-1 << 53, 1 << 53)
    ends, known = _two(node, "integers")

    def value(context: Context, u: float) -> int:
        a, b = (math.floor(v) for v in ends(context))
        return a + math.floor(u * (b - a + 1))

    return value, known


def _log_uniform(node: Node) -> tuple[Quantile, tuple[Any, ...]]:
    ends, known = _two(node, "log_uniform", 0)

    def value(context: Context, u: float) -> float:
        a, b = ends(context)
        return min(b, a * math.exp(u * math.log(b / a)))

    return value, known


def _gauss(node: Node) -> tuple[Quantile, tuple[Any, ...]]:
    """Of mean and standard deviation; `within` cuts it, and what is within is drawn as often as before in proportion."""
    mean, deviation = _parameters(node, "normal", 2)
    cut, ends = (_two(node, "within") if "within" in node.value else (None, ()))

    def value(context: Context, u: float) -> Any:
        m, s = _filled(mean, context), _filled(deviation, context)
        if isinstance(m, (str, bool)) or isinstance(s, (str, bool)) or not s > 0:
            raise node.error(f"'normal' of mean {m!r} and deviation {s!r}", "two numbers, the deviation above 0")
        if cut:
            a, b = cut(context)
            low, high = _NORMAL.cdf((a - m) / s), _NORMAL.cdf((b - m) / s)
            if not high - low > 1e-12:
                raise node.error(f"'within' from {a!r} to {b!r} holds none of the draws", "a range nearer to the mean")
            return min(b, max(a, m + s * _NORMAL.inv_cdf(low + u * (high - low))))
        return m + s * _NORMAL.inv_cdf(u)

    if not _references(node):
        value(_NoContext(), 0.5)
        if not cut:  # two in a million draws lie further out
            ends = tuple(value(_NoContext(), u) for u in (1e-6, 1 - 1e-6))
    return value, ends


def _choice(node: Node) -> tuple[Quantile, tuple[Any, ...]]:
    items = node.value["choice"].list(1)
    weights = [w.number(0, 1e30) for w in node.value["weights"].list()] if "weights" in node.value else [1.0] * len(items)
    if len(weights) != len(items):
        raise node.value["weights"].error(f"{len(weights)} weights for {len(items)} choices")
    total = math.fsum(weights)
    if not total > 0:
        raise node.value["weights"].error("all weights are 0", "one above 0")
    last = max(i for i, w in enumerate(weights) if w > 0)

    def value(context: Context, u: float) -> Any:
        at = 0.0
        for i, (item, weight) in enumerate(zip(items, weights)):
            at += weight
            if i == last or (weight > 0 and u * total < at):
                return _filled(item, context)
        raise AssertionError("weights")

    return value, () if _references(node) else tuple(n.plain() for n, w in zip(items, weights) if w > 0)


def _swept(node: Node, key: str, kind: str) -> Rule:
    keys = node.map((kind, *(("with",) if kind == "zip" else ())))
    items = keys[kind].list(1)
    axis = key if kind == "grid" else "zip " + (keys["with"].text() if "with" in keys else "")

    def value(context: Context) -> Any:
        return _filled(items[context.step(axis, len(items))], context)

    names = _references(node.value[kind])
    return Rule(key, node, kind, value, names, () if names else tuple(n.plain() for n in items), (axis, len(items)))


def _spectral(node: Node, key: str, kind: str, curves: Mapping[str, Any]) -> Rule:
    value, ends = (read_mixture if kind == "mixture" else read_variability)(node, curves)
    return Rule(key, node, kind, lambda c: value(lambda name: c.number(f"{key} {name}")), (), ends, continuous=True)


def _material(node: Node, key: str, curves: Mapping[str, Any] | None) -> Rule:
    """A material of its own, whose parameters are rules."""
    rules = {name: read_rule(n, f"{key}.{name}", curves) for name, n in node.value["material"].map().items()}
    for rule in rules.values():
        _only_random(rule, "a parameter of a material is drawn at random", "grid, zip, latin and sobol stand in variables of their own, as $NAME here")
    names = tuple(n for rule in rules.values() for n in rule.names)
    # Ends: each parameter at its own, the others at their first.
    first = {name: rule.ends[0] for name, rule in rules.items() if rule.ends}
    ends = tuple({**first, name: e} for name, rule in rules.items() for e in rule.ends) if len(first) == len(rules) else ()
    return Rule(key, node, "material", lambda c: {name: rule.value(c) for name, rule in rules.items()}, names, ends,
                continuous=any(r.continuous for r in rules.values()))


def _only_random(rule: Rule, wrong: str, right: str) -> None:
    if rule.kind in SWEPT or rule.how != "random":
        raise rule.node.error(wrong, right)


def _conditional(node: Node, key: str, curves: Mapping[str, Any] | None) -> Rule:
    keys = node.map(("by", "cases", "else"), ("by", "cases"))
    name = keys["by"].text()
    # One draw for all cases: a case that is added changes no other one.
    cases = {case: read_rule(n, key, curves) for case, n in keys["cases"].map().items()}
    other = read_rule(keys["else"], key, curves) if "else" in keys else None
    for rule in (*cases.values(), *([other] if other else [])):
        _only_random(rule, "a case is drawn at random", "grid, zip, latin and sobol stand outside of cases")

    def value(context: Context) -> Any:
        decides = context.reference(name, keys["by"])
        rule = cases.get(case_of(decides), other)
        if rule is None:
            raise keys["by"].error(f"'{name}' is {decides!r}, for which there is no case", near(case_of(decides), cases) + ", or `else`")
        return rule.value(context)

    rules = [*cases.values(), *([other] if other else [])]
    names = ((name, keys["by"]), *(r for rule in rules for r in rule.names))
    return Rule(key, node, "by", value, names, tuple(e for rule in rules for e in rule.ends), continuous=any(r.continuous for r in rules))


def case_of(value: Any) -> str:
    """A value as the key of a case."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def number_of(rule: Rule, seed: int, sample: int, samples: int, dimension: int) -> float:
    """The number within (0, 1) of a sample for a rule, in the way that it is to be drawn."""
    if rule.how == "latin":
        return latin(sample, samples, seed, rule.key)
    if rule.how == "sobol":
        return sobol(sample, dimension, seed, rule.key)
    return unit(seed, sample, rule.key)


__all__ = ["CampaignError", "Context", "Rule", "case_of", "number_of", "read_rule"]
