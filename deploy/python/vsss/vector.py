"""Many matches at once: gymnasium's vector environments over the library's."""

from __future__ import annotations

import copy
import ctypes
import os
from typing import Any, Dict, Optional, Tuple

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode

from . import _library as lib
from ._batch import Batch, SeedLike, check_choice
from ._players import actions_of, as_player
from ._render import MODES, Renderer

TEAM = 3


def default_threads() -> int:
    return len(os.sched_getaffinity(0))


def first_seed() -> int:
    """A seed nobody chose, for environments that are reset without one."""
    return int.from_bytes(os.urandom(8), "little")


class _Rows(gymnasium.vector.VectorEnv):
    """What both vector environments share: seeds, copies, snapshots, pictures, the end."""

    _batch: Batch
    _renderer: Renderer
    _config: Dict[str, Any]
    _seeded: bool
    _begun = False

    def _reset_batch(self, seed: SeedLike, options: Optional[Dict[str, Any]], rows_per_env: int) -> None:
        mask = (options or {}).get("reset_mask")
        if mask is not None:
            mask = np.asarray(mask, np.bool_)
            if mask.shape != (self.num_envs,):
                raise lib.UsageError(f"reset_mask: shape {mask.shape} given, ({self.num_envs},) needed")
            mask = mask.reshape(self._batch.envs, rows_per_env).any(axis=1)
        if seed is None and not self._seeded:
            seed = first_seed()
        if mask is not None and not self._begun:
            raise lib.UsageError("reset_mask before the first reset: reset all once")
        self._batch.reset(seed, mask)
        self._seeded = self._begun = True

    def _ready(self) -> None:
        self._batch.alive()
        if not self._begun:
            raise lib.UsageError("step before the first reset: call reset()")

    def snapshot(self) -> bytes:
        """All that goes on from here, as bytes: `restore` continues bit for bit, here or in an equal environment."""
        return self._batch.snapshot()

    def restore(self, snapshot: bytes) -> np.ndarray:
        """Back to a snapshot; returns the observations at it. Its settings must be this environment's."""
        self._batch.restore(snapshot)
        self._seeded = self._begun = True
        return self._observation(self._batch.current["observation"])

    def _observation(self, rows: np.ndarray) -> np.ndarray:
        return rows

    def render(self, env: int = 0) -> Any:
        """A picture of one match, uint8 [height][width][3], or None with render_mode="human"."""
        rgb = self._renderer.render(self._batch, env)
        return None if rgb is None else (rgb,)

    def close_extras(self, **kwargs: Any) -> None:
        self._renderer.close()
        self._batch.close()

    def __getstate__(self) -> Dict[str, Any]:
        return self._config

    def __setstate__(self, config: Dict[str, Any]) -> None:
        self.__init__(**config)  # type: ignore[misc]

    def __deepcopy__(self, memo: Any) -> Any:
        other = type(self)(**copy.copy(self._config))
        other.restore(self.snapshot())
        return other

    def __repr__(self) -> str:
        return f"{type(self).__name__}(num_envs={self.num_envs}, {self._batch.envs} at once)"


def _final_obs(rows: np.ndarray, done: np.ndarray) -> np.ndarray:
    """gymnasium's form: an array of objects, None where no episode ended."""
    out = np.full(len(done), None, dtype=object)
    for i in np.flatnonzero(done):
        out[i] = rows[i]
    return out


