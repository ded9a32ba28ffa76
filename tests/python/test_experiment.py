"""Orders, staircases and psychometric functions, tested with simulated observers and many seeds."""

import itertools
import math

import numpy as np
import pytest
import thimble
from thimble import experiment


def logistic(x, middle, width, guess=0.5, lapse=0.0):
    return guess + (1 - guess - lapse) / (1 + np.exp(-(x - middle) / width))


def test_all_combinations_come_equally_often_in_every_order():
    factors = {"amplitude": [1e-5, 2e-5], "speed": [0.02, 0.05, 0.1]}
    for order in ("given", "random", "blocks", "balanced"):
        trials = experiment.Trials(factors, repeats=4, order=order, seed=3, subject=0)
        shown = [(one["amplitude"], one["speed"]) for one in trials.conditions]
        assert len(shown) == 24 and all(shown.count(one) == 4 for one in itertools.product(*factors.values()))
        again = experiment.Trials(factors, repeats=4, order=order, seed=3, subject=0)
        assert again.conditions == trials.conditions
        other = experiment.Trials(factors, repeats=4, order=order, seed=4, subject=0).conditions
        assert (other != trials.conditions) == (order in ("random", "blocks"))
    blocks = experiment.Trials(factors, repeats=4, order="blocks", seed=3).conditions
    for at in range(0, 24, 6):
        assert len({tuple(one.values()) for one in blocks[at : at + 6]}) == 6


