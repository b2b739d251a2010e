// TrpMeshDesc → Mesh: bounds, formats and values are checked while the arrays are copied.
#include <algorithm>
#include <cstring>
#include <limits>

#include "scene/checks.h"
#include "scene/describe.h"

namespace trp {
namespace {

uint32_t format_size(int32_t format) {
    switch (format) {
        case TRP_FORMAT_UINT8:
            return 1;
        case TRP_FORMAT_UINT16:
            return 2;
        default:
            return 4;
    }
}

// A checked view of a TrpArray whose elements are `components` numbers.
struct View {
    View(const std::string& mesh, const char* field, const TrpArray& array, uint32_t components)
        : mesh(mesh), field(field), array(array), components(components) {
        check_enum(mesh, (std::string(field) + ".format").c_str(), array.format, TRP_FORMAT_INT32);
        const uint32_t packed = components * format_size(array.format);
        stride = array.stride ? array.stride : packed;
        if (array.count && !array.data) fail(TRP_ERROR_ARGUMENT, "{}: {}.data is null", mesh, field);
        if (stride < packed)
            fail(TRP_ERROR_ARGUMENT, "{}: {}.stride is {}, less than an element's {} bytes", mesh, field, stride,
                 packed);
        if (array.count > std::numeric_limits<uint32_t>::max())
            fail(TRP_ERROR_MEMORY, "{}: {} has {} elements; at most 2^32 - 1 can be held", mesh, field, array.count);
    }
    void expect_count(uint64_t count, const char* why) const {
        if (array.count != count)
            fail(TRP_ERROR_ARGUMENT, "{}: {} has {} elements where {} are needed ({})", mesh, field, array.count, count,
                 why);
    }
    void expect_format(int32_t format, const char* name) const {
        if (array.count && array.format != format)
            fail(TRP_ERROR_ARGUMENT, "{}: {} must be of format {}, not {}", mesh, field, name, array.format);
    }
    const unsigned char* at(size_t i) const { return static_cast<const unsigned char*>(array.data) + i * stride; }

