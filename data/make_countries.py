#!/usr/bin/env python3
"""Turns the countries file of the npm package world-atlas (TopoJSON of Natural Earth) into polygons.

    npm pack world-atlas@2.0.2 && tar xzf world-atlas-2.0.2.tgz
    python3 data/make_countries.py package/countries-110m.json > data/countries/world-110m.txt

A line that begins with `=` names a country; the lines behind it are the outer rings of its polygons,
closed, longitude and latitude in thousandths of a degree, position by position. A line that begins
with `hole` is a hole of the polygon before it. Nothing is simplified, so that neighbours keep
sharing their borders. Names that Natural Earth abbreviates are written out.
"""

import json
import sys

NAMES = {
    "Bosnia and Herz.": "Bosnia and Herzegovina",
    "Central African Rep.": "Central African Republic",
    "Congo": "Republic of the Congo",
    "Dem. Rep. Congo": "Democratic Republic of the Congo",
    "Dominican Rep.": "Dominican Republic",
    "Eq. Guinea": "Equatorial Guinea",
    "Falkland Is.": "Falkland Islands",
    "Fr. S. Antarctic Lands": "French Southern and Antarctic Lands",
    "Macedonia": "North Macedonia",
    "N. Cyprus": "Northern Cyprus",
    "S. Sudan": "South Sudan",
    "Solomon Is.": "Solomon Islands",
    "W. Sahara": "Western Sahara",
    "eSwatini": "Eswatini",
}


def arcs(topology):
    """The arcs of a quantised TopoJSON in thousandths of a degree."""
    (sx, sy), (tx, ty) = topology["transform"]["scale"], topology["transform"]["translate"]
    for arc in topology["arcs"]:
        x = y = 0
        points = []
        for dx, dy in arc:
            x, y = x + dx, y + dy
            points.append((round(1000 * (x * sx + tx)), round(1000 * (y * sy + ty))))
        yield points


def unwrapped(points):
    """A ring with longitudes that do not jump where it crosses the antimeridian; the one around the
    pole, that of Antarctica, is closed along the edge of the map."""
    turn = 0
    run = points[:1]
    for (x0, _), (x1, y1) in zip(points, points[1:]):
        if abs(x1 - x0) > 180_000:
            turn += -360_000 if x1 > x0 else 360_000
        run.append((x1 + turn, y1))
    if turn:
        run += [(run[-1][0], -90_000), (run[0][0], -90_000), run[0]]
    return run


def ring(indices, lines):
    """A closed ring from arcs, of which ~n is arc n backwards, without repeated positions; empty if it has no area."""
    points = []
    for n in indices:
        arc = lines[n] if n >= 0 else lines[~n][::-1]
        points += arc if not points else arc[1:]
    kept = [p for n, p in enumerate(points) if n == 0 or p != points[n - 1]]
    assert kept[0] == kept[-1], kept
    if len(kept) < 4:
        return ""
    return " ".join(f"{x} {y}" for x, y in unwrapped(kept))


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        topology = json.load(file)
    lines = list(arcs(topology))
    countries = topology["objects"]["countries"]["geometries"]
    named = [(NAMES.get(c["properties"]["name"], c["properties"]["name"]), c) for c in countries]
    for name, country in sorted(named, key=lambda one: one[0]):
        print(f"= {name}")
        polygons = country["arcs"] if country["type"] == "MultiPolygon" else [country["arcs"]]
        for outer, *holes in polygons:
            if area := ring(outer, lines):
                print(area)
                for hole in holes:
                    print("hole", ring(hole, lines))


main()
