#include "replay.h"

#include <time.h>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include <algorithm>
#include <atomic>
#include <thread>

namespace trp_bench {
namespace {

constexpr size_t kStaged = 64;

struct StagedPacket {
    alignas(64) int valid[16];
    RTCRay16 ray;
    RTCScene scene;
    bool occluded, coherent;
};

// As in the core's threads: denormals are zero.
void flush_denormals() {
#if defined(__SSE__)
    _mm_setcsr(_mm_getcsr() | 0x8040);
#endif
}

double thread_cpu_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

void unpack(const Packet& packet, Loop loop, RTCScene flat_scene, StagedPacket& out) {
    float* const fields[Packet::kFields] = {out.ray.org_x, out.ray.org_y, out.ray.org_z, out.ray.dir_x,
                                            out.ray.dir_y, out.ray.dir_z, out.ray.tnear, out.ray.tfar};
    for (int f = 0; f < Packet::kFields; ++f) std::copy_n(packet.fields[f], 16, fields[f]);
    std::fill_n(out.ray.time, 16, packet.time);
    std::fill_n(out.ray.mask, 16, packet.mask);
    std::fill_n(out.ray.id, 16, packet.id);
    std::fill_n(out.ray.flags, 16, packet.flags);
    for (int k = 0; k < 16; ++k) out.valid[k] = packet.valid >> k & 1 ? -1 : 0;
    out.scene = loop == Loop::flat ? flat_scene : packet.scene;
    out.occluded = packet.occluded;
    out.coherent = packet.coherent || (loop == Loop::flat && packet.occluded);
}

// The two calls, with what each version of Embree wants beside the rays.
class Tracer {
  public:
    explicit Tracer(bool count_hits) : count_hits_(count_hits) {
        for (const bool coherent : {false, true}) {
#if TRP_EMBREE == 4
            const auto flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
            rtcInitIntersectArguments(&intersect_[coherent]);
            rtcInitOccludedArguments(&occluded_[coherent]);
            intersect_[coherent].flags = occluded_[coherent].flags = flags;
#else
            rtcInitIntersectContext(&context_[coherent]);
            context_[coherent].flags =
                coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
#endif
        }
    }

    // Returns how many valid lanes met something, or 0 where that is not asked for.
    int trace(const StagedPacket& packet) {
        if (packet.occluded) {
            RTCRay16 ray = packet.ray;
#if TRP_EMBREE == 4
            occluded16_(packet.valid, packet.scene, &ray, &occluded_[packet.coherent]);
#else
            occluded16_(packet.valid, packet.scene, &context_[packet.coherent], &ray);
#endif
            int hits = 0;
            if (!count_hits_) return hits;
            for (int k = 0; k < 16; ++k) hits += packet.valid[k] & (ray.tfar[k] < 0);
            return hits;
        }
        RTCRayHit16 rays;
        rays.ray = packet.ray;
        std::fill_n(rays.hit.geomID, 16, RTC_INVALID_GEOMETRY_ID);
        std::fill_n(rays.hit.instID[0], 16, RTC_INVALID_GEOMETRY_ID);
#if TRP_EMBREE == 4
        intersect16_(packet.valid, packet.scene, &rays, &intersect_[packet.coherent]);
#else
        intersect16_(packet.valid, packet.scene, &context_[packet.coherent], &rays);
#endif
        int hits = 0;
        if (!count_hits_) return hits;
        for (int k = 0; k < 16; ++k) hits += packet.valid[k] & (rays.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID);
        return hits;
    }

  private:
    const bool count_hits_;
    Intersect16* const intersect16_ = embree_intersect16();
    Occluded16* const occluded16_ = embree_occluded16();
#if TRP_EMBREE == 4
    RTCIntersectArguments intersect_[2];
    RTCOccludedArguments occluded_[2];
#else
    RTCIntersectContext context_[2];
#endif
};

void replay_thread(const Recording& recording, Loop loop, RTCScene flat_scene, bool count_hits,
                   std::atomic<size_t>& next, ReplayResult& result) {
    flush_denormals();
    Tracer tracer(count_hits);
    std::vector<StagedPacket> staged(kStaged);
    for (size_t r; (r = next++) < recording.runs.size();) {
        const PacketRun& run = *recording.runs[r];
        for (size_t first = 0; first < run.count; first += kStaged) {
            const size_t count = std::min(kStaged, run.count - first);
            for (size_t i = 0; i < count; ++i) unpack(run.packets[first + i], loop, flat_scene, staged[i]);
            int hits = 0;
            const double cpu = thread_cpu_seconds();
            const auto start = Clock::now();
            for (size_t i = 0; i < count; ++i) hits += tracer.trace(staged[i]);
            result.cost.wall += seconds_since(start);
            result.cost.cpu += thread_cpu_seconds() - cpu;
            result.hits += static_cast<uint64_t>(hits);
        }
    }
}

}  // namespace

ReplayResult replay(const Recording& recording, unsigned threads, Loop loop, RTCScene flat_scene, bool count_hits) {
    std::atomic<size_t> next{0};
    std::vector<ReplayResult> parts(threads);
    std::vector<std::thread> workers;
    for (ReplayResult& part : parts)
        workers.emplace_back([&] { replay_thread(recording, loop, flat_scene, count_hits, next, part); });
    for (std::thread& worker : workers) worker.join();
    ReplayResult sum;
    for (const ReplayResult& part : parts) {
        sum.cost.wall = std::max(sum.cost.wall, part.cost.wall);
        sum.cost.cpu += part.cost.cpu;
        sum.hits += part.hits;
    }
    return sum;
}

}  // namespace trp_bench
