// Methods, settings, passes and node types describe themselves.
#include "api/guard.h"
#include "api/handles.h"
#include "radiosity/view.h"
#include "raster/line_drawing.h"
#include "raster/rasterizer.h"
#include "scene/nodes.h"
#include "trace/ray_tracing.h"

namespace trp {

const MethodRow kMethods[] = {
    {"wireframe", "Wireframe", "Every edge of the meshes, hidden or not", wireframe},
    {"hidden_line", "Hidden Lines",
     "The edges of the meshes without the parts that lie behind faces, whatever these are made of", hidden_line},
    {"visible_surface", "Visible Surfaces", "The nearest surface in each pixel, under ambient light alone",
     visible_surface},
    {"flat", "Flat Shading", "Light and highlight once for each polygon", flat_shading},
    {"gouraud", "Gouraud Shading", "Light and highlight at each vertex, their colours interpolated across polygons",
     gouraud_shading},
    {"phong", "Phong Shading", "Normals interpolated across polygons; light and highlight at each pixel",
     phong_shading},
    {"ray_casting", "Ray Casting",
     "One ray to a sample: the nearest surface with light, shadow and highlight, no reflections and no refraction",
     ray_casting},
    {"ray_tracing", "Ray Tracing",
     "Recursive ray tracing: mirror reflection and transparency, thin or by refraction, from every surface on",
     ray_tracing},
    {"radiosity", "Radiosity",
     "Diffuse light from surface to surface, found once for the whole scene and then seen from anywhere, without noise",
     radiosity_view},
    {"path_tracing", "Path Tracing",
     "All light, by chance: paths with diffuse, glossy and mirror reflection and transmission, without bias; slow and "
     "right",
     path_tracing},
};
const uint32_t kMethodCount = sizeof kMethods / sizeof kMethods[0];

namespace {

void check_index(uint32_t index, uint32_t count, const char* what) {
    if (index >= count) fail(TRP_ERROR_ARGUMENT, "there is no {} {}; there are {}", what, index, count);
}

}  // namespace
}  // namespace trp

using namespace trp;

extern "C" {

uint32_t trp_node_count(void) {
    return kNodeTypeCount;
}
TrpStatus trp_node_info(uint32_t index, TrpNodeInfo* info) {
    return guard([&] {
        check_index(index, kNodeTypeCount, "node type");
        const NodeType& row = kNodeTypes[index];
        write_struct(info, {0, row.type, row.name, row.description, row.inputs}, "info");
        return TRP_OK;
    });
}

uint32_t trp_method_count(void) {
    return kMethodCount;
}
TrpStatus trp_method_info(uint32_t index, TrpMethodInfo* info) {
    return guard([&] {
        check_index(index, kMethodCount, "method");
        const MethodRow& row = kMethods[index];
        write_struct(info, {0, row.name, row.label, row.description}, "info");
        return TRP_OK;
    });
}

uint32_t trp_setting_count(void) {
    return kSettingCount;
}
TrpStatus trp_setting_info(uint32_t index, TrpSettingInfo* info) {
    return guard([&] {
        check_index(index, kSettingCount, "setting");
        const SettingRow& row = kSettings[index];
        write_struct(info,
                     {0, row.type, row.name, row.label, row.description, row.unit, row.default_value, row.minimum,
                      row.maximum, row.choices, row.methods, row.method_defaults},
                     "info");
        return TRP_OK;
    });
}

uint32_t trp_pass_count(void) {
    return kPassCount;
}
TrpStatus trp_pass_info(uint32_t index, TrpPassInfo* info) {
    return guard([&] {
        check_index(index, kPassCount, "pass");
        const Pass& row = kPasses[index];
        write_struct(
            info, {0, channel_count(static_cast<PassId>(index)), row.name, row.channels, row.description, row.methods},
            "info");
        return TRP_OK;
    });
}

}  // extern "C"
