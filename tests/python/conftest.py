"""Fixtures: the program and the sources. PYTHONPATH has the built package."""

import os
import subprocess
from pathlib import Path

import pytest


@pytest.fixture
def program() -> str:
    return os.environ["THIMBLE_PROGRAM"]


@pytest.fixture
def source() -> Path:
    return Path(os.environ["THIMBLE_SOURCE"])


@pytest.fixture
def run_program(program, tmp_path):
    """Runs the program in a separate folder, and returns its output."""

    def run_in_folder(*arguments: str) -> str:
        return subprocess.run(
            [program, *arguments], cwd=tmp_path, check=True, capture_output=True, text=True
        ).stdout

    return run_in_folder
