// Instances, textures, lights, world and cameras of the ABI → plain checked data.
#include <limits>
#include <numbers>

#include "scene/checks.h"
#include "scene/describe.h"

namespace trp {
namespace {

constexpr double kGreatest = std::numeric_limits<float>::max();
constexpr double kPi = std::numbers::pi;
// Metres. Beyond these the rays of an odd film would leave the range of Embree, which may abort then (1.8e18).
constexpr double kGreatestWidth = 1e9, kGreatestAperture = 1e6;

}  // namespace

std::vector<Affine> describe_transforms(const float* rows, uint32_t count, const std::string& what) {
    check_range(what, "time_count", count, 1, kMostTimeSamples);
    std::vector<Affine> out(count);
    if (!rows) return out;
    for (uint32_t i = 0; i < 12 * count; ++i)
        if (!std::isfinite(rows[i])) fail(TRP_ERROR_ARGUMENT, "{}: number {} of the transform is {}", what, i, rows[i]);
    for (uint32_t i = 0; i < count; ++i) out[i] = Affine::from_rows(rows + 12 * i);
    return out;
}

Instance describe(const TrpInstanceDesc& desc, uint32_t id) {
    Instance instance;
    instance.name = text_of(desc.name);
    const std::string what = item_name("instance", id, instance.name);
    instance.mesh = desc.mesh;
    instance.world_from_object = describe_transforms(desc.world_from_object, desc.time_count, what);
    if (desc.material_count && !desc.materials)
        fail(TRP_ERROR_ARGUMENT, "{}: materials is null, with a count of {}", what, desc.material_count);
    check_range(what, "material_count", desc.material_count, 0, 65535);
    instance.materials.assign(desc.materials, desc.materials + desc.material_count);
    check_color(what, "color", desc.color);
    instance.color = {desc.color[0], desc.color[1], desc.color[2]};
    instance.index = desc.index;
    instance.visible_camera = desc.visible_camera;
    instance.visible_shadow = desc.visible_shadow;
    return instance;
}

Texture describe(const TrpTextureDesc& desc, uint32_t id) {
    Texture texture;
    texture.name = text_of(desc.name);
    const std::string what = item_name("texture", id, texture.name);
    const int sources = (desc.path != nullptr) + (desc.file_data != nullptr) + (desc.pixels != nullptr);
    if (sources != 1)
        fail(TRP_ERROR_ARGUMENT, "{}: {} of path, file_data and pixels are given, not one", what, sources);
    check_enum(what, "color_space", desc.color_space, TRP_COLOR_SPACE_LINEAR);
    check_enum(what, "wrap_u", desc.wrap_u, TRP_WRAP_BLACK);
    check_enum(what, "wrap_v", desc.wrap_v, TRP_WRAP_BLACK);
    check_enum(what, "filter", desc.filter, TRP_FILTER_NEAREST);
    texture.color_space = desc.color_space;
    texture.wrap_u = desc.wrap_u;
    texture.wrap_v = desc.wrap_v;
    texture.filter = desc.filter;
    texture.path = text_of(desc.path);
    if (desc.path && texture.path.empty()) fail(TRP_ERROR_ARGUMENT, "{}: path is empty", what);
    if (desc.file_data) {
        if (!desc.file_size) fail(TRP_ERROR_ARGUMENT, "{}: file_size is 0", what);
        const auto* bytes = static_cast<const unsigned char*>(desc.file_data);
        texture.file.assign(bytes, bytes + desc.file_size);
    }
    if (desc.pixels) {
        check_range(what, "width", desc.width, 1, 65536);
        check_range(what, "height", desc.height, 1, 65536);
        check_range(what, "channels", desc.channels, 1, 4);
        const size_t count = static_cast<size_t>(desc.width) * desc.height * desc.channels;
        texture.pixels.assign(desc.pixels, desc.pixels + count);
        for (size_t i = 0; i < count; ++i)
            if (!std::isfinite(texture.pixels[i]))
                fail(TRP_ERROR_ARGUMENT, "{}: pixels[{}] is {}", what, i, texture.pixels[i]);
        texture.width = desc.width;
        texture.height = desc.height;
        texture.channels = desc.channels;
    }
    return texture;
}

Light describe(const TrpLightDesc& desc, uint32_t id) {
    Light light;
    light.name = text_of(desc.name);
    const std::string what = item_name("light", id, light.name);
    check_enum(what, "type", desc.type, TRP_LIGHT_AREA);
    check_enum(what, "falloff", desc.falloff, TRP_FALLOFF_CONSTANT);
    check_enum(what, "shape", desc.shape, TRP_SHAPE_ELLIPSE);
    check_color(what, "emission", desc.emission);
    check_range(what, "radius", desc.radius, 0, kGreatest);
    check_range(what, "angle", desc.angle, -kGreatest, kPi + 1e-5);
    check_range(what, "blend", desc.blend, 0, 1);
    for (const float size : desc.size) check_range(what, "size", size, 0, kGreatest);
    light.type = desc.type;
    light.falloff = desc.falloff;
    light.shape = desc.shape;
    light.world_from_light = describe_transforms(desc.world_from_light, desc.time_count, what);
    light.emission = {desc.emission[0], desc.emission[1], desc.emission[2]};
    light.radius = desc.radius;
    light.angle = desc.angle;
    if (desc.angle < 0)
        light.angle = static_cast<float>(desc.type == TRP_LIGHT_SPOT ? kPi / 4 : desc.type == TRP_LIGHT_AREA ? kPi : 0);
    light.blend = desc.blend;
    light.size[0] = desc.size[0];
    light.size[1] = desc.size[1];
    light.cast_shadow = desc.cast_shadow;
    light.visible_camera = desc.visible_camera;
    light.group = desc.group;
    return light;
}

World describe(const TrpWorldDesc& desc) {
    World world;
    check_color("world", "radiance", desc.radiance);
    world.texture = desc.texture;
    world.radiance = {desc.radiance[0], desc.radiance[1], desc.radiance[2]};
    world.world_from_texture = describe_transforms(desc.world_from_texture, 1, "world")[0];
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b <= a; ++b) {
            const float product = world.world_from_texture.column(a).dot(world.world_from_texture.column(b));
            if (std::abs(product - (a == b ? 1.0f : 0.0f)) > 1e-3f)
                fail(TRP_ERROR_ARGUMENT, "world: world_from_texture is not a rotation");
        }
    world.visible_camera = desc.visible_camera;
    world.light = desc.light;
    return world;
}

