"""YAML with the place of every value: what is wrong in a text is said with file, line and column.

Plain scalars follow the core schema of YAML 1.2, as the programs read them: `on` is a name, `1e5` a number, a date a text.
"""
from __future__ import annotations

import difflib
import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Iterable, Iterator

import yaml

from ..tree import FileName

MOST_VALUES = 1_000_000
"""Values of one text with its aliases unfolded; more are refused."""
_INTEGER = re.compile(r"[-+]?[0-9]+")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")


class CampaignError(ValueError):
    """Something of a campaign is refused: "FILE:LINE:COLUMN: error: what is wrong; what would be right"."""

    def __init__(self, message: str, hint: str = "", file: str = "", line: int = 0, column: int = 0) -> None:
        self.message, self.hint, self.file, self.line, self.column = message, hint, file, line, column
        place = ":".join([file, *(str(n) for n in (line, column) if n)])
        super().__init__((f"{place}: " if file else "") + f"error: {message}" + (f"; {hint}" if hint else ""))


class Refused(CampaignError):
    """A refusal whose message is whole already."""

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self.args = (text,)


def near(name: str, known: Iterable[str]) -> str:
    """A hint: the nearest known name, else all of them."""
    names = [str(k) for k in known]
    found = difflib.get_close_matches(name, names, 1)
    return f"did you mean '{found[0]}'?" if found else f"known: {', '.join(names) or 'none'}"


@dataclass(frozen=True)
class Node:
    """A value of a text with its place. `value`: a scalar, a list of Nodes, or a map of Nodes."""

    value: Any
    file: str
    line: int
    column: int

    def error(self, message: str, hint: str = "") -> CampaignError:
        """An error at this place."""
        return CampaignError(message, hint, self.file, self.line, self.column)

    def plain(self) -> Any:
        """The value without places."""
        if isinstance(self.value, dict):
            return {k: n.plain() for k, n in self.value.items()}
        if isinstance(self.value, list):
            return [n.plain() for n in self.value]
        return self.value

    def map(self, known: Iterable[str] | None = None, required: Iterable[str] = ()) -> dict[str, Node]:
        """The entries of a map. known: its keys, others are refused with the nearest name; required: those that must be there."""
        if not isinstance(self.value, dict):
            raise self.error(f"a map of keys is wanted here, not {self._kind()}")
        if known is not None:
            names = list(known)
            for key, node in self.value.items():
                if key not in names:
                    raise node.error(f"unknown key '{key}'", near(key, names))
        for key in required:
            if key not in self.value:
                raise self.error(f"the key '{key}' is missing")
        return self.value

    def list(self, least: int = 0) -> list[Node]:
        """The items of a list of at least so many."""
        if not isinstance(self.value, list):
            raise self.error(f"a list is wanted here, not {self._kind()}")
        if len(self.value) < least:
            raise self.error(f"{len(self.value)} items are too few", f"at least {least}")
        return self.value

    def number(self, low: float = -math.inf, high: float = math.inf) -> float:
        """A number from low to high."""
        if isinstance(self.value, bool) or not isinstance(self.value, (int, float)):
            raise self.error(f"a number is wanted here, not {self._kind()}")
        if not low <= self.value <= high:
            raise self.error(f"{self.value} is out of range", f"{low:g} to {high:g}")
        return self.value

    def integer(self, low: int, high: int) -> int:
        """A whole number from low to high."""
        if isinstance(self.value, bool) or not isinstance(self.value, int):
            raise self.error(f"a whole number is wanted here, not {self._kind()}")
        return int(self.number(low, high))

    def text(self, pattern: str | None = None, hint: str = "") -> str:
        """A text; pattern: a regular expression that it must fit."""
        if not isinstance(self.value, str):
            raise self.error(f"a text is wanted here, not {self._kind()}")
        if pattern is not None and not re.fullmatch(pattern, self.value):
            raise self.error(f"'{self.value}' is not allowed here", hint)
        return self.value

    def flag(self) -> bool:
        """true or false."""
        if not isinstance(self.value, bool):
            raise self.error(f"true or false is wanted here, not {self._kind()}")
        return self.value

    def one_of(self, names: Iterable[str]) -> str:
        """One of some names."""
        allowed = list(names)
        text = self.text()
        if text not in allowed:
            raise self.error(f"'{text}' is not known", near(text, allowed))
        return text

    def numbers(self, count: int) -> tuple[float, ...]:
        """A list of so many numbers."""
        items = self.list()
        if len(items) != count:
            raise self.error(f"{count} numbers are wanted here, not {len(items)} items")
        return tuple(n.number() for n in items)

    def _kind(self) -> str:
        names = {dict: "a map", list: "a list", str: f"the text '{self.value}'", type(None): "nothing"}
        return names.get(type(self.value), str(self.value))


