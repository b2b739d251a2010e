# SPDX-License-Identifier: GPL-3.0-or-later
"""Radiosity step by step: what steps do, what they refresh, and what ends them."""

import threading
import time

import bpy
import exr
import numpy as np
import pytest
import stage
from triptych import engine, generated, radiosity, radiosity_panel, radiosity_play

pytestmark = pytest.mark.library


@pytest.fixture(autouse=True)
def floor(scene):
    """A floor and a wall on it under a lamp, by progressive refinement."""
    made = corner(scene)
    stage.light(scene, "POINT", (0, 0, 1), 100, shadow_soft_size=0)
    stage.camera(scene, (0, 0, 4))
    look = bpy.context.window_manager.triptych_radiosity
    for name in look.bl_rna.properties.keys():
        if name not in {"rna_type", "name"}:
            look.property_unset(name)
    yield made
    radiosity_play.stop()
    radiosity.forget()


def corner(scene):
    """The floor of a floor and a wall of 2 m, in elements of 0.5 m."""
    group = scene.triptych
    group.method, group.radiosity_solver, group.radiosity_element_size = "radiosity", "progressive", 0.5
    made = stage.plane(scene, 2)
    wall = stage.plane(scene, 2, "Wall", location=(-1, 0, 1), rotation=(0, 90, 0))
    for one in (made, wall):
        stage.material(one, Color=(0.5, 0.5, 0.5))
    return made


def step():
    assert bpy.ops.triptych.radiosity_step() == {"FINISHED"}
    return radiosity.kept()


def look():
    return bpy.context.window_manager.triptych_radiosity


def fails(operator, match, **values):
    with pytest.raises(RuntimeError, match=match):
        operator(**values)


# ---------------------------------------------------------------------------------------------------------------- steps


def test_a_step_is_a_shot(scene):
    kept = step()
    assert kept.info.iterations == 1 and kept.info.element_count == 32
    unshot = [sum(kept.info.unshot)]
    for number in range(2, 6):
        assert step() is kept and kept.info.iterations == number
        unshot.append(sum(kept.info.unshot))
    # Each element reflects half of what it receives, and no more than a quarter of what one sends meets the other.
    assert all(0 < after < before for before, after in zip(unshot, unshot[1:], strict=False))
    look().steps = 7
    assert step().info.iterations == 12


@pytest.mark.parametrize("solver", ["matrix", "hierarchical", "progressive"])
def test_play_goes_on_until_it_is_solved(scene, solver):
    scene.triptych.radiosity_solver = solver
    step()
    kept = radiosity.kept()
    assert bpy.ops.triptych.radiosity_play() == {"FINISHED"}
    assert radiosity.kept() is kept and kept.info.solved
    played = stage.render(scene)
    assert radiosity.kept() is kept
    radiosity.forget()
    np.testing.assert_array_equal(stage.render(scene), played)


def test_play_ends_at_the_limit_of_iterations_and_a_step_goes_on(scene):
    scene.triptych.radiosity_iterations = 5
    look().steps = 3
    bpy.ops.triptych.radiosity_play()
    assert radiosity.kept().info.iterations == 5
    bpy.ops.triptych.radiosity_play()
    assert radiosity.kept().info.iterations == 5
    assert step().info.iterations == 8


def test_reset_begins_anew(scene):
    step(), step()
    assert bpy.ops.triptych.radiosity_reset() == {"FINISHED"}
    assert radiosity.kept() is None and not bpy.ops.triptych.radiosity_reset.poll()
    assert step().info.iterations == 1


def test_the_state_that_the_panel_shows(scene):
    info = step().info
    rows = dict(radiosity_panel.state(radiosity.kept()))
    assert rows["Iteration"] == "1" and rows["Elements"] == "32" and "Links" not in rows
    assert [float(word) for word in rows["Unshot"].split()[:3]] == pytest.approx(list(info.unshot), rel=1e-2)
    assert rows["Residual"] == f"{info.residual:.3g} unshot" and 0.5 < info.residual < 1
    scene.triptych.radiosity_solver, scene.triptych.radiosity_iterations = "hierarchical", 9
    info = step().info
    rows = dict(radiosity_panel.state(radiosity.kept()))
    assert rows["Iteration"] == "1 of 9" and rows["Links"] == f"{info.links:,}" and info.links > 0
    assert rows["Residual"].startswith(f"{info.residual:.3g} W/m²") and "Unshot" not in rows


