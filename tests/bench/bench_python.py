"""Speed of the Python package: "bench NAME VALUE UNIT", medians. Run by tests/bench/python.sh.

bench_python.py [what...]: overhead, envs; sb3 (needs Stable-Baselines3; [--seconds 30] [--sb3 which])
"""

import argparse
import statistics
import sys
import time

import numpy as np

import vsss

RUNS = 9


def say(name, value, unit):
    print(f"bench python_{name} {value:.4g} {unit}", flush=True)


def overhead():
    """A step through VectorEnv beside the bare C call of the same environment, in turns, so that both meet alike states."""
    env = vsss.make_vec(64, 2, opponent="zero:", seed=1)
    env.reset()
    batch, error = env._batch, env._batch._error
    actions = [np.random.default_rng(i).uniform(-1, 1, (env.num_envs, 2)).astype(np.float32) for i in range(16)]
    held = batch.arrays[0]["action"]

    def python_step(i):
        env.step(actions[i & 15])

    def c_step(i):
        held[:] = actions[i & 15]
        batch._step(batch.handle, 1 - batch.now, error, 640)
        batch.now = 1 - batch.now

    ways = {"python": python_step, "c": c_step}
    spent = {name: [] for name in ways}
    for run in range(RUNS * 5):
        for name in sorted(ways, reverse=bool(run % 2)):
            start = time.perf_counter()
            for i in range(10):
                ways[name](i)
            if run:
                spent[name].append((time.perf_counter() - start) / 10)
    python_s, c_s = (statistics.median(spent[name]) for name in ("python", "c"))
    ratio = statistics.median(p / c for p, c in zip(spent["python"], spent["c"]))
    say("vec_64_step", 1e3 * python_s, "ms")
    say("vec_64_transitions", env.num_envs / python_s, "transitions/s")
    say("vec_64_overhead", ratio, "x_of_the_C_call")
    # What Python adds alone, with the library's work left out: robust where the machine is busy.
    real = batch._step
    batch._step = lambda handle, which, *_: 0
    start = time.perf_counter()
    for i in range(2000):
        env.step(actions[i & 15])
    added_s = (time.perf_counter() - start) / 2000
    batch._step = real
    say("vec_64_added", 1e6 * added_s, "us_a_step")
    say("vec_64_added_share", added_s / c_s, "of_the_C_call")
    env.close()


def rate(step, per_step, seconds=1.0):
    rates = []
    for _ in range(RUNS):
        start, n = time.perf_counter(), 0
        while time.perf_counter() - start < seconds / 2:
            for _ in range(10):
                step()
            n += 10
        rates.append(n * per_step / (time.perf_counter() - start))
    return statistics.median(rates)


def envs():
    """Transitions per second with random actions, resets included, one thread."""
    env = vsss.VSSEnv()
    env.reset(seed=1)
    actions = np.random.default_rng(1).uniform(-1, 1, (256, 2)).astype(np.float32)
    count = [0]

    def one():
        count[0] += 1
        _, _, over, _, _ = env.step(actions[count[0] & 255])
        if over or count[0] % 1200 == 0:
            env.reset()

    say("vss_v0_steps", rate(one, 1), "transitions/s")
    many = vsss.VSSVectorEnv(64, 1)
    many.reset(seed=1)
    given = np.random.default_rng(1).uniform(-1, 1, (64, 2)).astype(np.float32)
    say("vss_v0_64_steps", rate(lambda: many.step(given), 64), "transitions/s")
    both = vsss.make_vec(64, 1, learners="both")
    both.reset(seed=1)
    given = np.random.default_rng(1).uniform(-1, 1, both.action_space.shape).astype(np.float32)
    say("vec_64_both_steps", rate(lambda: both.step(given), both.num_envs), "transitions/s")
    match = vsss.parallel_env(end_at_first_goal=False)
    match.reset(seed=1)

    def round_of_six():
        if not match.agents:
            match.reset()
        match.step({agent: given[i] for i, agent in enumerate(match.agents)})

    say("parallel_env_steps", rate(round_of_six, 6), "transitions/s")


def sb3(seconds, which=""):
    """PPO on VSS-v0 as in the peers' script (2048 transitions an update, 64-64; batches of 64 in 10 epochs, or of 512 in 4,
    where the learner does not take it all) and on matches."""
    import torch
    from stable_baselines3 import PPO
    from stable_baselines3.common.callbacks import BaseCallback

    from vsss.sb3 import VecEnv

    torch.set_num_threads(1)

    class Share(BaseCallback):
        def __init__(self):
            super().__init__()
            self.rollout_s = 0.0

        def _on_rollout_start(self):
            self.began = time.perf_counter()

        def _on_rollout_end(self):
            self.rollout_s += time.perf_counter() - self.began

        def _on_step(self):
            return True

    def learn(name, env, n_steps, batch, epochs):
        share = Share()
        model = PPO("MlpPolicy", VecEnv(env), n_steps=n_steps, batch_size=batch, n_epochs=epochs, device="cpu", seed=0)
        per = n_steps * env.num_envs
        model.learn(per, callback=share)
        share.rollout_s, begun, start = 0.0, model.num_timesteps, time.perf_counter()
        while time.perf_counter() - start < seconds:
            model.learn(per, callback=share, reset_num_timesteps=False)
        spent, done = time.perf_counter() - start, model.num_timesteps - begun
        say(f"sb3_{name}", done / spent, "transitions/s")
        say(f"sb3_{name}_learner", 100 * (1 - share.rollout_s / spent), "%_of_the_time")
        say(f"sb3_{name}_rollout", done / share.rollout_s, "transitions/s")
        env.close()

    if which in ("", "vss_v0_as_peers"):
        learn("vss_v0_as_peers", vsss.VSSVectorEnv(64, 1), 32, 64, 10)
    if which in ("", "vss_v0_batch_512"):
        learn("vss_v0_batch_512", vsss.VSSVectorEnv(64, 1), 32, 512, 4)
    if which in ("", "matches"):
        learn("matches", vsss.make_vec(32, 1, opponent="zero:", observation="frame"), 64, 2048, 4)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", nargs="*", default=["overhead", "envs"])
    parser.add_argument("--seconds", type=float, default=30)
    parser.add_argument("--sb3", default="", help="vss_v0_as_peers, vss_v0_batch_512 or matches alone")
    arguments = parser.parse_args()
    for what in arguments.what:
        if what == "sb3":
            sb3(arguments.seconds, arguments.sb3)
        else:
            {"overhead": overhead, "envs": envs}[what]()


if __name__ == "__main__":
    sys.exit(main())
