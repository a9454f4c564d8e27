"""The evaluation of one design in numpy and in numba, for comparison with navwalker and its Python module.

    python3 evaluate.py [--navwalker BINARY]

The paper's scenario: 143 points, 1440 samples, 182 LEO and 30 BeiDou-3 satellites, a mask of 7
degrees on a sphere, one clock per system, exact CVaR. Both versions keep the sums over BeiDou
between designs, as navwalker does. Metrics must agree to 1e-6, with each other and (with
--navwalker) with the program, before any time is printed. So must those of the Python module where it is installed, which is
timed too. Times are on one thread.
"""

import argparse
import importlib.util
import json
import math
import subprocess
import time

import numba
import numpy as np

MU, RADIUS, J2 = 398600.4418, 6378.137, 1.08262668e-3
GMST_RATE, GEO_RADIUS = 7.2921158553e-5, 42164.17
EPOCH_JULIAN_CENTURIES = (2460676.5 - 2451545.0) / 36525.0  # 2025-01-01T00:00:00
SAMPLES, STEP_S, MASK_DEG, LEVEL, WEIGHT = 1440, 60.0, 7.0, 0.95, 0.5
DESIGN = "delta:55:182/13/1@925"
PARAMETERS = 182, 13, 1, 55.0, 925.0  # satellites, planes, phasing, inclination (deg), altitude (km)


def gmst(elapsed_s):
    """Greenwich mean sidereal time, IAU 1982 (Aoki et al.), at seconds since the epoch, rad."""
    t = EPOCH_JULIAN_CENTURIES + elapsed_s / 86400.0 / 36525.0
    of_midnight = 24110.54841 + t * (8640184.812866 + t * (0.093104 - 6.2e-6 * t))
    return np.radians(((of_midnight + elapsed_s) / 240.0) % 360.0)


def earth_fixed(raan, inclination, latitude, radius, sidereal):
    """Positions [sample, satellite, axis] from node and argument of latitude [sample, satellite]."""
    node = raan - sidereal[:, None]
    x, y = np.cos(latitude), np.sin(latitude)
    return radius * np.stack(
        [
            np.cos(node) * x - np.sin(node) * np.cos(inclination) * y,
            np.sin(node) * x + np.cos(node) * np.cos(inclination) * y,
            np.sin(inclination) * y,
        ],
        axis=-1,
    )


def walker(total, planes, phasing, inclination_deg, altitude_km, times, sidereal):
    """A circular Walker delta pattern under secular J2."""
    per_plane = total // planes
    k, j = np.divmod(np.arange(total), per_plane)
    a, i = RADIUS + altitude_km, math.radians(inclination_deg)
    n = math.sqrt(MU / a**3)
    g = 1.5 * J2 * (RADIUS / a) ** 2 * n
    raan_rate = -g * math.cos(i)
    latitude_rate = n + g * (2 - 2.5 * math.sin(i) ** 2) + g * (1 - 1.5 * math.sin(i) ** 2)
    raan = 2 * math.pi * k / planes + raan_rate * times[:, None]
    start = 2 * math.pi * (j / per_plane + phasing * k / total)
    return earth_fixed(raan, i, start + latitude_rate * times[:, None], a, sidereal)


def beidou(times, sidereal):
    """24 MEO, 3 IGSO on one ground track through 118 degrees east, 3 GEO."""
    meo = walker(24, 3, 1, 56.0, 21528.0, times, sidereal)
    offset = 2 * math.pi * np.arange(3) / 3
    raan = math.radians(118.0) + sidereal[0] + offset + 0 * times[:, None]
    igso = earth_fixed(
        raan, math.radians(55.0), GMST_RATE * times[:, None] - offset, GEO_RADIUS, sidereal
    )
    longitude = np.radians([80.0, 110.5, 140.0]) + 0 * times[:, None]
    geo = GEO_RADIUS * np.stack([np.cos(longitude), np.sin(longitude), 0 * longitude], axis=-1)
    return np.concatenate([meo, igso, geo], axis=1)


def points():
    """Unit vectors of the grid points."""
    latitude, longitude = np.meshgrid(
        np.radians(np.arange(3.0, 54.0, 5.0)), np.radians(np.arange(73.0, 134.0, 5.0)), indexing="ij"
    )
    return np.stack(
        [
            (np.cos(latitude) * np.cos(longitude)).ravel(),
            (np.cos(latitude) * np.sin(longitude)).ravel(),
            np.sin(latitude).ravel(),
        ],
        axis=-1,
    )


def numpy_normal(positions, up):
    """The normal matrix of the position [sample, point, 3, 3] and the count of one system."""
    normal = np.empty((len(positions), len(up), 3, 3))
    counts = np.empty((len(positions), len(up)))
    for k, satellites in enumerate(positions):
        line = satellites[None] - RADIUS * up[:, None]
        line /= np.linalg.norm(line, axis=-1, keepdims=True)
        seen = np.einsum("psx,px->ps", line, up) >= math.sin(math.radians(MASK_DEG))
        line *= seen[..., None]
        total, count = line.sum(axis=1), seen.sum(axis=1)
        scale = 1.0 / np.maximum(count, 1)
        normal[k] = line.transpose(0, 2, 1) @ line
        normal[k] -= total[:, :, None] * total[:, None, :] * scale[:, None, None]
        counts[k] = count
    return normal, counts


