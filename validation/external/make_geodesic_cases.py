"""Exact vectors by GeographicLib's own CartConvert and GeodSolve (Debian: geographiclib-tools).

    python3 validation/external/make_geodesic_cases.py

writes `validation/cases/geodesic/positions.csv` (geodetic point and height to Earth-fixed
coordinates, WGS 84) and `geodesics.csv` (a direct problem, and the distance by the inverse one).
"""

import itertools
import subprocess
from pathlib import Path

OUT = Path(__file__).parent.parent / "cases" / "geodesic"
LATITUDES = [-90, -89.9999, -60, -33.9, -1e-7, 0, 3, 30, 45, 53, 78.2, 90]
LONGITUDES = [-179.999999, -70.7, 0, 73, 116.4, 180]
HEIGHTS_M = [0, 400e3, 925e3, 2000e3, 20180e3, 35786e3]
BEARINGS = [0, 45, 90, 171.3, 260]
WAYS_M = [1000, 250e3, 3000e3, 9000e3]


def decimal(x):
    """Plain digits: in GeographicLib's input an E is a hemisphere."""
    return format(x, ".9f").rstrip("0").rstrip(".") if isinstance(x, float) else str(x)


def run(program, *options, lines):
    done = subprocess.run([program, *options], input="\n".join(lines) + "\n", text=True,
                          capture_output=True, check=True)
    return [line.split() for line in done.stdout.splitlines()]


def positions():
    cases = list(itertools.product(LATITUDES, LONGITUDES, HEIGHTS_M))
    found = run("CartConvert", "-p", "10", lines=[f"{decimal(a)} {decimal(b)} {decimal(h)}" for a, b, h in cases])
    rows = [",".join([decimal(a), decimal(b), decimal(h), *xyz]) for (a, b, h), xyz in zip(cases, found)]
    header = "latitude_deg,longitude_deg,height_m,x_m,y_m,z_m"
    (OUT / "positions.csv").write_text("\n".join([header, *rows]) + "\n")


def geodesics():
    cases = list(itertools.product(LATITUDES, LONGITUDES, BEARINGS, WAYS_M))
    ends = run("GeodSolve", "-p", "10", lines=[f"{decimal(a)} {decimal(b)} {decimal(z)} {decimal(s)}" for a, b, z, s in cases])
    back = run("GeodSolve", "-i", "-p", "10",
               lines=[f"{decimal(a)} {decimal(b)} {e[0]} {e[1]}" for (a, b, _, _), e in zip(cases, ends)])
    rows = [",".join([decimal(a), decimal(b), decimal(z), decimal(s), e[0], e[1], i[2]])
            for (a, b, z, s), e, i in zip(cases, ends, back)]
    header = "latitude_deg,longitude_deg,azimuth_deg,way_m,end_latitude_deg,end_longitude_deg,distance_m"
    (OUT / "geodesics.csv").write_text("\n".join([header, *rows]) + "\n")


if __name__ == "__main__":
    positions()
    geodesics()
