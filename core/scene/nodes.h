// The table of node types: one row to a type, from which descriptions, checks and programs are made.
#pragma once

#include <cstdint>

#include "triptych/triptych.h"

namespace trp {

struct NodeType {
    int32_t type;
    const char* name;
    const char* description;
    uint32_t inputs;
};

extern const NodeType kNodeTypes[];
extern const uint32_t kNodeTypeCount;

}  // namespace trp
