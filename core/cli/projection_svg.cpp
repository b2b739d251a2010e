// Nusselt's analog as a drawing. SPDX-License-Identifier: Apache-2.0
#include "projection_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "radiosity_job.h"
#include "report.h"
#include "svg.h"

namespace triptych::cli {
namespace {

using Point = std::array<double, 3>;  // of the unit hemisphere

constexpr double kRadius = 300, kMiddle = 310;  // of the circle on the page

struct Outline {
    uint32_t element = 0;
    std::vector<Point> corners;
    double form_factor = 0, distance = 0;
};

std::vector<float> read_values(TrpRadiosity* radiosity, const char* name, size_t count) {
    std::vector<float> out(count);
    check(trp_radiosity_read(radiosity, name, out.data(), out.size()));
    return out;
}

// Farthest first.
std::vector<Outline> outlines_about(TrpRadiosity* radiosity, uint32_t element) {
    const TrpRadiosityInfo info = info_of(radiosity);
    const std::vector<float> centres = read_values(radiosity, "centre", size_t{info.element_count} * 3);
    std::vector<Point> corners(2 * size_t{info.corner_count});
    std::vector<Outline> out;
    for (uint32_t k = 0; k < info.element_count; ++k) {
        Outline outline{k, {}, 0, 0};
        size_t used = 0;
        check(trp_radiosity_outline(radiosity, element, k, corners.data()->data(), corners.size(), &used,
                                    &outline.form_factor));
        if (used == 0) continue;
        outline.corners.assign(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(used));
        for (size_t c = 0; c < 3; ++c)
            outline.distance += std::pow(static_cast<double>(centres[3 * k + c] - centres[3 * element + c]), 2);
        out.push_back(std::move(outline));
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const Outline& a, const Outline& b) { return a.distance > b.distance; });
    return out;
}

// A great circle comes down as an ellipse about the middle, whose long axis is 1.
std::string arc(const Point& from, const Point& to) {
    const Point pole = {from[1] * to[2] - from[2] * to[1], from[2] * to[0] - from[0] * to[2],
                        from[0] * to[1] - from[1] * to[0]};
    const double length = std::hypot(pole[0], pole[1], pole[2]);
    const std::string end = fmt::format("{:.6f} {:.6f}", kMiddle + kRadius * to[0], kMiddle - kRadius * to[1]);
    const double across = length > 0 ? std::abs(pole[2]) / length : 0;
    if (across < 1e-6) return "L" + end;
    const double turn = 90 - std::atan2(pole[1], pole[0]) * 180 / std::numbers::pi;
    return fmt::format("A{:.6f} {:.6f} {:.6f} 0 {} {}", kRadius, kRadius * across, turn, pole[2] > 0 ? 0 : 1, end);
}

}  // namespace

void write_projection_svg(TrpRadiosity* radiosity, uint32_t element, const std::string& path) {
    const std::vector<float> reflectances =
        read_values(radiosity, "reflectance", size_t{info_of(radiosity).element_count} * 3);
    std::string out = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{0:.0f}\" viewBox=\"0 0 {0:.0f} "
        "{0:.0f}\" font-family=\"sans-serif\" font-size=\"11\" text-anchor=\"middle\">\n"
        "<title>What element {1} sees, on its hemisphere's base circle</title>\n"
        "<circle cx=\"{2:.0f}\" cy=\"{2:.0f}\" r=\"{3:.0f}\" fill=\"#222\" stroke=\"#000\"/>\n",
        2 * kMiddle, element, kMiddle, kRadius);
    for (const Outline& outline : outlines_about(radiosity, element)) {
        const float* reflectance = &reflectances[3 * size_t{outline.element}];
        const Point& first = outline.corners.front();
        std::string curve = fmt::format("M{:.6f} {:.6f}", kMiddle + kRadius * first[0], kMiddle - kRadius * first[1]);
        double x = 0, y = 0;
        for (size_t k = 0; k < outline.corners.size(); ++k) {
            const Point& here = outline.corners[k];
            x += here[0], y += here[1];
            curve += arc(here, outline.corners[(k + 1) % outline.corners.size()]);
        }
        const auto count = static_cast<double>(outline.corners.size());
        out += fmt::format(
            "<path d=\"{}Z\" fill=\"{}\" stroke=\"#000\" stroke-width=\"0.8\"><title>element {}: F = "
            "{:.10f}</title></path>\n",
            curve, page_color({reflectance[0], reflectance[1], reflectance[2]}), outline.element, outline.form_factor);
        if (outline.form_factor >= 0.01)
            out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" fill=\"{}\">{:.4f}</text>\n",
                               kMiddle + kRadius * x / count, kMiddle - kRadius * y / count + 4,
                               reflectance[1] < 0.2F ? "#fff" : "#000", outline.form_factor);
    }
    write_file(path, out + "</svg>\n");
}

}  // namespace triptych::cli
