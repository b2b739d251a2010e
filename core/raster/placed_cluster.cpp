#include "raster/placed_cluster.h"

namespace trp {

double within_bound(const Projection& projection, int bound, const FilmPoint& q) {
    const double scale = projection.perspective() ? q[2] : 1;
    switch (bound) {
        case 0:
            return q[2] - projection.clip_start();
        case 1:
            return q[0] + kGuardBand * scale;
        case 2:
            return (projection.width() + double{kGuardBand}) * scale - q[0];
        case 3:
            return q[1] + kGuardBand * scale;
        default:
            return (projection.height() + double{kGuardBand}) * scale - q[1];
    }
}

}  // namespace trp
