# SPDX-License-Identifier: GPL-3.0-or-later
"""The ctypes side against triptych.h. Needs no library."""

import ctypes
import re
from pathlib import Path

import pytest
from triptych import abi

HEADER = (Path(__file__).resolve().parents[2] / "core/include/triptych/triptych.h").read_text()
STRUCTURES = {
    "TrpArray": abi.Array,
    "TrpAttribute": abi.Attribute,
    "TrpSceneInfo": abi.SceneInfo,
    "TrpWarning": abi.Warning_,
    "TrpMeshDesc": abi.MeshDesc,
    "TrpInstanceDesc": abi.InstanceDesc,
    "TrpTextureDesc": abi.TextureDesc,
    "TrpNode": abi.Node,
    "TrpNodeInfo": abi.NodeInfo,
    "TrpCoefficient": abi.Coefficient,
    "TrpMaterialDesc": abi.MaterialDesc,
    "TrpLightDesc": abi.LightDesc,
    "TrpWorldDesc": abi.WorldDesc,
    "TrpCameraDesc": abi.CameraDesc,
    "TrpMethodInfo": abi.MethodInfo,
    "TrpSettingInfo": abi.SettingInfo,
    "TrpPassInfo": abi.PassInfo,
    "TrpProgress": abi.Progress,
    "TrpTile": abi.Tile,
    "TrpCallbacks": abi.Callbacks,
    "TrpRay": abi.Ray,
    "TrpStatistics": abi.Statistics,
    "TrpRadiosityInfo": abi.RadiosityInfo,
    "TrpRadiosityLink": abi.RadiosityLink,
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
    assert set(abi.FUNCTIONS) <= declared


def test_version():
    numbers = [int(re.search(rf"TRP_VERSION_{part} (\d+)", HEADER).group(1)) for part in ("MAJOR", "MINOR", "PATCH")]
    assert abi.VERSION // 100 == numbers[0] * 100 + numbers[1]
