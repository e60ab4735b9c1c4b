# SPDX-License-Identifier: Apache-2.0
"""A whole scene as a unit: the same bits as `mj_step` in Python, in a process that has MuJoCo."""

import ctypes
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import mujoco
import numpy as np
import pytest
from scene_master import SceneInstance, copied

import volcontact as vc
from volcontact.cli import main
from volcontact.fmu import packing
from volcontact.fmu.private_names import name_of, private_names, renamed

fmpy = pytest.importorskip("fmpy", reason="FMPy is missing: pip install fmpy")
pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="made on Linux")
MODELS = Path(__file__).parents[3] / "mjcf_models"
# A driven box on a floor, pushed by a mocap body, with a pendulum on a tendon-like constraint: what
# MuJoCo's own solver does starts from the step before, so an evaluation too many would be seen.
SCENE = """<mujoco model="yard">
  <option timestep="0.001" integrator="implicit"/>
  <custom>
    <numeric name="volcontact/material/rubber/stiffness" data="1e8"/>
    <numeric name="volcontact/material/rubber/friction" data="0.4"/>
    <tuple name="volcontact/material/rubber">
      <element objtype="geom" objname="box"/>
    </tuple>
  </custom>
  <worldbody>
    <geom name="floor" type="plane" size="2 2 .1"/>
    <body name="sled" pos="0 0 .0499">
      <joint name="along" type="slide" axis="1 0 0"/>
      <joint name="up" type="slide" axis="0 0 1"/>
      <joint name="tilt" type="hinge" axis="0 1 0"/>
      <geom name="box" type="box" size=".1 .1 .05" mass="1"/>
      <site name="pad" type="box" size=".11 .11 .06"/>
    </body>
    <body name="left" pos="1 0 .5"><joint name="left" axis="0 1 0"/>
      <geom type="capsule" fromto="0 0 0 0 0 -.2" size=".02" mass=".2" contype="0" conaffinity="0"/>
    </body>
    <body name="right" pos="1.2 0 .5"><joint name="right" axis="0 1 0"/>
      <geom type="capsule" fromto="0 0 0 0 0 -.2" size=".02" mass=".2" contype="0" conaffinity="0"/>
    </body>
    <body name="my pusher" mocap="true" pos="-.2 0 .06">
      <geom name="pusher" type="sphere" size=".04"/>
    </body>
  </worldbody>
  <equality><joint joint1="left" joint2="right" polycoef="0 1 .1 0 0"/></equality>
  <actuator><motor name="drive" joint="along" ctrlrange="-5 5" ctrllimited="true"/></actuator>
  <sensor>
    <touch name="pad" site="pad"/>
    <framepos name="sled" objtype="body" objname="sled"/>
    <jointvel name="left" joint="left"/>
    <accelerometer name="shake" site="pad"/>
  </sensor>
</mujoco>"""
CONTACTS = [("sled", "floor"), ("pusher", "sled")]


@pytest.fixture(scope="module", params=[2, 3])
def unit(request, tmp_path_factory):
    path = tmp_path_factory.mktemp("unit") / "yard.fmu"
    return vc.export_scene_fmu(SCENE, path, fmi=request.param, contacts=CONTACTS)


def number(model, kind, name):
    """Of a thing in the model; MuJoCo 2.2 has no short way."""
    return mujoco.mj_name2id(model, int(getattr(mujoco.mjtObj, f"mjOBJ_{kind.upper()}")), name)


def inputs(k):
    """Of communication step k."""
    return {
        "ctrl.drive": [2.0 * np.sin(0.1 * k)],
        "body.sled.applied_force": [0.1 * k, 0.0, -1.0],
        "body.sled.applied_torque": [0.0, 0.02 * k, 0.0],
        "mocap.'my pusher'.position": [-0.1395 + 2e-4 * k, 0.0, 0.06],
        "mocap.'my pusher'.quaternion": [np.cos(0.01 * k), 0.0, 0.0, np.sin(0.01 * k)],
    }


def apply(model, data, values):
    data.ctrl[0] = values["ctrl.drive"][0]
    sled = number(model, "body", "sled")
    data.xfrc_applied[sled, :3] = values["body.sled.applied_force"]
    data.xfrc_applied[sled, 3:] = values["body.sled.applied_torque"]
    data.mocap_pos[0] = values["mocap.'my pusher'.position"]
    data.mocap_quat[0] = values["mocap.'my pusher'.quaternion"]


