// Renders.
#include <sys/resource.h>

#include <algorithm>
#include <utility>

#include "api/guard.h"
#include "api/handles.h"
#include "base/clock.h"
#include "base/parallel.h"
#include "film/picture_file.h"
#include "film/view.h"
#include "radiosity/scene_hash.h"
#include "raster/rasterizer.h"

namespace trp {

RenderEvents events_of(const TrpCallbacks* given) {
    RenderEvents events;
    if (!given) return events;
    const TrpCallbacks callbacks = read_struct(given, TrpCallbacks{}, "callbacks");
    if (callbacks.progress)
        events.progress = [=](const TrpProgress& p) { return callbacks.progress(callbacks.user, &p) != 0; };
    if (callbacks.tile) events.tile = [=](const TrpTile& t) { return callbacks.tile(callbacks.user, &t) != 0; };
    if (callbacks.log) events.log = [=](const std::string& text) { callbacks.log(callbacks.user, text.c_str()); };
    return events;
}

}  // namespace trp

using namespace trp;

namespace {

uint64_t peak_memory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<uint64_t>(usage.ru_maxrss) * 1024;
}

// The film of a run, in place of that of the run before, which comes back if this one fails. Else it is kept, unless it
// is large, for the next run: the system's fresh memory costs more than drawing a simple frame.
struct NewFilm {
    explicit NewFilm(TrpRender& render) : render(render) {
        std::unique_ptr<Film> film = std::move(render.spare_film);
        if (film && film->is_for(render.window, render.passes))
            film->clear();
        else
            film = std::make_unique<Film>(render.window, render.passes);
        before = std::exchange(render.film, std::move(film));
    }
    ~NewFilm() {
        constexpr size_t kMostSpareBytes = size_t{256} << 20;
        if (!kept)
            render.film = std::move(before);
        else if (before && before->bytes() <= kMostSpareBytes)
            render.spare_film = std::move(before);
    }
    NewFilm(const NewFilm&) = delete;
    NewFilm& operator=(const NewFilm&) = delete;
    TrpRender& render;
    std::unique_ptr<Film> before;
    bool kept = false;
};

bool shows_radiosity(const TrpRender& render) {
    return kMethods[render.method].run == radiosity_view;
}

// What a render of radiosity shows: the solution that it was given, or one that it finds now. Null for other methods,
// and where it was cancelled.
std::shared_ptr<const ShownSolution> solution_for(TrpRender& render, const RenderEvents& events, TrpStatistics& s) {
    if (!shows_radiosity(render)) return nullptr;
    if (render.radiosity) return render.radiosity->shown(render.settings.radiosity);
    Radiosity radiosity(render.snapshot);
    radiosity.settings = render.settings;
    const bool whole = radiosity.advance(0, events, render.cancelled);
    s.solve_seconds = radiosity.seconds();
    s.gather_rays = radiosity.statistics().rays;
    s.links = radiosity.statistics().links;
    s.iterations = radiosity.statistics().steps;
    s.residual = radiosity.statistics().residual;
    if (!whole) return nullptr;
    auto shown = radiosity.shown(render.settings.radiosity);
    s.elements = shown->leaf_count();
    return shown;
}

void check_idle(const TrpRender* render) {
    check_pointer(render, "render");
    if (render->running) fail(TRP_ERROR_STATE, "the render is running");
}

void check_pixel(const Window& window, uint32_t x, uint32_t y) {
    if (x >= window.width || y >= window.height)
        fail(TRP_ERROR_ARGUMENT, "pixel ({}, {}) is not of a picture of {} x {}", x, y, window.width, window.height);
}

const Film& film_of(const TrpRender* render) {
    check_pointer(render, "render");
    if (!render->film) fail(TRP_ERROR_STATE, "the render has not run");
    return *render->film;
}

}  // namespace

