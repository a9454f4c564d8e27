"""Views, outages and weighted statistics of whole studies, evaluated in numpy.

    python3 validation/external/make_counts.py

writes `validation/cases/counts.json`: the metrics of four studies on a sphere, by a program that shares nothing
with the evaluator. Propagation is that of docs/models.md in closed form (circular Walker delta under secular J2), visibility
the elevation itself, PDOP, HDOP and VDOP the inverse of the full geometry matrix with its clocks, quantiles and CVaR those of
the sorted samples with their weights. numpy 2.
"""

import json
import math
from pathlib import Path

import numpy as np

OUT = Path(__file__).parent.parent / "cases" / "counts.json"
MU, RADIUS, J2 = 398600.4418, 6378.137, 1.08262668e-3
GMST_RATE, GEO_RADIUS = 7.2921158553e-5, 42164.17
CENTURIES = (2460676.5 - 2451545.0) / 36525.0  # 2025-01-01T00:00:00
LEVEL = 0.95

STUDIES = [
    {
        "name": "a band with BeiDou-3, by area",
        "planes": 13, "satellites": 182, "phasing": 1, "inclination_deg": 55.0, "altitude_km": 925.0,
        "latitude_deg": [-65.0, 66.0], "longitude_deg": [73.0, 136.0], "step_deg": 10.0,
        "weights": "cos-latitude", "mask_deg": 7.0, "beidou_3": True, "pdop_cap": 100.0,
        "availability_pdop": 1.25, "duration_s": 86400.0, "step_s": 300.0,
    },
    {
        "name": "LEO alone, by area",
        "planes": 11, "satellites": 132, "phasing": 3, "inclination_deg": 55.0, "altitude_km": 925.0,
        "latitude_deg": [-80.0, 81.0], "longitude_deg": [-180.0, 179.0], "step_deg": 20.0,
        "weights": "cos-latitude", "mask_deg": 5.0, "beidou_3": False, "pdop_cap": 20.0,
        "availability_pdop": 6.0, "duration_s": 21600.0, "step_s": 60.0,
    },
    {
        "name": "LEO alone, some samples unsolved",
        "planes": 12, "satellites": 168, "phasing": 1, "inclination_deg": 60.0, "altitude_km": 1000.0,
        "latitude_deg": [-60.0, 61.0], "longitude_deg": [-180.0, 179.0], "step_deg": 30.0,
        "weights": "cos-latitude", "mask_deg": 5.0, "beidou_3": False, "pdop_cap": 4.5,
        "availability_pdop": 3.0, "duration_s": 21600.0, "step_s": 120.0,
    },
    {
        "name": "the region of the paper, equal weights",
        "planes": 8, "satellites": 88, "phasing": 1, "inclination_deg": 50.0, "altitude_km": 900.0,
        "latitude_deg": [3.0, 54.0], "longitude_deg": [73.0, 136.0], "step_deg": 10.0,
        "weights": "equal", "mask_deg": 7.0, "beidou_3": True, "pdop_cap": 100.0,
        "availability_pdop": 1.5, "duration_s": 86400.0, "step_s": 300.0,
    },
]


def gmst(elapsed_s):
    """Greenwich mean sidereal time, IAU 1982 (Aoki et al.), rad."""
    t = CENTURIES + elapsed_s / 86400.0 / 36525.0
    of_midnight = 24110.54841 + t * (8640184.812866 + t * (0.093104 - 6.2e-6 * t))
    return np.radians(((of_midnight + elapsed_s) / 240.0) % 360.0)


def earth_fixed(raan, inclination, latitude, radius, sidereal):
    node = raan - sidereal[:, None]
    x, y = np.cos(latitude), np.sin(latitude)
    return radius * np.stack([
        np.cos(node) * x - np.sin(node) * np.cos(inclination) * y,
        np.sin(node) * x + np.cos(node) * np.cos(inclination) * y,
        np.sin(inclination) * y,
    ], axis=-1)


