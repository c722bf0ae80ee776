"""Events as numpy arrays, their representations and filters, and files of them."""
from __future__ import annotations

import bisect
import os
from typing import Any, Iterator, Optional, Union

import numpy as np

from saccade import _native
from saccade.config import document

#: Fields ``x``, ``y`` (uint16, pixels), ``p`` (bool, True is ON) and ``t`` (int64, nanoseconds).
EVENT_DTYPE: np.dtype = np.dtype(_native.EVENT_DTYPE)

_S = 1e-9


def _ns(t_s: float) -> int:
    return int(round(t_s * 1e9))


class Events:
    """Events of one sensor in order of time.

    Parameters
    ----------
    data : numpy.ndarray
        Of :data:`EVENT_DTYPE`, which is taken as it is, or any structured array with the fields
        ``x``, ``y``, ``p`` and ``t``, which is copied. ``t`` is in nanoseconds.
    width, height : int
        Size of the sensor in pixels.

    Notes
    -----
    ``events["t"]``, ``events.x``, slices and time windows are views; nothing is copied.
    ``numpy.asarray(events)`` is the structured array.

    Examples
    --------
    >>> events = Events.from_columns(t=[0, 1000], x=[3, 4], y=[1, 1], p=[True, False], width=8, height=4)
    >>> len(events), events["p"].tolist()
    (2, [True, False])
    """

    def __init__(self, data: np.ndarray, width: int, height: int) -> None:
        data = np.asarray(data)
        if data.dtype != EVENT_DTYPE:
            data = _converted(data)
        if data.ndim != 1:
            raise _native.InputError(f"events: must be one-dimensional, not of shape {data.shape}")
        self.data = data
        self.width = int(width)
        self.height = int(height)

    @classmethod
    def from_columns(cls, t: Any, x: Any, y: Any, p: Any, width: int, height: int) -> "Events":
        """Events from columns of equal length; ``t`` in nanoseconds, ``p`` True or above 0 for ON."""
        t = np.asarray(t)
        data = np.empty(t.shape, EVENT_DTYPE)
        data["t"], data["x"], data["y"] = t, x, y
        data["p"] = np.asarray(p) > 0
        return cls(data, width, height)

    @property
    def t(self) -> np.ndarray:
        """Times in nanoseconds, int64."""
        return self.data["t"]

    @property
    def x(self) -> np.ndarray:
        """Columns in pixels, uint16, to the right."""
        return self.data["x"]

    @property
    def y(self) -> np.ndarray:
        """Rows in pixels, uint16, downwards."""
        return self.data["y"]

    @property
    def p(self) -> np.ndarray:
        """Polarities, bool; True is ON (brighter)."""
        return self.data["p"]

    @property
    def t_s(self) -> np.ndarray:
        """Times in seconds, float64; a copy."""
        return self.data["t"] * _S

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the sensor in pixels."""
        return self.width, self.height

    @property
    def duration_s(self) -> float:
        """Time from the first event to the last."""
        return float(self.t[-1] - self.t[0]) * _S if len(self) > 0 else 0.0

    def __len__(self) -> int:
        return len(self.data)

    def __array__(self, dtype: Any = None) -> np.ndarray:
        return self.data if dtype is None else self.data.astype(dtype)

    def __getitem__(self, key: Any) -> Any:
        """A column by its name, else the events that a slice, a mask or indices choose."""
        if isinstance(key, str):
            return self.data[key]
        if isinstance(key, (int, np.integer)):
            return self.data[key]
        return self._of(self.data[key])

    def __repr__(self) -> str:
        return f"Events({len(self)} events in {self.duration_s:.6g} s, {self.width} x {self.height})"

    def _of(self, data: np.ndarray) -> "Events":
        return Events(data, self.width, self.height)

    def _index(self, t_s: float) -> int:
        # By hand: numpy's search copies a column that is not contiguous.
        return bisect.bisect_left(self.t, _ns(t_s))

    def between(self, start_s: float, end_s: float) -> "Events":
        """Those with ``start_s <= t < end_s``, a view."""
        return self._of(self.data[self._index(start_s):self._index(end_s)])

    def slices(self, dt: Optional[float] = None, n: Optional[int] = None) -> Iterator["Events"]:
        """Consecutive views of ``dt`` seconds from the first event on, or of ``n`` events.

        Windows without events are given as well; the last one may be shorter.
        """
        if (dt is None) == (n is None):
            raise _native.InputError("slices: state one of dt (seconds) and n (events)")
        if len(self) == 0:
            return
        if n is not None:
            for begin in range(0, len(self), _positive("n", n)):
                yield self._of(self.data[begin:begin + n])
            return
        step, start, begin = _positive("dt", _ns(dt)), int(self.t[0]), 0
        while begin < len(self):
            start += step
            end = bisect.bisect_left(self.t, start, lo=begin)
            yield self._of(self.data[begin:end])
            begin = end

    def to_frame(self, kind: str = "polarity", start_s: Optional[float] = None, end_s: Optional[float] = None,
                 **options: Any) -> np.ndarray:
        """One event frame, float32 of shape (channels, height, width).

        Parameters
        ----------
        kind : {"count", "polarity", "time_surface"}
            Number of events (one channel); of ON and of OFF events; or ``to_time_surface``.
        start_s, end_s : float, optional
            The window; default from the first event to the last.
        """
        events = self if kind == "time_surface" else self._within(start_s, end_s)
        return _native.event_frame(events.data, self._sensor(), document(None, {"kind": kind, **options}),
                                   *self._window(start_s, end_s))

    def to_time_surface(self, decay_s: float = 0.03, end_s: Optional[float] = None) -> np.ndarray:
        """exp(-(t_end - t) / decay_s) of the last ON and OFF event of each pixel, (2, height, width)."""
        return self.to_frame("time_surface", end_s=end_s, decay_s=decay_s)

    def to_voxel_grid(self, bins: int = 5, polarity: str = "signed", normalize: str = "none",
                      start_s: Optional[float] = None, end_s: Optional[float] = None) -> np.ndarray:
        """The voxel grid of E2VID, float32 of shape (bins or 2 bins, height, width).

        Parameters
        ----------
        bins : int
            Number of instants that the events are divided among, bilinearly in time.
        polarity : {"signed", "separate"}
            ON minus OFF, or ON events in the first ``bins`` channels and OFF events in the others.
        normalize : {"none", "nonzero"}
            To mean 0 and standard deviation 1 over the voxels that are not 0.
        start_s, end_s : float, optional
            The window; default from the first event to the last.
        """
        stated = {"bins": bins, "polarity": polarity, "normalize": normalize}
        if start_s is not None or end_s is not None:
            stated["span"] = "window"
        return _native.voxel_grid(self._within(start_s, end_s).data, self._sensor(), document(None, stated),
                                  *self._window(start_s, end_s))

    def on(self) -> "Events":
        """The ON events."""
        return self[self.p]

    def off(self) -> "Events":
        """The OFF events."""
        return self[~self.p]

    def crop(self, x: int, y: int, width: int, height: int) -> "Events":
        """Those in a rectangle, whose corner becomes the pixel (0, 0)."""
        inside = (self.x >= x) & (self.x < x + width) & (self.y >= y) & (self.y < y + height)
        data = self.data[inside].copy()
        data["x"] -= np.uint16(x)
        data["y"] -= np.uint16(y)
        return Events(data, width, height)

    def without_pixels(self, mask: np.ndarray) -> "Events":
        """Those outside of the pixels where ``mask`` (height, width) is True."""
        return self[~np.asarray(mask, bool)[self.y, self.x]]

    def hot_pixels(self, factor: float = 20.0) -> np.ndarray:
        """Pixels with more than ``factor`` times the mean number of events of those that fired, (height, width)."""
        counts = np.bincount(self._pixel(), minlength=self.width * self.height)
        fired = counts[counts > 0]
        limit = factor * fired.mean() if fired.size else 0.0
        return (counts > limit).reshape(self.height, self.width)

    def refractory(self, dt_us: float) -> "Events":
        """Without those that follow another event of their pixel within ``dt_us``."""
        order = np.argsort(self._pixel(), kind="stable")
        pixel, t = self._pixel()[order], self.t[order]
        keep = np.ones(len(self), bool)
        keep[order[1:]] = (pixel[1:] != pixel[:-1]) | (np.diff(t) > dt_us * 1e3)
        return self[keep]

    def supported(self, dt_us: float) -> "Events":
        """Those with an event in one of the eight neighbouring pixels at most ``dt_us`` before them.

        The background activity filter of Delbruck (2008), which takes noise away.
        """
        return self[_native.supported_events(self.data, self._sensor(), int(round(dt_us * 1e3)))]

    def save(self, file: Union[str, os.PathLike]) -> None:
        """Writes a file whose ending is that of a format (docs/formats.md), ``.h5`` for instance."""
        _native.write_events(os.fspath(file), self.data, self._sensor())

    def _pixel(self) -> np.ndarray:
        return self.y.astype(np.int64) * self.width + self.x

    def _sensor(self) -> _native.SensorSize:
        return _native.SensorSize(self.width, self.height)

    def _within(self, start_s: Optional[float], end_s: Optional[float]) -> "Events":
        begin = 0 if start_s is None else self._index(start_s)
        end = len(self) if end_s is None else self._index(end_s)
        return self._of(self.data[begin:end])

    @staticmethod
    def _window(start_s: Optional[float], end_s: Optional[float]) -> tuple[Optional[int], Optional[int]]:
        return (None if start_s is None else _ns(start_s)), (None if end_s is None else _ns(end_s))


def _positive(name: str, value: int) -> int:
    if value <= 0:
        raise _native.InputError(f"{name}: must be above 0")
    return value


def _converted(data: np.ndarray) -> np.ndarray:
    missing = [name for name in EVENT_DTYPE.names if name not in (data.dtype.names or ())]
    if missing:
        raise _native.InputError(f"events: the array has no field {missing[0]!r}; fields are x, y, p, t")
    converted = np.empty(data.shape, EVENT_DTYPE)
    for name in ("x", "y", "t"):
        converted[name] = data[name]
    converted["p"] = data["p"] > 0
    return converted


class EventsIterator:
    """Slices of an event file of any format, or of a dataset, in memory that does not grow with it.

    Parameters
    ----------
    path : path
        An event file (docs/formats.md) or a dataset folder.
    delta_t_us : float, optional
        Duration of a slice from the first event on, in microseconds.
    n_events : int, optional
        Events of a slice. One of both is stated.

    Examples
    --------
    >>> for events in EventsIterator("recording.raw", delta_t_us=10_000):
    ...     frame = events.to_frame()  # doctest: +SKIP
    """

    def __init__(self, path: Union[str, os.PathLike], delta_t_us: Optional[float] = None,
                 n_events: Optional[int] = None) -> None:
        if (delta_t_us is None) == (n_events is None):
            raise _native.InputError("EventsIterator: state one of delta_t_us and n_events")
        self._step_ns = None if delta_t_us is None else _positive("delta_t_us", int(round(delta_t_us * 1e3)))
        self._count = None if n_events is None else _positive("n_events", int(n_events))
        self._file, size = os.fspath(path), (0, 0)
        if os.path.isdir(self._file):
            dataset = _native.Dataset(self._file)
            self._file = dataset.events_file
            size = dataset.camera["width"], dataset.camera["height"]
            if not self._file:
                raise _native.InputError(f"{os.fspath(path)}: holds no events")
        self._sensor = _native.SensorSize(*size)
        stated = _native.EventStream(self._file, self._sensor).size
        self.width, self.height = size if size[0] > 0 else stated

    def __iter__(self) -> Iterator[Events]:
        stream = _native.EventStream(self._file, self._sensor)
        rest = stream.next()
        end_ns = None if self._step_ns is None or len(rest) == 0 else int(rest["t"][0]) + self._step_ns
        while len(rest) > 0:
            ready = self._ready(rest, end_ns)
            if ready is None:
                more = stream.next()
                if len(more) > 0:
                    rest = np.concatenate([rest, more])
                    continue
                ready = len(rest)
            yield self._events(rest[:ready])
            rest = rest[ready:]
            if end_ns is not None:
                end_ns += self._step_ns
            if len(rest) == 0:
                rest = stream.next()

    def _ready(self, rest: np.ndarray, end_ns: Optional[int]) -> Optional[int]:
        """Length of the next slice; None while events of it may be still to come."""
        if self._count is not None:
            return self._count if len(rest) >= self._count else None
        return bisect.bisect_left(rest["t"], end_ns) if rest["t"][-1] >= end_ns else None

    def _events(self, data: np.ndarray) -> Events:
        if self.width > 0:
            return Events(data, self.width, self.height)
        # Where neither file nor folder states the sensor: the smallest that holds the slice.
        size = (int(data["x"].max()) + 1, int(data["y"].max()) + 1) if len(data) > 0 else (0, 0)
        return Events(data, *size)


def read_events(path: Union[str, os.PathLike]) -> Events:
    """All events of an event file of any format, or of a dataset folder."""
    if os.path.isdir(path):
        from saccade.dataset import Dataset
        return Dataset(path).events
    stream = _native.EventStream(os.fspath(path), _native.SensorSize(0, 0))
    parts = []
    while len(part := stream.next()) > 0:
        parts.append(part)
    data = np.concatenate(parts) if parts else np.empty(0, EVENT_DTYPE)
    width, height = stream.size
    if width == 0 and len(data) > 0:
        width, height = int(data["x"].max()) + 1, int(data["y"].max()) + 1
    return Events(data, width, height)