def test_what_ends_before_its_tolerance_is_not_called_solved(scene):
    scene.triptych.radiosity_solver, scene.triptych.radiosity_tolerance = "hierarchical", 1e-6
    bpy.ops.triptych.radiosity_play()
    rows = dict(radiosity_panel.state(radiosity.kept()))
    assert radiosity.kept().info.solved and rows["Iteration"].endswith(", ended at its limit")


def test_powers_in_plain_digits():
    assert radiosity_panel._watts((12345, 0.98765, 0.0012)) == "12,300  0.988  0.0012 W"
    assert radiosity_panel._watts((100, 0, 1e-9)) == "100  0  0 W"


def test_a_walk_of_the_camera_and_views_stand(scene):
    kept = step()
    scene.camera.location.x = 1
    scene.triptych.radiosity_view = "unshot"
    assert step() is kept and kept.info.iterations == 2


def test_what_the_scene_changes_begins_anew(scene, floor):
    step(), step()
    floor.location.z = -0.5
    assert step().info.iterations == 1
    step()
    scene.triptych.radiosity_rays = 100
    assert step().info.iterations == 1


def test_each_step_refreshes_the_mesh(scene):
    step()
    made = generated.find(scene, generated.MESH)
    for _ in range(2):
        before = colors(made.data)
        step()
        assert generated.find(scene, generated.MESH) == made and not np.array_equal(colors(made.data), before)
    look().mesh = False
    before = colors(made.data)
    step()
    np.testing.assert_array_equal(colors(made.data), before)


def colors(mesh):
    values = np.empty(4 * len(mesh.loops), np.float32)
    mesh.attributes["shown"].data.foreach_get("color", values)
    return values


def shown_picture(path):
    bpy.data.images["Render Result"].save_render(path)
    return exr.image(exr.read(path))


def test_the_picture_is_refreshed_and_not_solved_further(scene, tmp_path):
    whole = stage.render(scene)  # which sets the file format, too
    radiosity.forget()
    look().picture = True
    scene.render.use_compositing = True
    path = str(tmp_path / "picture.exr")
    errors = []
    for number in (1, 2, 20):
        look().steps = number - (radiosity.kept().info.iterations if radiosity.kept() else 0)
        assert step().info.iterations == number
        errors.append(np.abs(shown_picture(path) - whole).mean())
    assert errors[0] > errors[1] > errors[2] > 0
    assert scene.render.use_compositing


def test_without_a_camera_the_mesh_alone(scene):
    scene.camera = None
    assert step().info.iterations == 1 and generated.find(scene, generated.MESH)
    look().picture = True
    fails(bpy.ops.triptych.radiosity_step, "there is no camera to render the picture from")
    assert radiosity.kept().info.iterations == 2


# -------------------------------------------------------------------------------------------------------------- renders


def test_a_render_goes_on_from_the_steps(scene):
    kept = step()
    picture = stage.render(scene)
    assert radiosity.kept() is kept and kept.info.solved
    radiosity.forget()
    np.testing.assert_array_equal(stage.render(scene), picture)


def test_play_shows_what_a_render_has_solved(scene):
    stage.render(scene)
    iterations = radiosity.kept().info.iterations
    for operator in (bpy.ops.triptych.radiosity_play, bpy.ops.triptych.radiosity_step):
        assert operator() == {"FINISHED"} and radiosity.kept().info.iterations == iterations
        made = generated.find(scene, generated.MESH)
        assert len(made.data.polygons) == 32
        generated.remove(scene, generated.MESH)


@pytest.fixture
def cancelled_at(monkeypatch):
    """Has renders cancelled, as by Esc, at the third call of a stage."""

    def cancel(stage):
        told = []
        monkeypatch.setattr(engine._Job, "stopped", lambda job: told.count(stage) >= 3)

        def progress(job, state, as_it_was=engine._Job._progress):
            told.append(state.stage)
            return as_it_was(job, state)

        monkeypatch.setattr(engine._Job, "_progress", progress)
        return told

    yield cancel
    monkeypatch.undo()


