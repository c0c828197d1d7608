# Tests deploy/python/vsss: whatever is given, an exception says what and why, and the process lives.
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import threading
import unittest

import gymnasium
import numpy as np

import vsss
from vsss import _library


def small(**kwargs):
    return vsss.make_vec(2, **dict(dict(threads=2, opponent="zero:"), **kwargs))


class RefusedTest(unittest.TestCase):
    def refused(self, pattern, function, *arguments, **kwargs):
        with self.assertRaisesRegex(vsss.UsageError, pattern):
            function(*arguments, **kwargs)

    def test_settings_by_name_with_what_is_allowed(self):
        self.refused("did you mean 'drive'", small, drve="planar")
        self.refused("contact or planar", small, drive="hover")
        self.refused("paper", small, rules="chess")
        self.refused("random", small, placement="here")
        self.refused("paper, dense or goals", small, reward="sparse")
        self.refused("own_distance", small, reward="dense,gaol=3")
        self.refused("allowed are 1 to 4096", vsss.make_vec, 0)
        self.refused("allowed are 1 to 4096", vsss.make_vec, 10**6)
        self.refused("threads", vsss.make_vec, 1, 0)
        self.refused("'blue', 'yellow', 'both'", small, learners="green")
        self.refused("'robot', 'team'", small, rows="world")
        self.refused("'stack', 'frame'", small, observation="pixels")
        self.refused("rgb_array", small, render_mode="ascii")
        self.refused("emc:", small, opponent="ghost:")
        self.refused("emc:", small, opponent=3)
        self.refused("opponent", small, learners="both")
        self.refused("num_envs", small, envs=3)
        self.refused("noise_scale", small, realism={"noise_scal": 1})
        self.refused("low, high", small, realism={"latency_s": "soon"})
        self.refused("allowed", small, realism={"latency_s": 9})
        self.refused("above", small, realism={"latency_s": (0.1, 0.05)})
        self.refused("whole number|number", small, seed="x")
        self.refused("zero byte", small, drive="pla\0nar")
        with self.assertRaisesRegex(vsss.Error, "nowhere.ini"):
            small(realism="/nowhere.ini")
        with self.assertRaisesRegex(vsss.Error, "nowhere.onnx"):
            small(opponent="onnx:/nowhere.onnx")

    def test_actions_of_wrong_shape_kind_or_value(self):
        env = small()
        self.refused("reset", env.step, np.zeros((6, 2)))
        env.reset(seed=1)
        before = env.world()
        self.refused(r"shape \(5, 2\) given, \(6, 2\)", env.step, np.zeros((5, 2)))
        self.refused("shape", env.step, np.zeros(()))
        self.refused("shape", env.step, np.zeros((2, 6)))
        self.refused("numbers", env.step, [["left", "right"]] * 6)
        self.refused("shape|numbers", env.step, None)
        for wrong in (np.nan, np.inf, -np.inf):
            bad = np.zeros((6, 2))
            bad[4, 1] = wrong
            self.refused("row 4, wheel 1", env.step, bad)
        np.testing.assert_array_equal(env.world(), before)
        env.step(np.full((6, 2), 1e30))  # finite: clamped
        env.step(np.zeros((6, 2), int))

    def test_seeds_masks_and_snapshots(self):
        env = small()
        self.refused("mask", env.reset, options={"reset_mask": np.ones(6, bool)})
        env.reset(seed=1)
        self.refused("mask", env.reset, options={"reset_mask": np.ones(5, bool)})
        for seed in (-1, 2**64, 0.5, [1, 2, 3]):
            self.refused("seed", env.reset, seed=seed)
        snapshot = env.snapshot()
        self.refused("bytes", env.restore, "text")
        self.refused("short", env.restore, b"")
        self.refused("cut short|snapshot|bytes", env.restore, snapshot[:-100])
        self.refused("snapshot", env.restore, bytes(len(snapshot)))
        self.refused("other settings", small(opponent="emc:").restore, snapshot)
        self.refused("match 7", env.world, 7)
        self.refused("blue", env.world, 0, "green")
        self.refused("cannot be copied", self._with_function().snapshot)

    @staticmethod
    def _with_function():
        env = small(opponent=vsss.strategy(lambda world, dt_s: np.zeros((3, 2))))
        env.reset(seed=1)
        return env

    def test_a_closed_environment_says_so(self):
        views = []
        for env in (small(), vsss.VSSEnv(), vsss.VSSVectorEnv(2)):
            observation, _ = env.reset(seed=1)
            views.append(observation)
            env.close()
            env.close()
            for call in (lambda: env.reset(), lambda: env.step(np.zeros(env.action_space.shape)), env.snapshot):
                with self.assertRaises(gymnasium.error.ClosedEnvironmentError):
                    call()
        for view in views:  # what was returned stays readable and writable
            view += 1

    def test_a_call_within_a_step_is_refused_and_the_step_tells_why(self):
        holder = {}

        def meddle(world, dt_s):
            if "env" in holder:
                holder["env"].reset()
            return np.zeros((3, 2))

        env = small(opponent=vsss.strategy(meddle))
        env.reset(seed=1)
        holder["env"] = env
        with self.assertRaisesRegex(vsss.Error, "function failed") as caught:
            env.step(np.zeros((6, 2)))
        self.assertIn("has not returned", str(caught.exception.__cause__))
        holder.clear()
        env.reset(seed=1)
        env.step(np.zeros((6, 2)))

    def test_two_threads_never_step_at_once(self):
        env = vsss.make_vec(16, 1, opponent="zero:")
        env.reset(seed=1)
        refused, played, start = [], [], threading.Barrier(2)

        def play():
            start.wait()
            for _ in range(20):
                try:
                    env._batch.step()
                    played.append(1)
                except vsss.UsageError as e:
                    refused.append(str(e))

        threads = [threading.Thread(target=play) for _ in range(2)]
        for t in threads:
            t.start()
        for t in threads:
            t.join()
        self.assertEqual(len(refused) + len(played), 40)
        self.assertTrue(all("has not returned" in text for text in refused))

    def test_what_a_strategy_raises_or_returns_is_told(self):
        for wrong, expected in (
            (lambda w, dt: 1 / 0, "division"),
            (lambda w, dt: np.zeros((2, 2)), "shape"),
            (lambda w, dt: np.full((3, 2), np.nan), "finite"),
        ):
            env = small(opponent=vsss.strategy(wrong))
            env.reset(seed=1)
            with self.assertRaises(vsss.Error) as caught:
                env.step(np.zeros((6, 2)))
            self.assertIn(expected, str(caught.exception.__cause__))
        def interrupt(world, dt_s):
            raise KeyboardInterrupt

        env = small(opponent=vsss.strategy(interrupt))
        env.reset(seed=1)
        with self.assertRaises(KeyboardInterrupt):
            env.step(np.zeros((6, 2)))
        with self.assertRaises(vsss.UsageError):
            vsss.strategy("emc:")
        env = small(opponent=lambda observation: np.zeros((1, 2)))
        env.reset(seed=1)
        self.refused("opponent: returned shape", env.step, np.zeros((6, 2)))

    def test_evaluate_refuses(self):
        self.refused("matches", vsss.evaluate, "zero:", "zero:", 0)
        self.refused("ghost:", vsss.evaluate, "ghost:", "zero:", 1)
        self.refused("returned shape", vsss.evaluate, lambda o: np.zeros(3), "zero:", 1)


