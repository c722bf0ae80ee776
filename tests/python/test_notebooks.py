"""The notebooks run from their first cell to their last; skipped where nbconvert is not installed."""
import os
import pathlib

import pytest

import saccade
from conftest import ROOT

nbconvert = pytest.importorskip("nbconvert")
nbformat = pytest.importorskip("nbformat")
pytest.importorskip("ipykernel")

NOTEBOOKS = sorted((ROOT / "examples" / "notebooks").glob("*.ipynb"))


def test_there_are_five():
    assert len(NOTEBOOKS) >= 5


@pytest.mark.parametrize("file", NOTEBOOKS, ids=lambda file: file.stem)
def test_it_runs(file, tmp_path, monkeypatch):
    from nbconvert.preprocessors import ExecutePreprocessor
    monkeypatch.setenv("PYTHONPATH", str(pathlib.Path(saccade.__file__).resolve().parents[1]))
    monkeypatch.setenv("MPLBACKEND", "module://matplotlib_inline.backend_inline")
    os.symlink(ROOT / "configs", tmp_path / "configs")
    os.symlink(ROOT / "scenes", tmp_path / "scenes")
    (tmp_path / "examples").mkdir()
    os.symlink(ROOT / "examples" / "python", tmp_path / "examples" / "python")
    notebook = nbformat.read(file, as_version=4)
    assert all(not cell.get("outputs") for cell in notebook.cells), "is kept without outputs"
    ExecutePreprocessor(timeout=300, kernel_name="python3").preprocess(notebook, {"metadata": {"path": str(tmp_path)}})
