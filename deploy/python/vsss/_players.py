"""Opponents as they are given: a URI, a Policy, a strategy, or a function of observations."""

from __future__ import annotations

from typing import Any, Callable, Optional, Tuple

import numpy as np

from . import _library as lib
from .strategy import Strategy


def as_player(name: str, given: Any) -> Tuple[str, Optional[Callable[[np.ndarray], Any]]]:
    """(URI, None), or ("", function of observations) for one that Python evaluates."""
    if isinstance(given, str):
        if not given:
            raise lib.UsageError(f"{name} = '': give a URI such as 'emc:' ({' '.join(lib.names('player'))})")
        return given, None
    uri = getattr(given, "uri", None)
    if isinstance(uri, str):
        return uri, None
    if callable(given):
        return "", given
    raise lib.UsageError(
        f"{name} = {given!r}: give a URI ({' '.join(lib.names('player'))}), a Policy, a strategy or a function of "
        "observations"
    )


def needs_python(given: Any) -> bool:
    return isinstance(given, Strategy)


def actions_of(function: Callable[[np.ndarray], Any], observation: np.ndarray, what: str) -> np.ndarray:
    """Calls a function of observations and checks what it returns, float32 [n][2]."""
    given = np.asarray(function(observation), np.float32)
    if given.shape != (observation.shape[0], lib.about.action):
        raise lib.UsageError(
            f"{what}: returned shape {given.shape} for {observation.shape[0]} rows, "
            f"({observation.shape[0]}, {lib.about.action}) needed"
        )
    if not np.isfinite(given).all():
        raise lib.UsageError(f"{what}: returned an action that is not finite")
    return given
