#include "textures/image_module.h"

#include <dlfcn.h>

#include "base/error.h"

namespace trp {

ImageModule& image_module() {
    // Never destroyed: the libraries that it stands on may be gone when a program's statics are.
    static ImageModule* const module = [] {
        Dl_info info{};
        dladdr(reinterpret_cast<const void*>(&trp_version), &info);
        std::string path = info.dli_fname ? info.dli_fname : "";
        path = path.substr(0, path.find_last_of('/') + 1) + "libtriptych_images.so";
        void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (!library) fail(TRP_ERROR_FILE, "the image library could not be loaded: {}", dlerror());
        const auto create = reinterpret_cast<CreateImageModule>(dlsym(library, kCreateImageModule));
        if (!create) fail(TRP_ERROR_FILE, "{} is not an image library of Triptych", path);
        return create();
    }();
    return *module;
}

}  // namespace trp
