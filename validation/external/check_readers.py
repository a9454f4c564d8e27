#!/usr/bin/env python3
"""Reads constellations with readers that this project did not write, and prints how far its own are from them.

    python -m venv venv && venv/bin/pip install -r requirements.txt
    cargo build --profile test --bin navwalker --example print_states
    venv/bin/python check_readers.py target/debug/examples/print_states target/debug/navwalker

The files come from reader_cases.py, and from the gallery for the project's own tables and OPM. Almanacs, STK ephemerides,
OMM in KVN and OPM are read by Orekit; SP3 by georinex and Orekit; OEM by the oem package and Orekit; element sets by
python-sgp4; CZML by czml3 and SciPy. States are compared in the frame of the file, at its samples and between them. Prints
a row for every file and reader; the exit status is 1 if a tolerance is exceeded, or a reader refuses a file.
"""

import argparse
import csv
import io
import json
import subprocess
import sys
import tempfile
from datetime import datetime
from pathlib import Path

import georinex
import numpy as np
from astropy.time import Time, TimeDelta
from czml3 import Packet
from oem import OrbitEphemerisMessage
from scipy.interpolate import BarycentricInterpolator
from sgp4 import omm as sgp4_omm
from sgp4.api import Satrec, jday

import reader_cases
from check_by_orekit import MU_M3_S2, Report, builder, vectors, without_data
from check_exports import teme_to_eme2000
from check_scenarios import interpolate

import jpype
from java.io import File, FileInputStream
from java.util import EnumMap
from org.orekit.data import DataSource
from org.orekit.files.sp3 import SP3Parser
from org.orekit.files.stk import STKEphemerisFile, STKEphemerisFileParser
from org.orekit.frames import FramesFactory
from org.orekit.gnss import SEMParser, YUMAParser
from org.orekit.propagation.analytical.tle import TLEPropagator
from org.orekit.time import AbsoluteDate, DateComponents, GNSSDate, TimeScalesFactory

GALLERY = Path(__file__).resolve().parent.parent / "exports"

# A centimetre: nine decimals of a kilometre and a rotation there and back, or polynomials through the same nodes.
KM = 1e-5
# At the samples nothing but those digits and rotations is left.
SAMPLE_KM = 1e-8
# Six decimals of a kilometre, and the sum of the weights of eleven nodes between the samples.
SP3_KM = 1e-8
# Velocities in twelve decimals, SP3 in six of a decimetre a second; of a polynomial, the derivative.
KM_S = 1e-8
# Two programs of the same theory; python-sgp4 keeps the time in two doubles of days.
SGP4_KM = 1e-6
# The epoch of a TLE from Orekit is in doubles of seconds; it has sidereal time and WGS-72 of its own.
OREKIT_SGP4_KM = 1e-5
# Equations of IS-GPS-200 in two programs, from the digits of one file.
ALMANAC_KM = 1e-6
# Closed forms in two programs, from the digits of one file.
J2_KM = 1e-6

# Degrees are printed as they are read, and a mean of four numbers is rounded twice.
POINT_DEG = 1e-12
MEAN = 1e-12


class Ours:
    """States of our reader, {name: {second: state}}, and the program itself."""

    def __init__(self, print_states, navwalker):
        self.print_states, self.navwalker = print_states, navwalker

    def states(self, path, frame, span_s, step_s, start=reader_cases.START, as_gnss=False):
        arguments = ["--gnss"] * as_gnss + [str(path), f"{start.isoformat()}Z", str(span_s), str(step_s), frame]
        done = subprocess.run([self.print_states, *arguments], capture_output=True, text=True, check=False)
        if done.returncode:
            raise RuntimeError(f"{path.name}: {done.stderr.strip()}")
        found = {}
        for row in csv.reader(list(io.StringIO(done.stdout))[1:]):
            numbers = np.array([float(value) for value in row[1:]])
            found.setdefault(row[0], {})[numbers[0]] = numbers[1:]
        return found


