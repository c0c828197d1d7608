"""A handle of the library with the NumPy arrays that it reads and writes in place."""

from __future__ import annotations

import ctypes
import os
from typing import Any, Dict, Optional, Sequence, Tuple, Union

import gymnasium
import numpy as np

from . import _library as lib

SETS = 2  # VS_CAPI_SETS: what a step returns stays as it is during the next step
SeedLike = Optional[Union[int, Sequence[int]]]


class Batch:
    """Many environments behind one handle: kind "vec" (matches) or "vss" (VSS-v0).

    arrays[s] are set s of the caller's arrays by name, C-contiguous, allocated once; `now` is the set that was written
    last. The library checks names and sizes, so a wrong layout is an exception.
    """

    def __init__(self, kind: str, settings: Dict[str, Any]) -> None:
        self.kind = kind
        self._pid = os.getpid()
        self.handle: Optional[ctypes.c_void_p] = None
        handle = ctypes.c_void_p()
        texts = lib.setting_texts(settings)
        lib.call(kind + "_new", ctypes.cast(texts, ctypes.c_void_p), ctypes.byref(handle))
        self.handle = handle
        self.envs = int(getattr(lib.library, f"vs_capi_{kind}_envs")(handle))
        self.rows = int(lib.library.vs_capi_vec_rows(handle)) if kind == "vec" else self.envs
        self.now = 0
        self.arrays: Tuple[Dict[str, np.ndarray], ...] = tuple({} for _ in range(SETS))
        action = None
        for s in range(SETS):
            for name, (shape, dtype) in self._layout().items():
                array = np.zeros(shape, dtype) if name != "action" or action is None else action
                action = array if name == "action" else action
                self.arrays[s][name] = array
                lib.call(kind + "_bind", handle, s, name.encode(), array.ctypes.data, array.nbytes)
        self._error = ctypes.create_string_buffer(640)
        self._step = getattr(lib.library, f"vs_capi_{kind}_step")

    def _layout(self) -> Dict[str, Tuple[Tuple[int, ...], Any]]:
        a, rows, envs = lib.about, self.rows, self.envs
        if self.kind == "vss":
            return {
                "observation": ((envs, a.vss_observation), np.float32),
                "final_observation": ((envs, a.vss_observation), np.float32),
                "action": ((envs, a.vss_action), np.float32),
                "reward": ((envs,), np.float32),
                "terminated": ((envs,), np.bool_),
                "truncated": ((envs,), np.bool_),
                "shaping": ((envs, a.vss_shaping), np.float64),
                "final_shaping": ((envs, a.vss_shaping), np.float64),
            }
        return {
            "observation": ((rows, a.observation), np.float32),
            "final_observation": ((rows, a.observation), np.float32),
            "action": ((rows, a.action), np.float32),
            "reward": ((rows,), np.float32),
            "reward_terms": ((rows, a.reward_terms), np.float64),
            "terminated": ((rows,), np.bool_),
            "truncated": ((rows,), np.bool_),
            "done": ((envs,), np.bool_),
            "score": ((envs, 2), np.int32),
            "episode_s": ((envs,), np.float32),
            "event": ((envs, 2), np.int32),
        }

    def alive(self) -> ctypes.c_void_p:
        if self.handle is None:
            raise gymnasium.error.ClosedEnvironmentError("this environment is closed: make a new one")
        return self.handle

    @property
    def current(self) -> Dict[str, np.ndarray]:
        return self.arrays[self.now]

    def reset(self, seed: SeedLike = None, start: Optional[np.ndarray] = None) -> None:
        """Begins episodes: all, or those that start (bool[envs]) names. seed None: the next ones."""
        handle = self.alive()
        seeds = None
        if seed is not None:
            given = [seed] if np.isscalar(seed) else list(seed)  # type: ignore[arg-type]
            for s in given:
                if isinstance(s, bool) or int(s) != s or not 0 <= int(s) < 2**64:
                    raise lib.UsageError(f"seed {s!r}: give whole numbers from 0 to 2**64 - 1")
            seeds = np.array([int(s) for s in given], np.uint64)
        mask = None
        if start is not None:
            mask = np.ascontiguousarray(start, np.uint8)
            if mask.shape != (self.envs,):
                raise lib.UsageError(f"reset mask: shape {mask.shape} given, ({self.envs},) needed")
        else:
            self.now = 0
        lib.call(
            self.kind + "_reset",
            handle,
            self.now,
            None if seeds is None else seeds.ctypes.data,
            0 if seeds is None else seeds.size,
            None if mask is None else mask.ctypes.data,
        )

    def act(self, actions: Any, shape: Optional[Tuple[int, ...]] = None) -> None:
        """Takes over the actions of the next step, float [rows][action], given in shape."""
        self.alive()
        to = self.arrays[0]["action"]
        shape = to.shape if shape is None else shape
        try:
            given = np.asarray(actions, np.float32)
        except (TypeError, ValueError) as e:
            raise lib.UsageError(f"actions: not an array of numbers ({e})") from None
        if given.shape != shape:
            raise lib.UsageError(f"actions: shape {given.shape} given, {shape} needed")
        to[:] = given.reshape(to.shape)

    def step(self) -> Dict[str, np.ndarray]:
        """One decision of all; returns the set of arrays that it wrote."""
        handle = self.alive()
        following = 1 - self.now
        error = self._error
        status = self._step(handle, following, error, 640)
        if status:
            lib.raise_status(status, error.value.decode(errors="replace"))
        self.now = following
        return self.arrays[following]

    def snapshot(self) -> bytes:
        handle = self.alive()
        size = ctypes.c_size_t()
        lib.call(self.kind + "_state_size", handle, ctypes.byref(size))
        state = np.empty(size.value, np.uint8)
        lib.call(self.kind + "_save", handle, state.ctypes.data, state.size)
        return b"".join([state.tobytes()] + [self.current[name].tobytes() for name in self.current])

    def restore(self, snapshot: bytes) -> None:
        handle = self.alive()
        if not isinstance(snapshot, (bytes, bytearray)):
            raise lib.UsageError(f"snapshot: bytes of snapshot(), not {type(snapshot).__name__}")
        arrays = sum(a.nbytes for a in self.current.values())
        state = np.frombuffer(snapshot, np.uint8)
        size = state.size - arrays
        if size <= 0:
            raise lib.UsageError("snapshot: too short for this environment")
        inner = np.ascontiguousarray(state[:size])
        lib.call(self.kind + "_restore", handle, inner.ctypes.data, inner.size)
        at = size
        for array in self.current.values():
            array[...] = state[at : at + array.nbytes].view(array.dtype).reshape(array.shape)
            at += array.nbytes

    def close(self) -> None:
        handle = self.handle
        if handle is None:
            return
        if os.getpid() == self._pid:  # a fork leaves it alone: its threads are the parent's
            lib.call(self.kind + "_free", handle)
        self.handle = None

    def __del__(self) -> None:
        try:
            self.close()
        except Exception:  # a call is at work on it
            pass


def check_choice(name: str, value: Any, allowed: Sequence[Any]) -> Any:
    if value in allowed:
        return value
    raise lib.UsageError(f"{name} = {value!r}: allowed are {', '.join(map(repr, allowed))}")
