#include "radiosity/scene_hash.h"

#include <bit>
#include <cstring>
#include <string>
#include <type_traits>

namespace trp {
namespace {

// Words of eight bytes, each multiplied into what was before.
class Hash {
  public:
    void add_bytes(const void* data, size_t bytes) {
        const auto* p = static_cast<const unsigned char*>(data);
        for (; bytes >= 8; p += 8, bytes -= 8) {
            uint64_t word;
            std::memcpy(&word, p, 8);
            add_word(word);
        }
        uint64_t rest = 0;
        if (bytes > 0) std::memcpy(&rest, p, bytes);  // of an empty array there is no address
        add_word(rest ^ (uint64_t{bytes} << 56));
    }
    template <class T>
    requires std::is_arithmetic_v<T>
    void add(T value) { add_bytes(&value, sizeof value); }
    template <class T>
    requires std::is_arithmetic_v<T>
    void add(const std::vector<T>& values) {
        add(values.size());
        add_bytes(values.data(), values.size() * sizeof(T));
    }
    void add(const std::vector<Vec3>& values) {
        add(values.size());
        add_bytes(values.data(), values.size() * sizeof(Vec3));
    }
    void add(const Vec3& v) { add_bytes(&v, sizeof v); }
    void add(const std::string& text) {
        add(text.size());
        add_bytes(text.data(), text.size());
    }
    // In the world, whatever the snapshot's origin.
    void add(const Affine& m, const Vec3d& origin) {
        for (int r = 0; r < 3; ++r) {
            for (int c = 0; c < 3; ++c) add(m.rows[r][c]);
            add(static_cast<float>(static_cast<double>(m.rows[r][3]) + origin[r]));
        }
    }
    uint64_t value() const { return state_ ^ (state_ >> 31); }

  private:
    void add_word(uint64_t word) { state_ = std::rotl((state_ ^ word) * 0x9E3779B97F4A7C15u, 29); }
    uint64_t state_ = 0x243F6A8885A308D3u;
};

void add_texture(const Texture& t, Hash& hash) {
    hash.add(t.path);
    hash.add_bytes(t.file.data(), t.file.size());
    hash.add(t.pixels);
    for (const uint32_t n : {t.width, t.height, t.channels}) hash.add(n);
    for (const int32_t n : {t.color_space, t.wrap_u, t.wrap_v, t.filter}) hash.add(n);
}

void add_material(const CompiledMaterial& m, Hash& hash) {
    for (const float constant : m.constants) hash.add(constant);
    for (const auto& instruction : m.instructions) {
        hash.add(instruction.type);
        for (const int32_t input : instruction.inputs) hash.add(input);
        for (const auto& value : instruction.values)
            for (const float number : value) hash.add(number);
        hash.add(instruction.name);
        if (instruction.texture) add_texture(*instruction.texture->texture(), hash);
    }
    for (const auto& output : m.outputs)
        for (const int number : {output.row, output.channels, output.node}) hash.add(number);
    hash.add(m.normal);
    for (const bool flag : {m.thin, m.double_sided, m.fresnel}) hash.add(flag);
    hash.add(m.absorption);
}

void add_layers(const std::vector<Attribute>& layers, Hash& hash) {
    for (const Attribute& layer : layers) {
        hash.add(layer.name);
        hash.add(layer.domain);
        hash.add(layer.components);
        hash.add(layer.values);
    }
}

void add_surface(const PlacedSurface& surface, const Vec3d& origin, Hash& hash) {
    const Mesh& mesh = *surface.mesh;
    hash.add(surface.world_from_object, origin);
    hash.add(surface.color);
    hash.add(surface.slot_materials);
    hash.add(mesh.positions);
    hash.add(mesh.face_offsets);
    hash.add(mesh.corner_vertices);
    hash.add(mesh.normals);
    hash.add(mesh.face_materials);
    hash.add(mesh.face_smooth);
    add_layers(mesh.uv_sets, hash);
    add_layers(mesh.colors, hash);
}

void add_lamp(const Light& lamp, const Vec3d& origin, Hash& hash) {
    for (const int32_t n : {lamp.type, lamp.falloff, lamp.shape}) hash.add(n);
    hash.add(lamp.world_from_light[0], origin);
    hash.add(lamp.emission);
    for (const float n : {lamp.radius, lamp.angle, lamp.blend, lamp.size[0], lamp.size[1]}) hash.add(n);
    hash.add(lamp.cast_shadow);
}

}  // namespace

uint64_t scene_hash(const Snapshot& snapshot) {
    Hash hash;
    for (const PlacedSurface& surface : snapshot.surfaces) {
        hash.add(surface.mesh != nullptr);
        if (surface.mesh) add_surface(surface, snapshot.origin, hash);
    }
    for (const CompiledMaterial& material : snapshot.materials) add_material(material, hash);
    for (const Light& lamp : snapshot.lamps) add_lamp(lamp, snapshot.origin, hash);
    hash.add(snapshot.world.radiance);
    hash.add(snapshot.world.light);
    hash.add(snapshot.world.world_from_texture, Vec3d(0, 0, 0));
    const auto texture = snapshot.textures.find(snapshot.world.texture);
    if (texture != snapshot.textures.end() && texture->second) add_texture(*texture->second->texture(), hash);
    return hash.value();
}

}  // namespace trp
