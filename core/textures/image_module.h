// The door to the image library. Pictures are read, filtered and written by a module of its own, loaded when it is
// first needed: OpenImageIO with all that it links takes 0.3-0.7 s to load, which `triptych methods` and scenes without
// textures need not pay, and a slimmer module can take its place.
//
// The module throws std::runtime_error with a line that says what is wrong; it does not know the core's types.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace trp {

// Where a texture comes from: a path, a file's bytes, or pixels (row 0 at the bottom). Read only while it is opened.
struct ImageSource {
    std::string path;
    const unsigned char* file = nullptr;
    size_t file_size = 0;
    const float* pixels = nullptr;
    uint32_t width = 0, height = 0, channels = 0;
    int32_t color_space = 0, wrap_u = 0, wrap_v = 0, filter = 0;  // TRP_COLOR_SPACE_…, TRP_WRAP_…, TRP_FILTER_…
};

// Texture coordinates, v up, with their derivatives by one pixel to the right and one pixel up.
struct TextureCoordinates {
    const float *u, *v, *dudx, *dvdx, *dudy, *dvdy;
};

// A picture to write: interleaved floats, row 0 at the top, in a window of a larger picture.
struct Picture {
    uint32_t width = 0, height = 0;                                            // of the whole picture
    uint32_t window_x = 0, window_y = 0, window_width = 0, window_height = 0;  // from the top left
    std::vector<std::string> channels;
    std::vector<float> values;  // window_height · window_width · channels
};

class ImageModule {
  public:
    virtual ~ImageModule() = default;
    // Reads the whole picture into the cache. The handle is never 0.
    virtual uint64_t open(const ImageSource& source) = 0;
    virtual void close(uint64_t texture) = 0;
    // Linear Rec. 709 with straight alpha, filtered over the footprint, to r, g, b, a[count]. Any thread.
    virtual void sample(uint64_t texture, size_t count, const TextureCoordinates& at, float* const rgba[4]) = 0;
    // OpenEXR, 32-bit float.
    virtual void write_exr(const std::string& path, const Picture& picture) = 0;
    // PNG, 8 bits; values are already display-referred, 0 to 1, straight alpha.
    virtual void write_png(const std::string& path, const Picture& picture) = 0;
};

// Loads the module that lies beside this library; throws Error where it cannot. Any thread.
ImageModule& image_module();

// The module's one symbol.
using CreateImageModule = ImageModule* (*)();
inline constexpr const char* kCreateImageModule = "triptych_create_image_module";

}  // namespace trp
