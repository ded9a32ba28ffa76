"""Pictures in notebooks, and the shipped notebooks: their code runs, and they are stored without results."""

import ast
import json
import os

import pytest
import thimble

NOTEBOOKS = ["first_touch", "texture_experiment"]


@pytest.fixture
def notebook(source):
    return lambda name: json.loads((source / f"app/examples/notebooks/{name}.ipynb").read_text(encoding="utf-8"))


def _run_cell(code, names):
    """Runs a cell, and returns what a notebook displays below it: the value of its last line."""
    tree = ast.parse(code)
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, "cell", "exec"), names)
    return None if last is None else eval(compile(ast.Expression(last.value), "cell", "eval"), names)


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_code_of_each_notebook_runs_and_shows_its_results(name, notebook, tmp_path, monkeypatch):
    matplotlib = pytest.importorskip("matplotlib", reason="install python3-matplotlib")
    matplotlib.use("Agg")
    monkeypatch.chdir(tmp_path)
    names = {"__name__": "__main__"}
    shown = [_run_cell("".join(cell["source"]), names) for cell in notebook(name)["cells"] if cell["cell_type"] == "code"]
    matplotlib.pyplot.close("all")
    assert shown[0]._repr_png_().startswith(b"\x89PNG")
    if name == "first_touch":
        assert "<svg" in shown[1]._repr_html_() and "ball: stiffness" in shown[3]._repr_html_()
        assert names["softer"].force.shape == names["touch"].force.shape
        assert "largest difference" in shown[-3]._repr_html_() and all("<iframe" in one._repr_html_() for one in shown[-2:])
    else:
        assert 0.05 < names["curve"].jnd < 0.5 and len(names["session"].lines) == 84


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_notebooks_are_stored_without_results(name, notebook):
    for cell in notebook(name)["cells"]:
        assert not cell.get("outputs") and cell.get("execution_count") is None and not cell["metadata"]


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_jupyter_runs_the_notebooks_and_shows_each_picture_once(name, source, tmp_path):
    if "THIMBLE_LONG" not in os.environ:
        pytest.skip("the long form (THIMBLE_LONG=1) runs them in Jupyter's own kernel")
    for package in ("nbformat", "nbclient", "ipykernel", "matplotlib_inline"):
        pytest.importorskip(package, reason="install python3-nbclient, python3-ipykernel and python3-matplotlib")
    import nbclient
    import nbformat

    read = nbformat.read(source / f"app/examples/notebooks/{name}.ipynb", as_version=4)
    nbclient.NotebookClient(read, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    pictures = [[one for one in cell.outputs if "image/png" in one.get("data", {})] for cell in read.cells if cell.cell_type == "code"]
    assert [len(one) for one in pictures] == {"first_touch": [1, 0, 1, 0, 1, 1], "texture_experiment": [1, 1, 0, 1]}[name]


def test_shot_repeats_the_run_or_gives_the_reason(tmp_path):
    run = thimble.run("box", seconds=0.5, seed=4, set={"entry_face.stiffness": 300})
    picture = run.shot(at=0.4, size=(160, 120), caption=False)
    assert repr(picture) == "Shot(160 x 120 pixels)"
    picture.save(tmp_path / "box.png")
    assert (tmp_path / "box.png").read_bytes() == picture.png == picture._repr_png_()
    own = thimble.run("box", seconds=0.1, law=lambda tick: None)
    with pytest.raises(thimble.Error, match="custom force law. .*thimble.shot"):
        own.shot()
    with pytest.raises(thimble.Error, match="its quality was draft"):
        thimble.run("box", seconds=0.1, quality="draft").shot()
    for wrong, message in [
        ({"size": (10, 10)}, "size: expected a whole number from 64 to 8192"),
        ({"size": 5}, "size: expected 2 numbers"),
        ({"camera": (1,)}, "camera: expected 2 or 3 numbers"),
        ({"at": 1e4}, "ends at"),
    ]:
        with pytest.raises(thimble.ArgumentError, match=message):
            thimble.shot("box", **wrong)
    with pytest.raises(thimble.ArgumentError, match="Known by name"):
        thimble.shot("no_such_scene")
