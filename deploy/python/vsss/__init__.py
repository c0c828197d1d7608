"""IEEE Very Small Size Soccer for Python: many matches at once, PettingZoo, rSoccer's VSS-v0, evaluation.

    import vsss
    env = vsss.make_vec(64, opponent="emc:", reward="dense,goal=5")   # gymnasium.vector.VectorEnv
    env = vsss.parallel_env(opponent="onnx:")                          # pettingzoo.ParallelEnv
    env = vsss.VSSEnv()                                                # rSoccer's VSS-v0
    print(vsss.evaluate(vsss.Policy(), against="inf:", matches=20))
"""

from __future__ import annotations

from typing import Any, Dict, List

import gymnasium as _gymnasium

from . import _library
from ._library import Error, UsageError, find, reward_weights
from .evaluation import Evaluation, evaluate
from .policy import Policy
from .strategy import Strategy, World, strategy
from .vector import VectorEnv, make_vec
from .vss_v0 import VSSEnv, VSSVectorEnv

__version__: str = _library.about.release.decode()

__all__ = [
    "Error",
    "Evaluation",
    "Policy",
    "Strategy",
    "UsageError",
    "VSSEnv",
    "VSSVectorEnv",
    "VectorEnv",
    "World",
    "evaluate",
    "event_names",
    "find",
    "make_vec",
    "observation_names",
    "parallel_env",
    "players",
    "reward_terms",
    "reward_weights",
    "settings",
    "strategy",
]


def settings() -> Dict[str, str]:
    """Every setting of make_vec, parallel_env and evaluate, with a line on each; names as in the INI files."""
    hidden = {"envs", "blue", "yellow", "stay_over"}
    return {k: v for k, v in zip(_library.names("setting"), _library.names("setting_help")) if k not in hidden}


def reward_terms() -> List[str]:
    """Names of infos["reward_terms"], and of the terms in reward="dense,goal=5"."""
    return _library.names("reward")


def event_names() -> List[str]:
    """Names of infos["event"] by number."""
    return _library.names("event")


def observation_names() -> List[str]:
    """Names of the 58 values of one frame."""
    return _library.names("observation")


def players() -> List[str]:
    """Schemes of players' URIs."""
    return _library.names("player")


def parallel_env(**kwargs: Any) -> Any:
    """One match as a PettingZoo ParallelEnv: see vsss.parallel.parallel_env. Needs pip install vsss[pettingzoo]."""
    from . import parallel

    return parallel.parallel_env(**kwargs)


def _register() -> None:
    registry = _gymnasium.envs.registration.registry
    for name in ("vsss/VSS-v0", "VSS-v0"):  # the second: scripts written for rsoccer_gym
        if name not in registry:
            _gymnasium.register(
                name, entry_point="vsss:VSSEnv", vector_entry_point="vsss:VSSVectorEnv", max_episode_steps=1200
            )
    if "vsss/Match-v0" not in registry:
        _gymnasium.register("vsss/Match-v0", vector_entry_point="vsss:VectorEnv")


_register()
