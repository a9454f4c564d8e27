"""Files of every form that is read, written from closed-form orbits for check_readers.py.

The orbits are ellipses at a constant rate in the frame of the file, an Earth-fixed one turned at the rate of the Earth.
They need not be right: what counts is that the files use what a form allows, so that every reader has something to get wrong.
"""

import json
from datetime import datetime, timedelta

import numpy as np
from sgp4.api import WGS72, Satrec
from sgp4.exporter import export_omm, export_tle

START = datetime(2025, 6, 1)
# TAI and GPS time of the same instant: UTC + 37 s and + 18 s since 2017.
TAI_S, GPS_S = 37, 18
# In GPS time, four hours before the leap second of 2016, when it was UTC + 17 s.
LEAP_GPS, LEAP_GPS_S = datetime(2016, 12, 31, 20), 17
MU_KM3_S2 = 398600.4418
TURN_RAD_S = 7.2921151467e-5


class Ellipse:
    """Elements in km and degrees, and whether states are turned with the Earth."""

    def __init__(self, a, e, i, node, perigee, anomaly, fixed=False):
        self.a, self.e, self.fixed = a, e, fixed
        self.i, self.node, self.perigee, self.anomaly = np.radians([i, node, perigee, anomaly])

    def state(self, t):
        n = np.sqrt(MU_KM3_S2 / self.a**3)
        mean = self.anomaly + n * t
        big_e = mean
        for _ in range(30):
            big_e = mean + self.e * np.sin(big_e)
        root, rate = np.sqrt(1 - self.e**2), n / (1 - self.e * np.cos(big_e))
        flat = self.a * np.array([np.cos(big_e) - self.e, root * np.sin(big_e), 0])
        speed = self.a * rate * np.array([-np.sin(big_e), root * np.cos(big_e), 0])
        turn = spin(self.node - TURN_RAD_S * t * self.fixed) @ tilt(self.i) @ spin(self.perigee)
        position, velocity = turn @ flat, turn @ speed
        if self.fixed:
            velocity = velocity - np.cross([0, 0, TURN_RAD_S], position)
        return position, velocity


def spin(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def tilt(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])


LOW = Ellipse(7303.137, 0.004, 55, 40, 30, 10)
BURNT = Ellipse(7403.137, 0.009, 56, 41, 35, 20)
LOW_FIXED = Ellipse(7303.137, 0.002, 86.4, 120, 80, 200, fixed=True)


def stamp(t, shift_s=0.0):
    return (START + timedelta(seconds=float(t + shift_s))).isoformat(timespec="milliseconds")


def numbers(state, digits=9):
    return " ".join(f"{value:.{digits}f}" for value in np.concatenate(state))


def oem_segment(orbit, times, frame, system, interpolation, useable=None):
    """Metadata and lines of a segment; `useable` are seconds."""
    shift = TAI_S if system == "TAI" else 0
    metadata = {
        "OBJECT_NAME": "SAT A", "OBJECT_ID": "2025-900A", "CENTER_NAME": "EARTH", "REF_FRAME": frame, "TIME_SYSTEM": system,
        "START_TIME": stamp(times[0], shift),
    }
    if useable:
        metadata["USEABLE_START_TIME"], metadata["USEABLE_STOP_TIME"] = (stamp(t, shift) for t in useable)
    metadata["STOP_TIME"] = stamp(times[-1], shift)
    metadata["INTERPOLATION"], metadata["INTERPOLATION_DEGREE"] = interpolation
    return metadata, [(stamp(t, shift), *np.concatenate(orbit.state(t))) for t in times]


def write_oem(path, segments):
    lines = ["CCSDS_OEM_VERS = 2.0", "CREATION_DATE = 2025-06-01T00:00:00", "ORIGINATOR = CASES"]
    for metadata, rows in segments:
        lines += ["", "META_START", *(f"{key} = {value}" for key, value in metadata.items()), "META_STOP", ""]
        lines += [f"{at} " + " ".join(f"{value:.9f}" for value in row) for at, *row in rows]
    path.write_text("\n".join(lines) + "\n")