def statistics(pdop, count):
    """The metrics, without NaN among the values: every sample of this scenario is solved."""
    values = pdop.ravel().copy()
    rank = math.ceil(LEVEL * values.size - 1e-9)
    values.partition(rank - 1)
    at_risk = values[rank - 1]
    cvar = at_risk + (values[rank:] - at_risk).sum() / ((1 - LEVEL) * values.size)
    mean = values.mean()
    return {
        "mean_visible": count / values.size,
        "mean_pdop": mean,
        "cvar_pdop": cvar,
        "max_pdop": values[rank - 1 :].max(),
        "j_pos": mean + WEIGHT * cvar,
    }


def evaluate_numpy(fixed, up, times, sidereal):
    normal, counts = numpy_normal(walker(*PARAMETERS, times, sidereal), up)
    pdop = np.sqrt(np.trace(np.linalg.inv(normal + fixed), axis1=-2, axis2=-1))
    return statistics(pdop, counts.sum())


@numba.njit(cache=False, fastmath=True, nogil=True)
def numba_pdop(positions, up, fixed, sine, pdop):
    visible = 0
    for k in range(positions.shape[0]):
        for p in range(up.shape[0]):
            ux, uy, uz = up[p, 0], up[p, 1], up[p, 2]
            n = 0
            sx = sy = sz = xx = yy = zz = xy = xz = yz = 0.0
            for s in range(positions.shape[1]):
                px, py, pz = positions[k, s, 0], positions[k, s, 1], positions[k, s, 2]
                height = px * ux + py * uy + pz * uz - RADIUS
                if height <= 0.0:
                    continue
                dx, dy, dz = px - RADIUS * ux, py - RADIUS * uy, pz - RADIUS * uz
                range2 = dx * dx + dy * dy + dz * dz
                if height * height >= sine * sine * range2:
                    scale = 1.0 / math.sqrt(range2)
                    x, y, z = dx * scale, dy * scale, dz * scale
                    n += 1
                    sx += x
                    sy += y
                    sz += z
                    xx += x * x
                    yy += y * y
                    zz += z * z
                    xy += x * y
                    xz += x * z
                    yz += y * z
            visible += n
            scale = 1.0 / max(n, 1)
            f = fixed[k, p]
            xx += f[0, 0] - sx * sx * scale
            yy += f[1, 1] - sy * sy * scale
            zz += f[2, 2] - sz * sz * scale
            xy += f[0, 1] - sx * sy * scale
            xz += f[0, 2] - sx * sz * scale
            yz += f[1, 2] - sy * sz * scale
            mzz, myy, mxx = xx * yy - xy * xy, xx * zz - xz * xz, yy * zz - yz * yz
            determinant = xx * mxx - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz)
            pdop[k, p] = math.sqrt((mxx + myy + mzz) / determinant)
    return visible


def evaluate_numba(fixed, up, times, sidereal, parameters=PARAMETERS):
    positions = walker(*parameters, times, sidereal)
    pdop = np.empty((len(times), len(up)))
    visible = numba_pdop(positions, up, fixed, math.sin(math.radians(MASK_DEG)), pdop)
    return statistics(pdop, visible)


def agree(ours, theirs, name):
    for key, value in theirs.items():
        apart = abs(ours[key] / value - 1)
        assert apart < 1e-6, f"{name} {key}: {ours[key]} against {value}, {apart:.1e}"


def fastest(function, repeats):
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        function()
        times.append(time.perf_counter() - start)
    return min(times) * 1e3, sorted(times)[len(times) // 2] * 1e3


def inputs():
    """What every evaluation takes: the sums over BeiDou, the points, the instants and their sidereal times."""
    times = np.arange(SAMPLES) * STEP_S
    sidereal = gmst(times)
    up = points()
    fixed, _ = numpy_normal(beidou(times, sidereal), up)
    return fixed, up, times, sidereal


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--navwalker", help="the program to compare the metrics with")
    binary = parser.parse_args().navwalker
    arguments = inputs()
    first, second = evaluate_numpy(*arguments), evaluate_numba(*arguments)
    agree(second, first, "numba")
    if binary:
        command = [binary, "evaluate", "paper", "--design", DESIGN, "--format", "json"]
        printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        agree(json.loads(printed)["metrics"], first, "navwalker")
    timed = [("numpy", evaluate_numpy, arguments, 3), ("numba", evaluate_numba, arguments, 20)]
    if importlib.util.find_spec("navwalker"):
        import navwalker

        evaluate = navwalker.Scenario("paper", threads=1).evaluate
        agree(evaluate(DESIGN).to_dict(), first, "navwalker in Python")
        timed.append(("navwalker in Python", evaluate, (DESIGN,), 100))
    for key, value in first.items():
        print(f"{key:20} {value:.12g}")
    for name, function, given, repeats in timed:
        least, median = fastest(lambda f=function, g=given: f(*g), repeats)
        print(f"{name:20} fastest {least:.2f} ms, median {median:.2f} ms")


if __name__ == "__main__":
    main()
