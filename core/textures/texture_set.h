// Textures that are open for sampling. An open texture is shared by all snapshots in which it stands unchanged.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "base/error.h"
#include "scene/items.h"
#include "textures/image_module.h"

namespace trp {

class OpenTexture {
  public:
    // Throws std::runtime_error where the picture cannot be read.
    explicit OpenTexture(std::shared_ptr<const Texture> texture);
    ~OpenTexture();
    OpenTexture(const OpenTexture&) = delete;
    OpenTexture& operator=(const OpenTexture&) = delete;

    const Texture* texture() const { return texture_.get(); }
    void sample(size_t count, const TextureCoordinates& at, float* const rgba[4]) const {
        image_module().sample(handle_, count, at, rgba);
    }

  private:
    std::shared_ptr<const Texture> texture_;
    uint64_t handle_;
};

// By texture id; null for a picture that could not be read, in whose place magenta is shown.
using TextureSet = std::map<uint32_t, std::shared_ptr<const OpenTexture>>;

// Opens `wanted`, taking over what `previous` has; adds a warning for each that cannot be read.
TextureSet open_textures(const std::map<uint32_t, std::shared_ptr<const Texture>>& wanted, const TextureSet& previous,
                         std::vector<Warning>& warnings);

// As OpenTexture::sample, or magenta where `texture` is null.
void sample_or_magenta(const OpenTexture* texture, size_t count, const TextureCoordinates& at, float* const rgba[4]);

}  // namespace trp