class Comparison:
    """Two sets of states {name: {second: state or position}} with the same satellites and instants."""

    def __init__(self, report, reader):
        self.report, self.reader = report, reader

    def hold(self, what, ours, theirs, km, km_s=None):
        self.report.same(self.reader, f"{what}: satellites", sorted(ours), sorted(theirs))
        position, velocity, instants = 0.0, 0.0, 0
        for name in ours.keys() & theirs.keys():
            mine, other = ours[name], theirs[name]
            if mine.keys() != other.keys():
                apart = sorted(float(t) for t in mine.keys() ^ other.keys())
                self.report.same(self.reader, f"{what}: {name} has a state for one reader only at", apart[:3], [])
            for t in mine.keys() & other.keys():
                position = max(position, float(np.linalg.norm(mine[t][:3] - other[t][:3])))
                instants += 1
                if km_s is not None:
                    velocity = max(velocity, float(np.linalg.norm(mine[t][3:] - other[t][3:])))
        self.report.same(self.reader, f"{what}: no instant in common", instants == 0, False)
        self.report.number(self.reader, f"{what}: position", position, km, "km")
        if km_s is not None:
            self.report.number(self.reader, f"{what}: velocity", velocity, km_s, "km/s")


def source(path):
    return DataSource(File(str(path)))


def date(t, start=reader_cases.START):
    return AbsoluteDate(start.isoformat(), TimeScalesFactory.getUTC()).shiftedBy(float(t))


def along(segments, seconds, start=reader_cases.START):
    """States by Orekit's interpolation; where segments meet, of the earlier."""
    found = {}
    for segment in segments:
        propagator = segment.getPropagator()
        for t in seconds:
            at = date(t, start)
            inside = at.durationFrom(segment.getStart()) >= -1e-6 and segment.getStop().durationFrom(at) >= -1e-6
            if inside and t not in found:
                found[t] = vectors([propagator.getPVCoordinates(at, segment.getFrame())])[0:2]
                found[t] = np.concatenate([part[0] for part in found[t]])
    return found


def only(states, step_s):
    """The states at the multiples of a step."""
    return {name: {t: state for t, state in one.items() if t % step_s == 0} for name, one in states.items()}


def check_almanacs(folder, ours, report):
    GNSSDate.setRolloverReference(DateComponents(2025, 6, 1))
    for name, parser in [("gps.alm", YUMAParser("")), ("gps.al3", SEMParser(""))]:
        parser.loadData(FileInputStream(str(folder / name)), name)
        theirs = {}
        for almanac in parser.getAlmanacs():
            if almanac.getHealth() == 0:
                propagator = almanac.getPropagator()
                of = lambda t: np.concatenate([part[0] for part in vectors([propagator.propagateInEcef(date(t))])])
                theirs[f"PRN-{int(almanac.getPRN()):02}"] = {float(t): of(t) for t in range(0, 86401, 1800)}
        form = "SEM" if name.endswith("al3") else "YUMA"
        for use, as_gnss in [("constellation", False), ("GNSS", True)]:
            mine = ours.states(folder / name, "ITRF", 86401, 1800, as_gnss=as_gnss)
            Comparison(report, "Orekit").hold(f"{form} almanac as {use}, over a day", mine, theirs, ALMANAC_KM, KM_S)


def check_oem(folder, ours, report):
    frames = {"useable": "EME2000", "lagrange": "GCRF", "tai": "EME2000", "teme": "TEME", "fixed": "ITRF"}
    for path in sorted([*folder.glob("*.oem"), *folder.glob("*.xml")]):
        if path.stem not in frames:
            continue
        form = f"OEM {path.name}"
        mine = ours.states(path, frames[path.stem], 7201, 60)
        message = builder().buildOemParser().parseMessage(source(path))
        theirs = {"SAT A": along(message.getSegments(), sorted(mine["SAT A"]))}
        # Orekit interpolates positions and velocities whatever the method is: by Hermite of the same degree or above.
        if path.stem == "lagrange":
            Comparison(report, "Orekit").hold(f"{form}, samples", only(mine, 180), only(theirs, 180), SAMPLE_KM, KM_S)
        else:
            Comparison(report, "Orekit").hold(f"{form}, samples and between", mine, theirs, KM)
        Comparison(report, "oem").hold(f"{form}, samples and between", mine, {"SAT A": by_oem(path, sorted(mine["SAT A"]))}, KM)