class VectorEnv(_Rows):
    """Matches of three against three, 10 decisions a second; made by `vsss.make_vec`.

    Rows (num_envs of them): with rows="robot" one for each learning robot, match by match, then team (blue first where
    both learn), then robot; with rows="team" one for each learning team, its three robots side by side.

    Spaces: observation Box(-1, 1, (464,)), 8 frames of 58 values, oldest first (vsss.observation_names() names the values
    of a frame), or (58,) with observation="frame"; action Box(-1, 1, (2,)), left and right wheel as shares of 46.66 rad/s.
    A team has three times as many values of each.

    Arrays that reset and step return are the library's own, not copies: they keep their values during the next step and
    are written by the one after. Autoreset is SAME_STEP: where an episode ended, observations are those of the next one,
    infos["final_obs"] has the last of the old, infos["final_info"] "score" (own, adversaries') and "episode_s". terminated
    tells that a goal ended it, truncated that the clock did. infos["reward_terms"] float64 [rows][terms] (as
    vsss.reward_terms() names them), infos["event"] int [rows] (as vsss.event_names()) are there in every step.
    """

    metadata: Dict[str, Any] = {"render_modes": MODES, "render_fps": 10, "autoreset_mode": AutoresetMode.SAME_STEP}

    def __init__(
        self,
        num_envs: int = 1,
        threads: Optional[int] = None,
        *,
        learners: str = "blue",
        opponent: Any = None,
        rows: str = "robot",
        observation: str = "stack",
        render_mode: Optional[str] = None,
        render_size: Tuple[int, int] = (640, 360),
        realism: Any = None,
        **settings: Any,
    ) -> None:
        self._config = dict(
            settings,
            num_envs=num_envs,
            threads=threads,
            learners=learners,
            opponent=opponent,
            rows=rows,
            observation=observation,
            render_mode=render_mode,
            render_size=render_size,
            realism=realism,
        )
        check_choice("learners", learners, ["blue", "yellow", "both"])
        check_choice("rows", rows, ["robot", "team"])
        check_choice("observation", observation, ["stack", "frame"])
        refuse_given(settings, ["envs", "blue", "yellow", "stay_over"], "num_envs, learners and opponent say so")
        if learners == "both" and opponent is not None:
            raise lib.UsageError("opponent: none where learners = 'both'; give learners = 'blue' or 'yellow'")
        self._opponent = None
        if learners != "both":
            uri, self._opponent = as_player("opponent", "emc:" if opponent is None else opponent)
            settings = dict(settings, **{"yellow" if learners == "blue" else "blue": uri})
        self.render_mode = render_mode
        self._renderer = Renderer(render_mode, render_size, None, 1 / lib.about.decision_hz)
        self._batch = Batch(
            "vec",
            dict(
                settings,
                envs=num_envs,
                threads=default_threads() if threads is None else threads,
                realism=lib.realism_text(realism),
            ),
        )
        self._seeded = "seed" in settings
        self.matches = self._batch.envs
        self._teams = 2 if learners == "both" else 1
        self._mine = slice(None)
        if self._opponent is not None:  # both teams have rows, one of them is shown
            self._mine = slice(0, 1) if learners == "blue" else slice(1, 2)
        self._sides = {"both": (0, 1), "blue": (0,), "yellow": (1,)}[learners]
        self._group = TEAM if rows == "team" else 1
        self._values = lib.about.observation if observation == "stack" else lib.about.frame
        self._stack = observation == "stack"
        self.num_envs = self.matches * self._teams * TEAM // self._group
        box = gymnasium.spaces.Box
        self.single_observation_space = box(-1.0, 1.0, (self._values * self._group,), np.float32)
        self.single_action_space = box(-1.0, 1.0, (lib.about.action * self._group,), np.float32)
        self.observation_space = gymnasium.vector.utils.batch_space(self.single_observation_space, self.num_envs)
        self.action_space = gymnasium.vector.utils.batch_space(self.single_action_space, self.num_envs)

    # Rows of the library's arrays that are shown; a view, but where Python plays the opponent.
    def _own(self, array: np.ndarray) -> np.ndarray:
        if self._opponent is None:
            return array
        teams = array.reshape((self.matches, 2, TEAM) + array.shape[1:])
        return teams[:, self._mine].reshape((-1,) + array.shape[1:])

    def _observation(self, rows: np.ndarray) -> np.ndarray:
        own = self._own(rows)
        if not self._stack:
            own = own[:, -lib.about.frame :]
        return own.reshape(self.num_envs, -1)

    def _per_row(self, array: np.ndarray) -> np.ndarray:
        return self._own(array)[:: self._group]

    def _of_matches(self, array: np.ndarray) -> np.ndarray:
        return np.repeat(array, self.num_envs // self.matches, axis=0)

    def reset(self, *, seed: SeedLike = None, options: Optional[Dict[str, Any]] = None) -> Tuple[np.ndarray, Dict[str, Any]]:
        """Begins episodes: with a seed (an int, or one for each match) always the same; without, the next ones.

        options={"reset_mask": bool [rows]} begins those of the rows named alone.
        """
        self._reset_batch(seed, options, self.num_envs // self.matches)
        return self._observation(self._batch.current["observation"]), {}

    def _act(self, actions: Any) -> None:
        if self._opponent is None:
            self._batch.act(actions, self.action_space.shape)
            return
        shape = (self.matches, 1, TEAM, lib.about.action)
        own = np.asarray(actions, np.float32)
        if own.shape != self.action_space.shape:
            raise lib.UsageError(f"actions: shape {own.shape} given, {self.action_space.shape} needed")
        teams = self._batch.current["observation"].reshape(self.matches, 2, TEAM, -1)
        theirs = teams[:, 1 - self._sides[0]].reshape(self.matches * TEAM, -1)
        both = self._batch.arrays[0]["action"].reshape(self.matches, 2, TEAM, lib.about.action)
        both[:, self._mine] = own.reshape(shape)
        other = actions_of(self._opponent, theirs, "opponent").reshape(shape)
        both[:, 1 - self._sides[0]] = other[:, 0]

    def step(self, actions: Any) -> Tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, Dict[str, Any]]:
        """One decision of every match. actions: float [rows][...], finite; clamped to [-1, 1]."""
        self._ready()
        self._act(actions)
        a = self._batch.step()
        terminated, truncated = self._per_row(a["terminated"]), self._per_row(a["truncated"])
        reward = self._own(a["reward"])
        if self._group > 1:
            reward = reward.reshape(-1, TEAM).mean(axis=1)
        infos: Dict[str, Any] = {"reward_terms": self._per_row(a["reward_terms"]), "event": self._of_matches(a["event"][:, 0])}
        if a["done"].any():
            done = terminated | truncated
            infos["final_obs"] = _final_obs(self._observation(a["final_observation"]), done)
            infos["_final_obs"] = done
            infos["final_info"] = {
                "score": self._scores(a["score"]),
                "_score": done,
                "episode_s": self._of_matches(a["episode_s"]),
                "_episode_s": done,
            }
            infos["_final_info"] = done
        if self.render_mode == "human":
            self.render()
        return self._observation(a["observation"]), reward, terminated, truncated, infos

    def _scores(self, score: np.ndarray) -> np.ndarray:
        """int [rows][2]: own, adversaries'."""
        of_sides = np.stack([score[:, [side, 1 - side]] for side in self._sides], axis=1)
        return np.repeat(of_sides.reshape(-1, 2), TEAM // self._group, axis=0)

    def world(self, match: int = 0, team: Optional[str] = None, measured: bool = False) -> np.ndarray:
        """The world of a match as float64 [44]; see vsss.World for its parts. team None: absolute, blue first."""
        side = {None: -1, "blue": 0, "yellow": 1}.get(team)
        if side is None:
            raise lib.UsageError(f"team = {team!r}: allowed are None, 'blue', 'yellow'")
        out = np.zeros(lib.about.world)
        lib.call("vec_world", self._batch.alive(), match, side, int(measured), ctypes.c_void_p(out.ctypes.data))
        return out


def refuse_given(settings: Dict[str, Any], keys: Any, why: str) -> None:
    for key in keys:
        if key in settings:
            raise lib.UsageError(f"{key}: not a setting here, {why}")


def make_vec(num_envs: int = 1, threads: Optional[int] = None, **kwargs: Any) -> VectorEnv:
    """Many matches at once, a `VectorEnv` with one row per learning robot (or team).

    Args:
        num_envs: matches side by side. Rows are more: three per learning team, or one with rows="team".
        threads: default one per processor; results do not depend on it.
        learners: "blue", "yellow", or "both" (self-play: rows of both teams).
        opponent: of a single learning team: a URI ("emc:", "inf:", "emc22:", "random:", "zero:", "onnx:FILE", "onnx:",
            "plugin:FILE.so"), a vsss.Policy, a @vsss.strategy, or a function observation [n][464] -> action [n][2].
            Default "emc:".
        rows: "robot" or "team". observation: "stack" (464 values) or "frame" (the newest 58).
        render_mode: None, "rgb_array" or "human"; render_size: (width, height) in pixels.
        reward: "dense", "paper" or "goals", then changes: "dense,goal=5,own_distance=0" (vsss.reward_terms()).
        realism: an INI file such as "deploy/config/realism.ini", or a dict {"latency_s": (0.02, 0.1), "noise": False}.
        drive: "planar" (fast) or "contact" (the reference). rules: "paper" or "league".
        Others: vsss.settings() lists all with a line on each (placement, episode_s, seed, end_at_first_goal, ...).
    """
    return VectorEnv(num_envs, threads, **kwargs)