def seen_in_python(model, data, contact):
    """The outputs, by an evaluation of a copy of the data."""
    seen = copied(model, data)
    mujoco.mj_forward(model, seen)
    contact.update_touch(seen)
    sites, energy = contact.sites(seen), contact.energy(seen)
    sled = number(model, "body", "sled")
    velocity = np.zeros(6)
    mujoco.mj_objectVelocity(model, seen, int(mujoco.mjtObj.mjOBJ_XBODY), sled, velocity, 0)
    pusher = number(model, "geom", "pusher")
    of_pusher = sites[(sites["geom_a"] == pusher) | (sites["geom_b"] == pusher)]
    force = sum((s["force"] * (1 if s["geom_a"] == pusher else -1) for s in of_pusher), np.zeros(3))
    return {
        "joint.along.position": data.qpos[:1],
        "joint.left.velocity": data.qvel[3:4],
        "sensor.pad": seen.sensordata[:1],
        "sensor.sled": seen.sensordata[1:4],
        "sensor.shake": seen.sensordata[5:8],
        "body.sled.position": seen.xpos[sled],
        "body.sled.quaternion": seen.xquat[sled],
        "body.sled.angular_velocity": velocity[:3],
        "body.sled.velocity": velocity[3:],
        "contact.volume": [sum(sites["volume"].tolist())],
        "contact.elastic_energy": [energy.elastic],
        "contact.dissipated_energy": energy.by_channel,
        "contact.dissipated_power": energy.power,
        "pair.pusher.sled.normal_force": [sum(of_pusher["normal_force"].tolist())],
        "pair.pusher.sled.force": force,
    }


def test_it_is_valid(unit):
    from fmpy.validation import validate_fmu

    assert validate_fmu(str(unit)) == []


@pytest.mark.parametrize("parts", [1, 5])
def test_it_has_the_bits_of_a_run_in_python(unit, parts):
    """Of states, sensors, poses, contact and energies, with inputs that change."""
    model = vc.load(SCENE)
    data = mujoco.MjData(model)
    instance = SceneInstance(unit)
    touched = 0.0
    with vc.attach(model) as contact:
        for k in range(60):
            apply(model, data, inputs(k))
            for name, values in inputs(k).items():
                instance.set(name, values)
            for _ in range(parts):
                mujoco.mj_step(model, data)
            instance.step(parts * 1e-3)
            for name, wanted in seen_in_python(model, data, contact).items():
                got = instance.get(name, len(wanted))
                assert got.tolist() == [float(one) for one in wanted], (k, name)
            touched = max(touched, instance.get("pair.pusher.sled.normal_force")[0])
            assert instance.get("time")[0] == data.time
    assert touched > 1.0  # [N]
    instance.close()


def test_a_saved_state_continues_to_the_bit(unit):
    def run(instance, first, count):
        rows = []
        for k in range(first, first + count):
            for name, values in inputs(k).items():
                instance.set(name, values)
            instance.step(1e-3)
            rows += [*instance.get("joint.along.position"), *instance.get("sensor.shake", 3),
                     *instance.get("contact.dissipated_energy", 4)]  # fmt: skip
        return rows

    one, other = SceneInstance(unit), SceneInstance(unit)
    run(one, 0, 30)
    state = one.save()
    straight = run(one, 30, 20)
    one.restore(state)
    assert run(one, 30, 20) == straight
    other.restore_bytes(one.bytes_of(state))  # another instance, from bytes
    assert run(other, 30, 20) == straight
    one.reset()
    again = run(one, 0, 50)
    assert again[-len(straight) :] == straight
    one.free(state)
    one.close()
    other.close()


def test_two_instances_and_another_copy_of_mujoco_do_not_meet(unit):
    """Python's MuJoCo steps another model meanwhile; the copies are two files."""
    one, other = SceneInstance(unit), SceneInstance(unit)
    model = mujoco.MjModel.from_xml_string(SCENE)
    data = mujoco.MjData(model)
    alone = SceneInstance(unit)
    for _ in range(20):
        alone.step(1e-3)
    for k in range(20):
        one.step(1e-3)
        mujoco.mj_step(model, data)
        other.set("ctrl.drive", [3.0])
        other.step(1e-3)
        assert k < 5 or one.get("joint.along.position") != other.get("joint.along.position")
    assert one.get("joint.along.position") == alone.get("joint.along.position")
    loaded = Path("/proc/self/maps").read_text()
    assert "/libmujoco.so" in loaded
    assert len(set(re.findall(r"/lib[0-9a-f]{6}\.so\.\d+\.\d+\.\d+", loaded))) == 1
    for instance in (one, other, alone):
        instance.close()


