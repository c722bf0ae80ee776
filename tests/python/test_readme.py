"""The Python examples of README.md and docs/python.md, run as they are printed."""
import os
import re

import matplotlib
import pytest

matplotlib.use("Agg")

from conftest import ROOT


def blocks(page):
    return re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(encoding="utf-8"), re.DOTALL)


def run_block(text, folder, monkeypatch):
    for name in ("configs", "scenes", "examples"):
        os.symlink(ROOT / name, folder / name)
    monkeypatch.chdir(folder)
    exec(compile(text, "example", "exec"), {"__name__": "__main__"})  # as python3 runs a file


def test_the_readmes_example_runs_as_printed(tmp_path, monkeypatch, capsys):
    examples = blocks("README.md")
    assert len(examples) == 1 and 15 <= examples[0].count("\n") <= 25
    run_block(examples[0], tmp_path, monkeypatch)
    assert "dt_rel" in capsys.readouterr().out
    assert (tmp_path / "errors.pdf").stat().st_size > 1000


@pytest.mark.parametrize("index", range(len(blocks("docs/python.md"))))
def test_the_pages_examples_run_as_printed(index, tmp_path, monkeypatch):
    run_block(blocks("docs/python.md")[index], tmp_path, monkeypatch)
