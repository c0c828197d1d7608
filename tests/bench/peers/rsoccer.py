"""rSoccer's VSS-v0 by its old gym interface: one robot learns, five drive at random, 25 ms a step."""
import gym
import rsoccer_gym  # noqa: F401  registers the environment

from timing import rate, say

env = gym.make("VSS-v0")
env.reset()
actions = [env.action_space.sample() for _ in range(1000)]
calls = 0


def step():
    global calls
    calls += 1
    if env.step(actions[calls % len(actions)])[2]:
        env.reset()


steps = rate(step, 8.0)
say("rsoccer_steps", steps)
say("rsoccer", steps * 0.025)
