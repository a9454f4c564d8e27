"""Constellations: shells, satellites from files, or both."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from navwalker import _native

if TYPE_CHECKING:
    from navwalker._scenario import Scenario

Path = str | os.PathLike[str]


class Constellation:
    """One or more Walker shells, or the satellites of files, under a name.

    ``notation`` is Walker's own with pattern, inclination and altitude (degrees and km), joined by ``+``:
    ``delta:53:160/10/1@1000+star:90:40/5/1@1100``.

    >>> import navwalker as nw
    >>> hybrid = nw.Constellation("delta:53:160/10/1@1000+star:90:40/5/1@1100", name="hybrid")
    >>> hybrid.satellites
    200
    >>> hybrid.without("NW-A-P01-S01").out_of_service
    ['NW-A-P01-S01']
    """

    __slots__ = ("_files", "_native")

    def __init__(self, notation: str, name: str | None = None) -> None:
        native = _native.NativeConstellation.of_notation(notation)
        self._native = native if name is None else native.named(name)
        self._files: dict[str, Any] | None = None

    @classmethod
    def _of(cls, native: _native.NativeConstellation, files: dict[str, Any] | None = None) -> Constellation:
        made = cls.__new__(cls)
        made._native = native
        made._files = files
        return made

    @property
    def name(self) -> str:
        """Its name in results."""
        return self._native.name

    @property
    def notation(self) -> str | None:
        """Its shells as a notation; None if it is of files alone."""
        return self._native.notation

    @property
    def satellites(self) -> int:
        """Number of satellites, those that are out of service included."""
        return self._native.satellites

    @property
    def out_of_service(self) -> list[str]:
        """The satellites, planes and shells that are out of service."""
        return self._native.out_of_service

    def without(self, *names: str) -> Constellation:
        """The same without satellites (``NW-P01-S03``), planes (``NW-P03``) or shells (``NW-A``); in a constellation
        of several shells the names begin with the letter of the shell: ``NW-A-P01-S01``."""
        return self._of(self._native.taking_out(list(names)), self._files)

    def named(self, name: str) -> Constellation:
        """The same under another name."""
        return self._of(self._native.named(name), self._files)

    def __add__(self, other: Constellation) -> Constellation:
        """The shells of both."""
        if self.notation is None or other.notation is None or self._native.has_files or other._native.has_files:
            raise _native.DesignError("only shells can be added; satellites from files join shells in a scenario")
        if self.out_of_service or other.out_of_service:
            raise _native.DesignError("add the shells first, then take satellites out of service")
        return Constellation(f"{self.notation}+{other.notation}")

    def export(
        self,
        out: Path,
        formats: Sequence[str] | str,
        *,
        scenario: Scenario | None = None,
        check: bool = False,
        force: bool = False,
        **options: str,
    ) -> dict[str, Any]:
        """Writes files for other tools into the directory ``out`` and returns their manifest.

        ``formats`` are those of ``navwalker export --as``; ``check`` reads every file back and checks it against its
        standard; further options are those of the command: ``frame="ITRF"``, ``omm_syntax="xml"``. Satellites that are
        out of service are in no file, and the others are called as if all were there.
        """
        from navwalker._commands import export

        return export(self, out, formats, scenario=scenario, check=check, force=force, **options)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Constellation):
            return NotImplemented
        return self.__reduce__() == other.__reduce__()

    def __hash__(self) -> int:
        return hash((self.name, self.notation, tuple(self.out_of_service)))

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (self.notation, self._files, self.name, self.out_of_service)

    def __repr__(self) -> str:
        parts = [repr(self.notation if self._files is None else self._native.made_of)]
        if self.name != self._native.made_of:
            parts.append(f"name={self.name!r}")
        text = f"Constellation({', '.join(parts)})" if self._files is None else f"<constellation of {', '.join(parts)}>"
        if self.out_of_service:
            text += f".without({', '.join(map(repr, self.out_of_service))})"
        return text


def read(
    *files: Path,
    name: str | None = None,
    format: str | None = None,
    only: Sequence[str] = (),
    exclude: Sequence[str] = (),
) -> Constellation:
    """The satellites of files or directories as one constellation.

    The format of each is recognised by its content (TLE, OMM, OEM, OPM, SP3, STK ephemeris, CZML, almanacs, tables of
    elements or states, gzip or not) unless ``format`` names it. ``only`` and ``exclude`` select satellites by name,
    designator, catalogue number, or patterns of these with ``*`` and ``?``. What is not read is named in a warning.
    """
    if not files:
        raise _native.FileError("read needs a file or a directory")
    options: dict[str, Any] = {
        "paths": [os.path.abspath(os.fspath(file)) for file in files],
        "format": format,
        "only": [only] if isinstance(only, str) else list(only),
        "exclude": [exclude] if isinstance(exclude, str) else list(exclude),
    }
    native = _native.NativeConstellation.of_files(**options)
    return Constellation._of(native if name is None else native.named(name), options)


def _again(
    notation: str | None, files: dict[str, Any] | None, name: str, out_of_service: list[str]
) -> Constellation:
    """A constellation from what was pickled: its notation, or the paths of its files."""
    if files is not None:
        made = Constellation._of(_native.NativeConstellation.of_files(**files), files)
    else:
        made = Constellation(notation or "")
    return made.named(name).without(*out_of_service)
