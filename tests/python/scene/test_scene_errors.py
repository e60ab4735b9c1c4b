# SPDX-License-Identifier: Apache-2.0
"""What is wrong with a scene, told so that its author can put it right."""

import re

import mujoco
import pytest

import volcontact as vc
from volcontact import _adaptor

SCENE = """
<mujoco>
  {head}
  <worldbody>
    <geom name="floor" type="plane" size="1 1 1"/>
    <body name="crate" pos="0 0 1"><freejoint name="joint"/>
      <geom name="crate" type="box" size=".1 .1 .1"/></body>
  </worldbody>
  <custom>{custom}</custom>
</mujoco>
"""
STEEL = (
    '<tuple name="volcontact/material/steel"><element objtype="{kind}" objname="{name}"/></tuple>'
)


def scene(custom="", head=""):
    return SCENE.format(custom=custom, head=head)


def numeric(name, data="1"):
    return f'<numeric name="volcontact/{name}" data="{data}"/>'


def steel(kind="geom", name="crate"):
    return STEEL.format(kind=kind, name=name)


KEY_ERRORS = {
    "unknown key": (
        steel() + numeric("material/steel/stifness", "1e8"),
        r"volcontact/material/steel/stifness: unknown key.*did you mean "
        r"'volcontact/material/steel/stiffness'",
    ),
    "negative stiffness": (
        steel() + numeric("material/steel/stiffness", "-1"),
        r"volcontact/material/steel: stiffness = -1 \[N/m\^3\] is out of range: must be > 0",
    ),
    "key without its tuple": (
        steel() + numeric("material/steal/stiffness", "1e8"),
        r'no <tuple name="volcontact/material/steal">.*did you mean \'volcontact/material/steel\'',
    ),
    "wrong count": (
        steel() + numeric("material/steel/damping", "1 2"),
        r"volcontact/material/steel/damping takes 1 number, got 2",
    ),
    "wrong object type": (steel("joint", "joint"), r"a tuple takes geoms and bodies only"),
    "unknown option": (
        numeric("option/tolerence", "1e-3"),
        r"did you mean 'volcontact/option/tolerance'",
    ),
    "unknown word": (
        numeric("option/target/appplied"),
        r"one of applied, passive, xfrc \(did you mean 'volcontact/option/target/applied'\?\)",
    ),
    "geom in two materials": (
        steel() + steel("body").replace("steel", "wood"),
        r"geom 'crate' is listed already, in volcontact/material/steel",
    ),
}


@pytest.mark.parametrize("name", KEY_ERRORS)
def test_wrong_keys_are_explained_at_load_and_at_attach(name):
    custom, message = KEY_ERRORS[name]
    with pytest.raises(ValueError, match=message):
        vc.load(scene(custom))
    model = mujoco.MjModel.from_xml_string(scene(custom, '<size nuserdata="1000"/>'))
    with pytest.raises(ValueError, match=message):
        vc.attach(model)


@pytest.mark.parametrize("kind", ["geom", "body"])
def test_misspelt_name_in_a_tuple_is_matched_with_the_nearest(kind):
    message = rf"volcontact/material/steel: there is no {kind} 'crat' \(did you mean 'crate'\?\)"
    with pytest.raises(ValueError, match=message):
        vc.load(scene(steel(kind, "crat")))


def test_misspelt_name_is_found_through_includes(tmp_path):
    (tmp_path / "keys.xml").write_text(f"<mujoco><custom>{steel(name='crat')}</custom></mujoco>")
    (tmp_path / "scene.xml").write_text(scene(head='<include file="keys.xml"/>'))
    with pytest.raises(ValueError, match="did you mean 'crate'"):
        vc.load(tmp_path / "scene.xml")


def test_other_errors_of_mujoco_come_as_they_are():
    with pytest.raises(ValueError, match=r"(?i)xml"):
        vc.load("<mujoco><worldbody>")


def test_too_small_userdata_names_the_line_to_add():
    model = mujoco.MjModel.from_xml_string(scene(steel()))
    with pytest.raises(ValueError, match=r"userdata is too small") as caught:
        vc.attach(model)
    line = str(caught.value).partition("write ")[2].partition(" into it")[0]
    assert line.startswith("<size nuserdata=")
    with vc.attach(mujoco.MjModel.from_xml_string(scene(steel(), line))) as contact:
        assert contact.is_installed()


def test_model_without_geoms_is_refused():
    with pytest.raises(ValueError, match="the model has no geoms"):
        vc.load("<mujoco/>")


def test_open_mesh_that_can_touch_is_refused_by_name():
    mesh = (
        '<asset><mesh name="wedge" vertex="0 0 0  1 0 0  0 1 0  0 0 1" '
        'face="0 2 1  0 1 3  1 2 3"/></asset>'
    )
    text = scene(head=mesh).replace('type="box" size=".1 .1 .1"', 'type="mesh" mesh="wedge"')
    with pytest.raises(ValueError, match=r"geom 'crate', mesh 'wedge' .*3 boundary edges"):
        vc.load(text)


@pytest.mark.parametrize("wrong", [None, 3, "scene.xml"])
def test_attach_takes_a_model(wrong):
    with pytest.raises(TypeError, match="MjModel"):
        vc.attach(wrong)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"stiffness": 1}, "'stiffness': it is of the material, material={'stiffness': 1}"),
        (
            {"friction_law": "bristle"},
            "it is of the material, material={'friction_law': 'bristle'}",
        ),
        ({"mesh": "hull"}, "'mesh': it is an option, options={'mesh': 'hull'}"),
        ({"materials": {}}, "'materials'; did you mean 'material'?"),
        ({"gravity": 0}, "'gravity'; there is material, options"),
    ],
)
def test_attach_tells_where_an_argument_belongs(given, told):
    with pytest.raises(TypeError, match=re.escape("attach has no argument ")) as raised:
        vc.attach(vc.load(scene()), **given)
    assert told in str(raised.value)


def test_flags_that_skip_the_callback_are_warned_of():
    old = '<option><flag passive="disable"/></option>'
    new = '<option><flag spring="disable" damper="disable"/></option>'
    try:
        model = vc.load(scene(head=new))
    except ValueError:  # a release that knows one flag only
        model = vc.load(scene(head=old))
    with pytest.warns(RuntimeWarning, match="there will be no contact at all"):
        contact = vc.attach(model)
    assert any("no contact at all" in text for text in contact.description["warnings"])
    contact.close()


def test_package_built_for_another_mujoco_says_so(monkeypatch):
    monkeypatch.setattr(mujoco, "__version__", "9.8.7")
    _adaptor.adaptor.cache_clear()
    try:
        message = r"runs with MuJoCo 9\.8\.7 but was built for MuJoCo.*has no .*so\.9\.8\.7"
        with pytest.raises(RuntimeError, match=message):
            vc.load(scene())
    finally:
        _adaptor.adaptor.cache_clear()
