// `triptych form-factors`: the matrix of a scene's form factors, or rows of it, and pictures of one.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <memory>

#include "commands.h"
#include "projection_svg.h"
#include "radiosity_job.h"
#include "report.h"

namespace triptych::cli {
namespace {

struct Options : PictureJob {
    std::string output, rows_text, picture;
    uint32_t element = 0;
};

bool ends_in(const std::string& text, const char* end) {
    const size_t length = std::strlen(end);
    return text.size() >= length && text.compare(text.size() - length, length, end) == 0;
}

// A two-dimensional array of little-endian doubles as numpy.load reads it (NumPy Enhancement Proposal 1, version 1.0).
std::string npy(const std::vector<double>& values, size_t rows, size_t columns) {
    static_assert(std::endian::native == std::endian::little);
    std::string header = fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, {}), }}", rows, columns);
    constexpr size_t kBefore = 10, kAlignment = 64;
    header.append((kAlignment - (kBefore + header.size() + 1) % kAlignment) % kAlignment, ' ');
    header += '\n';
    std::string out("\x93NUMPY\x01\x00", 8);
    out += static_cast<char>(header.size() & 0xFF);
    out += static_cast<char>(header.size() >> 8);
    out += header;
    out.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
    return out;
}

std::string csv(const std::vector<double>& values, size_t columns) {
    std::string out;
    for (size_t k = 0; k < values.size(); ++k)
        out += fmt::format("{:.17g}{}", values[k], (k + 1) % columns ? ',' : '\n');
    return out;
}

std::vector<uint32_t> chosen_rows(const std::string& text, uint32_t count) {
    std::vector<uint32_t> rows;
    if (text.empty()) {
        for (uint32_t k = 0; k < count; ++k) rows.push_back(k);
        return rows;
    }
    rows.resize(static_cast<size_t>(std::count(text.begin(), text.end(), ',')) + 1);
    if (!parse_numbers(text, rows.data(), rows.size()))
        throw UsageError(fmt::format("--rows: '{}' is not a list of numbers like 0,7,12", text));
    for (const uint32_t row : rows)
        if (row >= count) throw UsageError(fmt::format("--rows: there is no element {}; there are {}", row, count));
    return rows;
}

void write_rows(const Options& options, TrpRadiosity* radiosity, uint32_t count, InterruptGuard& guard) {
    const std::vector<uint32_t> rows = chosen_rows(options.rows_text, count);
    std::vector<double> values(rows.size() * count);
    for (size_t k = 0; k < rows.size(); ++k)
        check(trp_radiosity_form_factors(radiosity, rows[k], values.data() + k * count, count));
    guard.hold();
    write_file(options.output,
               ends_in(options.output, ".npy") ? npy(values, rows.size(), count) : csv(values, std::max(count, 1u)));
}

void write_picture(const Options& options, TrpRadiosity* radiosity, uint32_t count) {
    if (options.element >= count)
        throw UsageError(fmt::format("--element: there is no element {}; there are {}", options.element, count));
    if (ends_in(options.picture, ".svg"))
        write_projection_svg(radiosity, options.element, options.picture);
    else
        check(trp_radiosity_write_projection(radiosity, options.element, options.picture.c_str()));
}

int run(Options options) {
    if (options.output.empty() && options.picture.empty()) throw UsageError("--output or --picture is required");
    if (!options.output.empty() && !ends_in(options.output, ".npy") && !ends_in(options.output, ".csv"))
        throw UsageError(fmt::format("--output: '{}' does not end in .npy or .csv", options.output));
    if (!options.picture.empty() && !ends_in(options.picture, ".png") && !ends_in(options.picture, ".exr") &&
        !ends_in(options.picture, ".svg"))
        throw UsageError(fmt::format("--picture: '{}' does not end in .png, .exr or .svg", options.picture));
    // Elements as other solvers than the hierarchical one have them, which begins with undivided faces.
    options.set.insert(options.set.begin(), "radiosity.solver=matrix");
    check_picture(options);
    for (const std::string* path : {&options.output, &options.picture})
        if (!path->empty()) check_writable(*path);
    InterruptGuard guard;
    LoadedPicture picture = load_picture(options);
    const RenderHandle render = make_picture(options, picture);
    const RadiosityHandle radiosity = make_radiosity(options, picture);
    SolveCallbacks callbacks(options.quiet);
    if (!callbacks.check_whole(trp_radiosity_prepare(radiosity.get(), callbacks.get())))
        throw Interrupted("interrupted");
    print_radiosity_warnings(options, radiosity.get());
    const uint32_t count = info_of(radiosity.get()).element_count;
    if (!options.output.empty()) write_rows(options, radiosity.get(), count, guard);
    guard.hold();
    if (!options.picture.empty()) write_picture(options, radiosity.get(), count);
    if (guard.interrupted()) throw Interrupted("interrupted: all is written");
    return 0;
}

}  // namespace

Command add_form_factors_command(CLI::App& program) {
    CLI::App* app = program.add_subcommand("form-factors", "Write or draw the form factors between a scene's elements");
    const auto options = std::make_shared<Options>();
    options->method = "radiosity";
    add_scene_options(*app, *options);
    CLI::Option* output =
        app->add_option("--output", options->output, ".npy, doubles, or .csv: a row for each element");
    app->add_option("--rows", options->rows_text, "0,7,12,…: these rows alone")->needs(output);
    CLI::Option* picture = app->add_option(
        "--picture", options->picture,
        ".png, .exr: what an element sees, on the unfolded faces of a hemicube where "
        "radiosity.form_factors is hemicube, else projected to the hemisphere and its base circle; .svg: the "
        "elements themselves, projected so");
    app->add_option("--element", options->element, "The number of the row that is drawn")
        ->capture_default_str()
        ->needs(picture);
    return {app, [options] { return run(*options); }};
}

}  // namespace triptych::cli
