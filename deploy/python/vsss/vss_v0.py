"""rSoccer's VSS-v0 task on our simulator: one environment, and many at once."""

from __future__ import annotations

import copy
from typing import Any, Dict, Optional, Tuple

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode

from . import _library as lib
from ._batch import Batch, SeedLike
from ._render import MODES, Renderer
from .vector import _final_obs, _Rows, default_threads, first_seed

BOUND = 1.2  # rSoccer's NORM_BOUNDS
STEP_S = 1 / lib.about.vss_hz
_SHAPING = lib.names("shaping")


def _spaces() -> Tuple[gymnasium.spaces.Box, gymnasium.spaces.Box]:
    return (
        gymnasium.spaces.Box(-BOUND, BOUND, (lib.about.vss_observation,), np.float32),
        gymnasium.spaces.Box(-1.0, 1.0, (lib.about.vss_action,), np.float32),
    )


class VSSEnv(gymnasium.Env):
    """One robot, blue 0, among five that drive at random, as in rsoccer-gym's VSS-v0; steps of 25 ms.

    Observation float32 [40] in [-1.2, 1.2]: ball x, y, vx, vy; for blue 0 to 2 x, y, sin, cos, vx, vy, omega; for yellow 0
    to 2 x, y, vx, vy, omega. Positions in units of 0.9 m, speeds of 1.198 m/s, turning of 1716 degrees/s.
    Action float32 [2]: left and right wheel as shares of 1.198 m/s at the rim; slower than 0.05 m/s is 0.
    Reward: 10 for a goal and -10 for one conceded, which end the episode; else 0.2 x speed towards the ball / 0.4 m/s
    + 0.8 x gain of the ball's potential - 2e-4 x wheel speeds. info has their sums since the reset: goal_score, move,
    ball_grad, energy, goals_blue, goals_yellow.
    gymnasium.make("VSS-v0") cuts an episode after 1200 steps, this class alone does not.
    """

    metadata: Dict[str, Any] = {"render_modes": MODES, "render_fps": round(1 / STEP_S)}

    def __init__(
        self,
        render_mode: Optional[str] = None,
        *,
        drive: str = "planar",
        realism: Any = None,
        render_size: Tuple[int, int] = (640, 360),
    ) -> None:
        self._config = dict(render_mode=render_mode, drive=drive, realism=realism, render_size=render_size)
        self.observation_space, self.action_space = _spaces()
        self.render_mode = render_mode
        self._renderer = Renderer(render_mode, render_size, None, STEP_S)
        self._batch = Batch("vss", dict(drive=drive, realism=lib.realism_text(realism), autoreset=False))
        self._seeded = False

    def _info(self, arrays: Dict[str, np.ndarray]) -> Dict[str, float]:
        return dict(zip(_SHAPING, arrays["shaping"][0].tolist()))

    def reset(self, *, seed: Optional[int] = None, options: Optional[Dict[str, Any]] = None) -> Tuple[np.ndarray, Dict[str, Any]]:
        """Pieces anywhere on the field; with a seed always the same ones and the same drivers."""
        self._batch.alive()
        super().reset(seed=seed)
        if seed is None and not self._seeded:
            seed = first_seed()
        self._batch.reset(seed)
        self._seeded = True
        return self._batch.current["observation"][0].copy(), self._info(self._batch.current)

    def step(self, action: Any) -> Tuple[np.ndarray, float, bool, bool, Dict[str, Any]]:
        self._batch.alive()
        if not self._seeded:
            raise lib.UsageError("step before the first reset: call reset()")
        self._batch.act(np.asarray(action)[None])
        a = self._batch.step()
        if self.render_mode == "human":
            self.render()
        return a["observation"][0].copy(), float(a["reward"][0]), bool(a["terminated"][0]), False, self._info(a)

    def render(self) -> Optional[np.ndarray]:
        """uint8 [height][width][3], or None with render_mode="human"."""
        return self._renderer.render(self._batch, 0)

    def close(self) -> None:
        self._renderer.close()
        self._batch.close()

    def snapshot(self) -> bytes:
        """All that goes on from here, as bytes: `restore` continues bit for bit, here or in an equal environment."""
        return self._batch.snapshot()

    def restore(self, snapshot: bytes) -> np.ndarray:
        """Back to a snapshot; returns the observation at it."""
        self._batch.restore(snapshot)
        self._seeded = True
        return self._batch.current["observation"][0].copy()

    def __getstate__(self) -> Dict[str, Any]:
        return self._config

    def __setstate__(self, config: Dict[str, Any]) -> None:
        self.__init__(**config)  # type: ignore[misc]

    def __deepcopy__(self, memo: Any) -> "VSSEnv":
        other = type(self)(**copy.copy(self._config))
        other.restore(self.snapshot())
        return other


class VSSVectorEnv(_Rows):
    """Many VSSEnv over threads: gymnasium.make_vec("vsss/VSS-v0", num_envs, vectorization_mode="vector_entry_point").

    Arrays are views as in VectorEnv; autoreset is SAME_STEP; an episode is cut after max_episode_steps (0: never).
    """

    metadata: Dict[str, Any] = {
        "render_modes": MODES,
        "render_fps": round(1 / STEP_S),
        "autoreset_mode": AutoresetMode.SAME_STEP,
    }

    def __init__(
        self,
        num_envs: int = 1,
        threads: Optional[int] = None,
        *,
        max_episode_steps: int = 1200,
        drive: str = "planar",
        realism: Any = None,
        render_mode: Optional[str] = None,
        render_size: Tuple[int, int] = (640, 360),
    ) -> None:
        self._config = dict(
            num_envs=num_envs,
            threads=threads,
            max_episode_steps=max_episode_steps,
            drive=drive,
            realism=realism,
            render_mode=render_mode,
            render_size=render_size,
        )
        self.render_mode = render_mode
        self._renderer = Renderer(render_mode, render_size, None, STEP_S)
        self._batch = Batch(
            "vss",
            dict(
                envs=num_envs,
                threads=default_threads() if threads is None else threads,
                max_steps=max_episode_steps,
                drive=drive,
                realism=lib.realism_text(realism),
            ),
        )
        self._seeded = False
        self.num_envs = self._batch.envs
        self.single_observation_space, self.single_action_space = _spaces()
        self.observation_space = gymnasium.vector.utils.batch_space(self.single_observation_space, self.num_envs)
        self.action_space = gymnasium.vector.utils.batch_space(self.single_action_space, self.num_envs)

    def reset(self, *, seed: SeedLike = None, options: Optional[Dict[str, Any]] = None) -> Tuple[np.ndarray, Dict[str, Any]]:
        self._reset_batch(seed, options, 1)
        return self._batch.current["observation"], {}

    def step(self, actions: Any) -> Tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, Dict[str, Any]]:
        self._ready()
        self._batch.act(actions)
        a = self._batch.step()
        infos: Dict[str, Any] = {}
        done = a["terminated"] | a["truncated"]
        if done.any():
            infos["final_obs"], infos["_final_obs"] = _final_obs(a["final_observation"], done), done
            infos["final_info"] = {name: a["final_shaping"][:, i] for i, name in enumerate(_SHAPING)}
            infos["final_info"].update({"_" + name: done for name in _SHAPING})
            infos["_final_info"] = done
        if self.render_mode == "human":
            self.render()
        return a["observation"], a["reward"], a["terminated"], a["truncated"], infos
