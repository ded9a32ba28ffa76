"""Docstrings and types of the package."""

import ast
import inspect
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
import thimble
import thimble.experiment
import thimble.gym
from thimble import _core

PACKAGE = Path(thimble.__file__).parent


def _public(members):
    return {name for name in members if not name.startswith("_") or name in ("__init__", "__len__")}


def test_stub_file_lists_exactly_the_members_of_core():
    tree = ast.parse((PACKAGE / "_core.pyi").read_text(encoding="utf-8"))
    stub = {node.name: node for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
    values = {node.target.id for node in tree.body if isinstance(node, ast.AnnAssign)}
    assert set(stub) | values == _public(vars(_core))
    for name, node in stub.items():
        here = getattr(_core, name)
        if isinstance(node, ast.FunctionDef):
            _same_arguments(node, here)
            continue
        if issubclass(here, Exception):
            assert [base.id for base in node.bases] == [base.__name__ for base in here.__bases__]
            continue
        members = {one.name: one for one in node.body if isinstance(one, ast.FunctionDef)}
        assert set(members) == _public(vars(here)), name
        for method, stub_function in members.items():
            if not isinstance(vars(here)[method], property):
                _same_arguments(stub_function, getattr(here, method))


def _same_arguments(stub_function, here):
    """Compares a stub with the first line of a docstring, where pybind11 writes the arguments."""
    first = here.__doc__.splitlines()[0]
    arguments = [one.arg for one in stub_function.args.args + stub_function.args.kwonlyargs if one.arg != "self"]
    named = [part.split(":")[0].strip() for part in _split(first[first.index("(") + 1 : first.rindex(") ->")])]
    assert len(arguments) == len([one for one in named if one not in ("self", "*")]), first
    for asked, name in zip(arguments, [one for one in named if one not in ("self", "*")]):
        assert name == asked or re.fullmatch(r"arg\d", name), first


def _split(text):
    """Splits a text at commas outside brackets."""
    parts, depth = [""], 0
    for letter in text:
        depth += (letter in "([") - (letter in ")]")
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return [one for one in parts if one.strip()]


@pytest.mark.parametrize("module", [thimble, thimble.gym, thimble.experiment])
def test_public_functions_have_docstrings_and_types(module):
    for name in module.__all__:
        one = getattr(module, name)
        assert inspect.getdoc(one), name
        members = [one] if inspect.isfunction(one) else [m for k, m in vars(one).items() if not k.startswith("_")] if inspect.isclass(one) else []
        for member in members:
            function = member.fget if isinstance(member, property) else member
            if not inspect.isfunction(function):
                continue
            assert function.__doc__ or name in ("FinishedRun",), f"{name}.{function.__name__}"
            signature = inspect.signature(function)
            assert signature.return_annotation is not inspect.Signature.empty, f"{name}.{function.__name__}"
            for argument in signature.parameters.values():
                assert argument.name == "self" or argument.annotation is not inspect.Parameter.empty, f"{name}.{function.__name__}"


def test_mypy_accepts_all_types(tmp_path):
    if "THIMBLE_LONG" not in os.environ:
        pytest.skip("the long form (THIMBLE_LONG=1) runs mypy")
    pytest.importorskip("mypy", reason="install mypy")
    settings = tmp_path / "mypy.ini"
    settings.write_text("[mypy]\ndisallow_untyped_defs = True\ndisallow_any_generics = True\nwarn_unreachable = True\nignore_missing_imports = True\n")
    allowed = tmp_path / "allowed"
    allowed.write_text("thimble._core.Run\nthimble._core.SimulatorSession\n")  # pybind11's metaclass; another test compares the members
    for command in (["mypy", "--config-file", str(settings), "--cache-dir", str(tmp_path), "-p", "thimble"],
                    ["mypy.stubtest", "thimble._core", "--concise", "--allowlist", str(allowed)]):
        stub_function = subprocess.run([sys.executable, "-m", *command], capture_output=True, text=True, check=False, cwd=PACKAGE.parent)
        assert stub_function.returncode == 0, stub_function.stdout + stub_function.stderr