def test_a_cancelled_render_keeps_what_it_found(scene, cancelled_at, monkeypatch):
    scene.triptych.radiosity_element_size, scene.triptych.radiosity_tolerance = 0.03, 1e-9
    told = cancelled_at(b"Solving")
    picture = stage.render(scene)
    kept = radiosity.kept()
    assert told.count(b"Solving") == 3 and not kept.info.solved and kept.info.iterations > 0
    assert stage.status() == "" and picture[24, 32, 0] > 0
    before = kept.info.iterations
    monkeypatch.undo()
    step()
    assert radiosity.kept() is kept and kept.info.iterations == before + 1


def test_a_render_that_is_cancelled_before_there_are_elements(scene, cancelled_at):
    scene.triptych.radiosity_element_size = 0.004
    told = cancelled_at(b"Preparing")
    picture = stage.render(scene)
    assert told == [b"Preparing"] * 3 and stage.status() == "" and radiosity.kept() is None
    assert not picture.any()


def test_a_solution_that_is_taken_away_from_a_render(scene):
    """As another file does where it is loaded while a render solves on its thread."""
    scene.triptych.radiosity_element_size, scene.triptych.radiosity_tolerance = 0.02, 1e-9
    assert radiosity.at_hand(scene) == []
    kept, told = radiosity.kept(), []
    thread = threading.Thread(target=lambda: told.append(kept.run(kept.solution.solve, progress=lambda _: True)))
    thread.start()
    time.sleep(0.2)
    assert thread.is_alive()
    radiosity.forget()
    thread.join(10)
    assert told == [False] and radiosity.kept() is None
    assert kept.run(kept.solution.solve) is False and kept.news() == []


# ----------------------------------------------------------------------------------------------------------------- play


@pytest.fixture
def play(scene):
    """Ticks of a player that has begun, with room for many steps."""
    scene.triptych.radiosity_tolerance = 1e-6
    radiosity_play.begin(bpy.context, None)
    player = radiosity_play._player

    def tick():
        for _ in range(1000):
            if not player.tick(bpy.context):
                return False
            kept = radiosity.kept()
            if kept.info is not None and kept.info.iterations > tick.seen:
                tick.seen = kept.info.iterations
                return True
            time.sleep(0.002)
        raise AssertionError("no step was done")

    tick.seen, tick.player = 0, player
    return tick


def test_play_steps_at_ticks(scene, play):
    assert play() and play() and play()
    assert radiosity_play.is_playing()
    assert bpy.ops.triptych.radiosity_play() == {"CANCELLED"}  # pauses
    assert not play() and not play.player.message


def test_while_a_step_runs_others_wait(scene, play, capfd):
    """Their buttons are not grey, which they would stay under the mouse."""
    assert play()
    for name in ("step", "mesh", "form_factors"):
        operator = getattr(bpy.ops.triptych, f"radiosity_{name}")
        assert operator.poll() and operator() == {"CANCELLED"}
    assert capfd.readouterr().out.count("A step is running") == 3
    assert play() and not play.player.message


def test_play_ends_where_the_scene_changes(scene, play, floor):
    assert play()
    floor.location.z = -0.5
    bpy.context.view_layer.update()
    while play():
        pass
    assert "'Scene' has changed" in play.player.message and not play.player.failed
    assert radiosity.kept().outdated
    radiosity_play.stop()
    assert step().info.iterations == 1 and not radiosity.kept().outdated


def test_a_change_during_the_last_step_is_told(scene, floor, tmp_path):
    look().picture = True
    stage.render(scene)
    radiosity.forget()
    radiosity_play.begin(bpy.context, 1)
    player = radiosity_play._player
    assert player.tick(bpy.context)
    floor.location.z = -0.5
    radiosity.kept().wait()
    assert not player.tick(bpy.context)
    assert "'Scene' has changed" in player.message and not player.failed
    assert shown_picture(str(tmp_path / "picture.exr")).any(), "as it was"


def test_a_step_that_is_ended_before_there_are_elements(scene):
    scene.triptych.radiosity_element_size = 0.004
    radiosity_play.begin(bpy.context, 1)
    player = radiosity_play._player
    assert player.tick(bpy.context)
    radiosity_play.stop()
    player.break_off(bpy.context)
    assert not player.failed and not player.shown and radiosity.kept().info.element_count == 0
    assert radiosity_play._told(radiosity.kept().info) == "Radiosity: ended before there were elements"


def test_play_goes_on_where_the_camera_walks(scene, play):
    assert play()
    scene.camera.location.x = 1
    bpy.context.view_layer.update()
    assert radiosity.kept().suspect
    assert play() and play() and not play.player.message


