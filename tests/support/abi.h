// The C ABI for tests: handles that release themselves, calls that fail the test, and meshes of a few lines.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "triptych/triptych.h"

namespace trp_test {

constexpr double kPi = std::numbers::pi;

using Vec = std::array<float, 3>;

inline Vec operator+(Vec a, Vec b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Vec operator-(Vec a, Vec b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vec operator*(Vec a, float s) {
    return {a[0] * s, a[1] * s, a[2] * s};
}
inline float dot(Vec a, Vec b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vec cross(Vec a, Vec b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Vec unit(Vec a) {
    return a * (1 / std::sqrt(dot(a, a)));
}

inline void check(TrpStatus status) {
    if (status != TRP_OK) throw std::runtime_error(trp_error_message());
}

// 3 × 4, rows.
using Transform = std::array<float, 12>;
constexpr Transform kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

inline Transform translation(Vec t) {
    return {1, 0, 0, t[0], 0, 1, 0, t[1], 0, 0, 1, t[2]};
}

// A camera or light at `from` that looks at `to` with `up` upwards.
inline Transform look_at(Vec from, Vec to, Vec up = {0, 0, 1}) {
    const Vec z = unit(from - to), x = unit(cross(up, z)), y = cross(z, x);
    return {x[0], y[0], z[0], from[0], x[1], y[1], z[1], from[1], x[2], y[2], z[2], from[2]};
}

inline TrpArray floats(const std::vector<float>& v, uint32_t components) {
    return {v.data(), v.size() / components, 0, TRP_FORMAT_FLOAT32};
}
inline TrpArray indices(const std::vector<uint32_t>& v, uint32_t components = 1) {
    return {v.data(), v.size() / components, 0, TRP_FORMAT_UINT32};
}

// A mesh's arrays, and what is to be set beside them.
struct MeshData {
    std::vector<float> positions;
    std::vector<uint32_t> offsets, corners;
    std::vector<float> normals, uvs;  // normals by vertex, UVs by corner
    std::vector<uint8_t> smooth;
    std::vector<uint32_t> materials, face_materials;
};

// Four corners, counter-clockwise seen from the front, with UVs (0,0) (1,0) (1,1) (0,1).
inline MeshData quad(Vec a, Vec b, Vec c, Vec d) {
    MeshData m;
    for (const Vec& p : {a, b, c, d}) m.positions.insert(m.positions.end(), p.begin(), p.end());
    m.offsets = {0, 4};
    m.corners = {0, 1, 2, 3};
    m.uvs = {0, 0, 1, 0, 1, 1, 0, 1};
    return m;
}

// A horizontal square about the origin that faces up.
inline MeshData floor_square(float half, float z = 0) {
    return quad({-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z});
}

// A latitude-longitude sphere of quads (triangles at the poles), with its exact normals.
inline MeshData sphere(Vec centre, float radius, int rings = 64) {
    MeshData m;
    const int segments = 2 * rings;
    for (int r = 0; r <= rings; ++r)
        for (int s = 0; s < segments; ++s) {
            const double theta = kPi * r / rings, phi = 2 * kPi * s / segments;
            const Vec n = {static_cast<float>(std::sin(theta) * std::cos(phi)),
                           static_cast<float>(std::sin(theta) * std::sin(phi)), static_cast<float>(std::cos(theta))};
            for (int k = 0; k < 3; ++k) {
                m.positions.push_back(centre[k] + radius * n[k]);
                m.normals.push_back(n[k]);
            }
        }
    m.offsets = {0};
    for (int r = 0; r < rings; ++r)
        for (int s = 0; s < segments; ++s) {
            const auto at = [&](int ring, int segment) {
                return static_cast<uint32_t>(ring * segments + segment % segments);
            };
            for (const uint32_t v : {at(r, s), at(r + 1, s), at(r + 1, s + 1), at(r, s + 1)}) m.corners.push_back(v);
            m.offsets.push_back(static_cast<uint32_t>(m.corners.size()));
        }
    return m;
}

class Scene {
  public:
    Scene() { check(trp_scene_create(&handle_)); }
    ~Scene() { trp_scene_destroy(handle_); }
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;
    operator TrpScene*() const { return handle_; }

    // `change` edits the descriptor before it is handed in.
    uint32_t mesh(const MeshData& data, const std::function<void(TrpMeshDesc&)>& change = {}) {
        TrpMeshDesc desc = mesh_desc(data);
        if (change) change(desc);
        uint32_t id = 0;
        check(trp_mesh_add(handle_, &desc, &id));
        return id;
    }
    static TrpMeshDesc mesh_desc(const MeshData& data) {
        TrpMeshDesc desc;
        check(trp_mesh_desc_init(&desc, sizeof desc));
        desc.positions = floats(data.positions, 3);
        desc.face_offsets = indices(data.offsets);
        desc.corner_vertices = indices(data.corners);
        desc.normals = floats(data.normals, 3);
        static thread_local TrpAttribute uv;
        uv = {"UVMap", floats(data.uvs, 2), TRP_DOMAIN_CORNER, 2};
        if (!data.uvs.empty()) desc.uv_sets = &uv, desc.uv_set_count = 1;
        desc.face_smooth = {data.smooth.data(), data.smooth.size(), 0, TRP_FORMAT_UINT8};
        desc.materials = data.materials.data();
        desc.material_count = static_cast<uint32_t>(data.materials.size());
        desc.face_materials = indices(data.face_materials);
        return desc;
    }
    uint32_t instance(uint32_t mesh, const Transform& transform = kIdentity,
                      const std::function<void(TrpInstanceDesc&)>& change = {}) {
        TrpInstanceDesc desc;
        check(trp_instance_desc_init(&desc, sizeof desc));
        desc.mesh = mesh;
        desc.world_from_object = transform.data();
        if (change) change(desc);
        uint32_t id = 0;
        check(trp_instance_add(handle_, &desc, &id));
        return id;
    }
    uint32_t material(const std::function<void(TrpMaterialDesc&)>& change) {
        TrpMaterialDesc desc;
        check(trp_material_desc_init(&desc, sizeof desc));
        change(desc);
        uint32_t id = 0;
        check(trp_material_add(handle_, &desc, &id));
        return id;
    }
    uint32_t diffuse(float r, float g, float b) {
        return material([&](TrpMaterialDesc& d) { d.diffuse = {{r, g, b}, TRP_NO_NODE}; });
    }
    // Red light that lets through what its alpha leaves.
    uint32_t veil(float red, float alpha) {
        return material([&](TrpMaterialDesc& d) {
            d.diffuse = {{0, 0, 0}, TRP_NO_NODE};
            d.emission = {{red, 0, 0}, TRP_NO_NODE};
            d.alpha = {{alpha, 0, 0}, TRP_NO_NODE};
        });
    }
    // A mesh shown once, of one material.
    uint32_t object(MeshData data, uint32_t material = TRP_NO_ID, const Transform& transform = kIdentity) {
        if (material) data.materials = {material};
        return instance(mesh(data), transform);
    }
    uint32_t light(int32_t type, Vec emission, const Transform& transform,
                   const std::function<void(TrpLightDesc&)>& change = {}) {
        TrpLightDesc desc;
        check(trp_light_desc_init(&desc, sizeof desc));
        desc.type = type;
        desc.world_from_light = transform.data();
        for (int k = 0; k < 3; ++k) desc.emission[k] = emission[k];
        if (change) change(desc);
        uint32_t id = 0;
        check(trp_light_add(handle_, &desc, &id));
        return id;
    }
    uint32_t camera(const Transform& transform, const std::function<void(TrpCameraDesc&)>& change = {}) {
        TrpCameraDesc desc;
        check(trp_camera_desc_init(&desc, sizeof desc));
        desc.world_from_camera = transform.data();
        if (change) change(desc);
        uint32_t id = 0;
        check(trp_camera_add(handle_, &desc, &id));
        check(trp_scene_set_camera(handle_, id));
        return id;
    }
    // From above, orthographic, `width` metres across, at height 10.
    uint32_t camera_above(float width, Vec at = {0, 0, 0}) {
        return camera(translation({at[0], at[1], 10}), [&](TrpCameraDesc& d) {
            d.type = TRP_CAMERA_ORTHOGRAPHIC;
            d.width = width;
        });
    }
    void world(Vec radiance, const std::function<void(TrpWorldDesc&)>& change = {}) {
        TrpWorldDesc desc;
        check(trp_world_desc_init(&desc, sizeof desc));
        for (int k = 0; k < 3; ++k) desc.radiance[k] = radiance[k];
        if (change) change(desc);
        check(trp_scene_set_world(handle_, &desc));
    }
    void commit(uint32_t threads = 0) { check(trp_scene_commit(handle_, threads)); }

  private:
    TrpScene* handle_ = nullptr;
};

using Settings = std::vector<std::pair<const char*, std::string>>;

inline Settings with(Settings settings, const Settings& more) {
    settings.insert(settings.end(), more.begin(), more.end());
    return settings;
}

// A picture of one pass: row 0 at the bottom.
struct Image {
    uint32_t width = 0, height = 0, channels = 0;
    std::vector<float> values;
    const float* at(uint32_t x, uint32_t y) const { return &values[(static_cast<size_t>(y) * width + x) * channels]; }
};

class Render {
  public:
    Render(Scene& scene, uint32_t width, uint32_t height, const Settings& settings = {},
           const std::vector<const char*>& passes = {}, const char* method = "ray_casting")
        : width_(width), height_(height) {
        check(trp_render_create(scene, method, &handle_));
        check(trp_render_set_film(handle_, width, height, 0, 0, 0, 0));
        for (const auto& [name, value] : settings) check(trp_render_set(handle_, name, value.c_str()));
        for (const char* pass : passes) check(trp_render_add_pass(handle_, pass));
    }
    ~Render() { trp_render_destroy(handle_); }
    Render(const Render&) = delete;
    Render& operator=(const Render&) = delete;
    operator TrpRender*() const { return handle_; }

    Render& run() {
        check(trp_render_run(handle_, nullptr));
        return *this;
    }
    Image read(const char* pass = "Combined") const {
        Image image{width_, height_, 0, {}};
        for (uint32_t p = 0; p < trp_pass_count(); ++p) {
            TrpPassInfo info{};
            info.struct_size = sizeof info;
            check(trp_pass_info(p, &info));
            if (std::string(info.name) == pass) image.channels = info.channel_count;
        }
        image.values.resize(static_cast<size_t>(width_) * height_ * image.channels);
        check(trp_render_read(handle_, pass, 0, 0, width_, height_, image.values.data(), image.values.size()));
        return image;
    }

  private:
    TrpRender* handle_ = nullptr;
    uint32_t width_, height_;
};

// Commits and renders: the Combined pass.
inline Image render(Scene& scene, uint32_t width, uint32_t height, const Settings& settings = {}) {
    scene.commit();
    return Render(scene, width, height, settings).run().read();
}

// The mean of a channel over the picture.
inline double mean(const Image& image, uint32_t channel = 0) {
    double sum = 0;
    for (size_t i = channel; i < image.values.size(); i += image.channels) sum += image.values[i];
    return sum / (static_cast<double>(image.width) * image.height);
}

}  // namespace trp_test
