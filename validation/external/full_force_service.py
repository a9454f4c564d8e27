"""What the forces that J2 leaves out do to the service: the metrics of full_force.py's --service.

A first-order osculating start has a mean semi-major axis that is tens of metres off in the whole field, so that satellites would leave
their slots by kilometres a day for the want of a number that every operator has. Each start is therefore trimmed along its velocity until
it holds its slot over a week of gravity, of the Earth, the Sun and the Moon; drag and light then act on it without control.
"""

import json
import re
import sys
from datetime import timedelta

import numpy as np

from full_force_model import DAY_S, FINE_STEP_S, MU_KM3_S2, START, STEP_S, exported, integrate_all, ric, run, write_oems

METRICS = ("mean_visible", "mean_pdop", "cvar_pdop", "max_pdop", "availability", "least_visible", "longest_outage_s")
TRIM_DAYS = 7
MODELS = {"low activity": "radiation pressure", "high activity": "all, high activity"}


def turned(program, design, days):
    """The design after these days of mean J2, as notation: its node and arguments of latitude have turned."""
    (orbit,) = json.loads(run([program, "orbit", design, "--format", "json"]))
    given = dict(re.findall(r",(raan|u)=([-\d.]+)", design))
    plain = re.sub(r",(raan|u)=[-\d.]+", "", design)
    raan = float(given.get("raan", 0)) + orbit["nodal_rate_deg_per_day"] * days
    u = float(given.get("u", 0)) + 360.0 * days * 1440.0 / orbit["nodal_period_min"]
    return f"{plain},raan={raan % 360:.9f},u={u % 360:.9f}"


def metrics(program, settings, chosen):
    """The metrics of `--design NOTATION` or `--constellation FOLDER`."""
    printed = run([program, "evaluate", "--quiet", "--format", "json", *settings, *chosen])
    found = json.loads(printed)["metrics"]
    return {name: found[name] for name in METRICS}


def flipped_decisions(program, settings, design, folder):
    printed = run([program, "validate", "--quiet", "--format", "json", *settings, "--design", design, "--against", str(folder)])
    return next(check["value"] for check in json.loads(printed)["checks"] if check["name"].endswith("/flipped-decisions"))


def trimmed(args, craft, design, starts):
    """The starts, km and km/s, that hold their slots over the first days, and by how many metres their semi-major axes were changed."""
    names = sorted(starts)
    first = np.array([starts[name][0][1] for name in names])
    mean = exported(args.program, design, "j2", TRIM_DAYS * 24 + STEP_S / 3600, STEP_S)
    times = np.array([time for time, _ in mean[names[0]]])
    references = [np.array([state for _, state in mean[name]]) for name in names]
    tracks = integrate_all(craft, "Sun and Moon", first, times, args.jobs)
    drifts = [np.polyfit(times, ric(one, other)[:, 1], 1)[0] for one, other in zip(references, tracks)]
    # The semi-major axis that takes the drift away, and the velocity that makes it: da/a = 2 v dv / (mu/a).
    speed, radius = np.linalg.norm(first[:, 3:], axis=1), np.linalg.norm(first[:, :3], axis=1)
    axis = 1 / (2 / radius - speed**2 / MU_KM3_S2)
    offset = np.array(drifts) / (1.5 * np.sqrt(MU_KM3_S2 / axis**3))
    first[:, 3:] *= (1 + offset * MU_KM3_S2 / (2 * axis**2 * speed**2))[:, None]
    return first, offset * 1e3


def phase_spread(reference, states):
    """Of the mean in-track differences of the satellites: the mean, and the standard deviation and largest beyond it."""
    along = [float(np.mean(ric(one, other)[:, 1])) for one, other in zip(reference, states)]
    left = np.array(along) - np.mean(along)
    return {"mean_km": float(np.mean(along)), "std_km": float(np.std(left)), "max_km": float(np.max(np.abs(left)))}


def service(args, craft, design, starts, folder):
    """Metrics of a day, at once and after `--days` without control: under mean J2, and with all forces."""
    names = sorted(starts)
    # A sample beyond the last of the study, so that it is covered.
    day = np.arange(0.0, DAY_S + FINE_STEP_S + 1, FINE_STEP_S)
    whole_days = int(args.days)
    late = day + whole_days * DAY_S
    times = np.concatenate([day, late[late > day[-1]]])
    rows = []
    first, offsets_m = trimmed(args, craft, design, starts)
    integrations = {}
    for activity, force in MODELS.items():
        integrations[activity] = integrate_all(craft, force, first, times, args.jobs)
        print(f"{design}: all satellites, {activity}", file=sys.stderr, flush=True)
    for after, span in ((0, day), (whole_days, late)):
        instant = (START + timedelta(days=after)).isoformat() + "Z"
        settings = ["--set", f"time.epoch={instant}"]
        by_j2 = turned(args.program, design, after)
        rows.append({"days": after, "model": "mean J2", "metrics": metrics(args.program, settings, ["--design", by_j2])})
        fine = (("time.epoch", instant),)
        reference = exported(args.program, by_j2, "j2", (DAY_S + FINE_STEP_S) / 3600, FINE_STEP_S, fine)
        reference = [np.array([state for _, state in reference[name]]) for name in names]
        for activity, tracks in integrations.items():
            inside = np.isin(times, span)
            directory = folder / f"service-{after}-{activity.replace(' ', '-')}"
            write_oems(directory, f"all forces, {activity}", names, span, [track[inside] for track in tracks])
            count = len(reference[0])
            rows.append(
                {
                    "days": after,
                    "model": f"all forces, {activity}",
                    "metrics": metrics(args.program, settings, ["--constellation", str(directory)]),
                    "flipped_decisions": flipped_decisions(args.program, settings, by_j2, directory),
                    "in_track": phase_spread(reference, [track[inside][:count] for track in tracks]),
                }
            )
    trim = {"mean_m": float(np.mean(offsets_m)), "std_m": float(np.std(offsets_m))}
    return {"trim_of_semi_major_axis": trim, "rows": rows}


def service_markdown(found):
    trim = found["trim_of_semi_major_axis"]
    text = (
        "\nThe service of a day, of all satellites, at once and without control since. The semi-major axis of each start was trimmed so that it holds its slot "
        f"over a week of gravity, by {trim['mean_m']:.1f} m in the mean with a standard deviation of {trim['std_m']:.1f} m. Flipped are decisions of visibility, of all; in-track is the mean "
        "of all satellites' differences from mean J2, which is common, and the standard deviation and the largest of what is not.\n\n"
        "| after (days) | model | mean visible | mean PDOP | CVaR of PDOP | maximum PDOP | availability | least visible "
        "| longest outage (s) | flipped | in-track, common (km) | deviation (km) | largest (km) |\n"
    )
    text += "| --: | --- " + "| --: " * 11 + "|\n"
    for row in found["rows"]:
        of = row["metrics"]
        text += (
            f"| {row['days']} | {row['model']} | {of['mean_visible']:.4f} | {of['mean_pdop']:.4f} | {of['cvar_pdop']:.4f} "
            f"| {of['max_pdop']:.4f} | {of['availability']:.5f} | {of['least_visible']} | {of['longest_outage_s']:g} "
        )
        if "in_track" in row:
            spread = row["in_track"]
            text += f"| {row['flipped_decisions']:.2e} | {spread['mean_km']:.2f} | {spread['std_km']:.3f} | {spread['max_km']:.3f} |\n"
        else:
            text += "| | | | |\n"
    return text
