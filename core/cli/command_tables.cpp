// `triptych methods`, `settings` and `passes`: the core's tables, as text and as JSON. SPDX-License-Identifier:
// Apache-2.0
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "tables.h"

namespace triptych::cli {
namespace {

using nlohmann::ordered_json;

std::vector<std::string> words(const char* text) {
    std::vector<std::string> list;
    std::string word;
    for (const char* at = text; at != nullptr && *at != '\0'; ++at) {
        if (*at != ' ') {
            word.push_back(*at);
        } else if (!word.empty()) {
            list.push_back(std::move(word));
            word.clear();
        }
    }
    if (!word.empty()) list.push_back(std::move(word));
    return list;
}

const char* text_or_empty(const char* text) {
    return text != nullptr ? text : "";
}

std::string type_name(int32_t type) {
    switch (type) {
        case TRP_TYPE_BOOL:
            return "bool";
        case TRP_TYPE_INT:
            return "int";
        case TRP_TYPE_FLOAT:
            return "float";
        case TRP_TYPE_COLOR:
            return "color";
        case TRP_TYPE_ENUM:
            return "enum";
        default:
            return "unknown";
    }
}

bool has_range(int32_t type) {
    return type == TRP_TYPE_INT || type == TRP_TYPE_FLOAT || type == TRP_TYPE_COLOR;
}

std::vector<std::string> choices_of(const TrpSettingInfo& setting) {
    std::vector<std::string> list;
    for (const char* const* choice = setting.choices; choice != nullptr && *choice != nullptr; ++choice) {
        list.emplace_back(*choice);
    }
    return list;
}

std::string range_text(const TrpSettingInfo& setting) {
    if (setting.type == TRP_TYPE_ENUM) return fmt::format("{}", fmt::join(choices_of(setting), "|"));
    if (setting.type == TRP_TYPE_BOOL) return "on|off";
    return fmt::format("{} {} to {}", type_name(setting.type), setting.minimum, setting.maximum);
}

int print_json(const ordered_json& json) {
    fmt::print("{}\n", json.dump(2));
    return 0;
}

int print_methods(bool as_json) {
    ordered_json list = ordered_json::array();
    for (const TrpMethodInfo& method : all_methods()) {
        if (as_json) {
            list.push_back({{"name", method.name},
                            {"label", text_or_empty(method.label)},
                            {"description", text_or_empty(method.description)}});
        } else {
            fmt::print("{:<16} {}\n", method.name, text_or_empty(method.description));
        }
    }
    return as_json ? print_json(list) : 0;
}

int print_settings(bool as_json) {
    ordered_json list = ordered_json::array();
    for (const TrpSettingInfo& setting : all_settings()) {
        if (!as_json) {
            const std::string unit = text_or_empty(setting.unit);
            fmt::print("{:<26} {}\n{:<26} {}{}, default {}\n", setting.name, text_or_empty(setting.description), "",
                       range_text(setting), unit.empty() ? "" : " " + unit, text_or_empty(setting.default_value));
            const std::vector<std::string> others = words(setting.method_defaults);
            if (!others.empty()) fmt::print("{:<26} {}\n", "", fmt::join(others, ", "));
            continue;
        }
        ordered_json entry = {{"name", setting.name},
                              {"label", text_or_empty(setting.label)},
                              {"type", type_name(setting.type)},
                              {"default", text_or_empty(setting.default_value)},
                              {"unit", text_or_empty(setting.unit)},
                              {"description", text_or_empty(setting.description)},
                              {"methods", words(setting.methods)}};
        for (const std::string& word : words(setting.method_defaults)) {
            const size_t at = word.find('=');
            entry["method_defaults"][word.substr(0, at)] = word.substr(at + 1);
        }
        // JSON has no infinity.
        const auto bound = [&](double value) { return std::isfinite(value) ? ordered_json(value) : ordered_json(); };
        if (has_range(setting.type)) {
            entry["minimum"] = bound(setting.minimum);
            entry["maximum"] = bound(setting.maximum);
        }
        if (setting.type == TRP_TYPE_ENUM) entry["choices"] = choices_of(setting);
        list.push_back(std::move(entry));
    }
    return as_json ? print_json(list) : 0;
}

int print_passes(bool as_json) {
    ordered_json list = ordered_json::array();
    for (const TrpPassInfo& pass : all_passes()) {
        if (as_json) {
            list.push_back({{"name", pass.name},
                            {"channels", text_or_empty(pass.channels)},
                            {"description", text_or_empty(pass.description)},
                            {"methods", words(pass.methods)}});
        } else {
            fmt::print("{:<20} {:<5} {}\n", pass.name, text_or_empty(pass.channels), text_or_empty(pass.description));
        }
    }
    return as_json ? print_json(list) : 0;
}

Command add_table(CLI::App& program, const char* name, const char* description, int (*print)(bool)) {
    CLI::App* app = program.add_subcommand(name, description);
    const auto as_json = std::make_shared<bool>(false);
    app->add_flag("--json", *as_json, "As JSON");
    return {app, [=] { return print(*as_json); }};
}

}  // namespace

Command add_methods_command(CLI::App& program) {
    return add_table(program, "methods", "List the methods of rendering", print_methods);
}

Command add_settings_command(CLI::App& program) {
    return add_table(program, "settings", "List the settings that --set takes", print_settings);
}

Command add_passes_command(CLI::App& program) {
    return add_table(program, "passes", "List the passes that --pass takes", print_passes);
}

}  // namespace triptych::cli
