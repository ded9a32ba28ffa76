"""Sessions: the log of a subject, and its continuation after an interruption."""

import contextlib
import json
import os
import re
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
import thimble
from thimble import experiment


def staircases(start=8.0):
    return experiment.Interleaved(
        {
            "fine": experiment.Staircase(start, [2, 1], down=2, reversals=8, last=4, lowest=0),
            "coarse": experiment.Staircase(12, [2, 1], down=3, reversals=6, last=4, lowest=0),
        },
        seed=3,
    )


def felt(trial):
    """A subject whose answers depend on the random numbers of the trial."""
    level = trial.condition["level"] + (1.0 if trial.condition["track"] == "coarse" else 0.0)
    felt = level + 2.0 * trial.random.normal()
    return {"correct": bool(felt > 6), "felt": np.float64(felt), "heard": (1, 2)}


def whole(path):
    with experiment.Session(path, staircases(), seed=7, about={"subject": 7}) as session:
        session.run(felt)
        return session.procedure.tracks["fine"].threshold


def test_every_trial_is_a_line(tmp_path):
    threshold = whole(tmp_path / "a.jsonl")
    text = (tmp_path / "a.jsonl").read_text()
    assert text.endswith("}\n")
    about, *trials = map(json.loads, text.splitlines())
    assert about["seed"] == 7 and about["about"] == {"subject": 7} and "tracks" in about["plan"]
    assert [one["trial"] for one in trials] == list(range(len(trials))) and len(trials) > 20
    assert {one["condition"]["track"] for one in trials} == {"fine", "coarse"}
    assert (about, trials) == experiment.read_log(tmp_path / "a.jsonl")
    whole(tmp_path / "b.jsonl")
    assert (tmp_path / "b.jsonl").read_text() == text and np.isfinite(threshold)


def test_line_is_written_before_the_next_trial(tmp_path):
    path = tmp_path / "a.jsonl"

    def present(trial):
        assert path.read_bytes().count(b"\n") == 1 + trial.number
        return felt(trial)

    with experiment.Session(path, staircases(), seed=7, about={"subject": 7}) as session:
        session.run(present)


def test_each_line_is_synced_to_disk(tmp_path, monkeypatch):
    synced = []
    sync = os.fsync
    monkeypatch.setattr(os, "fsync", lambda number: (synced.append(os.fstat(number).st_size), sync(number)))
    with contextlib.closing(experiment.SubjectLog(tmp_path / "a.jsonl", {"a": 1})) as log:
        first = len(synced)
        for number in range(3):
            log.write({"trial": number})
            assert len(synced) == first + number + 1 and synced[-1] == os.path.getsize(log.path)


@pytest.mark.parametrize("stop", [0, 1, 5, 17])
def test_interrupted_session_continues_with_the_same_trials(stop, tmp_path):
    whole(tmp_path / "whole.jsonl")

    def leaves(trial):
        if trial.number == stop:
            raise KeyboardInterrupt
        return felt(trial)

    path = tmp_path / "left.jsonl"
    with pytest.raises(KeyboardInterrupt):
        with experiment.Session(path, staircases(), seed=7, about={"subject": 7}) as session:
            session.run(leaves)
    with experiment.Session(path, staircases(), seed=7, about={"subject": 7}) as session:
        assert session.resumed == stop and session.trial.number == stop
        session.run(felt)
        assert session.trial is None
        with pytest.raises(thimble.Error, match="over"):
            session.answer(True)
    assert path.read_bytes() == (tmp_path / "whole.jsonl").read_bytes()
    assert whole(path) == whole(tmp_path / "whole.jsonl")  # a complete log is only read


def test_incomplete_last_line_is_dropped_with_a_warning(tmp_path):
    whole(tmp_path / "whole.jsonl")
    text = (tmp_path / "whole.jsonl").read_bytes()
    lines = text.splitlines(keepends=True)
    path = tmp_path / "cut.jsonl"
    before = b"".join(lines[:6])
    tails = [lines[6][:cut] for cut in (1, 20, len(lines[6]) - 1)] + [b"\0" * 40, b"\0" * 40 + b"\n"]
    for tail in tails:
        path.write_bytes(before + tail)
        with pytest.warns(RuntimeWarning, match="incomplete"):
            session = experiment.Session(path, staircases(), seed=7, about={"subject": 7})
        with session:
            assert session.resumed == 5 and path.read_bytes() == before
            session.run(felt)
        assert path.read_bytes() == text
    path.write_bytes(lines[0][:10])  # the log ends within its first line
    with pytest.warns(RuntimeWarning, match="incomplete"):
        whole(path)
    assert path.read_bytes() == text


