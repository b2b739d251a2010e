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

Picture picture_of(const Film& film, const std::vector<PassId>& passes) {
    Picture picture = empty_picture(film);
    for (const PassId pass : passes)
        for (const char* c = kPasses[pass].channels; *c; ++c)
            picture.channels.push_back(std::string("ViewLayer.") + kPasses[pass].name + "." + *c);
    const size_t stride = picture.channels.size();
    picture.values.resize(size_t{picture.window_width} * picture.window_height * stride);
    size_t first = 0;
    for (const PassId pass : passes) {
        each_pixel(film, pass, [&](uint32_t y, uint32_t x, const float* values) {
            std::copy_n(values, channel_count(pass),
                        &picture.values[(size_t{y} * picture.window_width + x) * stride + first]);
        });
        first += channel_count(pass);
    }
    return picture;
}

Picture png_picture(const Picture& linear) {
    Picture picture;
    // A file of the window alone: PNG readers know no windows.
    picture.width = picture.window_width = linear.window_width;
    picture.height = picture.window_height = linear.window_height;
    picture.channels = {"R", "G", "B", "A"};
    const size_t stride = linear.channels.size();
    for (size_t at = 0; at < linear.values.size(); at += stride) {
        const float* values = &linear.values[at];
        const float alpha = std::clamp(values[3], 0.0f, 1.0f);
        for (int c = 0; c < 3; ++c) picture.values.push_back(srgb_from_linear(alpha > 0 ? values[c] / alpha : 0));
        picture.values.push_back(alpha);
    }
    return picture;
}

std::string extension_of(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    return extension;
}

}  // namespace

void write_picture_file(const Film& film, const std::string& path) {
    write_picture_file(picture_of(film, extension_of(path) == ".png" ? std::vector{kCombined} : film.passes().order()),
                       path);
}

void write_picture_file(const Picture& picture, const std::string& path) {
    namespace fs = std::filesystem;
    const std::string extension = extension_of(path);
    if (extension != ".exr" && extension != ".png")
        fail(TRP_ERROR_ARGUMENT, "{}: a picture is written as .exr or .png, not as \"{}\"", path, extension);
    const std::string unfinished = fmt::format("{}.{}.part", path, getpid());
    try {
        if (extension == ".exr")
            image_module().write_exr(unfinished, picture);
        else
            image_module().write_png(unfinished, png_picture(picture));
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
