#include "radiosity/radiosity.h"

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>

#include "base/clock.h"
#include "base/parallel.h"
#include "radiosity/coincident.h"
#include "radiosity/covered.h"
#include "radiosity/form_factors.h"
#include "radiosity/sides.h"

namespace trp {

// Work in an arena on a thread of its own, so that the caller's is free for callbacks.
bool Radiosity::run(const RenderEvents& events, std::atomic<bool>& cancelled, const std::function<void()>& work) {
    const std::lock_guard advancing(advancing_);
    std::mutex mutex;
    std::condition_variable news;
    bool done = false;
    std::exception_ptr error;
    const auto start = Clock::now();
    std::thread driver([&] {
        try {
            Arena arena(settings.threads);
            arena.run([&] {
                const FlushDenormals flush;
                work();
            });
        } catch (...) {
            error = std::current_exception();
        }
        const std::lock_guard lock(mutex);
        done = true;
        news.notify_all();
    });
    std::exception_ptr callback_error;
    std::unique_lock lock(mutex);
    while (!done) {
        news.wait_for(lock, std::chrono::milliseconds(50), [&] { return done; });
        if (done || !events.progress || cancelled) continue;
        lock.unlock();
        TrpProgress progress{};
        progress.struct_size = sizeof progress;
        progress.fraction = fraction_;
        progress.seconds = seconds_ + seconds_since(start);
        progress.seconds_left = -1;
        progress.pass = statistics_.steps;
        progress.pass_count = settings.radiosity.iterations;
        progress.stage = stage_;
        try {
            if (!events.progress(progress)) cancelled = true;
        } catch (...) {
            callback_error = std::current_exception();
            cancelled = true;
        }
        lock.lock();
    }
    lock.unlock();
    driver.join();
    seconds_ += seconds_since(start);
    if (callback_error) std::rethrow_exception(callback_error);
    if (error) std::rethrow_exception(error);
    return !cancelled;
}

void Radiosity::make_elements(std::atomic<bool>& cancelled) {
    const RadiositySettings& r = settings.radiosity;
    const bool hierarchical = r.solver == RadiositySolver::hierarchical,
               patches = r.solver == RadiositySolver::progressive && r.patch_levels > 0;
    const float size = hierarchical ? 0 : std::ldexp(r.element_size, static_cast<int>(patches ? r.patch_levels : 0));
    auto elements = std::make_shared<Elements>(snapshot_, size, hierarchical || patches);
    const LightingJob job{*elements, settings.illumination, settings.seed, &cancelled, &statistics_.rays};
    add_sides(*elements, job);
    find_covered(*elements, job, 0);
    for (uint32_t level = 0, first = 0; patches && level < r.patch_levels; ++level) {
        const uint32_t end = elements->size();
        for (; first < end; ++first) elements->divide(first);
        find_covered(*elements, job, end);
    }
    Solution solution;
    solution.light.resize(elements->size());
    solution.irradiance.assign(elements->size(), Vec3d(0, 0, 0));
    light_elements(job, 0, solution.light);
    if (cancelled) return;
    elements_ = std::move(elements);
    solution_ = std::move(solution);
    stage_ = "Solving";
    warn_of_clamped();
    warn_of_coincident();
    warn_of_mirrors();
    warn_of_many_shots();
}

void Radiosity::warn_of_coincident() {
    const Coincident faces = find_coincident(*elements_);
    if (faces.count == 0) return;
    const auto name = [&](uint32_t facet) { return snapshot_->surfaces[elements_->facets()[facet].slot].mesh->name; };
    warnings_.push_back(
        {TRP_WARNING_MESH, TRP_NO_ID,
         fmt::format("faces lie where others do, {} of them, the first of mesh \"{}\" on mesh \"{}\": which gets "
                     "the light is left to chance",
                     faces.count, name(faces.first[1]), name(faces.first[0]))});
}

void Radiosity::warn_of_mirrors() {
    std::set<uint32_t> black;
    for (const Facet& facet : elements_->facets()) {
        const CompiledMaterial& material = snapshot_->materials[facet.material];
        const float* diffuse = &material.constants[kDiffuse];
        if (material.mirrors && !material.transmits && !material.has_program() &&
            diffuse[0] + diffuse[1] + diffuse[2] == 0)
            black.insert(facet.material);
    }
    if (black.empty()) return;
    warnings_.push_back(
        {TRP_WARNING_MATERIAL, TRP_NO_ID,
         fmt::format("what is a mirror and nothing else, as material \"{}\", hands light on and is black "
                     "in pictures of radiosity ({} materials)",
                     snapshot_->materials[*black.begin()].name, black.size())});
}

void Radiosity::warn_of_many_shots() {
    constexpr uint32_t kMany = 10000;
    const RadiositySettings& r = settings.radiosity;
    if (r.solver != RadiositySolver::progressive || r.patch_levels > 0 || elements_->size() < kMany) return;
    warnings_.push_back(
        {TRP_WARNING_MESH, TRP_NO_ID,
         fmt::format("{} elements will shoot one by one: with radiosity.patch_levels 2, 16 of them shoot "
                     "together",
                     elements_->size())});
}

void Radiosity::warn_of_clamped() {
    std::set<uint32_t> clamped, dimmed;
    for (uint32_t i = 0; i < elements_->size(); ++i) {
        const uint32_t material = elements_->facet_of(i).material;
        if (solution_.light[i].clamped) clamped.insert(material);
        if (solution_.light[i].dimmed) dimmed.insert(material);
    }
    const auto warn = [&](uint32_t material, const char* what, double most) {
        warnings_.push_back(
            {TRP_WARNING_MATERIAL, TRP_NO_ID,
             fmt::format("material \"{}\" {}: {:g} of it is taken", snapshot_->materials[material].name, what, most)});
    };
    for (const uint32_t m : clamped)
        warn(m, "reflects as much as it receives or more", static_cast<double>(kGreatestReflectance));
    for (const uint32_t m : dimmed)
        warn(m, "emits or receives more W/m² than can be reckoned with", static_cast<double>(kGreatestLight));
    if (elements_->size() == 0)
        warnings_.push_back({TRP_WARNING_MESH, TRP_NO_ID, "the scene has no surface to be lit"});
}

void Radiosity::warn_of_limit() {
    if (statistics_.limit == SolverLimit::none) return;
    const std::string limit =
        statistics_.limit == SolverLimit::links
            ? fmt::format("at its limit of elements and links, {} of them", elements_->size() + statistics_.links)
            : "where no element may be divided further (radiosity.element_size)";
    warnings_.push_back({TRP_WARNING_MESH, TRP_NO_ID,
                         fmt::format("radiosity ended {}: its estimated error is {:.3g} W/m², and {:.3g} was asked for",
                                     limit, statistics_.residual, statistics_.wanted)});
}

// By steps, or the way from the first error to the one that is wanted, by its logarithm, as it falls by shares.
void Radiosity::note_progress() {
    const uint32_t most = settings.radiosity.iterations;
    const double error = statistics_.residual, wanted = statistics_.wanted;
    first_error_ = std::max(first_error_, error);
    double done = most > 0 ? static_cast<double>(statistics_.steps) / most : 0;
    if (wanted > 0 && error > wanted)
        done = std::max(done, std::log(first_error_ / error) / std::log(first_error_ / wanted));
    fraction_ = std::max(fraction_.load(), done);
}

bool Radiosity::prepare(const RenderEvents& events, std::atomic<bool>& cancelled) {
    return elements_ || run(events, cancelled, [&] { make_elements(cancelled); });
}

bool Radiosity::advance(uint32_t steps, const RenderEvents& events, std::atomic<bool>& cancelled) {
    if (!solver_) {
        const RadiositySolver solver = settings.radiosity.solver;
        solver_ = solver == RadiositySolver::matrix        ? make_matrix_solver()
                  : solver == RadiositySolver::progressive ? make_progressive_solver()
                                                           : make_hierarchical_solver();
    }
    return run(events, cancelled, [&] {
        shown_.reset();
        if (!elements_) make_elements(cancelled);
        const bool was_solved = solved_;
        const uint32_t most = settings.radiosity.iterations;
        const uint32_t before = elements_ ? elements_->size() : 0;
        for (uint32_t k = 0; (steps == 0 || k < steps) && !solved_ && !cancelled; ++k) {
            if (steps == 0 && most > 0 && statistics_.steps >= most) break;
            const SolverJob job{*elements_, solution_, settings, statistics_, cancelled, fraction_};
            solved_ = !solver_->step(job) && !cancelled;
            note_progress();
        }
        if (elements_ && elements_->size() != before) vertices_.reset();  // they depend on nothing else
        if (solved_ && !was_solved) warn_of_limit();
    });
}

void Radiosity::form_factors(uint32_t element, std::vector<Vec3d>& out) {
    std::atomic<bool> cancelled{false};
    out.resize(elements_->size());
    Arena arena(settings.threads);
    arena.run([&] {
        form_factor_row({*elements_, settings.radiosity, settings.seed, &cancelled, &statistics_.rays}, element, 0,
                        out.data());
    });
}

ProjectionPicture Radiosity::projection(uint32_t element) {
    std::atomic<bool> cancelled{false};
    ProjectionPicture out;
    Arena arena(settings.threads);
    arena.run([&] {
        out = make_projection_picture({*elements_, settings.radiosity, settings.seed, &cancelled, &statistics_.rays},
                                      element);
    });
    return out;
}

const ElementVertices& Radiosity::vertices() {
    if (!vertices_) vertices_ = std::make_shared<const ElementVertices>(*elements_);
    return *vertices_;
}

// Of the leaf of that number.
void Radiosity::show_form_factors(uint32_t number, ShownSolution& out) {
    uint32_t leaves = 0;
    for (uint32_t i = 0; i < elements_->size(); ++i)
        if ((*elements_)[i].leaf() && leaves++ == number) out.chosen = i;
    if (out.chosen == kNoElement)
        fail(TRP_ERROR_ARGUMENT, "radiosity.view_element: there is no element {}; there are {}", number, leaves);
    std::vector<Vec3d> row;
    form_factors(out.chosen, row);
    for (size_t k = 0; k < row.size(); ++k) {
        const auto mean = static_cast<float>((row[k].x + row[k].y + row[k].z) / 3);
        out.leaves[k] = {mean, mean, mean};
    }
}

std::shared_ptr<const ShownSolution> Radiosity::shown(const RadiositySettings& view) {
    const std::unique_lock lock(advancing_, std::try_to_lock);
    if (!lock) fail(TRP_ERROR_STATE, "the radiosity solution is being advanced");
    if (!elements_) return nullptr;
    const Aspect aspect{view.view, view.ambient, view.view_element};
    if (!shown_ || aspect != aspect_) shown_ = make_shown(view), aspect_ = aspect;
    return shown_;
}

std::shared_ptr<const ShownSolution> Radiosity::make_shown(const RadiositySettings& view) {
    auto out = std::make_shared<ShownSolution>();
    vertices();
    out->vertices = vertices_;
    out->elements = shown_ ? shown_->elements : std::make_shared<const Elements>(*elements_);
    out->leaves.resize(elements_->size(), Vec3(0, 0, 0));
    if (view.view == RadiositySettings::View::form_factors) {
        show_form_factors(view.view_element, *out);
        return out;
    }
    for (uint32_t i = 0; i < elements_->size(); ++i) {
        if (!(*elements_)[i].leaf()) continue;
        Vec3d arriving = solution_.irradiance[i] + Vec3d(solution_.light[i].irradiance);
        if (view.ambient) arriving += solution_.ambient;
        if (view.view == RadiositySettings::View::radiosity)
            arriving = Vec3d(solution_.light[i].emission) + solution_.reflected(i, arriving);
        else if (view.view == RadiositySettings::View::unshot)
            arriving = solution_.unshot.empty() ? Vec3d(0, 0, 0) : solution_.unshot[i];
        out->leaves[i] = Vec3(arriving);
    }
    std::vector<std::array<Vec3, 2>> slopes;
    if (view.view != RadiositySettings::View::unshot) slopes = solution_.slopes;
    if (view.view == RadiositySettings::View::radiosity)
        for (uint32_t i = 0; i < slopes.size(); ++i)
            for (Vec3& slope : slopes[i]) slope *= solution_.light[i].reflectance;
    out->at_vertices = out->vertices->average(*elements_, out->leaves, slopes);
    return out;
}

void Radiosity::links(std::vector<ElementLink>& out) const {
    out.clear();
    if (!solver_) return;
    solver_->links(*elements_, out);
    std::vector<int32_t> levels(elements_->size(), 0);
    for (uint32_t i = 0; i < elements_->size(); ++i)
        for (uint32_t k = 0; k < 4 && !(*elements_)[i].leaf(); ++k)
            levels[(*elements_)[i].first_child + k] = levels[i] + 1;
    for (ElementLink& link : out)
        if (link.receiver != kNoElement) link.level = levels[link.receiver];
}

std::vector<uint64_t> Radiosity::links_to(uint32_t leaf) const {
    return solver_ ? solver_->links_to(*elements_, leaf) : std::vector<uint64_t>();
}

std::vector<double> Radiosity::row_sums() const {
    return solver_ ? solver_->row_sums(*elements_) : std::vector<double>();
}

}  // namespace trp
