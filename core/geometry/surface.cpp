#include "geometry/surface.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "geometry/normals.h"
#include "geometry/triangulate.h"
#include "triptych/triptych.h"

namespace trp {

Surface::Surface(std::shared_ptr<const Mesh> mesh) : mesh_(std::move(mesh)) {
    make_triangles();
    for (size_t i = 0; i < 3 * size_t{triangle_count_}; ++i) bounds_.extend(mesh_->positions[triangle_vertices()[i]]);
    if (triangle_count_ == 0)
        for (const uint32_t v : mesh_->edges) bounds_.extend(mesh_->positions[v]);

    const std::vector<uint8_t>& smooth = mesh_->face_smooth;
    const bool any_smooth = std::any_of(smooth.begin(), smooth.end(), [](uint8_t s) { return s; });
    mixed_smooth_ = any_smooth && std::find(smooth.begin(), smooth.end(), 0) != smooth.end();
    all_flat_ = !smooth.empty() && !any_smooth;
    if (all_flat_) return;
    if (!mesh_->normals.empty()) {
        normal_values_ = unit_normals(*mesh_);
        normals_.domain =
            mesh_->normal_domain == TRP_DOMAIN_CORNER ? NormalLayer::Domain::corner : NormalLayer::Domain::vertex;
        normals_.values = normal_values_.empty() ? mesh_->normals.data() : normal_values_.data();
    } else if (any_smooth) {
        AveragedNormals averaged = averaged_normals(*mesh_, NormalWeight::angle, false);
        normal_values_ = std::move(averaged.values);
        normals_ = {averaged.domain, normal_values_.data()};
    }
}

void Surface::make_triangles() {
    const Mesh& mesh = *mesh_;
    if (mesh.triangles_only()) {
        triangle_count_ = mesh.face_count();
        for (uint32_t t = 0; t < triangle_count_; ++t) {
            const uint32_t* v = &mesh.corner_vertices[3 * t];
            const Vec3 a = mesh.positions[v[0]], n = (mesh.positions[v[1]] - a).cross(mesh.positions[v[2]] - a);
            dropped_faces_ += n == Vec3(0, 0, 0);  // they stay in the shared array; no ray can hit them
        }
        return;
    }
    triangle_vertices_.reserve(3 * mesh.corner_vertices.size());
    triangle_corners_.reserve(3 * mesh.corner_vertices.size());
    triangle_faces_.reserve(mesh.corner_vertices.size());
    std::vector<uint32_t> corners, local;
    std::vector<Vec3> polygon;
    for (uint32_t face = 0; face < mesh.face_count(); ++face) {
        mesh.distinct_corners(face, corners);
        polygon.clear();
        for (const uint32_t c : corners) polygon.push_back(mesh.positions[mesh.corner_vertices[c]]);
        const Vec3d normal = polygon.size() < 3 ? Vec3d(0, 0, 0) : newell(polygon);
        if (normal == Vec3d(0, 0, 0)) {
            ++dropped_faces_;
            continue;
        }
        local.clear();
        triangulate(polygon, normal, local);
        for (const uint32_t i : local) {
            triangle_corners_.push_back(corners[i]);
            triangle_vertices_.push_back(mesh.corner_vertices[corners[i]]);
        }
        triangle_faces_.insert(triangle_faces_.end(), local.size() / 3, face);
    }
    triangle_vertices_.shrink_to_fit();
    triangle_corners_.shrink_to_fit();
    triangle_faces_.shrink_to_fit();
    triangle_count_ = static_cast<uint32_t>(triangle_faces_.size());
}

const NormalLayer& Surface::normals(NormalChoice choice) const {
    static constexpr NormalLayer kFlat;
    if (choice == NormalChoice::mesh) return normals_;
    if (choice == NormalChoice::flat || all_flat_) return kFlat;
    const NormalWeight weight = choice == NormalChoice::plain_average  ? NormalWeight::plain
                                : choice == NormalChoice::area_average ? NormalWeight::area
                                                                       : NormalWeight::angle;
    Averaged& averaged = averaged_[static_cast<int>(weight)];
    std::call_once(averaged.once, [&] {
        AveragedNormals made = averaged_normals(*mesh_, weight, true);
        averaged.values = std::move(made.values);
        averaged.layer = {made.domain, averaged.values.data()};
        bytes_on_use_ += sizeof(Vec3) * averaged.values.size();
    });
    return averaged.layer;
}

const ClusterSet& Surface::clusters() const {
    std::call_once(clusters_once_, [this] {
        clusters_ = make_clusters(*mesh_, 3, triangle_vertices(), triangle_count_, bounds_);
        clusters_.normals.resize(clusters_.primitives.size());
        parallel_ranges(clusters_.normals.size(), 4096, [&](size_t begin, size_t end) {
            for (size_t k = begin; k < end; ++k) {
                const uint32_t* const v = triangle_vertices() + 3 * size_t{clusters_.primitives[k]};
                const Vec3d a(mesh_->positions[v[0]]), b(mesh_->positions[v[1]]), c(mesh_->positions[v[2]]);
                const Vec3d normal = (b - a).cross(c - a).normalized() * 127;
                const auto rounded = [](double x) { return static_cast<int8_t>(std::lround(x)); };
                clusters_.normals[k] = {rounded(normal.x), rounded(normal.y), rounded(normal.z), 0};
            }
        });
        bytes_on_use_ += clusters_.bytes();
    });
    return clusters_;
}

const EdgeSet& Surface::edges() const {
    std::call_once(edges_once_, [this] {
        edges_ = make_edges(*mesh_);
        bytes_on_use_ +=
            sizeof(Edge) * edges_.edges.size() + sizeof(Vec3) * edges_.face_normals.size() + edges_.clusters.bytes();
    });
    return edges_;
}

uint64_t Surface::bytes() const {
    return sizeof(uint32_t) * (triangle_vertices_.size() + triangle_corners_.size() + triangle_faces_.size()) +
           sizeof(Vec3) * normal_values_.size() + bytes_on_use_;
}

}  // namespace trp
