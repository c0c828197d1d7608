"""pSim (Box2D): raw, its simulation alone, and as its PettingZoo environment. A step is 1/60 s; random actions held a second.
It sets the bodies' velocities, with neither wheels nor traction: a bound of what two dimensions can give, not an equal."""
import os

os.environ["SDL_VIDEODRIVER"] = "dummy"
os.environ["PYGAME_HIDE_SUPPORT_PROMPT"] = "1"
import numpy as np
import pSim

from timing import rate, say

HZ, ROBOTS = 60, 3
WHO = dict(render_mode=None, scenario="formation", num_agent_robots=ROBOTS, num_adversary_robots=ROBOTS)
actions = np.random.default_rng(1).uniform(-1, 1, (200, 2, ROBOTS, 2))


class Raw:
    def __init__(self):
        self.env, self.calls = pSim.SimpleVSSSEnv(**WHO), 0
        self.env.reset(seed=1)

    def step(self):
        ours, theirs = actions[self.calls // HZ % len(actions)]
        for i in range(ROBOTS):
            self.env.simulator.agent_step(i, ours[i])
            self.env.simulator.adversary_step(i, theirs[i])
        self.env._step_simulation()
        self.calls += 1
        if self.calls % (60 * HZ) == 0:
            self.env.reset()


class Zoo:
    def __init__(self):
        self.env, self.calls = pSim.VSSSPettingZooEnv(**WHO), 0
        self.env.reset(seed=1)

    def step(self):
        ours, theirs = actions[self.calls // HZ % len(actions)]
        self.calls += 1
        _, _, terminated, truncated, _ = self.env.step({f"agent_{i}": ours[i] for i in range(ROBOTS)}, theirs)
        if any(terminated.values()) or any(truncated.values()):
            self.env.reset()


say("psim", rate(Raw().step, 8.0) / HZ)
steps = rate(Zoo().step, 8.0)
say("psim_zoo", steps / HZ)
say("psim_zoo_steps", steps)
