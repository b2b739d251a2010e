// The commands. Each adds itself to the command line, in a file of its own, and runs when it was called. A command says
// what it does through its return value (an exit code) or an Error. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

namespace CLI {
class App;
}

namespace triptych::cli {

struct Command {
    CLI::App* app;
    std::function<int()> run;
};

Command add_render_command(CLI::App& program);
Command add_info_command(CLI::App& program);
Command add_pick_command(CLI::App& program);
Command add_ray_tree_command(CLI::App& program);
Command add_radiosity_command(CLI::App& program);
Command add_form_factors_command(CLI::App& program);
Command add_methods_command(CLI::App& program);
Command add_settings_command(CLI::App& program);
Command add_passes_command(CLI::App& program);

}  // namespace triptych::cli
