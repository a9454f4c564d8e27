"""Metrics by ground point as an xarray Dataset."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from navwalker._extras import needed
from navwalker._results import Table

if TYPE_CHECKING:
    import xarray

_UNITS = {"latitude_deg": "degrees_north", "longitude_deg": "degrees_east"}
_NAMES = {
    "latitude_deg": "latitude",
    "longitude_deg": "longitude",
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


def _attributes(name: str) -> dict[str, str]:
    units = _UNITS.get(name, "s" if name.endswith("_s") else "1")
    return {"long_name": _NAMES.get(name, name.replace("_", " ")), "units": units}


def dataset_of(points: Table) -> xarray.Dataset:
    """The columns of a table of points, over latitude and longitude where the points fill a lattice."""
    xr = needed("xarray", "maps")
    latitudes, longitudes = points["latitude_deg"], points["longitude_deg"]
    rows, row = np.unique(latitudes, return_inverse=True)
    columns, column = np.unique(longitudes, return_inverse=True)
    is_lattice = len(rows) * len(columns) == len(latitudes) and len(set(zip(row, column, strict=True))) == len(latitudes)
    variables: dict[str, Any] = {}
    for name in points.columns:
        values = points[name]
        if name in ("latitude_deg", "longitude_deg") or (name == "name" and all(one is None for one in values)):
            continue
        if not is_lattice:
            variables[name] = ("point", values, _attributes(name))
            continue
        laid_out = np.empty((len(rows), len(columns)), dtype=values.dtype)
        laid_out[row, column] = values
        variables[name] = (("latitude_deg", "longitude_deg"), laid_out, _attributes(name))
    places = {"latitude_deg": rows, "longitude_deg": columns}
    if not is_lattice:
        places = {"latitude_deg": latitudes, "longitude_deg": longitudes}
    coordinates = {
        name: (name if is_lattice else "point", values, _attributes(name)) for name, values in places.items()
    }
    dataset: xarray.Dataset = xr.Dataset(variables, coords=coordinates)
    return dataset
