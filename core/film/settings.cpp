#include "film/settings.h"

#include <charconv>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "film/passes.h"

namespace trp {
namespace {

const char* const kSpeculars[] = {"none", "phong", "blinn", nullptr};
const char* const kNormals[] = {"mesh", "averaged", nullptr};
const char* const kAveraging[] = {"plain", "angle", "area", nullptr};
const char* const kInterpolations[] = {"perspective", "scan_line", nullptr};
const char* const kFalloffs[] = {"light", "none", "linear", "quadratic", nullptr};
const char* const kTransparentShadows[] = {"opaque", "transmission", "none", nullptr};
const char* const kFilters[] = {"box", "gaussian", "blackman_harris", nullptr};
const char* const kLineColors[] = {"line", "object", "material", nullptr};
const char* const kHidden[] = {"none", "faint", "dashed", nullptr};

const char* const kSolvers[] = {"hierarchical", "progressive", "matrix", nullptr};
const char* const kFormFactors[] = {"analytic", "hemisphere", "hemicube", nullptr};
const char* const kOrders[] = {"sorted", "unsorted", "gathering", nullptr};
const char* const kRadiosityViews[] = {"shaded",      "radiosity",    "unshot", "false_color",
                                       "illuminance", "form_factors", nullptr};

constexpr const char kLineMethods[] = "wireframe hidden_line";

Vec3 color_of(const double* v) {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

}  // namespace

const SettingRow kSettings[] = {
    {TRP_TYPE_INT, "samples", "Samples",
     "Rays through each pixel; in the rasterizer, samples of large lights in each pixel", "", "16", 1, 65536, nullptr,
     kSurfaceMethods, "path_tracing=128", [](Settings& s, const double* v) { s.samples = static_cast<uint32_t>(*v); }},
    {TRP_TYPE_FLOAT, "adaptive.threshold", "Noise threshold",
     "Pixels whose noise has fallen below this get no more samples: the standard error over the square root of the "
     "radiance, 0.01 to be fine. 0 gives all pixels all samples",
     "", "0", 0, 10, nullptr, kRayMethods, "",
     [](Settings& s, const double* v) { s.adaptive.threshold = static_cast<float>(*v); }},
    {TRP_TYPE_INT, "adaptive.least_samples", "Least samples",
     "Samples that every pixel gets before its noise is looked at; four times as many at edges of objects", "", "32", 8,
     65536, nullptr, kRayMethods, "",
     [](Settings& s, const double* v) { s.adaptive.least_samples = static_cast<uint32_t>(*v); }},
    {TRP_TYPE_INT, "seed", "Seed", "Another seed gives other noise", "", "0", 0, 2147483647, nullptr, kSeeingMethods,
     "", [](Settings& s, const double* v) { s.seed = static_cast<uint32_t>(*v); }},
    {TRP_TYPE_INT, "threads", "Threads", "Threads that work; 0 uses every core", "", "0", 0, 1024, nullptr, "*", "",
     [](Settings& s, const double* v) { s.threads = static_cast<uint32_t>(*v); }},
    {TRP_TYPE_BOOL, "shadows", "Shadows",
     "Lights are blocked by what stands in their way; the classic methods of the rasterizer have none unless asked", "",
     "on", 0, 1, nullptr, kSeeingMethods, "visible_surface=off flat=off gouraud=off phong=off",
     [](Settings& s, const double* v) { s.illumination.shadows = *v != 0; }},
    {TRP_TYPE_ENUM, "shading.transparent_shadows", "Transparent shadows",
     "What transparent surfaces (K_T) do to shadows: block light like all others, let through the share and the colour "
     "that K_T says, straight on, or cast none",
     "", "opaque", 0, 0, kTransparentShadows, "visible_surface flat gouraud phong ray_casting ray_tracing", "",
     [](Settings& s, const double* v) { s.illumination.transparent_shadows = static_cast<TransparentShadows>(*v); }},
    {TRP_TYPE_ENUM, "shading.specular", "Specular",
     "The highlight of lights (not of the world): none, Phong's (V·R)^n, or Blinn's (N·H)^n, which is about twice as "
     "wide for the same n",
     "", "phong", 0, 0, kSpeculars, kSurfaceMethods, "",
     [](Settings& s, const double* v) { s.illumination.specular = static_cast<Specular>(*v); }},
    {TRP_TYPE_COLOR, "shading.ambient", "Ambient light",
     "I_A, which reaches every surface from everywhere; the world's own light is sampled and needs none", "W/(m² sr)",
     "0,0,0", 0, 1e6, nullptr, kSurfaceMethods, "",
     [](Settings& s, const double* v) { s.illumination.ambient = color_of(v); }},
    {TRP_TYPE_ENUM, "shading.normals", "Normals",
     "The mesh's own normals, or averages of the faces around each position, whether the mesh has normals or not; "
     "faces that are flat, and sharp edges, stay so",
     "", "mesh", 0, 0, kNormals, kSurfaceMethods, "",
     [](Settings& s, const double* v) { s.averaged_normals = *v != 0; }},
    {TRP_TYPE_ENUM, "shading.averaging", "Averaging",
     "How the faces around a vertex count in averaged normals: all alike, by their angles at the vertex, or by their "
     "areas",
     "", "angle", 0, 0, kAveraging, kSurfaceMethods, "",
     [](Settings& s, const double* v) { s.normal_weight = static_cast<NormalWeight>(*v); }},
    {TRP_TYPE_ENUM, "shading.falloff", "Falloff",
     "How light fades with distance: each light's own way, not at all, with distance, or with its square; all agree at "
     "one metre",
     "", "light", 0, 0, kFalloffs, kSeeingMethods, "",
     [](Settings& s, const double* v) {
         constexpr int32_t kOf[] = {-1, TRP_FALLOFF_CONSTANT, TRP_FALLOFF_LINEAR, TRP_FALLOFF_PHYSICAL};
         s.illumination.falloff = kOf[static_cast<int>(*v)];
     }},
    {TRP_TYPE_FLOAT, "shading.least_light", "Least light",
     "Lamps are left out where less than this would arrive of their light, I_L; with hundreds of lamps in a large "
     "scene "
     "that saves most of the time, and darkens each place by at most this much for each lamp left out. 0 leaves out "
     "none",
     "W/(m² sr)", "0", 0, 1e6, nullptr, kSeeingMethods, "",
     [](Settings& s, const double* v) { s.illumination.least_light = static_cast<float>(*v); }},
    {TRP_TYPE_ENUM, "film.filter", "Pixel filter", "How samples are weighed around a pixel", "", "blackman_harris", 0,
     0, kFilters, "*", "", [](Settings& s, const double* v) { s.filter = static_cast<PixelFilter::Kind>(*v); }},
    {TRP_TYPE_FLOAT, "film.filter_width", "Filter width",
     "Width of the pixel filter; 0 sends every ray through the pixel's centre", "pixels", "1.5", 0, 16, nullptr, "*",
     "", [](Settings& s, const double* v) { s.filter_width = static_cast<float>(*v); }},
    {TRP_TYPE_BOOL, "film.transparent", "Transparent", "The background is left out of the picture, with an alpha of 0",
     "", "off", 0, 1, nullptr, "*", "", [](Settings& s, const double* v) { s.transparent = *v != 0; }},
    {TRP_TYPE_INT, "film.tile_size", "Tile size",
     "Side of the tiles in which the picture is made; the picture does not depend on it", "pixels", "64", 16, 4096,
     nullptr, "*", "", [](Settings& s, const double* v) { s.tile_size = static_cast<uint32_t>(*v); }},
    {TRP_TYPE_INT, "raster.samples", "Edge samples",
     "Samples of each pixel for smooth edges; 1 sees what lies at the pixel's centre", "", "8", 1, 32, nullptr,
     "visible_surface flat gouraud phong radiosity", "",
     [](Settings& s, const double* v) { s.raster_samples = static_cast<uint32_t>(*v); }},
    {TRP_TYPE_ENUM, "raster.interpolation", "Interpolation",
     "How colours or normals are interpolated over a face: right in perspective, triangle by triangle, or as the books "
     "do it, down the sides of the polygon and along scan lines on the film, which changes as the picture turns",
     "", "perspective", 0, 0, kInterpolations, "gouraud phong", "",
     [](Settings& s, const double* v) { s.scan_line = *v != 0; }},
    {TRP_TYPE_INT, "trace.depth", "Depth",
     "The greatest number of reflections and transmissions in a row along a ray; 0 traces none", "", "8", 0, 10000,
     nullptr, kTreeMethods, "path_tracing=64",
     [](Settings& s, const double* v) { s.trace.depth = static_cast<uint32_t>(*v); }},
    {TRP_TYPE_INT, "trace.reflection_depth", "Reflections", "The greatest number of mirror reflections along a ray", "",
     "8", 0, 10000, nullptr, kTreeMethods, "path_tracing=64",
     [](Settings& s, const double* v) { s.trace.ways[0] = static_cast<uint32_t>(*v); }},
    {TRP_TYPE_INT, "trace.transmission_depth", "Transmissions",
     "The greatest number of transmissions along a ray; a glass body takes two", "", "8", 0, 10000, nullptr,
     kTreeMethods, "path_tracing=64",
     [](Settings& s, const double* v) { s.trace.ways[1] = static_cast<uint32_t>(*v); }},
    {TRP_TYPE_INT, "trace.diffuse_depth", "Diffuse reflections",
     "The greatest number of diffuse reflections along a path; 0: lights alone light surfaces", "", "64", 0, 10000,
     nullptr, "path_tracing", "", [](Settings& s, const double* v) { s.trace.ways[2] = static_cast<uint32_t>(*v); }},
    {TRP_TYPE_BOOL, "trace.rough", "Rough reflections",
     "Mirror reflections and transmissions are blurred like the highlight, by the shininess n: each sample takes one "
     "ray of many. Off: all are sharp",
     "", "off", 0, 1, nullptr, kTreeMethods, "", [](Settings& s, const double* v) { s.trace.rough = *v != 0; }},
    {TRP_TYPE_FLOAT, "trace.least_weight", "Least weight",
     "Rays that count for less than this share in their pixel are not traced; each takes at most this share of what it "
     "would have seen from the pixel. 0 traces all",
     "", "0.001", 0, 1, nullptr, "ray_tracing", "",
     [](Settings& s, const double* v) { s.trace.least_weight = static_cast<float>(*v); }},
    {TRP_TYPE_ENUM, "radiosity.solver", "Solver",
     "How radiosity is solved: hierarchical divides surfaces where light is uneven and links them as coarsely as the "
     "tolerance allows; progressive shoots from the brightest patch first, a picture after each step; matrix solves "
     "the whole system, of some thousand elements",
     "", "hierarchical", 0, 0, kSolvers, "radiosity", "",
     [](Settings& s, const double* v) { s.radiosity.solver = static_cast<RadiositySolver>(*v); }},
    {TRP_TYPE_ENUM, "radiosity.form_factors", "Form factors",
     "How the matrix and progressive solvers find them: analytic, by contour integrals and rays between the elements; "
     "hemisphere, by rays into it; hemicube, by drawing the scene on its five faces, which leaves mirrors out",
     "", "analytic", 0, 0, kFormFactors, "radiosity", "",
     [](Settings& s, const double* v) { s.radiosity.form_factors = static_cast<FormFactors>(*v); }},
    {TRP_TYPE_FLOAT, "radiosity.element_size", "Element size",
     "The greatest side of an element, and of the hierarchical solver the least. 0: one element to a face, and the "
     "hierarchical solver divides as its tolerance asks",
     "m", "0", 0, 1e6, nullptr, "radiosity", "",
     [](Settings& s, const double* v) { s.radiosity.element_size = static_cast<float>(*v); }},
    {TRP_TYPE_INT, "radiosity.patch_levels", "Patch levels",
     "Progressive: patches, which shoot, are divided in four so many times into the elements that receive", "", "0", 0,
     8, nullptr, "radiosity", "",
     [](Settings& s, const double* v) { s.radiosity.patch_levels = static_cast<uint32_t>(*v); }},
    {TRP_TYPE_INT, "radiosity.subdivisions", "Subdivisions",
     "Matrix and progressive: how often an element may be divided in four, once all is solved, where what is shown "
     "between elements would be wrong by more than twice the tolerance (0: a fiftieth of the mean radiosity), at edges "
     "of shadows, and where a body stands on it. The parts gather their light from all others",
     "", "0", 0, 6, nullptr, "radiosity", "",
     [](Settings& s, const double* v) { s.radiosity.subdivisions = static_cast<uint32_t>(*v); }},
    {TRP_TYPE_INT, "radiosity.iterations", "Iterations",
     "The greatest number of steps: shots, sweeps over the matrix, or refinements of the hierarchy. 0: until it is "
     "solved",
     "", "0", 0, 2147483647, nullptr, "radiosity", "",
     [](Settings& s, const double* v) { s.radiosity.iterations = static_cast<uint32_t>(*v); }},
    {TRP_TYPE_FLOAT, "radiosity.tolerance", "Tolerance",
     "The error of radiosity that is allowed, as its root mean square over the area: hierarchical; or the mean that "
     "may stay unshot: progressive. 0: a hundredth of the mean radiosity, and a thousandth of it unshot",
     "W/m²", "0", 0, 1e9, nullptr, "radiosity", "",
     [](Settings& s, const double* v) { s.radiosity.tolerance = static_cast<float>(*v); }},
    {TRP_TYPE_FLOAT, "radiosity.link_ratio", "Link ratio",
     "Hierarchical: links go between elements whose sides are less than so much of their distance, down to the element "
     "size, whatever light they carry. 0: as the tolerance asks",
     "", "0", 0, 1e3, nullptr, "radiosity", "",
     [](Settings& s, const double* v) { s.radiosity.link_ratio = static_cast<float>(*v); }},
    {TRP_TYPE_INT, "radiosity.rays", "Rays",
     "Rays from each element into its hemisphere; with analytic form factors, to what it sees", "", "1024", 1,
     100000000, nullptr, "radiosity", "",
     [](Settings& s, const double* v) { s.radiosity.rays = static_cast<uint32_t>(*v); }},
    {TRP_TYPE_INT, "radiosity.hemicube_resolution", "Hemicube", "Pixels along a side of the hemicube, in steps of 32",
     "pixels", "256", 32, 8192, nullptr, "radiosity", "",
     [](Settings& s,
        const double* v) { s.radiosity.hemicube_resolution = (static_cast<uint32_t>(*v) + 16) / 32 * 32; }},
    {TRP_TYPE_ENUM, "radiosity.order", "Order",
     "Progressive: shooting from the patch with the most unshot power; from one patch after the other; or gathering, "
     "one element after the other",
     "", "sorted", 0, 0, kOrders, "radiosity", "",
     [](Settings& s, const double* v) { s.radiosity.order = static_cast<RadiositySettings::Order>(*v); }},
    {TRP_TYPE_BOOL, "radiosity.ambient", "Ambient estimate",
     "Progressive: power that is not yet shot is shown as if it came evenly from everywhere; the solution is not "
     "changed by it",
     "", "off", 0, 1, nullptr, "radiosity", "", [](Settings& s, const double* v) { s.radiosity.ambient = *v != 0; }},
    {TRP_TYPE_INT, "radiosity.memory", "Matrix memory", "The greatest size of a matrix of form factors", "MiB", "2048",
     1, 1048576, nullptr, "radiosity", "",
     [](Settings& s, const double* v) { s.radiosity.memory = static_cast<uint32_t>(*v); }},
    {TRP_TYPE_BOOL, "radiosity.smooth", "Smooth",
     "Radiosity is interpolated between the corners of the elements; off: each element is shown in one colour", "",
     "on", 0, 1, nullptr, "radiosity", "", [](Settings& s, const double* v) { s.radiosity.smooth = *v != 0; }},
    {TRP_TYPE_BOOL, "radiosity.mesh", "Mesh", "The sides of the elements are drawn into the picture", "", "off", 0, 1,
     nullptr, "radiosity", "", [](Settings& s, const double* v) { s.radiosity.mesh = *v != 0; }},
    {TRP_TYPE_ENUM, "radiosity.view", "View",
     "What is shown: the picture, with textures; the radiosity of the elements alone; what of it is not yet shot; or "
     "in "
     "false colours, from blue over green and yellow to red: irradiance; illuminance, which is the same in lux; or an "
     "element's row of form factors",
     "", "shaded", 0, 0, kRadiosityViews, "radiosity", "",
     [](Settings& s, const double* v) { s.radiosity.view = static_cast<RadiositySettings::View>(*v); }},
    {TRP_TYPE_FLOAT, "radiosity.view_scale", "Scale",
     "What is red in false colours: W/m², lux (683 are 1 W/m²) or a form factor, as the view has it; 0: the greatest "
     "there is",
     "", "0", 0, 1e9, nullptr, "radiosity", "",
     [](Settings& s, const double* v) { s.radiosity.view_scale = static_cast<float>(*v); }},
    {TRP_TYPE_BOOL, "radiosity.legend", "Legend",
     "The scale of false colours is drawn into the picture, where that is about 112 pixels wide and high at least", "",
     "on", 0, 1, nullptr, "radiosity", "", [](Settings& s, const double* v) { s.radiosity.legend = *v != 0; }},
    {TRP_TYPE_INT, "radiosity.view_element", "Element",
     "The element whose row of form factors is shown; it is white itself", "", "0", 0, 2147483647, nullptr, "radiosity",
     "", [](Settings& s, const double* v) { s.radiosity.view_element = static_cast<uint32_t>(*v); }},
    {TRP_TYPE_FLOAT, "lines.width", "Width", "Width of the lines", "pixels", "1.5", 0.01, 64, nullptr, kLineMethods, "",
     [](Settings& s, const double* v) { s.lines.width = static_cast<float>(*v); }},
    {TRP_TYPE_ENUM, "lines.color_by", "Colour by",
     "What gives a line its colour: the one line colour, the object's own (viewport) colour, or the diffuse colour of "
     "its face's material, without textures",
     "", "line", 0, 0, kLineColors, kLineMethods, "",
     [](Settings& s, const double* v) { s.lines.color_by = static_cast<LineSettings::ColorBy>(*v); }},
    {TRP_TYPE_COLOR, "lines.color", "Line", "Colour of all lines", "", "0,0,0", 0, 1e6, nullptr, kLineMethods, "",
     [](Settings& s, const double* v) { s.lines.color = color_of(v); }},
    {TRP_TYPE_COLOR, "lines.paper", "Paper", "Colour behind the lines", "", "1,1,1", 0, 1e6, nullptr, kLineMethods, "",
     [](Settings& s, const double* v) { s.lines.paper = color_of(v); }},
    {TRP_TYPE_FLOAT, "lines.depth_cue", "Depth cue",
     "How far the farthest lines have faded into the paper: 0 not at all, 1 wholly", "", "0", 0, 1, nullptr,
     kLineMethods, "", [](Settings& s, const double* v) { s.lines.depth_cue = static_cast<float>(*v); }},
    {TRP_TYPE_ENUM, "lines.hidden", "Hidden parts", "How parts of lines are drawn that lie behind a face", "", "none",
     0, 0, kHidden, "hidden_line", "",
     [](Settings& s, const double* v) { s.lines.hidden = static_cast<LineSettings::Hidden>(*v); }},
    {TRP_TYPE_BOOL, "lines.all", "All edges", "Draw every edge of the meshes; off: the kinds chosen below", "", "on", 0,
     1, nullptr, kLineMethods, "", [](Settings& s, const double* v) { s.lines.all = *v != 0; }},
    {TRP_TYPE_BOOL, "lines.silhouettes", "Silhouettes",
     "Edges between a face that is seen from the front and one that "
     "is seen from behind",
     "", "on", 0, 1, nullptr, kLineMethods, "", [](Settings& s, const double* v) { s.lines.silhouettes = *v != 0; }},
    {TRP_TYPE_BOOL, "lines.borders", "Borders",
     "Edges that do not have two faces: where a surface ends, and loose edges", "", "on", 0, 1, nullptr, kLineMethods,
     "", [](Settings& s, const double* v) { s.lines.borders = *v != 0; }},
    {TRP_TYPE_BOOL, "lines.creases", "Creases",
     "Edges whose faces are turned against each other by more than the crease "
     "angle",
     "", "on", 0, 1, nullptr, kLineMethods, "", [](Settings& s, const double* v) { s.lines.creases = *v != 0; }},
    {TRP_TYPE_FLOAT, "lines.crease_angle", "Crease angle",
     "The least angle between the normals of a crease's faces; 0.5236 is 30 degrees", "radians", "0.5236", 0,
     3.14159274, nullptr, kLineMethods, "",
     [](Settings& s, const double* v) { s.lines.crease_angle = static_cast<float>(*v); }},
    {TRP_TYPE_BOOL, "lines.material_borders", "Material borders", "Edges between faces of different materials", "",
     "on", 0, 1, nullptr, kLineMethods, "", [](Settings& s, const double* v) { s.lines.material_borders = *v != 0; }},
    {TRP_TYPE_BOOL, "lines.marked", "Marked edges", "Edges with a Freestyle mark", "", "on", 0, 1, nullptr,
     kLineMethods, "", [](Settings& s, const double* v) { s.lines.marked = *v != 0; }},
};
const uint32_t kSettingCount = sizeof kSettings / sizeof kSettings[0];

namespace {

std::vector<double> read_numbers(const SettingRow& row, const std::string& text) {
    std::vector<double> numbers;
    const char *at = text.data(), *const end = text.data() + text.size();
    while (true) {
        while (at < end && *at == ' ') ++at;
        double value = 0;
        const auto [next, error] = std::from_chars(at, end, value);
        if (error != std::errc() || !std::isfinite(value)) break;
        numbers.push_back(value);
        at = next;
        while (at < end && *at == ' ') ++at;
        if (at == end || *at != ',') break;
        ++at;
    }
    const size_t wanted = row.type == TRP_TYPE_COLOR ? 3 : 1;
    const bool whole = row.type != TRP_TYPE_INT || (!numbers.empty() && numbers[0] == std::floor(numbers[0]));
    if (at != end || numbers.size() != wanted || !whole)
        fail(TRP_ERROR_ARGUMENT, "setting {}: \"{}\" is not {}", row.name, text,
             row.type == TRP_TYPE_COLOR ? "a colour of three numbers, as 0.1,0.2,0.3"
             : row.type == TRP_TYPE_INT ? "a whole number"
                                        : "a number");
    for (const double value : numbers)
        if (value < row.minimum || value > row.maximum)
            fail(TRP_ERROR_ARGUMENT, "setting {}: {} is not between {} and {}", row.name, value, row.minimum,
                 row.maximum);
    return numbers;
}

}  // namespace

Settings default_settings(const std::string& method) {
    Settings settings;
    for (uint32_t i = 0; i < kSettingCount; ++i) {
        const std::string all = std::string(" ") + kSettings[i].method_defaults + " ";
        const size_t at = all.find(" " + method + "=");
        if (at == std::string::npos) continue;
        const size_t begin = at + method.size() + 2;
        set_setting(settings, kSettings[i].name, all.substr(begin, all.find(' ', begin) - begin));
    }
    return settings;
}

void set_setting(Settings& settings, const std::string& name, const std::string& value) {
    for (uint32_t i = 0; i < kSettingCount; ++i) {
        const SettingRow& row = kSettings[i];
        if (name != row.name) continue;
        if (row.type == TRP_TYPE_BOOL) {
            const double number = value == "on" || value == "true" || value == "1";
            if (number == 0 && value != "off" && value != "false" && value != "0")
                fail(TRP_ERROR_ARGUMENT, "setting {}: \"{}\" is neither on nor off", name, value);
            return row.set(settings, &number);
        }
        if (row.type == TRP_TYPE_ENUM) {
            std::string known;
            for (int k = 0; row.choices[k]; ++k) {
                const double number = k;
                if (value == row.choices[k]) return row.set(settings, &number);
                known += std::string(k ? ", " : "") + row.choices[k];
            }
            fail(TRP_ERROR_ARGUMENT, "setting {}: \"{}\" is none of {}", name, value, known);
        }
        return row.set(settings, read_numbers(row, value).data());
    }
    fail(TRP_ERROR_ARGUMENT, "there is no setting \"{}\"", name);
}

}  // namespace trp