def test_play_ends_where_the_method_is_another(scene, play):
    assert play()
    scene.triptych.method = "flat"
    assert not play() and "no longer rendered by radiosity" in play.player.message


def test_play_ends_where_the_scene_is_gone(scene, play):
    assert play()
    bpy.data.scenes.new("Other")
    bpy.data.scenes.remove(scene)
    bpy.context.view_layer.update()
    assert not play() and "'Scene' is gone" in play.player.message
    assert radiosity.kept() is None


def test_play_ends_where_the_solution_is_given_back(scene, play):
    assert play()
    radiosity.forget()
    assert not play() and "given back" in play.player.message


def test_a_render_takes_over_from_play(scene, play):
    assert play()
    scene.triptych.radiosity_iterations = 0
    stage.render(scene)
    assert stage.status() == "" and radiosity.kept().info.solved
    while play():
        pass
    assert not play.player.message


def test_another_file_ends_play(scene, play, tmp_path):
    assert play()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert not radiosity_play.is_playing() and radiosity.kept() is None


def test_unregister_ends_play(addon, scene, play):
    assert play()
    addon.unregister()
    try:
        assert not radiosity_play.is_playing() and radiosity.kept() is None
        assert not hasattr(bpy.types.WindowManager, "triptych_radiosity")
        assert not hasattr(bpy.types, "TRIPTYCH_RENDER_PT_radiosity_solution")
    finally:
        addon.register()


def test_undo_while_playing(scene, play):
    bpy.ops.ed.undo_push(message="Before")
    assert play()
    bpy.ops.ed.undo_push(message="After")
    bpy.ops.ed.undo()
    assert generated.find(bpy.context.scene, generated.MESH) is None
    while play() and not generated.find(bpy.context.scene, generated.MESH):
        pass
    assert generated.find(bpy.context.scene, generated.MESH) or play.player.message


def test_a_step_is_an_undo_step(scene, floor):
    bpy.ops.ed.undo_push(message="Before")
    floor.location.x = 0.25
    bpy.ops.ed.undo_push(message="The user's own")
    for _ in range(2):
        bpy.ops.triptych.radiosity_step("EXEC_DEFAULT", True)
    bpy.ops.ed.undo()
    scene = bpy.context.scene
    assert generated.find(scene, generated.MESH).data["iteration"] == 1
    assert radiosity_panel.hints(scene, look()) == ["The mesh is of iteration 1"]
    bpy.ops.ed.undo()
    scene = bpy.context.scene
    assert generated.find(scene, generated.MESH) is None and scene.objects["Plane"].location.x == 0.25
    assert step().info.iterations == 3 and radiosity_panel.hints(scene, look()) == []


# --------------------------------------------------------------------------------------------------------------- errors


def test_another_method_has_no_steps(scene):
    scene.triptych.method = "flat"
    for name in ("step", "play", "mesh", "form_factors"):
        assert not getattr(bpy.ops.triptych, f"radiosity_{name}").poll()
    scene.triptych.method = "radiosity"
    scene.render.engine = "BLENDER_WORKBENCH"
    assert not bpy.ops.triptych.radiosity_step.poll()


def test_a_scene_without_surfaces(scene, floor, capfd):
    for made in list(scene.objects):
        if made.type == "MESH":
            bpy.data.objects.remove(made)
    assert step().info.element_count == 0
    assert "no surface to be lit" in capfd.readouterr().out
    assert len(generated.find(scene, generated.MESH).data.polygons) == 0
    assert bpy.ops.triptych.radiosity_play() == {"FINISHED"}
    fails(bpy.ops.triptych.radiosity_form_factors, "no active face")


def test_a_matrix_that_is_too_large(scene):
    scene.triptych.radiosity_solver, scene.triptych.radiosity_element_size = "matrix", 0.02
    scene.triptych.radiosity_memory = 1
    fails(bpy.ops.triptych.radiosity_step, "(?s)(MiB|memory)")
    assert not radiosity_play.is_playing()
    scene.triptych.radiosity_element_size = 0.5
    assert step().info.iterations == 1


def test_without_the_library(scene, monkeypatch):
    from triptych import abi

    monkeypatch.setenv("TRIPTYCH_LIBRARY", "/nowhere/libtriptych.so")
    monkeypatch.setattr(abi, "_library", None)
    fails(bpy.ops.triptych.radiosity_step, "/nowhere/libtriptych.so")
