# SPDX-License-Identifier: Apache-2.0
"""Programs that know nothing of volcontact, loaded together with it."""

import contextlib
import importlib.util
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import mujoco
import pytest

import volcontact as vc

PACKAGE = Path(mujoco.__file__).parent
ADAPTOR = Path(vc._volcontact.__file__).parent / f"libvolcontact_mujoco-{mujoco.__version__}.so"

HOST = r"""
#include <mujoco/mujoco.h>
#include <stdio.h>
int main(int count, char** files) {
  char text[1000] = "";
  mjModel* m = mj_loadXML(files[count - 1], NULL, text, sizeof text);
  if (!m) return 1;
  mjData* d = mj_makeData(m);
  for (int i = 0; i < 2000; ++i) mj_step(m, d);
  printf("contacts %d height %.9f applied %.6f\n", d->ncon, d->qpos[2], d->qfrc_applied[2]);
  mj_deleteData(d);
  mj_deleteModel(m);
  return 0;
}
"""

SCENE = """
<mujoco model="rubber ball">
  <option timestep="1e-3"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 1"/>
    <body pos="0 0 .0493"><freejoint/><geom name="ball" type="sphere" size=".05" mass="1"/></body>
  </worldbody>
  <custom>
    <numeric name="volcontact/material/rubber/stiffness" data="2e8"/>
    <numeric name="volcontact/material/rubber/damping" data="10"/>
    <tuple name="volcontact/material/rubber">
      <element objtype="geom" objname="floor"/><element objtype="geom" objname="ball"/>
    </tuple>
  </custom>
</mujoco>
"""
DEPTH = 0.792364e-3  # k V(h) = m g of the spherical cap, k = 1e8 N/m^3 [m]


@pytest.fixture(scope="module")
def host(tmp_path_factory):
    """The program, and its folder."""
    folder = tmp_path_factory.mktemp("host")
    (folder / "host.c").write_text(HOST)
    (library,) = PACKAGE.glob("libmujoco.so.*")
    command = [os.environ.get("CC", "cc"), folder / "host.c", f"-I{PACKAGE / 'include'}", library]
    subprocess.run(
        [*command, f"-Wl,-rpath,{PACKAGE}", "-o", folder / "host"], check=True, cwd=folder
    )
    return folder / "host"


def run(host, folder, text, **variables):
    (folder / "scene.xml").write_text(text)
    environment = {**os.environ, **variables}
    ran = subprocess.run(
        [host, folder / "scene.xml"], cwd=folder, env=environment, capture_output=True, text=True
    )
    assert ran.returncode == 0, ran.stdout + ran.stderr
    found = re.search(r"contacts (\d+) height (\S+) applied (\S+)", ran.stdout)
    return int(found[1]), float(found[2]), float(found[3])


def with_room(text):
    room = vc.load(text).nuserdata
    return text.replace("<worldbody>", f'<size nuserdata="{room}"/><worldbody>')


def test_preloaded_library_makes_contact_volumetric(host, tmp_path):
    variables = {"LD_PRELOAD": str(ADAPTOR), "VOLCONTACT_AUTO": "1"}
    contacts, height, applied = run(host, tmp_path, with_room(SCENE), **variables)
    assert contacts == 0
    assert height == pytest.approx(0.05 - DEPTH, abs=1e-9)
    assert applied == pytest.approx(9.81, abs=1e-5)


def test_without_the_wish_or_without_keys_all_stays_native(host, tmp_path):
    quiet = run(host, tmp_path, with_room(SCENE), LD_PRELOAD=str(ADAPTOR))
    plain = run(host, tmp_path, with_room(SCENE))
    assert quiet == plain
    assert plain[0] == 1 and plain[2] == 0.0
    bare = re.sub(r"<custom>.*</custom>", "", SCENE, flags=re.DOTALL)
    variables = {"LD_PRELOAD": str(ADAPTOR), "VOLCONTACT_AUTO": "1"}
    assert run(host, tmp_path, bare, **variables)[0] == 1


