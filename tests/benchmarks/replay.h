// The bare loop: recorded packets traced again, and nothing else.
//
// Each thread unpacks 64 packets at a time into memory that its nearest caches hold, off the clock, and then, on the
// clock, copies each to the stack and has Embree trace it: reading gigabytes of recorded rays is no part of the figure.
#pragma once

#include "bench.h"
#include "packet_spy.h"

namespace trp_bench {

enum class Loop {
    as_recorded,  // the recorded scenes and flags
    flat,         // all packets against one scene; shadow packets always coherent, as nothing in it forbids it
};

struct ReplayResult {
    Cost cost;          // wall: of the thread that traced longest; cpu: of all threads
    uint64_t hits = 0;  // lanes that met something, where they were counted
};

// Traces all packets of the recording on `threads` threads. `flat_scene` is used by Loop::flat alone. Counting hits
// takes time: it is for checks, not for figures.
ReplayResult replay(const Recording& recording, unsigned threads, Loop loop, RTCScene flat_scene,
                    bool count_hits = false);

}  // namespace trp_bench
