#include "textures/texture_set.h"

#include <algorithm>

#include "base/parallel.h"

namespace trp {

namespace {

MipPyramid read_pyramid(const Texture& texture) {
    bool srgb = texture.color_space == TRP_COLOR_SPACE_SRGB;
    PixelArray picture;
    if (!texture.pixels.empty()) {
        if (uint64_t{texture.width} * texture.height > kMostTexturePixels)
            throw std::runtime_error(fmt::format("a picture of {} x {} pixels; at most {} pixels can be held",
                                                 texture.width, texture.height, kMostTexturePixels));
        picture.width = texture.width;
        picture.height = texture.height;
        picture.channels = texture.channels;
        picture.floats = texture.pixels;
    } else {
        ImageSource source;
        source.path = texture.path;
        if (!texture.file.empty()) {
            source.file = texture.file.data();
            source.file_size = texture.file.size();
        }
        picture = image_module().read(source, kMostTexturePixels);
        if (texture.color_space == TRP_COLOR_SPACE_AUTO) srgb = picture.srgb;
    }
    return MipPyramid(picture, srgb);
}

}  // namespace

OpenTexture::OpenTexture(std::shared_ptr<const Texture> texture)
    : texture_(std::move(texture)), pyramid_(read_pyramid(*texture_)) {}

TextureSet open_textures(const std::map<uint32_t, std::shared_ptr<const Texture>>& wanted, const TextureSet& previous,
                         std::vector<Warning>& warnings) {
    struct Job {
        uint32_t id;
        std::shared_ptr<const Texture> texture;
        std::shared_ptr<const OpenTexture> open;
        std::string error;
    };
    std::vector<Job> jobs;
    for (const auto& [id, texture] : wanted) {
        const auto it = previous.find(id);
        const bool kept = it != previous.end() && it->second && it->second->texture() == texture.get();
        jobs.push_back({id, texture, kept ? it->second : nullptr, ""});
    }
    parallel_ranges(jobs.size(), 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            if (jobs[i].open) continue;
            try {
                jobs[i].open = std::make_shared<const OpenTexture>(jobs[i].texture);
            } catch (const std::exception& error) {
                jobs[i].error = error.what();
            }
        }
    });
    TextureSet set;
    for (Job& job : jobs) {
        if (!job.open) {
            std::replace(job.error.begin(), job.error.end(), '\n', ' ');
            warnings.push_back(
                {TRP_WARNING_TEXTURE, job.id,
                 fmt::format("{}{}: {}; magenta stands in", item_name("texture", job.id, job.texture->name),
                             job.texture->path.empty() ? "" : " (" + job.texture->path + ")", job.error)});
        }
        set.emplace(job.id, std::move(job.open));
    }
    return set;
}

void sample_or_magenta(const OpenTexture* texture, size_t count, const TextureCoordinates& at, float* const rgba[4]) {
    if (texture) return texture->sample(count, at, rgba);
    for (int c = 0; c < 4; ++c) std::fill_n(rgba[c], count, c == 1 ? 0.0f : 1.0f);
}

}  // namespace trp