def test_the_timestep_and_a_material_are_parameters(unit):
    model = vc.load(SCENE)
    model.opt.timestep = 5e-4
    stiffness = number(model, "numeric", "volcontact/material/rubber/stiffness")
    model.numeric_data[model.numeric_adr[stiffness]] = 3e8
    data = mujoco.MjData(model)
    instance = SceneInstance(unit, start={"timestep": [5e-4],
                                          "material.rubber.stiffness": [3e8]})  # fmt: skip
    with vc.attach(model):
        for _ in range(40):
            mujoco.mj_step(model, data)
    instance.step(20e-3)
    assert instance.get("joint.up.position").tolist() == [data.qpos[1]]
    instance.close()


def test_wrong_use_is_told_and_the_instance_goes_on(unit):
    instance = SceneInstance(unit)
    assert instance.status("step", 1.5e-3) == "discard"
    assert "no multiple of the timestep of 0.001" in instance.messages[-1]
    assert instance.status("set", "ctrl.drive", [np.nan]) == "discard"
    assert "no finite number" in instance.messages[-1]
    instance.set("mocap.'my pusher'.quaternion", [0.0] * 4)
    assert instance.status("step", 1e-3) == "discard"
    assert "norm 0" in instance.messages[-1]
    instance.set("mocap.'my pusher'.quaternion", [1.0, 0.0, 0.0, 0.0])
    assert instance.status("set", "timestep", [1e-4]) == "error"  # fixed
    assert "cannot be set" in instance.messages[-1]
    instance.step(1e-3)
    instance.set("body.sled.applied_force", [0.0, 0.0, 1e300])
    assert instance.status("step", 2e-3) == "error"
    assert "diverged in the step from 0.00" in instance.messages[-1]
    instance.reset()
    fresh = SceneInstance(unit)
    for one in (instance, fresh):
        one.step(5e-3)
    assert instance.get("sensor.shake", 3).tolist() == fresh.get("sensor.shake", 3).tolist()
    instance.close()
    fresh.close()


def test_a_material_out_of_range_is_discarded(unit):
    instance = SceneInstance(unit, initialized=False)
    assert instance.status("set", "material.rubber.friction", [-1.0]) == "discard"
    assert "friction" in instance.messages[-1]
    assert instance.status("set", "timestep", [0.0]) == "discard"
    instance.initialize()
    assert instance.get("material.rubber.friction").tolist() == [0.4]
    instance.close()


def test_a_missing_library_is_told(unit, tmp_path):
    """And a binary of another kind: no instance, with a message."""
    broken = tmp_path / "yard.fmu"
    with zipfile.ZipFile(unit) as whole, zipfile.ZipFile(broken, "w") as part:
        for name in whole.namelist():
            if not re.search(r"/lib[0-9a-f]+\.so", name):
                text = whole.read(name)
                if name.endswith("scene.txt"):  # else the library that is loaded would serve
                    text = re.sub(rb"mujoco lib\w+", b"mujoco libnowhere", text)
                part.writestr(name, text)
    with pytest.raises(Exception, match="instantiate"):
        SceneInstance(broken)
    assert any("cannot load libnowhere" in message for message in SceneInstance.last_messages)


def test_third_version_returns_early_where_bodies_touch(tmp_path):
    path = vc.export_scene_fmu(MODELS / "bouncing_ball" / "scene.xml", tmp_path / "ball.fmu", fmi=3)
    instance = SceneInstance(path, event_mode=True)
    reached, event = instance.step_until_event(1.0)
    assert event
    assert reached == pytest.approx(np.sqrt(2 / 9.81), abs=2.1 * instance.timestep)
    instance.close()


@pytest.mark.parametrize("name", [pytest.param("battery_box", marks=pytest.mark.once), "tippe_top"])
def test_scenes_run_in_fmpy(tmp_path, name):
    scene = MODELS / name / "scene.xml"
    path = vc.export_scene_fmu(scene, tmp_path / f"{name}.fmu")
    about = fmpy.read_model_description(str(path))
    step = about.defaultExperiment.stepSize
    names = [v.name for v in about.modelVariables if v.name.startswith("joint.")]
    rows = fmpy.simulate_fmu(
        str(path), stop_time=20 * float(step), output_interval=float(step), output=names
    )
    model = vc.load(scene)
    data = mujoco.MjData(model)
    key = mujoco.mj_name2id(model, int(mujoco.mjtObj.mjOBJ_KEY), "start")
    if key >= 0:
        mujoco.mj_resetDataKeyframe(model, data, key)
    with vc.attach(model):
        for _ in range(20):
            mujoco.mj_step(model, data)
    positions = [n for n in names if ".position" in n]
    assert [rows[-1][n] for n in positions] == data.qpos.tolist()


