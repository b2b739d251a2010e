# SPDX-License-Identifier: GPL-3.0-or-later
"""Registration, with and without the library."""

import bpy
import pytest
import stage
from triptych import abi, core, panels, properties, settings


def test_registers_twice(addon):
    addon.register()
    assert hasattr(bpy.types.Scene, "triptych")
    addon.register()


def test_unregister_leaves_nothing(addon):
    addon.unregister()
    try:
        assert not hasattr(bpy.types.Scene, "triptych")
        assert not hasattr(bpy.types.Material, "triptych")
        assert not hasattr(bpy.types, "TRIPTYCH_RENDER_PT_method")
        for panel in panels._all_subclasses(bpy.types.Panel):
            if not panel.__module__.startswith("triptych"):
                assert "TRIPTYCH" not in getattr(panel, "COMPAT_ENGINES", ())
        addon.unregister()  # twice is no error
    finally:
        addon.register()


def test_without_library(addon, scene, monkeypatch, capfd):
    """The engine registers, says what is missing, and a render ends with that message and a black picture."""
    monkeypatch.setenv("TRIPTYCH_LIBRARY", "/nowhere/libtriptych.so")
    monkeypatch.setattr(abi, "_library", None)
    addon.register()
    try:
        assert "/nowhere/libtriptych.so" in abi.missing()
        assert set(properties.METHODS) == {
            item.identifier for item in scene.triptych.bl_rna.properties["method"].enum_items
        }
        scene.render.engine = "TRIPTYCH"
        stage.plane(scene)
        stage.camera(scene)
        pixels = stage.render(scene)
        assert pixels.shape == (48, 64, 4) and not pixels.any()
        assert "/nowhere/libtriptych.so" in stage.status()
    finally:
        monkeypatch.undo()
        addon.register()


def test_not_a_library(monkeypatch, tmp_path):
    path = tmp_path / "libtriptych.so"
    path.write_text("no library")
    monkeypatch.setenv("TRIPTYCH_LIBRARY", str(path))
    monkeypatch.setattr(abi, "_library", None)
    assert "cannot be loaded" in abi.missing()


def test_blender_panels_are_open(addon):
    for name in ("RENDER_PT_format", "RENDER_PT_output", "DATA_PT_lens", "DATA_PT_camera_dof", "VIEWLAYER_PT_layer"):
        assert "TRIPTYCH" in getattr(bpy.types, name).COMPAT_ENGINES, name


@pytest.mark.library
def test_every_method_is_selectable(scene):
    for name, _, _ in core.methods():
        scene.triptych.method = name
        assert scene.triptych.method == name


@pytest.mark.library
def test_settings_have_their_defaults(scene):
    """Each setting of the table is a property with its default, written as the library reads it."""
    for setting in core.settings():
        value = getattr(scene.triptych, settings.property_name(setting.name))
        told = settings.as_text(tuple(value) if setting.type == "COLOR" else value)
        if setting.type in {"FLOAT", "COLOR"}:
            expected = [float(number) for number in setting.default.split(",")]
            given = [float(number) for number in told.split(",")]
            assert given == pytest.approx(expected * (len(given) // len(expected)), rel=1e-6), setting.name
        elif setting.type == "BOOL":
            assert told == ("on" if setting.default in {"on", "true", "1"} else "off"), setting.name
        else:
            assert told == setting.default, setting.name
    assert settings.changed(scene) == {}


@pytest.mark.library
def test_settings_are_named_as_blenders(scene):
    shown = scene.triptych.bl_rna.properties
    assert shown["radiosity_element_size"].name == "Element Size"
    assert shown["radiosity_element_size"].unit == "LENGTH" and shown["lines_crease_angle"].unit == "ROTATION"
    assert shown["lines_color_by"].name == "Color By"
    assert shown["radiosity_view"].enum_items["false_color"].name == "False Color"
    assert shown["film_filter"].enum_items["blackman_harris"].name == "Blackman-Harris"
    for setting in core.settings():
        name = shown[settings.property_name(setting.name)].name
        assert name.split() == [word[0].upper() + word[1:] for word in name.split()] and "olour" not in name
        if setting.unit and setting.type == "FLOAT":
            unit = shown[settings.property_name(setting.name)].unit
            assert (unit == "NONE") == (setting.unit not in {"m", "radians"}), setting.name


@pytest.mark.library
def test_settings_of_other_solvers_are_grey(scene):
    names = {setting.name for setting in core.settings()}
    assert names >= panels._USED_WITH.keys()
    group = scene.triptych

    def grey():
        return {name for name in names if not panels.is_used(group, name)}

    views = {f"radiosity.{name}" for name in ("view_scale", "legend", "view_element")}
    by_rows = {f"radiosity.{name}" for name in ("form_factors", "subdivisions", "rays", "hemicube_resolution")}
    progressive = {f"radiosity.{name}" for name in ("patch_levels", "order", "ambient")}
    assert grey() == views | by_rows | progressive | {"radiosity.memory"}
    group.radiosity_solver, group.radiosity_form_factors = "progressive", "hemicube"
    assert grey() == views | {"radiosity.memory", "radiosity.link_ratio"}
    group.radiosity_solver, group.radiosity_view = "matrix", "illuminance"
    assert grey() == progressive | {"radiosity.link_ratio", "radiosity.view_element"}


@pytest.mark.library
def test_switch_shows_the_methods_default(scene):
    """Until it is set, and then what was set, whatever the method."""
    group = scene.triptych
    shown = {}
    for method in ("ray_casting", "phong"):
        group.method = method
        shown[method] = group.shadows
    assert shown == {"ray_casting": True, "phong": False}
    assert "shadows" not in settings.changed(scene)
    group.shadows = True
    assert group.shadows and settings.changed(scene)["shadows"] == "on"
    group.method = "ray_casting"
    group.shadows = False
    assert not group.shadows and settings.changed(scene)["shadows"] == "off"


def test_a_number_shows_what_the_method_has():
    scene = bpy.data.scenes.new("Numbers")
    group = scene.triptych
    shown = {}
    for method in ("ray_tracing", "path_tracing"):
        group.method = method
        shown[method] = group.samples, group.trace_depth
    assert shown == {"ray_tracing": (16, 8), "path_tracing": (128, 64)}
    assert "samples" not in settings.changed(scene)
    group.samples = 5
    assert group.samples == 5 and settings.changed(scene)["samples"] == "5"
    group.method = "ray_tracing"
    assert group.samples == 5, "once set, for every method"
