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

With --service all satellites are integrated with all forces at low and at high activity, and the metrics of the first day
and of the day after --days are given beside those of mean J2 (full_force_service.py).

DIR gets `full-force.md`, `full-force.json`, a figure of each design, and a folder for each design and in it for each force,
with an OEM of each satellite (a day, a sample every five minutes), which `navwalker validate --design … --against FOLDER`
reads where --satellites covers the design. `full_force_orekit.py DIR` integrates the first satellite of each by Orekit.
"""

import argparse
import json
import os
import re
import sys
from importlib.metadata import version
from pathlib import Path

import numpy as np

from full_force_figure import draw
from full_force_model import (
    DAY_S,
    FINE_STEP_S,
    STEP_S,
    exported,
    forces,
    integrate_all,
    mean_motion,
    ric,
    set_up,
    write_oems,
)
from full_force_service import service, service_markdown

HORIZONS_DAYS = (1, 7, 30)
SPACECRAFT = ("mass_kg", "area_m2", "drag_coefficient", "reflection_coefficient")
NOTATION = re.compile(r"(?:delta|star|lattice):[^:]+:[^@+]+@(?P<altitude>[\d.]+)(?:,[^+]*)?")
# What service and budget have in common are the steps of one spacecraft; this is the sum of all.
ALL = "radiation pressure"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--design", action="append", required=True, help="Walker notation of one shell; repeatable")
    parser.add_argument("--program", default="navwalker", help="the program navwalker")
    parser.add_argument("--out", type=Path, required=True, help="directory of the results, which must not exist")
    parser.add_argument("--satellites", type=int, default=2, help="satellites of each design, spread over its slots")
    parser.add_argument("--days", type=float, default=30.0, help="how long forces act, from 1 to 30 days")
    parser.add_argument("--service", action="store_true", help="integrate all satellites, and evaluate the service")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="processes")
    parser.add_argument("--mass-kg", type=float, default=200.0)
    parser.add_argument("--area-m2", type=float, default=2.0, help="for drag and radiation pressure")
    parser.add_argument("--drag-coefficient", type=float, default=2.2)
    parser.add_argument("--reflection-coefficient", type=float, default=1.3)
    args = parser.parse_args()
    for name in ("satellites", "jobs", *SPACECRAFT):
        if not getattr(args, name) > 0:
            parser.error(f"--{name.replace('_', '-')} must be above 0")
    if not 1 <= args.days <= HORIZONS_DAYS[-1]:
        parser.error(f"--days must be from 1 to {HORIZONS_DAYS[-1]}")
    for design in args.design:
        if not NOTATION.fullmatch(design):
            parser.error(f"--design {design}: must be the notation of one shell, as delta:55:182/13/1@925")
    if args.out.exists():
        parser.error(f"{args.out} exists")
    return args


def cross_track_growth(times, reference, cross_track_km):
    """The growth of the amplitude of a cross-track difference once a revolution, km a day: of the angle of the planes."""
    r, v = reference[:, :3], reference[:, 3:]
    normal = np.cross(r, v).mean(axis=0)
    normal /= np.linalg.norm(normal)
    x = np.cross([0.0, 0.0, 1.0], normal)
    x /= np.linalg.norm(x)
    angle = np.arctan2(r @ np.cross(normal, x), r @ x)
    days = times / DAY_S
    terms = [np.cos(angle), np.sin(angle), days * np.cos(angle), days * np.sin(angle)]
    found = np.linalg.lstsq(np.column_stack(terms), cross_track_km, rcond=None)[0]
    return float(np.hypot(found[2], found[3]))


def summary(times, references, differences, altitude_km):
    """By horizon, means over the satellites: the drift, how it grows, the planes, and what is left without the drift."""
    rows = {}
    for days in HORIZONS_DAYS:
        if times[-1] < days * DAY_S - STEP_S:
            continue
        inside = times <= days * DAY_S
        t = times[inside] / DAY_S
        drifts, growths, planes, left = [], [], [], []
        for reference, difference in zip(references, differences):
            d = difference[inside].copy()
            drift = np.polyfit(t, d[:, 1], 1)[0]
            drifts.append(drift)
            growths.append(2 * np.polyfit(t, d[:, 1], 2)[0])
            planes.append(cross_track_growth(times[inside], reference[inside], d[:, 2]))
            d[:, 1] -= drift * t
            left.append(d)
        left = np.array(left)
        rms = np.sqrt(np.mean(left**2, axis=(0, 1)))
        # A drift of -3/2 n for each unit of the semi-major axis.
        offset_km = -np.mean(drifts) / DAY_S / (1.5 * mean_motion(altitude_km))
        rows[days] = {
            "in_track_drift_km_per_day": float(np.mean(drifts)),
            "semi_major_axis_offset_m": float(offset_km * 1e3),
            "in_track_growth_km_per_day2": float(np.mean(growths)),
            "cross_track_growth_km_per_day": float(np.mean(planes)),
            "rms_km": dict(zip(("radial", "in_track", "cross_track"), map(float, rms))),
            "max_km": float(np.max(np.linalg.norm(left, axis=2))),
        }
    return rows


def folder_name(text):
    return re.sub(r"[^a-z0-9.]+", "-", text.lower())


def of_design(args, craft, design):
    altitude_km = float(NOTATION.fullmatch(design)["altitude"])
    starts = exported(args.program, design, "j2-osculating", 1, 3600)
    names = sorted(starts)
    count = min(args.satellites, len(names))
    chosen = [names[n * len(names) // count] for n in range(count)]
    mean = exported(args.program, design, "j2", args.days * 24 + STEP_S / 3600, STEP_S)
    times = np.array([time for time, _ in mean[chosen[0]]])
    first = [starts[one][0][1] for one in chosen]
    folder = args.out / folder_name(design)
    fine = np.arange(0.0, DAY_S + 1, FINE_STEP_S)
    tracks = {None: [np.array([state for _, state in mean[name]]) for name in chosen]}
    rows, curves = [], {}

    def compare(force, without, one, other):
        differences = [ric(a, b) for a, b in zip(one, other)]
        rows.append({"force": force, "without": without, "days": summary(times, one, differences, altitude_km)})
        curves[force] = differences

    for force, (without, _, _) in forces(craft).items():
        if force == "all, high activity":
            continue
        tracks[force] = integrate_all(craft, force, first, times, args.jobs)
        compare(force, without or "mean J2", tracks[without], tracks[force])
        write_oems(folder / folder_name(force), force, chosen, fine, integrate_all(craft, force, first, fine, args.jobs))
        print(f"{design}: {force}", file=sys.stderr, flush=True)
    compare("all", "mean J2", tracks[None], tracks[ALL])
    figure = f"{folder.name}.svg"
    draw(args.out / figure, design, times, curves)
    result = {"design": design, "directory": folder.name, "figure": figure, "satellites": chosen, "forces": rows}
    if args.service:
        result["service"] = service(args, craft, design, starts, folder)
    return result


def markdown(command, craft, results, versions):
    text = f"# What mean J2 leaves out\n\n<!-- {command} -->\n\n"
    text += (
        f"Integrated by {versions}; {craft['mass_kg']:g} kg, {craft['area_m2']:g} m², drag coefficient {craft['drag_coefficient']:g}, "
        f"reflection coefficient {craft['reflection_coefficient']:g}; low activity F10.7 = 65 and Ap = 0, high 250 and 45. Each force is "
        "compared with the integration without it, J2 and all with the design under mean J2. The drift along the track is taken as an "
        "offset of the mean semi-major axis, which a control of the orbit takes away; RMS and the largest distance are of what is left. The "
        "growth in-track is the second derivative of the drift (decay), the growth cross-track that of the angle between the planes.\n"
    )
    for result in results:
        text += f"\n## {result['design']}\n\nSatellites {', '.join(result['satellites'])}.\n\n"
        text += f"![Distance from the design by force]({result['figure']})\n\n"
        text += (
            "| force | days | drift (km/day) | semi-major axis (m) | growth in-track (km/day²) | growth cross-track (km/day) "
            "| RMS radial (km) | in-track (km) | cross-track (km) | largest (km) |\n"
        )
        text += "| --- " + "| --: " * 9 + "|\n"
        for row in result["forces"]:
            for days, of in row["days"].items():
                rms = of["rms_km"]
                text += (
                    f"| {row['force']} | {days} | {of['in_track_drift_km_per_day']:.4f} | {of['semi_major_axis_offset_m']:.3f} "
                    f"| {of['in_track_growth_km_per_day2']:.4f} | {of['cross_track_growth_km_per_day']:.4f} "
                    f"| {rms['radial']:.4f} | {rms['in_track']:.4f} | {rms['cross_track']:.4f} | {of['max_km']:.4f} |\n"
                )
        if "service" in result:
            text += service_markdown(result["service"])
    return text


def main():
    args = arguments()
    set_up()
    args.out.mkdir(parents=True)
    craft = {name: getattr(args, name) for name in SPACECRAFT}
    results = [of_design(args, craft, design) for design in args.design]
    versions = f"brahe {version('brahe')}"
    whole = {"versions": versions, "spacecraft": craft, "designs": results}
    (args.out / "full-force.json").write_text(json.dumps(whole, indent=1) + "\n")
    typed = [f"--design {design}" for design in args.design] + [f"--satellites {args.satellites}"]
    command = " ".join(["full_force.py", *typed, *(["--service"] if args.service else [])])
    text = markdown(command, craft, results, versions)
    (args.out / "full-force.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