extern "C" {

TrpStatus trp_render_create(TrpScene* scene, const char* method, TrpRender** render) {
    return guard([&] {
        check_pointer(scene, "scene");
        check_pointer(method, "method");
        check_pointer(render, "render");
        if (!scene->snapshot) fail(TRP_ERROR_STATE, "the scene was never committed");
        std::string known;
        for (uint32_t m = 0; m < kMethodCount; ++m) {
            if (std::strcmp(method, kMethods[m].name) == 0) {
                auto made = std::make_unique<TrpRender>();
                made->snapshot = scene->snapshot;
                made->method = m;
                made->settings = default_settings(method);
                *render = made.release();
                return TRP_OK;
            }
            known += std::string(m ? ", " : "") + kMethods[m].name;
        }
        fail(TRP_ERROR_ARGUMENT, "there is no method \"{}\"; the methods are {}", method, known);
    });
}

void trp_render_destroy(TrpRender* render) {
    delete render;
}

TrpStatus trp_render_set_film(TrpRender* render, uint32_t width, uint32_t height, uint32_t x, uint32_t y, uint32_t w,
                              uint32_t h) {
    return guard([&] {
        check_idle(render);
        const bool whole = w == 0 && h == 0;
        const Window window{width, height, whole ? 0 : x, whole ? 0 : y, whole ? width : w, whole ? height : h};
        check_window(window);
        render->window = window;
        return TRP_OK;
    });
}

TrpStatus trp_render_set(TrpRender* render, const char* name, const char* value) {
    return guard([&] {
        check_idle(render);
        check_pointer(name, "name");
        check_pointer(value, "value");
        set_setting(render->settings, name, value);
        return TRP_OK;
    });
}

TrpStatus trp_render_add_pass(TrpRender* render, const char* name) {
    return guard([&] {
        check_idle(render);
        check_pointer(name, "name");
        render->passes.add(find_pass(name, kMethods[render->method].name));
        return TRP_OK;
    });
}

TrpStatus trp_callbacks_init(TrpCallbacks* callbacks, size_t size) {
    return init_struct(callbacks, size, TrpCallbacks{});
}

TrpStatus trp_render_run(TrpRender* render, const TrpCallbacks* callbacks) {
    return guard([&] {
        check_pointer(render, "render");
        const RenderEvents events = events_of(callbacks);
        const Running running(*render, "render");
        NewFilm film(*render);
        RenderJob::Counts counts;
        TrpStatistics s{};
        const auto solution = solution_for(*render, events, s);
        RenderJob job{render->snapshot, render->settings, render->film.get(), &render->cancelled, &counts, solution};
        const auto start = Clock::now();
        const bool whole = (solution || !shows_radiosity(*render)) && kMethods[render->method].run(job, events);
        film.kept = true;
        s.threads = thread_count(render->settings.threads);
        s.render_seconds = seconds_since(start);
        s.primary_rays = counts.primary_rays;
        s.shadow_rays = counts.shadow_rays;
        s.reflection_rays = counts.reflection_rays;
        s.transmission_rays = counts.transmission_rays;
        s.gather_rays += counts.diffuse_rays;
        s.primary_seconds = 1e-9 * static_cast<double>(counts.primary_time);
        s.shadow_seconds = 1e-9 * static_cast<double>(counts.shadow_time);
        s.shading_seconds = 1e-9 * static_cast<double>(counts.shading_time);
        s.triangles = render->snapshot->info.triangle_count;
        s.peak_memory_bytes = peak_memory();
        render->statistics = s;
        return whole ? TRP_OK : TRP_CANCELLED;
    });
}

TrpStatus trp_render_set_radiosity(TrpRender* render, TrpRadiosity* radiosity) {
    return guard([&] {
        check_idle(render);
        check_pointer(radiosity, "radiosity");
        const Running running(*radiosity, "radiosity solution");
        if (!shows_radiosity(*render))
            fail(TRP_ERROR_STATE, "{} shows no radiosity solution; radiosity does", kMethods[render->method].name);
        if (!radiosity->data->has_elements()) fail(TRP_ERROR_STATE, "the radiosity solution has not been begun");
        if (radiosity->data->snapshot() != render->snapshot &&
            scene_hash(*radiosity->data->snapshot()) != scene_hash(*render->snapshot))
            fail(TRP_ERROR_STATE, "the radiosity solution is that of another scene");
        render->radiosity = radiosity->data;
        return TRP_OK;
    });
}

TrpStatus trp_render_cancel(TrpRender* render) {
    return guard([&] {
        check_pointer(render, "render");
        const std::lock_guard lock(render->state);
        if (render->running) render->cancelled = true;
        return TRP_OK;
    });
}

TrpStatus trp_render_read(const TrpRender* render, const char* pass, uint32_t x, uint32_t y, uint32_t width,
                          uint32_t height, float* buffer, size_t float_count) {
    return guard([&] {
        const Film& film = film_of(render);
        check_pointer(pass, "pass");
        check_pointer(buffer, "buffer");
        const PassId id = find_pass(pass, kMethods[render->method].name);
        if (!film.passes().has(id)) fail(TRP_ERROR_STATE, "pass {} was not asked for before the render ran", pass);
        const Window& window = film.window();
        if (x < window.x || y < window.y || x + uint64_t{width} > window.x + uint64_t{window.w} ||
            y + uint64_t{height} > window.y + uint64_t{window.h})
            fail(TRP_ERROR_ARGUMENT,
                 "{} x {} pixels at ({}, {}) are not within the render's window of {} x {} at ({}, {})", width, height,
                 x, y, window.w, window.h, window.x, window.y);
        const uint64_t needed = uint64_t{width} * height * channel_count(id);
        if (float_count != needed)
            fail(TRP_ERROR_ARGUMENT, "the buffer has {} floats where {} are needed", float_count, needed);
        film.read(id, x, y, width, height, buffer);
        return TRP_OK;
    });
}

TrpStatus trp_render_write(const TrpRender* render, const char* path) {
    return guard([&] {
        check_idle(render);
        check_pointer(path, "path");
        write_picture_file(film_of(render), path);
        return TRP_OK;
    });
}

TrpStatus trp_render_project(const TrpRender* render, const float* positions, size_t count, float* film) {
    return guard([&] {
        check_idle(render);
        check_pointer(positions, "positions");
        check_pointer(film, "film");
        const Snapshot& snapshot = *render->snapshot;
        if (!snapshot.camera) fail(TRP_ERROR_STATE, "the scene has no camera");
        const View view = make_view(*snapshot.camera, snapshot.origin, render->window.width, render->window.height);
        for (size_t k = 0; k < count; ++k, positions += 3, film += 3) {
            const Vec3 way(Vec3d(positions[0], positions[1], positions[2]) - snapshot.origin - Vec3d(view.position));
            const float depth = -view.z.dot(way), over = view.perspective ? depth : 1;
            film[0] = (view.x.dot(way) / over - view.left) / view.step_x;
            film[1] = (view.y.dot(way) / over - view.bottom) / view.step_y;
            film[2] = depth;
        }
        return TRP_OK;
    });
}

TrpStatus trp_render_pick_scan_line(const TrpRender* render, uint32_t x, uint32_t y, TrpScanLine* scan_line) {
    return guard([&] {
        check_idle(render);
        const std::string method = kMethods[render->method].name;
        if (method != "gouraud" && method != "phong")
            fail(TRP_ERROR_STATE, "{} interpolates nothing along scan lines; gouraud and phong do", method);
        check_pixel(render->window, x, y);
        Film film({render->window.width, render->window.height, x, y, 1, 1}, PassList());
        std::atomic<bool> cancelled{false};
        RenderJob::Counts counts;
        const PickedScanLine picked =
            pick_scan_line({render->snapshot, render->settings, &film, &cancelled, &counts, nullptr},
                           method == "gouraud" ? ScannedValue::radiance : ScannedValue::normal, x, y);
        TrpScanLine out{};
        if (picked.surface) {
            out.seen = 1;
            out.instance = picked.surface->instance;
            out.face = picked.face;
            out.mesh = picked.surface->mesh->name.c_str();
            const auto copy = [](const Vec3& from, float* to) { std::copy_n(&from.x, 3, to); };
            for (int k = 0; k < 4; ++k) {
                const PolygonPoint& end = picked.line.ends[k];
                out.vertices[k] = end.is_corner() ? picked.surface->mesh->corner_vertices[end.corner] : TRP_NO_VERTEX;
                copy(picked.values.ends[k], out.values[k]);
            }
            out.alpha = picked.line.alpha, out.beta = picked.line.beta, out.gamma = picked.line.gamma;
            copy(picked.values.a, out.a);
            copy(picked.values.b, out.b);
            copy(picked.values.value, out.value);
        }
        write_struct(scan_line, out, "scan_line");
        return TRP_OK;
    });
}

TrpStatus trp_render_trace_tree(TrpRender* render, uint32_t x, uint32_t y, uint32_t* count) {
    return guard([&] {
        check_pointer(count, "count");
        check_idle(render);
        const std::string method = kMethods[render->method].name;
        if (method != "ray_tracing") fail(TRP_ERROR_STATE, "{} traces no tree; ray_tracing does", method);
        check_pixel(render->window, x, y);
        Film film({render->window.width, render->window.height, x, y, 1, 1}, PassList());
        std::atomic<bool> cancelled{false};
        RenderJob::Counts counts;
        render->tree = trace_ray_tree({render->snapshot, render->settings, &film, &cancelled, &counts, nullptr}, x, y);
        *count = static_cast<uint32_t>(render->tree.size());
        return TRP_OK;
    });
}

TrpStatus trp_render_ray(const TrpRender* render, uint32_t index, TrpRay* ray) {
    return guard([&] {
        check_idle(render);
        if (index >= render->tree.size())
            fail(TRP_ERROR_ARGUMENT, "there is no ray {} in the tree; there are {}", index, render->tree.size());
        const RayNode& node = render->tree[index];
        TrpRay out{};
        out.kind = static_cast<int32_t>(node.kind);
        out.end = static_cast<int32_t>(node.end);
        out.parent = node.parent < 0 ? TRP_NO_PARENT : static_cast<uint32_t>(node.parent);
        out.object = out.material = "";
        out.instance = TRP_NO_ID;
        if (node.end == RayNode::End::surface) {
            const PlacedSurface& surface = render->snapshot->surfaces[node.slot];
            out.object = surface.mesh->name.c_str();
            out.material = render->snapshot->materials[node.material].name.c_str();
            out.instance = surface.instance;
        }
        out.distance = node.distance;
        const auto copy = [](const Vec3& from, float* to) { std::copy_n(&from.x, 3, to); };
        copy(node.origin, out.origin);
        copy(node.direction, out.direction);
        copy(node.position, out.position);
        copy(node.normal, out.normal);
        copy(node.local, out.local);
        copy(node.weight, out.weight);
        copy(node.intensity, out.intensity);
        write_struct(ray, out, "ray");
        return TRP_OK;
    });
}

TrpStatus trp_render_statistics(const TrpRender* render, TrpStatistics* statistics) {
    return guard([&] {
        film_of(render);
        write_struct(statistics, render->statistics, "statistics");
        return TRP_OK;
    });
}

}  // extern "C"
