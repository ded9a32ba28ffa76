#!/usr/bin/env python3
"""Runs a scene from Python and plots the force on the hand. Packages: python3-thimble, python3-matplotlib.

    python3 08_plot_a_touch.py [PICTURE]        default: touch.png

The lines "# %%" separate cells for notebook editors.
"""

# %% Touch a ball of rubber, then the same ball at half the stiffness by a custom force law. The law may be any
# Python code; it is called in each tick of virtual time.
import sys

import numpy as np

import thimble

touch = thimble.run("rubber")
softer = thimble.run("rubber", law=lambda tick: 0.5 * tick.force_wanted)
print(touch.summary())

# %% All arrays are numpy: seconds, metres, newtons.
force = np.linalg.norm(touch.force, axis=1)
softer_force = np.linalg.norm(softer.force, axis=1)
beginnings = np.flatnonzero(np.diff(touch.in_contact.astype(int)) == 1)
print(f"Contacts: {len(beginnings)}; largest force {force.max():.2f} N, largest depth {1e3 * touch.depth.max():.2f} mm.")
print(f"Largest depth with half the force: {1e3 * softer.depth.max():.2f} mm.")

# %% The plot needs matplotlib.
try:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot
except ImportError:
    sys.exit("Without python3-matplotlib there is no picture.")

blue, orange, grey = "#1f5fa8", "#d9822b", "#8a8a8a"
figure, (over_time, over_depth) = pyplot.subplots(
    1, 2, figsize=(11, 4.2), width_ratios=(2, 1), layout="constrained"
)
over_time.plot(touch.time, force, color=blue, linewidth=1, label="scene")
over_time.plot(softer.time, softer_force, color=orange, linewidth=1, label="half the force")
over_time.fill_between(
    touch.time, 0, 1, where=touch.in_contact, transform=over_time.get_xaxis_transform(),
    color=grey, alpha=0.12, linewidth=0, label="in contact",
)
over_time.set(xlabel="time, s", ylabel="force on the hand, N", title="A rubber ball under the hand")
over_time.set_xlim(0, touch.time[-1])
over_time.legend(frameon=False, loc="lower center", ncols=3)

for run, strength, color in ((touch, force, blue), (softer, softer_force, orange)):
    felt = run.in_contact
    over_depth.plot(1e3 * run.depth[felt], strength[felt], ".", color=color, markersize=1.5)
over_depth.set(xlabel="depth, mm", ylabel="force, N", title="Force over depth")
for axes in (over_time, over_depth):
    axes.set_ylim(bottom=0)
    axes.spines[["top", "right"]].set_visible(False)

picture = sys.argv[1] if len(sys.argv) > 1 else "touch.png"
figure.savefig(picture, dpi=110)
print(f"Plot: {picture}")
