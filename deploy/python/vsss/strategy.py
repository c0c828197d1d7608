"""Players that are Python: functions of the world, called by the library 30 times a second."""

from __future__ import annotations

import ctypes
import inspect
import threading
from typing import Any, Callable, Dict, Optional, Tuple

import numpy as np

from . import _library as lib


class World:
    """What a team sees, in its own view: it attacks +x. Metres, metres per second, radians; copies, yours to keep.

    Attributes:
        time_s, duration_s: of the match.
        score: (own, adversaries').
        ball: float64 [4]: x, y, vx, vy.
        own, adversaries: float64 [3][6]: x, y, theta, vx, vy, omega of each robot.
    """

    __slots__ = ("time_s", "duration_s", "score", "ball", "own", "adversaries")

    def __init__(self, numbers: np.ndarray) -> None:
        self.time_s, self.duration_s = float(numbers[0]), float(numbers[1])
        self.score = (int(numbers[2]), int(numbers[3]))
        self.ball = numbers[4:8]
        robots = numbers[8:].reshape(2, 3, 6)
        self.own, self.adversaries = robots[0], robots[1]

    def __repr__(self) -> str:
        return f"World(time_s={self.time_s:.2f}, score={self.score}, ball={self.ball.round(3).tolist()})"


WorldFunction = Callable[[World, float], Any]

_lock = threading.Lock()
_strategies: Dict[int, "Strategy"] = {}
_playing: Dict[Tuple[int, int], WorldFunction] = {}


class Strategy:
    """A player made of a function of the world; see `strategy`."""

    def __init__(self, function: Any) -> None:
        if not callable(function):
            raise lib.UsageError(f"strategy: a function or a class of (world, dt_s), not {type(function).__name__}")
        self.function = function
        self.__doc__ = getattr(function, "__doc__", None)
        self.__name__ = getattr(function, "__name__", type(function).__name__)
        self._number: Optional[int] = None

    @property
    def uri(self) -> str:
        """How the library knows it, in this process."""
        with _lock:
            if self._number is None:
                _register()
                self._number = len(_strategies) + 1
                _strategies[self._number] = self
            return f"python:{self._number}"

    def __call__(self, world: World, dt_s: float) -> Any:
        return self.function(world, dt_s)

    def begin(self, seed: int) -> WorldFunction:
        """One team's player for one match: the function itself, or a new object of the class."""
        if not inspect.isclass(self.function):
            return self.function
        make: Any = self.function
        try:
            inspect.signature(make).bind(seed)
        except TypeError:
            return make()
        return make(seed)

    def __getstate__(self) -> Any:
        return {"function": self.function}

    def __setstate__(self, state: Any) -> None:
        self.__init__(state["function"])  # type: ignore[misc]


def strategy(function: Any) -> Strategy:
    """Makes a player of a function (world, dt_s) -> wheels, or of a class whose objects are such functions.

    wheels: float [3][2], left and right of the three robots in rad/s, positive forward, clamped to 46.66. It is called
    for every camera frame (1/30 s) with what the team sees, noise included. A class gets one object per team and match,
    made with the match's seed where its constructor takes one: keep there what a player remembers.

    >>> @vsss.strategy
    ... def chase(world, dt_s):
    ...     return [[20, 20]] * 3
    >>> vsss.evaluate(chase, against="emc:")
    """
    return function if isinstance(function, Strategy) else Strategy(function)


def _begin(player: int, instance: int, seed: int) -> int:
    try:
        _playing[(player, instance)] = _strategies[player].begin(seed)
        return 0
    except BaseException as e:  # raised again by whoever called the library
        lib.pending.append(e)
        return 1


def _think(player: int, instance: int, numbers: Any, dt_s: float, wheels: Any) -> int:
    try:
        world = World(np.ctypeslib.as_array(numbers, (lib.about.world,)).copy())
        given = np.asarray(_playing[(player, instance)](world, dt_s), np.float64)
        if given.shape != (3, 2):
            raise lib.UsageError(f"strategy: returned shape {given.shape}, wheels are [3][2] in rad/s")
        if not np.isfinite(given).all():
            raise lib.UsageError(f"strategy: returned {given.tolist()}, wheels must be finite")
        np.ctypeslib.as_array(wheels, (6,))[:] = given.ravel()
        return 0
    except BaseException as e:
        lib.pending.append(e)
        return 1


def _end(player: int, instance: int) -> None:
    _playing.pop((player, instance), None)


_callbacks: Any = None


def _register() -> None:
    global _callbacks
    if _callbacks is not None:
        return
    _callbacks = (lib.BEGIN(_begin), lib.THINK(_think), lib.END(_end))
    begin, think, end = (ctypes.cast(c, ctypes.c_void_p) for c in _callbacks)
    lib.call("players", b"python", begin, think, end)