class ProcessTest(unittest.TestCase):
    """Each in a process of its own, with faulthandler: a crash would be a signal, not an exit status."""

    def python(self, code, **environment):
        return subprocess.run(
            [sys.executable, "-X", "faulthandler", "-c", code],
            env={**os.environ, **environment},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=300,
        )

    def test_a_fork_is_told_to_make_its_own(self):
        done = self.python(
            "import os, sys, warnings, vsss, numpy as np\n"
            "warnings.simplefilter('ignore')  # Python 3.12 and later warn of a fork with threads\n"
            "env = vsss.make_vec(2, 2, opponent='zero:'); env.reset(seed=1)\n"
            "child = os.fork()\n"
            "if child == 0:\n"
            "  try: env.step(np.zeros((6, 2)))\n"
            "  except vsss.UsageError as e: print(e, flush=True)\n"
            "  own = vsss.make_vec(2, 2, opponent='zero:'); own.reset(seed=1); own.step(np.zeros((6, 2)))\n"
            "  print('own plays', flush=True)\n"
            "  del env; sys.exit(0)\n"
            "_, status = os.waitpid(child, 0)\n"
            "env.step(np.zeros((6, 2))); env.close()\n"
            "print('status', status)\n"
        )
        self.assertEqual(done.returncode, 0, done.stdout)
        for line in ("after the fork", "own plays", "status 0"):
            self.assertIn(line, done.stdout)
        self.assertEqual(len(done.stdout.splitlines()), 3, done.stdout)

    def test_an_end_without_close_and_a_collected_environment(self):
        done = self.python(
            "import vsss, numpy as np, gc\n"
            "for i in range(5):\n"
            "  env = vsss.make_vec(2, 2, opponent='emc:'); o, _ = env.reset(seed=1)\n"
            "  env.step(np.zeros((6, 2))); del env; gc.collect(); o.sum()\n"
            "kept = vsss.make_vec(2, 2, opponent=vsss.strategy(lambda w, dt: [[1, 1]] * 3)); kept.reset(seed=1)\n"
            "kept.step(np.zeros((6, 2)))\n"
        )
        self.assertEqual((done.returncode, done.stdout), (0, ""))

    def test_a_library_of_another_version_is_refused(self):
        compiler = shutil.which("cc")
        if not compiler:
            self.skipTest("no C compiler")
        functions = "".join(f"int vs_capi_{name}(void) {{ return 1; }}\n" for name in _library._FUNCTIONS)
        functions += "const char *vs_capi_name(void) { return 0; }\n"
        functions += "".join(f"int vs_capi_{n}(void) {{ return 0; }}\n" for n in ("vec_envs", "vec_rows", "vss_envs", "seed"))
        said = (  # an older library that knows its own version alone
            "#include <stdio.h>\n#include <stdint.h>\n"
            "int vs_capi_hello(uint32_t v, uint32_t size, uint32_t *about, char *error, unsigned long n) {\n"
            "  %s }\n"
        )
        cases = {
            'snprintf(error, n, "libvsss speaks version 7"); return 2;': "speaks version 7",
            "about[0] = size; about[1] = 9; return 0;": "version 9",
            "about[0] = 5; about[1] = v; return 0;": "5 bytes",
        }
        with tempfile.TemporaryDirectory() as folder:
            source, library = pathlib.Path(folder, "other.c"), pathlib.Path(folder, "libvsss.so")
            for body, expected in cases.items():
                source.write_text(said % body + functions)
                subprocess.run([compiler, "-w", "-shared", "-fPIC", "-o", library, source], check=True)
                done = self.python("import vsss", VSSS_LIBRARY=str(library))
                self.assertEqual(done.returncode, 1)
                self.assertIn("ImportError", done.stdout)
                self.assertIn(expected, done.stdout)
            source.write_text("int nothing;")
            subprocess.run([compiler, "-shared", "-fPIC", "-o", library, source], check=True)
            for path, expected in ((str(library), "from one release"), ("/nowhere.so", "VSSS_LIBRARY"), (str(source), "VSSS_LIBRARY")):
                done = self.python("import vsss", VSSS_LIBRARY=path)
                self.assertEqual(done.returncode, 1)
                self.assertIn(expected, done.stdout)

    def test_an_interrupt_ends_an_evaluation(self):
        done = self.python(
            "import vsss, threading, signal, os\n"
            "def stop(finished, matches): signal.raise_signal(signal.SIGINT)\n"
            "try: vsss.evaluate('zero:', 'zero:', 50, episode_s=1, slots=2, progress=stop)\n"
            "except KeyboardInterrupt: print('interrupted')\n"
        )
        self.assertEqual((done.returncode, done.stdout), (0, "interrupted\n"))


if __name__ == "__main__":
    unittest.main()
