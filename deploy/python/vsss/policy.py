"""Policies: functions of observations. The one that comes with vsss, and those that ./vsss train exports."""

from __future__ import annotations

import os
from typing import Any, Optional

import numpy as np

from . import _library as lib


class Policy:
    """An ONNX policy as a function: observation float32 [n][464] (or [464]) -> action float32 [n][2] in [-1, 1].

    Needs the onnxruntime package (pip install vsss[onnx]). As a player (opponent=policy) it is the library's own
    onnx: player, which uses the same file.

    Args:
        path: a file that ./vsss train wrote; None: the policy that comes with vsss.
        threads: of the session.
    """

    def __init__(self, path: Optional[Any] = None, threads: int = 1) -> None:
        try:
            import onnxruntime
        except ImportError as e:
            raise lib.Error(f"Policy needs onnxruntime ({e}): pip install vsss[onnx]") from None
        self.path = os.fspath(path) if path is not None else lib.find("models/policy/vsss.onnx")
        self.threads = threads
        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = threads
        options.inter_op_num_threads = 1
        options.log_severity_level = 3
        try:
            self._session = onnxruntime.InferenceSession(self.path, options, providers=["CPUExecutionProvider"])
        except Exception as e:  # onnxruntime has a class of its own for each reason
            raise lib.Error(f"{self.path}: cannot be opened as a policy: {e}") from None
        self.metadata = dict(self._session.get_modelmeta().custom_metadata_map)
        contract = lib.about.contract.decode()
        if contract not in self.metadata.values():
            raise lib.Error(
                f"{self.path}: not a policy for this layout of observations (contract {contract}); its metadata: "
                f"{self.metadata or 'none'}"
            )

    @property
    def uri(self) -> str:
        return f"onnx:{self.path}"

    def __call__(self, observation: Any) -> np.ndarray:
        rows = np.ascontiguousarray(observation, np.float32)
        single = rows.ndim == 1
        if single:
            rows = rows[None]
        if rows.ndim != 2 or rows.shape[1] != lib.about.observation:
            raise lib.UsageError(f"observation: shape {np.shape(observation)} given, [n][{lib.about.observation}] needed")
        action = self._session.run(["action"], {"observation": rows})[0]
        return action[0] if single else action

    def __reduce__(self) -> Any:
        return (Policy, (self.path, self.threads))