def test_log_of_another_experiment_is_not_changed(tmp_path):
    path = tmp_path / "a.jsonl"
    whole(path)
    text = path.read_bytes()
    for other, message in (
        (lambda: experiment.Session(path, staircases(), seed=8, about={"subject": 7}), "different seed"),
        (lambda: experiment.Session(path, staircases(), seed=7, about={"subject": 8}), "different about"),
        (lambda: experiment.Session(path, staircases(9.0), seed=7, about={"subject": 7}), "different plan"),
    ):
        with pytest.raises(thimble.Error, match=message):
            other()
    damaged = text.replace(b'"trial": 3', b'"trial" 3')
    path.write_bytes(damaged)
    with pytest.raises(thimble.Error, match=r"a\.jsonl:5: not a line"):
        whole(path)
    exchanged = text.replace(b'"trial": 3', b'"trial": 4')
    path.write_bytes(exchanged)
    with pytest.raises(thimble.Error, match="trial 3 is not the one"):
        whole(path)
    assert path.read_bytes() == exchanged
    path.write_bytes(text)
    with pytest.raises(thimble.Error, match="cannot be written"):
        whole(tmp_path / "no" / "such.jsonl")
    with pytest.raises(thimble.Error, match="is not the log"):
        experiment.read_log(__file__)


def test_only_one_session_may_use_a_log(tmp_path):
    path = tmp_path / "a.jsonl"
    with experiment.Session(path, staircases(), seed=7):
        with pytest.raises(thimble.Error, match="in use"):
            experiment.Session(path, staircases(), seed=7)
    experiment.Session(path, staircases(), seed=7).close()


def test_refused_answer_is_not_logged(tmp_path):
    path = tmp_path / "a.jsonl"
    with experiment.Session(path, staircases(), seed=7) as session:
        begun = path.read_bytes()
        for answer, message in (({"right": True}, "correct=True"), ({"correct": True, "x": object()}, "cannot hold")):
            with pytest.raises(thimble.ArgumentError, match=message):
                session.answer(answer)
        with pytest.raises(thimble.ArgumentError, match="cannot hold"):
            session.answer({"correct": True, "x": float("nan")})
        assert path.read_bytes() == begun and session.trial.number == 0
        session.answer(np.True_)
        assert session.lines[-1]["answer"] == {"correct": True}


SUBJECT = """
import sys, time
sys.path.insert(0, {here!r})
from test_session import felt, staircases
from thimble import experiment

def slowly(trial):
    print(trial.number, flush=True)
    if trial.number >= {slow}:
        time.sleep(0.5)
    return felt(trial)

with experiment.Session(sys.argv[1], staircases(), seed=7, about={{"subject": 7}}) as session:
    session.run(slowly)
"""


@pytest.mark.parametrize("at", [0, 3, 11, 12])
def test_killed_session_continues_with_the_next_trial(at, tmp_path):
    whole(tmp_path / "whole.jsonl")
    text = (tmp_path / "whole.jsonl").read_bytes()
    path = tmp_path / "killed.jsonl"
    script = SUBJECT.format(here=os.path.dirname(__file__), slow=at)
    with subprocess.Popen([sys.executable, "-B", "-c", script, path], stdout=subprocess.PIPE, text=True) as subject:
        while int(subject.stdout.readline()) < at:
            pass
        subject.send_signal(signal.SIGKILL)
        assert subject.wait(timeout=30) == -signal.SIGKILL
    left = path.read_bytes()
    assert text.startswith(left) and left.count(b"\n") >= 1 + at and len(left) < len(text)
    whole(path)
    assert path.read_bytes() == text


def test_example_finds_the_parameters_of_its_subject(source, tmp_path):
    example = [sys.executable, "-B", source / "app/examples/10_texture_discrimination.py", tmp_path]
    log = tmp_path / "staircase.jsonl"
    with subprocess.Popen(example, stdout=subprocess.DEVNULL) as left:
        while left.poll() is None and not (log.exists() and log.read_bytes().count(b"\n") > 5):
            time.sleep(0.005)
        left.kill()
    message = subprocess.run(example, check=True, capture_output=True, text=True).stdout
    assert re.search(r"Continues after [1-9]", message)
    # Noise of 0.1 and strokes with a scatter of 0.2: sqrt(2) * 0.22 * 0.674 is 21 %.
    threshold = float(re.search(r"identified in 79 % at ([0-9.]+)", message)[1])
    equal, jnd = (float(one) for one in re.search(r"equal at ([0-9.]+) .*JND ([0-9.]+) %", message).groups())
    assert 1.15 < threshold < 1.5 and 0.85 < equal < 1.15 and 14 < jnd < 30
    assert len(experiment.read_log(tmp_path / "constant.jsonl")[1]) == 112
