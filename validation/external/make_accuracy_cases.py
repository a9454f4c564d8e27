"""Metres, windows, LEO clocks, QZSS and NavIC: an evaluation of a small study in numpy.

    pip install numpy==2.4.6 scipy==1.17.1 && python3 validation/external/make_accuracy_cases.py

writes `validation/cases/accuracy.json`. Written apart from the program from the conventions of docs/models.md: orbits from the
formulas, the whole geometry matrix with a column for each clock inverted by numpy, windows by stacking their rows, 95 % errors by
quadrature over the direction of the error (the program inverts a Laplace transform). Lengths in km and m, angles in degrees.
"""

import json
from pathlib import Path

import numpy as np
from scipy.optimize import brentq
from scipy.special import erfc

OUT = Path(__file__).parent.parent / "cases" / "accuracy.json"
MU, RADIUS, J2, F = 398600.4418, 6378.137, 1.08262668e-3, 1 / 298.257223563
SYNCHRONOUS, TURN = 42164.17, 7.2921158553e-5
SPAN_S, STEP_S, MASK, CAP, LEVEL, WINDOW_S = 14400.0, 600.0, 7.0, 100.0, 0.95, 1800.0
POINTS = [(-20.0, 80.0, 1.0), (12.97, 77.59, 2.0), (35.68, 139.77, 3.0)]
SHELLS = [("delta", 53.0, 60, 6, 1, 1000.0), ("star", 87.0, 30, 5, 1, 1100.0)]
# sigma, a, b
ERRORS = {"leo": (0.5, 0.6, 0.3), "beidou-3": (1.5, 1.0, 0.0), "qzss": (2.0, 0.0, 0.5), "navic": (3.0, 1.0, 1.0)}


def gmst(elapsed_s):
    """IAU 1982, UT1 = UTC, from 2025-01-01T00:00:00."""
    days = 2460676.5 - 2451545.0 + elapsed_s / 86400.0
    t = days / 36525.0
    seconds = 67310.54841 + (876600 * 3600 + 8640184.812866) * t + 0.093104 * t**2 - 6.2e-6 * t**3
    return np.radians(seconds / 240.0)


def in_orbit(a, i, node, u):
    """Circular."""
    c, s = np.cos(u), np.sin(u)
    return a * np.array([np.cos(node) * c - np.sin(node) * np.cos(i) * s,
                         np.sin(node) * c + np.cos(node) * np.cos(i) * s, np.sin(i) * s])


def walker(kind, inclination, total, planes, phasing, altitude, t):
    a, i = RADIUS + altitude, np.radians(inclination)
    n = np.sqrt(MU / a**3)
    g = 1.5 * J2 * (RADIUS / a) ** 2 * n
    node_rate, perigee_rate = -g * np.cos(i), g * (2 - 2.5 * np.sin(i) ** 2)
    anomaly_rate = n + g * (1 - 1.5 * np.sin(i) ** 2)
    each = total // planes
    span = 2 * np.pi if kind == "delta" else np.pi
    return [in_orbit(a, i, span * k / planes + node_rate * t,
                     2 * np.pi * (j / each + phasing * k / total) + (perigee_rate + anomaly_rate) * t)
            for k in range(planes) for j in range(each)]


def over(longitude):
    """Fixed over the equator, in Earth-fixed axes."""
    lon = np.radians(longitude)
    return SYNCHRONOUS * np.array([np.cos(lon), np.sin(lon), 0.0])


def eight(inclination, longitude, behind, t):
    """Circular geosynchronous, TEME; over the equator northwards at the longitude after a part of a sidereal day."""
    behind *= 2 * np.pi
    return in_orbit(SYNCHRONOUS, np.radians(inclination), np.radians(longitude) + gmst(0.0) + behind, TURN * t - behind)


def quasi_zenith(member, t):
    """Perigee at 270 degrees over 135 E; apogee and perigee from Kepler's equation."""
    e, i, perigee = 0.075, np.radians(41.0), np.radians(270.0)
    behind = 2 * np.pi * member / 3
    m = TURN * t - behind
    anomaly = brentq(lambda x: x - e * np.sin(x) - m, m - 1, m + 1, xtol=1e-15)
    true = 2 * np.arctan2(np.sqrt(1 + e) * np.sin(anomaly / 2), np.sqrt(1 - e) * np.cos(anomaly / 2))
    radius = SYNCHRONOUS * (1 - e * np.cos(anomaly))
    # At perigee the satellite is 90 degrees behind the node, in right ascension too.
    node = np.radians(135.0) + gmst(0.0) + np.pi / 2 + behind
    return in_orbit(radius, i, node, perigee + true)


def turned(positions, t):
    c, s = np.cos(gmst(t)), np.sin(gmst(t))
    return np.array(positions) @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]).T


def systems(t):
    beidou = walker("delta", 56.0, 24, 3, 1, 21528.0, t) + [eight(55.0, 118.0, k / 3, t) for k in range(3)]
    navic = [eight(29.0, lon, behind, t) for lon, behind in [(55, 0), (55, 0.5), (111.75, 0.25), (111.75, 0.75)]]
    leo = [("leo", part, turned(walker(*shell, t), t)) for part, shell in enumerate(SHELLS)]
    gnss = [
        ("beidou-3", 0, np.vstack([turned(beidou, t), [over(x) for x in (80.0, 110.5, 140.0)]])),
        ("qzss", 0, np.vstack([turned([quasi_zenith(k, t) for k in range(3)], t), [over(127.0)]])),
        ("navic", 0, np.vstack([turned(navic, t), [over(x) for x in (32.5, 83.0, 131.5)]])),
    ]
    return leo + gnss


