"""Steps of EnvPool's soccer, random actions held a second, sixteen matches."""
import numpy as np

from soccer import PLAYERS, STEP_S, Soccer
from timing import rate, say

soccer = Soccer(16, 45.0)
soccer.reset()
rng = np.random.default_rng(1)
shape = (soccer.rows, *soccer.space.shape)
actions = [rng.uniform(soccer.space.low, soccer.space.high, shape).astype(soccer.space.dtype) for _ in range(64)]
calls = 0


def step():
    global calls
    soccer.env.step(actions[calls // 40 % len(actions)])
    calls += 1


steps = rate(step, 12.0, 1) * soccer.matches
say("envpool", steps * STEP_S)
say("envpool_players", steps * PLAYERS)
