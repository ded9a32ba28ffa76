"""Slices, pickles, tables and pictures of ticks."""

import multiprocessing
import pickle

import numpy as np
import pytest
import thimble


@pytest.fixture(scope="module")
def run():
    return thimble.run("water_balloon", seconds=3)


def test_slices_masks_and_lists_return_ticks(run):
    part = run[1000:1010]
    assert type(part) is thimble.Ticks and len(part) == 10
    assert (part.time == run.time[1000:1010]).all() and (part.tip == run.tip[1000:1010]).all()
    felt = run[run.in_contact]
    assert 0 < len(felt) < len(run) and felt.in_contact.all() and felt.depth.min() > 0
    assert (run[::-3].in_contact == run.in_contact[::-3]).all()
    assert (run[[5, 3]].time == [run[5].time, run[3].time]).all()
    assert [tick.time for tick in run[:3]] == list(run.time[:3])
    assert run[-1].time == run.time[-1] and len(run[5000:]) == 0
    with pytest.raises(IndexError):
        run[3000]


def test_pickled_run_keeps_all_its_results(run):
    kept = pickle.loads(pickle.dumps(run))
    assert type(kept) is thimble.Run and kept.columns.tobytes() == run.columns.tobytes()
    assert kept.summary() == run.summary() and kept.figures() == run.figures() and kept.info == run.info
    assert (kept.end, kept.stride, kept.objects) == (run.end, run.stride, run.objects)
    for name in (None, *run.objects):
        for mine, its in zip(kept.mesh(name), run.mesh(name)):
            assert (mine == its).all()
    with pytest.raises(thimble.Error, match="no object"):
        kept.mesh("no_such_object")
    again = pickle.loads(pickle.dumps(kept))
    assert again.summary() == run.summary()
    part = pickle.loads(pickle.dumps(run[:7]))
    assert (part.force == run.force[:7]).all()


def _feel(seed):
    return thimble.run("box", seconds=0.2, seed=seed)


def test_runs_come_back_from_other_processes():
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        felt = pool.map(_feel, [1, 2])
    assert felt[0].columns.tobytes() == _feel(1).columns.tobytes()
    assert felt[1].columns.tobytes() != felt[0].columns.tobytes()


def test_notebooks_show_figures_and_curves(run):
    html = run._repr_html_()
    assert "water_balloon, vintage_phantom" in html and "3000 ticks" in html
    assert html.count("<svg") == 2 and f"to {1e3 * run.depth.max():.4g}" in html
    assert all(f"<td>{figure.name}</td>" in html for figure in run.figures())
    assert "http" not in html and "<script" not in html
    part = run[:10]._repr_html_()
    assert "10 ticks" in part and "<table" not in part
    assert "0 ticks" in run[:0]._repr_html_()
    named = thimble.Recording({"scene": "<b>", "arm": "&"}, run.columns, True)
    assert "&lt;b&gt;, &amp;" in named._repr_html_() and "<b><b>" not in named._repr_html_()


def test_pandas_gets_every_column_over_time(run):
    pytest.importorskip("pandas", reason="install python3-pandas")
    table = run.to_pandas()
    assert table.index.name == "seconds" and len(table) == 3000
    np.testing.assert_array_equal(table.index, run.time)
    np.testing.assert_array_equal(table[["p_WT_x", "p_WT_y", "p_WT_z"]], run.tip)
    np.testing.assert_array_equal(table["depth"], run.depth)
    assert {"q_WT_0", "q_WT_3", "in_contact"} <= set(table.columns)


def test_pandas_numbers_joints_and_motors(run):
    pytest.importorskip("pandas", reason="install python3-pandas")
    table = run.to_pandas()
    for name in ("q", "counts", "heat", "gimbal"):
        assert {f"{name}_{k}" for k in range(3)} <= set(table.columns)
        assert f"{name}_x" not in table.columns
    np.testing.assert_array_equal(table[["q_0", "q_1", "q_2"]], run.joints)


def test_matplotlib_draws_force_and_depth(run, tmp_path):
    matplotlib = pytest.importorskip("matplotlib", reason="install python3-matplotlib")
    matplotlib.use("Agg")
    figure = run.plot()
    force, depth = figure.axes
    np.testing.assert_array_equal(force.lines[2].get_ydata(), run.force[:, 2])
    np.testing.assert_allclose(depth.lines[0].get_ydata(), 1e3 * run.depth)
    figure.savefig(tmp_path / "run.png")
    assert (tmp_path / "run.png").read_bytes()[1:4] == b"PNG"


def test_missing_packages_are_reported(run, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "pandas", None)
    monkeypatch.setitem(__import__("sys").modules, "matplotlib", None)
    with pytest.raises(ImportError, match="python3-pandas"):
        run.to_pandas()
    with pytest.raises(ImportError, match="python3-matplotlib"):
        run.plot()
