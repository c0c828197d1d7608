"""Stable-Baselines3 PPO learns to hit the ball: three robots share a policy, the adversaries stand still.

python sb3_ppo.py [--seconds 60] [--save policy.zip]
Before and after it prints in how many of 96 episodes of 8 s the ball was hit (pushed more than 10 cm).
"""

import argparse
import time

import numpy as np
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback

import vsss
from vsss.sb3 import VecEnv

SETTINGS = dict(
    opponent="zero:",
    observation="frame",
    episode_s=8,
    reward="goals,approach=1,progress=1,own_distance=0.1",
    realism={"noise": False},
)


def hits(model: PPO, episodes: int = 96) -> int:
    """Episodes in which the ball was moved, of the first `episodes` from one seed."""
    env = vsss.make_vec(episodes, **SETTINGS, end_at_first_goal=False)
    observation, _ = env.reset(seed=7)
    first = np.stack([env.world(i)[4:6] for i in range(episodes)])
    moved = np.zeros(episodes, bool)
    for _ in range(79):
        action, _ = model.predict(observation, deterministic=True)
        observation, *_ = env.step(action)
        now = np.stack([env.world(i)[4:6] for i in range(episodes)])
        moved |= np.hypot(*(now - first).T) > 0.1
    env.close()
    return int(moved.sum())


class StopAfter(BaseCallback):
    def __init__(self, seconds: float) -> None:
        super().__init__()
        self.end = time.monotonic() + seconds

    def _on_step(self) -> bool:
        return time.monotonic() < self.end


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--envs", type=int, default=32, help="matches at once")
    parser.add_argument("--save", default="")
    arguments = parser.parse_args()
    env = VecEnv(vsss.make_vec(arguments.envs, **SETTINGS))
    model = PPO(
        "MlpPolicy", env, n_steps=32, batch_size=768, n_epochs=4, gamma=0.95, learning_rate=1e-3, device="cpu", seed=1
    )
    before = hits(model)
    print(f"untrained: {before} of 96 episodes hit the ball", flush=True)
    start = time.monotonic()
    model.learn(10**9, callback=StopAfter(arguments.seconds))
    seconds = time.monotonic() - start
    print(f"{model.num_timesteps} transitions in {seconds:.0f} s, {model.num_timesteps / seconds:.0f} per second")
    print(f"trained: {hits(model)} of 96 episodes hit the ball")
    if arguments.save:
        model.save(arguments.save)
    env.close()


if __name__ == "__main__":
    main()
