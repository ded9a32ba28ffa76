#!/usr/bin/env python3
"""Measures by how much two textures must differ in roughness to be distinguished, here with a simulated subject.

    python3 10_texture_discrimination.py [FOLDER]       FOLDER: of the logs; default: the working folder

Each trial strokes two pieces of sandpaper in random order, the standard and a rougher comparison, and asks which one
was rougher. A staircase finds the comparison that is identified in 79 % of trials. Constant stimuli give the whole
psychometric curve, with the point of subjective equality and the just noticeable difference (JND). After an
interruption, another call continues with the next trial. For human subjects, let `feels` open a real arm
(thimble.open) and ask them.
"""

import sys
from pathlib import Path

import numpy as np

import thimble
from thimble import experiment

STANDARD = 20e-6  # m, RMS height of the standard
NOISE = 0.1  # relative standard deviation of the roughness estimate of the simulated subject

# A hand strokes 20 mm of a block of sandpaper in 0.4 s.
SANDPAPER = {
    "name": "strip", "arm": "vintage_phantom", "duration": 0.7,
    "objects": [{"name": "strip", "box": {"sides": [0.05, 0.05, 0.02]}, "position": [0, 0, -0.01],
                 "stiffness": 800, "damping": 1,
                 "effects": [{"texture": "sandpaper", "wavelength": 0.002, "roughness": STANDARD, "seed": 1}]}],
    "hand": {"path": [{"t": 0, "at": [0, -0.01, 0.002]}, {"t": 0.3, "on": "strip", "near": [0, -0.01, 0], "press": 0.005},
                      {"t": 0.7, "on": "strip", "near": [0, 0.01, 0], "press": 0.005}]},
}  # fmt: skip


def stroke(roughness, random):
    """Strokes a new piece of sandpaper with a new tremor. Returns the RMS of the force above 20 Hz, N."""
    piece, tremor = random.integers(1, 10_000, size=2).tolist()
    changes = {"strip.effects.texture.roughness": roughness, "strip.effects.texture.seed": piece}
    touch = thimble.run(SANDPAPER, set=changes, seed=tremor)
    force = touch.force[touch.time > 0.35, 2]
    quick = force - np.convolve(force, np.ones(51) / 51, mode="same")  # removes frequencies below 20 Hz
    return float(np.sqrt(np.mean(quick[25:-25] ** 2)))


def feels(roughness, random):
    """Returns the roughness that the simulated subject perceives in a stroke, N."""
    rms = stroke(roughness, random)
    return rms * (1 + NOISE * random.normal())


def present(trial):
    """Strokes standard and comparison in random order. Returns which of them seemed rougher."""
    comparison = trial.condition["level"] * STANDARD
    standard_first = bool(trial.random.integers(2))
    first = feels(STANDARD if standard_first else comparison, trial.random)
    second = feels(comparison if standard_first else STANDARD, trial.random)
    chose_comparison = (second > first) == standard_first
    return {"correct": chose_comparison, "rougher": chose_comparison, "standard_first": standard_first}


def main(folder):
    staircase = experiment.Staircase(1.8, [1.2, 1.1, 1.05], multiply=True, down=3, lowest=1.0, reversals=12, last=8)
    with experiment.Session(folder / "staircase.jsonl", staircase, seed=1, about={"subject": "simulated"}) as session:
        if session.resumed:
            print(f"Continues after {session.resumed} trials.")
        session.run(present)
    print(
        f"Staircase: {len(staircase.levels)} trials; identified in {100 * staircase.target:.0f} % at "
        f"{staircase.threshold:.3f} of the standard."
    )

    stimuli = experiment.ConstantStimuli(np.linspace(0.4, 1.6, 7), 16, answer_key="rougher", seed=2)
    with experiment.Session(folder / "constant.jsonl", stimuli, seed=2, about={"subject": "simulated"}) as session:
        session.run(present)
    curve = stimuli.fit(shape="probit")
    print(
        f"Constant stimuli: {len(session.lines)} trials; equal at {curve.middle:.3f} +- {curve.middle_error:.3f} of the standard, "
        f"JND {100 * curve.jnd:.1f} % of it."
    )
    print(f"Threshold {1e6 * staircase.threshold * STANDARD:.1f} um, JND {1e6 * curve.jnd * STANDARD:.1f} um.")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
