"""Forces, integrations and ephemerides of full_force.py."""

import math
import subprocess
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from datetime import datetime, timedelta
from importlib.metadata import version
from pathlib import Path

import brahe as bh
import numpy as np

DAY_S = 86400.0
STEP_S = 900.0
# Of ephemerides: an eighteenth of a revolution, which an eighth-order polynomial interpolates to centimetres.
FINE_STEP_S = 300.0
MU_KM3_S2 = 398600.4418
EARTH_RADIUS_KM = 6378.137
# Below it a revolution decays the next, and NRLMSISE-00 alone decides: no comparison with J2 is left.
LOWEST_KM = 150.0
START = datetime(2025, 1, 1)
# ECSS-E-ST-10-04C, long-term low and high solar activity: F10.7 (daily and of 81 days), Ap, and the Kp next to it.
ACTIVITY = {"low": (65.0, 0.0, 0.0), "high": (250.0, 45.0, 5.0)}
GRAVITY = bh.GravityModelType.EGM2008_120
# Of the integrator RKN 12(10): 3 mm in a day from a hundredth of the relative tolerance.
ABSOLUTE_M, RELATIVE = 1e-6, 1e-10


def exported(program, design, model, duration_h, step_s, settings=()):
    """States of each satellite in GCRF: {name: [(elapsed seconds, km and km/s)]}."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "states"
        command = [program, "export", "--quiet", "--allow-large", "--design", design, "--as", "oem", "--frame", "GCRF"]
        command += ["--out", str(out)]
        keys = {"propagation.model": model, "time.duration-h": duration_h, "time.step-s": step_s, **dict(settings)}
        for key, value in keys.items():
            command += ["--set", f"{key}={value}"]
        run(command)
        return {path.stem: read_oem(path) for path in sorted((out / "oem").glob("*.oem"))}


def run(command):
    """What a command of the program prints; ends with its error where it has one."""
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(command)}\n{done.stderr}")
    return done.stdout


def read_oem(path):
    states, start = [], None
    for line in path.read_text().splitlines():
        words = line.split()
        if len(words) == 7 and words[0][0].isdigit():
            instant = datetime.fromisoformat(words[0])
            start = start or instant
            states.append(((instant - start).total_seconds(), [float(word) for word in words[1:]]))
    return states


def designator(number):
    """The international designator of a launch's satellite of this number from 0: A to Z but I and O, AA, AB and so on."""
    letters, number = "ABCDEFGHJKLMNPQRSTUVWXYZ", number + 1
    piece = ""
    while number:
        number, digit = divmod(number - 1, len(letters))
        piece = letters[digit] + piece
    return f"2025-900{piece}"


def write_oems(folder, force, names, times, tracks):
    """An OEM of each satellite, of its states at the times, km and km/s."""
    folder.mkdir(parents=True, exist_ok=True)
    for number, (name, states) in enumerate(zip(names, tracks)):
        write_oem(folder / f"{name}.oem", force, (name, designator(number)), times, states)


def write_oem(path, force, satellite, times, states):
    stamp = lambda t: (START + timedelta(seconds=float(t))).isoformat(timespec="milliseconds")
    lines = ["CCSDS_OEM_VERS = 2.0", f"COMMENT integrated by brahe {version('brahe')}: {force}"]
    lines += [f"CREATION_DATE = {stamp(0)}", "ORIGINATOR = BRAHE", "", "META_START"]
    lines += [f"OBJECT_NAME = {satellite[0]}", f"OBJECT_ID = {satellite[1]}", "CENTER_NAME = EARTH", "REF_FRAME = GCRF"]
    lines += ["TIME_SYSTEM = UTC"]
    lines += [f"START_TIME = {stamp(times[0])}", f"STOP_TIME = {stamp(times[-1])}", "META_STOP", ""]
    for time, state in zip(times, states):
        numbers = [f"{x:.9f}" for x in state[:3]] + [f"{x:.12f}" for x in state[3:]]
        lines.append(" ".join([stamp(time), *numbers]))
    path.write_text("\n".join(lines) + "\n")


