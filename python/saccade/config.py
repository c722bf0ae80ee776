"""Configurations: files, dictionaries and overrides, read by the one strict reader of the command."""
from __future__ import annotations

import json
import os
import shlex
from typing import Any, Mapping, Union

import numpy as np

from saccade import _native

#: A YAML file, a dictionary with the same keys, or nothing for all defaults.
Config = Union[str, os.PathLike, Mapping[str, Any], None]


def _plain(value: Any) -> Any:
    """What json cannot write by itself."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if hasattr(value, "as_dict"):
        return value.as_dict()
    raise TypeError(f"{type(value).__name__} is no value of a configuration")


def yaml_of(value: Any, key: str = "config") -> str:
    """The value as YAML (of which JSON is a part)."""
    try:
        return json.dumps(value, default=_plain, allow_nan=False)
    except (TypeError, ValueError) as error:
        raise _native.InputError(f"{key}: {error}") from None


def override_list(overrides: Mapping[str, Any]) -> list[str]:
    """``{"events__contrast_on": 0.2}`` as ``["events.contrast_on=0.2"]``, what ``--set`` takes."""
    texts = []
    for name, value in overrides.items():
        key = name.replace("__", ".")
        texts.append(f"{key}={yaml_of(value, key)}")
    return texts


def document(config: Config, overrides: Mapping[str, Any]) -> _native.Document:
    """A configuration as stated, with keyword arguments on top."""
    texts = override_list(overrides)
    if config is None:
        return _native.Document(None, None, texts)
    if isinstance(config, Mapping):
        return _native.Document(None, yaml_of(dict(config)), texts)
    return _native.Document(os.fspath(config), None, texts)


def command_line(words: list[str], config: Config, overrides: Mapping[str, Any]) -> str:
    """The call as the command line that does the same, for run.yaml; dictionaries become ``--set``."""
    stated = dict(overrides)
    if isinstance(config, Mapping):
        stated = {**config, **stated}
    elif config is not None:
        words = words + ["-c", os.fspath(config)]
    for text in override_list(stated):
        words = words + ["--set", text]
    return shlex.join(words)
