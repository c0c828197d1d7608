# Tests deploy/python/vsss/_render.py: pictures where a renderer is there, a clear error where not.
import http.client
import threading
import time
import unittest
import zlib

import numpy as np

import vsss
from vsss import _render


def picture_or_skip(test, env):
    try:
        return env.render()
    except vsss.UsageError:
        raise
    except vsss.Error as e:
        test.assertRegex(str(e), "EGL|libgl|OpenGL|install|apt")
        test.skipTest(f"no renderer: {e}")


class RenderTest(unittest.TestCase):
    def test_every_environment_has_pictures(self):
        envs = [
            vsss.make_vec(2, opponent="zero:", render_mode="rgb_array", render_size=(320, 200)),
            vsss.VSSEnv(render_mode="rgb_array", render_size=(320, 200)),
            vsss.parallel_env(render_mode="rgb_array", render_size=(320, 200)),
        ]
        for env in envs:
            env.reset(seed=1)
            rgb = picture_or_skip(self, env)
            rgb = rgb[0] if isinstance(rgb, tuple) else rgb
            self.assertEqual((rgb.shape, rgb.dtype), ((200, 320, 3), np.uint8))
            self.assertGreater(len(np.unique(rgb.reshape(-1, 3), axis=0)), 20)  # a field, not one colour
            env.close()

    def test_without_a_mode_or_with_a_wrong_size(self):
        env = vsss.VSSEnv()
        env.reset(seed=1)
        with self.assertRaisesRegex(vsss.UsageError, "render_mode"):
            env.render()
        with self.assertRaisesRegex(vsss.UsageError, "render_size"):
            vsss.VSSEnv(render_mode="rgb_array", render_size="big")
        env = vsss.VSSEnv(render_mode="rgb_array", render_size=(3, 100000))
        env.reset(seed=1)
        with self.assertRaises(vsss.Error):
            env.render()

    def test_a_png_has_the_pixels(self):
        rgb = np.random.default_rng(1).integers(0, 255, (4, 5, 3)).astype(np.uint8)
        data = _render.png(rgb)
        self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
        start = data.index(b"IDAT") + 4
        size = int.from_bytes(data[start - 8 : start - 4], "big")
        rows = np.frombuffer(zlib.decompress(data[start : start + size]), np.uint8).reshape(4, 16)
        np.testing.assert_array_equal(rows[:, 1:].reshape(4, 5, 3), rgb)

    def test_the_page_shows_pictures_and_keeps_time(self):
        page = _render.Page(0.02)
        try:
            connection = http.client.HTTPConnection("127.0.0.1", page.port, timeout=20)
            connection.request("GET", "/")
            self.assertIn(b"pictures", connection.getresponse().read())
            connection.request("GET", "/pictures")
            stream = connection.getresponse()
            feed = threading.Thread(target=lambda: [page.show(np.zeros((4, 4, 3), np.uint8)) for _ in range(10)])
            start = time.monotonic()
            feed.start()
            self.assertEqual(stream.readline().strip(), b"--next")
            self.assertIn(b"image/png", stream.readline())
            feed.join()
            self.assertGreater(time.monotonic() - start, 0.15)
        finally:
            page.close()


if __name__ == "__main__":
    unittest.main()