    const std::string& mesh;
    const char* field;
    const TrpArray& array;
    uint32_t components, stride;
};

// Floats, all of them finite, to out[count · components].
void copy_floats(const View& view, float* out) {
    view.expect_format(TRP_FORMAT_FLOAT32, "FLOAT32");
    const size_t count = view.array.count, components = view.components;
    if (view.stride == components * sizeof(float)) {
        if (count) std::memcpy(out, view.array.data, count * components * sizeof(float));
    } else {
        for (size_t i = 0; i < count; ++i) std::memcpy(out + i * components, view.at(i), components * sizeof(float));
    }
    // x − x is 0 for finite x and NaN for the others; the sum is a loop without branches.
    constexpr size_t kBlock = 4096;
    for (size_t begin = 0; begin < count * components; begin += kBlock) {
        const size_t end = std::min(begin + kBlock, count * components);
        bool finite = true;
        for (size_t i = begin; i < end; ++i) finite &= std::abs(out[i]) <= std::numeric_limits<float>::max();
        if (finite) continue;
        for (size_t i = begin; i < end; ++i)
            if (!std::isfinite(out[i]))
                fail(TRP_ERROR_ARGUMENT, "{}: {}[{}] is {}", view.mesh, view.field, i / components, out[i]);
    }
}

template <class In, class Out>
void copy_indices_as(const View& view, Out* out) {
    for (size_t i = 0; i < view.array.count; ++i)
        for (uint32_t k = 0; k < view.components; ++k) {
            In value;
            std::memcpy(&value, view.at(i) + k * sizeof(In), sizeof(In));
            // A negative index, or one that the smaller type cannot hold, becomes the greatest, which no limit allows.
            const auto wide = static_cast<uint64_t>(static_cast<int64_t>(value));
            out[i * view.components + k] = static_cast<Out>(std::min<uint64_t>(wide, std::numeric_limits<Out>::max()));
        }
}

int64_t index_at(const View& view, size_t i, uint32_t k) {
    const auto read = [&]<class In>(In value) {
        std::memcpy(&value, view.at(i) + k * sizeof(In), sizeof(In));
        return static_cast<int64_t>(value);
    };
    switch (view.array.format) {
        case TRP_FORMAT_UINT8:
            return read(uint8_t{});
        case TRP_FORMAT_UINT16:
            return read(uint16_t{});
        case TRP_FORMAT_INT32:
            return read(int32_t{});
        default:
            return read(uint32_t{});
    }
}

// Indices below `limit`.
template <class Out>
std::vector<Out> copy_indices(const View& view, uint64_t limit, const char* of_what) {
    std::vector<Out> out(view.array.count * view.components);
    if (out.empty()) return out;
    switch (view.array.format) {
        case TRP_FORMAT_UINT8:
            copy_indices_as<uint8_t>(view, out.data());
            break;
        case TRP_FORMAT_UINT16:
            copy_indices_as<uint16_t>(view, out.data());
            break;
        case TRP_FORMAT_UINT32:
            copy_indices_as<uint32_t>(view, out.data());
            break;
        case TRP_FORMAT_INT32:
            copy_indices_as<int32_t>(view, out.data());
            break;
        default:
            fail(TRP_ERROR_ARGUMENT, "{}: {} must be of an integer format", view.mesh, view.field);
    }
    Out greatest = 0;
    for (const Out index : out) greatest = std::max(greatest, index);
    if (greatest >= limit) {
        const auto bad = std::find_if(out.begin(), out.end(), [&](Out index) { return index >= limit; });
        const auto at = static_cast<size_t>(bad - out.begin());
        const size_t element = at / view.components;
        fail(TRP_ERROR_ARGUMENT, "{}: {}[{}] is {}, which is out of range: there are {} {}", view.mesh, view.field,
             element, index_at(view, element, static_cast<uint32_t>(at % view.components)), limit, of_what);
    }
    return out;
}

std::vector<float> copy_unit_floats(const View& view, uint64_t count, const char* why) {
    view.expect_count(count, why);
    std::vector<float> out(count);
    copy_floats(view, out.data());
    for (float& value : out) value = std::clamp(value, 0.0f, 1.0f);
    return out;
}

std::vector<Attribute> copy_attributes(const std::string& what, const char* field, const TrpAttribute* attributes,
                                       uint32_t count, int min_components, int max_components, const Mesh& mesh) {
    if (count && !attributes) fail(TRP_ERROR_ARGUMENT, "{}: {} is null, with a count of {}", what, field, count);
    std::vector<Attribute> out(count);
    for (uint32_t i = 0; i < count; ++i) {
        const TrpAttribute& in = attributes[i];
        const std::string name = fmt::format("{}[{}]", field, i);
        check_enum(what, (name + ".domain").c_str(), in.domain, TRP_DOMAIN_CORNER);
        if (in.components < min_components || in.components > max_components)
            fail(TRP_ERROR_ARGUMENT, "{}: {}.components is {}", what, name, in.components);
        const View view(what, name.c_str(), in.values, static_cast<uint32_t>(in.components));
        if (in.domain == TRP_DOMAIN_CORNER)
            view.expect_count(mesh.corner_vertices.size(), "one to a corner");
        else
            view.expect_count(mesh.vertex_count, "one to a vertex");
        out[i].name = text_of(in.name);
        out[i].domain = in.domain;
        out[i].components = static_cast<uint32_t>(in.components);
        out[i].values.resize(in.values.count * out[i].components);
        copy_floats(view, out[i].values.data());
    }
    return out;
}

}  // namespace

uint64_t Mesh::bytes() const {
    auto size = [](const auto& v) { return v.size() * sizeof(v[0]); };
    uint64_t sum = size(positions) + size(face_offsets) + size(corner_vertices) + size(normals) + size(materials) +
                   size(face_materials) + size(face_smooth) + size(edges) + size(edge_flags) + size(edge_creases) +
                   size(vertex_creases);
    for (const auto* layers : {&uv_sets, &colors})
        for (const Attribute& layer : *layers) sum += size(layer.values);
    return sum;
}

Mesh describe(const TrpMeshDesc& desc, uint32_t id) {
    Mesh mesh;
    mesh.name = text_of(desc.name);
    const std::string what = item_name("mesh", id, mesh.name);
    check_range(what, "time_count", desc.time_count, 1, kMostTimeSamples);
    mesh.time_count = desc.time_count;

    const View positions(what, "positions", desc.positions, 3);
    if (desc.positions.count % desc.time_count)
        fail(TRP_ERROR_ARGUMENT, "{}: positions.count is {}, not a multiple of time_count {}", what,
             desc.positions.count, desc.time_count);
    mesh.vertex_count = static_cast<uint32_t>(desc.positions.count / desc.time_count);
    mesh.positions.reserve(desc.positions.count + 1);
    mesh.positions.resize(desc.positions.count);
    copy_floats(positions, &mesh.positions.data()->x);

    mesh.corner_vertices =
        copy_indices<uint32_t>(View(what, "corner_vertices", desc.corner_vertices, 1), mesh.vertex_count, "vertices");
    const uint64_t corners = mesh.corner_vertices.size();
    if (desc.face_offsets.count) {
        const View offsets(what, "face_offsets", desc.face_offsets, 1);
        mesh.face_offsets = copy_indices<uint32_t>(offsets, corners + 1, "corners");
        if (mesh.face_offsets.front() != 0 || mesh.face_offsets.back() != corners)
            fail(TRP_ERROR_ARGUMENT, "{}: face_offsets run from {} to {}, not from 0 to the {} corners", what,
                 mesh.face_offsets.front(), mesh.face_offsets.back(), corners);
        bool triangles = true;
        for (size_t f = 0; f + 1 < mesh.face_offsets.size(); ++f) {
            if (mesh.face_offsets[f] > mesh.face_offsets[f + 1])
                fail(TRP_ERROR_ARGUMENT, "{}: face_offsets[{}] is {}, less than {} before it", what, f + 1,
                     mesh.face_offsets[f + 1], mesh.face_offsets[f]);
            triangles &= mesh.face_offsets[f + 1] - mesh.face_offsets[f] == 3;
        }
        if (triangles) mesh.face_offsets = {};
    } else if (corners % 3) {
        fail(TRP_ERROR_ARGUMENT, "{}: {} corner_vertices without face_offsets are not a number of triangles", what,
             corners);
    }
    const uint64_t faces = mesh.face_count();

    if (desc.normals.count) {
        check_enum(what, "normal_domain", desc.normal_domain, TRP_DOMAIN_CORNER);
        const View normals(what, "normals", desc.normals, 3);
        if (desc.normal_domain == TRP_DOMAIN_CORNER)
            normals.expect_count(corners, "one to a corner");
        else
            normals.expect_count(mesh.vertex_count, "one to a vertex");
        mesh.normal_domain = desc.normal_domain;
        mesh.normals.resize(desc.normals.count);
        copy_floats(normals, &mesh.normals.data()->x);
    }
    mesh.uv_sets = copy_attributes(what, "uv_sets", desc.uv_sets, desc.uv_set_count, 2, 2, mesh);
    mesh.colors = copy_attributes(what, "colors", desc.colors, desc.color_count, 3, 4, mesh);

    if (desc.material_count && !desc.materials)
        fail(TRP_ERROR_ARGUMENT, "{}: materials is null, with a count of {}", what, desc.material_count);
    check_range(what, "material_count", desc.material_count, 0, 65535);
    mesh.materials.assign(desc.materials, desc.materials + desc.material_count);
    if (desc.face_materials.count) {
        const View slots(what, "face_materials", desc.face_materials, 1);
        slots.expect_count(faces, "one to a face");
        // A slot that was deleted is no error: the snapshot shows the default grey there and warns.
        mesh.face_materials = copy_indices<uint16_t>(slots, 65535, "slots at most");
        if (std::all_of(mesh.face_materials.begin(), mesh.face_materials.end(), [](uint16_t s) { return s == 0; }))
            mesh.face_materials = {};
    }
    if (desc.face_smooth.count) {
        const View smooth(what, "face_smooth", desc.face_smooth, 1);
        smooth.expect_count(faces, "one to a face");
        smooth.expect_format(TRP_FORMAT_UINT8, "UINT8");
        mesh.face_smooth = copy_indices<uint8_t>(smooth, 256, "values");
    }
    if (desc.edges.count) {
        mesh.edges = copy_indices<uint32_t>(View(what, "edges", desc.edges, 2), mesh.vertex_count, "vertices");
    }
    const uint64_t edges = desc.edges.count;
    if (desc.edge_flags.count) {
        const View flags(what, "edge_flags", desc.edge_flags, 1);
        flags.expect_count(edges, "one to an edge");
        flags.expect_format(TRP_FORMAT_UINT8, "UINT8");
        mesh.edge_flags = copy_indices<uint8_t>(flags, 256, "values");
    }
    if (desc.edge_creases.count)
        mesh.edge_creases = copy_unit_floats(View(what, "edge_creases", desc.edge_creases, 1), edges, "one to an edge");
    if (desc.vertex_creases.count)
        mesh.vertex_creases = copy_unit_floats(View(what, "vertex_creases", desc.vertex_creases, 1), mesh.vertex_count,
                                               "one to a vertex");
    return mesh;
}

}  // namespace trp
