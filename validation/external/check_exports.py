#!/usr/bin/env python3
"""Reads an export with readers that this project did not write.

    python -m venv venv && venv/bin/pip install -r requirements.txt
    navwalker export paper --design delta:55:182/13/1@925 --as tle,tle-states,omm,oem,sp3,csv --omm-syntax xml --out DIR
    venv/bin/python check_exports.py DIR

The tables states.csv and tle-states.csv are the truth. TLEs are read and flown by python-sgp4 and by
Skyfield, OMMs in XML, JSON and CSV by Skyfield, OEMs in keyword = value notation are read by the oem
package and brought to TEME by ERFA, SP3 is read by georinex. Prints the largest difference of every
check with its tolerance; the exit status is 1 if one is exceeded or a file is missing or refused.
"""

import argparse
import csv
import hashlib
import json
import sys
from collections import defaultdict
from datetime import datetime, timezone
from pathlib import Path

import erfa
import georinex
import numpy as np
from oem import OrbitEphemerisMessage
from sgp4 import omm as sgp4_omm
from sgp4.api import SGP4_ERRORS, Satrec
from sgp4.io import compute_checksum
from skyfield.api import EarthSatellite, load
from skyfield.sgp4lib import TEME

# Two programs of the same theory from the same digits: rounding only.
SGP4_KM = 1e-6
# The frame rotations of two ports of SOFA, and files of 1e-9 km: the project's centimetre.
OEM_KM = 1e-5
# A centimetre a revolution.
OEM_KM_S = 1e-8
# Skyfield keeps time in Julian days of two doubles, and turns TEME to GCRS and back.
SKYFIELD_KM = 1e-5
# SP3 has six decimals of a kilometre in three components.
SP3_KM = 1e-6
# Velocities of SP3 have six decimals of a decimetre a second in three components.
SP3_KM_S = 1e-10
# A TLE epoch steps by 1e-8 day, and its elements belong to the rounded instant.
TLE_EPOCH_S = 0.5e-8 * 86400 * 1.01

POSITION = {"TEME": slice(1, 4), "ITRF": slice(7, 10)}
VELOCITY = {"TEME": slice(4, 7), "ITRF": slice(10, 13)}


class Report:
    """Collects checks and prints them as they come."""

    def __init__(self):
        self.failed = 0

    def number(self, name, value, tolerance, unit):
        good = bool(value <= tolerance)
        self.failed += not good
        print(f"{'ok  ' if good else 'FAIL'} {name}: {value:.3g} {unit} (at most {tolerance:.3g})")

    def same(self, name, found, expected):
        good = found == expected
        self.failed += not good
        print(f"{'ok  ' if good else 'FAIL'} {name}: {found}" + ("" if good else f", expected {expected}"))


def utc(text):
    return datetime.fromisoformat(text.rstrip("Z")).replace(tzinfo=timezone.utc)


def states(path):
    """The rows of a table of states by satellite: stamps, and seconds with both states."""
    stamps, numbers = defaultdict(list), defaultdict(list)
    with open(path, newline="") as file:
        rows = csv.reader(file)
        header = next(rows)
        assert header[3] == "teme_x_km" and header[14] == "itrf_vz_km_s", header
        for row in rows:
            stamps[row[0]].append(row[1])
            numbers[row[0]].append([float(value) for value in row[2:]])
    return stamps, {name: np.array(rows) for name, rows in numbers.items()}


def tai(text):
    """The instant of a UTC stamp, 23:59:60 too, as a Julian date of TAI in two parts."""
    date, time = text.rstrip("Z").split("T")
    (year, month, day), (hour, minute, second) = date.split("-"), time.split(":")
    label = (int(year), int(month), int(day), int(hour), int(minute), float(second))
    return erfa.utctai(*erfa.dtf2d("UTC", *label))


def teme_to_eme2000(epoch, seconds):
    """Matrices by ERFA: equation of the equinoxes (1994), transpose of IAU 1976/1980."""
    day, fraction = tai(epoch)
    tt1, tt2 = erfa.taitt(day, fraction + seconds / 86400.0)
    equinoxes = erfa.eqeq94(tt1, tt2)
    sine, cosine, nought = np.sin(-equinoxes), np.cos(-equinoxes), np.zeros_like(equinoxes)
    to_true = np.stack([
        np.stack([cosine, sine, nought], -1),
        np.stack([-sine, cosine, nought], -1),
        np.stack([nought, nought, nought + 1.0], -1),
    ], -2)
    return np.swapaxes(erfa.pnm80(tt1, tt2), -1, -2) @ to_true