def walker(total, planes, phasing, inclination_deg, altitude_km, times, sidereal):
    per_plane = total // planes
    k, j = np.divmod(np.arange(total), per_plane)
    a, i = RADIUS + altitude_km, math.radians(inclination_deg)
    n = math.sqrt(MU / a**3)
    g = 1.5 * J2 * (RADIUS / a) ** 2 * n
    latitude_rate = n + g * (2 - 2.5 * math.sin(i) ** 2) + g * (1 - 1.5 * math.sin(i) ** 2)
    raan = 2 * math.pi * k / planes - g * math.cos(i) * times[:, None]
    start = 2 * math.pi * (j / per_plane + phasing * k / total)
    return earth_fixed(raan, i, start + latitude_rate * times[:, None], a, sidereal)


def beidou(times, sidereal):
    """24 MEO, 3 IGSO on one ground track through 118 degrees east, 3 GEO."""
    meo = walker(24, 3, 1, 56.0, 21528.0, times, sidereal)
    offset = 2 * math.pi * np.arange(3) / 3
    raan = math.radians(118.0) + sidereal[0] + offset + 0 * times[:, None]
    igso = earth_fixed(raan, math.radians(55.0), GMST_RATE * times[:, None] - offset, GEO_RADIUS, sidereal)
    longitude = np.radians([80.0, 110.5, 140.0]) + 0 * times[:, None]
    geo = GEO_RADIUS * np.stack([np.cos(longitude), np.sin(longitude), 0 * longitude], axis=-1)
    return np.concatenate([meo, igso, geo], axis=1)


def grid(edges, step):
    return edges[0] + step * np.arange(math.floor((edges[1] - edges[0]) / step + 1e-9) + 1)


def in_local_axes(satellites, latitude, longitude):
    """Unit vectors east, north, up from a point on the sphere."""
    (sp, cp), (sl, cl) = (math.sin(latitude), math.cos(latitude)), (math.sin(longitude), math.cos(longitude))
    axes = np.array([[-sl, cl, 0.0], [-sp * cl, -sp * sl, cp], [cp * cl, cp * sl, sp]])
    line = (satellites - RADIUS * axes[2]) @ axes.T
    return line / np.linalg.norm(line, axis=-1, keepdims=True)


def dilutions(groups, cap):
    """PDOP, HDOP and VDOP from (GᵀG)⁻¹ with a clock for each group in view; None if unsolved."""
    groups = [group for group in groups if len(group)]
    rows = sum(map(len, groups))
    if rows < 3 + len(groups):
        return None
    geometry = np.zeros((rows, 3 + len(groups)))
    geometry[:, :3] = np.concatenate(groups)
    first = 0
    for clock, group in enumerate(groups):
        geometry[first:first + len(group), 3 + clock] = 1.0
        first += len(group)
    normal = geometry.T @ geometry
    if np.linalg.cond(normal) > 1e13:
        return None
    east, north, up = np.diag(np.linalg.inv(normal))[:3]
    pdop = math.sqrt(east + north + up)
    return (pdop, math.sqrt(east + north), math.sqrt(up)) if pdop <= cap else None


def quantile(values, weights, q):
    """Smallest value with at least the share q of the weight at or below it; values ascend."""
    wanted = q * weights.sum() - 1e-9 * weights.mean()
    return values[min(np.searchsorted(np.cumsum(weights), wanted), len(values) - 1)]


def tail(values, weights, q):
    """Mean of the worst 1 - q of the weight, with a part of the value at its edge."""
    worst, rest = 0.0, (1 - q) * weights.sum()
    for value, weight in zip(values[::-1], weights[::-1]):
        part = min(weight, rest)
        worst, rest = worst + part * value, rest - part
        if rest <= 0:
            break
    return worst / ((1 - q) * weights.sum())


def runs(bad):
    """(length, whether it touches an end) of each run of true values."""
    found, start = [], None
    for n, is_bad in enumerate(list(bad) + [False]):
        if is_bad and start is None:
            start = n
        if not is_bad and start is not None:
            found.append((n - start, start == 0 or n == len(bad)))
            start = None
    return found


