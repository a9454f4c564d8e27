"""The figure of full_force.py: what is left of each force over the days, on axes of its own for each direction."""

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
import numpy as np

DAY_S = 86400.0
# The Okabe-Ito palette, which the colour-blind tell apart, with grey for its yellow, which is faint on paper.
COLOURS = ("#000000", "#E69F00", "#56B4E9", "#009E73", "#999999", "#D55E00", "#CC79A7", "#0072B2")
DIRECTIONS = ("radial", "in-track", "cross-track")
# The same bytes each time.
PLAIN = {"svg.hashsalt": "full-force", "svg.fonttype": "path", "font.size": 8}


def envelope(days, values):
    """The middle of each whole half day, in which several revolutions lie, and the largest value in it."""
    count = int(days[-1] / 0.5)
    place = np.minimum((days / 0.5).astype(int), count - 1)
    return 0.5 * np.arange(count) + 0.25, np.array([np.max(values[place == n]) for n in range(count)])


def draw(path, design, times, curves):
    """`curves`: of each force the differences of each satellite, km, radial, in-track and cross-track by time."""
    days = times / DAY_S
    with plt.rc_context(PLAIN):
        figure, axes = plt.subplots(3, 1, figsize=(180 / 25.4, 170 / 25.4), sharex=True, layout="constrained")
        for number, (axis, direction) in enumerate(zip(axes, DIRECTIONS)):
            for colour, (force, satellites) in zip(COLOURS, curves.items()):
                worst = np.zeros(len(days))
                for difference in satellites:
                    d = difference[:, number]
                    left = d - np.polyfit(days, d, 1)[0] * days if direction == "in-track" else d
                    worst = np.maximum(worst, np.abs(left))
                x, y = envelope(days, worst)
                # A millimetre is what the integrations are good for.
                axis.plot(x, np.maximum(y, 1e-6), color=colour, label=force, linewidth=1.2 if force != "all" else 2.0)
            axis.set_yscale("log")
            axis.set_ylabel(f"{direction} (km)")
            axis.grid(True, which="major", linewidth=0.3)
        axes[0].set_title(f"{design}: largest difference by force, without the drift of the semi-major axis")
        axes[-1].set_xlabel("time (days)")
        axes[-1].set_xlim(0, days[-1])
        handles, labels = axes[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False)
        figure.savefig(path, metadata={"Date": None, "Creator": None})
        plt.close(figure)
