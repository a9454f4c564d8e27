#!/usr/bin/env python3
"""What a design under mean J2 leaves out, by cause: its satellites integrated with one force more at a time.

    python3 -m venv venv && venv/bin/pip install -r requirements-full-force.txt
    venv/bin/python full_force.py --design delta:55:182/13/1@925 --program navwalker --out DIR

The satellites start from the osculating state of the design (`propagation.model = "j2-osculating"`, GCRF) and are
integrated by brahe (EGM2008, NRLMSISE-00, the Sun and the Moon by its own series, conical shadow) with J2, zonals to J6,
20 x 20, the Sun and the Moon, drag at low and at high solar activity, and radiation pressure. J2 is compared with the
design under mean J2, every other force with the integration without it (both drags with that of the Sun and the Moon,
radiation pressure with low drag), over 1, 7 and 30 days. A drift along the track is first taken as an offset of the mean
semi-major axis, which is given apart; radial, in-track and cross-track are what is left. UT1 = UTC and no polar motion, as
in the design.

DIR gets `full-force.md`, `full-force.json`, and a folder for each design and in it for each force, with an OEM of each satellite (a day,
a sample every five minutes), which `navwalker validate --design … --against FOLDER` reads (it counts the satellites that are missing where
--satellites asks for fewer than the design has). `full_force_orekit.py DIR` integrates
the first satellite of each by Orekit.
"""

import argparse
import json
import math
import subprocess
import sys
import tempfile
from datetime import datetime, timedelta
from importlib.metadata import version
from pathlib import Path

import brahe as bh
import numpy as np

DAY_S = 86400.0
STEP_S = 900.0
HORIZONS_DAYS = (1, 7, 30)
MU_KM3_S2 = 398600.4418
# ECSS-E-ST-10-04C, long-term low and high solar activity: F10.7 (daily and of 81 days), Ap, and the Kp next to it.
ACTIVITY = {"low": (65.0, 0.0, 0.0), "high": (250.0, 45.0, 5.0)}
# Of the integrator RKN 12(10): 3 mm in a day from a tolerance of 1e-12.
ABSOLUTE_M, RELATIVE = 1e-6, 1e-10
SPACECRAFT = ("mass_kg", "area_m2", "drag_coefficient", "reflection_coefficient")
GRAVITY = bh.GravityModelType.EGM2008_120


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--design", action="append", required=True, help="Walker notation of one shell; repeatable")
    parser.add_argument("--program", default="navwalker", help="the program navwalker")
    parser.add_argument("--out", type=Path, required=True, help="directory of the results, which must not exist")
    parser.add_argument("--satellites", type=int, default=2, help="satellites of each design, spread over its slots")
    parser.add_argument("--days", type=float, default=30.0, help="at most 30 days are compared")
    parser.add_argument("--mass-kg", type=float, default=200.0)
    parser.add_argument("--area-m2", type=float, default=2.0, help="for drag and radiation pressure")
    parser.add_argument("--drag-coefficient", type=float, default=2.2)
    parser.add_argument("--reflection-coefficient", type=float, default=1.3)
    args = parser.parse_args()
    for name in ("satellites", "days", *SPACECRAFT):
        if not getattr(args, name) > 0:
            parser.error(f"--{name.replace('_', '-')} must be above 0")
    if args.days > HORIZONS_DAYS[-1]:
        parser.error(f"--days must be at most {HORIZONS_DAYS[-1]}")
    if args.out.exists():
        parser.error(f"{args.out} exists")
    return args


