// The command `triptych`: parses the command line, runs one command, and turns what goes wrong into one line and an
// exit code: 0 done, 1 the work failed, 2 wrong usage, 130 interrupted. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <new>

#include "commands.h"
#include "error.h"
#include "interrupt.h"

namespace {

using namespace triptych::cli;

constexpr int failed = 1;
constexpr int wrong_usage = 2;

int report(const std::string& message, int code) {
    fmt::print(stderr, "triptych: error: {}\n", one_line(message));
    return code;
}

std::string version_text() {
    const uint32_t version = trp_version();
    return fmt::format("triptych {}.{}.{}", version / 10000, version / 100 % 100, version % 100);
}

int run(int argc, char** argv) {
    CLI::App program("Triptych renders glTF scenes by rasterization, ray tracing and radiosity.", "triptych");
    program.set_version_flag("--version", version_text);
    program.require_subcommand(0, 1);  // none is answered below: CLI11 would not name a command it does not know
    program.fallthrough(false);
    const std::vector<Command> commands = {
        add_render_command(program),   add_info_command(program),      add_pick_command(program),
        add_ray_tree_command(program), add_radiosity_command(program), add_form_factors_command(program),
        add_methods_command(program),  add_settings_command(program),  add_passes_command(program)};
    try {
        program.parse(argc, argv);
    } catch (const CLI::Success& success) {
        // --help and --version
        program.exit(success);
        return std::fflush(stdout) == 0 ? 0 : failed;
    } catch (const CLI::ParseError& error) {
        return report(error.what(), wrong_usage);
    }
    for (const Command& command : commands) {
        if (command.app->parsed()) return command.run();
    }
    return report(
        "a command is required: render, info, pick, ray-tree, radiosity, form-factors, methods, "
        "settings or passes",
        wrong_usage);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const UsageError& error) {
        return report(error.what(), wrong_usage);
    } catch (const Interrupted& error) {
        return report(error.what(), InterruptGuard::exit_code());
    } catch (const std::bad_alloc&) {
        return report("there is not enough memory", failed);
    } catch (const std::exception& error) {
        return report(error.what(), failed);
    }
}
