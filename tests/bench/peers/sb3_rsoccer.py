"""Stable-Baselines3's PPO, with its defaults unless told otherwise, on rSoccer's VSS-v0: what a team gets from a package registry today; one core."""
import argparse
import time

import gym as old_gym
import gymnasium
import numpy as np
import rsoccer_gym  # noqa: F401  registers the environment
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.vec_env import DummyVecEnv

from timing import say

ENVS, STEPS = 4, 512
flags = argparse.ArgumentParser()
flags.add_argument("--seconds", type=float, default=30.0)
flags.add_argument("--batch", type=int, default=64)
flags.add_argument("--epochs", type=int, default=10)
flags = flags.parse_args()
torch.set_num_threads(1)


class Vss(gymnasium.Env):
    """VSS-v0, which speaks gym's interface of 2021, in gymnasium's."""

    def __init__(self):
        self.env = old_gym.make("VSS-v0")
        self.action_space, self.observation_space = (
            gymnasium.spaces.Box(s.low, s.high, dtype=np.float32) for s in (self.env.action_space, self.env.observation_space))

    def reset(self, seed=None, options=None):
        return np.asarray(self.env.reset(), np.float32), {}

    def step(self, action):
        seen, reward, done, about = self.env.step(action)
        late = bool((about or {}).get("TimeLimit.truncated", False))
        return np.asarray(seen, np.float32), float(reward), bool(done) and not late, late, {}


model = PPO("MlpPolicy", DummyVecEnv([Vss] * ENVS), n_steps=STEPS, batch_size=flags.batch, n_epochs=flags.epochs,
            device="cpu", seed=1, policy_kwargs={"net_arch": [64, 64]})
model.learn(ENVS * STEPS)
before, start = model.num_timesteps, time.perf_counter()
while time.perf_counter() - start < flags.seconds:
    model.learn(ENVS * STEPS, reset_num_timesteps=False)
say("sb3_rsoccer", (model.num_timesteps - before) / (time.perf_counter() - start))
