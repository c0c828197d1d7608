"""render(): pictures of the library's renderer, and a page in the browser for render_mode="human"."""

from __future__ import annotations

import ctypes
import http.server
import os
import struct
import sys
import threading
import time
import zlib
from typing import Any, Optional

import numpy as np

from . import _library as lib

MODES = ["rgb_array", "human"]


class Camera:
    """Draws environments of a Batch: uint8 [height][width][3], top row first."""

    def __init__(self, width_px: int, height_px: int, title: Optional[str] = None) -> None:
        handle = ctypes.c_void_p()
        lib.call("render_new", width_px, height_px, title.encode() if title else None, ctypes.byref(handle))
        self.handle: Optional[ctypes.c_void_p] = handle
        self._pid = os.getpid()
        self.shape = (height_px, width_px, 3)

    def picture(self, batch: Any, env: int) -> np.ndarray:
        rgb = np.empty(self.shape, np.uint8)
        lib.call(f"render_{batch.kind}", self.handle, batch.alive(), env, rgb.ctypes.data, rgb.nbytes)
        return rgb

    def close(self) -> None:
        if self.handle is not None and os.getpid() == self._pid:
            lib.call("render_free", self.handle)
        self.handle = None


def png(rgb: np.ndarray) -> bytes:
    """A picture as a PNG file."""
    height, width, _ = rgb.shape
    rows = np.zeros((height, width * 3 + 1), np.uint8)  # each begins with its filter, none
    rows[:, 1:] = rgb.reshape(height, -1)

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows.tobytes(), 1)) + chunk(b"IEND", b"")


class Page:
    """A page on this machine's loopback that shows the newest picture; no files, no other host."""

    def __init__(self, step_s: float) -> None:
        self.step_s = step_s
        self._newest = b""
        self._changed = threading.Condition()
        self._closed = False
        self._due_s = time.monotonic()
        page = self

        class Handler(http.server.BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                if self.path == "/":
                    self._send("text/html", b"<title>vsss</title><body style='margin:0;background:#222'><img src=pictures>")
                elif self.path == "/pictures":
                    self._stream()
                else:
                    self.send_error(404)

            def _send(self, kind: str, body: bytes) -> None:
                self.send_response(200)
                self.send_header("Content-Type", kind)
                self.send_header("Content-Length", str(len(body)))
                self.end_headers()
                self.wfile.write(body)

            def _stream(self) -> None:
                self.send_response(200)
                self.send_header("Content-Type", "multipart/x-mixed-replace; boundary=next")
                self.end_headers()
                try:
                    for picture in page._pictures():
                        self.wfile.write(b"--next\r\nContent-Type: image/png\r\nContent-Length: %d\r\n\r\n" % len(picture))
                        self.wfile.write(picture + b"\r\n")
                except OSError:
                    pass  # the browser went away

            def log_message(self, *_: Any) -> None:
                pass

        self._server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self._server.daemon_threads = True
        self.port = int(self._server.server_address[1])
        threading.Thread(target=self._server.serve_forever, daemon=True).start()
        print(f"vsss: watch at 127.0.0.1:{self.port} in a browser of this machine", file=sys.stderr)

    def _pictures(self) -> Any:
        shown = None
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._closed or self._newest is not shown, timeout=1)
                if self._closed:
                    return
                picture = self._newest
            if picture and picture is not shown:
                shown = picture
                yield picture

    def show(self, rgb: np.ndarray) -> None:
        """Shows a picture, no sooner than a step's time after the one before."""
        picture = png(rgb)
        with self._changed:
            self._newest = picture
            self._changed.notify_all()
        self._due_s = max(self._due_s + self.step_s, time.monotonic() - self.step_s)
        time.sleep(max(0.0, self._due_s - time.monotonic()))

    def close(self) -> None:
        with self._changed:
            self._closed = True
            self._changed.notify_all()
        self._server.shutdown()
        self._server.server_close()


class Renderer:
    """What every environment's render() does, by its render_mode."""

    def __init__(self, mode: Optional[str], size_px: Any, title: Optional[str], step_s: float) -> None:
        if mode is not None and mode not in MODES:
            raise lib.UsageError(f"render_mode = {mode!r}: allowed are None, 'rgb_array', 'human'")
        self.mode, self.title, self.step_s = mode, title, step_s
        try:
            self.width_px, self.height_px = (int(n) for n in size_px)
        except (TypeError, ValueError):
            raise lib.UsageError(f"render_size = {size_px!r}: give (width, height) in pixels") from None
        self.camera: Optional[Camera] = None
        self.page: Optional[Page] = None

    def render(self, batch: Any, env: int) -> Optional[np.ndarray]:
        if self.mode is None:
            raise lib.UsageError("made without a render_mode: give render_mode='rgb_array' or 'human'")
        batch.alive()
        if self.camera is None:
            self.camera = Camera(self.width_px, self.height_px, self.title)
        rgb = self.camera.picture(batch, env)
        if self.mode == "rgb_array":
            return rgb
        if self.page is None:
            self.page = Page(self.step_s)
        self.page.show(rgb)
        return None

    def close(self) -> None:
        if self.page is not None:
            self.page.close()
            self.page = None
        if self.camera is not None:
            self.camera.close()
            self.camera = None
