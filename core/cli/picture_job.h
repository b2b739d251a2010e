// What commands that show a scene by a method have in common: the scene, the camera, the picture's size and the
// settings. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "gltf_scene.h"
#include "handles.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace triptych::cli {

struct PictureJob {
    std::string scene, method, camera;
    uint32_t width = 0, height = 0;  // 0: as the file says
    std::vector<std::string> set;    // NAME=VALUE
    std::vector<std::pair<std::string, std::string>> settings;
    std::string threads;
    uint32_t pixel[2] = {};  // from the top left, where a command asks for one
    bool has_pixel = false;
    bool quiet = false;

    uint32_t thread_count() const;
};

// Adds SCENE and the options for what is done with it to a command; and those for how it is seen.
void add_scene_options(CLI::App& app, PictureJob& job);
void add_picture_options(CLI::App& app, PictureJob& job);

// Adds --pixel.
CLI::Option* add_pixel_option(CLI::App& app, PictureJob& job);

// Splits the texts, and checks method, names and values. Throws a UsageError for what is wrong in the call.
void check_picture(PictureJob& job);

// A scene that was read, and the size of its picture.
struct LoadedPicture {
    LoadedScene loaded;
    uint32_t width = 0, height = 0;
};
LoadedPicture load_picture(const PictureJob& job);

// What a setting is by the job, the file and the table, the first of them that says so.
std::string setting_of(const PictureJob& job, const LoadedPicture& picture, const std::string& name);

// Throws a UsageError where the picture does not have the job's pixel.
void check_pixel(const PictureJob& job, const LoadedPicture& picture);

// Commits the scene, with a camera and a light where it has none, says its warnings and makes a render of the whole
// film with the file's settings and the job's.
RenderHandle make_picture(const PictureJob& job, LoadedPicture& picture);

// Reads "12,34": true where the text is so many whole numbers with commas between them.
bool parse_numbers(const std::string& text, uint32_t* out, size_t count);

}  // namespace triptych::cli