def forces(craft):
    """Name, what it is compared with, and the force model with the solar activity of each step."""
    value = bh.ParameterSource.value
    zonal = lambda n: bh.GravityConfiguration.spherical_harmonic(n, 0, GRAVITY)
    field = bh.GravityConfiguration.spherical_harmonic(20, 20, GRAVITY)
    third = [
        bh.ThirdBodyConfiguration(body, bh.EphemerisSource.LowPrecision)
        for body in (bh.ThirdBody.SUN, bh.ThirdBody.MOON)
    ]
    drag = bh.DragConfiguration(
        bh.AtmosphericModel.NRLMSISE00, value(craft["area_m2"]), value(craft["drag_coefficient"])
    )
    light = bh.SolarRadiationPressureConfiguration(
        value(craft["area_m2"]), value(craft["reflection_coefficient"]), bh.EclipseModel.CONICAL
    )
    mass = value(craft["mass_kg"])
    model = bh.ForceModelConfig
    dragged = model(gravity=field, third_body=third, drag=drag, mass=mass)
    lit = model(gravity=field, third_body=third, drag=drag, srp=light, mass=mass)
    return {
        "J2": (None, model(gravity=zonal(2)), "low"),
        "zonals to J6": ("J2", model(gravity=zonal(6)), "low"),
        "20 x 20": ("zonals to J6", model(gravity=field), "low"),
        "Sun and Moon": ("20 x 20", model(gravity=field, third_body=third), "low"),
        "drag, low activity": ("Sun and Moon", dragged, "low"),
        "drag, high activity": ("Sun and Moon", dragged, "high"),
        "radiation pressure": ("drag, low activity", lit, "low"),
        "all, high activity": (None, lit, "high"),
    }


def set_up():
    """UT1 = UTC and no polar motion, as in the design. IAU 2000B is within a thousandth of a second of arc of 2006/2000A: 1 mm
    of gravity and 8 cm of drag in a day, for a quarter of the time."""
    bh.set_precession_nutation_model(bh.PrecessionNutationModel.IAU2000B)
    bh.set_global_eop_provider_from_static_provider(bh.StaticEOPProvider.from_zero())


def epoch():
    return bh.Epoch.from_datetime(START.year, START.month, START.day, 0, 0, 0.0, 0.0, bh.TimeSystem.UTC)


def set_space_weather(activity):
    flux, ap, kp = ACTIVITY[activity]
    weather = bh.StaticSpaceWeatherProvider.from_values(kp, ap, flux, flux, 0)
    bh.set_global_space_weather_provider(weather)


def integrated(start, model, times):
    """Positions and velocities in km and km/s at the times, of which the first is that of the start if it is 0."""
    config = bh.NumericalPropagationConfig.with_method(bh.IntegrationMethod.RKN1210)
    config = config.with_abs_tol(ABSOLUTE_M).with_rel_tol(RELATIVE)
    state = np.array(start) * 1e3
    propagator = bh.NumericalOrbitPropagator(epoch(), state, config, model)
    propagator.set_eviction_policy_max_size(4)
    found = []
    for time in times:
        if time > 0:
            propagator.propagate_to(epoch() + float(time))
            state = propagator.current_state()
        found.append(state)
        altitude_km = np.linalg.norm(state[:3]) / 1e3 - EARTH_RADIUS_KM
        if altitude_km < LOWEST_KM:
            raise ValueError(f"altitude {altitude_km:.0f} km after {time / DAY_S:.2f} days, less than {LOWEST_KM:g} km")
    return np.array(found) / 1e3


def integrate_one(task):
    """For a pool: a satellite under the force of this name."""
    craft, force, start, times = task
    set_up()
    _, model, activity = forces(craft)[force]
    set_space_weather(activity)
    return integrated(start, model, times)


def integrate_all(craft, force, starts, times, jobs):
    """The states of all satellites, in their order."""
    tasks = [(craft, force, start, times) for start in starts]
    with ProcessPoolExecutor(jobs) as pool:
        try:
            return list(pool.map(integrate_one, tasks))
        except ValueError as error:
            sys.exit(f"{force}: {error}")


def ric(one, other):
    """Radial, in-track (along the arc) and cross-track differences, km, the second minus the first."""
    r, v = one[:, :3], one[:, 3:]
    unit = lambda x: x / np.linalg.norm(x, axis=1)[:, None]
    radial, cross = unit(r), unit(np.cross(r, v))
    along = np.cross(cross, radial)
    part = lambda axis: np.sum(other[:, :3] * axis, axis=1)
    x, y = part(radial), part(along)
    size = np.linalg.norm(r, axis=1)
    angle = np.unwrap(np.arctan2(y, x))
    return np.column_stack([np.hypot(x, y) - size, angle * size, part(cross)])


def mean_motion(altitude_km):
    return math.sqrt(MU_KM3_S2 / (EARTH_RADIUS_KM + altitude_km) ** 3)
