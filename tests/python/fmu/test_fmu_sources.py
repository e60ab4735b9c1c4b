# SPDX-License-Identifier: Apache-2.0
"""Sources inside: a stranger compiles them by what the unit says, and gets the same bits."""

import re
import shutil
import subprocess
import zipfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

import volcontact as vc
from volcontact.fmu import packing

fmpy = pytest.importorskip("fmpy", reason="FMPy is missing: pip install fmpy")
COMPILER = ["ccache", "c++"] if shutil.which("ccache") else ["c++"]


def dragged_ball():
    return vc.ContactModel(
        pairs=[vc.Pair(vc.Sphere(radius=0.05), vc.HalfSpace()),
               vc.Pair(vc.Torus(0.05, 0.01), vc.Box((0.1, 0.1, 0.049)))],
        normal=vc.HuntCrossley(stiffness=1e8, damping=0.5),
        friction=vc.Bristle(friction=0.3, static_friction=0.4),
    )  # fmt: skip


@pytest.fixture(scope="module", params=[2, 3])
def unit(request, tmp_path_factory):
    path = tmp_path_factory.mktemp("sources") / "ball.fmu"
    return vc.export_fmu(dragged_ball(), path, fmi=request.param, sources=True, arrays=False)


def to_compile(folder):
    """Files, options, folders for headers and libraries, as the FMU says."""
    build = folder / "sources" / "buildDescription.xml"
    if not build.is_file():
        about = ElementTree.parse(folder / "modelDescription.xml").getroot()
        names = [file.get("name") for file in about.findall("CoSimulation/SourceFiles/File")]
        assert names == [f.get("name") for f in about.findall("ModelExchange/SourceFiles/File")]
        return names, "", ["."], []
    (configuration,) = ElementTree.parse(build).getroot()
    (files,) = configuration.findall("SourceFileSet")
    assert configuration.get("modelIdentifier") == "ball"
    return (
        [file.get("name") for file in files.findall("SourceFile")],
        files.get("compilerOptions"),
        [one.get("name") for one in files.findall("IncludeDirectory")],
        [one.get("name") for one in configuration.findall("Library")],
    )


def test_the_archive_is_valid_and_has_all_it_names(unit, tmp_path):
    from fmpy.validation import validate_fmu

    assert validate_fmu(str(unit)) == []
    with zipfile.ZipFile(unit) as fmu:
        fmu.extractall(tmp_path)
        names = {name.removeprefix("sources/") for name in fmu.namelist()}
    files, _, _, _ = to_compile(tmp_path)
    assert len(files) > 20
    assert set(files) <= names
    for name in names:
        path = tmp_path / "sources" / name
        if path.suffix not in {".cc", ".h", ".inc"}:
            continue
        text = path.read_text(errors="replace")
        assert "CGAL/" not in text
        assert "SPDX-License-Identifier: Apache-2.0" in text[:200], name
        for included in re.findall(r'#\s*include\s+"([^"]+)"', text):
            assert included in names or (path.parent / included).is_file(), (name, included)


def test_build_description_follows_the_schema(unit, tmp_path):
    lxml = pytest.importorskip("lxml.etree")
    with zipfile.ZipFile(unit) as fmu:
        if "sources/buildDescription.xml" not in fmu.namelist():
            return  # FMI 2.0 has none
        text = fmu.read("sources/buildDescription.xml")
    schema = Path(fmpy.__file__).parent / "schema" / "fmi3" / "fmi3BuildDescription.xsd"
    lxml.XMLSchema(file=str(schema)).assertValid(lxml.fromstring(text))


def rows(path):
    names = ["A.position[1]", "A.position[3]", "A.velocity[1]"]
    signals = np.array(
        [(t, 2e-3 * t, 0.0495, 2e-3) for t in np.linspace(0.0, 0.02, 21)],
        dtype=[("time", float)] + [(name, float) for name in names],
    )
    return fmpy.simulate_fmu(
        str(path), fmi_type="CoSimulation", stop_time=0.02, output_interval=1e-3, input=signals,
        output=["A.force[1]", "A.force[3]", "A.torque[2]", "dissipated_energy[3]"],
    )  # fmt: skip


