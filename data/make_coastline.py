#!/usr/bin/env python3
"""Turns a land file of the npm package world-atlas (TopoJSON of Natural Earth) into coastlines.

    npm pack world-atlas@2.0.2 && tar xzf world-atlas-2.0.2.tgz
    python3 data/make_coastline.py package/land-110m.json 0.20 > data/coastline/world-110m.txt
    python3 data/make_coastline.py package/land-50m.json 0.05 > data/coastline/world-50m.txt

The second argument is the tolerance of the simplification, degrees. A line of the result is a
polyline: longitude and latitude in hundredths of a degree, point by point.
"""

import json
import math
import sys


def arcs(topology):
    """The arcs of a quantised TopoJSON in degrees."""
    (sx, sy), (tx, ty) = topology["transform"]["scale"], topology["transform"]["translate"]
    for arc in topology["arcs"]:
        x = y = 0
        points = []
        for dx, dy in arc:
            x, y = x + dx, y + dy
            points.append((x * sx + tx, y * sy + ty))
        yield points


def unwrapped(points):
    """The points with longitudes that do not jump where a line crosses the antimeridian."""
    turn = 0
    run = points[:1]
    for (x0, _), (x1, y1) in zip(points, points[1:]):
        if abs(x1 - x0) > 180:
            turn += -360 if x1 > x0 else 360
        run.append((x1 + turn, y1))
    return run


def is_cut(a, b):
    """Whether a segment closes a polygon on the edge of the map and is no coast."""
    on_meridian = abs(abs(a[0]) - 180) < 0.01 and abs(abs(b[0]) - 180) < 0.01
    on_pole = a[1] < -89.9 or b[1] < -89.9
    return on_meridian or on_pole


def coasts(points):
    """The runs of an arc between its cuts."""
    run = points[:1]
    for a, b in zip(points, points[1:]):
        if is_cut(a, b):
            yield run
            run = []
        run.append(b)
    yield run


def distance(p, a, b):
    """From p to the segment from a to b, degrees on the map."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    length2 = dx * dx + dy * dy
    along = 0 if length2 == 0 else ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / length2
    along = min(1, max(0, along))
    return math.hypot(p[0] - a[0] - along * dx, p[1] - a[1] - along * dy)


def simplified(points, tolerance):
    """Douglas and Peucker's selection, without recursion."""
    keep = {0, len(points) - 1}
    spans = [(0, len(points) - 1)]
    while spans:
        first, last = spans.pop()
        inner = range(first + 1, last)
        far = max(inner, key=lambda n: distance(points[n], points[first], points[last]), default=None)
        if far is not None and distance(points[far], points[first], points[last]) > tolerance:
            keep.add(far)
            spans += [(first, far), (far, last)]
    return [points[n] for n in sorted(keep)]


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        topology = json.load(file)
    tolerance = float(sys.argv[2])
    for arc in arcs(topology):
        for run in coasts(arc):
            if len(run) < 2:
                continue
            line = simplified(unwrapped(run), tolerance)
            size = max(math.dist(a, line[0]) for a in line)
            if size > 2 * tolerance:
                print(" ".join(f"{round(100 * x)} {round(100 * y)}" for x, y in line))


main()
