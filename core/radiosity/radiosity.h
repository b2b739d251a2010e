// A radiosity solution of a scene: made ready, advanced step by step, and read.
#pragma once

#include <memory>
#include <mutex>

#include "film/tiles.h"
#include "radiosity/projection_picture.h"
#include "radiosity/solver.h"
#include "radiosity/view.h"

namespace trp {

class Radiosity {
  public:
    explicit Radiosity(std::shared_ptr<const Snapshot> snapshot) : snapshot_(std::move(snapshot)) {}

    const std::shared_ptr<const Snapshot>& snapshot() const { return snapshot_; }
    // May be changed until the first step.
    Settings settings;
    bool has_elements() const { return elements_ != nullptr; }
    bool solved() const { return solved_; }

    // So many steps (0: until it is solved, or radiosity.iterations are done). Returns false where it was cancelled;
    // what was done by then stands. Callbacks on the calling thread.
    bool advance(uint32_t steps, const RenderEvents& events, std::atomic<bool>& cancelled);
    // Without solving: elements and what they are made of.
    bool prepare(const RenderEvents& events, std::atomic<bool>& cancelled);
    // Where no step has been made yet; a row of form factors by colour, of elements in their order.
    void form_factors(uint32_t element, std::vector<Vec3d>& out);

    // What an element sees, as radiosity.form_factors projects it.
    ProjectionPicture projection(uint32_t element);

    const Elements& elements() const { return *elements_; }
    const Solution& solution() const { return solution_; }
    const SolverStatistics& statistics() const { return statistics_; }
    double seconds() const { return seconds_; }
    const std::vector<Warning>& warnings() const { return warnings_; }
    void links(std::vector<ElementLink>& out) const;
    // As Solver has them.
    std::vector<uint64_t> links_to(uint32_t leaf) const;
    std::vector<double> row_sums() const;
    const ElementVertices& vertices();  // of the elements as they are; made on first use
    // As it is now, for renders, which hold it; null where there are no elements yet. `view`: the settings of the
    // render that shows it. Made once for frames that follow each other. Throws Error while another thread advances it.
    std::shared_ptr<const ShownSolution> shown(const RadiositySettings& view);

  private:
    bool run(const RenderEvents& events, std::atomic<bool>& cancelled, const std::function<void()>& work);
    void make_elements(std::atomic<bool>& cancelled);
    void warn_of_clamped();
    void warn_of_mirrors();
    void warn_of_coincident();
    void warn_of_many_shots();
    void warn_of_limit();
    void note_progress();
    std::shared_ptr<const ShownSolution> make_shown(const RadiositySettings& view);
    void show_form_factors(uint32_t number, ShownSolution& out);
    // What of the settings says which values are shown.
    struct Aspect {
        RadiositySettings::View view = RadiositySettings::View::shaded;
        bool ambient = false;
        uint32_t element = 0;
        bool operator==(const Aspect&) const = default;
    };

    std::shared_ptr<const Snapshot> snapshot_;
    std::shared_ptr<Elements> elements_;
    std::shared_ptr<const ElementVertices> vertices_;
    std::shared_ptr<const ShownSolution> shown_;  // of the solution as it is, or null
    Aspect aspect_;                               // of shown_
    Solution solution_;
    SolverStatistics statistics_;
    std::unique_ptr<Solver> solver_;
    std::mutex advancing_;
    // For progress, read while the solver runs.
    std::atomic<double> fraction_{0};
    std::atomic<const char*> stage_{"Preparing"};
    std::vector<Warning> warnings_;
    double seconds_ = 0, first_error_ = 0;
    bool solved_ = false;
};

}  // namespace trp
