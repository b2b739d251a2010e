// Standing between a library and those who call it: a function that the executable defines under the library's name is
// called in its place, and calls the library's own through this.
#pragma once

#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>

namespace trp_bench {

// The next definition of `name` after the executable's.
template <class Function>
Function* next_definition(const char* name) {
    void* const found = dlsym(RTLD_NEXT, name);
    if (!found) {
        std::fprintf(stderr, "no library defines %s\n", name);
        std::abort();
    }
    return reinterpret_cast<Function*>(found);
}

}  // namespace trp_bench
