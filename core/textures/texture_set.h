// Textures that are open for sampling. An open texture is shared by all snapshots in which it stands unchanged.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "base/error.h"
#include "scene/items.h"
#include "textures/mip_pyramid.h"

namespace trp {

class OpenTexture {
  public:
    // Reads the picture; throws std::runtime_error where it cannot be read.
    explicit OpenTexture(std::shared_ptr<const Texture> texture);

    const Texture* texture() const { return texture_.get(); }
    // Linear Rec. 709 with straight alpha, filtered over the footprints, to r, g, b, a[count]. Any thread.
    void sample(size_t count, const TextureCoordinates& at, float* const rgba[4]) const {
        filter_texture(pyramid_, {texture_->wrap_u, texture_->wrap_v, texture_->filter}, count, at, rgba);
    }

  private:
    std::shared_ptr<const Texture> texture_;
    MipPyramid pyramid_;
};

// By texture id; null for a picture that could not be read, in whose place magenta is shown.
using TextureSet = std::map<uint32_t, std::shared_ptr<const OpenTexture>>;

// Opens `wanted`, taking over what `previous` has; adds a warning for each that cannot be read.
TextureSet open_textures(const std::map<uint32_t, std::shared_ptr<const Texture>>& wanted, const TextureSet& previous,
                         std::vector<Warning>& warnings);

// As OpenTexture::sample, or magenta where `texture` is null.
void sample_or_magenta(const OpenTexture* texture, size_t count, const TextureCoordinates& at, float* const rgba[4]);

}  // namespace trp
