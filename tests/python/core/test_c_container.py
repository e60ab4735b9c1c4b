# SPDX-License-Identifier: Apache-2.0
"""The plain C container through ctypes, as another simulator would call it."""

import ctypes
import importlib.util
import os
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest

import volcontact as vc

FOLDER = Path(importlib.util.find_spec("volcontact._volcontact").origin).parent
HEADER = Path(__file__).parents[3] / "plugin/c_api/volcontact.h"
Numbers = ctypes.POINTER(ctypes.c_double)


class Metrics(ctypes.Structure):
    _fields_ = (
        ("volume", ctypes.c_double),
        ("centroid", ctypes.c_double * 3),
        ("inertia", ctypes.c_double * 9),
        ("area_vector", ctypes.c_double * 3),
        ("area_moment", ctypes.c_double * 3),
        ("area", ctypes.c_double),
        ("counter_area", ctypes.c_double),
        ("depth_moment", ctypes.c_double),
        ("depth", ctypes.c_double),
        ("flatness", ctypes.c_double),
        ("volume_error", ctypes.c_double),
        ("status", ctypes.c_int),
    )


class Motion(ctypes.Structure):
    _fields_ = (
        ("X_WA", ctypes.c_double * 16),
        ("X_WB", ctypes.c_double * 16),
        ("V_WA", ctypes.c_double * 6),
        ("V_WB", ctypes.c_double * 6),
    )


class Result(ctypes.Structure):
    _fields_ = (
        ("force_on_a", ctypes.c_double * 3),
        ("torque_on_a", ctypes.c_double * 3),
        ("force_on_b", ctypes.c_double * 3),
        ("torque_on_b", ctypes.c_double * 3),
        ("elastic_energy", ctypes.c_double),
        ("power", ctypes.c_double * 4),
        ("metrics", Metrics),
        ("sites", ctypes.c_int),
        ("forgotten", ctypes.c_int),
    )


@pytest.fixture(scope="module")
def library():
    made = ctypes.CDLL(str(FOLDER / "libvolcontact.so"))
    made.vc_error.restype = ctypes.c_char_p
    for name in ("vc_solid_free", "vc_model_free", "vc_workspace_free"):
        getattr(made, name).restype = None
        getattr(made, name).argtypes = (ctypes.c_void_p,)
    return made


def numbers(values):
    array = np.ascontiguousarray(values, dtype=float).ravel()
    return array.ctypes.data_as(Numbers), len(array)


class Caller:
    """Objects of the library that end with the test; errors are raised."""

    def __init__(self, library):
        self.library = library
        self.made = []

    def call(self, name, *arguments):
        code = getattr(self.library, name)(*arguments)
        if code < 0:
            raise ValueError(self.library.vc_error().decode())
        return code

    def make(self, name, *arguments):
        handle = ctypes.c_void_p()
        self.call(f"vc_{name}", *arguments, ctypes.byref(handle))
        self.made.append((f"vc_{name.split('_')[0]}_free", handle))
        return handle

    def solid(self, shape, **parameters):
        handle = self.make("solid_create", shape.encode())
        for name, values in parameters.items():
            self.call("vc_solid_set", handle, name.encode(), *numbers(values))
        return handle

    def end(self):
        for name, handle in self.made:
            getattr(self.library, name)(handle)


@pytest.fixture
def c(library):
    caller = Caller(library)
    yield caller
    caller.end()


def test_header_is_installed_and_of_this_version(library):
    installed = FOLDER / "include/c_api/volcontact.h"
    assert installed.read_text() == HEADER.read_text()
    (number,) = re.findall(r"#define VC_VERSION (\d+)", HEADER.read_text())
    parts = [int(part) for part in re.findall(r"\d+", vc.__version__)]
    assert library.vc_version() == int(number) == np.dot(parts, (10000, 100, 1))


def test_every_function_of_the_header_is_in_the_library(library):
    names = re.findall(r"VC_API [\w* ]+?\*?(vc_\w+)\(", HEADER.read_text())
    assert len(names) >= 24
    for name in names:
        assert hasattr(library, name), name