def by_oem(path, seconds):
    """The method and degree of each segment by the oem package, within the useable span."""
    found = {}
    for segment in OrbitEphemerisMessage.open(str(path)):
        metadata = segment.metadata
        scale = metadata["TIME_SYSTEM"].lower()
        first, last = (
            Time(metadata[f"USEABLE_{end}_TIME"] if f"USEABLE_{end}_TIME" in metadata else metadata[f"{end}_TIME"], scale=scale)
            for end in ("START", "STOP")
        )
        start = Time(reader_cases.START, scale="utc")
        for t in seconds:
            at = start + TimeDelta(t, format="sec")
            if t not in found and (at - first).sec >= -1e-6 and (last - at).sec >= -1e-6:
                found[t] = np.array(segment(at).position)
    return found


def check_stk(folder, ours, report):
    systems = EnumMap(STKEphemerisFile.STKCoordinateSystem)
    for system in STKEphemerisFile.STKCoordinateSystem.values():
        # States are compared as they are read; the name of the frame is compared as well.
        systems.put(system, FramesFactory.getGCRF())
    frames = {"TEMEOfDate": "TEME", "J2000": "EME2000", "ICRF": "GCRF", "Fixed": "ITRF"}
    for path in sorted(folder.glob("*.e")):
        parser = STKEphemerisFileParser(path.stem, MU_M3_S2, TimeScalesFactory.getUTC(), systems)
        segments = parser.parse(source(path)).getSatellites().get(path.stem).getSegments()
        mine = ours.states(path, frames[path.stem], 7201, 60)
        theirs = {path.stem: along(segments, sorted(mine[path.stem]))}
        Comparison(report, "Orekit").hold(f"STK {path.stem}, samples and between", mine, theirs, KM, KM_S)


def sp3_samples(path):
    """Samples by georinex: {id: {second of UTC from the start of the file: state}}, without those of zeros."""
    read, found = georinex.load(path), {}
    seconds = (read.time.values - read.time.values[0]) / np.timedelta64(1, "s")
    for sv in read.sv.values:
        one = read.sel(sv=sv)
        position = one.position.values
        velocity = one.velocity.values * 1e-4 if "velocity" in one else np.full_like(position, np.nan)
        rows = np.concatenate([position, velocity], 1)
        found[str(sv)] = {t: row for t, row in zip(seconds, rows) if np.linalg.norm(row[:3]) > 0}
    return found


def between(samples, seconds, step_s):
    """Polynomials through eleven positions by SciPy, of the runs without a gap."""
    times = np.array(sorted(samples))
    found = {}
    for run in np.split(times, np.flatnonzero(np.diff(times) > 1.5 * step_s) + 1):
        inside = [t for t in seconds if run[0] <= t <= run[-1]]
        for t in inside if len(run) >= 11 else run:
            first = int(np.clip(np.searchsorted(run, t, side="right") - 6, 0, max(0, len(run) - 11)))
            nodes = run[first:first + 11]
            found[t] = BarycentricInterpolator(nodes - t, [samples[node][:3] for node in nodes])(0.0)
    return found


