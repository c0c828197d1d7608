"""Many matches between two players, and the table of ./vsss eval."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Callable, Dict, List, Optional

import numpy as np

from . import _library as lib
from ._batch import Batch
from ._players import actions_of, as_player
from .vector import TEAM, default_threads


@dataclass
class Evaluation:
    """A series of matches as seen from the first player. Each of the first six has a 95 % interval in `interval`.

    Attributes:
        win, draw, loss: rates in [0, 1].
        goals_for, goals_against, score: per match; score is their difference.
        penalties_for, penalties_against, free_balls, goal_kicks: per match.
        mean_time_s: length of a match.
        interval: (low, high) by name.
        scores: int [matches][2], own and theirs.

    `./vsss eval` also tells what needs every frame of a match: the share of still ball, goals that came of penalties and
    free balls, and who broke the idle rule.
    """

    against: str
    matches: int
    win: float
    draw: float
    loss: float
    goals_for: float
    goals_against: float
    score: float
    penalties_for: float
    penalties_against: float
    free_balls: float
    goal_kicks: float
    mean_time_s: float
    interval: Dict[str, Any] = field(default_factory=dict)
    scores: Any = None

    def __str__(self) -> str:
        def rate(name: str) -> str:
            low, high = self.interval[name]
            return f"{100 * getattr(self, name):.0f} % [{100 * low:.0f}, {100 * high:.0f}]"

        low, high = self.interval["score"]
        return (
            f"{self.matches} matches against {self.against}: win {rate('win')}, draw {rate('draw')}, loss {rate('loss')}, "
            f"goals {self.goals_for:.2f} : {self.goals_against:.2f}, score {self.score:+.2f} [{low:+.2f}, {high:+.2f}]"
        )


class _Series:
    """Matches in slots: as one ends, the next begins in its place. Match i has the seed that ./vsss eval gives it."""

    def __init__(self, batch: Batch, matches: int, seed: int, progress: Optional[Callable[[int, int], None]]) -> None:
        self.batch, self.matches, self.progress = batch, matches, progress
        self.seeds = [lib.library.vs_capi_seed(seed, i) for i in range(matches)]
        self.score = np.zeros((matches, 2), np.int32)
        self.time_s = np.zeros(matches)
        self.events = np.zeros((matches, 2, lib.about.event_kinds), np.int32)
        self.slot = list(range(batch.envs))
        self.next = batch.envs
        self.finished = 0
        for env in range(batch.envs):
            self._start(env)

    def _start(self, env: int) -> None:
        b = self.batch
        lib.call("vec_start", b.alive(), b.now, env, self.seeds[self.slot[env]])

    def after_step(self) -> None:
        a = self.batch.current
        for env in np.flatnonzero(a["event"][:, 0]):
            if self.slot[env] >= 0:
                kind, team = a["event"][env]
                self.events[self.slot[env], team, kind] += 1
        for env in np.flatnonzero(a["done"]):
            match = self.slot[env]
            if match < 0:
                continue
            self.score[match], self.time_s[match] = a["score"][env], a["episode_s"][env]
            self.finished += 1
            self.slot[env] = self.next if self.next < self.matches else -1
            self.next += 1
            if self.slot[env] >= 0:
                self._start(int(env))
            if self.progress:
                self.progress(self.finished, self.matches)


def _sum_up(series: _Series, against: str) -> Evaluation:
    out = np.zeros(lib.about.summary)
    lib.call(
        "sum_up",
        series.matches,
        series.time_s.ctypes.data,
        series.score.ctypes.data,
        series.events.ctypes.data,
        out.ctypes.data,
    )
    numbers = dict(zip(lib.names("summary"), out.tolist()))
    interval = {n[:-4]: (numbers[n], numbers[n[:-4] + "_high"]) for n in numbers if n.endswith("_low")}
    means = {n: v for n, v in numbers.items() if not n.endswith(("_low", "_high"))}
    return Evaluation(against=against, matches=series.matches, interval=interval, scores=series.score, **means)


def evaluate(
    policy: Any,
    against: Any = "emc:",
    matches: int = 100,
    *,
    seed: int = 1,
    threads: Optional[int] = None,
    slots: int = 64,
    progress: Optional[Callable[[int, int], None]] = None,
    realism: Any = None,
    **settings: Any,
) -> Evaluation:
    """Plays matches and sums them up as ./vsss eval does: same seeds, same defaults (contact drive, 120 s), same table.

    Args:
        policy: who is blue: a function observation float32 [n][464] -> action [n][2] (n a multiple of 3: the robots of each
            match in order), a Policy, a @vsss.strategy or a URI.
        against: who is yellow, likewise.
        matches, seed: match i is played from the seed that ./vsss eval --seed gives it.
        slots: matches at once: the batch that a function sees is three times as large.
        progress: called with (finished, matches) after each match.
        settings: drive, rules, placement, episode_s, ... as of vsss.make_vec.
    """
    if int(matches) != matches or matches < 1:
        raise lib.UsageError(f"matches = {matches!r}: give a whole number, at least 1")
    uris, functions = zip(as_player("policy", policy), as_player("against", against))
    given: Dict[str, Any] = dict(drive="contact", placement="paper", end_at_first_goal=False, episode_s=0)
    given.update(settings, blue=uris[0], yellow=uris[1], realism=lib.realism_text(realism), stay_over=True)
    given.update(envs=min(int(slots), int(matches)), threads=default_threads() if threads is None else threads)
    batch = Batch("vec", given)
    try:
        series = _Series(batch, int(matches), int(seed), progress)
        players: List[Any] = [(team, f) for team, f in enumerate(functions) if f is not None]
        while series.finished < series.matches:
            _decide(batch, players)
            batch.step()
            series.after_step()
        return _sum_up(series, against if isinstance(against, str) else getattr(against, "__name__", type(against).__name__))
    finally:
        batch.close()


def _decide(batch: Batch, players: List[Any]) -> None:
    if not players:
        return
    per_match = batch.rows // batch.envs
    observation = batch.current["observation"].reshape(batch.envs, per_match // TEAM, TEAM, -1)
    action = batch.arrays[0]["action"].reshape(batch.envs, per_match // TEAM, TEAM, -1)
    for team, function in players:
        column = team if per_match == 2 * TEAM else 0
        rows = observation[:, column].reshape(batch.envs * TEAM, -1)
        action[:, column] = actions_of(function, rows, ("policy", "against")[team]).reshape(action[:, column].shape)
