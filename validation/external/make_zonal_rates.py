#!/usr/bin/env python3
"""Rates of the node under zonals to J4, from integrations over 30 days, as `src/orbit/zonal.rs` is tested against.

    venv/bin/python make_zonal_rates.py --program navwalker

Each orbit starts from the osculating state of its design (`propagation.model = "j2-osculating"`, GCRF) and is integrated by
brahe with J2 alone and with J2, J3 and J4 of EGM2008. A line is fitted to the node. The mean semi-major axis of a start is good to first order in J2, so that a rate
is known to a few parts in 1e5 of that of J2; both columns have the same error, which cancels in their difference.
"""

import argparse

import brahe as bh
import numpy as np
from full_force_model import epoch, exported, integrated, set_space_weather, set_up

DESIGNS = ("delta:40:1/1/0@925", "delta:55:1/1/0@925", "delta:70:1/1/0@600", "delta:97:1/1/0@500")
STEP_S = 300.0
DAYS = 30


def node_rate_deg_day(times, states, pole):
    """Of the node on the equator of date: 0.14 degrees between the poles would turn the fitted line."""
    x = np.cross([0.0, 1.0, 0.0], pole)
    x /= np.linalg.norm(x)
    normal = np.cross(states[:, :3], states[:, 3:])
    node = np.unwrap(np.arctan2(normal @ x, -(normal @ np.cross(pole, x))))
    return float(np.degrees(np.polyfit(times / 86400.0, node, 1)[0]))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", default="navwalker")
    program = parser.parse_args().program
    set_up()
    set_space_weather("low")
    times = np.arange(0.0, DAYS * 86400.0 + 1, STEP_S)
    pole = bh.rotation_eci_to_ecef(epoch() + DAYS * 43200.0)[2]
    print("design, rate of the node under J2 and under J2 to J4 (deg/day)")
    for design in DESIGNS:
        (states,) = exported(program, design, "j2-osculating", 1, 3600).values()
        rates = []
        for degree in (2, 4):
            gravity = bh.GravityConfiguration.spherical_harmonic(degree, 0, bh.GravityModelType.EGM2008_120)
            track = integrated(states[0][1], bh.ForceModelConfig(gravity=gravity), times)
            rates.append(node_rate_deg_day(times, track, pole))
        print(f"{design}, {rates[0]:.7f}, {rates[1]:.7f}")


if __name__ == "__main__":
    main()