def read_text(path: FileName) -> Node:
    """Reads a text whose root is a map. CampaignError: not there, not UTF-8, not YAML, keys that stand twice."""
    file = str(path)
    try:
        text = Path(path).read_text(encoding="utf-8")
    except OSError as problem:
        raise CampaignError(f"it cannot be read: {problem.strerror}", file=file) from None
    except UnicodeDecodeError:
        raise CampaignError("it is not UTF-8", file=file) from None
    try:
        root = yaml.compose(text, Loader=yaml.SafeLoader)
    except yaml.MarkedYAMLError as fault:
        mark = fault.problem_mark
        raise CampaignError(str(fault.problem), "", file, mark.line + 1 if mark else 0, mark.column + 1 if mark else 0) from None
    except (yaml.YAMLError, RecursionError) as fault:
        raise CampaignError(f"it is not YAML: {str(fault).splitlines()[0]}", file=file) from None
    if not isinstance(root, yaml.MappingNode):
        raise CampaignError("it has no map of keys", file=file, line=1)
    return _node(root, file, _Count(MOST_VALUES), 0)


class _Count:
    def __init__(self, left: int) -> None:
        self.left = left


def _node(node: yaml.Node, file: str, count: _Count, depth: int) -> Node:
    line, column = node.start_mark.line + 1, node.start_mark.column + 1
    count.left -= 1
    if count.left < 0 or depth > 200:
        raise CampaignError("it has too many values, or they lie too deep", f"{MOST_VALUES} values, 200 levels", file, line, column)
    if isinstance(node, yaml.ScalarNode):
        return Node(_scalar(node), file, line, column)
    if isinstance(node, yaml.SequenceNode):
        return Node([_node(item, file, count, depth + 1) for item in node.value], file, line, column)
    assert isinstance(node, yaml.MappingNode)
    out: dict[str, Node] = {}
    for key, value in node.value:
        at = key.start_mark
        if not isinstance(key, yaml.ScalarNode):
            raise CampaignError("a key must be a name or a number", "", file, at.line + 1, at.column + 1)
        if key.value in out:
            raise CampaignError(f"the key '{key.value}' stands there twice", "", file, at.line + 1, at.column + 1)
        inner = _node(value, file, count, depth + 1)
        # The place of an entry is that of its key.
        out[key.value] = Node(inner.value, file, at.line + 1, at.column + 1)
    return Node(out, file, line, column)


def _scalar(node: yaml.ScalarNode) -> Any:
    if node.style is not None or node.tag == "!":
        return node.value
    text = node.value
    if text in ("", "~", "null", "Null", "NULL"):
        return None
    if text in ("true", "True", "TRUE", "false", "False", "FALSE"):
        return text.lower() == "true"
    if _INTEGER.fullmatch(text) and len(text) < 40:
        return int(text)
    if _FLOAT.fullmatch(text):
        return float(text)
    return text


def leaves(tree: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    """All scalars of a plain tree with their places."""
    entries = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else None
    if entries is None:
        yield path, tree
    else:
        for key, value in entries:
            yield from leaves(value, (*path, str(key)))
