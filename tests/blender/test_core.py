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
