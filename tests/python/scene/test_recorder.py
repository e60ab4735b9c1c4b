# SPDX-License-Identifier: Apache-2.0
"""`Recorder`: what belongs together stands in one row."""

import mujoco
import numpy as np
import pyarrow.parquet as pq
import pytest

import volcontact as vc
from volcontact._adaptor import SITE_DTYPE
from volcontact.running.recorder import SITE_UNITS

SCENE = """
<mujoco>
  <option timestep="0.001"/>
  <worldbody>
    <geom type="plane" size="1 1 1"/>
    <body pos="0 0 0.051"><freejoint/><geom type="sphere" size="0.05" mass="1"/></body>
    <body pos="1 0 0.1"><freejoint/><geom type="box" size=".1 .1 .1" mass="2"/></body>
  </worldbody>
</mujoco>
"""
STEPS = 60


@pytest.fixture
def recorded():
    model = vc.load(SCENE)
    data = mujoco.MjData(model)
    with vc.attach(model) as contact:
        recorder = vc.Recorder(contact)
        for _ in range(STEPS):
            recorder.record(data)
            mujoco.mj_step(model, data)
        yield recorder


def test_variables_have_their_dimensions_and_units(recorded):
    variables = recorded.variables()
    sizes = {"time": STEPS, "channel": 4, "qpos_index": 14, "qvel_index": 12}
    for dims, values, attributes in variables.values():
        assert values.shape == tuple(sizes[dim] for dim in dims)
        assert "units" in attributes or dims == ("channel",)
    assert variables["time"].values == pytest.approx(1e-3 * np.arange(STEPS))


def test_sites_and_states_belong_to_one_instant(recorded):
    """Depth of the ball in its own row of positions: R - z."""
    sites, variables = recorded.sites, recorded.variables()
    times = variables["time"].values
    balls = sites[sites["geom_b"] == 1]
    assert len(balls) > 10
    rows = np.searchsorted(times, balls["time"] - 1e-9)
    heights = variables["qpos"].values[rows, 2]
    assert balls["depth"] == pytest.approx(0.05 - heights, rel=1e-9)
    totals = [np.linalg.norm(sites["force"][sites["time"] == t], axis=1).sum() for t in times]
    assert variables["contact_force"].values == pytest.approx(np.array(totals))
    counts = [(sites["time"] == t).sum() for t in times]
    assert variables["site_count"].values.tolist() == counts


def test_files_have_a_column_a_component_with_its_unit(recorded, tmp_path):
    states, sites = (pq.read_table(file) for file in recorded.write(tmp_path / "out"))
    assert states.num_rows == STEPS and sites.num_rows == len(recorded.sites)
    assert states.schema.field("dissipated_slide").metadata == {b"unit": b"J"}
    assert sites.schema.field("force_z").metadata == {b"unit": b"N"}
    assert sites["force_z"].to_numpy() == pytest.approx(recorded.sites["force"][:, 2])


def test_every_field_of_a_site_has_a_unit():
    assert set(SITE_UNITS) == {"time", *SITE_DTYPE.names}


def test_nothing_recorded_is_an_empty_table(tmp_path):
    with vc.attach(vc.load(SCENE)) as contact:
        recorder = vc.Recorder(contact)
        assert len(recorder) == 0 and len(recorder.sites) == 0
        for file in recorder.write(tmp_path):
            assert pq.read_table(file).num_rows == 0
