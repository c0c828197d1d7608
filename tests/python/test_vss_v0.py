# Tests deploy/python/vsss/vss_v0.py: what a script written for rSoccer's VSS-v0 relies on.
import copy
import pickle
import unittest
import warnings

import gymnasium
import numpy as np
from gymnasium.utils.env_checker import check_env

import vsss


def play(env, steps):
    out = []
    for i in range(steps):
        action = np.random.default_rng(i).uniform(-1, 1, 2).astype(np.float32)
        observation, reward, *_ = env.step(action)
        out.append(np.append(observation, reward))
    return np.array(out)


class VSSTest(unittest.TestCase):
    def test_the_checker_of_gymnasium_passes(self):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            warnings.filterwarnings("ignore", ".*alternative render modes.*|.*not having a spec.*")
            check_env(vsss.VSSEnv(), skip_render_check=True)

    def test_a_script_written_for_rsoccer_runs(self):
        env = gymnasium.make("VSS-v0")
        self.assertEqual((env.observation_space.shape, env.action_space.shape), ((40,), (2,)))
        self.assertAlmostEqual(float(env.observation_space.high[0]), 1.2, places=6)
        observation, info = env.reset(seed=4)
        steps, total = 0, 0.0
        over = cut = False
        while not (over or cut):
            observation, reward, over, cut, info = env.step(np.zeros(2, np.float32))
            steps, total = steps + 1, total + reward
            self.assertIn(observation, env.observation_space)
        self.assertEqual(set(info), {"goal_score", "move", "ball_grad", "energy", "goals_blue", "goals_yellow"})
        self.assertTrue(steps == 1200 if cut else info["goals_blue"] + info["goals_yellow"] == 1)
        shaped = info["move"] + info["ball_grad"] + info["energy"] + 10 * info["goal_score"]
        self.assertAlmostEqual(total, shaped, places=3)
        self.assertEqual(info["energy"], 0)
        env.close()

    def test_an_episode_is_cut_after_1200_steps_of_25_ms(self):
        env = vsss.VSSVectorEnv(4)
        env.reset(seed=1)
        cuts, age = 0, np.zeros(4, int)
        for _ in range(1201):
            _, _, terminated, truncated, infos = env.step(np.zeros((4, 2)))
            age += 1
            np.testing.assert_array_equal(truncated, (age == 1200) & ~terminated)
            cuts += int(truncated.sum())
            for i in np.flatnonzero(truncated):
                self.assertEqual(infos["final_obs"][i].shape, (40,))
            age[terminated | truncated] = 0
        self.assertGreater(cuts, 0)

    def test_forward_is_forward(self):
        env = vsss.VSSEnv(realism=None)
        moved = 0
        for seed in range(6):
            observation, _ = env.reset(seed=seed)
            heading = observation[7], observation[6]  # cos, sin of blue 0
            for _ in range(8):
                after, *_ = env.step(np.ones(2, np.float32))
            moved += (after[4] - observation[4]) * heading[0] + (after[5] - observation[5]) * heading[1] > 0.02
        self.assertGreaterEqual(moved, 4)  # some stand before a wall

    def test_seeds_copies_and_pickles(self):
        env = vsss.VSSEnv()
        first, _ = env.reset(seed=3)
        expected = play(env, 30)
        other, _ = env.reset()
        self.assertTrue((other != first).any())
        np.testing.assert_array_equal(env.reset(seed=3)[0], first)
        twin, again = copy.deepcopy(env), pickle.loads(pickle.dumps(env))
        again.reset(seed=3)
        snapshot = env.snapshot()
        for where in (env, twin, again):
            np.testing.assert_array_equal(play(where, 30), expected)
        env.restore(snapshot)
        np.testing.assert_array_equal(play(env, 30), expected)

    def test_many_are_the_same_whatever_the_threads(self):
        results = []
        for threads in (1, 2):
            env = gymnasium.make_vec("vsss/VSS-v0", 5, vectorization_mode="vector_entry_point", threads=threads)
            rows = [env.reset(seed=2)[0].copy()]
            for i in range(40):
                rows.append(env.step(np.random.default_rng(i).uniform(-1, 1, (5, 2)))[0].copy())
            results.append(np.array(rows))
        np.testing.assert_array_equal(results[0], results[1])
        alone = vsss.VSSEnv()
        self.assertEqual(results[0].shape, (41, 5, 40))
        alone.close()

    def test_bad_input(self):
        env = vsss.VSSEnv()
        with self.assertRaisesRegex(vsss.UsageError, "reset"):
            env.step(np.zeros(2))
        env.reset(seed=1)
        for wrong in (np.zeros(3), 1.0, [np.nan, 0], "left", None):
            with self.assertRaises(vsss.UsageError):
                env.step(wrong)
        env.step([2, -7])  # clipped
        with self.assertRaisesRegex(vsss.UsageError, "contact or planar"):
            vsss.VSSEnv(drive="hover")


if __name__ == "__main__":
    unittest.main()
