#include "film/picture_file.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "textures/image_module.h"

namespace trp {
namespace {

float srgb_from_linear(float c) {
    c = std::clamp(c, 0.0f, 1.0f);
    return c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f;
}

Picture empty_picture(const Film& film) {
    const Window& window = film.window();
    Picture picture;
    picture.width = window.width;
    picture.height = window.height;
    picture.window_x = window.x;
    picture.window_y = window.height - window.y - window.h;
    picture.window_width = window.w;
    picture.window_height = window.h;
    return picture;
}

// Calls put(row from the top, column, values of the pixel).
template <class Put>
void each_pixel(const Film& film, PassId pass, Put&& put) {
    const Window& window = film.window();
    const size_t channels = channel_count(pass);
    std::vector<float> row(window.w * channels);
    for (uint32_t y = 0; y < window.h; ++y) {
        film.read(pass, window.x, window.y + window.h - 1 - y, window.w, 1, row.data());
        for (uint32_t x = 0; x < window.w; ++x) put(y, x, &row[x * channels]);
    }
}

Picture exr_picture(const Film& film) {
    Picture picture = empty_picture(film);
    for (const PassId pass : film.passes().order())
        for (const char* c = kPasses[pass].channels; *c; ++c)
            picture.channels.push_back(std::string("ViewLayer.") + kPasses[pass].name + "." + *c);
    const size_t stride = picture.channels.size();
    picture.values.resize(size_t{picture.window_width} * picture.window_height * stride);
    for (const PassId pass : film.passes().order()) {
        const auto first = static_cast<size_t>(film.passes().first_channel(pass));
        each_pixel(film, pass, [&](uint32_t y, uint32_t x, const float* values) {
            std::copy_n(values, channel_count(pass),
                        &picture.values[(size_t{y} * picture.window_width + x) * stride + first]);
        });
    }
    return picture;
}

Picture png_picture(const Film& film) {
    Picture picture = empty_picture(film);
    // A file of the window alone: PNG readers know no windows.
    picture.width = picture.window_width;
    picture.height = picture.window_height;
    picture.window_x = picture.window_y = 0;
    picture.channels = {"R", "G", "B", "A"};
    picture.values.resize(size_t{picture.width} * picture.height * 4);
    each_pixel(film, kCombined, [&](uint32_t y, uint32_t x, const float* values) {
        float* out = &picture.values[(size_t{y} * picture.width + x) * 4];
        const float alpha = std::clamp(values[3], 0.0f, 1.0f);
        for (int c = 0; c < 3; ++c) out[c] = srgb_from_linear(alpha > 0 ? values[c] / alpha : 0);
        out[3] = alpha;
    });
    return picture;
}

}  // namespace

void write_picture_file(const Film& film, const std::string& path) {
    namespace fs = std::filesystem;
    std::string extension = fs::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    if (extension != ".exr" && extension != ".png")
        fail(TRP_ERROR_ARGUMENT, "{}: a picture is written as .exr or .png, not as \"{}\"", path, extension);
    const std::string unfinished = fmt::format("{}.{}.part", path, getpid());
    try {
        if (extension == ".exr")
            image_module().write_exr(unfinished, exr_picture(film));
        else
            image_module().write_png(unfinished, png_picture(film));
        fs::rename(unfinished, path);
    } catch (const std::exception& error) {
        std::error_code ignored;
        fs::remove(unfinished, ignored);
        std::string text = error.what();
        std::replace(text.begin(), text.end(), '\n', ' ');
        fail(TRP_ERROR_FILE, "{} could not be written: {}", path, text);
    }
}

}  // namespace trp
