# SPDX-License-Identifier: GPL-3.0-or-later
"""The ctypes side against triptych.h, and errors of the library as exceptions."""

import ctypes
import re
from pathlib import Path

import numpy as np
import pytest
from triptych import core, data

HEADER = (Path(__file__).resolve().parents[2] / "core/include/triptych/triptych.h").read_text()
STRUCTURES = {
    "TrpArray": core.Array,
    "TrpAttribute": core.Attribute,
    "TrpSceneInfo": core.SceneInfo,
    "TrpWarning": core.Warning_,
    "TrpMeshDesc": core.MeshDesc,
    "TrpInstanceDesc": core.InstanceDesc,
    "TrpTextureDesc": core.TextureDesc,
    "TrpNode": core.Node,
    "TrpNodeInfo": core.NodeInfo,
    "TrpCoefficient": core.Coefficient,
    "TrpMaterialDesc": core.MaterialDesc,
    "TrpLightDesc": core.LightDesc,
    "TrpWorldDesc": core.WorldDesc,
    "TrpCameraDesc": core.CameraDesc,
    "TrpMethodInfo": core.MethodInfo,
    "TrpSettingInfo": core.SettingInfo,
    "TrpPassInfo": core.PassInfo,
    "TrpProgress": core.Progress,
    "TrpTile": core.Tile,
    "TrpCallbacks": core.Callbacks,
    "TrpStatistics": core.Statistics,
}
_SIZES = {"uint32_t": 4, "int32_t": 4, "uint64_t": 8, "float": 4, "double": 8, "char": 1, "void": 1}


def fields(name):
    """[(name, bytes)] of a struct of the header; bytes None where the type is another struct."""
    body = re.search(rf"typedef struct {name} \{{(.*?)\n\}} {name};", HEADER, re.S).group(1)
    body = re.sub(r"/\*.*?\*/", "", body, flags=re.S).replace("TRP_NODE_INPUTS", "3")
    result = []
    for line in filter(None, (one.strip() for one in body.split(";"))):
        call = re.search(r"\(\*(\w+)\)", line)
        if call:
            result.append((call.group(1), 8))
            continue
        kind, declared = re.match(r"(?:const\s+)?(\w+)(.*)", line, re.S).groups()
        for one in declared.split(","):
            word, count = re.search(r"(\w+)(?:\[(\d+)\])?\s*$", one.strip()).groups()
            size = 8 if "*" in declared else _SIZES.get(kind)
            result.append((word, size and size * int(count or 1)))
    return result


@pytest.mark.parametrize("name", STRUCTURES)
def test_structures_are_those_of_the_header(name):
    structure = STRUCTURES[name]
    expected = fields(name)
    assert [field.rstrip("_") for field, _ in structure._fields_] == [word for word, _ in expected]
    for (word, kind), (_, size) in zip(structure._fields_, expected, strict=True):
        assert size is None or ctypes.sizeof(kind) == size, word


def test_every_function_of_the_header_that_we_call_is_there():
    declared = set(re.findall(r"\btrp_(\w+)\(", HEADER))
    assert set(core._FUNCTIONS) <= declared


def test_version():
    numbers = [int(re.search(rf"TRP_VERSION_{part} (\d+)", HEADER).group(1)) for part in ("MAJOR", "MINOR", "PATCH")]
    assert core.VERSION // 100 == numbers[0] * 100 + numbers[1]


def square(**values):
    corners = np.float32([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)])
    return data.Mesh("Square", corners, np.uint32([0, 4]), np.uint32([0, 1, 2, 3]), **values)


@pytest.mark.library
def test_errors_name_the_item():
    with core.Scene() as scene:
        with pytest.raises(core.Error, match="Square") as caught:
            scene.add_mesh(square(face_smooth=np.uint8([1, 1])), [])
        assert caught.value.status == "ARGUMENT"
        with pytest.raises(core.Error) as caught:
            core.Render(scene, "ray_casting")
        assert caught.value.status == "STATE"


@pytest.mark.library
def test_unknown_names():
    with core.Scene() as scene:
        scene.commit()
        with pytest.raises(core.Error, match="no_method"):
            core.Render(scene, "no_method")
        with core.Render(scene, core.methods()[0][0]) as render:
            with pytest.raises(core.Error, match="no_setting"):
                render.set("no_setting", "1")
            with pytest.raises(core.Error):
                render.set("samples", "many")
            with pytest.raises(core.Error, match="NoPass"):
                render.add_pass("NoPass")


@pytest.mark.library
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
