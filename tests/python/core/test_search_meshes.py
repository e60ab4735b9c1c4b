# SPDX-License-Identifier: Apache-2.0
"""A sample of the search over random meshes, against manifold3d."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

SCRIPT = Path(__file__).resolve().parents[2] / "benchmarks" / "search_meshes.py"


@pytest.fixture(scope="module")
def search() -> ModuleType:
    pytest.importorskip("manifold3d")
    spec = importlib.util.spec_from_file_location(SCRIPT.stem, SCRIPT)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_random_meshes_agree_with_manifold3d(search):
    rows = [search.examine(seed) for seed in range(60)]
    result = search.summary(rows)
    assert result["faults"] == {}, result["examples"]
    assert result["overlapping"] > 30


def test_a_wrong_volume_is_seen(search, monkeypatch):
    exact = search.vc.interference

    class Wrong:
        """An answer that is a thousandth too large."""

        def __init__(self, answer):
            self._answer = answer
            self.volume = 1.001 * answer.volume

        def __getattr__(self, name):
            return getattr(self._answer, name)

    seed = next(s for s in range(50) if search.examine(s).get("expected", 0.0) > 1e-4)
    monkeypatch.setattr(search.vc, "interference", lambda *args: Wrong(exact(*args)))
    assert "beyond the bound" in search.examine(seed)["faults"]


def test_poses_are_rigid(search):
    drawer = search.Drawer(1)
    for _ in range(50):
        X = drawer.pose(np.full(3, -0.1), np.full(3, 0.1))
        assert np.allclose(X[:3, :3] @ X[:3, :3].T, np.eye(3), atol=1e-12)
        assert np.linalg.det(X[:3, :3]) == pytest.approx(1.0)
