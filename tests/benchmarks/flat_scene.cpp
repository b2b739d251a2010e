#include "flat_scene.h"

#include <tbb/task_arena.h>

#include <stdexcept>

#include "bench.h"

namespace trp_bench {
namespace {

RTCDevice device() {
    static const RTCDevice device = rtcNewDevice(nullptr);
    if (!device) throw std::runtime_error("Embree could not be started");
    return device;
}

}  // namespace

FlatScene::FlatScene(const FlatMeshes& meshes, unsigned threads) {
    device();
    tbb::task_arena arena(static_cast<int>(threads));
    const auto start = Clock::now();
    arena.execute([&] {
        scene_.reset(rtcNewScene(device()));
        rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_MEDIUM);
        for (const auto& [mask, mesh] : meshes) {
            const trp::EmbreeGeometry geometry(rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_TRIANGLE));
            rtcSetGeometryBuildQuality(geometry.get(), RTC_BUILD_QUALITY_MEDIUM);
            rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                       mesh.positions.data(), 0, 3 * sizeof(float), mesh.vertex_count());
            rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices.data(),
                                       0, 3 * sizeof(uint32_t), mesh.triangle_count());
            rtcSetGeometryMask(geometry.get(), mask);
            rtcCommitGeometry(geometry.get());
            rtcAttachGeometry(scene_.get(), geometry.get());
        }
        rtcCommitScene(scene_.get());
    });
    build_seconds_ = seconds_since(start);
    if (rtcGetDeviceError(device()) != RTC_ERROR_NONE) throw std::runtime_error("Embree could not build the scene");
}

}  // namespace trp_bench
