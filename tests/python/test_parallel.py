# Tests deploy/python/vsss/parallel.py
import contextlib
import copy
import io
import pickle
import unittest
import warnings

import numpy as np
from pettingzoo.test import parallel_api_test, parallel_seed_test

import vsss


def play(env, steps, seed=None):
    observations, _ = env.reset(seed=seed) if seed is not None else (None, None)
    out = []
    for i in range(steps):
        if not env.agents:
            env.reset()
        rng = np.random.default_rng(i)
        given = {agent: rng.uniform(-1, 1, 2).astype(np.float32) for agent in env.agents}
        observations, rewards, *_ = env.step(given)
        out.append(np.concatenate([observations[a] for a in sorted(observations)] + [list(rewards.values())]))
    return np.array(out)


class ParallelTest(unittest.TestCase):
    def test_pettingzoos_own_tests_pass(self):
        with contextlib.redirect_stdout(io.StringIO()), warnings.catch_warnings():
            warnings.simplefilter("ignore")  # its test warns of PettingZoo's own habits
            parallel_api_test(vsss.parallel_env(episode_s=5), num_cycles=200)
            parallel_api_test(vsss.parallel_env(episode_s=5, opponent="inf:", learners="yellow"), num_cycles=200)
            parallel_seed_test(lambda: vsss.parallel_env(episode_s=3), num_cycles=60)

    def test_agents_are_the_robots_that_learn(self):
        self.assertEqual(
            vsss.parallel_env().possible_agents, ["blue_0", "blue_1", "blue_2", "yellow_0", "yellow_1", "yellow_2"]
        )
        env = vsss.parallel_env(opponent="emc:", learners="yellow")
        self.assertEqual(env.possible_agents, ["yellow_0", "yellow_1", "yellow_2"])

    def test_it_is_the_match_of_the_vector_environment(self):
        one, many = vsss.parallel_env(opponent="emc:", episode_s=2), vsss.make_vec(1, opponent="emc:", episode_s=2)
        a, b = one.reset(seed=9)[0], many.reset(seed=9)[0]
        for i in range(20):
            np.testing.assert_array_equal(np.stack([a[agent] for agent in one.possible_agents]), b)
            given = np.random.default_rng(i).uniform(-1, 1, (3, 2)).astype(np.float32)
            a, rewards, terminated, truncated, infos = one.step(dict(zip(one.possible_agents, given)))
            b, reward, over, cut, more = many.step(given)
            np.testing.assert_allclose(list(rewards.values()), reward, atol=1e-6)
            if not one.agents:
                self.assertEqual((terminated["blue_0"], truncated["blue_0"]), (over[0], cut[0]))
                np.testing.assert_array_equal(a["blue_0"], more["final_obs"][0])
                self.assertEqual(infos["blue_0"]["score"], tuple(more["final_info"]["score"][0]))
                return
        self.fail("no end within two seconds")

    def test_opponents_that_are_functions(self):
        env = vsss.parallel_env(opponent=lambda observation: np.zeros((3, 2)), episode_s=2)
        still = vsss.parallel_env(opponent="zero:", episode_s=2)
        np.testing.assert_array_equal(play(env, 15, seed=1), play(still, 15, seed=1))

    def test_copies_snapshots_and_pickles(self):
        env = vsss.parallel_env(opponent="emc:", episode_s=1)
        play(env, 4, seed=2)
        snapshot, twin = env.snapshot(), copy.deepcopy(env)
        expected = play(env, 5)
        np.testing.assert_array_equal(play(twin, 5), expected)
        env.restore(snapshot)
        np.testing.assert_array_equal(play(env, 5), expected)
        again = pickle.loads(pickle.dumps(env))
        np.testing.assert_array_equal(play(again, 8, seed=2), play(env, 8, seed=2))

    def test_bad_input(self):
        env = vsss.parallel_env(episode_s=1)
        with self.assertRaisesRegex(vsss.UsageError, "reset"):
            env.step({})
        env.reset(seed=1)
        given = {agent: np.zeros(2) for agent in env.agents}
        with self.assertRaisesRegex(vsss.UsageError, "needed"):
            env.step({k: v for k, v in given.items() if k != "blue_1"})
        with self.assertRaisesRegex(vsss.UsageError, "blue_1"):
            env.step(dict(given, blue_1=np.zeros(3)))
        with self.assertRaisesRegex(vsss.UsageError, "row 1"):
            env.step(dict(given, blue_1=np.array([0, np.nan])))
        env.step(given)
        for kwargs in (dict(learners="blue"), dict(opponent="emc:", learners="both"), dict(threads=2), dict(colour=1)):
            with self.assertRaises(vsss.UsageError):
                vsss.parallel_env(**kwargs)


if __name__ == "__main__":
    unittest.main()
