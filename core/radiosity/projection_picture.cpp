#include "radiosity/projection_picture.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "base/parallel.h"
#include "radiosity/element_rays.h"
#include "radiosity/hemicube.h"

namespace trp {
namespace {

// Takes what a pixel sees, and keeps what counts for most.
class Seen {
  public:
    explicit Seen(ProjectionPicture& picture) : picture_(picture), best_(picture.elements.size(), 0.0f) {}
    void take(size_t pixel, uint32_t element, const Vec3& weight) {
        const float bright = luminance(weight);
        if (!(bright > best_[pixel])) return;
        best_[pixel] = bright;
        picture_.elements[pixel] = element;
    }

  private:
    ProjectionPicture& picture_;
    std::vector<float> best_;
};

// Where a pixel of a hemicube's face lies in the cross.
std::array<uint32_t, 2> in_cross(int face, uint32_t resolution, uint32_t x, uint32_t y) {
    const uint32_t half = resolution / 2, last = resolution - 1;
    switch (face) {
        case 0:
            return {half + last - x, half + y};
        case 1:
            return {half + resolution + last - y, half + last - x};
        case 2:
            return {half + x, half + resolution + last - y};
        case 3:
            return {y - half, half + x};
        default:
            return {half + last - x, y - half};
    }
}

void draw_hemicube(const FormFactorJob& job, uint32_t element, ProjectionPicture& out) {
    const uint32_t resolution = job.settings.hemicube_resolution;
    const auto place = [&](int face, uint32_t x, uint32_t y) {
        const auto [column, row] = in_cross(face, resolution, x, y);
        return size_t{row} * out.side + column;
    };
    Seen seen(out);
    std::vector<HemicubePixel> pixels[kHemicubeFaces];
    parallel_ranges(kHemicubeFaces, 1, [&](size_t begin, size_t end) {
        for (size_t face = begin; face < end; ++face)
            draw_hemicube_face(job, element, static_cast<int>(face), pixels[face]);
    });
    for (int face = 0; face < kHemicubeFaces; ++face) {
        for (uint32_t y = face == 0 ? 0 : resolution / 2; y < resolution; ++y)
            for (uint32_t x = 0; x < resolution; ++x)
                out.shares[place(face, x, y)] = static_cast<float>(delta_form_factor(face, resolution, x, y));
        for (const HemicubePixel& pixel : pixels[face])
            seen.take(place(face, pixel.x, pixel.y), pixel.element, pixel.weight);
    }
}

void draw_circle(const FormFactorJob& job, uint32_t element, ProjectionPicture& out) {
    const ElementFrame frame = frame_of(job.elements, element);
    const Vec3 origin = frame.middle + frame.z * clearance(frame.middle);
    const float step = 2 / static_cast<float>(out.side), share = step * step / std::numbers::pi_v<float>;
    Seen seen(out);
    parallel_ranges(out.side, 4, [&](size_t begin, size_t end) {
        const auto tracer = std::make_unique<ElementTracer>(job.elements);
        std::vector<ElementRay> rays;
        std::vector<ElementHit> hits;
        for (size_t row = begin; row < end && !*job.cancelled; ++row) {
            rays.clear();
            hits.clear();
            for (uint32_t column = 0; column < out.side; ++column) {
                const float x = (static_cast<float>(column) + 0.5f) * step - 1,
                            y = (static_cast<float>(row) + 0.5f) * step - 1, z2 = 1 - x * x - y * y;
                if (!(z2 > 0)) continue;
                const auto pixel = static_cast<uint32_t>(row * out.side + column);
                out.shares[pixel] = share;
                rays.push_back({origin, (frame.x * x + frame.y * y + frame.z * std::sqrt(z2)).normalized(), pixel});
            }
            *job.rays += tracer->trace(rays, hits);
            for (const ElementHit& hit : hits)
                if (hit.element != kNoElement) seen.take(hit.id, hit.element, hit.weight);
        }
    });
}

// A shade, so that neighbours of one material can be told apart.
float shade_of(uint32_t element) {
    return 0.4f + 0.6f * static_cast<float>((element * 0x9E3779B9u) >> 8) / 0x1p24f;
}

}  // namespace

ElementFrame frame_of(const Elements& elements, uint32_t element) {
    const Vec3 z = elements.normal(element), x = perpendicular_to(z);
    return {elements[element].centre, x, z.cross(x), z};
}

ProjectionPicture make_projection_picture(const FormFactorJob& job, uint32_t element) {
    ProjectionPicture out;
    out.side = 2 * job.settings.hemicube_resolution;
    out.elements.assign(size_t{out.side} * out.side, kNoElement);
    out.shares.assign(out.elements.size(), 0.0f);
    if (job.settings.form_factors == FormFactors::hemicube)
        draw_hemicube(job, element, out);
    else
        draw_circle(job, element, out);
    return out;
}

Picture draw_projection(const ProjectionPicture& projection, std::span<const Vec3> reflectances,
                        std::span<const float> numbers) {
    constexpr float kSky = 0.01f, kLeast = 0.1f;  // what is black is still seen
    Picture out;
    out.width = out.height = out.window_width = out.window_height = projection.side;
    for (const char* channel : {"Combined.R", "Combined.G", "Combined.B", "Combined.A", "Element.X", "FormFactor.X"})
        out.channels.push_back(std::string("ViewLayer.") + channel);
    for (uint32_t row = projection.side; row-- > 0;)
        for (uint32_t column = 0; column < projection.side; ++column) {
            const size_t pixel = size_t{row} * projection.side + column;
            const uint32_t element = projection.elements[pixel];
            const bool inside = projection.shares[pixel] > 0, seen = element != kNoElement;
            const float shade = seen ? shade_of(element) : kSky;
            for (int c = 0; c < 3; ++c) {
                const float color = seen ? std::lerp(kLeast, 1.0f, reflectances[element][c]) : 1;
                out.values.push_back(inside ? shade * color : 0);
            }
            out.values.insert(out.values.end(),
                              {inside ? 1.0f : 0.0f, seen ? numbers[element] : -1.0f, projection.shares[pixel]});
        }
    return out;
}

std::vector<Vec3d> project_polygon(const ElementFrame& frame, std::span<const Vec3d> polygon) {
    const Vec3d middle(frame.middle), axes[3] = {Vec3d(frame.x), Vec3d(frame.y), Vec3d(frame.z)};
    std::vector<Vec3d> corners;
    Vec3d normal(0, 0, 0);
    for (const Vec3d& corner : polygon) {
        const Vec3d way = corner - middle;
        corners.emplace_back(axes[0].dot(way), axes[1].dot(way), axes[2].dot(way));
    }
    for (size_t k = 1; k + 1 < corners.size(); ++k)
        normal += (corners[k] - corners[0]).cross(corners[k + 1] - corners[0]);
    std::vector<Vec3d> out;
    if (corners.empty() || !(normal.dot(corners[0]) < 0)) return out;
    // Backwards: what is counter-clockwise from below is not so from outside.
    for (size_t k = corners.size(); k-- > 0;) {
        const Vec3d &here = corners[k], &next = corners[(k + corners.size() - 1) % corners.size()];
        if (here.z >= 0) out.push_back(here.normalized());
        if ((here.z >= 0) == (next.z >= 0)) continue;
        Vec3d cut = here + (next - here) * (here.z / (here.z - next.z));
        cut.z = 0;
        out.push_back(cut.normalized());
    }
    // What only touches the horizon is not seen.
    const bool above = std::any_of(out.begin(), out.end(), [](const Vec3d& p) { return p.z > 0; });
    if (!above) out.clear();
    return out;
}

}  // namespace trp
