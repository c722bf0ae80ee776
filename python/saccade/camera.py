"""A pinhole camera with its lens."""
from __future__ import annotations

import dataclasses
from typing import Any, Mapping, Union

import numpy as np


@dataclasses.dataclass(frozen=True)
class Camera:
    """Size, focal lengths and principal point in pixels; distortion is k1 k2 p1 p2 k3.

    Pixel centres lie at integer coordinates; the camera looks along +z, x points to the right and y down.
    """

    width: int = 240
    height: int = 180
    fx: float = 200.0
    fy: float = 200.0
    cx: float = 119.5
    cy: float = 89.5
    distortion: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0, 0.0)

    @property
    def matrix(self) -> np.ndarray:
        """K, 3 x 3."""
        return np.array([[self.fx, 0, self.cx], [0, self.fy, self.cy], [0, 0, 1]])

    def as_dict(self) -> dict[str, Any]:
        """The section ``camera`` of a configuration."""
        return {**dataclasses.asdict(self), "distortion": list(self.distortion)}

    @classmethod
    def of(cls, stated: Union["Camera", Mapping[str, Any]]) -> "Camera":
        """From a dictionary with these keys."""
        if isinstance(stated, Camera):
            return stated
        return cls(**{**stated, "distortion": tuple(stated.get("distortion", cls.distortion))})
