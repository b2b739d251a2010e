// The one validator: descriptors of the ABI in, plain checked data out. Every function throws Error, naming the item
// and the value, and has no other effect.
#pragma once

#include "scene/items.h"
#include "scene/mesh.h"
#include "triptych/triptych.h"

namespace trp {

Mesh describe(const TrpMeshDesc& desc);
Instance describe(const TrpInstanceDesc& desc);
Texture describe(const TrpTextureDesc& desc);
Material describe(const TrpMaterialDesc& desc);
Light describe(const TrpLightDesc& desc);
World describe(const TrpWorldDesc& desc);
Camera describe(const TrpCameraDesc& desc);

// `count` blocks of 12 floats, checked to be finite; a null pointer is the identity. `what` names the item.
std::vector<Affine> describe_transforms(const float* rows, uint32_t count, const std::string& what);

}  // namespace trp
