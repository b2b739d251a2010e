#include "raster/edge_classes.h"

#include <cmath>

namespace trp {

EdgeClasses::EdgeClasses(const LineSettings& settings, const View& view)
    : settings_(settings), view_(view), cos_crease_(std::cos(settings.crease_angle)) {}

bool EdgeClasses::has(const PlacedSurface& surface, uint32_t number) const {
    if (settings_.all) return true;
    const Edge& edge = surface.surface->edges().edges[number];
    if (settings_.marked && edge.marked) return true;
    if (!edge.manifold) return settings_.borders;
    if (settings_.material_borders && surface.face_material(edge.faces[0]) != surface.face_material(edge.faces[1]))
        return true;
    return (settings_.silhouettes && is_silhouette(surface, edge)) || (settings_.creases && is_crease(surface, edge));
}

// Whether one face is seen from the front and the other from behind.
bool EdgeClasses::is_silhouette(const PlacedSurface& surface, const Edge& edge) const {
    const std::vector<Vec3>& normals = surface.surface->edges().face_normals;
    const Vec3 to_eye = view_.perspective ? view_.position - surface.world_position(edge.vertices[0]) : view_.z;
    const float first = surface.world_from_object.normal(normals[edge.faces[0]]).dot(to_eye),
                second = surface.world_from_object.normal(normals[edge.faces[1]]).dot(to_eye);
    return (first > 0) != ((edge.alike ? -second : second) > 0);
}

bool EdgeClasses::is_crease(const PlacedSurface& surface, const Edge& edge) const {
    const std::vector<Vec3>& normals = surface.surface->edges().face_normals;
    const Vec3 first = surface.world_from_object.normal(normals[edge.faces[0]]).normalized(),
               second = surface.world_from_object.normal(normals[edge.faces[1]]).normalized();
    return first.dot(edge.alike ? -second : second) < cos_crease_;
}

}  // namespace trp
