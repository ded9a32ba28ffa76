"""Builds the wheel: CMake builds module and program, and installs their files next to the module.

If the environment variable THIMBLE_BUILD_FOLDER names a build folder (preset release), its files are used.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

SOURCE = Path(__file__).resolve().parent


class BuildByCMake(build_ext):
    """Fills the package's folder of the wheel: _core, bin/thimble, libexec/thimble, lib/thimble, share/thimble."""

    def build_extension(self, ext: Extension) -> None:
        package = Path(self.get_ext_fullpath(ext.name)).resolve().parent
        build = os.environ.get("THIMBLE_BUILD_FOLDER")
        if build is None:
            build = str(Path(self.build_temp).resolve())
            self._build(build)
        modules = list(Path(build, "app/python/thimble").glob("_core*.so"))
        if len(modules) != 1:
            sys.exit(f"{build} has no Python module. Install python3-dev and pybind11-dev, and build again.")
        package.mkdir(parents=True, exist_ok=True)
        shutil.copy2(modules[0], package)
        for component in ("program", "viewer", "studies", "mesh_formats", "compat"):
            self._run("cmake", "--install", build, "--prefix", str(package), "--component", component, "--strip")

    def _build(self, build: str) -> None:
        preset = ["-D", "CMAKE_BUILD_TYPE=Release", "-D", "CMAKE_CXX_FLAGS_RELEASE=-O3 -DNDEBUG"]
        if shutil.which("ninja"):
            preset += ["-G", "Ninja"]
        self._run("cmake", "-S", str(SOURCE), "-B", build, *preset, "-D", "THIMBLE_TESTS=OFF",
                  "-D", f"Python_EXECUTABLE={sys.executable}")
        targets = ["thimble", "thimble_python", "thimble_compat_libraries"]
        self._run("cmake", "--build", build, "--parallel", str(os.cpu_count() or 1), "--target", *targets)

    @staticmethod
    def _run(*command: str) -> None:
        subprocess.run(command, check=True)


def numpy_of_pybind11() -> str:
    """Returns the versions of numpy that the module will work with: pybind11 knows numpy 2 from 2.12 on."""
    asked = subprocess.run(["pkg-config", "--modversion", "pybind11"], capture_output=True, text=True, check=False)
    major, minor = (int(one) for one in (re.findall(r"\d+", asked.stdout) + ["0", "0"])[:2])
    return "numpy" if (major, minor) >= (2, 12) else "numpy<2"


version = re.search(r"project\(thimble VERSION ([0-9.]+)", (SOURCE / "CMakeLists.txt").read_text())
assert version is not None
setup(
    version=version[1],
    install_requires=[numpy_of_pybind11()],
    ext_modules=[Extension("thimble._core", sources=[])],
    cmdclass={"build_ext": BuildByCMake},
)
