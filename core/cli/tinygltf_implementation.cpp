// tinygltf's one compiled copy, without its image decoder: pictures go to the core as they are.
// SPDX-License-Identifier: Apache-2.0
#define TINYGLTF_IMPLEMENTATION
#include "tinygltf_model.h"
