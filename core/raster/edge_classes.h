// Which of a mesh's edges are drawn.
#pragma once

#include "film/settings.h"
#include "film/view.h"
#include "shading/snapshot.h"

namespace trp {

class EdgeClasses {
  public:
    EdgeClasses(const LineSettings& settings, const View& view);
    // Whether the edge of that number is of a class that the settings name.
    bool has(const PlacedSurface& surface, uint32_t edge) const;

  private:
    bool is_silhouette(const PlacedSurface& surface, const Edge& edge) const;
    bool is_crease(const PlacedSurface& surface, const Edge& edge) const;

    const LineSettings& settings_;
    const View& view_;
    float cos_crease_;
};

}  // namespace trp
