#include "packet_spy.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>
#include <mutex>
#include <stdexcept>

#include "interpose.h"

namespace trp_bench {
namespace {

std::atomic<bool> g_recording{false};
std::atomic<bool> g_uneven{false};  // a packet was met whose lanes differ where Packet holds one value
std::atomic<uint64_t> g_generation{0};
std::mutex g_mutex;
Recording g_recorded;

PacketRun& run_of_thread() {
    thread_local PacketRun* run = nullptr;
    thread_local uint64_t generation = 0;
    if (!run || generation != g_generation || run->count == PacketRun::kCapacity) {
        auto fresh = std::make_unique_for_overwrite<PacketRun>();
        fresh->count = 0;
        run = fresh.get();
        generation = g_generation;
        const std::lock_guard lock(g_mutex);
        g_recorded.runs.push_back(std::move(fresh));
    }
    return *run;
}

template <class T>
T value_of_all(const T* lanes) {
    if (std::any_of(lanes, lanes + 16, [&](const T& value) { return value != lanes[0]; })) g_uneven = true;
    return lanes[0];
}

void keep(const int* valid, RTCScene scene, const RTCRay16& ray, bool occluded, bool coherent) {
    uint16_t lanes = 0;
    for (int k = 0; k < 16; ++k) lanes = static_cast<uint16_t>(lanes | (valid[k] ? 1u << k : 0u));
    if (lanes == 0) return;
    PacketRun& run = run_of_thread();
    Packet& packet = run.packets[run.count++];
    const float* const fields[Packet::kFields] = {ray.org_x, ray.org_y, ray.org_z, ray.dir_x,
                                                  ray.dir_y, ray.dir_z, ray.tnear, ray.tfar};
    for (int f = 0; f < Packet::kFields; ++f) std::memcpy(packet.fields[f], fields[f], sizeof packet.fields[f]);
    packet.scene = scene;
    packet.time = value_of_all(ray.time);
    packet.mask = value_of_all(ray.mask);
    packet.id = value_of_all(ray.id);
    packet.flags = value_of_all(ray.flags);
    packet.valid = lanes;
    packet.occluded = occluded;
    packet.coherent = coherent;
}

const auto g_intersect16 = next_definition<Intersect16>("rtcIntersect16");
const auto g_occluded16 = next_definition<Occluded16>("rtcOccluded16");

}  // namespace

uint64_t Recording::rays() const {
    uint64_t sum = 0;
    for (const auto& run : runs)
        for (size_t i = 0; i < run->count; ++i) sum += static_cast<uint64_t>(std::popcount(run->packets[i].valid));
    return sum;
}

void start_recording() {
    ++g_generation;
    g_recorded = {};
    g_uneven = false;
    g_recording = true;
}

Recording stop_recording() {
    g_recording = false;
    if (g_uneven) throw std::runtime_error("a packet's lanes differ in time, mask, id or flags");
    return std::move(g_recorded);
}

Intersect16* embree_intersect16() {
    return g_intersect16;
}
Occluded16* embree_occluded16() {
    return g_occluded16;
}

}  // namespace trp_bench

// The functions that the core calls in Embree's place.

using namespace trp_bench;

#if TRP_EMBREE == 4
RTC_API_EXPORT void rtcIntersect16(const int* valid, RTCScene scene, RTCRayHit16* rays, RTCIntersectArguments* args) {
    if (g_recording.load(std::memory_order_relaxed))
        keep(valid, scene, rays->ray, false, args->flags & RTC_RAY_QUERY_FLAG_COHERENT);
    g_intersect16(valid, scene, rays, args);
}

RTC_API_EXPORT void rtcOccluded16(const int* valid, RTCScene scene, RTCRay16* rays, RTCOccludedArguments* args) {
    if (g_recording.load(std::memory_order_relaxed))
        keep(valid, scene, *rays, true, args->flags & RTC_RAY_QUERY_FLAG_COHERENT);
    g_occluded16(valid, scene, rays, args);
}
#else
RTC_API_EXPORT void rtcIntersect16(const int* valid, RTCScene scene, RTCIntersectContext* context, RTCRayHit16* rays) {
    if (g_recording.load(std::memory_order_relaxed))
        keep(valid, scene, rays->ray, false, context->flags & RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
    g_intersect16(valid, scene, context, rays);
}

RTC_API_EXPORT void rtcOccluded16(const int* valid, RTCScene scene, RTCIntersectContext* context, RTCRay16* rays) {
    if (g_recording.load(std::memory_order_relaxed))
        keep(valid, scene, *rays, true, context->flags & RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
    g_occluded16(valid, scene, context, rays);
}
#endif
