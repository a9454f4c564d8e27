"""Metrics, tables and samples."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from navwalker import _native
from navwalker._extras import needed

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    import pandas
    import polars
    import pyarrow
    import xarray

    Column = npt.NDArray[Any]

Value = float | int | bool | None

# Rows that a preview shows.
_SHOWN = 10


class Metrics:
    """The metrics of a constellation as attributes, named as the columns of tables: ``m.mean_pdop``, ``m.coverage_4``.

    A metric without a value is None. What each means, and its unit, is in ``docs/evaluate.md``; those in metres, seconds
    or degrees say so in their names, all others are without unit.
    """

    __slots__ = ("_name", "_values")

    def __init__(self, name: str, values: Mapping[str, Value]) -> None:
        object.__setattr__(self, "_name", name)
        object.__setattr__(self, "_values", dict(values))

    @property
    def name(self) -> str:
        """What was evaluated."""
        name: str = self._name
        return name

    def to_dict(self) -> dict[str, Value]:
        """All metrics by name."""
        return dict(self._values)

    def __getattr__(self, name: str) -> Any:
        try:
            return object.__getattribute__(self, "_values")[name]
        except KeyError:
            raise AttributeError(_no_such("metric", name, list(self._values))) from None

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError("metrics cannot be changed")

    def __getitem__(self, name: str) -> Value:
        try:
            value: Value = self._values[name]
        except KeyError:
            raise KeyError(_no_such("metric", name, list(self._values))) from None
        return value

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._values]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Metrics):
            return NotImplemented
        return bool(self._name == other._name and self._values == other._values)

    def __hash__(self) -> int:
        return hash((self._name, tuple(self._values.items())))

    def __reduce__(self) -> tuple[Any, ...]:
        return Metrics, (self._name, self._values)

    def __repr__(self) -> str:
        width = max(map(len, self._values), default=0)
        rows = (f"{name:{width}}  {_shown(value):>10}" for name, value in self._values.items())
        return "\n".join([self._name, *rows])

    def _repr_html_(self) -> str:
        rows = ((name, _shown(value)) for name, value in self._values.items())
        return _html_table(["metric", self._name], rows)


class Table:
    """Columns of one length, by name: ``table["mean_pdop"]`` is an array.

    Missing numbers are NaN in arrays and null in Arrow; the length is the number of rows.
    """

    __slots__ = ("_columns",)

    def __init__(self, columns: _native.Columns) -> None:
        self._columns = columns

    @property
    def columns(self) -> list[str]:
        """The names of the columns."""
        return self._columns.names

    def __getitem__(self, name: str) -> Column:
        try:
            return self._columns.column(name)
        except KeyError:
            raise KeyError(_no_such("column", name, self.columns)) from None

    def __getattr__(self, name: str) -> Column:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def __len__(self) -> int:
        return self._columns.rows

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """The table as an Arrow C stream, which Polars, pyarrow, DuckDB and pandas take."""
        return self._columns.__arrow_c_stream__(requested_schema)

    def to_dict(self) -> dict[str, Column]:
        """All columns as arrays."""
        return {name: self[name] for name in self.columns}

    def to_pandas(self) -> pandas.DataFrame:
        """A pandas DataFrame."""
        frame: pandas.DataFrame = needed("pandas", "to_pandas").DataFrame(self.to_dict())
        return frame

    def to_polars(self) -> polars.DataFrame:
        """A Polars DataFrame."""
        frame: polars.DataFrame = needed("polars", "to_polars").DataFrame(self)
        return frame

    def to_arrow(self) -> pyarrow.Table:
        """An Arrow table."""
        table: pyarrow.Table = needed("pyarrow", "to_arrow").table(self)
        return table

    def _cells(self) -> list[list[str]]:
        shown = (self[name][:_SHOWN] for name in self.columns)
        columns = [[_shown(value) for value in column] for column in shown]
        return [list(row) for row in zip(*columns, strict=True)]

    def _told(self) -> str:
        rows, columns = len(self), len(self.columns)
        return f"{rows} row{'s' * (rows != 1)}, {columns} column{'s' * (columns != 1)}"

    def __repr__(self) -> str:
        first = self.columns[:8]
        rows = [row[:8] for row in self._cells()]
        widths = [max(len(cell) for cell in column) for column in zip(first, *rows, strict=True)]
        lines = ("  ".join(f"{cell:>{width}}" for cell, width in zip(row, widths, strict=True)) for row in [first, *rows])
        return "\n".join([*lines, self._told()])

    def _repr_html_(self) -> str:
        return _html_table(self.columns, self._cells()) + f"<p>{self._told()}</p>"


@dataclass(frozen=True)
class Samples:
    """Every sample of an evaluation; arrays of (time, point).

    ``pdop`` is in single precision, NaN where it is not solved; ``visible`` and ``gnss_visible`` count the LEO and the
    GNSS satellites in view.
    """

    elapsed_s: npt.NDArray[np.float64]
    pdop: npt.NDArray[np.float32]
    visible: npt.NDArray[np.uint32]
    gnss_visible: npt.NDArray[np.uint32]
    points: Table

    def to_xarray(self) -> xarray.Dataset:
        """A Dataset over ``time`` (seconds since the epoch) and ``point``."""
        from navwalker._maps import attributes, coordinates_of

        xr = needed("xarray", "to_xarray")
        dims = ("time", "point")
        dataset: xarray.Dataset = xr.Dataset(
            {
                "pdop": (dims, self.pdop, {"long_name": "PDOP", "units": "1"}),
                "visible": (dims, self.visible, {"long_name": "LEO satellites in view", "units": "1"}),
                "gnss_visible": (dims, self.gnss_visible, {"long_name": "GNSS satellites in view", "units": "1"}),
            },
            coords={
                "time": ("time", self.elapsed_s, {"long_name": "time since the epoch", "units": "s"}),
                **coordinates_of(self.points),
                "weight": ("point", self.points["weight"], attributes("weight")),
            },
        )
        return dataset


def _no_such(kind: str, name: str, known: Sequence[str]) -> str:
    import difflib

    near = difflib.get_close_matches(name, known, n=1)
    hint = f"; did you mean '{near[0]}'?" if near else ""
    return f"there is no {kind} '{name}'{hint}"


def _shown(value: object) -> str:
    if value is None or (isinstance(value, float) and value != value):
        return "-"
    import numpy as np

    if isinstance(value, (bool, np.bool_)):
        return "yes" if value else "no"
    if isinstance(value, (float, np.floating)):
        return f"{value:.6g}"
    return str(value)


def _html_table(header: Sequence[str], rows: Any) -> str:
    import html

    cell = "<td>{}</td>".format
    head = "".join(f"<th>{html.escape(name)}</th>" for name in header)
    body = "".join("<tr>" + "".join(cell(html.escape(one)) for one in row) + "</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
