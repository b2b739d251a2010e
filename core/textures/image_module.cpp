#include "textures/image_module.h"

#include <dlfcn.h>

#include <memory>

#include "base/error.h"

namespace trp {

ImageModule& image_module() {
    static const std::unique_ptr<ImageModule> module = [] {
        Dl_info info{};
        dladdr(reinterpret_cast<const void*>(&trp_version), &info);
        std::string path = info.dli_fname ? info.dli_fname : "";
        path = path.substr(0, path.find_last_of('/') + 1) + "libtriptych_images.so";
        void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (!library) fail(TRP_ERROR_FILE, "the image library could not be loaded: {}", dlerror());
        const auto create = reinterpret_cast<CreateImageModule>(dlsym(library, kCreateImageModule));
        if (!create) fail(TRP_ERROR_FILE, "{} is not an image library of Triptych", path);
        return std::unique_ptr<ImageModule>(create());
    }();
    return *module;
}

}  // namespace trp