def test_equals_the_python_model_to_the_bit(c):
    ball, plate = dict(radius=0.05), dict(half_sizes=(0.2, 0.2, 0.01))
    model = c.make("model_create")
    c.call(
        "vc_model_add_pair", model, c.solid("sphere", **ball), None, c.solid("box", **plate), None
    )
    c.call("vc_model_choose", model, b"friction_law", b"bristle")
    c.call("vc_model_choose", model, b"coupling", b"quadrature")
    c.call("vc_model_set", model, b"stiffness", *numbers(3e8))
    c.call("vc_model_set", model, b"damping", *numbers(0.7))
    c.call("vc_model_set", model, b"friction", *numbers(0.15))
    same = vc.ContactModel(
        pairs=[vc.Pair(vc.Sphere(**ball), vc.Box(**plate))],
        normal=vc.HuntCrossley(stiffness=3e8, damping=0.7),
        friction=vc.Bristle(friction=0.15, coupling="quadrature"),
    )
    workspace = c.make("workspace_create")
    size = c.call("vc_model_state_size", model, 3)
    state = np.zeros(size)
    rows, motion, result = None, Motion(), Result()
    for i in range(5):
        X_WA, X_WB = np.eye(4), np.eye(4)
        X_WA[:3, 3] = 1e-5 * i, 2e-5 * i, 0.0595 - 1e-5 * i
        V_WA, V_WB = np.array([0.0, 0.1, 3.0, 0.01, 0.02, -0.01]), np.zeros(6)
        motion.X_WA[:], motion.X_WB[:] = X_WA.ravel(), X_WB.ravel()
        motion.V_WA[:], motion.V_WB[:] = V_WA, V_WB
        pointer = state.ctypes.data_as(Numbers)
        c.call(
            "vc_evaluate",
            *(model, workspace, ctypes.byref(motion), pointer, pointer, size),
            *(ctypes.c_double(1e-3), ctypes.byref(result)),
        )
        report = same.evaluate(X_WA=X_WA, X_WB=X_WB, V_WA=V_WA, V_WB=V_WB, state=rows, elapsed=1e-3)
        rows = report.state
        assert report.touching
        assert np.array_equal(result.force_on_a[:], report.force_on_A)
        assert np.array_equal(result.torque_on_a[:], report.torque_on_A)
        assert np.array_equal(result.force_on_b[:], report.force_on_B)
        assert result.elastic_energy == report.elastic_energy
        assert result.metrics.volume == report.metrics.volume
        assert state[0] == len(rows)
        assert np.array_equal(state[2 : 2 + rows.size], rows.ravel())


def test_errors_name_what_is_wrong(c):
    with pytest.raises(ValueError, match="did you mean 'sphere'"):
        c.solid("sphre")
    with pytest.raises(ValueError, match=r"radius = -1 \[m\] is out of range: must be >= 0"):
        c.solid("sphere", radius=-1)
    with pytest.raises(ValueError, match="compile it with the library's own"):
        c.call("vc_check_version", 9900)


def test_example_of_the_page_compiles_as_c99_and_runs(tmp_path):
    page = (HEADER.parents[2] / "docs/c_container.md").read_text()
    (program,) = re.findall(r"^```c\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    source, binary = tmp_path / "page.c", tmp_path / "page"
    source.write_text(program)
    flags = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", f"-I{FOLDER / 'include'}"]
    link = [f"-L{FOLDER}", f"-Wl,-rpath,{FOLDER}", "-lvolcontact"]
    compiler = os.environ.get("CC", "cc")
    subprocess.run([compiler, *flags, str(source), "-o", str(binary), *link], check=True)
    printed = subprocess.run([binary], check=True, capture_output=True, text=True).stdout
    volume, force = map(float, re.findall(r"[\d.]+(?:e-\d+)?(?= [mN])", printed))
    cap = np.pi * 0.001**2 * (3 * 0.05 - 0.001) / 3
    assert volume == pytest.approx(cap, rel=1e-5)  # six digits are printed
    assert force == pytest.approx(1e8 * cap, rel=1e-5)
