// The command as others call it, in a process of its own. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "gltf_builder.h"

namespace triptych::test {

struct Outcome {
    int code = -1;
    std::string out, error;
};

inline std::string text_of(const std::filesystem::path& path) {
    const std::vector<unsigned char> bytes = read_bytes(path);
    return {bytes.begin(), bytes.end()};
}

// Starts the command with its two streams in files; gives its process.
inline pid_t start(const std::vector<std::string>& arguments, const std::filesystem::path& folder) {
    const pid_t process = fork();
    if (process != 0) return process;
    if (freopen((folder / "out").c_str(), "w", stdout) == nullptr) _exit(99);
    if (freopen((folder / "error").c_str(), "w", stderr) == nullptr) _exit(99);
    std::vector<char*> list = {const_cast<char*>(TRIPTYCH_COMMAND)};
    for (const std::string& argument : arguments) list.push_back(const_cast<char*>(argument.c_str()));
    list.push_back(nullptr);
    execv(TRIPTYCH_COMMAND, list.data());
    _exit(98);
}

inline Outcome finish(pid_t process, const std::filesystem::path& folder) {
    int status = 0;
    waitpid(process, &status, 0);
    Outcome outcome;
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
    outcome.out = text_of(folder / "out");
    outcome.error = text_of(folder / "error");
    return outcome;
}

class Command : public testing::Test {
  protected:
    void SetUp() override {
        folder = test_folder(std::string("Command.") + testing::UnitTest::GetInstance()->current_test_info()->name());
        const Square square;
        GltfBuilder builder;
        builder.add_mesh_node({{"attributes", {{"POSITION", builder.accessor(square.positions, float_type, "VEC3")}}},
                               {"indices", builder.accessor(square.indices, ushort_type, "SCALAR")}});
        scene = builder.write(folder, "scene.glb").string();
        picture = (folder / "picture.exr").string();
    }

    Outcome run(const std::vector<std::string>& arguments) { return finish(start(arguments, folder), folder); }

    // Runs it, and sends it an interrupt after so many milliseconds.
    Outcome interrupt(const std::vector<std::string>& arguments, int milliseconds) {
        const pid_t process = start(arguments, folder);
        std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
        kill(process, SIGINT);
        return finish(process, folder);
    }

    // The same after so long that there is something to keep: sanitizers take their time.
    Outcome interrupt_late(const std::vector<std::string>& arguments) {
        for (int milliseconds = 1000;; milliseconds *= 2) {
            const Outcome outcome = interrupt(arguments, milliseconds);
            if (outcome.error != "triptych: error: interrupted\n" || milliseconds > 60000) return outcome;
        }
    }

    std::vector<std::string> render(std::vector<std::string> more = {}) {
        std::vector<std::string> arguments = {"render", scene,     "--method", "ray_casting", "--output",
                                              picture,  "--width", "64",       "--height",    "32"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }

    // One line, with that part in it.
    static void expect_error(const Outcome& outcome, int code, const std::string& part) {
        EXPECT_EQ(outcome.code, code) << outcome.error;
        EXPECT_EQ(outcome.error.rfind("triptych: error: ", 0), 0u) << outcome.error;
        EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
        EXPECT_NE(outcome.error.find(part), std::string::npos) << outcome.error;
    }

    std::vector<std::string> files() const {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(folder)) {
            const std::string name = entry.path().filename().string();
            if (name != "out" && name != "error" && name != "scene.glb") names.push_back(name);
        }
        std::sort(names.begin(), names.end());
        return names;
    }

    std::filesystem::path folder;
    std::string scene, picture;
};

}  // namespace triptych::test