def check_sp3(folder, ours, report):
    stand_in = jpype.JProxy("java.util.function.Function", dict={"apply": lambda name: FramesFactory.getGCRF()})
    for path in sorted(folder.glob("*.sp3")):
        start = reader_cases.sp3_start(path)
        form = f"SP3 {path.name}"
        step_s, span_s = (60, 7201) if path.stem == "low" else (900, 35101)
        mine = ours.states(path, "ITRF", span_s, step_s / 3, start)
        samples = sp3_samples(path)
        has_velocity = not any(np.isnan(row[3:]).any() for one in samples.values() for row in one.values())
        km_s = KM_S if has_velocity else None
        Comparison(report, "georinex").hold(f"{form}, samples", only(mine, step_s), samples, SP3_KM, km_s)
        gnss = ours.states(path, "ITRF", span_s, step_s, start, as_gnss=True)
        Comparison(report, "georinex").hold(f"{form} as GNSS, samples", gnss, samples, SP3_KM, km_s)
        seconds = np.arange(0, span_s, step_s / 3)
        theirs = {name: between(one, seconds, step_s) for name, one in samples.items()}
        Comparison(report, "SciPy").hold(f"{form}, samples and between", mine, theirs, KM)
        file = SP3Parser(MU_M3_S2, 11, stand_in).parse(source(path))
        theirs = {}
        for name in (str(key) for key in file.getSatellites().keySet()):
            coordinates = [one for part in file.getEphemeris(name).getSegments() for one in part.getCoordinates()]
            rows = np.concatenate(vectors(coordinates), 1)
            theirs[name] = {round(one.getDate().durationFrom(date(0, start)), 6): row for one, row in zip(coordinates, rows)}
        Comparison(report, "Orekit").hold(f"{form}, samples", only(mine, step_s), theirs, SP3_KM, km_s)


def check_czml(folder, ours, report):
    path = folder / "scene.czml"
    packets = json.loads(path.read_text())
    for packet in packets:
        # czml3 has no samples with instants of their own, which CZML has.
        if "epoch" in packet.get("position", {"epoch": None}):
            Packet.model_validate(packet)
    for frame, keyword in [("INERTIAL", "GCRF"), ("FIXED", "ITRF")]:
        mine, theirs = ours.states(path, keyword, 7201, 60), {}
        wanted = [one for one in packets[1:] if one["position"]["referenceFrame"] == frame]
        for packet in wanted:
            position = packet["position"]
            zero = datetime.fromisoformat(position.get("epoch", "2025-06-01T00:00:00Z")).replace(tzinfo=None)
            if "epoch" in position:
                zero -= datetime.fromisoformat(position["epoch"]).utcoffset()
            table = np.array(position["cartesian"], object).reshape(-1, 4)
            times = [
                (datetime.fromisoformat(at[:-1]) - reader_cases.START).total_seconds() if isinstance(at, str)
                else at + (zero - reader_cases.START).total_seconds() for at in table[:, 0]
            ]
            track = (None, np.array(times), table[:, 1:].astype(float) / 1e3, position["interpolationDegree"])
            theirs[packet["id"]] = {t: interpolate(track, t) for t in np.arange(0.0, 7201.0, 60.0)}
        mine = {name: one for name, one in mine.items() if name in theirs}
        Comparison(report, "czml3, SciPy").hold(f"CZML {frame}, samples and between", mine, theirs, KM)


def by_sgp4(satellites):
    """{name: states in TEME every ten minutes of a day}."""
    found = {}
    for name, satellite in satellites.items():
        day, fraction = jday(*reader_cases.START.timetuple()[:6])
        found[name] = {}
        for t in range(0, 86401, 600):
            error, position, velocity = satellite.sgp4(day, fraction + t / 86400)
            assert error == 0, (name, error)
            found[name][float(t)] = np.array([*position, *velocity])
    return found


def check_sets(folder, ours, report):
    lines = (folder / "sets.tle").read_text().splitlines()
    firsts = [at for at, line in enumerate(lines) if line.startswith("1 ")]
    satellites = {}
    for at in firsts:
        satellite = Satrec.twoline2rv(lines[at], lines[at + 1])
        named = at > 0 and not lines[at - 1].startswith("2 ")
        satellites[lines[at - 1] if named else str(satellite.satnum)] = satellite
    held = Comparison(report, "python-sgp4")
    held.hold("TLE with and without names, Alpha-5", ours.states(folder / "sets.tle", "TEME", 86401, 600), by_sgp4(satellites), SGP4_KM, KM_S)
    for suffix in ("json", "csv", "xml"):
        path = folder / f"sets.{suffix}"
        with open(path, newline="") as file:
            records = json.load(file) if suffix == "json" else list({"xml": sgp4_omm.parse_xml, "csv": sgp4_omm.parse_csv}[suffix](file))
        satellites = {}
        for record in records:
            satellites[record["OBJECT_NAME"]] = satellite = Satrec()
            sgp4_omm.initialize(satellite, {key: str(value) for key, value in record.items()})
        held.hold(f"OMM in {suffix.upper()}", ours.states(path, "TEME", 86401, 600), by_sgp4(satellites), SGP4_KM, KM_S)
    for path in sorted(folder.glob("*.omm")):
        message = builder().buildOmmParser().parseMessage(source(path))
        propagator = TLEPropagator.selectExtrapolator(message.generateTLE())
        rows = np.concatenate(vectors([propagator.getPVCoordinates(date(t)) for t in range(0, 86401, 600)]), 1)
        theirs = {str(message.getMetadata().getObjectName()): dict(zip(np.arange(0.0, 86401, 600), rows))}
        Comparison(report, "Orekit").hold(f"OMM in KVN, {path.name}", ours.states(path, "TEME", 86401, 600), theirs, OREKIT_SGP4_KM)