Camera describe(const TrpCameraDesc& desc, uint32_t id) {
    Camera camera;
    camera.name = text_of(desc.name);
    const std::string what = item_name("camera", id, camera.name);
    check_enum(what, "type", desc.type, TRP_CAMERA_ORTHOGRAPHIC);
    check_enum(what, "fit", desc.fit, TRP_FIT_VERTICAL);
    check_range(what, "field_of_view", desc.field_of_view, 1e-6, kPi - 1e-4);
    check_range(what, "width", desc.width, 1e-9, kGreatestWidth);
    check_range(what, "shift[0]", desc.shift[0], -1e6, 1e6);
    check_range(what, "shift[1]", desc.shift[1], -1e6, 1e6);
    check_range(what, "clip_start", desc.clip_start, desc.type == TRP_CAMERA_PERSPECTIVE ? 0 : -kGreatest, kGreatest);
    check_range(what, "clip_end", desc.clip_end, -kGreatest, kGreatest);
    if (!(desc.clip_end > desc.clip_start))
        fail(TRP_ERROR_ARGUMENT, "{}: clip_end {} is not beyond clip_start {}", what, desc.clip_end, desc.clip_start);
    check_range(what, "aperture_radius", desc.aperture_radius, 0, kGreatestAperture);
    check_range(what, "focus_distance", desc.focus_distance, 1e-9, kGreatest);
    check_range(what, "blade_count", desc.blade_count, 0, 64);
    check_range(what, "blade_rotation", desc.blade_rotation, -kGreatest, kGreatest);
    check_range(what, "shutter[0]", desc.shutter[0], 0, 1);
    check_range(what, "shutter[1]", desc.shutter[1], desc.shutter[0], 1);
    check_range(what, "pixel_aspect", desc.pixel_aspect, 1e-3, 1e3);
    camera.type = desc.type;
    camera.fit = desc.fit;
    camera.world_from_camera = describe_transforms(desc.world_from_camera, desc.time_count, what);
    camera.field_of_view = desc.field_of_view;
    camera.width = desc.width;
    camera.shift[0] = desc.shift[0];
    camera.shift[1] = desc.shift[1];
    camera.clip_start = desc.clip_start;
    camera.clip_end = desc.clip_end;
    camera.aperture_radius = desc.aperture_radius;
    camera.focus_distance = desc.focus_distance;
    camera.blade_count = desc.blade_count;
    // Within half a turn: sines of vectors know no more than some thousands.
    camera.blade_rotation = static_cast<float>(std::remainder(static_cast<double>(desc.blade_rotation), 2 * kPi));
    camera.shutter[0] = desc.shutter[0];
    camera.shutter[1] = desc.shutter[1];
    camera.pixel_aspect = desc.pixel_aspect;
    return camera;
}

}  // namespace trp
