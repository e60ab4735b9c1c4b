# SPDX-License-Identifier: Apache-2.0
"""The documentation is true: its code runs, its links lead somewhere, its tables are the code's."""

from __future__ import annotations

import csv
import importlib.util
import json
import os
import re
import statistics
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import mujoco
import pytest

import volcontact as vc
from volcontact.cli import make_parser

ROOT = Path(__file__).resolve().parents[3]
PAGES = [ROOT / "README.md", ROOT / "plugin" / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
SOURCES = [
    path
    for folder in ("plugin", "python", "tests")
    for suffix in ("h", "cc", "py")
    for path in sorted((ROOT / folder).rglob(f"*.{suffix}"))
]
# Tutorials simulate for seconds.
LONG = {page: [pytest.mark.once] for page in PAGES if page.parent.name == "tutorials"}
RUN = [pytest.param(page, marks=LONG.get(page, [])) for page in PAGES]
STEPS = 20  # enough for MuJoCo to complain about a scene that does not work

SCENE = """
<mujoco>
  {assets}
  <worldbody>
    <geom name="floor" type="plane" size="1 1 0.1"/>
    <body name="crate" pos="0 0 0.1">
      <freejoint/><geom name="crate" type="box" size="0.1 0.1 0.1"/>
    </body>
    {bodies}
  </worldbody>
  <custom>{keys}</custom>
</mujoco>"""

_FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_LINK = re.compile(r"(?<!\!)\[[^\]\n]+\]\(([^)\s]+)\)")
_CITATION = re.compile(r"\[([A-Z][A-Za-z]*\d{4}|CSA|Drake|MuJoCo|Simbody)\b[^\]]*\](?!\()")
_SECTION = re.compile(r"docs/(\w+\.md), [\"']([^\"']+)[\"']")


def blocks(page: Path, language: str) -> list[tuple[int, str]]:
    """Line number and text of every fenced block of the language."""
    text = page.read_text(encoding="utf-8")
    return [
        (text.count("\n", 0, found.start(2)) + 1, found.group(2))
        for found in _FENCE.finditer(text)
        if found.group(1) == language
    ]


def anchor(heading: str) -> str:
    """The anchor a heading gets on the page."""
    kept = re.sub(r"[^\w\- ]", "", heading.strip().lower())
    return kept.replace(" ", "-")


def headings(page: Path) -> list[str]:
    """Headings of the page, code blocks left out."""
    prose = _FENCE.sub("", page.read_text(encoding="utf-8"))
    return re.findall(r"^#+ +(.+?) *$", prose, re.MULTILINE)


def generator(name: str) -> ModuleType:
    """A script of docs as a module. It finds its neighbours as when it runs as a program."""
    folder = ROOT / "docs" / "generate"
    if str(folder) not in sys.path:
        sys.path.insert(0, str(folder))
    spec = importlib.util.spec_from_file_location(name, folder / f"{name.replace('.', '/')}.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # its dataclasses look there
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("page", RUN, ids=lambda page: str(page.relative_to(ROOT)))
def test_python_blocks_run(page: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Blocks of one page run in order and share their names, as a reader would type them."""
    monkeypatch.chdir(ROOT)
    names: dict[str, Any] = {"__name__": page.stem}
    for line, text in blocks(page, "python"):
        # Leading newlines make the line numbers of a traceback those of the page.
        exec(compile("\n" * (line - 1) + text, str(page), "exec"), names)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_mjcf_blocks_load_and_step(page: Path) -> None:
    for line, text in blocks(page, "xml"):
        if "<mujoco" not in text:
            continue
        model = vc.load(text)
        data = mujoco.MjData(model)
        with vc.attach(model):
            for _ in range(STEPS):
                mujoco.mj_step(model, data)
        raised = [warning for warning in data.warning if warning.number]
        assert not raised, f"{page.name}:{line}: MuJoCo warnings {raised}"


def test_components_page_is_generated_from_the_field_tables() -> None:
    module = generator("make_components")
    assert module.PAGE.read_text(encoding="utf-8") == module.render(), (
        "run './run python docs/generate/make_components.py'"
    )


def test_reference_has_every_public_name() -> None:
    page = (ROOT / "docs" / "reference" / "python.md").read_text(encoding="utf-8")
    listed = re.findall(r"^\.\. autoapi(?:class|function):: volcontact\.(\w+)$", page, re.MULTILINE)
    assert sorted(listed) == sorted(set(vc.__all__) - {"__version__"})


def test_places_in_the_glossary_exist() -> None:
    named = 0
    rows = (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8").splitlines()
    for row in filter(lambda line: line.startswith("|"), rows):
        for place in re.findall(r"`([^`]+)`", row.strip("|").split("|")[-1]):
            above = "" if place.startswith("plugin/") else "plugin/volcontact"
            assert (ROOT / above / place).exists(), row
            named += 1
    assert named > 50


def test_drawing_of_the_rooms_is_that_of_the_includes() -> None:
    module = generator("make_rooms")
    assert module.PAGE.read_text(encoding="utf-8") == module.render(), (
        "run './run python docs/generate/make_rooms.py'"
    )


def test_page_of_the_keys_is_generated_from_what_the_code_accepts() -> None:
    module = generator("make_mjcf_keys")
    assert module.PAGE.read_text(encoding="utf-8") == module.render(), (
        "run './run python docs/generate/make_mjcf_keys.py'"
    )


@pytest.mark.once
def test_pictures_of_the_concepts_show_what_the_core_computes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    module = generator("make_concepts")
    monkeypatch.setattr("parts.concepts_sections.POINTS", 20)  # the test looks at numbers alone
    assert {path.stem for path in module.PICTURES.glob("*.svg")} == set(module.PICTURE)
    for name, draw in module.PICTURE.items():
        picture = (module.PICTURES / f"{name}.svg").read_text(encoding="utf-8")
        assert f"<dc:source>{module.digest(draw()[1])}</dc:source>" in picture, (
            "run './run python docs/generate/make_concepts.py'"
        )


def test_every_engine_and_law_has_a_page() -> None:
    words, laws = generator("make_mjcf_keys").words_after, generator("make_components").laws()
    engines = {path.stem for path in (ROOT / "docs" / "engines").glob("*.md")}
    assert engines == set(words("options", "engine")) - {"auto"}
    pages = {path.stem for path in (ROOT / "docs" / "laws").glob("*.md")}
    choices = {"coupling", "rolling"}  # of every pair, whatever its laws
    assert pages == set(laws) | choices | set(words("options", "formulation"))
    module = generator("make_blocks")
    named = {path.name for path in module.pages()}
    for name in engines | pages:
        assert f"{name}.md" in named, f"{name}.md has no block from the code or the results"
    shown = "".join(page.read_text("utf-8") for page in module.pages())
    for picture in module.PICTURE:
        assert f"]({Path(picture).name}.svg)" in shown, picture


@pytest.mark.once
def test_blocks_of_pages_say_what_the_code_and_the_results_say(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    module = generator("make_blocks")
    digest = generator("make_concepts").digest
    command = "run './run python docs/generate/make_blocks.py'"
    for page in module.pages():
        text = page.read_text(encoding="utf-8")
        assert text == module.render(text), f"{page.name}: {command}"
    monkeypatch.setattr("parts.concepts_sections.POINTS", 20)  # the test looks at numbers alone
    for name, draw in module.PICTURE.items():
        picture = (module.DOCS / f"{name}.svg").read_text(encoding="utf-8")
        assert f"<dc:source>{digest(draw()[1])}</dc:source>" in picture, command


def test_pictures_of_the_hosts_show_what_was_measured() -> None:
    module, digest = generator("make_hosts"), generator("make_concepts").digest
    found = json.loads(module.RESULT.read_text(encoding="utf-8"))
    assert {page.stem for page in module.PICTURES.glob("*.md")} == set(found["hosts"])
    shown = {host: module.numbers(found, host) for host in found["hosts"]}
    shown["simulink"] = module.block_diagram()[1]
    for name, numbers in shown.items():
        picture = (module.PICTURES / f"{name}.svg").read_text(encoding="utf-8")
        assert f"<dc:source>{digest(numbers)}</dc:source>" in picture, (
            "run './run python docs/generate/make_hosts.py'"
        )


def test_times_on_the_pages_of_the_engines_are_all_there_are() -> None:
    """Every pair of the performance page is some engine's, and what that engine is."""
    module = generator("parts.page_blocks")
    titles = [title for timed in module.TIMED.values() for title in timed]
    assert sorted(titles) == sorted(asked.title for asked in module.ASKED)


def test_accuracy_page_is_generated_from_the_results() -> None:
    module = generator("make_accuracy")
    assert module.PAGE.read_text(encoding="utf-8") == module.render(), (
        "run './run python docs/generate/make_accuracy.py'"
    )


def test_accuracy_page_has_every_pair_of_every_engine() -> None:
    """Independent of the generator's merging of the two orders."""
    page = (ROOT / "docs" / "accuracy.md").read_text(encoding="utf-8")
    table = (ROOT / "tests" / "benchmarks" / "results" / "accuracy.csv").read_text(encoding="utf-8")
    for line in table.splitlines()[1:]:
        a, b, engine, poses = line.split(",")[:4]
        section = page.split(f"## `{engine}`")[1].split("\n## ")[0]
        both = (f"| {a} - {b}, both orders |", f"| {b} - {a}, both orders |")
        named = (f"| {a} - {b} |", *both)
        assert poses == "0" or any(name in section for name in named), (engine, a, b)


def test_performance_page_is_generated_from_the_results() -> None:
    module = generator("make_performance")
    assert module.PAGE.read_text(encoding="utf-8") == module.render(), (
        "run './run python docs/generate/make_performance.py'"
    )


def test_times_in_the_readme_are_those_of_the_pages() -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    performance = (ROOT / "docs" / "performance.md").read_text(encoding="utf-8")

    def times(row: str, text: str) -> list[str]:
        """Of the first row of a table that begins so and has times."""
        rows = (line for line in text.splitlines() if line.startswith(f"| {row}"))
        found = (re.findall(r"(?<![\d.])[\d.]+ [um]s\b", line) for line in rows)
        return next(numbers for numbers in found if numbers)

    assert set(times("one query", readme)) <= set(times("bored block - peg 0.3 mm |", performance))
    ours, native, drake = (times("one step", readme)[i : i + 2] for i in (0, 2, 4))
    for i, scene in enumerate(("battery box, seated", "pile of 20 boxes, at rest")):
        row = times(scene, performance)
        assert [native[i], ours[i], drake[i]] == [row[1], row[2], row[3]], scene
    with (ROOT / "tests" / "benchmarks" / "results" / "third_party.csv").open() as table:
        rows = [row for row in csv.DictReader(table) if row["volumetric_us"]]
    ratios = sorted(float(row["volumetric_us"]) / float(row["native_us"]) for row in rows)
    least, most, median = (f"{r:.1f}" for r in (ratios[0], ratios[-1], statistics.median(ratios)))
    assert f"take {least} to {most} times as long, {median} in the median" in readme
    stacks = next(line for line in performance.splitlines() if line.startswith("| 20 boxes in 4"))
    assert f"stacks {stacks.split(' | ')[4]}." in readme


def test_performance_plots_are_made_of_the_results() -> None:
    """The plots themselves differ from one release of matplotlib to the next."""
    module = generator("make_performance")
    assert {path.stem for path in module.PLOTS.glob("*.svg")} == set(module.PLOT)
    for name in module.PLOT:
        plot = (module.PLOTS / f"{name}.svg").read_text(encoding="utf-8")
        assert f"<dc:source>{module.digest()}</dc:source>" in plot, (
            "run './run python docs/generate/make_performance.py'"
        )


def test_comparison_page_is_generated_from_results_and_validation_page() -> None:
    module = generator("make_comparison")
    assert module.PAGE.read_text(encoding="utf-8") == module.render(), (
        "run './run python docs/generate/make_comparison.py'"
    )


def test_assembly_page_and_its_plots_are_generated_from_the_results() -> None:
    module = generator("make_assembly")
    command = "run './run python docs/generate/make_assembly.py'"
    assert module.PAGE.read_text(encoding="utf-8") == module.render(), command
    assert {path.stem for path in module.PLOTS.glob("*.svg")} == set(module.PLOT)
    for name in module.PLOT:
        plot = (module.PLOTS / f"{name}.svg").read_text(encoding="utf-8")
        assert f"<dc:source>{module.digest()}</dc:source>" in plot, command


def test_campaign_page_is_generated_from_the_results() -> None:
    module = generator("make_campaign")
    assert module.PAGE.read_text(encoding="utf-8") == module.render(), (
        "run './run python docs/generate/make_campaign.py'"
    )


def test_third_party_page_is_generated_from_the_results() -> None:
    module = generator("make_third_party")
    assert module.PAGE.read_text(encoding="utf-8") == module.render(), (
        "run './run python docs/generate/make_third_party.py'"
    )


def test_coverage_page_is_generated_from_the_results() -> None:
    pytest.importorskip("scipy")
    made = generator("make_identify_coverage")
    assert made.PAGE.read_text(encoding="utf-8") == made.render()


def test_convergence_page_is_generated_from_the_results() -> None:
    module = generator("make_convergence")
    assert module.PAGE.read_text(encoding="utf-8") == module.render(), (
        "run './run python docs/generate/make_convergence.py'"
    )


def test_bench_tests_page_has_what_its_sheets_say() -> None:
    module = generator("make_bench_tests")
    assert module.PAGE.read_text(encoding="utf-8") == module.render(), (
        "run './run python docs/generate/make_bench_tests.py'"
    )


def test_results_hold_no_path_and_no_name_of_a_machine() -> None:
    results = sorted((ROOT / "tests" / "benchmarks").glob("**/results/*.csv"))
    assert len({table.parent for table in results}) > 1
    for table in results:
        text = table.read_text(encoding="utf-8")
        assert not re.search(r"(^|[\s\",])/[a-z]+/", text), f"{table.name} holds a path"
        assert "host" not in text, f"{table.name} may name a machine"


def test_components_page_lists_every_component() -> None:
    """Independent of the generator's parsing: every public law and solid has its section."""
    page = (ROOT / "docs" / "components.md").read_text(encoding="utf-8")
    for name in vc.__all__:
        item = getattr(vc, name)
        bases = (vc.NormalForce, vc.Friction, vc.NormalLaw, vc.FrictionLaw)
        if not isinstance(item, type) or item in bases:
            continue
        if issubclass(item, (vc.NormalForce, vc.Friction)) or hasattr(item, "own_metrics"):
            assert f"Python: `{name}`" in page


def number(key: str, data: float | str) -> str:
    return f'<numeric name="volcontact/{key}" data="{data}"/>'


def tuple_of(name: str, geom: str) -> str:
    element = f'<element objtype="geom" objname="{geom}"/>'
    return f'<tuple name="volcontact/{name}">{element}</tuple>'


WOOD = tuple_of("material/wood", "crate")
SPRING = number("material/wood/normal_law/volume_spring", 1)
MISTAKES = {
    "misspelt key": WOOD + number("material/wood/stifness", 1e7),
    "out of range": WOOD + number("material/wood/stiffness", -1),
    "two numbers": WOOD + number("material/wood/stiffness", "1 2"),
    "no such material": WOOD + number("material/wod/stiffness", 1e7),
    "no such geom": tuple_of("material/wood", "crat"),
    "two materials": WOOD + tuple_of("material/steel", "crate"),
    "different laws": WOOD
    + SPRING
    + tuple_of("material/stone", "floor")
    + number("material/stone/normal_law/hunt_crossley", 1),
    "neither adds nor cuts": tuple_of("solid/part", "crate"),
    "no such field": WOOD + SPRING + number("material/wood/damping", 1),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_documented_messages_are_those_of_the_code(mistake: str) -> None:
    with pytest.raises(ValueError, match="volcontact/") as caught:
        vc.load(SCENE.format(assets="", bodies="", keys=MISTAKES[mistake]))
    assert str(caught.value) in documented_messages()


def test_documented_message_for_too_little_userdata() -> None:
    keys = number("option/tolerance", 1e-3)
    model = mujoco.MjModel.from_xml_string(SCENE.format(assets="", bodies="", keys=keys))
    with pytest.raises(ValueError, match="userdata") as caught:
        vc.attach(model)
    assert str(caught.value) in documented_messages()


def test_documented_message_for_a_mesh() -> None:
    corners = 'vertex="0 0 0  1 0 0  0 1 0  0 0 1" face="0 2 1  0 1 3  1 2 3"'
    assets = f'<asset><mesh name="wedge" {corners}/></asset>'
    geom = '<geom name="rock" type="mesh" mesh="wedge"/>'
    inertial = '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
    bodies = f'<body name="rock"><freejoint/>{inertial}{geom}</body>'
    with pytest.raises(ValueError, match="mesh 'wedge'") as caught:
        vc.load(SCENE.format(assets=assets, bodies=bodies, keys=""))
    # Where the corners are depends on how MuJoCo lays the frame of the geom.
    places = re.compile(r"\([^()]*\) to \([^()]*\);")
    documented = {places.sub("", message) for message in documented_messages()}
    assert places.sub("", str(caught.value)) in documented


def documented_messages() -> list[str]:
    """Lines of the text blocks of the page that lists the messages."""
    page = ROOT / "docs" / "writing_a_scene.md"
    return [line for _, text in blocks(page, "text") for line in text.splitlines()]


@pytest.mark.parametrize("language", ["c", "cpp"])
def test_programs_of_the_plugin_page_run(language: str, tmp_path: Path) -> None:
    """Compiled as the page says, against the MuJoCo and the adaptor of this environment."""
    page = ROOT / "plugin" / "README.md"
    (_, program), (_, scene) = blocks(page, language)[0], blocks(page, "xml")[0]
    source = tmp_path / f"program.{language}"
    source.write_text(program, encoding="utf-8")
    (tmp_path / "scene.xml").write_text(scene, encoding="utf-8")
    package = Path(mujoco.__file__).parent
    adaptor = Path(vc._volcontact.__file__).parent
    (mujoco_library,) = package.glob("libmujoco.so.*")
    (adaptor_library,) = adaptor.glob(f"libvolcontact_mujoco-{mujoco.__version__}.so")
    variable, default, standard = {
        "c": ("CC", "cc", "-std=c99"),
        "cpp": ("CXX", "c++", "-std=c++17"),
    }[language]
    subprocess.run(
        [
            os.environ.get(variable, default),
            standard,
            "-Wall",
            "-Wextra",
            "-Werror",
            source,
            f"-I{ROOT / 'plugin'}",
            f"-isystem{package / 'include'}",
            adaptor_library,
            mujoco_library,
            f"-Wl,-rpath,{adaptor}:{package}",
            "-o",
            tmp_path / "program",
        ],
        check=True,
    )
    ran = subprocess.run(
        [tmp_path / "program"], cwd=tmp_path, check=True, capture_output=True, text=True
    )
    if language == "c":
        assert "touches at 1 place" in ran.stdout
    else:
        (force,) = re.findall(r"geoms 0 and 1: (\S+) N", ran.stdout)
        assert float(force) == pytest.approx(9.81, rel=0.05)  # 1 kg that has nearly come to rest


def test_own_law_of_the_page_is_the_one_that_is_compiled_and_tested() -> None:
    page, built = ROOT / "docs" / "own_laws.md", ROOT / "tests" / "own_law"
    ((_, law),), ((_, project),) = blocks(page, "cpp"), blocks(page, "cmake")
    assert law in (built / "crushable.h").read_text(encoding="utf-8")
    assert project in (built / "CMakeLists.txt").read_text(encoding="utf-8")


def test_commands_of_the_pages_exist() -> None:
    """Words of ./run, commands of the program, targets, presets: what a shell block calls."""
    noxfile = (ROOT / "noxfile.py").read_text(encoding="utf-8")
    lists = "".join(p.read_text("utf-8") for p in (ROOT / "plugin").rglob("CMakeLists.txt"))
    presets = (ROOT / "CMakePresets.json").read_text(encoding="utf-8")
    (commands,) = (a.choices for a in make_parser()._actions if hasattr(a, "choices") and a.choices)
    seen = 0
    for page in [*PAGES, ROOT / "CONTRIBUTING.md", ROOT / "plugin" / "cgal" / "README.md"]:
        text = "".join(text for _, text in blocks(page, "sh"))
        for word in re.findall(r"^\./run (\w+)", text, re.MULTILINE):
            assert re.search(rf"^def {word}_?\(", noxfile, re.MULTILINE), (page, word)
            seen += 1
        for word in re.findall(r"^(?:\./run )?volcontact (\w+)", text, re.MULTILINE):
            assert word in commands, (page, word)
        for target in re.findall(r"--target (\w+)", text):
            assert re.search(rf"add_(library|executable)\({target}\b", lists), (page, target)
        for preset in re.findall(r"--preset (\w+)", text):
            assert f'"name": "{preset}"' in presets, (page, preset)
    assert seen > 8


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_somewhere(page: Path) -> None:
    prose = _FENCE.sub("", page.read_text(encoding="utf-8"))
    for target in _LINK.findall(prose):
        if "://" in target:
            continue
        path, _, fragment = target.partition("#")
        linked = (page.parent / path).resolve() if path else page
        assert linked.exists(), f"{page.name}: no file {target}"
        if fragment:
            anchors = [anchor(heading) for heading in headings(linked)]
            assert fragment in anchors, f"{page.name}: no heading for {target}"


def test_every_section_the_code_names_exists() -> None:
    named = {
        (page, section, path.name)
        for path in SOURCES
        # A comment may break the line inside the name of a section.
        for page, section in _SECTION.findall(
            re.sub(r"\s*\n\s*(///?|#)?\s*", " ", path.read_text(encoding="utf-8"))
        )
    }
    assert named, "the code refers to no section of the documentation"
    known = {page: headings(ROOT / "docs" / page) for page, _, _ in named}
    assert not sorted(reference for reference in named if reference[1] not in known[reference[0]])


def test_every_citation_is_in_the_bibliography() -> None:
    bibliography = (ROOT / "docs" / "references.md").read_text(encoding="utf-8")
    keys = set(re.findall(r"^\| \[(\w+)\] \|", bibliography, re.MULTILINE))
    assert keys
    cited = {key for page in PAGES for key in _CITATION.findall(page.read_text(encoding="utf-8"))}
    assert cited <= keys, f"not in docs/references.md: {sorted(cited - keys)}"
