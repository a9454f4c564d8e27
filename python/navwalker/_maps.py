"""Metrics by ground point as an xarray Dataset."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from navwalker._extras import needed
from navwalker._results import Table

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    import xarray

# Columns of tables that are coordinates of Datasets: their names there, which carry no unit since the coordinate does.
PLACES = {"latitude_deg": "latitude", "longitude_deg": "longitude"}
_UNITS = {"latitude": "degrees_north", "longitude": "degrees_east"}
_NAMES = {
    "mean_visible": "mean visible LEO satellites",
    "mean_pdop": "mean PDOP",
    "p95_pdop": "95 % quantile of PDOP",
    "max_pdop": "maximum PDOP",
    "solved_fraction": "fraction of instants that are solved",
    "availability": "fraction of instants within the availability threshold",
    "least_visible": "least visible LEO satellites",
    "mean_gnss_visible": "mean visible GNSS satellites",
    "mean_total_visible": "mean visible satellites",
    "outages": "number of outages",
    "longest_outage_s": "longest outage",
    "total_outage_s": "all outages together",
    "gain_mean_pdop": "gain in mean PDOP over the GNSS alone",
}


def attributes(name: str) -> dict[str, str]:
    """Long name and units of a variable."""
    units = _UNITS.get(name, "s" if name.endswith("_s") else "1")
    return {"long_name": _NAMES.get(name, name.replace("_", " ")), "units": units}


@dataclass(frozen=True)
class Lattice:
    """Points that fill a lattice of latitudes and longitudes, degrees."""

    latitudes: npt.NDArray[np.float64]
    longitudes: npt.NDArray[np.float64]
    row: npt.NDArray[np.int64]
    column: npt.NDArray[np.int64]

    @classmethod
    def of(cls, points: Table) -> Lattice | None:
        """The lattice that the points of a table fill, if they do."""
        import numpy as np

        latitudes, longitudes = points["latitude_deg"], points["longitude_deg"]
        rows, row = np.unique(latitudes, return_inverse=True)
        columns, column = np.unique(longitudes, return_inverse=True)
        places = set(zip(row.tolist(), column.tolist(), strict=True))
        if len(places) < len(latitudes) or len(places) < len(rows) * len(columns):
            return None
        return cls(rows, columns, row, column)

    def laid_out(self, values: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Values of the points as an array of (latitude, longitude)."""
        import numpy as np

        array = np.empty((len(self.latitudes), len(self.longitudes)), dtype=values.dtype)
        array[self.row, self.column] = values
        return array


def dataset_of(points: Table) -> xarray.Dataset:
    """The columns of a table of points, over latitude and longitude where the points fill a lattice."""
    xr = needed("xarray", "maps")
    lattice = Lattice.of(points)
    variables: dict[str, Any] = {}
    for name in points.columns:
        values = points[name]
        if name in PLACES or (name == "name" and all(one is None for one in values)):
            continue
        if lattice is None:
            variables[name] = ("point", values, attributes(name))
        else:
            variables[name] = (("latitude", "longitude"), lattice.laid_out(values), attributes(name))
    places = coordinates_of(points)
    if lattice is not None:
        places = {"latitude": ("latitude", lattice.latitudes, attributes("latitude"))}
        places["longitude"] = ("longitude", lattice.longitudes, attributes("longitude"))
    dataset: xarray.Dataset = xr.Dataset(variables, coords=places)
    return dataset


def coordinates_of(points: Table) -> dict[str, tuple[str, npt.NDArray[Any], dict[str, str]]]:
    """The places of points as coordinates of the dimension ``point``."""
    return {name: ("point", points[column], attributes(name)) for column, name in PLACES.items()}