def test_file_without_room_stays_native_and_the_warning_has_the_line(host, tmp_path):
    variables = {"LD_PRELOAD": str(ADAPTOR), "VOLCONTACT_AUTO": "1"}
    contacts, _, applied = run(host, tmp_path, SCENE, **variables)
    assert (contacts, applied) == (1, 0.0)
    log = (tmp_path / "MUJOCO_LOG.TXT").read_text()
    assert "contact stays native" in log
    assert re.search(r'<size nuserdata="\d+"/>', log)


def test_library_in_a_plugin_folder_needs_no_variable(host, tmp_path):
    # What `simulate` does with each library there: dlopen.
    folder = tmp_path / "mujoco_plugin"
    folder.mkdir()
    copy = folder / ADAPTOR.name
    copy.write_bytes(ADAPTOR.read_bytes())
    contacts, height, _ = run(host, tmp_path, with_room(SCENE), LD_PRELOAD=str(copy))
    assert contacts == 0
    assert height == pytest.approx(0.05 - DEPTH, abs=1e-9)
    quiet = run(host, tmp_path, with_room(SCENE), LD_PRELOAD=str(copy), VOLCONTACT_AUTO="0")
    assert quiet[0] == 1


TAKEN = "the contact of model 'rubber ball' is volumetric"


def run_until_taken(command, folder, **variables):
    """Runs a program with windows until it says that volcontact took the scene, and 3 s longer."""
    environment = {**os.environ, "LIBGL_ALWAYS_SOFTWARE": "1", "MUJOCO_GL": "glfw", **variables}
    said = folder / "said.txt"
    with said.open("w") as errors:
        ran = subprocess.Popen(
            ["xvfb-run", "-a", *command],
            cwd=folder,
            env=environment,
            stderr=errors,
            start_new_session=True,
        )
    end = time.monotonic() + 80.0  # all is drawn by the processor, which may be busy
    while TAKEN not in said.read_text() and ran.poll() is None and time.monotonic() < end:
        time.sleep(0.2)
    with contextlib.suppress(subprocess.TimeoutExpired):
        ran.wait(timeout=3.0)
    alive = ran.poll() is None
    if alive:
        os.killpg(ran.pid, signal.SIGTERM)
        ran.wait(timeout=30.0)
    assert alive, f"it ended by itself: {said.read_text()}"
    assert TAKEN in said.read_text()
    assert not (folder / "MUJOCO_LOG.TXT").exists()


# The wheels carry no program of that name, but `simulate` as the module that the viewer runs.
@pytest.mark.skipif(
    importlib.util.find_spec("mujoco.viewer") is None or shutil.which("xvfb-run") is None,
    reason="needs MuJoCo's viewer, and from Debian xvfb with xauth",
)
def test_simulate_of_the_wheel_takes_the_scene(tmp_path):
    (tmp_path / "scene.xml").write_text(with_room(SCENE))
    command = [sys.executable, "-m", "mujoco.viewer", "--mjcf=scene.xml"]
    variables = {"VOLCONTACT_AUTO": "1"}
    if int(mujoco.__version__.split(".")[0]) < 4:  # no entry point `mujoco.plugins`
        variables["LD_PRELOAD"] = str(ADAPTOR)
    run_until_taken(command, tmp_path, **variables)


# Debian's, of package libmujoco-samples. Its library is the one that the wheel of 2.2.2 has too.
SIMULATE = shutil.which("mujoco-simulate")


@pytest.mark.skipif(
    mujoco.__version__ != "2.2.2" or SIMULATE is None or shutil.which("xvfb-run") is None,
    reason="needs MuJoCo 2.2.2, and from Debian libmujoco-samples and xvfb with xauth",
)
def test_simulate_of_debian_takes_the_scene(tmp_path):
    (tmp_path / "scene.xml").write_text(with_room(SCENE))
    variables = {"LD_PRELOAD": str(ADAPTOR), "VOLCONTACT_AUTO": "1"}
    run_until_taken([SIMULATE, "scene.xml"], tmp_path, **variables)
