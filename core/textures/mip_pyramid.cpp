#include "textures/mip_pyramid.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"

namespace trp {
namespace {

float linear_from_srgb(float c) {
    return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}

// Of all 16-bit numbers, which hold those of 8 bits.
const std::vector<uint16_t>& linear_from_srgb_table() {
    static const std::vector<uint16_t> table = [] {
        std::vector<uint16_t> t(65536);
        for (size_t i = 0; i < t.size(); ++i)
            t[i] = static_cast<uint16_t>(std::lround(65535 * linear_from_srgb(static_cast<float>(i) / 65535)));
        return t;
    }();
    return table;
}

// A file may hold anything, and one texel that is no number would spread over every level.
uint16_t finite(uint16_t c) {
    return c;
}
float finite(float c) {
    return std::isfinite(c) ? c : 0;
}

uint16_t linear(uint16_t c) {
    static const std::vector<uint16_t>& table = linear_from_srgb_table();
    return table[c];
}
float linear(float c) {
    return linear_from_srgb(c);
}

// One row of a picture with any number of channels to RGBA.
template <class T>
void expand_row(const T* in, uint32_t width, uint32_t channels, bool srgb, T one, T* out) {
    const bool has_alpha = channels == 2 || channels == 4, grey = channels < 3;
    for (uint32_t x = 0; x < width; ++x, in += channels, out += 4) {
        for (int c = 0; c < 3; ++c) {
            const T value = finite(in[grey ? 0 : c]);
            out[c] = srgb ? linear(value) : value;
        }
        out[3] = has_alpha ? finite(in[channels - 1]) : one;
    }
}

// What a texel of the next level takes from this one's along an axis: the share of each that it covers, at most three.
struct Cover {
    uint32_t first = 0;
    std::array<float, 3> weights{};
    int count = 0;
};

std::vector<Cover> covers(uint32_t size, uint32_t next) {
    std::vector<Cover> out(next);
    const double step = static_cast<double>(size) / next;
    for (uint32_t i = 0; i < next; ++i) {
        const double begin = i * step, end = (i + 1) * step;
        Cover& cover = out[i];
        cover.first = static_cast<uint32_t>(begin);
        for (uint32_t k = cover.first; k < size && k < end - 1e-6 && cover.count < 3; ++k)
            cover.weights[cover.count++] =
                static_cast<float>((std::min<double>(end, k + 1) - std::max<double>(begin, k)) / step);
    }
    return out;
}

uint16_t stored(float value, uint16_t) {
    return static_cast<uint16_t>(std::lrintf(value));
}
float stored(float value, float) {
    return value;
}

template <class T>
void shrink(const T* in, uint32_t width, uint32_t height, T* out, uint32_t next_width, uint32_t next_height) {
    const std::vector<Cover> columns = covers(width, next_width), rows = covers(height, next_height);
    parallel_ranges(next_height, 16, [&](size_t begin, size_t end) {
        for (size_t y = begin; y < end; ++y)
            for (uint32_t x = 0; x < next_width; ++x) {
                float sum[4] = {};
                for (int j = 0; j < rows[y].count; ++j)
                    for (int i = 0; i < columns[x].count; ++i) {
                        const float weight = rows[y].weights[j] * columns[x].weights[i];
                        const T* texel = in + 4 * (size_t{rows[y].first + j} * width + columns[x].first + i);
                        for (int c = 0; c < 4; ++c) sum[c] += weight * static_cast<float>(texel[c]);
                    }
                for (int c = 0; c < 4; ++c) out[4 * (y * next_width + x) + c] = stored(sum[c], T{});
            }
    });
}

template <class T>
std::vector<T> make_levels(const std::vector<T>& values, const PixelArray& picture, bool srgb, T one,
                           std::vector<int32_t>& offsets) {
    uint32_t width = picture.width, height = picture.height;
    auto next = [](uint32_t side) { return std::max(side / 2, 1u); };
    size_t texels = 0;
    for (uint32_t w = width, h = height;; w = next(w), h = next(h)) {
        offsets.push_back(static_cast<int32_t>(texels));
        texels += size_t{w} * h;
        if (w == 1 && h == 1) break;
    }
    std::vector<T> out(4 * texels);
    parallel_ranges(height, 16, [&](size_t begin, size_t end) {
        for (size_t y = begin; y < end; ++y)
            expand_row(&values[y * width * picture.channels], width, picture.channels, srgb, one, &out[4 * y * width]);
    });
    for (size_t level = 1; level < offsets.size(); ++level) {
        shrink(&out[4 * size_t(offsets[level - 1])], width, height, &out[4 * size_t(offsets[level])], next(width),
               next(height));
        width = next(width), height = next(height);
    }
    return out;
}

}  // namespace

MipPyramid::MipPyramid(const PixelArray& picture, bool srgb) : width_(picture.width), height_(picture.height) {
    if (!picture.integers.empty())
        integers_ = make_levels<uint16_t>(picture.integers, picture, srgb, 65535, offsets_);
    else
        floats_ = make_levels<float>(picture.floats, picture, srgb, 1.0f, offsets_);
}

}  // namespace trp