def statistics(dops, weights, name, column=0):
    """Mean, quantiles and tail of the solved samples; nothing if there are none."""
    solved = ~np.isnan(dops[:, 0])
    if not solved.any():
        return {}
    order = np.argsort(dops[solved, column], kind="stable")
    values, share = dops[solved, column][order], weights[solved][order]
    return {
        f"mean_{name}": (values * share).sum() / share.sum(),
        f"p50_{name}": quantile(values, share, 0.5),
        f"p95_{name}": quantile(values, share, 0.95),
        f"p99_{name}": quantile(values, share, 0.99),
        f"max_{name}": values[-1],
        f"cvar_{name}": tail(values, share, LEVEL),
    }


def summary(dops, weights, study):
    """What a gain is taken of: all statistics, fractions and the longest outage, from dops by point and instant."""
    flat = dops.reshape(-1, 3)
    solved = ~np.isnan(flat[:, 0])
    out = ~(dops[:, :, 0] <= study["availability_pdop"])
    longest = max((n for point in out for n, _ in runs(point)), default=0)
    return statistics(flat, weights, "pdop") | {
        "solved_fraction": weights[solved].sum() / weights.sum(),
        "availability": weights[~out.ravel()].sum() / weights.sum(),
        "longest_outage_s": longest * study["step_s"],
    }


def mean_of_solved(values):
    return float(np.nanmean(values)) if not np.isnan(values).all() else None


def minus(alone, both):
    return None if alone is None or both is None else alone - both


def error95_v(dops, weights):
    """Height error that 5 % of all samples exceed with ranges of 1 m, unsolved ones without end; by bisection."""
    solved = ~np.isnan(dops[:, 0])
    unsolved = weights[~solved].sum() / weights.sum()
    if unsolved >= 0.05:
        return None
    sigmas, shares = dops[solved, 2], weights[solved] / weights.sum()
    low, high = 0.0, 100.0 * sigmas.max()
    for _ in range(200):
        x = (low + high) / 2
        beyond = sum(share * math.erfc(x / sigma / math.sqrt(2)) for sigma, share in zip(sigmas, shares))
        low, high = (x, high) if unsolved + beyond > 0.05 else (low, x)
    return low


