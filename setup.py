"""Builds the compiled part of the Python package with CMake; everything else is in pyproject.toml."""
import os
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent


class CMakeBuild(build_ext):
    """$SACCADE_BUILD_DIR may name a build folder that is there already, build/release for instance."""

    def build_extension(self, extension):
        stated = os.environ.get("SACCADE_BUILD_DIR")
        folder = pathlib.Path(stated or ROOT / "build" / "pip").resolve()
        if not stated:
            subprocess.run(["cmake", "--preset", "release", "-B", str(folder), "-DSACCADE_UNITY_BUILD=ON",
                            "-DSACCADE_BUILD_TESTS=OFF", f"-DPython_EXECUTABLE={sys.executable}"], cwd=ROOT, check=True)
        subprocess.run(["cmake", "--build", str(folder), "--parallel", "--target", "saccade_python"], check=True)
        built = list((folder / "python" / "saccade").glob("_native*.so"))
        if len(built) != 1:
            sys.exit(f"{folder} holds no Python module; it needs pybind11-dev, python3-dev and python3-numpy")
        target = pathlib.Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(built[0], target)


version = re.search(r"project\(saccade VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
setup(version=version, ext_modules=[Extension("saccade._native", [])], cmdclass={"build_ext": CMakeBuild})
