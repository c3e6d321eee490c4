"""Settings as TOML, which the core itself reads and checks."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ._error import Error


def toml(value: Any) -> str:
    """A value as TOML, so that each float comes back digit by digit."""
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if isinstance(value, Mapping):
        inside = (f"{key} = {toml(one)}" for key, one in value.items() if one is not None)
        return "{ " + ", ".join(inside) + " }"
    if isinstance(value, Sequence):
        return "[" + ", ".join(map(toml, value)) + "]"
    raise Error(f"{type(value).__name__}: a number, a text, a list or a mapping was expected")


def document(settings: Mapping[str, Any]) -> str:
    return "".join(f"{k} = {toml(v)}\n" for k, v in settings.items() if v is not None)