def write_oem_xml(path, segments):
    tag = lambda key, value: f"<{key}>{value}</{key}>"
    text = '<?xml version="1.0" encoding="UTF-8"?>\n<oem id="CCSDS_OEM_VERS" version="2.0">\n'
    text += tag("header", tag("CREATION_DATE", "2025-06-01T00:00:00") + tag("ORIGINATOR", "CASES")) + "\n<body>\n"
    for metadata, rows in segments:
        text += "<segment>" + tag("metadata", "".join(tag(*pair) for pair in metadata.items())) + "<data>\n"
        for at, *row in rows:
            fields = zip(["X", "Y", "Z", "X_DOT", "Y_DOT", "Z_DOT"], (f"{value:.9f}" for value in row))
            text += tag("stateVector", tag("EPOCH", at) + "".join(tag(*pair) for pair in fields)) + "\n"
        text += "</data></segment>\n"
    path.write_text(text + "</body>\n</oem>\n")


def write_oems(folder):
    """The manoeuvre at 3600 s lies between two useable spans, and each segment goes on beyond it."""
    before, after = np.arange(0, 5401, 180), np.arange(1800, 7201, 180)
    burn = [
        oem_segment(LOW, before, "EME2000", "UTC", ("HERMITE", 7), (0, 3600)),
        oem_segment(BURNT, after, "EME2000", "UTC", ("HERMITE", 7), (3600, 7200)),
    ]
    write_oem(folder / "useable.oem", burn)
    write_oem_xml(folder / "useable.xml", burn)
    for name, frame, system, interpolation in [
        ("lagrange", "GCRF", "UTC", ("LAGRANGE", 5)), ("tai", "EME2000", "TAI", ("HERMITE", 7)), ("teme", "TEME", "UTC", ("HERMITE", 7)),
    ]:
        times = np.arange(0, 7201, 180)
        parts = [times[times <= 3600], times[times >= 3600]]
        segments = [oem_segment(LOW, part, frame, system, interpolation) for part in parts]
        write_oem(folder / f"{name}.oem", segments)
        write_oem_xml(folder / f"{name}.xml", segments)
    fixed = oem_segment(LOW_FIXED, np.arange(0, 7201, 180), "ITRF2000", "UTC", ("HERMITE", 7))
    write_oem(folder / "fixed.oem", [fixed])


def write_stk(folder):
    """Times from midnight in TEME; from noon of the day before in J2000; two segments in the others."""
    for name, frame, orbit, ahead_s, split in [
        ("TEMEOfDate", "TEMEOfDate", LOW, 0, False), ("J2000", "J2000", LOW, 43200, False),
        ("ICRF", "ICRF", LOW, 0, True), ("Fixed", "Fixed", LOW_FIXED, 43200, True),
    ]:
        first = np.arange(0, 3601, 180)
        rows = [(t, orbit) for t in np.arange(0, 7201, 180)]
        if split:
            other = BURNT if orbit is LOW else Ellipse(7353.137, 0.002, 86.4, 121, 80, 201, fixed=True)
            rows = [(t, orbit) for t in first] + [(t, other) for t in first + 3600]
        epoch = START - timedelta(seconds=ahead_s)
        lines = [
            "stk.v.12.0", "", "BEGIN Ephemeris", "", f"NumberOfEphemerisPoints {len(rows)}",
            f"ScenarioEpoch {epoch:%d %b %Y %H:%M:%S}.000", "InterpolationMethod Hermite", "InterpolationSamplesM1 3",
            "CentralBody Earth", f"CoordinateSystem {frame}",
        ]
        if split:
            ends = [f"{t + ahead_s:.3f}" for t in (0, 3600, 7200)]
            lines += ["BEGIN SegmentBoundaryTimes", *ends, "END SegmentBoundaryTimes"]
        lines += ["EphemerisTimePosVel", ""]
        for t, one in rows:
            state = [1e3 * part for part in one.state(t)]
            lines.append(f"{t + ahead_s:.6f} {numbers(state, 6)}")
        (folder / f"{name}.e").write_text("\n".join([*lines, "", "END Ephemeris"]) + "\n")