@pytest.mark.parametrize("count", [2, 3, 4, 5, 8])
def test_balanced_orders_balance_positions_and_neighbours(count):
    subjects = count * (1 + count % 2)
    rows = [experiment.balanced_row(count, subject) for subject in range(subjects)]
    for column in zip(*rows):
        assert all(column.count(one) == subjects // count for one in range(count))
    pairs = [pair for row in rows for pair in zip(row, row[1:])]
    expected = subjects // count
    assert all(pairs.count(pair) == expected for pair in itertools.permutations(range(count), 2))


def run(staircase, probability, random):
    while (condition := staircase.condition()) is not None:
        staircase.take({"correct": bool(random.random() < probability(condition["level"]))})
    return staircase


@pytest.mark.parametrize("down, up, target", [(1, 1, 0.5), (2, 1, 0.7071), (3, 1, 0.7937), (1, 2, 0.2929), (2, 2, 0.5)])
def test_target_is_where_steps_balance(down, up, target):
    assert experiment.Staircase(1, 0.1, down=down, up=up).target == pytest.approx(target, abs=1e-4)


def test_weighted_steps_move_the_target():
    # Up by three steps, down by one: at equilibrium three of four answers are correct.
    assert experiment.Staircase(1, 0.1, down=1, up_ratio=3).target == pytest.approx(0.75, abs=1e-9)


@pytest.mark.parametrize(
    "down, ratio, guess, widest",
    [(2, 1.0, 0.5, 0.7), (3, 1.0, 0.5, 0.5), (1, 3.0, 0.5, 0.85), (1, 1.0, 0.0, 0.45)],
)
def test_staircase_converges_to_the_known_threshold(down, ratio, guess, widest):
    middle, width = 10.0, 1.0
    found = []
    for seed in range(400):
        random = np.random.default_rng([seed, down])
        staircase = experiment.Staircase(
            15, [2, 1, 0.5], down=down, up_ratio=ratio, reversals=24, last=20, lowest=0
        )
        found.append(run(staircase, lambda x: logistic(x, middle, width, guess), random).threshold)
    part = (staircase.target - guess) / (1 - guess)
    known = middle + width * math.log(part / (1 - part))
    bias, spread = np.mean(found) - known, np.std(found)
    print(f"{down} down: bias {bias:.3f}, spread {spread:.3f} widths, {len(staircase.levels)} trials")
    assert abs(bias) < 0.15 * width
    assert spread < widest * width


def test_multiplied_steps_are_invariant_to_the_unit():
    found = {}
    for unit in (1.0, 1e-6):
        thresholds = []
        for seed in range(100):
            staircase = experiment.Staircase(40 * unit, [2, 1.4, 1.15], down=3, multiply=True, reversals=16, last=12)
            run(staircase, lambda x: logistic(np.log(x / unit), np.log(10), 0.2), np.random.default_rng(seed))
            thresholds.append(staircase.threshold / unit)
        found[unit] = np.array(thresholds)
    np.testing.assert_allclose(found[1.0], found[1e-6], rtol=1e-9)
    part = (0.7937 - 0.5) / 0.5
    known = 10 * math.exp(0.2 * math.log(part / (1 - part)))
    assert np.exp(np.mean(np.log(found[1.0]))) == pytest.approx(known, rel=0.05)
    assert np.std(np.log(found[1.0])) < 0.15


def test_staircase_step_by_step():
    staircase = experiment.Staircase(10, [4, 1], down=2, up=1, reversals=3, last=2, lowest=0, highest=12)
    assert math.isnan(staircase.threshold)
    for correct in (1, 1, 1, 1, 0, 1, 1, 0):
        staircase.take({"correct": bool(correct)})
    assert staircase.levels == [10, 10, 6, 6, 2, 3, 3, 2]
    assert staircase.reversals == [2, 3, 2] and staircase.over and staircase.condition() is None
    assert staircase.threshold == 2.5 and staircase.spread == pytest.approx(math.sqrt(0.5))
    # It stays within its bounds, and ends by the number of trials if its direction never changes.
    staircase = experiment.Staircase(10, 4, down=1, lowest=0, max_trials=10)
    while staircase.condition() is not None:
        staircase.take({"correct": True})
    assert staircase.levels == [10, 6, 2] + [0] * 7


@pytest.mark.parametrize("shape", ["logistic", "probit"])
@pytest.mark.parametrize("guess", [0.0, 0.5])
def test_fit_recovers_parameters_with_correct_standard_errors(shape, guess):
    levels = np.linspace(7, 13, 9)
    true = experiment.Psychometric(shape, 10.0, 1.5, guess, 0.0, 0.0, 0.0, 0.0)
    fits = []
    for seed in range(200):
        random = np.random.default_rng(seed)
        fits.append(experiment.fit(levels, random.binomial(120, true(levels)), 120, shape=shape, guess=guess))
    middles, widths = np.array([one.middle for one in fits]), np.array([one.width for one in fits])
    assert np.mean(middles) == pytest.approx(10, abs=0.1)
    assert np.mean(widths) == pytest.approx(1.5, rel=0.06)
    # The standard errors agree with the scatter of the fits, and 95 % of intervals contain the truth.
    errors = np.array([one.middle_error for one in fits])
    assert np.mean(errors) == pytest.approx(np.std(middles), rel=0.15)
    held = np.abs(middles - 10) < 1.96 * errors
    assert 0.9 < np.mean(held) < 0.99
    width_errors = np.array([one.width_error for one in fits])
    assert np.mean(width_errors) == pytest.approx(np.std(widths), rel=0.2)
    assert np.mean([one.deviance for one in fits]) == pytest.approx(len(levels) - 2, rel=0.2)


@pytest.mark.parametrize("shape", ["logistic", "probit"])
def test_fit_is_the_likeliest_curve_near_it(shape):
    levels, message, of = [1, 2, 3, 4, 5], [1, 4, 11, 17, 19], [20, 20, 20, 20, 20]
    found = experiment.fit(levels, message, of, shape=shape)

    def likelihood(middle, width):
        p = experiment.Psychometric(shape, middle, width, 0, 0, 0, 0, 0)(levels)
        return float(np.sum(np.array(message) * np.log(p) + (20 - np.array(message)) * np.log(1 - p)))

    best = likelihood(found.middle, found.width)
    for middle, width in itertools.product((0.98, 1, 1.02), (0.95, 1, 1.05)):
        if (middle, width) != (1, 1):
            assert likelihood(found.middle * middle, found.width * width) < best


def test_fit_is_invariant_to_grouping_and_unit():
    levels, message = [1, 2, 3, 4, 5], [1, 4, 11, 17, 19]
    counted = experiment.fit(levels, message, 20)
    single = experiment.fit(np.repeat(levels, 20), np.concatenate([np.arange(20) < one for one in message]))
    assert single == counted
    small = experiment.fit(np.array(levels) * 1e-6 + 7e-6, message, 20)
    assert small.middle == pytest.approx(counted.middle * 1e-6 + 7e-6) and small.width == pytest.approx(counted.width * 1e-6)


def test_levels_of_a_probability_and_the_jnd():
    for shape in ("logistic", "probit"):
        curve = experiment.Psychometric(shape, 10.0, 2.0, 0.5, 0.02, 0, 0, 0)
        for p in (0.6, 0.75, 0.9):
            assert float(curve(curve.level(p))) == pytest.approx(p, abs=1e-9)
        with pytest.raises(thimble.ArgumentError, match="does not reach"):
            curve.level(0.99)
        curve = experiment.Psychometric(shape, 10.0, 2.0, 0, 0, 0, 0, 0)
        assert curve.jnd == pytest.approx((curve.level(0.75) - curve.level(0.25)) / 2)


def test_lapses_are_found_and_do_not_widen_the_curve():
    levels = np.linspace(4, 16, 9)
    widths, lapses = {"fit": [], 0.0: []}, []
    for seed in range(30):
        message = np.random.default_rng(seed).binomial(200, logistic(levels, 10, 0.8, 0.5, 0.04))
        for lapse in widths:
            found = experiment.fit(levels, message, 200, guess=0.5, lapse=lapse)
            widths[lapse].append(found.width)
        lapses.append(experiment.fit(levels, message, 200, guess=0.5, lapse="fit").lapse)
    assert np.mean(lapses) == pytest.approx(0.04, abs=0.01)
    assert np.mean(widths["fit"]) == pytest.approx(0.8, rel=0.1)
    assert np.mean(widths[0.0]) > 1.15 * np.mean(widths["fit"])


def test_fit_warns_without_a_width_and_refuses_flat_answers():
    with pytest.warns(RuntimeWarning, match="do not determine the width"):
        found = experiment.fit([1, 2, 3, 4], [0, 0, 10, 10], 10)
    assert 2 < found.middle < 3 and math.isnan(found.middle_error) and math.isnan(found.width_error)
    with pytest.warns(RuntimeWarning, match="do not determine the width"):  # the attribute exists without a value
        found = experiment.fit([1, 2, 3, 4], [5, 6, 10, 10], 10, guess=0.5)
    assert math.isnan(found.middle_error) and math.isnan(found.width_error)
    for message in ([5, 5, 5], [9, 5, 1], [10, 10, 10], [0, 0, 0]):
        with pytest.raises(thimble.ArgumentError, match="do not rise"):
            experiment.fit([1, 2, 3], message, 10)


def test_constant_stimuli_are_balanced_over_subjects():
    rows = []
    for subject in range(4):
        stimuli = experiment.ConstantStimuli([1, 2, 3, 4], 1, order="balanced", subject=subject)
        rows.append([one["level"] for one in stimuli.conditions])
    for column in zip(*rows):
        assert sorted(column) == [1, 2, 3, 4]


def dense_loss(x, k, n, guess, lapse):
    """Returns the minimum loss of logistic curves over a grid much finer than the start grid of fit()."""
    x = (x - x[0]) / (x[-1] - x[0])
    middles, widths = np.linspace(-0.5, 1.5, 201), np.exp(np.linspace(math.log(0.002), math.log(20), 160))
    z = (x - middles[:, None, None]) / widths[None, :, None]
    p = np.clip(guess + (1 - guess - lapse) * 0.5 * (1 + np.tanh(0.5 * z)), 1e-12, 1 - 1e-12)
    return float(-(k * np.log(p) + (n - k) * np.log(1 - p)).sum(axis=2).min())


@pytest.mark.filterwarnings("ignore:The answers do not hold:RuntimeWarning")
@pytest.mark.parametrize("guess", [0.0, 0.5])
def test_fit_is_at_least_as_likely_as_a_dense_grid(guess):
    random = np.random.default_rng(7)
    fits = 0
    for _ in range(200):
        x = np.sort(random.choice(np.linspace(0, 1, 21), random.integers(3, 9), replace=False))
        n = np.full(len(x), float(random.integers(2, 20)))
        width = math.exp(random.uniform(math.log(0.02), math.log(0.5)))
        k = random.binomial(n.astype(int), logistic(x, random.uniform(0, 1), width, guess, 0.02)).astype(float)
        try:
            curve = experiment.fit(x, k, n, guess=guess, lapse=0.02)
        except thimble.ArgumentError:  # answers that do not increase with the level
            continue
        p = np.clip(curve(x), 1e-12, 1 - 1e-12)
        own = float(-(k * np.log(p) + (n - k) * np.log(1 - p)).sum())
        assert own < dense_loss(x, k, n, guess, 0.02) + 1e-3, (x, k, n)
        fits += 1
    assert fits > 120


def test_constant_stimuli_fit_their_answers():
    stimuli = experiment.ConstantStimuli(np.linspace(0.7, 1.3, 7), 40, answer_key="rougher", seed=5)
    random = np.random.default_rng(2)
    while (condition := stimuli.condition()) is not None:
        stimuli.take({"rougher": bool(random.random() < logistic(condition["level"], 1.0, 0.06, guess=0))})
    levels, _, totals = stimuli.counts()
    assert (totals == 40).all() and len(levels) == 7
    curve = stimuli.fit()
    assert abs(curve.middle - 1) < 3 * curve.middle_error and curve.jnd == pytest.approx(0.06 * math.log(3), rel=0.3)


@pytest.mark.parametrize(
    "wrong, message",
    [
        (lambda: experiment.Staircase(1, 0), "step"),
        (lambda: experiment.Staircase(1, 0.5, multiply=True), "above 1"),
        (lambda: experiment.Staircase(1, 1, last=20), "last"),
        (lambda: experiment.Staircase(5, 1, highest=2), "between the bounds"),
        (lambda: experiment.Staircase(1, 1).take({"right": True}), "correct=True or False"),
        (lambda: experiment.Trials({"a": [1]}, order="wild"), "given, random, blocks, balanced"),
        (lambda: experiment.Trials({"a": []}), "at least one"),
        (lambda: experiment.Trials({"a": [1, 2]}, order="balanced"), "subject: .*requires the number"),
        (lambda: experiment.ConstantStimuli([1, 2], 2, order="balanced"), "subject: .*requires the number"),
        (lambda: experiment.Trials({"a": [1, 2]}, order="balanced", subject=-1), "subject: expected a whole number"),
        (lambda: experiment.ConstantStimuli([1, 2], 2).take({}), "correct=True or False"),
        (lambda: experiment.Interleaved({}), "at least one"),
        (lambda: experiment.fit([1, 1], [0, 1]), "two or more"),
        (lambda: experiment.fit([1, 2], [3, 1], 2), "successes 0 to totals"),
        (lambda: experiment.fit([1, 2], [0, 1], shape="cubic"), "logistic"),
        (lambda: experiment.fit([1, 2], [0, 1], guess=0.5, lapse=0.6), "lapse"),
    ],
)
def test_wrong_arguments_raise_a_clear_error(wrong, message):
    with pytest.raises(thimble.ArgumentError, match=message):
        wrong()


def test_old_names_work_with_a_warning_that_gives_the_new_name():
    with pytest.warns(DeprecationWarning, match="trials_most= is deprecated; use max_trials="):
        staircase = experiment.Staircase(10, 4, trials_most=10)
    assert staircase.plan() == experiment.Staircase(10, 4, max_trials=10).plan()
    with pytest.warns(DeprecationWarning, match="says= is deprecated; use answer_key="):
        stimuli = experiment.ConstantStimuli([1, 2], 3, says="rougher")
    assert stimuli.answer_key == "rougher"
    assert stimuli.plan() == experiment.ConstantStimuli([1, 2], 3, answer_key="rougher").plan()
    with pytest.warns(DeprecationWarning, match="answer_key"):
        assert stimuli.says == "rougher"
    with pytest.raises(TypeError, match="max_trials"):
        experiment.Staircase(10, 4, max_trials=20, trials_most=10)
    with pytest.raises(TypeError, match="answer_key"):
        experiment.ConstantStimuli([1, 2], 3, answer_key="rougher", says="rougher")