def rows(point, t):
    """(east, north, up, system, part) of each satellite in view."""
    lat, lon = np.radians(point[0]), np.radians(point[1])
    e2 = F * (2 - F)
    normal = RADIUS / np.sqrt(1 - e2 * np.sin(lat) ** 2)
    up = np.array([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)])
    east = np.array([-np.sin(lon), np.cos(lon), 0.0])
    north = np.cross(up, east)
    origin = np.array([normal * up[0], normal * up[1], normal * (1 - e2) * up[2]])
    found = []
    for name, part, positions in systems(t):
        for position in positions:
            line = position - origin
            line /= np.linalg.norm(line)
            if np.degrees(np.arcsin(line @ up)) >= MASK:
                found.append((line @ east, line @ north, line @ up, name, part))
    return found


def covariance(observations, clock, weight):
    """The position block of (G' W G)^-1; None if there are too few satellites."""
    clocks = sorted({clock(one) for one in observations})
    if len(observations) < 3 + len(clocks):
        return None
    g = np.zeros((len(observations), 3 + len(clocks)))
    for n, one in enumerate(observations):
        g[n, :3] = one[:3]
        g[n, 3 + clocks.index(clock(one))] = 1
    w = np.array([weight(one) for one in observations])
    return np.linalg.inv(g.T * w @ g)[:3, :3]


def by_error(one):
    sigma, a, b = ERRORS[one[3]]
    return 1 / (sigma**2 * (a**2 + b**2 / one[2] ** 2))


def summary(values, weights):
    values, weights = np.array(values), np.array(weights)
    order = np.argsort(values)
    values, weights = values[order], weights[order]
    total = weights.sum()

    def quantile(q):
        return np.searchsorted(np.cumsum(weights), q * total - 1e-9 * total / len(values))
    at = quantile(LEVEL)
    tail = (weights[at + 1:] * (values[at + 1:] - values[at])).sum() / ((1 - LEVEL) * total)
    return {"mean": (weights @ values) / total, "p95": values[quantile(0.95)], "cvar": values[at] + tail}


def error95(covariances, weights, axes):
    """The length that 5 % of the errors exceed, by quadrature over the direction of the whitened error."""
    weights = np.array(weights)
    blocks = [np.linalg.eigvalsh(c[np.ix_(axes, axes)]) for c in covariances]
    if len(axes) == 1:
        directions, share = np.ones((1, 1)), np.ones(1)
    elif len(axes) == 2:
        phi = 2 * np.pi * (np.arange(2000) + 0.5) / 2000
        directions, share = np.stack([np.cos(phi) ** 2, np.sin(phi) ** 2], 1), np.full(2000, 1 / 2000)
    else:
        heights, shares = np.polynomial.legendre.leggauss(60)
        angles = 2 * np.pi * (np.arange(120) + 0.5) / 120
        z, phi = (x.ravel() for x in np.meshgrid(heights, angles, indexing="ij"))
        directions = np.stack([(1 - z**2) * np.cos(phi) ** 2, (1 - z**2) * np.sin(phi) ** 2, z**2], 1)
        share = np.repeat(shares, 120) / 240
    radii = [np.sqrt(directions @ block) for block in blocks]

    def survival(x):
        """P(chi > x) with as many degrees of freedom as axes."""
        if len(axes) == 1:
            return erfc(x / np.sqrt(2))
        if len(axes) == 2:
            return np.exp(-x * x / 2)
        return erfc(x / np.sqrt(2)) + np.sqrt(2 / np.pi) * x * np.exp(-x * x / 2)

    def excess(length):
        return weights @ [share @ survival(length / radius) for radius in radii] / weights.sum() - 0.05
    return brentq(excess, 1e-3, 1e3, xtol=1e-12)


def study():
    instants = np.arange(int(SPAN_S / STEP_S)) * STEP_S
    seen = {(n, t): rows(point, t) for n, point in enumerate(POINTS) for t in instants}
    weight = {n: point[2] for n, point in enumerate(POINTS)}
    result = {}
    for key, clock in [("shared", lambda one: one[3]), ("per_part", lambda one: one[3:5])]:
        pdops = [(np.sqrt(np.trace(covariance(seen[n, t], clock, lambda _: 1.0))), weight[n])
                 for t in instants for n in weight]
        assert max(pdops)[0] < CAP
        result[f"pdop_{key}"] = summary(*zip(*pdops))
    samples = [(covariance(seen[n, t], lambda one: one[3], by_error), weight[n]) for t in instants for n in weight]
    for name, axes in [("3d", [0, 1, 2]), ("h", [0, 1]), ("v", [2])]:
        sigmas = [(np.sqrt(sum(c[k, k] for k in axes)), w) for c, w in samples]
        result[f"sigma_{name}_m"] = summary(*zip(*sigmas))
        result[f"error95_{name}_m"] = error95(*zip(*samples), axes)
    count = int(WINDOW_S / STEP_S)
    windows = []
    for first in range(len(instants) - count + 1):
        for n in weight:
            stacked = [one + (t,) for t in instants[first:first + count] for one in seen[n, t]]
            block = covariance(stacked, lambda one: (one[3], one[5]), lambda _: 1.0)
            windows.append((np.sqrt(np.trace(block)), weight[n]))
    result["information_pdop"] = summary(*zip(*windows))
    return result


if __name__ == "__main__":
    OUT.write_text(json.dumps(study(), indent=1) + "\n")
