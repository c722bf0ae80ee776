"""Figures with matplotlib, in the size and type of a paper's column.

Every function draws into ``ax`` (default: a new figure) and returns it; ``ax.figure.savefig("figure.pdf")``.
"""
from __future__ import annotations

import functools
import itertools
from typing import Any, Callable, Iterator, Mapping, Optional, Union

import numpy as np

from saccade._native import InputError
from saccade.dataset import Dataset
from saccade.events import Events
from saccade.runs import Run

#: Okabe and Ito's colours, which readers with any colour vision tell apart.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
_ON, _OFF, _TRUTH = "#0072B2", "#D55E00", "#000000"
_STYLE = {
    "font.size": 8, "axes.labelsize": 8, "axes.titlesize": 8, "xtick.labelsize": 7, "ytick.labelsize": 7,
    "legend.fontsize": 7, "lines.linewidth": 1.0, "axes.linewidth": 0.6, "axes.spines.top": False,
    "axes.spines.right": False, "legend.frameon": False, "figure.dpi": 200, "savefig.bbox": "tight",
    "savefig.pad_inches": 0.02, "pdf.fonttype": 42,
}
#: Width of a column and of a page in inches.
COLUMN, PAGE = 3.5, 7.2


def style() -> Any:
    """The style of these figures as a context: ``with saccade.plot.style(): ...``."""
    import matplotlib.pyplot as plt
    return plt.rc_context(_STYLE)


def _styled(draw: Callable[..., Any]) -> Callable[..., Any]:
    """Draws in the style, which the axes of somebody else's figure keep beside theirs."""
    @functools.wraps(draw)
    def styled(*arguments: Any, **options: Any) -> Any:
        with style():
            return draw(*arguments, **options)
    return styled


def _axes(ax: Any, width: float, height: float, rows: int = 1) -> Any:
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt
    return plt.subplots(rows, 1, figsize=(width, height), sharex=rows > 1, constrained_layout=True)[1]


def _image_axes(ax: Any, shape: tuple[int, int], bar: bool = False) -> Any:
    height, width = shape
    return _axes(ax, COLUMN, COLUMN * (0.84 if bar else 1.0) * height / width + (0.15 if bar else 0.0))


def _bare(ax: Any) -> Any:
    ax.set_xticks([])
    ax.set_yticks([])
    for spine in ax.spines.values():
        spine.set_visible(True)
    return ax


@_styled
def events(stream: Events, ax: Any = None, frame: Optional[np.ndarray] = None) -> Any:
    """Events of a window as a picture: ON blue, OFF orange, on white or on a grey frame (linear radiance).

    Of a pixel with both the more frequent one is shown.
    """
    on, off = stream.to_frame("polarity")
    ax = _image_axes(ax, on.shape)
    if frame is None:
        picture = np.ones((*on.shape, 3))
    else:
        grey = np.clip(frame / max(float(frame.max()), 1e-9), 0, 1) ** (1 / 2.2)
        picture = np.repeat((0.35 + 0.65 * grey)[..., None], 3, axis=2)
    for shown, colour in ((on >= np.maximum(off, 1), _ON), (off > on, _OFF)):
        picture[shown] = _rgb(colour)
    ax.imshow(picture, interpolation="nearest")
    return _bare(ax)


def _rgb(colour: str) -> tuple[float, ...]:
    return tuple(int(colour[i:i + 2], 16) / 255 for i in (1, 3, 5))


def _rows(path: Union[Run, Dataset, np.ndarray]) -> np.ndarray:
    if isinstance(path, Run):
        return path.trajectory if path.trajectory is not None else np.empty((0, 8))
    return path.poses if isinstance(path, Dataset) else np.asarray(path)


@_styled
def trajectory(paths: Union[Run, np.ndarray, Mapping[str, Any]], truth: Union[Dataset, np.ndarray, None] = None,
               axes: str = "xy", ax: Any = None) -> Any:
    """Positions seen along an axis of the world; ``axes`` names the horizontal and the vertical one.

    Parameters
    ----------
    paths : run, array, or a dictionary of them by name
    truth : Dataset or array, optional
    """
    ax = _axes(ax, COLUMN, 2.6)
    if len(axes) != 2 or not set(axes) <= set("xyz"):
        raise InputError(f"axes: must be two of x, y and z, such as 'xy', not '{axes}'")
    u, v = (1 + "xyz".index(name) for name in axes)
    if truth is not None:
        rows = _rows(truth)
        ax.plot(rows[:, u], rows[:, v], color=_TRUTH, linewidth=1.6, alpha=0.35, label="truth", zorder=1)
    named = paths if isinstance(paths, Mapping) else {"estimate": paths}
    for (name, path), colour in zip(named.items(), _cycle()):
        rows = _rows(path)
        ax.plot(rows[:, u], rows[:, v], color=colour, label=name, zorder=2)
    ax.set_xlabel(f"{axes[0]} [m]")
    ax.set_ylabel(f"{axes[1]} [m]")
    ax.set_aspect("equal", adjustable="datalim")
    ax.legend()
    return ax


def _cycle() -> Iterator[str]:
    return itertools.cycle(COLOURS)


@_styled
def errors(paths: Union[Run, np.ndarray, Mapping[str, Any]], dataset: Dataset, ax: Any = None) -> Any:
    """Errors of position and rotation over time, without alignment; two axes, ``ax`` is a pair."""
    from saccade.scores import errors as errors_of
    top, bottom = _axes(ax, COLUMN, 2.8, rows=2)
    named = paths if isinstance(paths, Mapping) else {"": paths}
    depth = dataset.mean_depth_m
    for (name, path), colour in zip(named.items(), _cycle()):
        series = errors_of(_rows(path), dataset.poses, depth)
        top.plot(series["t"], series["dt_rel_percent" if depth else "dt_m"], color=colour, label=name)
        bottom.plot(series["t"], series["dtheta_deg"], color=colour)
    top.set_ylabel("position [% of depth]" if depth else "position [m]")
    bottom.set_ylabel("rotation [deg]")
    bottom.set_xlabel("time [s]")
    for axis in (top, bottom):
        axis.set_ylim(bottom=0)
    if isinstance(paths, Mapping):
        top.legend()
    return top, bottom


@_styled
def depth(image: np.ndarray, ax: Any = None, nearest: Optional[float] = None, farthest: Optional[float] = None) -> Any:
    """A depth map [m], dense or sparse; what is unknown (0) stays white."""
    image = np.asarray(image)
    ax = _image_axes(ax, image.shape, bar=True)
    known = image[image > 0]
    limits = (nearest if nearest is not None else (np.percentile(known, 1) if known.size else 0),
              farthest if farthest is not None else (np.percentile(known, 99) if known.size else 1))
    shown = ax.imshow(np.where(image > 0, image, np.nan), cmap="viridis_r", vmin=limits[0], vmax=limits[1],
                      interpolation="nearest")
    bar = ax.figure.colorbar(shown, ax=ax, fraction=0.046 * image.shape[0] / image.shape[1], pad=0.02)
    bar.set_label("depth [m]", size=8)
    bar.ax.tick_params(labelsize=7)
    bar.outline.set_linewidth(0.6)
    return _bare(ax)
