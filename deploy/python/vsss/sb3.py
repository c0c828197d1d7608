"""Our vector environments as Stable-Baselines3 takes them."""

from __future__ import annotations

from typing import Any, Dict, List, Optional, Sequence

import numpy as np

try:
    from stable_baselines3.common.vec_env import VecEnv as _Base
except ImportError as e:
    raise ImportError(f"vsss.sb3 needs Stable-Baselines3 ({e}): pip install vsss[sb3]") from None


class VecEnv(_Base):
    """A vsss.make_vec(...) or vsss.VSSVectorEnv(...) for Stable-Baselines3: one of its environments per row.

    >>> PPO("MlpPolicy", vsss.sb3.VecEnv(vsss.make_vec(64)))
    """

    def __init__(self, env: Any) -> None:
        self.env = env
        self.render_mode = env.render_mode
        self._actions: Any = None
        super().__init__(env.num_envs, env.single_observation_space, env.single_action_space)

    def reset(self) -> np.ndarray:
        seeds = [s for s in self._seeds if s is not None]
        observation, _ = self.env.reset(seed=seeds[0] if seeds else None)
        self._reset_seeds()
        return observation

    def step_async(self, actions: np.ndarray) -> None:
        self._actions = actions

    def step_wait(self) -> Any:
        observation, reward, terminated, truncated, infos = self.env.step(self._actions)
        done = terminated | truncated
        out: List[Dict[str, Any]] = [{} for _ in range(self.num_envs)]
        for i in np.flatnonzero(done):
            out[i] = {"terminal_observation": infos["final_obs"][i].copy(), "TimeLimit.truncated": bool(truncated[i])}
        return observation, reward, done, out

    def close(self) -> None:
        self.env.close()

    def get_attr(self, attr_name: str, indices: Any = None) -> List[Any]:
        return [getattr(self.env, attr_name)] * len(list(self._get_indices(indices)))

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        setattr(self.env, attr_name, value)

    def env_method(self, method_name: str, *args: Any, indices: Any = None, **kwargs: Any) -> List[Any]:
        return [getattr(self.env, method_name)(*args, **kwargs)]

    def env_is_wrapped(self, wrapper_class: Any, indices: Any = None) -> List[bool]:
        return [False] * len(list(self._get_indices(indices)))

    def get_images(self) -> Sequence[Optional[np.ndarray]]:
        return self.env.render()
