"""Scores: of runs, of trajectories in arrays, of runs against a baseline, and those that are stored."""
from __future__ import annotations

import json
import os
from typing import Any, Optional, Sequence, Union

import numpy as np

from saccade import _native
from saccade.dataset import Dataset
from saccade.runs import PathLike, Run


class Metrics(dict):
    """Scores by dotted key (docs/metrics.md); None where something was not measured.

    ``print(metrics)`` shows the table of ``saccade eval``.
    """

    def __init__(self, values: dict[str, Optional[float]], table: str = "") -> None:
        super().__init__(values)
        self.table = table

    def __str__(self) -> str:
        return self.table or super().__str__()


def evaluate(run: Union[Run, PathLike, np.ndarray], dataset: Union[Dataset, PathLike, None] = None, *,
             mean_depth_m: Optional[float] = None, refined: Union[Run, PathLike, None] = None) -> Metrics:
    """Scores a run, or a trajectory, against ground truth, as ``saccade eval`` does.

    Parameters
    ----------
    run : Run, path or array
        A run, whose metrics.json is written and which is stored for :func:`results`; or rows
        ``t x y z qx qy qz qw`` of any program, (N, 8).
    dataset : Dataset or path, optional
        With the ground truth; default that of the run.
    mean_depth_m : float, optional
        d of ``dt_rel``; default the dataset's.
    refined : Run or path, optional
        A run of ``refine`` that the errors are divided by.

    Returns
    -------
    Metrics
        A dictionary, with the table as its text.
    """
    if isinstance(run, (Run, str, os.PathLike)):
        folder = None if dataset is None else os.fspath(dataset)
        other = None if refined is None else os.fspath(refined)
        return Metrics(*_native.evaluate_run(os.fspath(run), folder, mean_depth_m, other))
    if dataset is None:
        raise _native.InputError("dataset: state the one that the trajectory is scored against")
    return Metrics(*_native.evaluate_poses(run, os.fspath(dataset), mean_depth_m))


def ate(estimate: np.ndarray, truth: np.ndarray, alignment: str = "none") -> dict[str, Optional[float]]:
    """Absolute trajectory error of rows ``t x y z qx qy qz qw`` against the truth's.

    Parameters
    ----------
    estimate, truth : array
        (N, 8) and (M, 8); the truth is interpolated at the estimate's times.
    alignment : {"none", "yaw", "se3", "sim3"}
        The freedom that is taken out of the estimate first.

    Returns
    -------
    dict
        ``ate_rmse_m``, ``rot_rmse_deg`` and ``scale``.
    """
    if alignment not in ("none", "yaw", "se3", "sim3"):
        raise _native.InputError(f"alignment: {alignment!r} is none; there are none, yaw, se3, sim3")
    return _below(f"trajectory.{alignment}.", _native.compare_trajectories(estimate, truth, None))


def rpe(estimate: np.ndarray, truth: np.ndarray) -> dict[str, Optional[float]]:
    """Relative pose errors by dotted key, ``length_10_percent.trans_percent`` for instance (docs/metrics.md)."""
    return _below("trajectory.rpe.", _native.compare_trajectories(estimate, truth, None))


def errors(estimate: np.ndarray, truth: np.ndarray,
           mean_depth_m: Optional[float] = None) -> dict[str, np.ndarray]:
    """Errors from the first estimated pose to the last, every millisecond: ``t``, ``dt_m``, ``dt_rel_percent`` (empty without a depth), ``dtheta_deg``."""
    return _native.trajectory_errors(estimate, truth, mean_depth_m)


def _below(prefix: str, metrics: dict[str, Optional[float]]) -> dict[str, Optional[float]]:
    return {key[len(prefix):]: value for key, value in metrics.items() if key.startswith(prefix)}


class GateResult:
    """The comparison of runs with a baseline; ``print`` shows the table of ``saccade gate``.

    Attributes
    ----------
    tripped : bool
        Whether something regressed.
    rows : list of dict
        ``verdict`` (regressed, improved, same), ``metric``, ``scope``, ``before``, ``after``, ``change`` and more.
    markdown, junit : str
    """

    def __init__(self, native: dict[str, Any]) -> None:
        self.tripped: bool = native["tripped"]
        self.rows: list[dict[str, Any]] = native["rows"]
        self.markdown: str = native["markdown"]
        self.junit: str = native["junit"]
        self._text: str = native["text"]

    def __str__(self) -> str:
        return self._text

    def __bool__(self) -> bool:
        """True where nothing regressed."""
        return not self.tripped


def gate(runs: Union[Run, PathLike, Sequence[Union[Run, PathLike]]], baseline: PathLike, *, update: bool = False,
         **options: Any) -> Optional[GateResult]:
    """Compares scored runs with a baseline, or writes them to it.

    Parameters
    ----------
    runs : run, path or several
    baseline : path
    update : bool
        Write the runs to the baseline, compare nothing and return None.
    **options
        ``tolerance``, ``gross``, ``confidence``, ``resamples``, ``speed``, ``partial``, ``metrics`` as of
        ``saccade gate`` (docs/gate.md).
    """
    stated = [runs] if isinstance(runs, (Run, str, os.PathLike)) else list(runs)
    folders = [os.fspath(run) for run in stated]
    native = _native.GateOptions()
    for name, value in options.items():
        if not hasattr(native, name):
            known = ", ".join(n for n in dir(native) if not n.startswith("_"))
            raise _native.InputError(f"{name}: is no option of gate; there are {known}")
        setattr(native, name, value)
    if update:
        _native.update_baseline(folders, os.fspath(baseline), native.partial)
        return None
    return GateResult(_native.gate(folders, os.fspath(baseline), native))


def results(store: PathLike = ".", where: str = "", columns: Sequence[str] = (),
            diff: Optional[tuple[str, str]] = None) -> Any:
    """Stored results of runs, as ``saccade results`` lists them.

    Parameters
    ----------
    store : path
        results.sqlite, the folder that holds it, or that of a sweep.
    where : str
        Condition over columns and metrics: ``"module = 'track' and trajectory.drift_percent < 1"``.
    columns : sequence of str
        Columns and metrics; default all.
    diff : two names, optional
        Compares two runs, or the runs of two commits, versions or configurations, in place of a list.

    Returns
    -------
    pandas.DataFrame, or a list of dict where pandas is not installed
    """
    if diff is not None:
        return _frame(json.loads(_native.results_diff(os.fspath(store), diff[0], diff[1], where)))
    rows = json.loads(_native.results_json(os.fspath(store), where, list(columns)))
    return _frame([{**{k: v for k, v in row.items() if k != "metrics"}, **row.get("metrics", {})} for row in rows])


def _frame(rows: Any) -> Any:
    try:
        import pandas
    except ImportError:
        return rows
    return pandas.json_normalize(rows) if isinstance(rows, dict) else pandas.DataFrame(rows)
