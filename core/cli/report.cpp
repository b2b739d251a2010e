// Warnings, progress and files that appear whole. SPDX-License-Identifier: Apache-2.0
#include "report.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <fstream>

#if defined(_WIN32)
#include <io.h>
#include <process.h>
#else
#include <unistd.h>
#endif

namespace triptych::cli {
namespace {

// "4 s", "3:05", "1:02:03"
std::string duration(double seconds) {
    const long whole = std::lround(std::min(std::max(seconds, 0.0), 1e7));
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

int process_id() {
#if defined(_WIN32)
    return _getpid();
#else
    return static_cast<int>(getpid());
#endif
}

// A name in the same folder, so that the rename stays within one file system.
std::filesystem::path beside(const std::filesystem::path& path) {
    std::filesystem::path name = path.filename();
    name += fmt::format(".{}.partial", process_id());
    return path.parent_path() / name;
}

}  // namespace

std::vector<std::string> all_warnings(const LoadedScene& loaded) {
    std::vector<std::string> lines = loaded.warnings.lines();
    const uint32_t count = trp_scene_warning_count(loaded.scene.get());
    for (uint32_t i = 0; i < count; ++i) {
        TrpWarning warning{};
        warning.struct_size = sizeof warning;
        check(trp_scene_warning(loaded.scene.get(), i, &warning));
        lines.push_back(one_line(warning.text));
    }
    return lines;
}

void print_warnings(const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) fmt::print(stderr, "triptych: warning: {}\n", one_line(warning));
}

bool error_is_terminal() {
#if defined(_WIN32)
    return _isatty(_fileno(stderr)) != 0;
#else
    return isatty(STDERR_FILENO) == 1;
#endif
}

void ProgressLine::show(const TrpProgress& progress) {
    // Ten lines a second are enough for eyes.
    if (!shown_ || (on_screen_ && progress.seconds - last_seconds_ < 0.1)) return;
    last_seconds_ = progress.seconds;
    on_screen_ = true;
    const std::string left = progress.seconds_left < 0.0 ? "" : ", " + duration(progress.seconds_left) + " left";
    const char* stage = progress.stage != nullptr ? progress.stage : "Rendering";
    fmt::print(stderr, "\r\x1b[K{}: {:.0f} %, {}{}", stage, 100.0 * progress.fraction, duration(progress.seconds),
               left);
    std::fflush(stderr);
}

void ProgressLine::clear() {
    if (!on_screen_) return;
    on_screen_ = false;
    fmt::print(stderr, "\r\x1b[K");
    std::fflush(stderr);
}

void write_file(const std::string& path, const std::string& content) {
    const std::filesystem::path target = std::filesystem::u8path(path);
    const std::filesystem::path partial = beside(target);
    std::error_code error;
    {
        std::ofstream stream(partial, std::ios::binary | std::ios::trunc);
        stream.write(content.data(), static_cast<std::streamsize>(content.size()));
        stream.flush();
        if (!stream) {
            std::filesystem::remove(partial, error);
            throw Error(path + ": it cannot be written");
        }
    }
    std::filesystem::rename(partial, target, error);
    if (error) {
        const std::string message = error.message();
        std::filesystem::remove(partial, error);
        throw Error(fmt::format("{}: it cannot be written: {}", path, message));
    }
}

void check_writable(const std::string& path) {
    const std::filesystem::path target = std::filesystem::u8path(path);
    const std::filesystem::path folder = target.has_parent_path() ? target.parent_path() : ".";
    std::error_code error;
    if (!std::filesystem::is_directory(folder, error))
        throw Error(fmt::format("{}: there is no folder '{}'", path, folder.string()));
    if (std::filesystem::is_directory(target, error)) throw Error(path + ": it is a folder");
    const std::filesystem::path probe = beside(target);
    const bool opened = static_cast<bool>(std::ofstream(probe, std::ios::binary | std::ios::trunc));
    std::filesystem::remove(probe, error);
    if (!opened) throw Error(fmt::format("{}: the folder '{}' cannot be written to", path, folder.string()));
}

}  // namespace triptych::cli
