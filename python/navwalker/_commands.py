"""Commands of the program from Python: its checks, its exports and what they say."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from navwalker import _native
from navwalker._constellation import Constellation, Path

if TYPE_CHECKING:
    from navwalker._progress import Tick
    from navwalker._scenario import Scenario


def run(
    arguments: Sequence[str],
    error: type[_native.NavwalkerError] = _native.NavwalkerError,
    *,
    scenario: Scenario | None = None,
    tick: Tick | None = None,
) -> tuple[int, str]:
    """Runs a command, on a scenario if one is given: its status and its result. Its warnings become warnings, a status of
    2 an exception."""
    given = list(arguments)
    own = None
    if scenario is not None:
        own = scenario._given_text
        given += scenario._arguments()
    status, result, messages = _native.run_command(given, own, tick)
    for kind, text in messages:
        if kind == "warning":
            warnings.warn(text, _native.NavwalkerWarning, stacklevel=3)
    if status == 2:
        raise error("\n".join(text for kind, text in messages if kind == "error"))
    if status == 130:
        raise KeyboardInterrupt
    return status, result


def arguments_of(constellation: Constellation | str) -> list[str]:
    """A constellation as arguments of a command, with all of its satellites."""
    if isinstance(constellation, str):
        return ["--design", constellation]
    files = constellation._files
    if files is None:
        name = f"{constellation.name}=" if constellation.name != constellation.notation else ""
        return ["--design", f"{name}{constellation.notation}"]
    if len(files["paths"]) > 1:
        raise _native.FileError("a command takes one file or directory; put the files in a directory")
    selection = [part for option in ("only", "exclude") for one in files[option] for part in (f"--{option}", one)]
    form = [] if files["format"] is None else ["--input-format", files["format"]]
    return ["--constellation", f"{constellation.name}={files['paths'][0]}", *selection, *form]


def export(
    constellation: Constellation,
    out: Path,
    formats: Sequence[str] | str,
    *,
    scenario: Scenario | None,
    check: bool,
    force: bool,
    **options: str,
) -> dict[str, Any]:
    """Writes the files of :meth:`Constellation.export`."""
    products = formats if isinstance(formats, str) else ",".join(formats)
    more = [part for name, value in options.items() for part in (f"--{name.replace('_', '-')}", str(value))]
    switches = [switch for switch, on in (("--check", check), ("--force", force)) if on]
    place = os.fspath(out)
    without = [part for name in constellation.out_of_service for part in ("--without", name)]
    arguments = ["export", *arguments_of(constellation), *without, "--as", products, "--out", place, *switches, *more]
    status, result = run(arguments, _native.FileError, scenario=scenario)
    if status != 0:
        raise _native.FileError(f"what was read back from {place} differs from the constellation:\n{result}")
    with open(os.path.join(place, "manifest.json"), encoding="utf-8") as file:
        manifest: dict[str, Any] = json.load(file)
    return manifest


@dataclass(frozen=True)
class ValidationReport:
    """The checks of a validation, each with its gate."""

    passed: bool
    checks: list[dict[str, Any]]
    _whole: dict[str, Any]

    def to_dict(self) -> dict[str, Any]:
        """Everything that ``navwalker validate --format json`` says."""
        return dict(self._whole)

    def __bool__(self) -> bool:
        return self.passed

    def __repr__(self) -> str:
        gated = [check for check in self.checks if check.get("gate") is not None]
        failed = [check["name"] for check in gated if not check["passed"]]
        told = f"failed: {', '.join(failed)}" if failed else "all passed"
        return f"<ValidationReport of {len(self.checks)} checks, {len(gated)} with a gate, {told}>"


def validate(
    constellation: Constellation | str,
    against: Sequence[str] | str = "sgp4",
    *,
    scenario: Scenario | None = None,
) -> ValidationReport:
    """Checks the propagation of a constellation against independent standards (``sgp4``, ``geographiclib``,
    ``numerical``, ``analytic``, ``paper``, ``all``) or the files of other programs."""
    targets = against if isinstance(against, str) else ",".join(os.fspath(one) for one in against)
    arguments = ["validate", *arguments_of(constellation), "--against", targets, "--format", "json"]
    _, result = run(arguments, scenario=scenario)
    whole = json.loads(result)
    return ValidationReport(whole["passed"], whole["checks"], whole)


@dataclass(frozen=True)
class Finding:
    """Where a file departs from the standard of its format."""

    file: str
    format: str
    line: int | None
    column: int | None
    severity: str
    rule: str
    message: str


def lint(*files: Path, format: str | None = None) -> list[Finding]:
    """Checks files against the standards of their formats; an empty list if all is well."""
    form = [] if format is None else ["--as", format]
    arguments = ["lint", "--format", "json", *form, *(os.fspath(file) for file in files)]
    _, result = run(arguments, _native.FileError)
    fields = Finding.__dataclass_fields__
    return [Finding(**{name: one.get(name) for name in fields}) for one in json.loads(result)]
