// Finished films as files.
#pragma once

#include <string>

#include "film/film.h"
#include "textures/image_module.h"

namespace trp {

// .exr: all passes, 32-bit float, channels ViewLayer.Pass.C; .png: Combined, 8-bit sRGB, straight alpha. The file is
// written beside its place and moved there when it is whole. Throws Error.
void write_picture_file(const Film& film, const std::string& path);
// Of any channels, the first four of which are those of Combined.
void write_picture_file(const Picture& picture, const std::string& path);

}  // namespace trp
