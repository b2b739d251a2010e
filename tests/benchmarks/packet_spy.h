// The packets of rays that the core has Embree trace, overheard. It stands between the core and Embree; calls are
// forwarded unchanged, and kept while a recording runs.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/embree.h"

namespace trp_bench {

// 16 rays as they went in. What is the same in all lanes is kept once.
struct Packet {
    enum Field { kOrgX, kOrgY, kOrgZ, kDirX, kDirY, kDirZ, kNear, kFar, kFields };
    alignas(64) float fields[kFields][16];
    RTCScene scene;
    float time;
    unsigned mask, id, flags;
    uint16_t valid;  // a bit to a lane
    bool occluded;   // rtcOccluded16, else rtcIntersect16
    bool coherent;
};

// Packets of one thread, in the order in which it traced them.
struct PacketRun {
    static constexpr size_t kCapacity = 2048;
    std::array<Packet, kCapacity> packets;
    size_t count = 0;
};

struct Recording {
    std::vector<std::unique_ptr<PacketRun>> runs;
    uint64_t rays() const;
};

// Packets of any thread are kept from the first to the second call. Packets without a valid lane are left out.
void start_recording();
Recording stop_recording();

// Embree's own functions, past the ones that listen.
using Intersect16 = decltype(rtcIntersect16);
using Occluded16 = decltype(rtcOccluded16);
Intersect16* embree_intersect16();
Occluded16* embree_occluded16();

}  // namespace trp_bench
