/* The header as a C99 client sees it: compiles with -pedantic -Werror, links, and renders a triangle. */
#include <stdio.h>

#include "triptych/triptych.h"

#define CHECK(call)                                                  \
    do {                                                             \
        if ((call) != TRP_OK) {                                      \
            fprintf(stderr, "%s: %s\n", #call, trp_error_message()); \
            return 1;                                                \
        }                                                            \
    } while (0)

static int32_t count_call(void* user, const TrpProgress* progress) {
    ++*(int*)user;
    return progress->fraction <= 1.0;
}

int main(void) {
    static const float positions[9] = {-1, -1, -5, 1, -1, -5, 0, 1, -5};
    static const uint8_t corners[3] = {0, 1, 2};
    static float pixels[16 * 16 * 4];
    TrpScene* scene = NULL;
    TrpRender* render = NULL;
    TrpMeshDesc mesh;
    TrpInstanceDesc instance;
    TrpMaterialDesc material;
    TrpCameraDesc camera;
    TrpCallbacks callbacks;
    uint32_t material_id, camera_id, instance_id;
    int calls = 0;

    if (trp_version() != TRP_VERSION) return 1;
    CHECK(trp_scene_create(&scene));
    CHECK(trp_material_desc_init(&material, sizeof material));
    material.emission.value[0] = 2.0f;
    CHECK(trp_material_add(scene, &material, &material_id));
    CHECK(trp_mesh_desc_init(&mesh, sizeof mesh));
    mesh.positions.data = positions;
    mesh.positions.count = 3;
    mesh.corner_vertices.data = corners;
    mesh.corner_vertices.count = 3;
    mesh.corner_vertices.format = TRP_FORMAT_UINT8;
    mesh.materials = &material_id;
    mesh.material_count = 1;
    CHECK(trp_instance_desc_init(&instance, sizeof instance));
    CHECK(trp_mesh_add(scene, &mesh, &instance.mesh));
    CHECK(trp_instance_add(scene, &instance, &instance_id));
    CHECK(trp_camera_desc_init(&camera, sizeof camera));
    CHECK(trp_camera_add(scene, &camera, &camera_id));
    CHECK(trp_scene_set_camera(scene, camera_id));
    CHECK(trp_scene_commit(scene, 0));

    CHECK(trp_render_create(scene, "ray_casting", &render));
    trp_scene_destroy(scene);
    CHECK(trp_render_set_film(render, 16, 16, 0, 0, 0, 0));
    CHECK(trp_render_set(render, "samples", "4"));
    CHECK(trp_callbacks_init(&callbacks, sizeof callbacks));
    callbacks.user = &calls;
    callbacks.progress = count_call;
    CHECK(trp_render_run(render, &callbacks));
    CHECK(trp_render_read(render, "Combined", 0, 0, 16, 16, pixels, sizeof pixels / sizeof pixels[0]));
    trp_render_destroy(render);
    if (calls == 0) {
        fprintf(stderr, "no progress was told\n");
        return 1;
    }
    if (pixels[(8 * 16 + 8) * 4] != 2.0f || pixels[0] != 0.0f) {
        fprintf(stderr, "the triangle is not in the picture\n");
        return 1;
    }
    if (trp_scene_commit(NULL, 0) != TRP_ERROR_ARGUMENT) return 1;
    return 0;
}
