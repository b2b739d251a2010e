// The header as a C++11 client sees it: compiles with -pedantic -Werror, links and answers.
#include "triptych/triptych.h"

static_assert(sizeof(TrpStatus) == 4, "enumerations are 32 bits wide");
static_assert(sizeof(TrpCoefficient) == 16, "no padding in a coefficient");

int main() {
    TrpScene* scene = nullptr;
    if (trp_version() != TRP_VERSION || trp_scene_create(&scene) != TRP_OK) return 1;
    const TrpStatus status = trp_scene_commit(scene, 1);
    trp_scene_destroy(scene);
    return status == TRP_OK ? 0 : 1;
}
