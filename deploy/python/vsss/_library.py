"""libvsss through ctypes: found, shaken hands with, its functions declared, its errors turned into exceptions."""

from __future__ import annotations

import ctypes
import ctypes.util
import os
import pathlib
import sys
from typing import Any, Dict, List, Optional

import numpy as np

VERSION = 1  # VS_CAPI_VERSION of include/vsss/capi.h, which this package was written for
_ERROR_SIZE = 640
_FAIL, _USAGE = 1, 2


class Error(RuntimeError):
    """A run that failed: a file, a device, numerics. The text names what, and the fix."""


class UsageError(Error, ValueError):
    """A request that was wrong: a setting, a shape, a number, a call at the wrong time. Nothing has changed."""


_INTS = (
    "team_size observation frame action reward_terms event_kinds world vss_observation vss_action vss_shaping summary "
    "decision_hz vss_hz"
)
_FIELDS: Any = [
    ("size", ctypes.c_uint32),
    ("version", ctypes.c_uint32),
    *((name, ctypes.c_int32) for name in _INTS.split()),
    ("wheel_limit_radps", ctypes.c_double),
    ("contract", ctypes.c_char * 24),
    ("release", ctypes.c_char * 32),
]


class About(ctypes.Structure):
    """vs_capi_about of include/vsss/capi.h: the one struct that crosses the border, checked by size and version."""

    _fields_ = _FIELDS


_POINTER, _INT, _SIZE, _TEXT = ctypes.c_void_p, ctypes.c_int, ctypes.c_size_t, ctypes.c_char_p
_U64 = ctypes.c_uint64

THINK = ctypes.CFUNCTYPE(
    _INT, ctypes.c_int64, _U64, ctypes.POINTER(ctypes.c_double), ctypes.c_double, ctypes.POINTER(ctypes.c_double)
)
BEGIN = ctypes.CFUNCTYPE(_INT, ctypes.c_int64, _U64, _U64)
END = ctypes.CFUNCTYPE(None, ctypes.c_int64, _U64)

# Arguments before (error, error_size), which every one of these has.
_FUNCTIONS: Dict[str, List[Any]] = {
    "find": [_TEXT, _TEXT, _SIZE],
    "reward": [_TEXT, _POINTER],
    "vec_new": [_POINTER, _POINTER],
    "vec_free": [_POINTER],
    "vec_bind": [_POINTER, _INT, _TEXT, _POINTER, _SIZE],
    "vec_reset": [_POINTER, _INT, _POINTER, _INT, _POINTER],
    "vec_start": [_POINTER, _INT, _INT, _U64],
    "vec_step": [_POINTER, _INT],
    "vec_player": [_POINTER, _INT, _INT, _TEXT],
    "vec_hash": [_POINTER, _POINTER],
    "vec_state_size": [_POINTER, _POINTER],
    "vec_save": [_POINTER, _POINTER, _SIZE],
    "vec_restore": [_POINTER, _POINTER, _SIZE],
    "vec_world": [_POINTER, _INT, _INT, _INT, _POINTER],
    "vss_new": [_POINTER, _POINTER],
    "vss_free": [_POINTER],
    "vss_bind": [_POINTER, _INT, _TEXT, _POINTER, _SIZE],
    "vss_reset": [_POINTER, _INT, _POINTER, _INT, _POINTER],
    "vss_step": [_POINTER, _INT],
    "vss_state_size": [_POINTER, _POINTER],
    "vss_save": [_POINTER, _POINTER, _SIZE],
    "vss_restore": [_POINTER, _POINTER, _SIZE],
    "render_new": [_INT, _INT, _TEXT, _POINTER],
    "render_free": [_POINTER],
    "render_vec": [_POINTER, _POINTER, _INT, _POINTER, _SIZE],
    "render_vss": [_POINTER, _POINTER, _INT, _POINTER, _SIZE],
    "players": [_TEXT, _POINTER, _POINTER, _POINTER],
    "sum_up": [_INT, _POINTER, _POINTER, _POINTER, _POINTER],
}


def _candidates() -> List[str]:
    here = pathlib.Path(__file__).resolve().parent
    given = os.environ.get("VSSS_LIBRARY")
    if given:
        return [given]
    paths = [here / "lib" / "libvsss.so"]  # in a wheel
    checkout = here.parents[2]
    if (checkout / "models" / "vsss_planar.xml").exists():
        paths.append(checkout / "build" / "plain" / "libvsss.so")
    found = [str(p) for p in paths if p.exists()]
    return found or ["libvsss.so.1", "libvsss.so", "/usr/local/lib/libvsss.so"]


def _load() -> ctypes.CDLL:
    reasons = []
    for path in _candidates():
        try:
            return ctypes.CDLL(path)
        except OSError as e:
            reasons.append(str(e))
    raise ImportError(
        "libvsss.so not found (" + "; ".join(reasons) + "): install the wheel, run 'make build/plain/libvsss.so' in a "
        "checkout, or set VSSS_LIBRARY to its path"
    )


