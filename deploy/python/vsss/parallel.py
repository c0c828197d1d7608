"""One match as a PettingZoo environment."""

from __future__ import annotations

import copy
from typing import Any, Dict, List, Optional, Tuple

import gymnasium
import numpy as np

try:
    from pettingzoo import ParallelEnv as _Base
except ImportError as e:
    raise ImportError(f"vsss.parallel_env needs PettingZoo ({e}): pip install vsss[pettingzoo]") from None

from . import _library as lib
from ._batch import Batch, check_choice
from ._players import actions_of, as_player
from ._render import MODES, Renderer
from .vector import TEAM, first_seed, refuse_given

TEAMS = ("blue", "yellow")


class ParallelEnv(_Base):
    """One match, ten decisions a second; agents blue_0 to yellow_2, or one team's where an opponent plays the other.

    Observations float32 [464] and actions float32 [2] in [-1, 1], as of vsss.make_vec; rewards are each robot's own sum.
    All agents end together: terminated by a goal (or whatever the settings let end a match), truncated by the clock.
    infos: "reward_terms" by name, "event", and at the end "score" (own, adversaries').
    """

    metadata: Dict[str, Any] = {"name": "vsss_v0", "render_modes": MODES, "render_fps": 10, "is_parallelizable": True}

    def __init__(
        self,
        *,
        opponent: Any = None,
        learners: Optional[str] = None,
        render_mode: Optional[str] = None,
        render_size: Tuple[int, int] = (640, 360),
        realism: Any = None,
        **settings: Any,
    ) -> None:
        self._config = dict(
            settings,
            opponent=opponent,
            learners=learners,
            render_mode=render_mode,
            render_size=render_size,
            realism=realism,
        )
        learners = ("both" if opponent is None else "blue") if learners is None else learners
        check_choice("learners", learners, ["blue", "yellow", "both"])
        refuse_given(settings, ["envs", "threads", "blue", "yellow", "stay_over"], "this is one match")
        if (learners == "both") != (opponent is None):
            raise lib.UsageError("opponent: needed where one team learns, none where both do")
        self._opponent = None
        self._side = TEAMS.index(learners) if learners != "both" else 0
        if opponent is not None:
            uri, self._opponent = as_player("opponent", opponent)
            settings = dict(settings, **{TEAMS[1 - self._side]: uri})
        self.possible_agents = [f"{t}_{i}" for t in TEAMS for i in range(TEAM) if learners in (t, "both")]
        self.agents: List[str] = []
        self.render_mode = render_mode
        self._renderer = Renderer(render_mode, render_size, None, 1 / lib.about.decision_hz)
        self._batch = Batch("vec", dict(settings, stay_over=True, realism=lib.realism_text(realism)))
        self._seeded = "seed" in settings
        self._first = TEAM * self._side if self._opponent is not None else 0
        self._terms, self._events = lib.names("reward"), lib.names("event")
        box = gymnasium.spaces.Box
        self.observation_spaces = {a: box(-1.0, 1.0, (lib.about.observation,), np.float32) for a in self.possible_agents}
        self.action_spaces = {a: box(-1.0, 1.0, (lib.about.action,), np.float32) for a in self.possible_agents}

    def observation_space(self, agent: str) -> gymnasium.spaces.Space:
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> gymnasium.spaces.Space:
        return self.action_spaces[agent]

    def _by_agent(self, rows: np.ndarray) -> Dict[str, Any]:
        return {agent: rows[self._first + i] for i, agent in enumerate(self.possible_agents)}

    def _observations(self) -> Dict[str, np.ndarray]:
        return self._by_agent(self._batch.current["observation"].copy())

    def reset(self, seed: Optional[int] = None, options: Optional[Dict[str, Any]] = None) -> Tuple[Dict[str, Any], Dict[str, Any]]:
        """A new match; with a seed always the same one."""
        if seed is None and not self._seeded:
            seed = first_seed()
        self._batch.reset(seed)
        self._seeded = True
        self.agents = list(self.possible_agents)
        return self._observations(), {agent: {} for agent in self.agents}

    def _act(self, actions: Dict[str, Any]) -> None:
        if set(actions) != set(self.agents):
            raise lib.UsageError(f"actions of {sorted(actions)} given, of {self.agents} needed")
        rows = np.zeros((self._batch.rows, lib.about.action), np.float32)
        for i, agent in enumerate(self.possible_agents):
            given = np.asarray(actions[agent], np.float32)
            if given.shape != (lib.about.action,):
                raise lib.UsageError(f"action of {agent}: shape {given.shape} given, ({lib.about.action},) needed")
            rows[self._first + i] = given
        if self._opponent is not None:
            theirs = slice(TEAM * (1 - self._side), TEAM * (2 - self._side))
            rows[theirs] = actions_of(self._opponent, self._batch.current["observation"][theirs], "opponent")
        self._batch.act(rows)

    def step(self, actions: Dict[str, Any]) -> Tuple[Dict[str, Any], ...]:
        self._batch.alive()
        if not self.agents:
            raise lib.UsageError("step of a match that is over or not begun: call reset()")
        self._act(actions)
        a = self._batch.step()
        event = self._events[int(a["event"][0, 0])]
        infos: Dict[str, Dict[str, Any]] = {
            agent: {"reward_terms": dict(zip(self._terms, terms.tolist())), "event": event}
            for agent, terms in self._by_agent(a["reward_terms"]).items()
        }
        if a["done"][0]:
            for agent in infos:
                own = TEAMS.index(agent.split("_")[0])
                infos[agent]["score"] = (int(a["score"][0, own]), int(a["score"][0, 1 - own]))
            self.agents = []
        results = (
            self._observations(),
            {agent: float(r) for agent, r in self._by_agent(a["reward"]).items()},
            {agent: bool(t) for agent, t in self._by_agent(a["terminated"]).items()},
            {agent: bool(t) for agent, t in self._by_agent(a["truncated"]).items()},
            infos,
        )
        if self.render_mode == "human":
            self.render()
        return results

    def render(self) -> Optional[np.ndarray]:
        """uint8 [height][width][3], or None with render_mode="human"."""
        return self._renderer.render(self._batch, 0)

    def close(self) -> None:
        self._renderer.close()
        self._batch.close()

    def snapshot(self) -> bytes:
        """All that goes on from here, as bytes: `restore` continues bit for bit, here or in an equal environment."""
        return bytes([bool(self.agents)]) + self._batch.snapshot()

    def restore(self, snapshot: bytes) -> Dict[str, np.ndarray]:
        """Back to a snapshot; returns the observations at it."""
        self._batch.restore(snapshot[1:])
        self.agents = list(self.possible_agents) if snapshot[0] else []
        self._seeded = True
        return self._observations()

    def __getstate__(self) -> Dict[str, Any]:
        return self._config

    def __setstate__(self, config: Dict[str, Any]) -> None:
        self.__init__(**config)  # type: ignore[misc]

    def __deepcopy__(self, memo: Any) -> "ParallelEnv":
        other = type(self)(**copy.copy(self._config))
        other.restore(self.snapshot())
        return other


def parallel_env(**kwargs: Any) -> ParallelEnv:
    """One match as a PettingZoo ParallelEnv.

    Args:
        opponent: None: all six robots are agents. Else who plays the other team, as in vsss.make_vec, and only one
            team's robots are agents.
        learners: "both", "blue" or "yellow"; follows from opponent.
        Others: as of vsss.make_vec (reward, realism, drive, rules, episode_s, ...).
    """
    return ParallelEnv(**kwargs)
