// Radiosity solutions.
#include <algorithm>
#include <cstring>

#include "api/guard.h"
#include "api/handles.h"
#include "film/picture_file.h"
#include "radiosity/polygon_factors.h"

using namespace trp;

namespace {

void check_idle(const TrpRadiosity* radiosity) {
    check_pointer(radiosity, "radiosity");
    if (radiosity->running) fail(TRP_ERROR_STATE, "the radiosity solution is running");
}

// Elements have the numbers of the leaves, in their order.
void number_leaves(TrpRadiosity& radiosity) {
    const Elements& elements = radiosity.data->elements();
    radiosity.leaves.clear();
    for (uint32_t i = 0; i < elements.size(); ++i)
        if (elements[i].leaf()) radiosity.leaves.push_back(i);
    radiosity.links_read = false;
}

Radiosity& with_elements(TrpRadiosity* radiosity) {
    check_idle(radiosity);
    if (!radiosity->data->has_elements()) fail(TRP_ERROR_STATE, "the radiosity solution has no elements yet");
    return *radiosity->data;
}

// Runs a call that may be cancelled.
template <class Work>
TrpStatus run(TrpRadiosity* radiosity, const TrpCallbacks* callbacks, Work&& work) {
    return guard([&] {
        check_pointer(radiosity, "radiosity");
        const RenderEvents events = events_of(callbacks);
        const Running running(*radiosity, "radiosity solution");
        const auto number = [&] {
            if (radiosity->data->has_elements()) number_leaves(*radiosity);
        };
        try {
            const bool whole = work(*radiosity->data, events);
            number();
            return whole ? TRP_OK : TRP_CANCELLED;
        } catch (...) {
            number();  // what there is can be read
            throw;
        }
    });
}

// What trp_radiosity_read knows: of elements or vertices, so many numbers each.
struct Values {
    const char* name;
    bool of_vertices;
    int count;
    void (*read)(Radiosity& radiosity, uint32_t item, float* out);
};

void put(const Vec3d& v, float* out) {
    for (int k = 0; k < 3; ++k) out[k] = static_cast<float>(v[k]);
}

Vec3d arriving(const Radiosity& radiosity, uint32_t i) {
    const Solution& solution = radiosity.solution();
    return solution.irradiance[i] + Vec3d(solution.light[i].irradiance);
}

const Values kValues[] = {
    {"radiosity", false, 3, [](Radiosity& r, uint32_t i, float* out) { put(r.solution().radiosity(i), out); }},
    {"irradiance", false, 3, [](Radiosity& r, uint32_t i, float* out) { put(arriving(r, i), out); }},
    {"emission", false, 3,
     [](Radiosity& r, uint32_t i, float* out) { put(Vec3d(r.solution().light[i].emission), out); }},
    {"unshot", false, 3,
     [](Radiosity& r, uint32_t i, float* out) {
         put(r.solution().unshot.empty() ? Vec3d(0, 0, 0) : r.solution().unshot[i], out);
     }},
    {"reflectance", false, 3,
     [](Radiosity& r, uint32_t i, float* out) { put(Vec3d(r.solution().light[i].reflectance), out); }},
    {"centre", false, 3,
     [](Radiosity& r, uint32_t i, float* out) {
         put(Vec3d(r.elements()[i].centre) + r.elements().snapshot().origin, out);
     }},
    {"normal", false, 3, [](Radiosity& r, uint32_t i, float* out) { put(Vec3d(r.elements().normal(i)), out); }},
    {"area", false, 1, [](Radiosity& r, uint32_t i, float* out) { *out = r.elements()[i].area; }},
    {"instance", false, 1,
     [](Radiosity& r, uint32_t i, float* out) {
         const Elements& elements = r.elements();
         *out = static_cast<float>(elements.snapshot().surfaces[elements.facet_of(i).slot].instance);
     }},
    {"face", false, 1,
     [](Radiosity& r, uint32_t i, float* out) { *out = static_cast<float>(r.elements().facet_of(i).face); }},
    {"vertex_position", true, 3,
     [](Radiosity& r, uint32_t v, float* out) {
         put(Vec3d(r.vertices().vertices()[v].position) + r.elements().snapshot().origin, out);
     }},
    {"vertex_normal", true, 3,
     [](Radiosity& r, uint32_t v, float* out) {
         const ElementVertex& vertex = r.vertices().vertices()[v];
         put(Vec3d(vertex.normal) * (vertex.side ? -1.0 : 1.0), out);
     }},
};

// At vertices, of radiosity or irradiance.
void read_at_vertices(Radiosity& radiosity, RadiositySettings::View view, float* out) {
    RadiositySettings settings = radiosity.settings.radiosity;
    settings.view = view;
    settings.ambient = false;
    const auto shown = radiosity.shown(settings);
    for (const Vec3& value : shown->at_vertices) {
        put(Vec3d(value), out);
        out += 3;
    }
}

void check_count(size_t given, size_t needed, const char* what) {
    if (given != needed) fail(TRP_ERROR_ARGUMENT, "the buffer has {} {} where {} are needed", given, what, needed);
}

uint32_t leaf_of(const TrpRadiosity& radiosity, uint32_t element) {
    if (element >= radiosity.leaves.size())
        fail(TRP_ERROR_ARGUMENT, "there is no element {}; there are {}", element, radiosity.leaves.size());
    return radiosity.leaves[element];
}

// The number that the ABI knows an element by; of one that was divided, and of none, TRP_NO_ELEMENT.
uint32_t number_of(const TrpRadiosity& radiosity, uint32_t element) {
    const auto at = std::lower_bound(radiosity.leaves.begin(), radiosity.leaves.end(), element);
    if (at == radiosity.leaves.end() || *at != element) return TRP_NO_ELEMENT;
    return static_cast<uint32_t>(at - radiosity.leaves.begin());
}

}  // namespace

