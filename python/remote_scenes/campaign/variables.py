"""All variables of a campaign: in an order in which each comes after those that it refers to, and their values for a sample."""
from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Mapping

from .distributions import Rule, number_of, read_rule
from .draws import SOBOL_DIMENSIONS, unit
from .text import Node, near


@dataclass(frozen=True)
class Variables:
    """The rules by name, in the order of the text; `ordered` in that of evaluation."""

    rules: dict[str, Rule]
    ordered: tuple[str, ...]
    dimensions: dict[str, int]
    axes: dict[str, tuple[int, int]]
    """Of every axis of the grid its length and how many samples one step of it takes."""

    def continuous(self, name: str) -> bool:
        """Whether a variable, by itself or through those that it refers to, takes more values than can be kept ready."""
        rule = self.rules[name]
        return rule.continuous or any(self.continuous(other) for other, _ in rule.names)

    def values(self, seed: int, sample: int, samples: int, forced: Mapping[str, Any] | None = None,
               again: frozenset[str] | None = None) -> dict[str, Any]:
        """The value of every variable, in the order of the text. samples: of the whole campaign (a Latin hypercube needs it); forced: values in
        place of draws, which others see that refer to them; again: those that are drawn by other numbers, for the second picture of a pair."""
        drawn = Draw(self, seed, sample, samples, again=again)
        given = forced or {}
        for name in self.ordered:
            drawn.known[name] = given[name] if name in given else self.rules[name].value(drawn)
        return {name: drawn.known[name] for name in self.rules}


class Draw:
    """One sample while it is drawn (distributions.Context)."""

    def __init__(self, variables: Variables, seed: int, sample: int, samples: int, known: dict[str, Any] | None = None,
                 again: frozenset[str] | None = None) -> None:
        self.variables, self.seed, self.sample, self.samples = variables, seed, sample, samples
        self.again, self.later = again or frozenset(), again is not None
        self.known: dict[str, Any] = dict(known or {})

    def number(self, key: str) -> float:
        """Of a variable, or of any other name."""
        rule = self.variables.rules.get(key)
        if rule is None:  # a part of a variable: its name, a blank or a dot, and which part
            return unit(self.seed, self.sample, f"{key} again" if self.again and any(key.startswith((f"{a} ", f"{a}.")) for a in self.again) else key)
        named = replace(rule, key=f"{key} again") if key in self.again else rule
        return number_of(named, self.seed, self.sample, self.samples, self.variables.dimensions.get(key, 0))

    def reference(self, name: str, at: Node) -> Any:
        """The value of a variable that was drawn before."""
        if name not in self.known:
            raise at.error(f"there is no variable '{name}'", near(name, self.variables.rules))
        return self.known[name]

    def step(self, axis: str, length: int) -> int:
        """Which item of an axis this sample has."""
        return self.sample // self.variables.axes[axis][1] % length


def read_variables(node: Node | None, curves: Mapping[str, Any] | None = None) -> Variables:
    """The map of variables; curves: those of the scene's text. CampaignError: a name that is not there, a circle, axes of other lengths under one name."""
    rules = {name: read_rule(inner, name, curves) for name, inner in (node.map().items() if node else ())}
    axes: dict[str, tuple[int, int]] = {}
    stride = 1
    for rule in rules.values():
        if rule.axis is None:
            continue
        axis, length = rule.axis
        if axis not in axes:
            axes[axis] = (length, stride)
            stride *= length
        elif axes[axis][0] != length:
            raise rule.node.error(f"this list has {length} items, another one of the same zip {axes[axis][0]}", "lists of one length")
    wanted = [name for name, rule in rules.items() if rule.how == "sobol"]
    if len(wanted) > SOBOL_DIMENSIONS:
        raise rules[wanted[SOBOL_DIMENSIONS]].node.error(f"{len(wanted)} variables are drawn by sobol", f"at most {SOBOL_DIMENSIONS}; draw: latin has no limit")
    return Variables(rules, _order(rules), {name: i for i, name in enumerate(wanted)}, axes)


def _order(rules: dict[str, Rule]) -> tuple[str, ...]:
    done: list[str] = []
    for name in rules:
        # Depth first without recursion: chains may be long.
        stack = [(name, iter(rules[name].names))]
        under_way = {name}
        while stack:
            here, rest = stack[-1]
            for other, at in rest:
                if other not in rules:
                    raise at.error(f"there is no variable '{other}'", near(other, rules))
                if other in under_way:
                    raise at.error(f"'{here}' and '{other}' refer to each other", "no circles")
                if other not in done:
                    stack.append((other, iter(rules[other].names)))
                    under_way.add(other)
                    break
            else:
                stack.pop()
                under_way.discard(here)
                if here not in done:
                    done.append(here)
    return tuple(done)
