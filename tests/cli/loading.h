// Loading a built file against the recorder. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "gltf_builder.h"
#include "gltf_scene.h"
#include "recorder.h"

namespace triptych::test {

struct Loaded {
    cli::LoadedScene scene;
    const Recording* recording;
    const Recording* operator->() const { return recording; }
    bool warns(const std::string& part) const {
        const auto& lines = scene.warnings.lines();
        return std::any_of(lines.begin(), lines.end(),
                           [&](const std::string& line) { return line.find(part) != std::string::npos; });
    }
};

inline Loaded load(const std::filesystem::path& path, const std::string& camera = "") {
    Loaded loaded{cli::load_gltf(path, camera, 1), nullptr};
    loaded.recording = &recording_of(loaded.scene.scene.get());
    return loaded;
}

// Writes the file under the running test's name and loads it.
inline Loaded load(const GltfBuilder& builder, const std::string& name = "scene.glb") {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    return load(builder.write(test_folder(std::string(test->test_suite_name()) + "." + test->name()), name));
}

// The message of the error that loading the file ends with; empty if it loads.
inline std::string error_of(const GltfBuilder& builder, const std::string& name = "scene.glb") {
    try {
        load(builder, name);
    } catch (const cli::Error& error) {
        return error.what();
    }
    return "";
}

inline void expect_near(const std::vector<float>& actual, const std::vector<float>& expected, float tolerance = 1e-6f) {
    ASSERT_EQ(actual.size(), expected.size());
    for (size_t i = 0; i < actual.size(); ++i) EXPECT_NEAR(actual[i], expected[i], tolerance) << "at " << i;
}

#define EXPECT_CONTAINS(text, part) EXPECT_NE(std::string(text).find(part), std::string::npos) << (text)

}  // namespace triptych::test
