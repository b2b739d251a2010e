// A mesh made ready to be hit: its triangles and its normals. Made once for a mesh, never changed, shared by snapshots.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "geometry/edges.h"
#include "geometry/normals.h"

namespace trp {

// Which shading normals: the mesh's own, averages over the faces around each position, or those of the faces.
enum class NormalChoice { mesh, plain_average, angle_average, area_average, flat };

class Surface {
  public:
    explicit Surface(std::shared_ptr<const Mesh> mesh);

    const Mesh& mesh() const { return *mesh_; }
    const std::shared_ptr<const Mesh>& mesh_handle() const { return mesh_; }
    uint32_t triangle_count() const { return triangle_count_; }
    // Three vertices to a triangle. For a mesh of triangles these are the mesh's own arrays.
    const uint32_t* triangle_vertices() const {
        return mesh_->triangles_only() ? mesh_->corner_vertices.data() : triangle_vertices_.data();
    }
    // Three corners to a triangle, and its face; null for a mesh of triangles: corners 3t … 3t + 2, face t.
    const uint32_t* triangle_corners() const { return mesh_->triangles_only() ? nullptr : triangle_corners_.data(); }
    const uint32_t* triangle_faces() const { return mesh_->triangles_only() ? nullptr : triangle_faces_.data(); }
    // As chosen; faces that are flat by their flags stay so. The mesh's own are those it came with, or without them,
    // averages over the smooth faces around a vertex that sharp edges do not part. Averages that are asked for weld
    // vertices and are made on first use. Any thread.
    const NormalLayer& normals(NormalChoice choice) const;
    // The triangles in groups, for projection. Made on first use. Any thread.
    const ClusterSet& clusters() const;
    // The mesh's edges. Made on first use. Any thread.
    const EdgeSet& edges() const;
    bool mixed_smooth() const { return mixed_smooth_; }  // some faces are flat in spite of their normals
    // Of the triangles, or where there are none, of the mesh's own edges; at the first time sample.
    const Bounds& bounds() const { return bounds_; }
    uint32_t dropped_faces() const { return dropped_faces_; }  // without area
    uint64_t bytes() const;                                    // held beside the mesh, what was made on first use too

  private:
    void make_triangles();

    std::shared_ptr<const Mesh> mesh_;
    std::vector<uint32_t> triangle_vertices_, triangle_corners_, triangle_faces_;
    std::vector<Vec3> normal_values_;
    NormalLayer normals_;
    Bounds bounds_;
    uint32_t triangle_count_ = 0, dropped_faces_ = 0;
    bool mixed_smooth_ = false, all_flat_ = false;
    struct Averaged {
        std::once_flag once;
        std::vector<Vec3> values;
        NormalLayer layer;
    };
    mutable Averaged averaged_[3];  // by NormalWeight
    mutable std::once_flag clusters_once_;
    mutable ClusterSet clusters_;
    mutable std::once_flag edges_once_;
    mutable EdgeSet edges_;
    mutable std::atomic<uint64_t> bytes_on_use_ = 0;
};

}  // namespace trp
