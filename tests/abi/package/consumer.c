/* Renders nothing but the sky, and writes it: the image module must lie beside the installed library. */
#include <stdio.h>
#include <triptych/triptych.h>

int main(int count, char** arguments) {
    TrpScene* scene = NULL;
    TrpRender* render = NULL;
    TrpCameraDesc camera;
    uint32_t id = TRP_NO_ID;
    int failed;
    if (count != 2) return 2;
    trp_camera_desc_init(&camera, sizeof camera);
    failed = trp_scene_create(&scene) != TRP_OK || trp_camera_add(scene, &camera, &id) != TRP_OK ||
             trp_scene_set_camera(scene, id) != TRP_OK || trp_scene_commit(scene, 1) != TRP_OK ||
             trp_render_create(scene, "ray_casting", &render) != TRP_OK ||
             trp_render_set_film(render, 16, 16, 0, 0, 0, 0) != TRP_OK || trp_render_run(render, NULL) != TRP_OK ||
             trp_render_write(render, arguments[1]) != TRP_OK;
    if (failed) fprintf(stderr, "%s\n", trp_error_message());
    trp_render_destroy(render);
    trp_scene_destroy(scene);
    return failed;
}
