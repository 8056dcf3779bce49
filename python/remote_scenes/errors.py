"""What the programs say, as exceptions and warnings with a place.

The programs check all input; this module only takes their messages apart, so that nothing is checked twice.
"""
from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Iterable

import yaml


@dataclass(frozen=True)
class Finding:
    """One thing that a program found: where, what, and what would be right.

    `line` and `column` count from 1, 0 = the file as a whole. `key` is the place in the tree of a YAML text that the line
    belongs to, as `materials.grass.reflectance`; empty where the file is no text or the line belongs to no key.
    """

    severity: str
    message: str
    file: str = ""
    line: int = 0
    column: int = 0
    code: str = ""
    hint: str = ""
    count: int = 1
    key: str = ""

    def __str__(self) -> str:
        place = ":".join([self.file, *(str(n) for n in (self.line, self.column) if n)])
        head = f"{place}: " if self.file else ""
        key = f" (at {self.key})" if self.key else ""
        code = f" [{self.code}]" if self.code else ""
        return f"{head}{self.severity}: {self.message}{code}{key}" + (f"; {self.hint}" if self.hint else "")


class ProgramWarning(UserWarning):
    """A warning of a program, which went on."""


class ProgramMissing(FileNotFoundError):
    """A program was found nowhere."""


class ProgramError(Exception):
    """A program ended without a result. `output` is all it said (`stdout` what of it went there), `exit_code` as in
    the programs' USAGE.md."""

    def __init__(self, text: str, program: str, exit_code: int, output: str, findings: tuple[Finding, ...] = ()) -> None:
        super().__init__(text)
        self.stdout = ""
        self.program, self.exit_code, self.output, self.findings = program, exit_code, output, findings

    @property
    def _first(self) -> Finding:
        errors = [f for f in self.findings if f.severity == "error"]
        return (errors or list(self.findings) or [Finding("error", str(self))])[0]

    @property
    def file(self) -> str:
        """The file of the first error; empty when the message names none."""
        return self._first.file

    @property
    def line(self) -> int:
        """Line of the first error, from 1; 0 = the file as a whole."""
        return self._first.line

    @property
    def column(self) -> int:
        """Column of the first error, from 1; 0 = unknown."""
        return self._first.column

    @property
    def key(self) -> str:
        """Place of the first error in the tree of the text, as `sensors.0.bands`."""
        return self._first.key

    @property
    def message(self) -> str:
        """What is wrong, without place and hint."""
        return self._first.message

    @property
    def hint(self) -> str:
        """What would be right; may be empty."""
        return self._first.hint

    @property
    def code(self) -> str:
        """Stable code of the first error, such as SP104 (`scene-prep --list-issues`); may be empty."""
        return self._first.code


class InputError(ProgramError):
    """The input was refused (exit code 1)."""


class UsageError(ProgramError):
    """The program was called in a way it does not know (exit code 2)."""


class ProgramBug(ProgramError):
    """A bug of the program (exit code 3, or ended by a signal that nobody sent)."""


class Interrupted(ProgramError):
    """Stopped by Ctrl-C, SIGTERM or SIGHUP (exit codes 130, 143 and 129)."""


_PLACE = r"(?P<file>.+?)(?::(?P<line>\d+)(?::(?P<column>\d+))?)?"
_ERROR = re.compile(rf"^(?:{_PLACE}: )?(?P<severity>error|warning): (?P<rest>.*)$")
_ISSUE = re.compile(r"^(?P<asset>.*): (?P<severity>info|warning|error) \[(?P<code>[A-Z]+\d+)\] x(?P<count>\d+): (?P<summary>.*)$")
_EXAMPLE = re.compile(rf"^    {_PLACE}: (?P<message>.*)$")
_CODE = re.compile(r"^(?P<message>.*?) \[(?P<code>[A-Z]+\d+)\](?:; (?P<hint>.*))?$")


def _number(text: str | None) -> int:
    return int(text) if text else 0


