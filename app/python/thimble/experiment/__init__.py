"""Experiments with people: trials, conditions, staircases, constant stimuli, and a crash-safe log.

    from thimble import experiment

    staircase = experiment.Staircase(1.0, [2.0, 1.4, 1.2], multiply=True, down=3, lowest=1e-3)
    with experiment.Session("subject_07.jsonl", staircase, seed=7, about={"subject": 7}) as session:
        session.run(present)        # present(trial) presents trial.condition, and returns the answer
    print(staircase.threshold, staircase.target)

This module needs neither an arm nor packages other than numpy. `present` may use thimble.run, a Stepper,
a real arm (thimble.open), or a question to the person.
"""

from .constant_stimuli import ConstantStimuli
from .order import Trials, balanced_row, combinations
from .psychometric import Psychometric, fit
from .session import Interleaved, Procedure, Session, Trial
from .staircase import Staircase
from .subject_log import SubjectLog, read_log

__all__ = [
    "ConstantStimuli",
    "Interleaved",
    "Procedure",
    "Psychometric",
    "Session",
    "Staircase",
    "SubjectLog",
    "Trial",
    "Trials",
    "balanced_row",
    "combinations",
    "fit",
    "read_log",
]