def expected(frame, epoch, rows):
    """Positions and velocities of a table that begins at a UTC stamp, in the frame of a file."""
    if frame in POSITION:
        return rows[:, POSITION[frame]], rows[:, VELOCITY[frame]]
    matrices = teme_to_eme2000(epoch, rows[:, 0])
    if frame == "GCRF":
        bias, _, _ = erfa.bp00(2451545.0, 0.0)
        matrices = bias.T @ matrices
    elif frame != "EME2000":
        raise ValueError(f"no truth in frame {frame}")
    turn = lambda vectors: np.einsum("kij,kj->ki", matrices, vectors)
    return turn(rows[:, POSITION["TEME"]]), turn(rows[:, VELOCITY["TEME"]])


def worst(differences):
    return float(np.max(np.linalg.norm(differences, axis=1)))


def check_files(directory, manifest, report):
    listed = {entry["path"]: entry["sha256"] for entry in manifest["files"]}
    here = {path.relative_to(directory).as_posix() for path in directory.rglob("*") if path.is_file()}
    report.same("files beside the manifest", sorted(here - {"manifest.json", "provenance.json"}) == sorted(listed), True)
    wrong = [
        path for path, digest in listed.items()
        if hashlib.sha256((directory / path).read_bytes()).hexdigest() != digest
    ]
    report.same("files whose SHA-256 differs", wrong, [])


def check_tle(directory, entry, manifest, report):
    lines = (directory / entry["path"]).read_text(encoding="ascii").splitlines()
    sets = [lines[at:at + 3] for at in range(0, len(lines), 3)]
    report.same(f"{entry['path']}: sets", len(sets), entry["objects"])
    sums = sum(int(line[68]) != compute_checksum(line) for _, *two in sets for line in two)
    report.same(f"{entry['path']}: wrong checksums", sums, 0)
    satellites = {name: Satrec.twoline2rv(first, second) for name, first, second in sets}
    numbers = {satellite.satnum for satellite in satellites.values()}
    designators = {satellite.intldesg for satellite in satellites.values()}
    report.same(f"{entry['path']}: catalogue numbers", len(numbers), entry["objects"])
    report.same(f"{entry['path']}: designators", len(designators), entry["objects"])
    _, truth = states(directory / "tle-states.csv")
    report.same(f"{entry['path']}: names", sorted(satellites) == sorted(truth), True)
    epoch = utc(manifest["epoch"])
    day, fraction = erfa.dtf2d("UTC", epoch.year, epoch.month, epoch.day, epoch.hour, epoch.minute,
                               epoch.second + epoch.microsecond * 1e-6)
    late, apart = 0.0, 0.0
    for name, satellite in satellites.items():
        offset = (satellite.jdsatepoch - day) + (satellite.jdsatepochF - fraction)
        late = max(late, abs(offset) * 86400.0)
        minutes = truth[name][:, 0] / 60.0 - offset * 1440.0
        errors, positions = [], []
        for minute in minutes:
            error, position, _ = satellite.sgp4_tsince(minute)
            errors.append(error)
            positions.append(position)
        if any(errors):
            report.same(f"{name}: SGP4", SGP4_ERRORS[max(errors)], None)
        apart = max(apart, worst(np.array(positions) - truth[name][:, POSITION["TEME"]]))
    report.number(f"{entry['path']}: epoch", late, TLE_EPOCH_S, "s")
    report.number(f"{entry['path']}: python-sgp4 against ours", apart, SGP4_KM, "km")


def check_oem(directory, entries, manifest, report):
    stamps, truth = states(directory / "states.csv")
    epoch = manifest["epoch"]
    names, ids = set(), set()
    position_km, velocity_km_s, count, times = 0.0, 0.0, 0, 0
    for entry in entries:
        segments = list(OrbitEphemerisMessage.open(str(directory / entry["path"])))
        report.failed += len(segments) != 1
        metadata = segments[0].metadata
        name, frame = metadata["OBJECT_NAME"], metadata["REF_FRAME"]
        names.add(name)
        ids.add(metadata["OBJECT_ID"])
        report.failed += frame != entry["frame"] or metadata["TIME_SYSTEM"] != "UTC"
        read = list(segments[0].states)
        count += len(read)
        position, velocity = expected(frame, epoch, truth[name])
        # Both sides keep microseconds.
        late_s = [
            abs((utc(state.epoch.isot) - utc(stamp)).total_seconds())
            for state, stamp in zip(read, stamps[name], strict=True)
        ]
        times += sum(late > 1.5e-6 for late in late_s)
        found = np.array([state.position for state in read])
        position_km = max(position_km, worst(found - position))
        found = np.array([state.velocity for state in read])
        velocity_km_s = max(velocity_km_s, worst(found - velocity))
    report.same("OEM: objects", sorted(names) == sorted(truth), True)
    report.same("OEM: identifiers", len(ids), len(entries))
    report.same("OEM: states", count, len(entries) * manifest["samples"])
    report.same("OEM: wrong times", times, 0)
    report.number("OEM: position against the table", position_km, OEM_KM, "km")
    report.number("OEM: velocity against the table", velocity_km_s, OEM_KM_S, "km/s")


