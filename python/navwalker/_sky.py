"""Dilutions of precision of skies."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from navwalker import _native
from navwalker._arrays import numbers

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt


@dataclass(frozen=True)
class Dops:
    """Dilutions of precision of one or more skies, without unit; NaN where a geometry is not solved.

    ``tdop`` has one more axis: the clocks, in the order of ``systems``.
    """

    gdop: npt.NDArray[np.float64]
    pdop: npt.NDArray[np.float64]
    hdop: npt.NDArray[np.float64]
    vdop: npt.NDArray[np.float64]
    tdop: npt.NDArray[np.float64]
    systems: list[object]


def dop(
    azimuth_deg: npt.ArrayLike,
    elevation_deg: npt.ArrayLike,
    system: npt.ArrayLike | None = None,
    *,
    mask_deg: float = 0.0,
) -> Dops:
    """The dilutions of precision of satellites at some azimuths (from north by east) and elevations, degrees.

    Satellites are along the last axis, and every other axis is one of skies; a satellite that is NaN, or below
    ``mask_deg``, is not there.
    Each ``system`` has a clock state of its own; without systems all satellites share one.

    >>> import navwalker as nw
    >>> sky = nw.dop([0, 120, 240, 0], [20, 20, 20, 90])
    >>> round(float(sky.pdop), 3)
    2.142
    """
    import numpy as np

    azimuth = numbers("azimuth_deg", azimuth_deg).astype(np.float64)
    elevation = numbers("elevation_deg", elevation_deg).astype(np.float64)
    labels = np.zeros((), dtype=np.int64) if system is None else np.asarray(system)
    try:
        azimuth, elevation, labels = np.broadcast_arrays(azimuth, elevation, labels)
    except ValueError:
        shapes = f"{azimuth.shape}, {elevation.shape} and {labels.shape}"
        raise _native.NavwalkerError(f"azimuth, elevation and system have shapes {shapes}, which do not fit") from None
    if azimuth.ndim == 0:
        raise _native.NavwalkerError("dop needs at least one axis, that of the satellites")
    wrong = (elevation < -90) | (elevation > 90)
    if wrong.any():
        raise _native.NavwalkerError(f"an elevation is {elevation[wrong][0]}, expected -90 to 90")
    if np.isinf(azimuth).any() or np.isinf(elevation).any():
        raise _native.NavwalkerError("an azimuth or elevation is infinite")
    systems: list[object] = ["all"]
    clocks = labels
    if system is not None:
        systems, clocks = _distinct(labels)
    skies, satellites = azimuth.shape[:-1], azimuth.shape[-1]
    count = int(np.prod(skies, dtype=np.int64))
    rows = (count, satellites)
    found = _native.dilutions(
        np.ascontiguousarray(azimuth.reshape(rows)),
        np.ascontiguousarray(elevation.reshape(rows)),
        np.ascontiguousarray(clocks.reshape(rows), dtype=np.int64),
        len(systems),
        mask_deg,
    ).reshape(count, 4 + len(systems))
    gdop, pdop, hdop, vdop = (found[:, place].reshape(skies) for place in range(4))
    tdop = found[:, 4:].reshape((*skies, len(systems)))
    return Dops(gdop, pdop, hdop, vdop, tdop, systems)


def _distinct(labels: npt.NDArray[Any]) -> tuple[list[object], npt.NDArray[np.int64]]:
    """The systems, and the number of that of each satellite."""
    import numpy as np

    try:
        systems, clocks = np.unique(labels, return_inverse=True)
    except TypeError:
        raise _native.NavwalkerError("system has labels that cannot be compared; give texts or numbers") from None
    return systems.tolist(), clocks.astype(np.int64).reshape(labels.shape)
