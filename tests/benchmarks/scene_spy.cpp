#include "scene_spy.h"

#include <algorithm>
#include <cstring>
#include <mutex>
#include <stdexcept>
#include <unordered_map>

#include "interpose.h"

namespace trp_bench {
namespace {

struct Buffer {
    const char* data = nullptr;
    size_t stride = 0, count = 0;
    template <class T>
    const T* at(size_t i) const {
        return reinterpret_cast<const T*>(data + i * stride);
    }
};

struct Geometry {
    Buffer vertices, indices;
    unsigned mask = ~0u;
    RTCScene instanced = nullptr;
    float transform[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    bool known = true;  // false: something was set that is not kept here
};

struct Overheard {
    std::mutex mutex;
    std::unordered_map<RTCGeometry, Geometry> geometries;
    std::unordered_map<RTCScene, std::map<unsigned, RTCGeometry>> scenes;
    std::vector<RTCScene> order;  // of making
};

Overheard& overheard() {
    static Overheard state;
    return state;
}

Geometry& geometry_of(RTCGeometry geometry) {
    return overheard().geometries[geometry];
}

void append(const Geometry& geometry, const float* m, FlatMesh& mesh) {
    const auto first = static_cast<uint32_t>(mesh.vertex_count());
    for (size_t v = 0; v < geometry.vertices.count; ++v) {
        const float* p = geometry.vertices.at<float>(v);
        for (int row = 0; row < 3; ++row)
            mesh.positions.push_back(
                m ? m[4 * row] * p[0] + m[4 * row + 1] * p[1] + m[4 * row + 2] * p[2] + m[4 * row + 3] : p[row]);
    }
    for (size_t t = 0; t < geometry.indices.count; ++t)
        for (int k = 0; k < 3; ++k) mesh.indices.push_back(first + geometry.indices.at<uint32_t>(t)[k]);
}

}  // namespace

FlatMeshes overheard_triangles(RTCScene scene) {
    Overheard& state = overheard();
    const std::lock_guard lock(state.mutex);
    FlatMeshes meshes;
    for (const auto& [id, handle] : state.scenes.at(scene)) {
        const Geometry& geometry = state.geometries.at(handle);
        if (!geometry.known) throw std::runtime_error("the core uses a feature of Embree that the benchmark ignores");
        FlatMesh& mesh = meshes[geometry.mask];
        if (!geometry.instanced) {
            append(geometry, nullptr, mesh);
        } else {
            for (const auto& [part_id, part] : state.scenes.at(geometry.instanced))
                append(state.geometries.at(part), geometry.transform, mesh);
        }
    }
    for (auto& [mask, mesh] : meshes) mesh.positions.reserve(mesh.positions.size() + 1);
    return meshes;
}

RTCScene overheard_top_scene() {
    Overheard& state = overheard();
    const std::lock_guard lock(state.mutex);
    for (auto it = state.order.rbegin(); it != state.order.rend(); ++it) {
        const bool is_part = std::any_of(state.geometries.begin(), state.geometries.end(),
                                         [&](const auto& entry) { return entry.second.instanced == *it; });
        if (!is_part) return *it;
    }
    throw std::runtime_error("the core has made no Embree scene");
}

}  // namespace trp_bench

// The functions that the core calls in Embree's place.

using trp_bench::Geometry;
using trp_bench::geometry_of;
using trp_bench::next_definition;
using trp_bench::overheard;

#define TRP_FORWARD(function) static const auto real = next_definition<decltype(function)>(#function)

RTC_API_EXPORT RTCScene rtcNewScene(RTCDevice device) {
    TRP_FORWARD(rtcNewScene);
    const RTCScene scene = real(device);
    const std::lock_guard lock(overheard().mutex);
    auto& order = overheard().order;
    order.erase(std::remove(order.begin(), order.end(), scene), order.end());
    order.push_back(scene);
    overheard().scenes[scene].clear();
    return scene;
}

RTC_API_EXPORT RTCGeometry rtcNewGeometry(RTCDevice device, RTCGeometryType type) {
    TRP_FORWARD(rtcNewGeometry);
    const RTCGeometry geometry = real(device, type);
    const std::lock_guard lock(overheard().mutex);
    geometry_of(geometry) = Geometry{};
    geometry_of(geometry).known = type == RTC_GEOMETRY_TYPE_TRIANGLE || type == RTC_GEOMETRY_TYPE_INSTANCE;
    return geometry;
}

RTC_API_EXPORT void rtcSetSharedGeometryBuffer(RTCGeometry geometry, RTCBufferType type, unsigned slot,
                                               RTCFormat format, const void* data, size_t offset, size_t stride,
                                               size_t count) {
    TRP_FORWARD(rtcSetSharedGeometryBuffer);
    real(geometry, type, slot, format, data, offset, stride, count);
    const std::lock_guard lock(overheard().mutex);
    const trp_bench::Buffer buffer{static_cast<const char*>(data) + offset, stride, count};
    if (type == RTC_BUFFER_TYPE_VERTEX && slot == 0 && format == RTC_FORMAT_FLOAT3)
        geometry_of(geometry).vertices = buffer;
    else if (type == RTC_BUFFER_TYPE_INDEX && slot == 0 && format == RTC_FORMAT_UINT3)
        geometry_of(geometry).indices = buffer;
    else
        geometry_of(geometry).known = false;
}

RTC_API_EXPORT void rtcSetGeometryMask(RTCGeometry geometry, unsigned mask) {
    TRP_FORWARD(rtcSetGeometryMask);
    real(geometry, mask);
    const std::lock_guard lock(overheard().mutex);
    geometry_of(geometry).mask = mask;
}

RTC_API_EXPORT void rtcSetGeometryInstancedScene(RTCGeometry geometry, RTCScene scene) {
    TRP_FORWARD(rtcSetGeometryInstancedScene);
    real(geometry, scene);
    const std::lock_guard lock(overheard().mutex);
    geometry_of(geometry).instanced = scene;
}

RTC_API_EXPORT void rtcSetGeometryTransform(RTCGeometry geometry, unsigned time_step, RTCFormat format,
                                            const void* transform) {
    TRP_FORWARD(rtcSetGeometryTransform);
    real(geometry, time_step, format, transform);
    const std::lock_guard lock(overheard().mutex);
    if (time_step == 0 && format == RTC_FORMAT_FLOAT3X4_ROW_MAJOR)
        std::memcpy(geometry_of(geometry).transform, transform, sizeof Geometry::transform);
    else
        geometry_of(geometry).known = false;
}

RTC_API_EXPORT unsigned rtcAttachGeometry(RTCScene scene, RTCGeometry geometry) {
    TRP_FORWARD(rtcAttachGeometry);
    const unsigned id = real(scene, geometry);
    const std::lock_guard lock(overheard().mutex);
    overheard().scenes[scene][id] = geometry;
    return id;
}

RTC_API_EXPORT void rtcAttachGeometryByID(RTCScene scene, RTCGeometry geometry, unsigned id) {
    TRP_FORWARD(rtcAttachGeometryByID);
    real(scene, geometry, id);
    const std::lock_guard lock(overheard().mutex);
    overheard().scenes[scene][id] = geometry;
}

RTC_API_EXPORT void rtcDetachGeometry(RTCScene scene, unsigned id) {
    TRP_FORWARD(rtcDetachGeometry);
    real(scene, id);
    const std::lock_guard lock(overheard().mutex);
    overheard().scenes[scene].erase(id);
}
