"""Scenarios: everything that an evaluation depends on, except the constellation."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, overload

from navwalker import _native
from navwalker._arrays import finite, numbers
from navwalker._constellation import Constellation, Path
from navwalker._extras import needed
from navwalker._keys import overrides
from navwalker._progress import followed
from navwalker._results import Metrics, Samples, Table

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    import xarray

    from navwalker._custom import CustomRun
    from navwalker._engines import Executor
    from navwalker._plots import Plots
    from navwalker._run import Run
    from navwalker._sweep import Sweep

    Objective = Callable[[Table], npt.ArrayLike]
    Whole = npt.NDArray[np.int64]
    Real = npt.NDArray[np.float64]

Given = str | Constellation
Errors = Literal["raise", "column"]

_COLUMNS = ("planes", "satellites_per_plane", "inclination_deg", "altitude_km", "phasing")


class Scenario:
    """A study: instants, ground points, masks, GNSS, clocks and metrics.

    ``source`` is the name of a built-in scenario, the path of a TOML file, or the text of one. Any key can be overridden,
    as a keyword with underscores (``visibility_mask_deg=10``) or by its own name (``set={"visibility.mask-deg": 10}``).
    ``threads`` bounds the cores that its work uses; results do not depend on it.

    >>> import navwalker as nw
    >>> nw.Scenario("paper", visibility_mask_deg=10).name
    'paper'
    """

    def __init__(
        self,
        source: Path = "paper",
        *,
        set: Mapping[str, Any] | None = None,
        threads: int | None = None,
        **keys: Any,
    ) -> None:
        self._source = os.fspath(source)
        self._overrides = overrides(set, keys)
        self._threads = threads
        is_text = isinstance(source, str) and ("\n" in source or "=" in source)
        self._text = self._source if is_text else None
        self._directory = os.getcwd()
        if self._text is None and os.path.exists(self._source):
            self._source = os.path.abspath(self._source)
        label = "scenario" if is_text else self._source
        self._engine = _native.Engine(label, self._text, self._directory, self._overrides, threads)

    @property
    def name(self) -> str:
        """The name of the scenario."""
        return self._engine.name

    @property
    def hash(self) -> str:
        """SHA-256 of everything that determines its results, files included."""
        return self._engine.hash

    @property
    def reference_design(self) -> str:
        """The notation of the design that commands take where none is given."""
        return self._engine.reference_design

    @property
    def elapsed_s(self) -> npt.NDArray[np.float64]:
        """Seconds since the epoch of each instant."""
        return self._engine.elapsed_s

    @property
    def utc(self) -> list[str]:
        """UTC of each instant as text, since a leap second (23:59:60) has no ``datetime64``."""
        return self._engine.utc

    @property
    def points(self) -> Table:
        """The ground points: ``latitude_deg``, ``longitude_deg``, ``height_m``, ``weight`` and ``name``."""
        return Table(self._engine.points())

    @property
    def constellations(self) -> list[Constellation]:
        """The constellations that the scenario names."""
        return [Constellation._of(one) for one in self._engine.constellations()]

    @property
    def plot(self) -> Plots:
        """Figures by matplotlib."""
        from navwalker._plots import Plots

        return Plots(self)

    def replace(self, *, set: Mapping[str, Any] | None = None, **keys: Any) -> Scenario:
        """The same scenario with further keys overridden."""
        further = [*self._overrides, *overrides(set, keys)]
        return _again(self._source, further, self._threads, self._directory, self._text is not None)

    def to_toml(self) -> str:
        """The scenario with every key."""
        return self._engine.to_toml()

    @overload
    def evaluate(  # type: ignore[overload-overlap]  # a text is a notation, although it is an iterable of texts too
        self,
        constellations: Given,
        *,
        errors: Errors = "raise",
        progress: bool = False,
        tiles: int | None = None,
        executor: Executor | None = None,
    ) -> Metrics: ...
    @overload
    def evaluate(
        self, constellations: Iterable[Given], *, errors: Errors = "raise", progress: bool = False
    ) -> Table: ...
    @overload
    def evaluate(
        self,
        constellations: None = None,
        *,
        errors: Errors = "raise",
        progress: bool = False,
        pattern: str = "delta",
        planes: npt.ArrayLike,
        satellites_per_plane: npt.ArrayLike,
        inclination_deg: npt.ArrayLike,
        altitude_km: npt.ArrayLike,
        phasing: npt.ArrayLike,
    ) -> Table: ...

    def evaluate(
        self,
        constellations: Given | Iterable[Given] | None = None,
        *,
        errors: Errors = "raise",
        progress: bool = False,
        pattern: str = "delta",
        tiles: int | None = None,
        executor: Executor | None = None,
        **columns: Any,
    ) -> Metrics | Table:
        """The metrics of a constellation, or the table of several.

        One is given by its notation, its name in the scenario or as a :class:`Constellation`, several as an iterable of
        these, or shells as columns of numbers that broadcast to one length: ``planes``, ``satellites_per_plane``,
        ``inclination_deg``, ``altitude_km`` and ``phasing``, with one ``pattern``. A constellation that cannot be
        evaluated raises :class:`DesignError`; with ``errors="column"`` its row has no metrics and says why in the
        column ``error``. ``progress`` says on stderr how many of several are done.

        One design that takes long can be cut into ``tiles``, each of some instants at all points, with the metrics of the
        whole to the bit: a scenario of any size, in the memory of a tile. ``executor`` evaluates them elsewhere, as that of
        :meth:`sweep`. Their files, 8 bytes a sample, are in the temporary directory until they are merged.
        """
        if errors not in ("raise", "column"):
            raise _native.NavwalkerError(f"errors is {errors!r}, expected 'raise' or 'column'")
        keeps = errors == "column"
        if constellations is None:
            arrays = _columns(columns)
            with followed(progress, "design") as tick:
                return Table(self._engine.evaluate_columns(pattern, *arrays, keeps, tick))
        if columns:
            raise _native.NavwalkerError("give constellations or columns, not both")
        if isinstance(constellations, (str, Constellation)):
            one = self._native_of(constellations)
            if tiles is not None:
                from navwalker import _tiles

                return _tiles.evaluate(self, one, tiles, executor, progress)
            if executor is None:
                return Metrics(one.name, self._engine.evaluate(one))
        if tiles is not None or executor is not None:
            raise _native.NavwalkerError("tiles and executor are of one design, both of them; use sweep for many")
        given = list(constellations)
        if not given:
            raise _native.NavwalkerError("there is no constellation to evaluate")
        texts = [one for one in given if isinstance(one, str)]
        with followed(progress, "design") as tick:
            if len(texts) == len(given):
                return Table(self._engine.evaluate_texts(texts, keeps, tick))
            return Table(self._engine.evaluate_all([self._native_of(one) for one in given], keeps, tick))

    def gnss_only(self) -> Metrics | None:
        """The metrics of the GNSS alone; None without GNSS."""
        found = self._engine.gnss_only()
        return None if found is None else Metrics("GNSS alone", found)

    def series(self, constellation: Given) -> Table:
        """The metrics by instant, over all points with their weights: ``elapsed_s``, ``mean_pdop``, …"""
        return Table(self._engine.series(self._native_of(constellation))[0])

    def by_point(self, constellation: Given) -> Table:
        """The metrics by ground point, over all instants: ``latitude_deg``, ``longitude_deg``, ``mean_pdop``, …"""
        return Table(self._engine.series(self._native_of(constellation))[1])

    def maps(self, constellation: Given) -> xarray.Dataset:
        """The metrics by ground point as a Dataset: over ``latitude`` and ``longitude``, degrees, where the points fill a
        lattice, or else over ``point``. Needs xarray."""
        from navwalker._maps import dataset_of

        needed("xarray", "maps")
        return dataset_of(self.by_point(constellation))

    def samples(self, constellation: Given) -> Samples:
        """PDOP and satellites in view of every sample, as arrays of (time, point)."""
        found = self._engine.samples(self._native_of(constellation))
        shape = (len(self.elapsed_s), len(self.points))
        pdop, visible, gnss_visible = found
        return Samples(
            self.elapsed_s, pdop.reshape(shape), visible.reshape(shape), gnss_visible.reshape(shape), self.points
        )

    def positions(self, constellation: Given, *, frame: str = "ITRF") -> npt.NDArray[np.float64]:
        """Positions of (satellite, time, 3), km, in ITRF, TEME, EME2000 or GCRF; NaN where a satellite has no state."""
        return self._engine.positions(self._native_of(constellation), frame)[0]

    def satellite_names(self, constellation: Given) -> list[str]:
        """The names of the satellites, in the order of :meth:`positions`."""
        return self._engine.positions(self._native_of(constellation), "TEME")[1]

    def look_angles(
        self, constellation: Given, point: int = 0
    ) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Azimuth (from north by east) and elevation of (satellite, time) at the ground point of this place, degrees."""
        count = len(self.points)
        if not 0 <= point < count:
            raise _native.NavwalkerError(f"point is {point}, expected 0 to {count - 1}")
        return self._engine.look_angles(self._native_of(constellation), point)

    @overload
    def optimize(
        self, *, seed: int | None = None, out: Path | None = None, force: bool = False, progress: bool = False
    ) -> Run: ...
    @overload
    def optimize(
        self, *, seed: int | None = None, objectives: Sequence[str | Objective], progress: bool = False
    ) -> CustomRun: ...

    def optimize(
        self,
        *,
        seed: int | None = None,
        out: Path | None = None,
        force: bool = False,
        objectives: Sequence[str | Objective] | None = None,
        progress: bool = False,
    ) -> Run | CustomRun:
        """Searches for the Pareto set as the scenario says.

        The run is kept in the directory ``out`` (with ``force`` in place of one that is there), or else in a temporary
        one that goes with the object.

        ``objectives`` replace those of the scenario: names of quantities (``"satellites"``), and functions that take the
        :class:`Table` of a generation's designs and return an array with one number to minimise for each. Such a search
        is a :class:`CustomRun`, which is not kept in files.

        ``progress`` says on stderr how far the search is, as a line that terminals and notebooks rewrite.
        """
        if objectives is not None:
            from navwalker._custom import search as custom

            if out is not None:
                raise _native.NavwalkerError("a search with objectives of your own is not kept in files; omit out")
            return custom(self, seed, objectives, progress)
        from navwalker._run import search

        return search(self, seed, out, force, progress)

    def sweep(
        self,
        designs: Iterable[Given] | None = None,
        *,
        store: Path,
        executor: Executor | None = None,
        chunk: int | None = None,
        format: Literal["parquet", "csv"] | None = None,
        force: bool = False,
        allow_large: bool = False,
        progress: bool = False,
    ) -> Sweep:
        """Evaluates every design of the search space, on the steps of its grid, or those of a list, and keeps every metric
        in one table in the directory ``store``, with the same bytes wherever the designs were evaluated.

        The work is cut into chunks, of ``chunk`` designs or of some seconds on one thread. Each is kept as it is done: a
        store that holds this sweep is continued, after Ctrl-C or a failure too, and another one is replaced with ``force``
        alone. ``executor`` evaluates the chunks elsewhere: a ``Client`` of Dask, or an executor like those of
        ``concurrent.futures``, of loky or of ``mpi4py.futures``; without it they are evaluated here, on all threads.
        A sweep that cannot be finished raises :class:`SweepError`, which says what is missing; one of more than 20 million
        designs begins with ``allow_large`` alone.

        A process of an executor evaluates on one thread, unless the scenario has ``threads``; a worker of Dask on its own.
        """
        from navwalker._sweep import sweep

        options = {"chunk": chunk, "format": format, "force": force, "allow_large": allow_large}
        return sweep(self, designs, store, executor, options, progress)

    def problem(self) -> Any:
        """The search of the scenario as a pymoo Problem of real variables, which rounds those that are whole."""
        from navwalker._problem import problem

        return problem(self)

    def batch(self, vectors: npt.ArrayLike) -> dict[str, Any]:
        """Evaluates vectors of the search space, one a row, for any optimiser.

        Every value is moved to the nearest that its variable can take. Returns ``objectives`` as minimised (n, m),
        infinite where they have no value; ``violation`` (n), 0 where all constraints are kept; the ``vectors`` as
        evaluated; and the ``notation`` of each design.
        """
        import numpy as np

        given = np.ascontiguousarray(np.atleast_2d(numbers("vectors", vectors)), dtype=np.float64)
        variables, _ = _native.search_space(self._engine)
        if given.ndim != 2 or given.shape[1] != len(variables):
            raise _native.NavwalkerError(f"vectors have shape {given.shape}, expected (n, {len(variables)})")
        finite("vectors", given)
        objectives, violation, evaluated, notation = _native.answers(self._engine, given)
        return {"objectives": objectives, "violation": violation, "vectors": evaluated, "notation": notation}

    def search_space(self) -> list[tuple[str, str, float, float]]:
        """Name, kind (integer, real or category) and bounds of each variable of the search."""
        return _native.search_space(self._engine)[0]

    def objectives(self) -> list[str]:
        """The names of the objectives."""
        return _native.search_space(self._engine)[1]

    def _native_of(self, given: Given) -> _native.NativeConstellation:
        if isinstance(given, Constellation):
            return given._native
        if isinstance(given, str):
            return self._engine.constellation(given)
        raise _native.DesignError(f"a constellation is a notation or a Constellation, not {type(given).__name__}")

    @property
    def _given_text(self) -> tuple[str, str] | None:
        """Its text and the directory of its files, if it was given as a text."""
        return None if self._text is None else (self._text, self._directory)

    def _arguments(self) -> list[str]:
        """The scenario as arguments of a command, without its text."""
        source = [self._source] if self._text is None else []
        sets = [part for one in self._overrides for part in ("--set", one)]
        threads = [] if self._threads is None else ["--threads", str(self._threads)]
        return [*sets, *threads, *source]

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (self._source, self._overrides, self._threads, self._directory, self._text is not None)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scenario):
            return NotImplemented
        return self.hash == other.hash

    def __hash__(self) -> int:
        return hash(self.hash)

    def __repr__(self) -> str:
        source = "text" if self._text is not None else repr(self._source)
        more = "".join(f", {one}" for one in self._overrides)
        return f"<Scenario {self.name} from {source}{more}>"


