// A tree of rays as a drawing. SPDX-License-Identifier: Apache-2.0
#include "ray_tree_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report.h"
#include "svg.h"

namespace triptych::cli {
namespace {

constexpr double column = 168, level = 120, margin = 30, box_width = 152, box_height = 62;

struct Place {
    double x = 0, y = 0;
};

// Leaves side by side, parents above the middle of their children.
std::vector<Place> lay_out(const RayTree& tree, double& width, double& height) {
    std::vector<Place> places(tree.rays.size());
    std::vector<std::pair<size_t, bool>> open = {{0, false}};
    std::vector<size_t> levels(tree.rays.size(), 0);
    size_t leaves = 0, deepest = 0;
    while (!open.empty()) {
        const auto [at, done] = open.back();
        open.pop_back();
        const std::vector<size_t>& children = tree.children[at];
        if (done) {
            places[at].x = (places[children.front()].x + places[children.back()].x) / 2;
            continue;
        }
        // The root's level is that of I_pixel.
        levels[at] = tree.rays[at].parent == TRP_NO_PARENT ? 1 : levels[tree.rays[at].parent] + 1;
        deepest = std::max(deepest, levels[at]);
        places[at].y = margin + static_cast<double>(levels[at]) * level;
        if (children.empty()) {
            places[at].x = margin + (static_cast<double>(leaves++) + 0.5) * column;
            continue;
        }
        open.emplace_back(at, true);
        for (size_t c = children.size(); c-- > 0;) open.emplace_back(children[c], false);
    }
    width = 2 * margin + static_cast<double>(leaves) * column;
    height = 2 * margin + static_cast<double>(deepest) * level + box_height;
    return places;
}

std::string triple(const float (&v)[3]) {
    return fmt::format("{:.3g} {:.3g} {:.3g}", v[0], v[1], v[2]);
}

std::string text(double x, double y, const std::string& words, const char* style = "") {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\"{}>{}</text>\n", x, y, style, words);
}

std::string shortened(const std::string& name, size_t most) {
    if (name.size() <= most) return name;
    size_t end = most - 1;
    while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0) == 0x80) --end;  // not within a letter
    return name.substr(0, end) + "…";
}

const char* branch_color(const TrpRay& ray) {
    return ray.kind == TRP_RAY_REFLECTION ? "#c0392b" : ray.kind == TRP_RAY_TRANSMISSION ? "#2471a3" : "#333333";
}

std::string draw_ray(const TrpRay& ray, const Place& from, const Place& to) {
    const bool open = ray.end == TRP_END_DEPTH || ray.end == TRP_END_WEIGHT;
    std::string out =
        fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"{}\" stroke-width=\"1.6\" fill=\"none\"{}/>\n",
                    from.x, from.y, to.x, to.y, branch_color(ray), open ? " stroke-dasharray=\"5 4\"" : "");
    if (ray.kind == TRP_RAY_PRIMARY) return out;
    const double x = (from.x + 2 * to.x) / 3, y = (from.y + 2 * to.y) / 3;
    const std::string words = fmt::format("{} {}", ray.kind == TRP_RAY_REFLECTION ? "R" : "T", triple(ray.weight));
    const double half = 2.9 * static_cast<double>(words.size());
    out += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"13\" fill=\"#fff\"/>\n", x - half,
                       y - 13, 2 * half);
    out += text(x, y - 3, words);
    return out;
}

std::string draw_end(const TrpRay& ray, const Place& at) {
    const double left = at.x - box_width / 2;
    if (ray.end != TRP_END_SURFACE) {
        const char* const names[] = {"", "light", "I_back", "depth", "weight"};
        std::string out = text(at.x, at.y + 14, names[ray.end], " class=\"n\"");
        if (ray.end == TRP_END_LIGHT || ray.end == TRP_END_BACKGROUND) {
            out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"6\" fill=\"{}\" stroke=\"#333\"/>\n", at.x,
                               at.y + 28, page_color(ray.intensity));
            out += text(at.x, at.y + 50, triple(ray.intensity));
        }
        return out;
    }
    std::string out = fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{}\" rx=\"5\" fill=\"#fff\" stroke=\"#333\"/>\n"
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"12\" height=\"{}\" rx=\"5\" fill=\"{}\" stroke=\"#333\"/>\n",
        left, at.y, box_width, box_height, left, at.y, box_height, page_color(ray.intensity));
    const std::string object = ray.object, material = ray.material;
    const double x = at.x + 6;
    out += text(x, at.y + 14, escaped(shortened(object.empty() ? material : object, 20)), " class=\"n\"");
    out += text(x, at.y + 28, fmt::format("{:.4g} m", ray.distance));
    out += text(x, at.y + 42, "local " + triple(ray.local));
    out += text(x, at.y + 56, "I " + triple(ray.intensity));
    return out;
}

}  // namespace

void write_tree_svg(const RayTree& tree, const std::string& path) {
    double width = 0, height = 0;
    const std::vector<Place> places = lay_out(tree, width, height);
    std::string out = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
        "{1:.0f}\" font-family=\"sans-serif\" font-size=\"10\" text-anchor=\"middle\">\n"
        "<style>.n{{font-size:12px;font-weight:bold}}</style>\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        width, height);
    const TrpRay& root = tree.rays[0];
    const Place eye = {places[0].x, margin};
    for (size_t k = 0; k < tree.rays.size(); ++k) {
        const TrpRay& ray = tree.rays[k];
        const Place from = ray.parent == TRP_NO_PARENT ? Place{eye.x, eye.y + 40}
                                                       : Place{places[ray.parent].x, places[ray.parent].y + box_height};
        out += draw_ray(ray, from, places[k]);
    }
    out += text(eye.x, eye.y + 12, "I_pixel", " class=\"n\"");
    out += text(eye.x, eye.y + 34, triple(root.intensity));
    for (size_t k = 0; k < tree.rays.size(); ++k) out += draw_end(tree.rays[k], places[k]);
    out += "</svg>\n";
    write_file(path, out);
}

}  // namespace triptych::cli
