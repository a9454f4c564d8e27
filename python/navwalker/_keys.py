"""Scenario keys as keyword arguments, and Python values as TOML."""

import json
import math
import os
from collections.abc import Mapping
from typing import Any

from navwalker import _native


def _as_word(key: str) -> str:
    return key.replace(".", "_").replace("-", "_")


_KEYS = {_as_word(key): key for key in _native.keys()}
_SECTIONS = sorted({key.split(".")[0] for key in _native.keys() if "." in key})


def key_of(word: str) -> str:
    """The key that a keyword argument means: ``visibility_mask_deg`` is ``visibility.mask-deg``.

    One that is none is given as it may have been meant, so that the error names the nearest.
    """
    known = _KEYS.get(word)
    if known is not None:
        return known
    for section in _SECTIONS:
        if word.startswith(_as_word(section) + "_"):
            return f"{section}.{word[len(section) + 1:].replace('_', '-')}"
    return word.replace("_", "-")


def toml_of(value: object) -> str:
    """A Python value as TOML."""
    item = getattr(value, "item", None)
    if callable(item) and getattr(value, "ndim", None) == 0:
        value = item()
    tolist = getattr(value, "tolist", None)
    if callable(tolist):
        value = tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        if math.isnan(value) or math.isinf(value):
            raise _native.ScenarioError(f"{value} is no value of a scenario key")
        return repr(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, os.PathLike):
        return json.dumps(os.fspath(value), ensure_ascii=False)
    if isinstance(value, Mapping):
        pairs = (f"{json.dumps(str(key))} = {toml_of(one)}" for key, one in value.items())
        return "{" + ", ".join(pairs) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(toml_of(one) for one in value) + "]"
    raise _native.ScenarioError(
        f"a scenario key takes a number, text, truth value, list or mapping, not {type(value).__name__}"
    )


def overrides(by_key: Mapping[str, Any] | None, by_word: Mapping[str, Any]) -> list[str]:
    """Overrides as the command line takes them: ``region.step-deg=2``."""
    given = dict(by_key or {})
    for word, value in by_word.items():
        key = key_of(word)
        if key in given:
            raise _native.ScenarioError(f"{key} is given twice")
        given[key] = value
    return [f"{key}={toml_of(value)}" for key, value in given.items()]
