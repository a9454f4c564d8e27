#!/usr/bin/env python3
"""Reads the scenario files of an export with readers that this project did not write.

    python -m venv venv && venv/bin/pip install -r requirements.txt
    navwalker export paper --design delta:55:182/13/1@925 --as czml,geojson,kml,stk,yuma,csv --out DIR
    venv/bin/python check_scenarios.py DIR

CZML is read by czml3, and its positions are interpolated by SciPy's Lagrange form and compared with
states.csv; GeoJSON by geojson and Shapely, KML by fastkml. The almanacs are flown by the algorithm of
IS-GPS-200, written here, against the GNSS of the CZML. Prints the largest difference of every check
with its tolerance; the exit status is 1 if one is exceeded or a file is missing or refused.
"""

import csv
import json
import re
import sys
from datetime import datetime, timedelta, timezone
from math import cos, radians, sin, sqrt
from pathlib import Path

import fastkml
import geojson
import numpy as np
from czml3 import Packet
from scipy.interpolate import BarycentricInterpolator
from shapely.geometry import Point, Polygon, shape
from shapely.ops import unary_union

# A metre by the spacing of the samples, twice for other satellites than the one it is chosen on, and digits.
CZML_KM = 2.2e-3
# The almanac's radius is off by what the manifest says; its angles have ten digits, its A a metre.
YUMA_KM = 5e-3


class Report:
    """Collects checks and prints them as they come."""

    def __init__(self):
        self.failed = 0

    def check(self, name, good, detail=""):
        self.failed += not good
        print(f"{'passed' if good else 'FAILED'}  {name}  {detail}")

    def number(self, name, value, tolerance, unit):
        self.check(name, bool(value <= tolerance), f"{value:.3g} <= {tolerance:.3g} {unit}")


def tracks(packets):
    """Positions of the packets that have sampled ones: id -> (epoch, times, km, degree)."""
    found = {}
    for packet in packets:
        position = packet.get("position") or {}
        values = position.get("cartesian")
        if values is None or len(values) <= 3:
            continue
        assert position["referenceFrame"] == "FIXED"
        assert position["interpolationAlgorithm"] == "LAGRANGE"
        table = np.array(values, float).reshape(-1, 4)
        epoch = datetime.fromisoformat(position["epoch"].replace("Z", "+00:00"))
        found[packet["id"]] = (epoch, table[:, 0], table[:, 1:] / 1000, position["interpolationDegree"])
    return found