def evaluate(study):
    times = np.arange(0.0, study["duration_s"], study["step_s"])
    sidereal = gmst(times)
    leo = walker(study["satellites"], study["planes"], study["phasing"], study["inclination_deg"],
                 study["altitude_km"], times, sidereal)
    gnss = beidou(times, sidereal) if study["beidou_3"] else np.zeros((len(times), 0, 3))
    sine = math.sin(math.radians(study["mask_deg"]))
    n_leo, n_gnss, weights, dops, alone, points = [], [], [], [], [], []
    for latitude_deg in grid(study["latitude_deg"], study["step_deg"]):
        for longitude_deg in grid(study["longitude_deg"], study["step_deg"]):
            latitude, longitude = math.radians(latitude_deg), math.radians(longitude_deg)
            weight = math.cos(latitude) if study["weights"] == "cos-latitude" else 1.0
            of_leo = in_local_axes(leo, latitude, longitude)
            of_gnss = in_local_axes(gnss, latitude, longitude)
            bad = []
            for k in range(len(times)):
                seen = [sky[k][sky[k][:, 2] >= sine] for sky in (of_gnss, of_leo)]
                dop = dilutions(seen, study["pdop_cap"])
                alone.append(dilutions(seen[:1], study["pdop_cap"]) or (math.nan,) * 3)
                n_gnss.append(len(seen[0]))
                n_leo.append(len(seen[1]))
                weights.append(weight)
                dops.append(dop or (math.nan,) * 3)
                bad.append(dop is None or dop[0] > study["availability_pdop"])
            outages = runs(bad)
            points.append({
                "outages": len(outages),
                "longest_outage_s": max((n for n, _ in outages), default=0) * study["step_s"],
                "total_outage_s": sum(bad) * study["step_s"],
                "outage_cut": any(cut for _, cut in outages),
                "least_visible": int(min(n_leo[-len(times):])),
                "availability": 1 - sum(bad) / len(bad),
            })
            points[-1]["cuts"] = [n * study["step_s"] for n, cut in outages if cut]
    n_leo, n_gnss, weights, dops, alone = map(np.array, (n_leo, n_gnss, weights, dops, alone))
    total = weights.sum()
    longest = max(point["longest_outage_s"] for point in points)
    solved = ~np.isnan(dops[:, 0])
    metrics = {
        "mean_visible": (weights * n_leo).sum() / total,
        "least_visible": int(n_leo.min()),
        "mean_gnss_visible": (weights * n_gnss).sum() / total,
        "mean_total_visible": (weights * (n_leo + n_gnss)).sum() / total,
        "coverage": [weights[n_leo >= n].sum() / total for n in range(1, 13)],
        "coverage_total": [weights[n_leo + n_gnss >= n].sum() / total for n in range(1, 13)],
        "solved_fraction": weights[solved].sum() / total,
        "availability": weights[solved & (dops[:, 0] <= study["availability_pdop"])].sum() / total,
        "longest_outage_s": longest,
        "longest_outage_cut": longest > 0 and any(longest in point.pop("cuts") for point in list(points)),
    }
    for point in points:
        point.pop("cuts", None)
    for name, column in (("pdop", 0), ("hdop", 1), ("vdop", 2)):
        metrics |= statistics(dops, weights, name, column)
    metrics["error95_v_m"] = error95_v(dops, weights)
    for name, counts in (("leo", n_leo), ("gnss", n_gnss), ("all", n_leo + n_gnss)):
        metrics[f"histogram_{name}"] = list(np.bincount(counts, weights) / total)
    by_point = (len(points), len(times))
    own, without = (of.reshape(*by_point, 3) for of in (dops, alone))
    if study["beidou_3"]:
        both, gnss = summary(own, weights, study), summary(without, weights, study)
        metrics["gain"] = {name: minus(gnss.get(name), both.get(name)) for name in both}
    of_leo, of_all, share = (of.reshape(by_point) for of in (n_leo, n_leo + n_gnss, weights))
    for n, point in enumerate(points):
        point["coverage"] = [float((of_leo[n] >= least).mean()) for least in range(1, 13)]
        point["coverage_total"] = [float((of_all[n] >= least).mean()) for least in range(1, 13)]
        if study["beidou_3"]:
            point["gain_mean_pdop"] = minus(mean_of_solved(without[n, :, 0]), mean_of_solved(own[n, :, 0]))
    instants = []
    for k in range(0, len(times), max(1, len(times) // 24)):
        weight = share[:, k]
        instants.append({
            "number": k,
            "coverage": [(weight * (of_leo[:, k] >= least)).sum() / weight.sum() for least in range(1, 13)],
            "coverage_total": [(weight * (of_all[:, k] >= least)).sum() / weight.sum() for least in range(1, 13)],
            "availability": (weight * (own[:, k, 0] <= study["availability_pdop"])).sum() / weight.sum(),
        })
        if study["beidou_3"]:
            means = []
            for dop in (without[:, k, 0], own[:, k, 0]):
                known = ~np.isnan(dop)
                means.append((weight * dop)[known].sum() / weight[known].sum() if known.any() else None)
            instants[-1]["gain_mean_pdop"] = minus(*means)
    return {"study": study, "metrics": metrics, "points": points, "instants": instants}


def plain(value):
    if isinstance(value, np.bool_):
        return bool(value)
    return float(value) if isinstance(value, np.floating) else int(value)


def lines(case):
    """One study as JSON: a line for each member, and for each point and instant."""
    def part(value):
        if isinstance(value, list):
            return "[\n   " + ",\n   ".join(json.dumps(one, default=plain) for one in value) + "\n  ]"
        return json.dumps(value, default=plain)
    return " {\n" + ",\n".join(f'  "{name}": {part(value)}' for name, value in case.items()) + "\n }"


if __name__ == "__main__":
    cases = [evaluate(study) for study in STUDIES]
    OUT.write_text("[\n" + ",\n".join(map(lines, cases)) + "\n]\n")
    print(f"{OUT}: {len(cases)} studies, numpy {np.__version__}")