def secular_j2(elements, t):
    """TEME position of mean elements in km and degrees by the closed forms M-6 to M-8."""
    a, e = elements[:2]
    i, node, perigee, anomaly = np.radians(elements[2:])
    n = np.sqrt(MU_M3_S2 / 1e9 / a**3)
    g = 1.5 * 1.08262668e-3 * (6378.137 / (a * (1 - e * e))) ** 2 * n
    node, perigee = node - g * np.cos(i) * t, perigee + g * (2 - 2.5 * np.sin(i) ** 2) * t
    anomaly = anomaly + (n + g * np.sqrt(1 - e * e) * (1 - 1.5 * np.sin(i) ** 2)) * t
    return reader_cases.Ellipse(a, e, *np.degrees([i, node, perigee, anomaly])).state(0.0)[0]


def check_opm(folder, ours, report):
    """Ours, with the time in TAI; the state of the message at its epoch, and the mean elements over a day."""
    text = (GALLERY / "opm/opm/NW-P02-S01.opm").read_text()
    text = text.replace("TIME_SYSTEM = UTC", "TIME_SYSTEM = TAI").replace("EPOCH = 2025-01-01T00:00:00.000", "EPOCH = 2025-01-01T00:00:37.000")
    for name, written in [("tai.opm", text), ("tai-opm.xml", reader_cases.opm_xml(text))]:
        path = folder / name
        path.write_text(written)
        check_one_opm(path, ours, report)


def check_one_opm(path, ours, report):
    form = "OPM in XML" if path.suffix == ".xml" else "OPM"
    start = datetime(2025, 1, 1)
    data = builder().buildOpmParser().parseMessage(source(path)).getData()
    state = data.getStateVectorBlock().toTimeStampedPVCoordinates()
    late = state.getDate().durationFrom(date(0, start))
    state = np.concatenate([part[0] for part in vectors([state])])
    mine = ours.states(path, "EME2000", 1, 60, start)
    Comparison(report, "Orekit").hold(f"{form}, state at the epoch", mine, {"NW-P02-S01": {late: state}}, SAMPLE_KM, KM_S)
    mean = dict(data.getUserDefinedBlock().getParameters())
    keys = ["SEMI_MAJOR_AXIS_KM", "ECCENTRICITY", "INCLINATION_DEG", "RA_OF_ASC_NODE_DEG", "ARG_OF_PERICENTER_DEG", "MEAN_ANOMALY_DEG"]
    elements = [float(str(mean[f"MEAN_{key}"])) for key in keys]
    theirs = {"NW-P02-S01": {float(t): secular_j2(elements, t - late) for t in range(0, 86401, 600)}}
    Comparison(report, "Orekit, closed form").hold(f"{form}, mean elements over a day", ours.states(path, "TEME", 86401, 600, start), theirs, J2_KM)


