# Tests deploy/python/vsss/evaluation.py, policy.py and strategy.py
import json
import pathlib
import pickle
import subprocess
import tempfile
import unittest

import numpy as np

import vsss

ROOT = pathlib.Path(__file__).resolve().parents[2]
try:
    import onnxruntime
except ImportError:
    onnxruntime = None
TOO_OLD = onnxruntime is not None and tuple(map(int, onnxruntime.__version__.split(".")[:2])) < (1, 20)


class EvaluationTest(unittest.TestCase):
    def test_the_table_is_that_of_vsss_eval(self):
        program = ROOT / "vsss"
        if not program.exists():
            self.skipTest("no ./vsss here")
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder, "eval.json")
            subprocess.run(
                [program, "eval", "--blue", "emc:", "--against", "inf:", "--matches", "5", "--seconds", "20"]
                + ["--placement", "random", "--seed", "3", "--drive", "planar", "--json", out],
                check=True,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
            report = json.loads(out.read_text())
        ours = vsss.evaluate("emc:", "inf:", 5, episode_s=20, placement="random", seed=3, drive="planar", slots=2)
        (series,) = report["series"]
        self.assertEqual([m["score"] for m in series["matches"]], ours.scores.tolist())
        # What needs every frame of a match, which a vector environment does not show.
        frames = {"still_share", "penalty_goals_for", "penalty_goals_against", "free_ball_goals_for"}
        frames |= {"free_ball_goals_against", "idle_warnings", "idle_warnings_against"}
        frames |= {"idle_sent_off", "idle_sent_off_against"}
        # Of knockout matches, and of rules that the table of a vector environment does not count.
        frames |= {"extra_time", "shoot_out", "lot", "free_kicks"}
        self.assertEqual({name for name in series["summary"] if not hasattr(ours, name)}, frames)
        for name, theirs in series["summary"].items():
            if name in frames:
                continue
            if isinstance(theirs, dict):
                self.assertAlmostEqual(getattr(ours, name), theirs["mean"], 6, name)
                self.assertAlmostEqual(ours.interval[name][0], theirs["low"], 6, name)
                self.assertAlmostEqual(ours.interval[name][1], theirs["high"], 6, name)
            else:
                self.assertAlmostEqual(getattr(ours, name), theirs, 4, name)
        self.assertIn("5 matches against inf:", str(ours))

    def test_a_strategy_plays_either_side(self):
        @vsss.strategy
        class Chase:
            """Every robot drives at the ball."""

            made = []

            def __init__(self, seed):
                self.calls = 0
                Chase.function.made.append(seed)

            def __call__(self, world, dt_s):
                self.calls += 1
                assert abs(dt_s - 1 / 30) < 1e-9 and world.own.shape == (3, 6) and world.ball.shape == (4,)
                to = world.ball[:2] - world.own[:, :2]
                turn = np.arctan2(to[:, 1], to[:, 0]) - world.own[:, 2]
                turn = np.arctan2(np.sin(turn), np.cos(turn))
                return np.stack([20 - 10 * turn, 20 + 10 * turn], axis=1)

        blue = vsss.evaluate(Chase, "zero:", 3, episode_s=60, drive="planar", placement="random")
        self.assertGreaterEqual(len(set(Chase.function.made)), 3)  # each match has its own seed
        self.assertGreater(blue.score, 0)
        yellow = vsss.evaluate("zero:", Chase, 3, episode_s=60, drive="planar", placement="random")
        self.assertLess(yellow.score, 0)
        again = vsss.evaluate(Chase, "zero:", 3, episode_s=60, drive="planar", placement="random")
        self.assertEqual(again.score, blue.score)

    @unittest.skipIf(onnxruntime is None, "onnxruntime is not installed")
    def test_the_policy_as_function_and_as_player(self):
        policy = vsss.Policy()
        rows = np.random.default_rng(1).uniform(-1, 1, (6, 464)).astype(np.float32)
        action = policy(rows)
        self.assertEqual(action.shape, (6, 2))
        self.assertLessEqual(np.abs(action).max(), 1)
        np.testing.assert_allclose(policy(rows[2]), action[2], atol=1e-5)
        again = pickle.loads(pickle.dumps(policy))
        np.testing.assert_array_equal(again(rows), action)
        with self.assertRaisesRegex(vsss.UsageError, "464"):
            policy(rows[:, :58])
        with self.assertRaisesRegex(vsss.Error, "nowhere"):
            vsss.Policy("/nowhere.onnx")
        with tempfile.NamedTemporaryFile(suffix=".onnx") as file:
            file.write(b"no model")
            file.flush()
            with self.assertRaisesRegex(vsss.Error, "cannot be opened"):
                vsss.Policy(file.name)
        function = vsss.evaluate(lambda o: policy(o), "random:", 2, episode_s=20, drive="planar")
        self.assertGreater(function.score, 0)
        if TOO_OLD:
            self.skipTest("onnxruntime before 1.20: the library's onnx: wants a newer one; Policy() itself was tested")
        player = vsss.evaluate(policy, "random:", 2, episode_s=20, drive="planar")
        self.assertAlmostEqual(function.score, player.score, delta=1.01)  # batches of other sizes round otherwise


if __name__ == "__main__":
    unittest.main()
