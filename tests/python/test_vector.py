# Tests deploy/python/vsss/vector.py and _batch.py: seeds, views, ends of episodes, rows, rewards, copies.
import copy
import pickle
import unittest

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode

import vsss


def short(n=4, **kwargs):
    """Matches of one second, ten steps."""
    return vsss.make_vec(n, **dict(dict(threads=2, opponent="emc:", episode_s=1), **kwargs))


def actions(env, step):
    rng = np.random.default_rng(step)
    return rng.uniform(-1, 1, env.action_space.shape).astype(np.float32)


def run(env, steps, first=0):
    """Everything that the steps return, in one array."""
    out = []
    for i in range(first, first + steps):
        observation, reward, terminated, truncated, _ = env.step(actions(env, i))
        out.append(np.concatenate([observation.ravel(), reward, terminated, truncated]))
    return np.array(out)


class VectorTest(unittest.TestCase):
    def test_spaces_fit_what_comes(self):
        env = short()
        self.assertIsInstance(env, gymnasium.vector.VectorEnv)
        self.assertEqual(env.num_envs, 12)
        self.assertIs(env.metadata["autoreset_mode"], AutoresetMode.SAME_STEP)
        observation, infos = env.reset(seed=1)
        self.assertEqual(infos, {})
        for i in range(12):
            self.assertIn(observation, env.observation_space)
            observation, reward, terminated, truncated, infos = env.step(actions(env, i))
            self.assertEqual((reward.dtype, terminated.dtype, truncated.dtype), (np.float32, np.bool_, np.bool_))
            self.assertEqual(infos["reward_terms"].shape, (12, len(vsss.reward_terms())))
        env.close()

    def test_same_seed_same_rows_whatever_the_threads(self):
        results = []
        for threads in (1, 3):
            env = short(threads=threads)
            first, _ = env.reset(seed=5)
            results.append((first.copy(), run(env, 25)))
            env.close()
        np.testing.assert_array_equal(results[0][0], results[1][0])
        np.testing.assert_array_equal(results[0][1], results[1][1])

    def test_seeds_are_honoured_and_without_one_episodes_go_on(self):
        env = short()
        a = env.reset(seed=5)[0].copy()
        b = env.reset()[0].copy()
        c = env.reset(seed=6)[0].copy()
        self.assertTrue((a != b).any() and (a != c).any())
        np.testing.assert_array_equal(env.reset(seed=5)[0], a)
        np.testing.assert_array_equal(env.reset()[0], b)
        d = env.reset(seed=[9, 8, 9, 7])[0].copy()
        np.testing.assert_array_equal(d[0:3], d[6:9])
        self.assertTrue((d[0:3] != d[3:6]).any())
        self.assertTrue((short().reset()[0] != short().reset()[0]).any())  # nobody chose a seed
        np.testing.assert_array_equal(short(seed=3).reset()[0], short(seed=3).reset()[0])

    def test_observations_are_the_librarys_own_arrays_and_last_one_more_step(self):
        env = short()
        first, _ = env.reset(seed=1)
        self.assertTrue(any(np.shares_memory(first, s["observation"]) for s in env._batch.arrays))
        kept = first.copy()
        second = env.step(actions(env, 0))[0]
        np.testing.assert_array_equal(first, kept)  # still there
        self.assertFalse(np.shares_memory(first, second))
        third = env.step(actions(env, 1))[0]
        self.assertTrue(np.shares_memory(first, third))  # no third array: none was allocated

    def test_every_ended_episode_has_its_last_observation_and_score(self):
        env = short(8, opponent="random:", start_open=1.0, episode_s=3)
        names = vsss.observation_names()
        left = len(names) * 7 + names.index("time_left")
        env.reset(seed=2)
        goals = clocks = 0
        for _ in range(150):
            observation, reward, terminated, truncated, infos = env.step(np.ones(env.action_space.shape))
            done = terminated | truncated
            self.assertEqual("final_obs" in infos, bool(done.any()))
            if not done.any():
                continue
            np.testing.assert_array_equal(infos["_final_obs"], done)
            for row in range(env.num_envs):
                self.assertEqual(infos["final_obs"][row] is None, not done[row])
                if not done[row]:
                    continue
                score, seconds = infos["final_info"]["score"][row], infos["final_info"]["episode_s"][row]
                self.assertEqual(abs(score[0] - score[1]), int(terminated[row]))
                self.assertAlmostEqual(float(infos["final_obs"][row][left]), (3 - seconds) / 3, places=3)
                self.assertAlmostEqual(float(observation[row][left]), 1, places=3)
                if terminated[row]:
                    goals += 1
                    self.assertEqual(np.sign(reward[row]), np.sign(score[0] - score[1]))
                    self.assertEqual(vsss.event_names()[infos["event"][row]], "goal")
                else:
                    clocks += 1
                    self.assertEqual(vsss.event_names()[infos["event"][row]], "end")
        self.assertGreater(goals, 0)
        self.assertGreater(clocks, 0)

    def test_rewards_are_the_weighted_terms(self):
        text = "paper,goal=3,progress=0.5"
        env = short(reward=text)
        weights = np.array(list(vsss.reward_weights(text).values()))
        self.assertEqual(vsss.reward_weights(text)["goal"], 3)
        env.reset(seed=1)
        for i in range(15):
            _, reward, _, _, infos = env.step(actions(env, i))
            np.testing.assert_allclose(reward, infos["reward_terms"] @ weights, atol=1e-5)

    def test_a_row_per_team_is_three_robots_side_by_side(self):
        robots, teams = short(), short(rows="team")
        self.assertEqual(teams.num_envs, 4)
        a, b = robots.reset(seed=4)[0], teams.reset(seed=4)[0]
        for i in range(25):
            np.testing.assert_array_equal(a.reshape(4, -1), b)
            given = actions(robots, i)
            a, reward_a, over_a, cut_a, infos_a = robots.step(given)
            b, reward_b, over_b, cut_b, infos_b = teams.step(given.reshape(4, -1))
            np.testing.assert_allclose(reward_a.reshape(4, 3).mean(axis=1), reward_b, atol=1e-6)
            np.testing.assert_array_equal(over_a[::3], over_b)
            np.testing.assert_array_equal(cut_a[::3], cut_b)
            if cut_b.any():
                match = int(np.flatnonzero(cut_b)[0])
                robots_of = list(infos_a["final_obs"][3 * match : 3 * match + 3])
                np.testing.assert_array_equal(np.concatenate(robots_of), infos_b["final_obs"][match])

    def test_the_newest_frame_alone(self):
        stack, frame = short(), short(observation="frame")
        self.assertEqual(frame.single_observation_space.shape, (58,))
        np.testing.assert_array_equal(stack.reset(seed=1)[0][:, -58:], frame.reset(seed=1)[0])
        np.testing.assert_array_equal(run(stack, 3)[:, -36:], run(frame, 3)[:, -36:])

    def test_both_teams_learn(self):
        env = short(learners="both", opponent=None)
        self.assertEqual(env.num_envs, 24)
        env.reset(seed=1)
        for i in range(11):
            _, _, _, truncated, infos = env.step(actions(env, i))
        scores = None
        env.reset(seed=1)
        for i in range(40):
            *_, infos = env.step(actions(env, i))
            if "final_info" in infos:
                scores = infos["final_info"]["score"].reshape(4, 2, 3, 2)
                np.testing.assert_array_equal(scores[:, 0], scores[:, 1, :, ::-1])
        self.assertIsNotNone(scores)

    def test_opponents_are_uris_functions_and_strategies_alike(self):
        def still(observation):
            return np.zeros((len(observation), 2))

        @vsss.strategy
        def stand(world, dt_s):
            return np.zeros((3, 2))

        results = []
        for opponent in ("zero:", still, stand):
            env = short(opponent=opponent)
            first = env.reset(seed=3)[0].copy()
            self.assertEqual(first.shape, (12, 464))
            results.append(np.concatenate([first.ravel(), run(env, 15).ravel()]))
            env.close()
        np.testing.assert_array_equal(results[0], results[1])
        np.testing.assert_array_equal(results[0], results[2])
        yellow = short(opponent=still, learners="yellow")
        blue_is_still = short(opponent="zero:", learners="yellow")
        np.testing.assert_array_equal(yellow.reset(seed=1)[0], blue_is_still.reset(seed=1)[0])
        np.testing.assert_array_equal(run(yellow, 12), run(blue_is_still, 12))

    def test_a_snapshot_continues_bit_for_bit_here_and_in_a_copy(self):
        env = short()
        env.reset(seed=1)
        run(env, 4)
        snapshot = env.snapshot()
        expected = run(env, 20, first=4)
        twin = None
        for where in (env, short(threads=1)):
            np.testing.assert_array_equal(where.restore(snapshot), where._batch.current["observation"])
            if twin is None:
                twin = copy.deepcopy(where)
            np.testing.assert_array_equal(run(where, 20, first=4), expected)
        np.testing.assert_array_equal(run(twin, 20, first=4), expected)

    def test_a_pickle_is_the_configuration(self):
        env = short(realism={"latency_s": (0.0, 0.05), "noise": False}, reward="paper")
        env.reset(seed=2)
        run(env, 3)
        again = pickle.loads(pickle.dumps(env))
        np.testing.assert_array_equal(again.reset(seed=2)[0], env.reset(seed=2)[0])
        np.testing.assert_array_equal(run(again, 12), run(env, 12))

    def test_realism_changes_what_is_seen_and_its_file_is_found(self):
        quiet = short(realism={"noise": False}).reset(seed=1)[0]
        loud = short(realism={"noise_scale": (3, 4)}).reset(seed=1)[0]
        file = short(realism="deploy/config/realism.ini").reset(seed=1)[0]
        self.assertTrue((quiet != loud).any() and (quiet != file).any())

    def test_a_mask_restarts_the_named_alone(self):
        env = short()
        env.reset(seed=1)
        before = env.step(actions(env, 0))[0].copy()
        mask = np.zeros(12, bool)
        mask[3:6] = True
        after, _ = env.reset(options={"reset_mask": mask})
        np.testing.assert_array_equal(after[:3], before[:3])
        np.testing.assert_array_equal(after[6:], before[6:])
        self.assertTrue((after[3:6] != before[3:6]).any())

    def test_gymnasium_makes_and_wraps_it(self):
        env = gymnasium.make_vec("vsss/Match-v0", num_envs=2, vectorization_mode="vector_entry_point", episode_s=1)
        env = gymnasium.wrappers.vector.RecordEpisodeStatistics(env)
        env.reset(seed=1)
        seen = 0
        for i in range(12):
            *_, infos = env.step(actions(env, i))
            seen += "episode" in infos
        self.assertGreater(seen, 0)
        env.close()

    def test_worlds_are_seen_from_a_team(self):
        env = short()
        env.reset(seed=1)
        absolute, blue, yellow = (env.world(1, team) for team in (None, "blue", "yellow"))
        np.testing.assert_array_equal(absolute, blue)
        np.testing.assert_allclose(yellow[4:6], -blue[4:6])  # the ball, turned by half a turn
        np.testing.assert_allclose(yellow[8:10], -blue[8 + 18 : 8 + 20])  # own robot 0 is the other's adversary 0
        self.assertTrue((env.world(1, measured=True) != absolute).any())


if __name__ == "__main__":
    unittest.main()
