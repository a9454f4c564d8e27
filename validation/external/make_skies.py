"""Dilutions of precision of planted skies, most of them singular or nearly so, in 60 digits.

    pip install mpmath==1.3.0 && python3 validation/external/make_skies.py

writes `validation/cases/skies.csv`. A sky is given by exact decimals, elevation/azimuth of each
satellite in degrees, `|` between satellites that keep clocks of their own. The whole normal matrix
of position and clocks is made and inverted by mpmath; no formula of the program is used. The
columns of a sky whose matrix is singular, or that has fewer satellites than states, are empty.

Weights are `unit`, or `sine-elevation`: sin² of it. No PDOP is within 5 % of a cap that the test
sets (100, 1e4, 1e6), so that every verdict is certain.
"""

import csv
import random
from pathlib import Path

import mpmath as mp

mp.mp.dps = 60
OUT = Path(__file__).parent.parent / "cases" / "skies.csv"
CAPS = [100, 10**4, 10**6]
draw = random.Random(20250101)


def decimal(x, digits=4):
    return format(x, f".{digits}f").rstrip("0").rstrip(".")


def anywhere():
    return [decimal(draw.uniform(5, 88)), decimal(draw.uniform(0, 360))]


def nudge(satellite, least, most):
    """The satellite moved by 10^-most to 10^-least degrees."""
    by = mp.mpf(draw.uniform(0.3, 1)) * mp.mpf(10) ** -draw.uniform(least, most)
    sign = draw.choice([-1, 1])
    return [mp.nstr(mp.mpf(angle) + sign * by, 18, min_fixed=-mp.inf, max_fixed=mp.inf)
            for angle in satellite]


def open_sky():
    return [[anywhere() for _ in range(draw.randint(4, 10))]
            for _ in range(draw.randint(1, 3))]


def few_directions():
    """Satellites in two or three directions: their differences span a line or a plane."""
    places = [anywhere() for _ in range(draw.randint(2, 3))]
    group = [draw.choice(places) for _ in range(draw.randint(4, 9))]
    if len(places) == 2 and draw.random() < 0.4:
        # Two such systems determine two components together.
        others = [anywhere() for _ in range(2)]
        return [group, [draw.choice(others) for _ in range(draw.randint(4, 6))]]
    return [group]


def cone():
    """Each system at one elevation: nothing determines the height."""
    def ring():
        elevation = decimal(draw.uniform(5, 80))
        return [[elevation, anywhere()[1]] for _ in range(draw.randint(5, 9))]
    return [ring() for _ in range(draw.randint(1, 2))]


def near_cone():
    """A cone with elevations that differ by 1e-10 to 10 degrees."""
    size = draw.uniform(-10, 1)
    groups = cone()
    for group in groups:
        for satellite in group:
            by = mp.mpf(draw.uniform(-1, 1)) * mp.mpf(10) ** size
            satellite[0] = mp.nstr(mp.mpf(satellite[0]) + by, 17)
    return groups


def docked():
    """Three directions, and the others next to one of them."""
    places = [anywhere() for _ in range(3)]
    return [places + [nudge(draw.choice(places), -1, 10) for _ in range(draw.randint(1, 4))]]


def lone():
    """Satellites that have a clock to themselves determine nothing else."""
    groups = draw.choice([open_sky, near_cone, docked, cone])()
    return groups + [[anywhere()] for _ in range(draw.randint(1, 3))]


def tilted_cone():
    """On a cone about a tilted axis, but for the decimals of the angles."""
    digits = draw.randint(1, 13)
    tilt, opening = mp.mpf(draw.uniform(0, 40)), mp.mpf(draw.uniform(15, 45))
    tilt, opening = mp.radians(tilt), mp.radians(opening)
    group = []
    for _ in range(draw.randint(5, 9)):
        around = mp.mpf(draw.uniform(0, 6.28))
        x, y, z = (mp.sin(opening) * mp.cos(around), mp.sin(opening) * mp.sin(around),
                   mp.cos(opening))
        x, z = mp.cos(tilt) * x + mp.sin(tilt) * z, -mp.sin(tilt) * x + mp.cos(tilt) * z
        angles = [mp.degrees(mp.asin(z)), mp.degrees(mp.atan2(x, y)) % 360]
        group.append([mp.nstr(mp.nint(a * 10**digits) / mp.mpf(10) ** digits, 16) for a in angles])
    return [group]


def too_few():
    groups = open_sky()
    while sum(map(len, groups)) >= 3 + len(groups):
        max(groups, key=len).pop()
    return groups


def dilutions(groups, weights):
    """PDOP, HDOP, VDOP and the TDOP of each group; None for a singular matrix."""
    satellites = [(clock, *map(mp.mpf, place))
                  for clock, group in enumerate(groups) for place in group]
    size = 3 + len(groups)
    if len(satellites) < size:
        return None
    normal = mp.zeros(size, size)
    for clock, elevation, azimuth in satellites:
        elevation, azimuth = mp.radians(elevation), mp.radians(azimuth)
        row = [mp.mpf(0)] * size
        row[0] = mp.cos(elevation) * mp.sin(azimuth)
        row[1] = mp.cos(elevation) * mp.cos(azimuth)
        row[2] = mp.sin(elevation)
        row[3 + clock] = mp.mpf(1)
        weight = mp.sin(elevation) ** 2 if weights == "sine-elevation" else 1
        for i in range(size):
            for j in range(size):
                normal[i, j] += weight * row[i] * row[j]
    # Rounding leaves 1e-59 of a determinant of zero; the smallest other is above 1e-32 here.
    if abs(mp.det(normal)) < mp.mpf(10) ** -45:
        return None
    inverse = normal ** -1
    variance = [inverse[n, n] for n in range(size)]
    return [mp.sqrt(x) for x in
            [sum(variance[:3]), variance[0] + variance[1], variance[2], *variance[3:]]]


def is_certain(found):
    return found is None or all(abs(found[0] / cap - 1) > 0.05 for cap in CAPS)


KINDS = [(open_sky, 30), (few_directions, 50), (cone, 40), (near_cone, 70), (docked, 60),
         (lone, 40), (tilted_cone, 40), (too_few, 10)]

with OUT.open("w", newline="") as file:
    out = csv.writer(file, lineterminator="\n")
    out.writerow(["kind", "weights", "sky", "pdop", "hdop", "vdop", "tdop"])
    for kind, count in KINDS:
        made = 0
        while made < count:
            groups, weights = kind(), draw.choice(["unit", "unit", "sine-elevation"])
            if any(not 1 < mp.mpf(elevation) < 90 for group in groups for elevation, _ in group):
                continue
            found = dilutions(groups, weights)
            if not is_certain(found):
                continue
            made += 1
            sky = "|".join(" ".join("/".join(place) for place in group) for group in groups)
            text = [mp.nstr(x, 17) for x in found] if found else [""] * 4
            name = kind.__name__.replace("_", "-")
            out.writerow([name, weights, sky, *text[:3], "|".join(text[3:])])