def exported(program, design, model, duration_h, step_s):
    """States of each satellite in GCRF: {name: [(elapsed seconds, km and km/s)]}."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "states"
        command = [program, "export", "--design", design, "--as", "oem", "--frame", "GCRF", "--out", str(out)]
        settings = {"propagation.model": model, "time.duration-h": duration_h, "time.step-s": step_s}
        for key, value in settings.items():
            command += ["--set", f"{key}={value}"]
        done = subprocess.run([*command, "--allow-large"], capture_output=True, text=True)
        if done.returncode:
            sys.exit(f"{' '.join(command)}\n{done.stderr}")
        return {path.stem: read_oem(path) for path in sorted((out / "oem").glob("*.oem"))}


def read_oem(path):
    states, start = [], None
    for line in path.read_text().splitlines():
        words = line.split()
        if len(words) == 7 and words[0][0].isdigit():
            instant = datetime.fromisoformat(words[0])
            start = start or instant
            states.append(((instant - start).total_seconds(), [float(word) for word in words[1:]]))
    return states


def forces(args):
    """Name, what it is compared with, and the force model with the space weather of each step."""
    value = bh.ParameterSource.value
    zonal = lambda n: bh.GravityConfiguration.spherical_harmonic(n, 0, GRAVITY)
    field = bh.GravityConfiguration.spherical_harmonic(20, 20, GRAVITY)
    third = [
        bh.ThirdBodyConfiguration(body, bh.EphemerisSource.LowPrecision)
        for body in (bh.ThirdBody.SUN, bh.ThirdBody.MOON)
    ]
    drag = bh.DragConfiguration(bh.AtmosphericModel.NRLMSISE00, value(args.area_m2), value(args.drag_coefficient))
    light = bh.SolarRadiationPressureConfiguration(
        value(args.area_m2), value(args.reflection_coefficient), bh.EclipseModel.CONICAL
    )
    mass = value(args.mass_kg)
    model = bh.ForceModelConfig
    return [
        ("J2", None, model(gravity=zonal(2)), None),
        ("zonals to J6", "J2", model(gravity=zonal(6)), None),
        ("20 x 20", "zonals to J6", model(gravity=field), None),
        ("Sun and Moon", "20 x 20", model(gravity=field, third_body=third), None),
        ("drag, low activity", "Sun and Moon", model(gravity=field, third_body=third, drag=drag, mass=mass), "low"),
        ("drag, high activity", "Sun and Moon", model(gravity=field, third_body=third, drag=drag, mass=mass), "high"),
        (
            "radiation pressure",
            "drag, low activity",
            model(gravity=field, third_body=third, drag=drag, srp=light, mass=mass),
            "low",
        ),
    ]


def set_space_weather(activity):
    flux, ap, kp = ACTIVITY[activity or "low"]
    weather = bh.StaticSpaceWeatherProvider.from_values(kp, ap, flux, flux, 0)
    bh.set_global_space_weather_provider(weather)


def integrated(start, epoch, model, times):
    """Positions and velocities in km and km/s at the times."""
    config = bh.NumericalPropagationConfig.with_method(bh.IntegrationMethod.RKN1210)
    config = config.with_abs_tol(ABSOLUTE_M).with_rel_tol(RELATIVE)
    state = np.array(start) * 1e3
    propagator = bh.NumericalOrbitPropagator(epoch, state, config, model)
    propagator.set_eviction_policy_max_size(4)
    found = [state]
    for time in times[1:]:
        propagator.propagate_to(epoch + float(time))
        found.append(propagator.current_state())
    return np.array(found) / 1e3


def differences(one, other):
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


def summary(times, found, semi_major_axis_km):
    """The offset of the mean semi-major axis and what is left, of all satellites over each horizon."""
    rate = math.sqrt(MU_KM3_S2 / semi_major_axis_km**3)
    rows = {}
    for days in HORIZONS_DAYS:
        if times[-1] < days * DAY_S - STEP_S:
            continue
        inside = times <= days * DAY_S
        t = times[inside]
        offsets, left = [], []
        for difference in found:
            d = difference[inside].copy()
            slope = np.polyfit(t, d[:, 1], 1)[0]
            d[:, 1] -= slope * t
            # A drift of -3/2 n for each unit of the semi-major axis.
            offsets.append(-slope / (1.5 * rate) * 1e3)
            left.append(d)
        left = np.array(left)
        rms = np.sqrt(np.mean(left**2, axis=(0, 1)))
        rows[days] = {
            "semi_major_axis_offset_m": float(np.mean(offsets)),
            "in_track_drift_km_per_day": float(np.mean(offsets) * -1.5e-3 * rate * DAY_S),
            "rms_km": dict(zip(("radial", "in_track", "cross_track"), map(float, rms))),
            "max_km": float(np.max(np.linalg.norm(left, axis=2))),
        }
    return rows


def write_oem(path, epoch, force, name, times, states):
    stamp = lambda t: (epoch + timedelta(seconds=t)).isoformat(timespec="milliseconds")
    lines = ["CCSDS_OEM_VERS = 2.0", f"COMMENT integrated by brahe {version('brahe')}: {force}"]
    lines += [f"CREATION_DATE = {stamp(0)}", "ORIGINATOR = BRAHE", "", "META_START"]
    lines += [f"OBJECT_NAME = {name}", "OBJECT_ID = 2025-900A", "CENTER_NAME = EARTH", "REF_FRAME = GCRF", "TIME_SYSTEM = UTC"]
    lines += [f"START_TIME = {stamp(times[0])}", f"STOP_TIME = {stamp(times[-1])}", "META_STOP", ""]
    for time, state in zip(times, states):
        numbers = [f"{x:.9f}" for x in state[:3]] + [f"{x:.12f}" for x in state[3:]]
        lines.append(" ".join([stamp(time), *numbers]))
    path.parent.mkdir(exist_ok=True)
    path.write_text("\n".join(lines) + "\n")


def folder_name(force):
    return force.replace(", ", "-").replace(" ", "-").lower()


def of_design(args, design):
    altitude_km = float(design.split("@")[1].split(",")[0])
    starts = exported(args.program, design, "j2-osculating", 1, 3600)
    names = sorted(starts)
    count = min(args.satellites, len(names))
    chosen = [names[n * len(names) // count] for n in range(count)]
    mean = exported(args.program, design, "j2", args.days * 24 + STEP_S / 3600, STEP_S)
    times = np.array([time for time, _ in mean[chosen[0]]])
    epoch = bh.Epoch.from_datetime(2025, 1, 1, 0, 0, 0.0, 0.0, bh.TimeSystem.UTC)
    tracks = {None: [np.array([state for _, state in mean[name]]) for name in chosen]}
    rows, folder = [], args.out / design.replace("/", "-").replace(":", "-").replace("@", "-")
    folder.mkdir(parents=True)
    fine = np.arange(0.0, DAY_S + 1, 300.0)
    for name, before, model, activity in forces(args):
        set_space_weather(activity)
        tracks[name] = [integrated(starts[one][0][1], epoch, model, times) for one in chosen]
        for one in chosen:
            path = folder / folder_name(name) / f"{one}.oem"
            write_oem(path, datetime(2025, 1, 1), name, one, fine, integrated(starts[one][0][1], epoch, model, fine))
        found = [differences(a, b) for a, b in zip(tracks[before], tracks[name])]
        rows.append({"force": name, "without": before or "mean J2", "days": summary(times, found, 6378.137 + altitude_km)})
        print(f"{design}: {name}", file=sys.stderr)
    whole = [differences(a, b) for a, b in zip(tracks[None], tracks["radiation pressure"])]
    rows.append({"force": "all", "without": "mean J2", "days": summary(times, whole, 6378.137 + altitude_km)})
    return {"design": design, "directory": folder.name, "satellites": chosen, "forces": rows}


def markdown(args, results, versions):
    text = "# What mean J2 leaves out\n\n"
    text += "<!-- made by validation/external/full_force.py -->\n\n"
    text += (
        f"Integrated by {versions}; {args.mass_kg:g} kg, {args.area_m2:g} m², drag coefficient {args.drag_coefficient:g}, "
        f"reflection coefficient {args.reflection_coefficient:g}; low activity F10.7 = 65 and Ap = 0, high 250 and 45. Each force is "
        "compared with the integration without it, J2 and all with the design under mean J2. The drift is that of the mean "
        "semi-major axis, which is fitted and given apart; RMS is what is left.\n"
    )
    for result in results:
        text += f"\n## {result['design']}\n\nSatellites {', '.join(result['satellites'])}.\n\n"
        text += "| force | days | drift (km/day) | semi-major axis (m) | RMS radial (km) | in-track (km) | cross-track (km) | largest (km) |\n"
        text += "| --- | --: | --: | --: | --: | --: | --: | --: |\n"
        for row in result["forces"]:
            for days, of in row["days"].items():
                rms = of["rms_km"]
                text += (
                    f"| {row['force']} | {days} | {of['in_track_drift_km_per_day']:.4f} | {of['semi_major_axis_offset_m']:.3f} "
                    f"| {rms['radial']:.4f} | {rms['in_track']:.4f} | {rms['cross_track']:.4f} | {of['max_km']:.4f} |\n"
                )
    return text


def main():
    args = arguments()
    bh.set_global_eop_provider_from_static_provider(bh.StaticEOPProvider.from_zero())
    args.out.mkdir(parents=True)
    results = [of_design(args, design) for design in args.design]
    versions = f"brahe {version('brahe')}"
    spacecraft = {name: getattr(args, name) for name in SPACECRAFT}
    whole = {"versions": versions, "spacecraft": spacecraft, "designs": results}
    (args.out / "full-force.json").write_text(json.dumps(whole, indent=1) + "\n")
    (args.out / "full-force.md").write_text(markdown(args, results, versions))
    print((args.out / "full-force.md").read_text())


if __name__ == "__main__":
    main()