def _declare(library: ctypes.CDLL) -> None:
    path = getattr(library, "_name", "libvsss.so")
    try:
        library.vs_capi_hello
        for name in _FUNCTIONS:
            getattr(library, "vs_capi_" + name)
    except AttributeError as e:
        raise ImportError(f"{path} is not the libvsss of this package ({e}): install both from one release") from None
    library.vs_capi_name.restype = _TEXT
    library.vs_capi_name.argtypes = [_TEXT, _INT]
    for name, arguments in _FUNCTIONS.items():
        function = getattr(library, "vs_capi_" + name)
        function.restype = _INT
        function.argtypes = arguments + [_TEXT, _SIZE]
    library.vs_capi_seed.restype = _U64
    library.vs_capi_seed.argtypes = [_U64, _U64]
    for name in ("vec_envs", "vec_rows", "vss_envs"):
        getattr(library, "vs_capi_" + name).argtypes = [_POINTER]


def _shake_hands(library: ctypes.CDLL) -> About:
    about = About()
    error = ctypes.create_string_buffer(_ERROR_SIZE)
    hello = library.vs_capi_hello
    hello.restype = _INT
    hello.argtypes = [ctypes.c_uint32, ctypes.c_uint32, ctypes.POINTER(About), _TEXT, _SIZE]
    if hello(VERSION, ctypes.sizeof(About), ctypes.byref(about), error, _ERROR_SIZE) != 0:
        said = error.value.decode(errors="replace")
        raise ImportError(f"{library._name}: {said}")
    if about.version != VERSION or about.size != ctypes.sizeof(About):
        raise ImportError(
            f"{library._name} speaks version {about.version} of its interface ({about.size} bytes), this package "
            f"version {VERSION} ({ctypes.sizeof(About)} bytes): install both from one release"
        )
    return about


def _find_home() -> None:
    """Lets the library find models/ in a checkout; a wheel has them beside the library."""
    checkout = pathlib.Path(__file__).resolve().parents[3]
    if "VSSS_HOME" not in os.environ and (checkout / "models" / "vsss_planar.xml").exists():
        os.environ["VSSS_HOME"] = str(checkout)


def _find_onnxruntime() -> None:
    """Lets the library's onnx: players use the onnxruntime package, where it is installed."""
    if "VSSS_ONNXRUNTIME" in os.environ:
        return
    for folder in sys.path:
        for path in sorted(pathlib.Path(folder or ".").glob("onnxruntime/capi/libonnxruntime.so.*")):
            os.environ["VSSS_ONNXRUNTIME"] = str(path)
            return


if not sys.platform.startswith("linux"):
    raise ImportError("vsss runs on Linux alone")
_find_home()
_find_onnxruntime()
library = _load()
_declare(library)
about = _shake_hands(library)

pending: List[BaseException] = []  # raised in a function that the library called; see strategy.py


def raise_status(status: int, text: str) -> None:
    cause = pending.pop() if pending else None
    pending.clear()
    if cause is not None and not isinstance(cause, Exception):
        raise cause  # an interrupt, say
    kind = UsageError if status == _USAGE else Error
    raise kind(text) from cause


def call(name: str, *arguments: Any) -> None:
    """Calls vs_capi_NAME and raises what it says."""
    error = ctypes.create_string_buffer(_ERROR_SIZE)
    status = getattr(library, "vs_capi_" + name)(*arguments, error, _ERROR_SIZE)
    if status:
        raise_status(status, error.value.decode(errors="replace"))


def names(which: str) -> List[str]:
    out: List[str] = []
    while True:
        name = library.vs_capi_name(which.encode(), len(out))
        if name is None:
            return out
        out.append(name.decode())


def find(relative: str) -> str:
    """The path of a file that comes with vsss."""
    path = ctypes.create_string_buffer(4096)
    call("find", relative.encode(), path, len(path))
    return path.value.decode()


def reward_weights(text: str) -> Dict[str, float]:
    """The weights that a reward's text stands for, by term."""
    weights = np.zeros(about.reward_terms)
    call("reward", text.encode(), weights.ctypes.data)
    return dict(zip(names("reward"), weights.tolist()))


def setting_texts(settings: Dict[str, Any]) -> Any:
    """'key=value' texts for the library, and the block of pointers to them."""
    texts = []
    for key, value in settings.items():
        if value is None:
            continue
        text = f"{key}={'true' if value is True else 'false' if value is False else value}"
        if "\0" in text:
            raise UsageError(f"{key}: has a zero byte")
        texts.append(text.encode())
    return (ctypes.c_char_p * (len(texts) + 1))(*texts, None)


def realism_text(value: Any) -> Optional[str]:
    """realism as the library takes it: a path as it stands, a dict as the text of an INI file.

    >>> realism_text({"noise": False, "latency_s": (0.02, 0.1), "radio_loss": 0.05})
    """
    if value is None or isinstance(value, (str, os.PathLike)):
        return None if value is None else os.fspath(value)
    if not isinstance(value, dict):
        raise UsageError(f"realism: a path or a dict of ranges, not {type(value).__name__}")
    top, sections = [], []
    for key, given in value.items():
        if key in ("noise", "ideal_share", "never_seen_share"):
            top.append(f"{key} = {str(given).lower()}\n")
            continue
        try:
            low, high = map(float, (given, given) if np.isscalar(given) else given)  # type: ignore[arg-type]
        except (TypeError, ValueError):
            raise UsageError(f"realism: {key} = {given!r}: give a number, or (low, high)") from None
        sections.append(f"[{key}]\nlow = {low!r}\nhigh = {high!r}\n")
    return "".join(top + sections) or None