extern "C" {

TrpStatus trp_radiosity_create(TrpScene* scene, TrpRadiosity** radiosity) {
    return guard([&] {
        check_pointer(scene, "scene");
        check_pointer(radiosity, "radiosity");
        if (!scene->snapshot) fail(TRP_ERROR_STATE, "the scene was never committed");
        auto made = std::make_unique<TrpRadiosity>();
        made->data = std::make_shared<Radiosity>(scene->snapshot);
        made->data->settings = default_settings("radiosity");
        *radiosity = made.release();
        return TRP_OK;
    });
}

void trp_radiosity_destroy(TrpRadiosity* radiosity) {
    delete radiosity;
}

TrpStatus trp_radiosity_set(TrpRadiosity* radiosity, const char* name, const char* value) {
    return guard([&] {
        check_idle(radiosity);
        check_pointer(name, "name");
        check_pointer(value, "value");
        if (radiosity->data->has_elements())
            fail(TRP_ERROR_STATE, "the radiosity solution has been begun: {} can no longer be set", name);
        set_setting(radiosity->data->settings, name, value);
        return TRP_OK;
    });
}

TrpStatus trp_radiosity_prepare(TrpRadiosity* radiosity, const TrpCallbacks* callbacks) {
    return run(radiosity, callbacks,
               [&](Radiosity& data, const RenderEvents& events) { return data.prepare(events, radiosity->cancelled); });
}

TrpStatus trp_radiosity_step(TrpRadiosity* radiosity, uint32_t count, const TrpCallbacks* callbacks) {
    return run(radiosity, callbacks, [&](Radiosity& data, const RenderEvents& events) {
        return count == 0 || data.advance(count, events, radiosity->cancelled);
    });
}

TrpStatus trp_radiosity_solve(TrpRadiosity* radiosity, const TrpCallbacks* callbacks) {
    return run(radiosity, callbacks, [&](Radiosity& data, const RenderEvents& events) {
        return data.advance(0, events, radiosity->cancelled);
    });
}

TrpStatus trp_radiosity_cancel(TrpRadiosity* radiosity) {
    return guard([&] {
        check_pointer(radiosity, "radiosity");
        const std::lock_guard lock(radiosity->state);
        if (radiosity->running) radiosity->cancelled = true;
        return TRP_OK;
    });
}

TrpStatus trp_radiosity_info(TrpRadiosity* radiosity, TrpRadiosityInfo* info) {
    return guard([&] {
        check_idle(radiosity);
        TrpRadiosityInfo out{};
        Radiosity& data = *radiosity->data;
        const SolverStatistics& statistics = data.statistics();
        out.iterations = statistics.steps;
        out.solved = data.solved();
        out.limited = static_cast<int32_t>(statistics.limit);
        out.links = statistics.links;
        out.rays = statistics.rays;
        out.residual = statistics.residual;
        out.seconds = data.seconds();
        out.projection_side = 2 * data.settings.radiosity.hemicube_resolution;
        if (data.has_elements()) {
            out.element_count = static_cast<uint32_t>(radiosity->leaves.size());
            const ElementVertices& vertices = data.vertices();
            out.vertex_count = static_cast<uint32_t>(vertices.vertices().size());
            for (const uint32_t leaf : radiosity->leaves) {
                out.corner_count += static_cast<uint32_t>(vertices.around(leaf).size());
                const double area = data.elements()[leaf].exposed_area();
                out.area += area;
                const Vec3d power = data.solution().radiosity(leaf) * area,
                            unshot =
                                data.solution().unshot.empty() ? Vec3d(0, 0, 0) : data.solution().unshot[leaf] * area;
                for (int c = 0; c < 3; ++c) out.power[c] += power[c], out.unshot[c] += unshot[c];
            }
        }
        write_struct(info, out, "info");
        return TRP_OK;
    });
}

uint32_t trp_radiosity_warning_count(const TrpRadiosity* radiosity) {
    return radiosity ? static_cast<uint32_t>(radiosity->data->warnings().size()) : 0;
}

TrpStatus trp_radiosity_warning(const TrpRadiosity* radiosity, uint32_t index, TrpWarning* warning) {
    return guard([&] {
        check_idle(radiosity);
        const auto& warnings = radiosity->data->warnings();
        if (index >= warnings.size())
            fail(TRP_ERROR_ARGUMENT, "there is no warning {}; there are {}", index, warnings.size());
        write_struct(warning, {0, warnings[index].code, warnings[index].item, warnings[index].text.c_str()}, "warning");
        return TRP_OK;
    });
}

TrpStatus trp_radiosity_read(TrpRadiosity* radiosity, const char* values, float* buffer, size_t float_count) {
    return guard([&] {
        Radiosity& data = with_elements(radiosity);
        check_pointer(values, "values");
        check_pointer(buffer, "buffer");
        const size_t vertices = data.vertices().vertices().size();
        for (const auto& [name, view] : {std::pair{"vertex_radiosity", RadiositySettings::View::radiosity},
                                         std::pair{"vertex_irradiance", RadiositySettings::View::shaded}}) {
            if (std::strcmp(values, name) != 0) continue;
            check_count(float_count, 3 * vertices, "floats");
            read_at_vertices(data, view, buffer);
            return TRP_OK;
        }
        if (std::strcmp(values, "row_sum") == 0) {
            check_count(float_count, radiosity->leaves.size(), "floats");
            const std::vector<double> sums = data.row_sums();
            if (sums.empty()) fail(TRP_ERROR_STATE, "the solver has no form factors to be summed");
            for (const uint32_t leaf : radiosity->leaves) *buffer++ = static_cast<float>(sums[leaf]);
            return TRP_OK;
        }
        std::string known = "vertex_radiosity, vertex_irradiance, row_sum";
        for (const Values& row : kValues) {
            known += std::string(", ") + row.name;
            if (std::strcmp(values, row.name) != 0) continue;
            const size_t items = row.of_vertices ? vertices : radiosity->leaves.size();
            check_count(float_count, items * static_cast<size_t>(row.count), "floats");
            for (size_t k = 0; k < items; ++k)
                row.read(data, row.of_vertices ? static_cast<uint32_t>(k) : radiosity->leaves[k],
                         buffer + k * static_cast<size_t>(row.count));
            return TRP_OK;
        }
        fail(TRP_ERROR_ARGUMENT, "a radiosity solution has no values \"{}\"; there are {}", values, known);
    });
}

TrpStatus trp_radiosity_polygons(TrpRadiosity* radiosity, uint32_t* offsets, size_t offset_count, uint32_t* vertices,
                                 size_t vertex_count) {
    return guard([&] {
        Radiosity& data = with_elements(radiosity);
        check_pointer(offsets, "offsets");
        check_pointer(vertices, "vertices");
        check_count(offset_count, radiosity->leaves.size() + 1, "offsets");
        size_t corners = 0;
        for (const uint32_t leaf : radiosity->leaves) corners += data.vertices().around(leaf).size();
        check_count(vertex_count, corners, "vertices");
        uint32_t at = 0;
        for (size_t k = 0; k < radiosity->leaves.size(); ++k) {
            const uint32_t leaf = radiosity->leaves[k];
            const auto loop = data.vertices().around(leaf);
            offsets[k] = at;
            if (data.elements()[leaf].side)
                std::reverse_copy(loop.begin(), loop.end(), vertices + at);
            else
                std::copy(loop.begin(), loop.end(), vertices + at);
            at += static_cast<uint32_t>(loop.size());
        }
        offsets[radiosity->leaves.size()] = at;
        return TRP_OK;
    });
}

TrpStatus trp_radiosity_form_factors(TrpRadiosity* radiosity, uint32_t element, double* buffer, size_t count) {
    return guard([&] {
        Radiosity& data = with_elements(radiosity);
        check_pointer(buffer, "buffer");
        check_count(count, radiosity->leaves.size(), "numbers");
        std::vector<Vec3d> row;
        data.form_factors(leaf_of(*radiosity, element), row);
        for (size_t k = 0; k < count; ++k) {
            const Vec3d& f = row[radiosity->leaves[k]];
            buffer[k] = (f.x + f.y + f.z) / 3;
        }
        return TRP_OK;
    });
}

TrpStatus trp_radiosity_projection(TrpRadiosity* radiosity, uint32_t element, uint32_t* seen, float* shares,
                                   size_t count) {
    return guard([&] {
        Radiosity& data = with_elements(radiosity);
        check_pointer(seen, "seen");
        check_pointer(shares, "shares");
        const size_t side = 2 * size_t{data.settings.radiosity.hemicube_resolution};
        check_count(count, side * side, "pixels");
        const ProjectionPicture picture = data.projection(leaf_of(*radiosity, element));
        std::transform(picture.elements.begin(), picture.elements.end(), seen,
                       [&](uint32_t leaf) { return number_of(*radiosity, leaf); });
        std::copy(picture.shares.begin(), picture.shares.end(), shares);
        return TRP_OK;
    });
}

TrpStatus trp_radiosity_write_projection(TrpRadiosity* radiosity, uint32_t element, const char* path) {
    return guard([&] {
        Radiosity& data = with_elements(radiosity);
        check_pointer(path, "path");
        const uint32_t leaf = leaf_of(*radiosity, element);
        std::vector<Vec3> reflectances;
        for (const ElementLight& light : data.solution().light) reflectances.push_back(light.reflectance);
        std::vector<float> numbers(data.elements().size(), -1.0f);
        for (size_t k = 0; k < radiosity->leaves.size(); ++k) numbers[radiosity->leaves[k]] = static_cast<float>(k);
        write_picture_file(draw_projection(data.projection(leaf), reflectances, numbers), path);
        return TRP_OK;
    });
}

TrpStatus trp_radiosity_outline(TrpRadiosity* radiosity, uint32_t element, uint32_t seen, double* corners,
                                size_t corner_count, size_t* used, double* form_factor) {
    return guard([&] {
        Radiosity& data = with_elements(radiosity);
        check_pointer(corners, "corners");
        check_pointer(used, "used");
        check_pointer(form_factor, "form_factor");
        const ElementFrame frame = frame_of(data.elements(), leaf_of(*radiosity, element));
        std::vector<Vec3d> polygon;
        data.elements().corners(leaf_of(*radiosity, seen), polygon);
        const std::vector<Vec3d> outline = project_polygon(frame, polygon);
        if (outline.size() > corner_count)
            fail(TRP_ERROR_ARGUMENT, "the buffer has {} corners where {} are needed", corner_count, outline.size());
        for (const Vec3d& corner : outline)
            for (int k = 0; k < 3; ++k) *corners++ = corner[k];
        *used = outline.size();
        *form_factor = point_to_polygon(Vec3d(frame.middle), Vec3d(frame.z), polygon);
        return TRP_OK;
    });
}

TrpStatus trp_radiosity_link(TrpRadiosity* radiosity, uint64_t index, TrpRadiosityLink* link) {
    return guard([&] {
        Radiosity& data = with_elements(radiosity);
        if (!radiosity->links_read) data.links(radiosity->links);
        radiosity->links_read = true;
        if (index >= radiosity->links.size())
            fail(TRP_ERROR_ARGUMENT, "there is no link {}; there are {}", index, radiosity->links.size());
        const ElementLink& of = radiosity->links[index];
        TrpRadiosityLink out{};
        out.receiver = number_of(*radiosity, of.receiver);
        out.source = number_of(*radiosity, of.source);
        const Vec3d& origin = data.elements().snapshot().origin;
        out.level = of.level;
        put(Vec3d(of.factor), out.factor);
        put(Vec3d(of.ends[1]) + origin, out.from);
        put(Vec3d(of.ends[0]) + origin, out.to);
        write_struct(link, out, "link");
        return TRP_OK;
    });
}

TrpStatus trp_radiosity_element_links(TrpRadiosity* radiosity, uint32_t element, uint64_t* links, size_t capacity,
                                      size_t* count) {
    return guard([&] {
        Radiosity& data = with_elements(radiosity);
        if (capacity > 0) check_pointer(links, "links");
        check_pointer(count, "count");
        const std::vector<uint64_t> numbers = data.links_to(leaf_of(*radiosity, element));
        std::copy_n(numbers.begin(), std::min(capacity, numbers.size()), links);
        *count = numbers.size();
        return TRP_OK;
    });
}

TrpStatus trp_radiosity_pick(TrpRadiosity* radiosity, const TrpRender* render, uint32_t x, uint32_t y,
                             uint32_t* element) {
    return guard([&] {
        Radiosity& data = with_elements(radiosity);
        check_pointer(render, "render");
        check_pointer(element, "element");
        const Window& film = render->window;
        if (x >= film.width || y >= film.height)
            fail(TRP_ERROR_ARGUMENT, "pixel ({}, {}) is not of a picture of {} x {}", x, y, film.width, film.height);
        *element = number_of(*radiosity, element_at(*render->snapshot, film, data.elements(), x, y));
        return TRP_OK;
    });
}

}  // extern "C"
