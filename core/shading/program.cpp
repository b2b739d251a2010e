#include "shading/program.h"

#include <algorithm>
#include <cmath>

#include "scene/nodes.h"
#include "shading/snapshot.h"

namespace trp {
namespace {

using Register = ProgramScratch::Register;
using Instruction = CompiledMaterial::Instruction;

bool reads_surface(int32_t type) {
    return type == TRP_NODE_UV || type == TRP_NODE_COLOR || type == TRP_NODE_OBJECT_COLOR || type == TRP_NODE_IMAGE ||
           type == TRP_NODE_NORMAL_MAP;
}

// --------------------------------------------------------------------------------------------- arithmetic of numbers

// out[c][j] = f(a, b, c) for each channel and lane; an input of none is the instruction's own value.
template <class F>
void arithmetic(const Instruction& in, const Register* registers, int count, Register& out, F&& f) {
    for (int c = 0; c < 4; ++c) {
        const float* source[TRP_NODE_INPUTS];
        Lanes constants[TRP_NODE_INPUTS];
        for (int k = 0; k < TRP_NODE_INPUTS; ++k) {
            if (in.inputs[k] == TRP_NO_NODE) std::fill_n(constants[k], count, in.values[k][c]);
            source[k] = in.inputs[k] == TRP_NO_NODE ? constants[k] : registers[in.inputs[k]].value[c];
        }
        for (int j = 0; j < count; ++j) out.value[c][j] = f(source[0][j], source[1][j], source[2][j]);
    }
}

// Nodes that need nothing but numbers.
void run_arithmetic(const Instruction& in, const Register* registers, int count, Register& out) {
    auto each = [&](auto&& f) { arithmetic(in, registers, count, out, f); };
    switch (in.type) {
        case TRP_NODE_CONSTANT:
            each([](float a, float, float) { return a; });
            break;
        case TRP_NODE_CHANNEL: {
            const int channel = static_cast<int>(in.values[0][0]);
            for (int c = 0; c < 3; ++c) std::copy_n(registers[in.inputs[0]].value[channel], count, out.value[c]);
            std::fill_n(out.value[3], count, 1.0f);
            break;
        }
        case TRP_NODE_ADD:
            each([](float a, float b, float) { return a + b; });
            break;
        case TRP_NODE_SUBTRACT:
            each([](float a, float b, float) { return a - b; });
            break;
        case TRP_NODE_MULTIPLY:
            each([](float a, float b, float) { return a * b; });
            break;
        case TRP_NODE_DIVIDE:
            each([](float a, float b, float) { return b != 0 ? a / b : 0; });
            break;
        case TRP_NODE_POWER:
            each([](float a, float b, float) { return std::pow(std::max(a, 0.0f), b); });
            break;
        case TRP_NODE_MIX:
            each([](float a, float b, float t) { return a + (b - a) * t; });
            break;
        case TRP_NODE_CLAMP:
            each([](float a, float, float) { return std::clamp(a, 0.0f, 1.0f); });
            break;
        case TRP_NODE_GREATER:
            each([](float a, float b, float) { return a > b ? 1.0f : 0.0f; });
            break;
        case TRP_NODE_UV_TRANSFORM: {
            // KHR_texture_transform: uv' = T · R · S · uv
            const float cosine = std::cos(in.values[1][0]), sine = std::sin(in.values[1][0]);
            const auto [scale_u, scale_v, offset_u, offset_v] = in.values[0];
            auto turn = [&, su = scale_u, sv = scale_v](const float* u, const float* v, float* u2, float* v2, float ou,
                                                        float ov) {
                for (int j = 0; j < count; ++j) {
                    const float a = u[j] * su, b = v[j] * sv;
                    u2[j] = cosine * a - sine * b + ou;
                    v2[j] = sine * a + cosine * b + ov;
                }
            };
            const Register& uv = registers[in.inputs[0]];
            turn(uv.value[0], uv.value[1], out.value[0], out.value[1], offset_u, offset_v);
            turn(uv.ddx[0], uv.ddx[1], out.ddx[0], out.ddx[1], 0, 0);
            turn(uv.ddy[0], uv.ddy[1], out.ddy[0], out.ddy[1], 0, 0);
            for (int c = 2; c < 4; ++c) std::fill_n(out.value[c], count, 0.0f);
            break;
        }
        default:
            break;
    }
}

// ------------------------------------------------------------------------------------------------ layers of a surface

const float* layer_value(const Attribute& layer, const PlacedSurface& surface, uint32_t triangle, int k) {
    const uint32_t element = layer.domain == TRP_DOMAIN_CORNER
                                 ? surface.corner(triangle, k)
                                 : surface.vertices[3 * static_cast<size_t>(triangle) + k];
    return &layer.values[static_cast<size_t>(element) * layer.components];
}

void run_color(const Snapshot& snapshot, const Instruction& in, const Points& points, const int32_t* lanes, int count,
               Register& out) {
    for (int j = 0; j < count; ++j) {
        const int lane = lanes[j];
        const PlacedSurface& surface = snapshot.surfaces[points.slot[lane]];
        const Attribute* layer = find_layer(surface.mesh->colors, in.name);
        const float b1 = points.b1[lane], b2 = points.b2[lane], b0 = 1 - b1 - b2;
        for (uint32_t c = 0; c < 4; ++c) {
            out.value[c][j] = 1;
            if (layer && c < layer->components)
                out.value[c][j] = layer_value(*layer, surface, points.triangle[lane], 0)[c] * b0 +
                                  layer_value(*layer, surface, points.triangle[lane], 1)[c] * b1 +
                                  layer_value(*layer, surface, points.triangle[lane], 2)[c] * b2;
        }
    }
}

// A tangent-space normal to world space, on the viewer's side. The tangent frame is that of the triangle's own
// parametrization, made orthogonal to the shading normal, so that mirrored and skewed maps come out right.
void run_normal_map(const Snapshot& snapshot, const Instruction& in, const Points& points, const int32_t* lanes,
                    int count, const Register& map, Register& out) {
    for (int j = 0; j < count; ++j) {
        const int lane = lanes[j];
        const PlacedSurface& surface = snapshot.surfaces[points.slot[lane]];
        const Attribute* layer = find_layer(surface.mesh->uv_sets, in.name);
        const Vec3 seen = points.normal.get(lane);
        const float side = points.behind[lane] ? -1.0f : 1.0f;
        const Vec3 n = seen * side;
        Vec3 result = n;
        if (layer) {
            // ∂p/∂u and ∂p/∂v, up to a factor: the inverse of the 2 × 2 matrix of the edges in texture coordinates.
            const uint32_t triangle = points.triangle[lane];
            const float *t0 = layer_value(*layer, surface, triangle, 0),
                        *t1 = layer_value(*layer, surface, triangle, 1),
                        *t2 = layer_value(*layer, surface, triangle, 2);
            const Vec2 d1(t1[0] - t0[0], t1[1] - t0[1]), d2(t2[0] - t0[0], t2[1] - t0[1]);
            const float determinant = d1.x * d2.y - d1.y * d2.x;
            const float turn = determinant < 0 ? -1.0f : determinant > 0 ? 1.0f : 0.0f;
            const Vec3 e1 = points.edge1.get(lane), e2 = points.edge2.get(lane);
            const Vec3 along_u = (e1 * d2.y - e2 * d1.y) * turn, along_v = (e2 * d1.x - e1 * d2.x) * turn;
            Vec3 t = along_u - n * n.dot(along_u);
            const float length = t.length();
            if (length > 0) {
                t /= length;
                Vec3 b = n.cross(t);
                if (b.dot(along_v) < 0) b = -b;
                const float x = 2 * map.value[0][j] - 1, y = 2 * map.value[1][j] - 1, z = 2 * map.value[2][j] - 1;
                const Vec3 mapped = (t * x + b * y + n * z).normalized();
                const Vec3 mixed = n + (mapped - n) * std::max(in.values[0][0], 0.0f);
                if (mixed.length2() > 0) result = mixed.normalized();
            }
        }
        result *= side;
        for (int c = 0; c < 3; ++c) out.value[c][j] = result[c];
        out.value[3][j] = 1;
    }
}

void run_image(const Instruction& in, const Register* registers, int count, Register& out) {
    const Register& uv = registers[in.inputs[0]];
    float* const rgba[4] = {out.value[0], out.value[1], out.value[2], out.value[3]};
    sample_or_magenta(in.texture.get(), count, {uv.value[0], uv.value[1], uv.ddx[0], uv.ddx[1], uv.ddy[0], uv.ddy[1]},
                      rgba);
}

void clear_derivatives(Register& r, int count) {
    for (int k = 0; k < 2; ++k) {
        std::fill_n(r.ddx[k], count, 0.0f);
        std::fill_n(r.ddy[k], count, 0.0f);
    }
}

float* coefficient_row(Coefficients& c, int row) {
    struct Entry {
        int row;
        LaneVec3* value;
    };
    for (const Entry& e :
         {Entry{kEmission, &c.emission}, Entry{kAmbient, &c.ambient}, Entry{kDiffuse, &c.diffuse},
          Entry{kSpecular, &c.specular}, Entry{kMirror, &c.mirror}, Entry{kTransmission, &c.transmission}})
        if (row >= e.row && row < e.row + 3) return (*e.value)[row - e.row];
    return row == kShininess ? c.shininess : row == kAlpha ? c.alpha : c.ior;
}

}  // namespace

Vec2 first_uv(const PlacedSurface& surface, const Points& points, int lane) {
    const Attribute* layer = find_layer(surface.mesh->uv_sets, "");
    if (!layer) return {0, 0};
    const float b1 = points.b1[lane], b2 = points.b2[lane], b0 = 1 - b1 - b2;
    Vec2 uv;
    for (int c = 0; c < 2; ++c)
        uv[c] = layer_value(*layer, surface, points.triangle[lane], 0)[c] * b0 +
                layer_value(*layer, surface, points.triangle[lane], 1)[c] * b1 +
                layer_value(*layer, surface, points.triangle[lane], 2)[c] * b2;
    return uv;
}

bool CompiledMaterial::needs_footprint() const {
    return std::any_of(instructions.begin(), instructions.end(),
                       [](const Instruction& i) { return i.type == TRP_NODE_IMAGE; });
}

CompiledMaterial compile(const Material& material, const TextureSet& textures) {
    CompiledMaterial out;
    out.name = material.name;
    out.index = material.index;
    out.thin = material.thin;
    out.double_sided = material.double_sided;
    out.fresnel = material.fresnel;
    out.priority = material.priority;
    out.absorption = material.absorption;

    // Fold: node i is either a constant or an instruction.
    const size_t count = material.nodes.size();
    std::vector<bool> folded(count, false);
    std::vector<std::array<float, 4>> constants(count);
    std::vector<Instruction> instructions;
    std::vector<int32_t> place(count, TRP_NO_NODE);  // of node i among the instructions
    ProgramScratch scratch;
    for (size_t i = 0; i < count; ++i) {
        const Node& node = material.nodes[i];
        Instruction in;
        in.type = node.type;
        in.values = node.values;
        in.name = node.name;
        bool constant = !reads_surface(node.type);
        for (uint32_t k = 0; k < TRP_NODE_INPUTS; ++k) {
            in.inputs[k] = TRP_NO_NODE;
            if (node.inputs[k] == TRP_NO_NODE) continue;
            const bool needs_register = node.type == TRP_NODE_CHANNEL || node.type == TRP_NODE_UV_TRANSFORM ||
                                        node.type == TRP_NODE_NORMAL_MAP || node.type == TRP_NODE_IMAGE;
            if (folded[node.inputs[k]] && !needs_register) {
                in.values[k] = constants[node.inputs[k]];
            } else if (folded[node.inputs[k]]) {
                Instruction value;
                value.type = TRP_NODE_CONSTANT;
                value.inputs = {TRP_NO_NODE, TRP_NO_NODE, TRP_NO_NODE};
                value.values[0] = constants[node.inputs[k]];
                in.inputs[k] = static_cast<int32_t>(instructions.size());
                instructions.push_back(value);
                constant &= node.type == TRP_NODE_CHANNEL;
            } else {
                in.inputs[k] = place[node.inputs[k]];
                constant = false;
            }
        }
        const bool without_input = in.inputs[0] == TRP_NO_NODE;
        if (node.type == TRP_NODE_IMAGE || node.type == TRP_NODE_UV_TRANSFORM) {
            if (without_input) {  // the first UV set
                Instruction uv;
                uv.type = TRP_NODE_UV;
                uv.inputs = {TRP_NO_NODE, TRP_NO_NODE, TRP_NO_NODE};
                in.inputs[0] = static_cast<int32_t>(instructions.size());
                instructions.push_back(uv);
            }
            constant = false;
        }
        if (node.type == TRP_NODE_IMAGE) {
            const auto it = textures.find(node.texture);
            in.texture = it == textures.end() ? nullptr : it->second;
        }
        if (node.type == TRP_NODE_NORMAL_MAP && without_input) continue;  // no map: the surface's own normal
        if (constant && node.type == TRP_NODE_CHANNEL && without_input) {
            folded[i] = true;
            constants[i] = {0, 0, 0, 1};
        } else if (constant) {
            Register* registers = scratch.registers(instructions.size() + 1);
            for (size_t r = 0; r < instructions.size(); ++r)
                if (instructions[r].type == TRP_NODE_CONSTANT)
                    run_arithmetic(instructions[r], registers, 1, registers[r]);
            Register& result = registers[instructions.size()];
            run_arithmetic(in, registers, 1, result);
            folded[i] = true;
            for (int c = 0; c < 4; ++c) constants[i][c] = result.value[c][0];
        } else {
            place[i] = static_cast<int32_t>(instructions.size());
            instructions.push_back(in);
        }
    }

    auto output = [&](const Coefficient& coefficient, int row, int channels) {
        for (int c = 0; c < channels; ++c) {
            float value = coefficient.value[c];
            if (coefficient.node != TRP_NO_NODE && folded[coefficient.node]) value *= constants[coefficient.node][c];
            out.constants[row + c] = value;
        }
        const bool zero =
            std::all_of(&out.constants[row], &out.constants[row] + channels, [](float v) { return v == 0; });
        if (coefficient.node != TRP_NO_NODE && place[coefficient.node] != TRP_NO_NODE && !zero)
            out.outputs.push_back({row, channels, place[coefficient.node]});
    };
    output(material.emission, kEmission, 3);
    output(material.ambient, kAmbient, 3);
    output(material.diffuse, kDiffuse, 3);
    output(material.specular, kSpecular, 3);
    output(material.shininess, kShininess, 1);
    output(material.alpha, kAlpha, 1);
    output(material.mirror, kMirror, 3);
    output(material.transmission, kTransmission, 3);
    output(material.ior, kIor, 1);
    out.normal = material.normal == TRP_NO_NODE ? TRP_NO_NODE : place[material.normal];

    // Keep what the outputs read.
    std::vector<bool> live(instructions.size(), false);
    for (const auto& o : out.outputs) live[o.node] = true;
    if (out.normal != TRP_NO_NODE) live[out.normal] = true;
    for (size_t i = instructions.size(); i-- > 0;)
        for (const int32_t input : instructions[i].inputs)
            if (live[i] && input != TRP_NO_NODE) live[input] = true;
    std::vector<int32_t> kept(instructions.size(), TRP_NO_NODE);
    for (size_t i = 0; i < instructions.size(); ++i) {
        if (!live[i]) continue;
        kept[i] = static_cast<int32_t>(out.instructions.size());
        for (int32_t& input : instructions[i].inputs)
            if (input != TRP_NO_NODE) input = kept[input];
        out.instructions.push_back(std::move(instructions[i]));
    }
    for (auto& o : out.outputs) o.node = kept[o.node];
    if (out.normal != TRP_NO_NODE) out.normal = kept[out.normal];

    out.emits = out.constants[kEmission] > 0 || out.constants[kEmission + 1] > 0 || out.constants[kEmission + 2] > 0;
    for (int c = 0; c < 3; ++c) {
        out.transmits |= out.constants[kTransmission + c] > 0;
        out.mirrors |= out.constants[kMirror + c] > 0;
    }
    out.has_holes = out.constants[kAlpha] < 1 ||
                    std::any_of(out.outputs.begin(), out.outputs.end(), [](const auto& o) { return o.row == kAlpha; });
    return out;
}

void run_program(const Snapshot& snapshot, const CompiledMaterial& material, const int32_t* lanes, int count,
                 Points& points, Coefficients& coefficients, ProgramScratch& scratch) {
    Register* registers = scratch.registers(material.instructions.size());
    for (size_t i = 0; i < material.instructions.size(); ++i) {
        const Instruction& in = material.instructions[i];
        Register& out = registers[i];
        if (in.type != TRP_NODE_UV && in.type != TRP_NODE_UV_TRANSFORM) clear_derivatives(out, count);
        switch (in.type) {
            case TRP_NODE_UV:
                read_uv(snapshot, in.name, points, lanes, count, out);
                break;
            case TRP_NODE_COLOR:
                run_color(snapshot, in, points, lanes, count, out);
                break;
            case TRP_NODE_OBJECT_COLOR:
                for (int j = 0; j < count; ++j) {
                    const Vec3& color = snapshot.surfaces[points.slot[lanes[j]]].color;
                    for (int c = 0; c < 3; ++c) out.value[c][j] = color[c];
                    out.value[3][j] = 1;
                }
                break;
            case TRP_NODE_IMAGE:
                run_image(in, registers, count, out);
                break;
            case TRP_NODE_NORMAL_MAP:
                run_normal_map(snapshot, in, points, lanes, count, registers[in.inputs[0]], out);
                break;
            default:
                run_arithmetic(in, registers, count, out);
        }
    }
    for (const auto& output : material.outputs)
        for (int c = 0; c < output.channels; ++c) {
            float* row = coefficient_row(coefficients, output.row + c);
            const float* values = registers[output.node].value[c];
            for (int j = 0; j < count; ++j) row[lanes[j]] *= std::max(values[j], 0.0f);
        }
    if (material.normal != TRP_NO_NODE)
        for (int j = 0; j < count; ++j)
            points.normal.set(lanes[j], {registers[material.normal].value[0][j], registers[material.normal].value[1][j],
                                         registers[material.normal].value[2][j]});
}

}  // namespace trp