def write_sp3(path, version, satellites, step_s, count, velocities, missing=(), first=START):
    """Satellites as {id: orbit} from an instant in GPS time on; `missing` are pairs of id and number of the epoch."""
    week, of_week = divmod((first - datetime(1980, 1, 6)).total_seconds(), 604800)
    mjd = (first - datetime(1858, 11, 17)).days
    letter = "V" if velocities else "P"
    lines = [
        f"#{version}{letter}{first:%Y} {first.month:2} {first.day:2}  0  0  0.00000000 {count:7} ORBIT IGS20 FIT CASE",
        f"## {int(week):4} {of_week:15.8f} {step_s:14.8f} {mjd} 0.0000000000000",
    ]
    ids = list(satellites) + ["  0"] * (85 - len(satellites))
    for row in range(5):
        start = f"+  {len(satellites):3}   " if row == 0 else "+        "
        lines.append(start + "".join(ids[17 * row: 17 * row + 17]))
    lines += ["++       " + "  0" * 17] * 5
    lines += ["%c M  cc GPS ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc", "%c cc cc ccc ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc"]
    lines += ["%f  1.2500000  1.025000000  0.00000000000  0.000000000000000", "%f  0.0000000  0.000000000  0.00000000000  0.000000000000000"]
    lines += ["%i    0    0    0    0      0      0      0      0         0"] * 2 + ["/* MADE FROM CLOSED-FORM ORBITS"] * 4
    for k in range(count):
        at = first + timedelta(seconds=k * step_s)
        lines.append(f"*  {at:%Y} {at.month:2} {at.day:2} {at.hour:2} {at.minute:2} {at.second:11.8f}")
        for name, orbit in satellites.items():
            position, velocity = orbit.state(k * step_s - GPS_S)
            if (name, k) in missing:
                position, velocity = 0 * position, 0 * velocity
            lines.append(f"P{name}" + "".join(f"{value:14.6f}" for value in position) + " 999999.999999")
            if velocities:
                lines.append(f"V{name}" + "".join(f"{1e4 * value:14.6f}" for value in velocity) + " 999999.999999")
    path.write_text("\n".join([*lines, "EOF"]) + "\n")


def write_sp3s(folder):
    medium = lambda a, i, node, anomaly: Ellipse(a, 0.005, i, node, 40, anomaly, fixed=True)
    several = {
        "G01": medium(26560, 55, 10, 20), "G32": medium(26560, 55, 130, 80), "R07": medium(25510, 64.8, 50, 140),
        "E11": medium(29600, 56, 170, 200), "C21": medium(27906, 55, 290, 260), "J02": medium(42164, 41, 230, 320),
    }
    write_sp3(folder / "systems-d.sp3", "d", several, 900, 40, velocities=False)
    write_sp3(folder / "systems-c.sp3", "c", several, 900, 40, velocities=True)
    write_sp3(folder / "gap.sp3", "d", several, 900, 40, velocities=False, missing=[("R07", 20)])
    write_sp3(folder / "leap.sp3", "d", several, 900, 40, velocities=False, first=LEAP_GPS)
    write_sp3(folder / "low.sp3", "d", {"L01": LOW_FIXED, "L99": Ellipse(7000, 0.001, 97, 10, 0, 0, fixed=True)}, 60, 121, velocities=True)


def sp3_start(path):
    """The first instant of a file of the above in UTC."""
    if path.stem == "leap":
        return LEAP_GPS - timedelta(seconds=LEAP_GPS_S)
    return START - timedelta(seconds=GPS_S)


def write_czml(folder):
    """An epoch with an offset from UTC, and samples with their own instants."""
    def packet(name, frame, orbit, times, degree, iso):
        at = lambda t: stamp(t) + "Z" if iso else float(t) - 3600
        values = [value for t in times for value in (at(t), *(1e3 * orbit.state(t)[0]))]
        position = {"referenceFrame": frame, "interpolationAlgorithm": "LAGRANGE", "interpolationDegree": degree, "cartesian": values}
        if not iso:
            position["epoch"] = "2025-06-01T03:00:00+02:00"
        return {"id": name, "position": position}

    document = {"id": "document", "name": "cases", "version": "1.0"}
    times = np.arange(0, 7201, 180)
    packets = [
        document, packet("inertial", "INERTIAL", LOW, times, 5, iso=False), packet("inertial-iso", "INERTIAL", BURNT, times, 7, iso=True),
        packet("fixed", "FIXED", LOW_FIXED, times, 5, iso=True),
    ]
    (folder / "scene.czml").write_text(json.dumps(packets))


