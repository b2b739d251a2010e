#include "trace/media.h"

namespace trp {

void Media::clear() {
    solids_.assign(1, {kOutside, kNoSlot, 0});
}

Media::State Media::enter(State state, uint32_t slot, uint32_t material) {
    // The last states are the likeliest; only so many are searched, or deep nests would cost their square.
    constexpr size_t kSearched = 64;
    for (size_t k = solids_.size(); k-- > 1 && solids_.size() - k <= kSearched;)
        if (solids_[k].within == state && solids_[k].slot == slot && solids_[k].material == material)
            return static_cast<State>(k);
    solids_.push_back({state, slot, material});
    return static_cast<State>(solids_.size() - 1);
}

Media::State Media::leave(State state, uint32_t slot) {
    std::vector<Solid> kept;  // those above it
    for (State at = state; at != kOutside; at = solids_[at].within) {
        if (solids_[at].slot != slot) {
            kept.push_back(solids_[at]);
            continue;
        }
        State out = solids_[at].within;
        for (size_t k = kept.size(); k-- > 0;) out = enter(out, kept[k].slot, kept[k].material);
        return out;
    }
    return state;
}

const CompiledMaterial* Media::filling(State state) const {
    const CompiledMaterial* best = nullptr;
    for (State at = state; at != kOutside; at = solids_[at].within) {
        const CompiledMaterial& material = snapshot_.materials[solids_[at].material];
        if (!best || material.priority > best->priority) best = &material;
    }
    return best;
}

Media::Crossing Media::cross(State state, uint32_t slot, uint32_t material, bool from_behind) {
    Crossing out{};
    const State inside = from_behind ? state : enter(state, slot, material),
                outside = from_behind ? leave(state, slot) : state;
    out.beyond = from_behind ? outside : inside;
    out.here = filling(state);
    out.there = filling(out.beyond);
    const CompiledMaterial* const own = &snapshot_.materials[material];
    if (from_behind) {
        // Seen from within though never entered, as where a mesh is open: it is its own solid.
        if (outside == state) out.here = own;
        out.is_real = out.here == own;
    } else {
        out.is_real = out.there == own;
    }
    return out;
}

}  // namespace trp