def interpolate(track, t):
    """The polynomial through the nodes around t, half of them on each side."""
    _, times, km, degree = track
    first = int(np.clip(np.searchsorted(times, t, side="right") - (degree + 1) // 2, 0, len(times) - degree - 1))
    nodes = slice(first, first + degree + 1)
    return BarycentricInterpolator(times[nodes] - times[first], km[nodes])(t - times[first])


def states(folder):
    """Positions by satellite: seconds since the first sample, Earth-fixed and TEME."""
    rows = {}
    with open(folder / "states.csv", newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            place = [[float(row[f"{frame}_{axis}_km"]) for axis in "xyz"] for frame in ("itrf", "teme")]
            rows.setdefault(row["object"], []).append((float(row["elapsed_s"]), *place))
    return rows


def check_czml(folder, report):
    packets = json.loads((folder / "scene.czml").read_text(encoding="utf-8"))
    for packet in packets:
        # Refuses unknown keys and values. It lacks the height of a rectangle, which CZML has.
        rectangle = {k: v for k, v in packet.get("rectangle", {}).items() if k != "height"}
        Packet.model_validate({**packet, **({"rectangle": rectangle} if rectangle else {})})
    report.check("czml3 takes every packet", packets[0]["id"] == "document", f"{len(packets)} packets")
    found = tracks(packets)
    flown = states(folder)
    worst = 0.0
    for name, rows in flown.items():
        for t, km, _ in rows[:: max(1, len(rows) // 40)] + rows[-1:]:
            worst = max(worst, float(np.linalg.norm(interpolate(found[name], t) - km)))
    report.number("CZML positions by SciPy", worst, CZML_KM, "km")
    return packets, found


def pole_or_edge(polygon):
    west, south, east, north = polygon.bounds
    return west >= -180 and east <= 180 and south >= -90 and north <= 90


def check_geojson(folder, report):
    collections = {}
    for name in ["region", "ground-tracks", "footprints"]:
        text = (folder / "geojson" / f"{name}.geojson").read_text(encoding="utf-8")
        loaded = geojson.loads(text)
        errors = [feature.errors() for feature in loaded.features if not feature.is_valid]
        report.check(f"geojson takes {name}", loaded.is_valid and not errors, f"{len(loaded.features)} features")
        collections[name] = loaded.features
    polygons = [
        polygon
        for name in ["region", "footprints"]
        for feature in collections[name]
        for polygon in parts(shape(feature.geometry))
        if isinstance(polygon, Polygon)
    ]
    report.check("rings are simple", all(polygon.is_valid for polygon in polygons))
    report.check("rings are counterclockwise", all(polygon.exterior.is_ccw for polygon in polygons))
    report.check("areas lie within 180 degrees", all(pole_or_edge(polygon) for polygon in polygons))
    inside = [
        shape(f.geometry).buffer(1e-9).contains(
            Point(f.properties["epoch_longitude_deg"], f.properties["epoch_latitude_deg"])
        )
        for f in collections["footprints"]
    ]
    report.check("footprints hold the places below", all(inside), f"{len(inside)} satellites")
    cells = [shape(f.geometry) for f in collections["region"] if f.geometry["type"] != "Point"]
    if cells:
        whole = unary_union(cells).area
        apart = abs(whole - sum(cell.area for cell in cells))
        report.number("cells do not overlap", apart, 1e-6, "square degrees")
    longest = 0.0
    for feature in collections["ground-tracks"]:
        for line in feature.geometry["coordinates"]:
            steps = np.abs(np.diff(np.array(line)[:, 0]))
            longest = max(longest, float(steps.max()))
    report.number("tracks are cut at the antimeridian", longest, 180.0, "degrees a step")
    return collections


def parts(geometry):
    return list(geometry.geoms) if hasattr(geometry, "geoms") else [geometry]


def placemarks(feature):
    for child in getattr(feature, "features", []) or []:
        if isinstance(child, fastkml.Placemark):
            yield child
        else:
            yield from placemarks(child)


def check_kml(folder, collections, report):
    document = fastkml.KML.parse(folder / "scene.kml", strict=True)
    marks = list(placemarks(document))
    wanted = sum(len(features) for features in collections.values())
    report.check("fastkml reads every placemark", len(marks) == wanted, f"{len(marks)} of {wanted}")
    worst = 0.0
    features = collections["region"] + collections["ground-tracks"] + collections["footprints"]
    for mark, feature in zip(marks, features):
        ours = shape(mark.geometry.__geo_interface__)
        theirs = shape(feature.geometry)
        worst = max(worst, max(abs(a - b) for a, b in zip(ours.bounds, theirs.bounds)))
    report.number("KML and GeoJSON agree", worst, 1e-9, "degrees")


MU = 3.986005e14
EARTH_RATE = 7.2921151467e-5
GPS_START = datetime(1980, 1, 6, tzinfo=timezone.utc)
# GPS time less UTC since 2017.
LEAP = 18


def almanac_position(block, gps_seconds):
    """IS-GPS-200, table 20-IV with the parameters of an almanac, km."""
    t = gps_seconds - block["toa"]
    a = block["sqrt_a"] ** 2
    m = block["m0"] + sqrt(MU / a**3) * t
    e = m
    for _ in range(20):
        e = m + block["e"] * sin(e)
    v = np.arctan2(sqrt(1 - block["e"] ** 2) * sin(e), cos(e) - block["e"])
    u = v + block["w"]
    r = a * (1 - block["e"] * cos(e))
    node = block["node"] + (block["rate"] - EARTH_RATE) * t - EARTH_RATE * block["toa"]
    x, y = r * cos(u), r * sin(u)
    i = block["i"]
    return np.array([
        x * cos(node) - y * cos(i) * sin(node), x * sin(node) + y * cos(i) * cos(node), y * sin(i)
    ]) / 1000


def almanacs(text):
    keys = {
        "ID": "prn", "Eccentricity": "e", "Time of Applicability(s)": "toa", "Orbital Inclination(rad)": "i",
        "Rate of Right Ascen(r/s)": "rate", "SQRT(A)  (m 1/2)": "sqrt_a", "Right Ascen at Week(rad)": "node",
        "Argument of Perigee(rad)": "w", "Mean Anom(rad)": "m0", "week": "week",
    }
    for block in re.split(r"^\*{8}.*\*{8}$", text, flags=re.M)[1:]:
        pairs = [line.split(":", 1) for line in block.strip().splitlines()]
        yield {keys[key]: float(value) for key, value in pairs if key in keys}


def check_yuma(folder, manifest, found, report):
    for entry in manifest["files"]:
        if entry["format"] != "yuma":
            continue
        shift = entry["loss"]["theory_max_km"]
        names = dict(re.findall(r"PRN-(\d+) = ([^,]+)", entry["assumptions"][-1]))
        system = Path(entry["path"]).stem
        worst = 0.0
        for block in almanacs((folder / entry["path"]).read_text(encoding="ascii")):
            name = names[f"{int(block['prn']):02}"]
            track = found[f"gnss:{system}:{name}"]
            # The samples reach beyond the span at both ends.
            for seconds in np.linspace(0, track[1][-4], 5):
                at = track[0] + timedelta(seconds=float(seconds))
                gps = (at - GPS_START).total_seconds() + LEAP
                # The week counts from the last multiple of 1024 before the study.
                weeks = int(gps // 604800) // 1024 * 1024 + block["week"]
                position = almanac_position(block, gps - weeks * 604800)
                shown = interpolate(track, seconds)
                turned = position * (np.linalg.norm(shown) / np.linalg.norm(position))
                worst = max(worst, float(np.linalg.norm(turned - shown)))
                radial = abs(np.linalg.norm(position) - np.linalg.norm(shown))
                if radial > shift + YUMA_KM:
                    report.number(f"radius of PRN {block['prn']:.0f}", radial, shift + YUMA_KM, "km")
        report.number(f"almanac of {system} by IS-GPS-200", worst, YUMA_KM, "km")


def place_of(elements):
    """Where mean elements are at their epoch, km, TEME."""
    a, e, i, w, node, m = elements
    i, w, node, m = map(radians, (i, w, node, m))
    anomaly = m
    for _ in range(50):
        anomaly = m + e * sin(anomaly)
    x, y = a * (cos(anomaly) - e), a * sqrt(1 - e * e) * sin(anomaly)
    p, q = x * cos(w) - y * sin(w), x * sin(w) + y * cos(w)
    return np.array([
        p * cos(node) - q * cos(i) * sin(node), p * sin(node) + q * cos(i) * cos(node), q * sin(i)
    ]) / 1000


def walker(seed, kind, planes, per_plane, phasing):
    """The satellites that Walker makes of a circular seed, plane by plane, as STK's documentation has it."""
    spread = {"Delta": 360, "Star": 180}[kind]
    a, e, i, w, node, m = seed
    for k in range(planes):
        for j in range(per_plane):
            ahead = 360 * j / per_plane + 360 * phasing * k / (planes * per_plane)
            yield a, e, i, w, node + spread * k / planes, m + ahead


def check_connect(folder, report):
    """The elements of the commands, and those that Walker makes of a seed, at the epoch: states.csv, TEME."""
    lines = (folder / "stk-scenario" / "connect.txt").read_text(encoding="ascii").splitlines()
    rows = {name: np.array(samples[0][2]) for name, samples in states(folder).items()}
    state = re.compile(
        r'SetState \*/Satellite/(\S+) Classical J2Perturbation UseScenarioInterval \S+ TEMEOfEpoch "[^"]+" (.*) "'
    )
    shell = re.compile(
        r"Walker \*/Satellite/(\S+) Type (Delta|Star) NumPlanes (\d+) NumSatsPerPlane (\d+) InterPlanePhaseIncrement (\d+) "
    )
    given, found = {}, {}
    for line in lines:
        if match := state.match(line):
            given[match[1]] = tuple(map(float, match[2].split()))
            if match[1] in rows:
                found[match[1]] = place_of(given[match[1]])
        elif match := shell.match(line):
            planes, per_plane, phasing = map(int, match.groups()[2:])
            # Names in states.csv go on plane by plane after the prefix of the shell.
            names = [name for name in rows if re.fullmatch(re.escape(match[1]) + r"-P\d+-S\d+", name)]
            made = walker(given[match[1]], match[2], planes, per_plane, phasing)
            found.update(zip(names, map(place_of, made), strict=True))
    worst = max(float(np.linalg.norm(place - rows[name])) for name, place in found.items())
    report.check("Connect sets every satellite", found.keys() == rows.keys(), f"{len(found)} of {len(rows)}")
    report.number("elements of Connect at the epoch", worst, 1e-6, "km")


def main():
    folder = Path(sys.argv[1])
    report = Report()
    manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    _, found = check_czml(folder, report)
    collections = check_geojson(folder, report)
    check_kml(folder, collections, report)
    check_yuma(folder, manifest, found, report)
    check_connect(folder, report)
    return 1 if report.failed else 0


if __name__ == "__main__":
    sys.exit(main())
