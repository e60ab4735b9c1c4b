# SPDX-License-Identifier: Apache-2.0
"""Names that steer a terminal, a page or a spreadsheet: they are shown and do nothing."""

import csv
import re
from html import escape

import pytest

from volcontact.cli import main
from volcontact.messages.printable import cell, printable

SCENE = """
<mujoco>
  <worldbody>
    <geom name="floor{tail}" type="plane" size="1 1 0.1"/>
    <body name="{head}body{tail}" pos="0 0 0.049"><freejoint/>
      <geom name="{head}ball{tail}" type="sphere" size="0.05" mass="1"/>
      <site name="site"/></body>
    <body name="other" pos="0 0 1"><freejoint/><geom name="other" size=".1"/></body>
  </worldbody>
  <sensor><force name="{head}force{tail}" site="site"/></sensor>
  <custom>
    <numeric name="volcontact/material/{key}/stiffness" data="1e8"/>
    <tuple name="volcontact/material/{key}">
      <element objtype="geom" objname="{head}ball{tail}"/></tuple>
  </custom>
</mujoco>
"""
ESCAPES = "\x1b]0;owned\x07\x1b[2J\u009b31m\u202e"
NAMES = {
    "escape sequences": ("", ESCAPES),
    "markup of the terminal": ("[bold]", "[/]"),
    "markup of the page": ("<script>", "</script>&amp;<img/src=x/onerror=alert(1)>"),
    "markup of formulas": ("$x_", "^{$"),
    "a formula": ("=HYPERLINK(1)", ""),
}


def reference(text):
    """As an XML attribute: control characters by their number."""
    marked = escape(text, quote=True)
    return re.sub("[\x00-\x1f\x7f-\x9f]", lambda m: f"&#{ord(m[0])};", marked)


@pytest.fixture(params=NAMES)
def scene(request, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    head, tail = map(reference, NAMES[request.param])
    path = tmp_path / "scene.xml"
    path.write_text(
        SCENE.format(head=head, tail=tail, key=f"{head}m{tail}".replace("/", "")), encoding="utf-8"
    )
    return str(path)


def harmless(text):
    return not re.search("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e]", text)


@pytest.mark.parametrize("command", [["check"], ["run", "--duration", "0.02"], ["metrics"]])
def test_the_terminal_is_not_steered(scene, command, capsys):
    assert main([command[0], scene, *command[1:]]) == 0
    output = capsys.readouterr()
    assert harmless(output.out) and harmless(output.err)
    assert main([command[0], scene, *command[1:], "--json"]) == 0
    assert harmless(capsys.readouterr().out)


def test_errors_do_not_steer_the_terminal_either(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    scene = SCENE.format(head="", tail="", key=f"m{reference(ESCAPES)}").replace(
        "/stiffness", "/stifness"
    )
    (tmp_path / "bad.xml").write_text(scene, encoding="utf-8")
    assert main(["check", "bad.xml"]) == 1
    error = capsys.readouterr().err
    assert harmless(error) and r"m\x1b]0;owned" in error


@pytest.mark.once
def test_the_report_shows_names_and_runs_none(scene, tmp_path):
    out = tmp_path / "out"
    arguments = ["compare", scene, "--duration", "0.02", "--frame-interval", "0.01"]
    assert main([*arguments, "--width", "64", "--height", "48", "--out", str(out)]) == 0
    page = (out / "report.html").read_text(encoding="utf-8")
    assert harmless(page)
    assert page.count("<script") == 2 and "<img/src=x" not in page
    for name in ("sites.csv", "trajectory.csv"):
        text = (out / name).read_text(encoding="utf-8")
        assert harmless(text)
        for row in csv.reader(text.splitlines()):
            for field in row:
                assert not re.match(r"[=+@\t\r]|-(?![0-9.]|inf|nan)", field), field


def test_what_is_not_seen_is_spelled_out():
    assert (
        printable("a\x1b[2J\x00\u202e\x9b\ud800b\n\tc") == r"a\x1b[2J\x00\u202e\x9b\ud800b" "\n\tc"
    )
    assert printable("Müller, 模型, ±1 µm²") == "Müller, 模型, ±1 µm²"
    for start in "=+-@\t\r":
        assert cell(f"{start}1")[0] == "'"
    assert cell("a=1") == "a=1" and cell("") == ""