def check_tables(folder, ours, report):
    start = datetime(2025, 1, 1)
    with open(GALLERY / "csv/elements.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    keys = ["semi_major_axis_km", "eccentricity", "inclination_deg", "raan_deg", "arg_perigee_deg", "mean_anomaly_deg"]
    theirs = {row["object"]: {float(t): secular_j2([float(row[key]) for key in keys], t) for t in range(0, 86401, 600)} for row in rows}
    mine = ours.states(GALLERY / "csv/elements.csv", "TEME", 86401, 600, start)
    Comparison(report, "closed form").hold("elements.csv over a day", mine, theirs, J2_KM)
    with open(GALLERY / "csv/states.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    for axes, other in [("teme", "itrf"), ("itrf", "teme")]:
        kept = [column for column in rows[0] if not column.startswith(other)]
        path = folder / f"states-{axes}.csv"
        with open(path, "w", newline="") as file:
            table = csv.DictWriter(file, kept, extrasaction="ignore")
            table.writeheader()
            table.writerows(rows)
        theirs = {}
        for row in rows:
            state = np.array([float(row[f"{axes}_{axis}"]) for axis in ("x_km", "y_km", "z_km", "vx_km_s", "vy_km_s", "vz_km_s")])
            theirs.setdefault(row["object"], {})[float(row["elapsed_s"])] = state
        step_s, last_s = rows[1]["elapsed_s"], max(theirs[rows[0]["object"]])
        mine = ours.states(path, axes.upper(), last_s + 1, step_s, start)
        Comparison(report, "csv").hold(f"states in {axes.upper()}, samples", mine, theirs, SAMPLE_KM, KM_S)


def check_points(folder, ours, report):
    """Ground points, by the table of metrics by point; their weights, by the mean over them."""
    arguments = ["evaluate", "--design", "delta:55:24/6/1@925", "--set", f"region.points={folder}/points.csv", "--set", "time.duration-h=6"]
    arguments += ["--set", "time.step-s=600", "--format", "json", "--quiet", "--series", str(folder / "series")]
    done = subprocess.run([ours.navwalker, *arguments], capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr.strip())
    with open(folder / "points.csv", newline="") as file:
        theirs = {row["name"]: row for row in csv.DictReader(file)}
    with open(folder / "series/points.csv", newline="") as file:
        mine = {row["name"]: row for row in csv.DictReader(file)}
    report.same("csv", "points: names", sorted(mine), sorted(theirs))
    places = ["latitude_deg", "longitude_deg"]
    apart = max(abs(float(mine[name][key]) - float(theirs[name][key])) for name in mine.keys() & theirs.keys() for key in places)
    report.number("csv", "points: latitude and longitude", apart, POINT_DEG, "deg")
    weights = [float(theirs[name]["weight"]) for name in mine]
    mean = np.average([float(row["mean_visible"]) for row in mine.values()], weights=weights)
    report.number("csv", "points: mean by weight", abs(mean - json.loads(done.stdout)["metrics"]["mean_visible"]), MEAN, "satellites")


def check_rotation(folder, ours, report):
    """What files in EME2000 and GCRF are to a study, in TEME, by ERFA."""
    epoch = f"{reader_cases.START.isoformat()}Z"
    for name, frame in [("useable.oem", "EME2000"), ("J2000.e", "EME2000")]:
        own = ours.states(folder / name, frame, 7201, 180)
        mine, theirs = ours.states(folder / name, "TEME", 7201, 180), {}
        for satellite, one in own.items():
            seconds = np.array(sorted(one))
            turned = np.einsum("kji,kj->ki", teme_to_eme2000(epoch, seconds), np.array([one[t][:3] for t in seconds]))
            theirs[satellite] = dict(zip(seconds, turned))
        Comparison(report, "ERFA").hold(f"{name} in TEME", mine, theirs, KM)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("print_states", help="the example of that name")
    parser.add_argument("navwalker", help="the program")
    given, report = parser.parse_args(), Report()
    ours = Ours(given.print_states, given.navwalker)
    without_data()
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        reader_cases.write_all(folder)
        checks = (check_almanacs, check_oem, check_stk, check_sp3, check_czml, check_sets, check_opm, check_tables, check_points, check_rotation)
        for check in checks:
            try:
                check(folder, ours, report)
            except Exception as error:  # a reader that refuses a file is a failed check
                report.same(check.__name__, f"{type(error).__name__}: {error}".replace("\n", " ")[:300], "refused", "read")
    report.print()
    return 1 if report.failed else 0


if __name__ == "__main__":
    sys.exit(main())
