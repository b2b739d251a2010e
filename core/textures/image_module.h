// The door to the image library. Pictures are read and written by a module of its own, loaded when a file is first
// touched: OpenImageIO with all that it links takes 0.3-0.7 s to load, which `triptych methods` and scenes without
// image files need not pay, and a slimmer module can take its place.
//
// The module throws std::runtime_error with a line that says what is wrong; it does not know the core's types.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace trp {

// A picture file: a path, or the file's bytes.
struct ImageSource {
    std::string path;
    const unsigned char* file = nullptr;  // null: the path counts
    size_t file_size = 0;
};

// A picture as its file has it: interleaved, row 0 at the bottom, straight alpha, 1 to 4 channels (grey, grey and
// alpha, RGB, RGBA). One of the two arrays holds it.
struct PixelArray {
    uint32_t width = 0, height = 0, channels = 0;
    bool srgb = false;               // as the file says; not so for alpha
    std::vector<uint16_t> integers;  // of files with integers; 65535 is 1
    std::vector<float> floats;       // of all others
};

// A picture to write: interleaved floats, row 0 at the top, in a window of a larger picture.
struct Picture {
    uint32_t width = 0, height = 0;                                            // of the whole picture
    uint32_t window_x = 0, window_y = 0, window_width = 0, window_height = 0;  // from the top left
    std::vector<std::string> channels;
    std::vector<float> values;  // window_height · window_width · channels
};

// Any thread.
class ImageModule {
  public:
    virtual ~ImageModule() = default;
    // Refuses pictures of more than `most_pixels`.
    virtual PixelArray read(const ImageSource& source, uint64_t most_pixels) = 0;
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
