// How many links the hierarchy needs for a certain error.
#include "support/radiosity_scenes.h"

namespace trp_test {
namespace {

TEST(RadiosityLinks, StayAsTheyAreWhereElementsMayBeSmaller) {
    // From 6144 to 393216 elements that there may be on the faces of a cube: they are as small as the error asks for,
    // and not one link is added.
    Scene scene;
    add_cube(scene, wall(scene, 0.3f, 1), wall(scene, 0.7f));
    scene.object(box({0.25f, 0.3f, 0.3f}, {0.55f, 0.7f, 0.7f}), wall(scene, 0.4f));
    uint64_t links = 0;
    for (int level = 5; level <= 8; ++level) {
        Solution::Settings settings = by("hierarchical");
        settings.insert(settings.end(), {{"radiosity.element_size", std::to_string(std::ldexp(1.0, -level))},
                                         {"radiosity.tolerance", "0.01"}});
        Solution solution(scene, settings);
        const TrpRadiosityInfo info = solution.solve().info();
        EXPECT_LE(info.residual, 0.01) << level;
        if (links > 0) {
            EXPECT_EQ(info.links, links) << level;
        }
        links = info.links;
    }
    EXPECT_LT(links, 6144u);
}

}  // namespace
}  // namespace trp_test
