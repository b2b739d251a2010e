// The one validator: descriptors of the ABI in, plain checked data out. Every function throws Error, naming the item
// and the value, and has no other effect. `id` is for messages: 0 while the item has none.
#pragma once

#include "scene/items.h"
#include "scene/mesh.h"
#include "triptych/triptych.h"

namespace trp {

Mesh describe(const TrpMeshDesc& desc, uint32_t id);
Instance describe(const TrpInstanceDesc& desc, uint32_t id);
Texture describe(const TrpTextureDesc& desc, uint32_t id);
Material describe(const TrpMaterialDesc& desc, uint32_t id);
Light describe(const TrpLightDesc& desc, uint32_t id);
World describe(const TrpWorldDesc& desc);
Camera describe(const TrpCameraDesc& desc, uint32_t id);

// `count` blocks of 12 floats, checked to be finite; a null pointer is the identity. `what` names the item.
std::vector<Affine> describe_transforms(const float* rows, uint32_t count, const std::string& what);

}  // namespace trp
