// glTF files by others, through the reader. SPDX-License-Identifier: Apache-2.0
#include "samples.h"

#include "loading.h"

namespace triptych::test {
namespace {

TEST(Samples, Version2) {
    if (!std::filesystem::is_directory(models / "glTF2")) GTEST_SKIP() << "the package assimp-testmodels is not there";
    const std::vector<std::filesystem::path> files = files_in(models / "glTF2");
    EXPECT_GE(files.size(), 40u);
    for (const std::filesystem::path& file : files) {
        const std::string name = std::filesystem::relative(file, models / "glTF2").string();
        const auto expected = expected_errors.find(name);
        try {
            const Loaded loaded = load(file);
            EXPECT_EQ(expected, expected_errors.end()) << name << " was expected to fail";
        } catch (const cli::Error& error) {
            const std::string message = error.what();
            EXPECT_CONTAINS(message, file.string() + ": ");
            EXPECT_EQ(message.find('\n'), std::string::npos);
            if (expected == expected_errors.end()) {
                ADD_FAILURE() << name << " was expected to load: " << message;
            } else {
                EXPECT_CONTAINS(message, expected->second) << name;
            }
        }
    }
}

TEST(Samples, Version1IsAClearError) {
    if (!std::filesystem::is_directory(models / "glTF")) GTEST_SKIP() << "the package assimp-testmodels is not there";
    for (const std::filesystem::path& file : files_in(models / "glTF")) {
        try {
            load(file);
            ADD_FAILURE() << file << " loaded";
        } catch (const cli::Error& error) {
            EXPECT_CONTAINS(error.what(), "glTF 1.0 is not supported") << file;
        }
    }
}

}  // namespace
}  // namespace triptych::test