def findings_of(output: Iterable[str]) -> tuple[Finding, ...]:
    """The findings in the lines that a program printed: single messages and reports of scene-prep."""
    found: list[Finding] = []
    issue: Finding | None = None
    examples = 0

    def close() -> None:
        if issue and not examples:
            found.append(issue)

    for line in _without_excerpts(list(output)):
        if head := _ISSUE.match(line):
            close()
            issue = Finding(head["severity"], head["summary"], head["asset"], code=head["code"], count=int(head["count"]))
            examples = 0
        elif issue and line.startswith("    hint: "):
            hint = line.removeprefix("    hint: ")
            first = len(found) - examples
            found[first:] = [replace(f, hint=hint) for f in found[first:]]
            issue = replace(issue, hint=hint)
        elif issue and (example := _EXAMPLE.match(line)):
            found.append(replace(issue, message=example["message"], file=example["file"], line=_number(example["line"]),
                                 column=_number(example["column"])))
            examples += 1
        else:
            close()
            issue = None
            if error := _ERROR.match(line):
                found.append(_single(error))
    close()
    return tuple(found)


def _without_excerpts(lines: list[str]) -> list[str]:
    """Without the lines of texts that are shown, each of which has a line with a caret under it."""
    carets = [i for i, line in enumerate(lines) if line.strip() == "^"]
    shown = {i - back for i in carets for back in (0, 1)}
    return [line for i, line in enumerate(lines) if i not in shown]


def _single(match: re.Match[str]) -> Finding:
    message, code, hint = match["rest"], "", ""
    if with_code := _CODE.match(message):
        message, code, hint = with_code["message"], with_code["code"], with_code["hint"] or ""
    elif "; " in message:
        message, hint = message.split("; ", 1)
    return Finding(match["severity"], message, match["file"] or "", _number(match["line"]), _number(match["column"]),
                   code, hint)


def with_keys(findings: Iterable[Finding]) -> tuple[Finding, ...]:
    """The findings with the place in the tree of the YAML texts they are about."""
    trees: dict[str, yaml.Node | None] = {}
    out = []
    for f in findings:
        if f.line and Path(f.file).suffix in (".yaml", ".yml", ".json"):
            if f.file not in trees:
                trees[f.file] = _compose(f.file)
            f = replace(f, key=_key_at(trees[f.file], f.line - 1, f.column - 1))
        out.append(f)
    return tuple(out)


def _compose(file: str) -> yaml.Node | None:
    try:
        with open(file, encoding="utf-8") as text:
            node: yaml.Node | None = yaml.compose(text, Loader=yaml.SafeLoader)
            return node
    except (OSError, UnicodeError, yaml.YAMLError):
        return None


def _key_at(node: yaml.Node | None, line: int, column: int) -> str:
    """Keys that lead to the innermost entry that begins at or before a place and has not ended there."""
    place = (line, max(column, 0))
    keys: list[str] = []
    while node is not None:
        entries: list[tuple[str, yaml.Node, yaml.Node]] = []
        if isinstance(node, yaml.MappingNode):
            entries = [(str(k.value), k, v) for k, v in node.value]
        elif isinstance(node, yaml.SequenceNode):
            entries = [(str(i), v, v) for i, v in enumerate(node.value)]
        node = None
        for name, first, value in entries:
            begin, end = first.start_mark, value.end_mark
            if (begin.line, begin.column) <= place < (end.line, end.column):
                keys.append(name)
                # On the key itself: no deeper.
                if (value.start_mark.line, value.start_mark.column) <= place:
                    node = value
    return ".".join(keys)


def error_of(program: str, exit_code: int, output: list[str]) -> ProgramError:
    """The exception for a program that ended with an exit code other than 0."""
    text = "\n".join(output)
    if exit_code == 2:
        said = [line.partition(": usage: ")[2] for line in output if ": usage: " in line]
        return UsageError(said[0] if said else text, program, exit_code, text)
    if exit_code in (129, 130, 143):
        return Interrupted(f"{program} was stopped", program, exit_code, text)
    if exit_code != 1:
        return ProgramBug(f"{program} ended with {exit_code}: {text}", program, exit_code, text)
    findings = with_keys(findings_of(output))
    errors = [f for f in findings if f.severity == "error"] or list(findings)
    return InputError("\n".join(str(f) for f in errors) or text, program, exit_code, text, findings)
