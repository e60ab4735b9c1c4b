# SPDX-License-Identifier: Apache-2.0
"""Studies on local clusters of Ray and Dask: the same bits, also when workers and nodes die."""

from __future__ import annotations

import os
import signal
import threading
import time
from pathlib import Path

import pytest
from study_files import FUNCTION_STUDY, bits, function_study

import volcontact as vc
from volcontact.study.child import end_children

ray = pytest.importorskip("ray", reason='ray is missing: pip install "volcontact[ray]"')
distributed = pytest.importorskip(
    "distributed", reason='dask is missing: pip install "volcontact[dask]"'
)
pytestmark = [
    pytest.mark.filterwarnings("default"),  # what Ray and Dask warn of is theirs
    pytest.mark.xdist_group("clusters"),
]
TRIALS = 500
SLOW = FUNCTION_STUDY + '[vary.sleep]\ndistribution = "uniform"\nlow = 0.004\nhigh = 0.006\n'


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    path = function_study(tmp_path_factory.mktemp("study"), SLOW)
    yield vc.Study(path, trials=TRIALS)
    end_children()


@pytest.fixture(scope="module")
def expected(study, tmp_path_factory):
    """The rows of one process."""
    out = tmp_path_factory.mktemp("serial") / "out"
    study.run(out, engine="serial")
    table = study.rows(out)
    assert table["trial"].to_pylist() == list(range(TRIALS))
    return bits(table)


class Later(threading.Thread):
    """Does something once rows have come, while the study still runs."""

    def __init__(self, action) -> None:
        super().__init__()
        self._action = action
        self._go = threading.Event()
        self.done_at = 0
        self.start()

    def progress(self, done, total, outcomes) -> None:
        if done > TRIALS // 8:
            self.done_at = self.done_at or done
            self._go.set()

    def run(self) -> None:
        assert self._go.wait(300)  # a busy machine takes a minute to start a cluster
        self._action()


def test_two_processes_have_the_bits_of_one(study, expected, tmp_path):
    study.run(tmp_path / "out", engine="processes", workers=2)
    assert bits(study.rows(tmp_path / "out")) == expected


def test_dask_whose_worker_is_killed_has_the_bits_of_one(study, expected, tmp_path, monkeypatch):
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        pids = list(client.run(os.getpid).values())
        killer = Later(lambda: os.kill(pids[0], signal.SIGKILL))
        # The study waits by its own client: no other event loop hears of lost workers.
        monkeypatch.setattr(client, "sync", lambda *_, **__: pytest.fail("of the program's client"))
        study.run(
            tmp_path / "out",
            engine="dask",
            address=cluster.scheduler_address,
            progress=killer.progress,
        )
        monkeypatch.undo()
        killer.join()
        assert killer.done_at < TRIALS
        assert not Path(f"/proc/{pids[0]}").exists()
    assert bits(study.rows(tmp_path / "out")) == expected


def test_ray_whose_node_is_killed_has_the_bits_of_one(study, expected, tmp_path):
    from ray.cluster_utils import Cluster

    soon = {"health_check_initial_delay_ms": 0, "health_check_period_ms": 500}
    # A node that is dead refuses at once; one that only has a busy machine gets its time.
    soon |= {"health_check_timeout_ms": 10000, "health_check_failure_threshold": 3}
    head = {"num_cpus": 1, "_system_config": soon}
    cluster = Cluster(initialize_head=True, head_node_args=head)
    other = cluster.add_node(num_cpus=1)
    try:
        ray.init(address=cluster.address, log_to_driver=False, logging_level="error")
        assert ray.cluster_resources()["CPU"] == 2
        killer = Later(lambda: cluster.remove_node(other, allow_graceful=False))
        study.run(tmp_path / "out", engine="ray", progress=killer.progress)
        killer.join()
        assert killer.done_at < TRIALS
        deadline = time.monotonic() + 20
        while ray.cluster_resources()["CPU"] != 1 and time.monotonic() < deadline:
            time.sleep(0.2)
        assert ray.cluster_resources()["CPU"] == 1
    finally:
        ray.shutdown()
        cluster.shutdown()
    assert bits(study.rows(tmp_path / "out")) == expected