def _again(
    source: str, given: list[str], threads: int | None, directory: str, is_text: bool
) -> Scenario:
    made = Scenario.__new__(Scenario)
    made._source, made._overrides, made._threads = source, given, threads
    made._directory, made._text = directory, source if is_text else None
    label = "scenario" if is_text else source
    made._engine = _native.Engine(label, made._text, directory, given, threads)
    return made


def _columns(given: Mapping[str, Any]) -> tuple[Whole, Whole, Whole, Real, Real]:
    """The columns of shells, in the order in which the native part takes them, of one length."""
    import numpy as np

    missing = [name for name in _COLUMNS if name not in given]
    unknown = [name for name in given if name not in _COLUMNS]
    if unknown:
        raise TypeError(f"unknown argument {unknown[0]!r}; the columns are {', '.join(_COLUMNS)}")
    if missing:
        raise TypeError(f"columns need {', '.join(missing)} too")
    arrays = [np.atleast_1d(numbers(name, given[name])) for name in _COLUMNS]
    for name, array in zip(_COLUMNS, arrays, strict=True):
        if array.ndim != 1:
            raise _native.NavwalkerError(f"{name} has the shape {array.shape}, expected one dimension")
        finite(name, array)
    try:
        planes, per_plane, inclination, altitude, phasing = np.broadcast_arrays(*arrays)
    except ValueError:
        shapes = ", ".join(f"{name} {len(array)}" for name, array in zip(_COLUMNS, arrays, strict=True))
        raise _native.NavwalkerError(f"the columns have different lengths: {shapes}") from None
    if len(planes) == 0:
        raise _native.NavwalkerError("there is no constellation to evaluate")
    whole = []
    for name, array in (("planes", planes), ("satellites_per_plane", per_plane), ("phasing", phasing)):
        rounded = np.rint(array)
        if not np.array_equal(rounded, array):
            row = int(np.argmax(rounded != array))
            raise _native.NavwalkerError(f"{name} is {array[row]} in row {row}, expected a whole number")
        whole.append(np.ascontiguousarray(rounded, dtype=np.int64))
    real = [np.ascontiguousarray(one, dtype=np.float64) for one in (inclination, altitude)]
    return whole[0], whole[1], whole[2], real[0], real[1]
