// The front door's guard: runs a call, turns exceptions into status and message, and checks what every call must check.
#pragma once

#include <algorithm>
#include <cstring>
#include <new>

#include "base/error.h"

namespace trp {

void set_error_message(const char* text) noexcept;

template <class Call>
TrpStatus guard(Call&& call) noexcept {
    try {
        return call();
    } catch (const Error& error) {
        set_error_message(error.what());
        return error.status;
    } catch (const std::bad_alloc&) {
        set_error_message("out of memory");
        return TRP_ERROR_MEMORY;
    } catch (const std::exception& error) {
        set_error_message(error.what());
        return TRP_ERROR_INTERNAL;
    } catch (...) {
        set_error_message("an unknown fault");
        return TRP_ERROR_INTERNAL;
    }
}

// Throws where a pointer argument is null.
inline void check_pointer(const void* pointer, const char* argument) {
    if (!pointer) fail(TRP_ERROR_ARGUMENT, "{} is null", argument);
}

// Structs of an older client are smaller than ours, those of a newer one larger; both begin with struct_size. Every
// version of a struct ends where its alignment lets it, never within a pointer or a number.
constexpr size_t kGreatestStruct = 1 << 16;

template <class Struct>
bool is_struct_size(size_t size) {
    return size >= sizeof(uint32_t) && size <= kGreatestStruct && size % alignof(Struct) == 0;
}

// Writes defaults into the caller's `size` bytes: ours as far as they go, zeros beyond.
template <class Desc>
TrpStatus init_struct(Desc* out, size_t size, Desc defaults) {
    return guard([&] {
        check_pointer(out, "the struct");
        if (!is_struct_size<Desc>(size)) fail(TRP_ERROR_ARGUMENT, "struct_size is {}", size);
        defaults.struct_size = static_cast<uint32_t>(size);
        std::memset(out, 0, size);
        std::memcpy(out, &defaults, std::min(size, sizeof(Desc)));
        return TRP_OK;
    });
}

// The caller's struct, completed with defaults where it is smaller than ours.
template <class Desc>
Desc read_struct(const Desc* in, const Desc& defaults, const char* argument) {
    check_pointer(in, argument);
    if (!is_struct_size<Desc>(in->struct_size))
        fail(TRP_ERROR_ARGUMENT, "{}: struct_size is {}; was it initialized?", argument, in->struct_size);
    Desc out = defaults;
    std::memcpy(&out, in, std::min<size_t>(in->struct_size, sizeof(Desc)));
    return out;
}

// Fills the caller's struct, as much of it as there is, with zeros beyond ours; struct_size stays the caller's.
template <class Info>
void write_struct(Info* out, Info info, const char* argument) {
    check_pointer(out, argument);
    if (!is_struct_size<Info>(out->struct_size))
        fail(TRP_ERROR_ARGUMENT, "{}: struct_size is {}; was it set?", argument, out->struct_size);
    info.struct_size = out->struct_size;
    std::memset(static_cast<void*>(out), 0, info.struct_size);
    std::memcpy(out, &info, std::min<size_t>(info.struct_size, sizeof(Info)));
}

}  // namespace trp
