// Links of a radiosity solution as a drawing. SPDX-License-Identifier: Apache-2.0
#include "links_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>

#include "report.h"
#include "svg.h"

namespace triptych::cli {
namespace {

using Point = std::array<float, 3>;

constexpr float kNear = 1e-3F;  // metres before the camera: what lies behind is cut off

const char* level_color(int32_t level) {
    static constexpr const char* kColors[] = {"#e8e8e8", "#ff4d4d", "#ffb02e", "#3ddc5a", "#36c5f0", "#b388ff"};
    return kColors[std::clamp(level + 1, 0, 5)];
}

// On the film, with the depth.
Point project(const TrpRender* render, const Point& position) {
    Point film{};
    check(trp_render_project(render, position.data(), 1, film.data()));
    return film;
}

struct Line {
    Point from, to;
};
std::optional<Line> line_of(const TrpRender* render, const TrpRadiosityLink& link) {
    Point ends[2] = {{link.from[0], link.from[1], link.from[2]}, {link.to[0], link.to[1], link.to[2]}};
    const float depths[2] = {project(render, ends[0])[2], project(render, ends[1])[2]};
    if (depths[0] < kNear && depths[1] < kNear) return std::nullopt;
    for (size_t k = 0; k < 2; ++k) {
        if (depths[k] >= kNear) continue;
        const float share = (kNear - depths[k]) / (depths[1 - k] - depths[k]);
        for (size_t c = 0; c < 3; ++c) ends[k][c] += (ends[1 - k][c] - ends[k][c]) * share;
    }
    return Line{project(render, ends[0]), project(render, ends[1])};
}

// What the render has drawn, as a PNG file's bytes.
std::string picture_of(const TrpRender* render, const std::string& path) {
    const std::string beside = path + ".png";
    check(trp_render_write(render, beside.c_str()));
    const std::filesystem::path file = std::filesystem::u8path(beside);
    std::string bytes;
    {
        std::ifstream stream(file, std::ios::binary);
        bytes.assign(std::istreambuf_iterator<char>(stream), {});
    }
    std::filesystem::remove(file);
    return bytes;
}

}  // namespace

void write_links_svg(const TrpRender* render, uint32_t width, uint32_t height,
                     const std::vector<TrpRadiosityLink>& links, const std::string& path) {
    const std::string picture = picture_of(render, path);
    std::string out = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\">\n"
        "<image width=\"{0}\" height=\"{1}\" href=\"data:image/png;base64,{2}\"/>\n"
        "<g stroke-width=\"1\" stroke-opacity=\"0.7\">\n",
        width, height, base64(picture));
    const auto up = static_cast<float>(height);
    for (const TrpRadiosityLink& link : links) {
        const auto line = line_of(render, link);
        if (!line) continue;
        const char* color = level_color(link.level);
        out += fmt::format(
            "<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"{}\"><title>{}: {:.3g} {:.3g} {:.3g}</title></path>"
            "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2\" fill=\"{}\"/>\n",
            line->from[0], up - line->from[1], line->to[0], up - line->to[1], color,
            link.level < 0 ? "group" : fmt::format("level {}", link.level), link.factor[0], link.factor[1],
            link.factor[2], line->to[0], up - line->to[1], color);
    }
    write_file(path, out + "</g>\n</svg>\n");
}

}  // namespace triptych::cli
