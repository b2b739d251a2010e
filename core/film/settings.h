// The settings of a render, and the one table that names, describes, checks and reads them.
#pragma once

#include <string>

#include "film/pixel_filter.h"
#include "shading/lighting.h"

namespace trp {

// How edges are drawn, and which.
struct LineSettings {
    enum class ColorBy { line, object, material };
    enum class Hidden { none, faint, dashed };
    float width = 1.5f;  // pixels
    ColorBy color_by = ColorBy::line;
    Vec3 color{0, 0, 0}, paper{1, 1, 1};
    float depth_cue = 0;  // the share of the paper in the farthest lines
    Hidden hidden = Hidden::none;
    bool all = true, silhouettes = true, borders = true, creases = true, material_borders = true, marked = true;
    float crease_angle = 0.5235988f;  // radians
};

// Where the ray tree ends.
struct TraceLimits {
    uint32_t depth = 8, ways[3] = {8, 8, 64};  // by trace/tracer.h's Way: reflections, transmissions, diffuse
    float least_weight = 0.001f;               // of a ray in its pixel
    bool rough = false;                        // mirror and transmitted rays are scattered like the highlight
};

// Pixels get fewer samples where that leaves no more noise than this.
struct AdaptiveSampling {
    float threshold = 0;  // of a pixel's standard error over the square root of its radiance; 0: all get all
    uint32_t least_samples = 32;
};

// How radiosity is solved, and how the solution is shown.
enum class RadiositySolver { hierarchical, progressive, matrix };
enum class FormFactors { analytic, hemisphere, hemicube };
struct RadiositySettings {
    enum class Order { sorted, unsorted, gathering };
    enum class View { shaded, radiosity, unshot, false_color, illuminance, form_factors };
    RadiositySolver solver = RadiositySolver::hierarchical;
    FormFactors form_factors = FormFactors::analytic;
    float element_size = 0;     // metres; 0: one element to a face, or where it is divided on its own, as needed
    uint32_t patch_levels = 0;  // a patch that shoots is divided so often into elements that receive
    uint32_t iterations = 0;    // at most; 0: until it is solved
    uint32_t subdivisions = 0;  // of elements, once solved, where radiosity changes fast: matrix and progressive
    float tolerance = 0;        // W/m²; 0: a hundredth of the mean radiosity
    float link_ratio = 0;       // of an end's side to their distance, the most in any link; 0: as the tolerance asks
    uint32_t rays = 1024;       // from each element
    uint32_t hemicube_resolution = 256;  // pixels; a multiple of 32
    Order order = Order::sorted;
    bool ambient = false;    // light that is not yet shot is shown as if it came from everywhere
    uint32_t memory = 2048;  // MiB, at most, for a matrix
    bool smooth = true;      // vertices are interpolated; else elements are shown flat
    bool mesh = false;       // the elements' sides are drawn
    View view = View::shaded;
    float view_scale = 0;       // the top of the scale of colours, in the view's unit; 0: the greatest
    bool legend = true;         // the scale is drawn into the picture
    uint32_t view_element = 0;  // whose row of form factors is shown
};

struct Settings {
    uint32_t samples = 16;
    uint32_t seed = 0;
    uint32_t threads = 0;
    Illumination illumination;
    bool averaged_normals = false;
    NormalWeight normal_weight = NormalWeight::angle;
    NormalChoice normals() const {
        if (!averaged_normals) return NormalChoice::mesh;
        return normal_weight == NormalWeight::plain  ? NormalChoice::plain_average
               : normal_weight == NormalWeight::area ? NormalChoice::area_average
                                                     : NormalChoice::angle_average;
    }
    bool scan_line = false;  // values are interpolated along scan lines instead of in perspective
    PixelFilter::Kind filter = PixelFilter::Kind::blackman_harris;
    float filter_width = 1.5f;
    bool transparent = false;
    uint32_t tile_size = 64;
    uint32_t raster_samples = 8;
    LineSettings lines;
    TraceLimits trace;
    AdaptiveSampling adaptive;
    RadiositySettings radiosity;
};

struct SettingRow {
    int32_t type;  // TRP_TYPE_…
    const char *name, *label, *description, *unit, *default_value;
    double minimum, maximum;
    const char* const* choices;  // null-terminated; ENUM alone
    const char* methods;
    const char* method_defaults;  // "METHOD=VALUE" with a space between, where they differ from default_value
    // Takes a value that is checked: numbers by component, or the index of the choice.
    void (*set)(Settings&, const double*);
};

extern const SettingRow kSettings[];
extern const uint32_t kSettingCount;

// The settings that a method starts with.
Settings default_settings(const std::string& method);

// Sets the named setting from text; throws Error where the name or the value is not of the table.
void set_setting(Settings& settings, const std::string& name, const std::string& value);

}  // namespace trp
