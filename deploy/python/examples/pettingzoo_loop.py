"""A PettingZoo loop: our trained policy, or random play without onnxruntime, plays all six robots of one match.

python pettingzoo_loop.py [--seconds 60]
"""

import argparse
import time

import numpy as np

import vsss


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=60, help="stop after so long")
    arguments = parser.parse_args()
    env = vsss.parallel_env(end_at_first_goal=False, episode_s=120)
    try:
        policy = vsss.Policy()
    except vsss.Error as e:
        print(f"random play: {e}")
        policy = None
    end = time.monotonic() + arguments.seconds
    observations, infos = env.reset(seed=1)
    played = 0
    while time.monotonic() < end:
        if policy is None:
            actions = {agent: env.action_space(agent).sample() for agent in env.agents}
        else:
            rows = policy(np.stack([observations[agent] for agent in env.agents]))
            actions = dict(zip(env.agents, rows))
        observations, rewards, terminated, truncated, infos = env.step(actions)
        if infos["blue_0"]["event"] == "goal":
            print(f"a goal: blue_0 gets {rewards['blue_0']:+.1f}")
        if not env.agents:
            played += 1
            own, theirs = infos["blue_0"]["score"]
            print(f"match {played}: {own} : {theirs}")
            observations, infos = env.reset()
    env.close()


if __name__ == "__main__":
    main()