def write_almanacs(folder):
    """One constellation twice. The week is the 2368th, modulo 1024, and PRN 9 is unhealthy."""
    week, toa = 2368 % 1024, 61440
    yuma, sem = "", f"7 CURRENT.ALM\n{week:4} {toa}\n"
    for k, prn in enumerate([1, 2, 5, 9, 14, 23, 32]):
        e, offset, rate = 0.0021 * (k + 1), 0.0024 * (k - 3) / 7, -2.5e-9 - 1e-11 * k
        root, node, perigee, anomaly = 5153.5 + 0.02 * k, (-1 + 0.29 * k), 0.9 - 0.23 * k, -0.8 + 0.21 * k
        health = 63 if prn == 9 else 0
        pi = np.pi
        yuma += f"******** Week {week:4} almanac for PRN-{prn:02} ********\nID:                         {prn:02}\nHealth:                     {health:03}\n"
        yuma += f"Eccentricity:               {e:.10E}\nTime of Applicability(s):  {toa}.0000\nOrbital Inclination(rad):   {(0.3 + offset) * pi:.10f}\n"
        yuma += f"Rate of Right Ascen(r/s):  {rate * pi:.10E}\nSQRT(A)  (m 1/2):           {root:.6f}\nRight Ascen at Week(rad):   {node * pi:.10E}\n"
        yuma += f"Argument of Perigee(rad):   {perigee * pi:.9f}\nMean Anom(rad):             {anomaly * pi:.10E}\nAf0(s):                     0.0E+000\nAf1(s/s):                  0.0E+000\nweek:                        {week}\n\n"
        sem += f"\n{prn}\n{60 + k}\n0\n {e:.14E}  {offset:.14E} {rate:.14E}\n {root:.14E} {node:.14E}  {perigee:.14E}\n {anomaly:.14E}  0.0E+00  0.0E+00\n{health}\n11\n"
    (folder / "gps.alm").write_text(yuma)
    (folder / "gps.al3").write_text(sem)


def element_sets():
    """Satellites of python-sgp4: near and far from the Earth, with drag, and with a number of Alpha-5."""
    sets = []
    for number, a_rev_day, e, i, node, perigee, anomaly, bstar in [
        (25544, 15.49, 0.0006, 51.64, 120, 30, 200, 3.1e-4), (90001, 13.910254, 0.01, 55, 10, 20, 30, 0.0),
        (100001, 14.2, 0.002, 98.6, 300, 100, 250, 9e-5), (339999, 2.00563, 0.01, 55.4, 80, 60, 120, 0.0),
    ]:
        satellite = Satrec()
        days = (START - datetime(1949, 12, 31)).total_seconds() / 86400 - 0.4321
        satellite.sgp4init(WGS72, "i", number, days, bstar, 0.0, 0.0, e, *np.radians([perigee, i, anomaly]), a_rev_day * 2 * np.pi / 1440, np.radians(node))
        satellite.classification, satellite.intldesg, satellite.elnum, satellite.revnum, satellite.ephtype = "U", f"25{len(sets) + 901}A", 999, 1, 0
        sets.append(satellite)
    return sets


def write_sets(folder):
    lines, messages = [], []
    for k, satellite in enumerate(element_sets()):
        # The third has no name, so that it goes by its number.
        lines += ([] if k == 2 else [f"OBJECT {k}"]) + list(export_tle(satellite))
        fields = export_omm(satellite, f"OBJECT {k}")
        messages.append({key: value for key, value in fields.items() if key not in ("CCSDS_OMM_VERS", "COMMENT")})
    (folder / "sets.tle").write_text("\n".join(lines) + "\n")
    (folder / "sets.json").write_text(json.dumps(messages))
    table = [",".join(messages[0]), *(",".join(str(value) for value in one.values()) for one in messages)]
    (folder / "sets.csv").write_text("\n".join(table) + "\n")
    for k, one in enumerate(messages):
        head = {key: one.get(key, value) for key, value in {"CREATION_DATE": "2025-06-01T00:00:00", "ORIGINATOR": "CASES"}.items()}
        rest = {key: value for key, value in one.items() if key not in head}
        kvn = {"CCSDS_OMM_VERS": "2.0", **head, **rest}
        (folder / f"set-{k}.omm").write_text("".join(f"{key} = {value}\n" for key, value in kvn.items()))
    (folder / "sets.xml").write_text(omm_xml(messages))


METADATA = ["OBJECT_NAME", "OBJECT_ID", "CENTER_NAME", "REF_FRAME", "TIME_SYSTEM", "MEAN_ELEMENT_THEORY"]
MEAN = ["EPOCH", "MEAN_MOTION", "ECCENTRICITY", "INCLINATION", "RA_OF_ASC_NODE", "ARG_OF_PERICENTER", "MEAN_ANOMALY"]


