"""What of a result's files is the same whenever the same is computed, for the scripts that compare results."""

import hashlib
import json
import re


def numbers_of(value, path=""):
    """The numbers and nulls of a JSON value with their dotted keys, speed left out."""
    if isinstance(value, dict):
        for key in sorted(value):
            if not (path == "" and key in ("speed", "timing")):
                yield from numbers_of(value[key], f"{path}.{key}" if path else key)
    elif isinstance(value, list):
        for i, item in enumerate(value):
            yield from numbers_of(item, f"{path}[{i}]")
    elif not isinstance(value, str):
        yield f"{path}={value!r}"


def digest(path):
    if path.name == "metrics.json":
        data = "\n".join(numbers_of(json.loads(path.read_text()))).encode()
    elif path.name == "cost.csv":  # without its last column, the seconds
        data = re.sub(r",[^,\n]*$", "", path.read_text(), flags=re.MULTILINE).encode()
    else:
        data = path.read_bytes()
    return hashlib.sha256(data).hexdigest()[:16]