# What most of the files include, parsed once; and no bit depends on how far a compiler optimises.
# As the options say, the same takes twice as long.
QUICKLY = ["-O0", "-fpch-preprocess"]
COMMON = "volcontact/shape/shapes.h"
ROOT = Path(__file__).parents[3]
CORE = ROOT / "build" / "core" / "plugin" / "volcontact" / "libvolcontact_core.a"


def core_of_the_checkout(sources):
    """Its library, if the sources of the unit are its own."""
    if not CORE.is_file():
        pytest.skip("./run builds the core of the checkout")
    files = [file for file in (sources / "volcontact").rglob("*") if file.is_file()]
    assert len(files) > 200
    for file in files:
        own = ROOT / "plugin" / file.relative_to(sources)
        assert file.read_bytes() == own.read_bytes(), own
    return CORE


@pytest.mark.parametrize(
    "core", ["of the checkout", pytest.param("of the unit", marks=pytest.mark.soak)]
)
def test_compiled_by_what_the_unit_says_it_has_the_same_bits(core, tmp_path):
    """FMI 3: buildDescription.xml. Every other file of FMI 2 is the same.

    To compile the core takes minutes: `./run test` compiles what is around it.
    """
    path = vc.export_fmu(dragged_ball(), tmp_path / "ball.fmu", fmi=3, sources=True, arrays=False)
    with zipfile.ZipFile(path) as fmu:
        fmu.extractall(tmp_path / "unpacked")
    files, options, folders, libraries = to_compile(tmp_path / "unpacked")
    sources = tmp_path / "unpacked" / "sources"
    given = []
    if core == "of the checkout":
        files = [name for name in files if not name.startswith("core_")]
        given = [core_of_the_checkout(sources)]
    words = [*options.split(), *QUICKLY, *(f"-I{one}" for one in folders)]

    def compiled(name, *more):
        out = name.removesuffix(".cc") + ".o"
        command = [*COMPILER, *words, *more, "-c", name, "-o", out]
        done = subprocess.run(command, cwd=sources, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr[:2000]
        return out

    def common(name):
        return ["-include", "common.h"] if name.startswith("core_") else []

    # Each file defines the same before its first include; so has what is included before it.
    defined = re.findall(r"^#define (\w+)$", (sources / files[0]).read_text(), re.MULTILINE)
    assert defined
    (sources / "common.h").write_text(
        "".join(f"#define {name}\n" for name in defined) + f'#include "{COMMON}"\n'
    )
    if not given:
        subprocess.run(
            ["c++", *words, "-x", "c++-header", "common.h", "-o", "common.h.gch"],
            cwd=sources, check=True,
        )  # fmt: skip
    with ThreadPoolExecutor(2) as pool:
        objects = list(pool.map(lambda name: compiled(name, *common(name)), files))
    binary = next((tmp_path / "unpacked" / "binaries").glob("*/ball.*"))
    shipped = binary.read_bytes()
    binary.unlink()
    subprocess.run(
        ["c++", "-shared", "-o", str(binary), *objects, *given, *(f"-l{one}" for one in libraries)],
        cwd=sources, check=True,
    )  # fmt: skip
    assert binary.read_bytes() != shipped
    own = tmp_path / "own.fmu"
    with zipfile.ZipFile(own, "w") as fmu:
        for file in (tmp_path / "unpacked").rglob("*"):
            if file.is_file() and "sources" not in file.parts:
                fmu.write(file, file.relative_to(tmp_path / "unpacked"))
    wanted, got = rows(path), rows(own)
    assert abs(wanted["A.force[1]"][-1]) > 1.0
    assert got.tolist() == wanted.tolist()


def test_a_package_without_sources_or_binaries_says_so(tmp_path, monkeypatch):
    model = dragged_ball()
    monkeypatch.setattr("volcontact.fmu.sources._plugin_places", lambda: [tmp_path])
    with pytest.raises(RuntimeError, match="no sources to put into an FMU"):
        vc.export_fmu(model, tmp_path / "a.fmu", sources=True)
    monkeypatch.setattr(packing, "library_folder", lambda: tmp_path)
    with pytest.raises(RuntimeError, match=r"no volcontact_fmi2\.\w+; build it again"):
        vc.export_fmu(model, tmp_path / "a.fmu")
    assert not (tmp_path / "a.fmu").exists()