def omm_xml(messages):
    tags = lambda one, keys: "".join(f"<{key}>{one[key]}</{key}>" for key in keys)
    text = '<?xml version="1.0" encoding="UTF-8"?>\n<ndm>\n'
    for one in messages:
        rest = [key for key in one if key not in [*METADATA, *MEAN, "CREATION_DATE", "ORIGINATOR"]]
        text += '<omm id="CCSDS_OMM_VERS" version="2.0"><header><CREATION_DATE>2025-06-01T00:00:00</CREATION_DATE><ORIGINATOR>CASES</ORIGINATOR></header>'
        text += f"<body><segment><metadata>{tags(one, METADATA)}</metadata><data><meanElements>{tags(one, MEAN)}</meanElements>"
        text += f"<tleParameters>{tags(one, rest)}</tleParameters></data></segment></body></omm>\n"
    return text + "</ndm>\n"


OPM_SECTIONS = {
    "metadata": ["OBJECT_NAME", "OBJECT_ID", "CENTER_NAME", "REF_FRAME", "TIME_SYSTEM"],
    "stateVector": ["EPOCH", "X", "Y", "Z", "X_DOT", "Y_DOT", "Z_DOT"],
    "keplerianElements": ["SEMI_MAJOR_AXIS", "ECCENTRICITY", "INCLINATION", "RA_OF_ASC_NODE", "ARG_OF_PERICENTER", "TRUE_ANOMALY", "GM"],
}
OPM_UNITS = {"X": "km", "Y_DOT": "km/s", "SEMI_MAJOR_AXIS": "km", "INCLINATION": "deg", "GM": "km**3/s**2"}


def opm_xml(kvn):
    """A message in keyword = value notation as XML, some of its numbers with their units, and with a manoeuvre."""
    pairs = dict(line.split(" = ", 1) for line in kvn.splitlines() if " = " in line)

    def tags(keys):
        units = {key: f' units="{OPM_UNITS[key]}"' if key in OPM_UNITS else "" for key in keys}
        return "".join(f"<{key}{units[key]}>{pairs[key]}</{key}>\n" for key in keys)

    section = {name: f"<{name}>\n<COMMENT>x</COMMENT>{tags(keys)}</{name}>\n" for name, keys in OPM_SECTIONS.items()}
    burn = {"EPOCH_IGNITION": pairs["EPOCH"], "DURATION": "0.0", "DELTA_MASS": "-1.0", "REF_FRAME": "RTN", "DV_1": "0.0", "DV_2": "0.0", "DV_3": "0.0"}
    burn = "".join(f"<MAN_{key}>{value}</MAN_{key}>" for key, value in burn.items())
    prefix = "USER_DEFINED_"
    user = "".join(
        f'<USER_DEFINED parameter="{key[len(prefix):]}">{value}</USER_DEFINED>\n' for key, value in pairs.items() if key.startswith(prefix)
    )
    text = '<?xml version="1.0" encoding="UTF-8"?>\n<opm id="CCSDS_OPM_VERS" version="2.0">\n'
    text += f"<header>{tags(['CREATION_DATE', 'ORIGINATOR'])}</header>\n<body><segment>\n{section['metadata']}<data>\n"
    text += f"{section['stateVector']}{section['keplerianElements']}<spacecraftParameters><MASS>100.0</MASS></spacecraftParameters>\n"
    text += f"<maneuverParameters>{burn}</maneuverParameters>\n<userDefinedParameters>\n{user}</userDefinedParameters>\n"
    return text + "</data>\n</segment></body>\n</opm>\n"


def write_points(folder):
    """Columns in an order of their own, one that has no meaning, a comma in a name, and the antimeridian."""
    rows = ['7,"A, north",-179.5,2,89.5', "7,B,179.25,1,-45.125", "8,C,0,0.5,1e-6", "9,D,12.345678901,0.25,47.5"]
    (folder / "points.csv").write_text("\n".join(["visits,name,longitude_deg,weight,latitude_deg", *rows]) + "\n")


def write_all(folder):
    for write in (write_oems, write_stk, write_sp3s, write_czml, write_almanacs, write_sets, write_points):
        write(folder)
