# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes and renders of the library: what goes in and comes out, and its errors as exceptions."""

import numpy as np
import pytest
from triptych import abi, core, data

pytestmark = pytest.mark.library


def square(**values):
    corners = np.float32([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)])
    return data.Mesh("Square", corners, np.uint32([0, 4]), np.uint32([0, 1, 2, 3]), **values)


def test_errors_name_the_item():
    with core.Scene() as scene:
        with pytest.raises(abi.Error, match="Square") as caught:
            scene.add_mesh(square(face_smooth=np.uint8([1, 1])), [])
        assert caught.value.status == "ARGUMENT"
        with pytest.raises(abi.Error) as caught:
            core.Render(scene, "ray_casting")
        assert caught.value.status == "STATE"


def test_unknown_names():
    with core.Scene() as scene:
        scene.commit()
        with pytest.raises(abi.Error, match="no_method"):
            core.Render(scene, "no_method")
        with core.Render(scene, core.methods()[0][0]) as render:
            with pytest.raises(abi.Error, match="no_setting"):
                render.set("no_setting", "1")
            with pytest.raises(abi.Error):
                render.set("samples", "many")
            with pytest.raises(abi.Error, match="NoPass"):
                render.add_pass("NoPass")


def test_render_read_and_write(tmp_path):
    source = data.Scene(meshes=[square()], instances=[data.Instance("Square", 0, data.IDENTITY)])
    source.materials.append(data.Material("Glow", emission=data.Coefficient((1.0, 2.0, 3.0))))
    source.meshes[0].materials = [0]
    above = data.IDENTITY.copy()
    above[2, 3] = 2
    source.cameras.append(data.Camera("Camera", "orthographic", above, width=1))
    source.camera = 0
    progress, tiles = [], []
    with core.Scene() as scene:
        scene.fill(source)
        scene.commit(1)
        assert scene.info().face_count == 1 and scene.warnings() == []
        with core.Render(scene, "ray_casting") as render:
            render.set_film(32, 16)
            render.set("samples", "1")
            done = render.run(
                lambda one: progress.append(one.fraction) or True, lambda one: tiles.append(one.x) or True
            )
            assert done and progress and tiles
            assert render.read("Combined", 4, 4, 2, 3).reshape(-1, 4) == pytest.approx(np.float32([[1, 2, 3, 1]] * 6))
            assert render.statistics().primary_rays > 0
            render.write(str(tmp_path / "out.exr"))
            assert render.run(lambda one: False) is False
            with pytest.raises(ZeroDivisionError):
                render.run(lambda one: 1 / 0)
    assert (tmp_path / "out.exr").stat().st_size > 0


def test_radiosity_of_a_cube():
    """A furnace, B = E / (1 - ρ) everywhere, and the form factors of opposite and adjacent faces."""
    corners = np.float32([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)])
    faces = np.uint32([(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])  # inwards
    cube = data.Mesh("Cube", corners, np.arange(0, 28, 4, dtype=np.uint32), faces.ravel(), materials=[0])
    source = data.Scene(meshes=[cube], instances=[data.Instance("Cube", 0, data.IDENTITY)])
    gray = {"diffuse": data.Coefficient((0.5, 0.5, 0.5)), "emission": data.Coefficient((1.0, 2.0, 3.0))}
    source.materials.append(data.Material("Glow", **gray))
    with core.Scene() as scene:
        scene.fill(source)
        scene.commit(1)
        solution = core.Radiosity(scene)
        assert solution.info().element_count == 0
        solution.set("radiosity.solver", "matrix")
        assert solution.prepare() and solution.info().element_count == 6 and solution.info().iterations == 0
        assert solution.step(1) and solution.info().iterations == 1
        assert solution.solve() and solution.info().solved
    expected = np.pi * np.float32([1, 2, 3]) / (1 - 0.5)
    for name, count in (("radiosity", 6), ("vertex_radiosity", 24)):
        assert solution.read(name) == pytest.approx(np.tile(expected, (count, 1)), rel=2e-3), name
    assert solution.read("vertex_irradiance") == pytest.approx(np.tile(expected, (24, 1)), rel=2e-3)
    assert solution.read("area") == pytest.approx(np.ones(6), rel=1e-6)
    offsets, vertices = solution.polygons()
    assert list(offsets) == list(range(0, 28, 4)) and sorted(vertices) == list(range(24))
    row = solution.form_factors(0)
    assert row == pytest.approx([0, 0.1998249, 0.2000438, 0.2000438, 0.2000438, 0.2000438], abs=1e-6)
    assert len(solution.links()) == 0 and solution.warnings() == []
    with pytest.raises(abi.Error, match="no values"):
        solution.read("nothing")
    solution.close()