def test_documentation_and_libraries_lie_inside(unit):
    with zipfile.ZipFile(unit) as fmu:
        names = fmu.namelist()
        page = fmu.read("documentation/index.html").decode()
        libraries = [n for n in names if re.search(r"binaries/.*/lib", n)]
        contents = {Path(n).name: fmu.read(n) for n in libraries}
    assert page.count("<polygon") >= 3
    assert "ctrl.drive" in page
    assert len(contents) == 2
    for name, content in contents.items():
        assert name_of(content) == name
        assert str(Path(mujoco.__file__).parent).encode() not in content


def test_private_names_have_the_length_of_the_old_ones():
    names = private_names([("libmujoco.so.4.0.0", b"a"), ("libvolcontact_mujoco-4.0.0.so", b"b")])
    for old, new in names.items():
        assert len(new) == len(old)
        assert new != old
        assert re.fullmatch(r"lib[0-9a-f]+(_mujoco-4\.0\.0\.so|\.so\.4\.0\.0)", new)
    with pytest.raises(ValueError, match="ELF"):
        renamed(b"MZ", names)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (dict(contacts=[("sledd", "floor")]), "no body and no geom 'sledd'"),
        (dict(contacts=[("sled", "sled")]), "'sled' is named twice"),
        (dict(bodies=["sledge"]), "no body 'sledge'"),
        (dict(fmi=1), "fmi = 1 is none of 2, 3"),
    ],
)
def test_wrong_arguments_are_told(tmp_path, arguments, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        vc.export_scene_fmu(SCENE, tmp_path / "a.fmu", **arguments)
    assert list(tmp_path.iterdir()) == []


def test_the_command_writes_one(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    scene = str(MODELS / "bouncing_ball" / "scene.xml")
    assert main(["fmu", "--scene", scene, "--contact", "ball", "world", "--out", "b.fmu"]) == 0
    assert "wrote b.fmu" in capsys.readouterr().out
    names = [v.name for v in fmpy.read_model_description("b.fmu").modelVariables]
    assert "pair.ball.world.volume" in names
    assert main(["fmu", scene, "--scene", scene]) == 1
    assert "one scene at a time" in capsys.readouterr().err
    assert main(["fmu", "--scene", scene, "--kind", "me"]) == 1
    assert "--kind is for the contact of bodies" in capsys.readouterr().err
    assert main(["fmu", scene, "--bodies", "ball", "world", "--contact", "a", "b"]) == 1
    assert "--contact goes with --scene" in capsys.readouterr().err
    assert main(["fmu"]) == 1
    assert "name a scene" in capsys.readouterr().err


def test_what_a_wheel_brought_along_goes_with_the_binary(tmp_path, monkeypatch):
    """A wheel has OpenMP's library in a folder of its own, where no FMU can look."""
    package, libs = tmp_path / "volcontact", tmp_path / "volcontact.libs"
    package.mkdir()
    libs.mkdir()
    (tmp_path / "a.c").write_text("int answer(void) { return 42; }\n")
    (tmp_path / "b.c").write_text(
        "int answer(void);\nint fmi2GetVersion(void) { return answer(); }"
    )
    build = ["cc", "-shared", "-fPIC", "-o"]
    inner, outer = libs / "libomp-12ab.so.1", package / "volcontact_fmi2.so"
    subprocess.run([*build, inner, tmp_path / "a.c", f"-Wl,-soname,{inner.name}"], check=True)
    looks = "-Wl,-rpath,$ORIGIN/../volcontact.libs"
    subprocess.run([*build, outer, tmp_path / "b.c", inner, looks], check=True)
    monkeypatch.setattr(packing, "library_folder", lambda: package)
    for name, content in packing.common_files(2, "unit").items():
        path = tmp_path / "fmu" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    shutil.rmtree(libs)
    library = ctypes.CDLL(
        str(tmp_path / "fmu" / "binaries" / packing.platform_folder(2) / "unit.so")
    )
    assert library.fmi2GetVersion() == 42