def skyfield_apart(satellites, epoch, truth):
    """Largest distance in TEME between Skyfield's states and a table, km."""
    scale = load.timescale(builtin=True)
    apart = 0.0
    for name, satellite in satellites.items():
        seconds = epoch.second + epoch.microsecond * 1e-6 + truth[name][:, 0]
        times = scale.utc(epoch.year, epoch.month, epoch.day, epoch.hour, epoch.minute, seconds)
        positions = satellite.at(times).frame_xyz(TEME).km.T
        apart = max(apart, worst(positions - truth[name][:, POSITION["TEME"]]))
    return apart


def check_tle_by_skyfield(directory, entry, manifest, report):
    _, truth = states(directory / "tle-states.csv")
    found = {satellite.name: satellite for satellite in load.tle_file(str(directory / entry["path"]))}
    report.same(f"{entry['path']}: names by Skyfield", sorted(found) == sorted(truth), True)
    apart = skyfield_apart(found, utc(manifest["epoch"]), truth)
    report.number(f"{entry['path']}: Skyfield against ours", apart, SKYFIELD_KM, "km")


def check_omm(directory, entry, tle, manifest, report):
    """The unrounded elements, against the states of the rounded: as far as rounding explains."""
    path = directory / entry["path"]
    with open(path, newline="") as file:
        if path.suffix == ".json":
            records = json.load(file)
        else:
            records = list({".xml": sgp4_omm.parse_xml, ".csv": sgp4_omm.parse_csv}[path.suffix](file))
    report.same(f"{entry['path']}: messages", len(records), entry["objects"])
    scale = load.timescale(builtin=True)
    found = {record["OBJECT_NAME"]: EarthSatellite.from_omm(scale, record) for record in records}
    _, truth = states(directory / "tle-states.csv")
    report.same(f"{entry['path']}: names", sorted(found) == sorted(truth), True)
    apart = skyfield_apart(found, utc(manifest["epoch"]), truth)
    # The manifest looks at the rounding about once an hour; a metre for what it misses.
    rounding = 1.2 * tle["loss"]["quantisation_max_km"] + 1e-3
    report.number(f"{entry['path']}: Skyfield against the rounded sets", apart, rounding, "km")


def check_sp3(directory, entries, manifest, report):
    _, truth = states(directory / "states.csv")
    names = iter(truth)
    position_km, velocity_km_s, count, late = 0.0, 0.0, 0, 0.0
    # GPS time has been 18 s ahead of UTC since 2017.
    start = np.datetime64(utc(manifest["epoch"]).replace(tzinfo=None), "us") + np.timedelta64(18, "s")
    for entry in entries:
        read = georinex.load(directory / entry["path"])
        seconds = (read.time.values.astype("datetime64[us]") - start) / np.timedelta64(1, "s")
        for sv in read.sv.values:
            rows = truth[next(names)]
            late = max(late, float(np.max(np.abs(seconds - rows[:, 0]))))
            one = read.sel(sv=sv)
            position_km = max(position_km, worst(one.position.values - rows[:, POSITION["ITRF"]]))
            velocity = one.velocity.values * 1e-4  # from dm/s
            velocity_km_s = max(velocity_km_s, worst(velocity - rows[:, VELOCITY["ITRF"]]))
            count += 1
    report.same("SP3: satellites", count, len(truth))
    # georinex keeps microseconds.
    report.number("SP3: epochs by georinex", late, 1.5e-6, "s")
    report.number("SP3: position against the table", position_km, SP3_KM, "km")
    report.number("SP3: velocity against the table", velocity_km_s, SP3_KM_S, "km/s")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", type=Path, help="directory of an export, with states.csv and tle-states.csv")
    directory = parser.parse_args().directory
    manifest = json.loads((directory / "manifest.json").read_text())
    report = Report()
    check_files(directory, manifest, report)
    of = lambda product: [entry for entry in manifest["files"] if entry["format"] == product]
    checked = 0
    for entry in of("tle"):
        check_tle(directory, entry, manifest, report)
        check_tle_by_skyfield(directory, entry, manifest, report)
        checked += 1
    for entry in of("omm"):
        if of("tle") and not entry["path"].endswith(".omm"):
            check_omm(directory, entry, of("tle")[0], manifest, report)
            checked += 1
    if of("sp3"):
        check_sp3(directory, of("sp3"), manifest, report)
        checked += 1
    if of("oem") and of("oem")[0]["path"].endswith(".oem"):
        check_oem(directory, of("oem"), manifest, report)
        checked += 1
    report.same("nothing to check", checked == 0, False)
    return 1 if report.failed else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Exception as error:  # a reader that refuses a file is a failed check
        print(f"FAIL {type(error).__name__}: {error}")
        sys.exit(1)
