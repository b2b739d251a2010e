// The image module on OpenImageIO: its texture system for filtered reading, its writers for pictures.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/texture.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>

#include "textures/image_module.h"
#include "triptych/triptych.h"

namespace trp {
namespace {

float linear_from_srgb(float c) {
    return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}

[[noreturn]] void fail(const std::string& text) {
    throw std::runtime_error(text);
}

// A picture in linear floats, row 0 at the top, straight alpha.
struct LinearImage {
    OIIO::ImageSpec spec;
    std::vector<float> values;
};

bool is_srgb(const OIIO::ImageSpec& spec, int32_t color_space) {
    if (color_space != TRP_COLOR_SPACE_AUTO) return color_space == TRP_COLOR_SPACE_SRGB;
    return spec.format.basetype == OIIO::TypeDesc::UINT8 || spec.get_string_attribute("oiio:ColorSpace") == "sRGB";
}

LinearImage read_file(const ImageSource& source) {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    std::unique_ptr<OIIO::ImageInput> input;
    OIIO::Filesystem::IOMemReader memory(const_cast<unsigned char*>(source.file), source.file_size);
    if (source.file) {
        // Readers are chosen by name; try each that can read from memory until one knows these bytes.
        OIIO::ImageSpec spec;
        for (const char* name : {"a.png", "a.jpg", "a.exr", "a.tif", "a.hdr", "a.webp", "a.tga", "a.bmp", "a.gif"}) {
            memory.seek(0);
            input = OIIO::ImageInput::create(name, false, nullptr, &memory);
            if (input && input->set_ioproxy(&memory) && input->open(name, spec, config)) break;
            if (input) input->geterror();
            input.reset();
        }
        OIIO::geterror();
        if (!input) fail("no known picture format");
    } else {
        input = OIIO::ImageInput::open(source.path, &config);
        if (!input) fail(OIIO::geterror());
    }
    LinearImage image;
    image.spec = input->spec();
    const OIIO::ImageSpec& spec = image.spec;
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1 || spec.width > 65536 ||
        spec.height > 65536)
        fail("a picture of " + std::to_string(spec.width) + " x " + std::to_string(spec.height));
    const int channels = std::min(spec.nchannels, 4);
    image.values.resize(static_cast<size_t>(spec.width) * spec.height * channels);
    if (!input->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, image.values.data())) fail(input->geterror());
    if (is_srgb(spec, source.color_space)) {
        const int alpha = channels == 2 || channels == 4 ? channels - 1 : -1;
        for (size_t i = 0; i < image.values.size(); ++i)
            if (static_cast<int>(i % channels) != alpha) image.values[i] = linear_from_srgb(image.values[i]);
    }
    image.spec.nchannels = channels;
    return image;
}

LinearImage read_pixels(const ImageSource& source) {
    LinearImage image;
    image.spec = OIIO::ImageSpec(static_cast<int>(source.width), static_cast<int>(source.height),
                                 static_cast<int>(source.channels), OIIO::TypeDesc::FLOAT);
    const size_t row = static_cast<size_t>(source.width) * source.channels;
    image.values.resize(row * source.height);
    for (uint32_t y = 0; y < source.height; ++y)
        std::copy_n(source.pixels + y * row, row,
                    image.values.begin() + static_cast<ptrdiff_t>((source.height - 1 - y) * row));
    if (source.color_space == TRP_COLOR_SPACE_SRGB) {
        const uint32_t alpha = source.channels == 2 || source.channels == 4 ? source.channels - 1 : source.channels;
        for (size_t i = 0; i < image.values.size(); ++i)
            if (i % source.channels != alpha) image.values[i] = linear_from_srgb(image.values[i]);
    }
    return image;
}

// Pictures that the texture cache is reading, by the name under which it knows them.
std::mutex g_reading_mutex;
std::map<std::string, std::shared_ptr<const LinearImage>> g_reading;

// What the texture cache reads from: a LinearImage in 16-bit floats (32-bit where the file has more than 8 bits), so
// that filtering happens in linear light.
class LinearInput final : public OIIO::ImageInput {
  public:
    static OIIO::ImageInput* create() { return new LinearInput; }
    const char* format_name() const override { return "triptych"; }
    bool open(const std::string& name, OIIO::ImageSpec& spec) override {
        {
            const std::lock_guard lock(g_reading_mutex);
            const auto it = g_reading.find(name);
            if (it == g_reading.end()) return false;
            image_ = it->second;
        }
        const auto& file = image_->spec;
        const bool small = file.format.basetype == OIIO::TypeDesc::UINT8;
        m_spec = OIIO::ImageSpec(file.width, file.height, file.nchannels,
                                 small ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
        spec = m_spec;
        return true;
    }
    bool close() override {
        image_.reset();
        return true;
    }
    bool read_native_scanline(int, int, int y, int, void* data) override {
        const size_t row = static_cast<size_t>(m_spec.width) * m_spec.nchannels;
        return OIIO::convert_pixel_values(OIIO::TypeDesc::FLOAT, image_->values.data() + y * row, m_spec.format, data,
                                          static_cast<int>(row));
    }

  private:
    std::shared_ptr<const LinearImage> image_;
};

struct OpenTexture {
    OIIO::ustring name;
    OIIO::TextureSystem::TextureHandle* handle = nullptr;
    OIIO::TextureOpt options;
    int channels = 0;
};

OIIO::TextureOpt::Wrap wrap_mode(int32_t wrap) {
    switch (wrap) {
        case TRP_WRAP_CLAMP:
            return OIIO::TextureOpt::WrapClamp;
        case TRP_WRAP_MIRROR:
            return OIIO::TextureOpt::WrapMirror;
        case TRP_WRAP_BLACK:
            return OIIO::TextureOpt::WrapBlack;
        default:
            return OIIO::TextureOpt::WrapPeriodic;
    }
}

class OiioModule final : public ImageModule {
  public:
    OiioModule() : system_(OIIO::TextureSystem::create(false)) {
        OIIO::attribute("threads", 1);
        system_->attribute("automip", 1);
        system_->attribute("autotile", 64);
        system_->attribute("max_memory_MB", 4096.0f);
    }
    ~OiioModule() override { OIIO::TextureSystem::destroy(system_, true); }

    uint64_t open(const ImageSource& source) override {
        auto image = std::make_shared<const LinearImage>(source.pixels ? read_pixels(source) : read_file(source));
        auto texture = std::make_unique<OpenTexture>();
        const std::string name = "triptych:" + std::to_string(++names_);
        texture->name = OIIO::ustring(name);
        texture->channels = image->spec.nchannels;
        texture->options.swrap = wrap_mode(source.wrap_u);
        texture->options.twrap = wrap_mode(source.wrap_v);
        texture->options.fill = 1;
        const bool nearest = source.filter == TRP_FILTER_NEAREST;
        texture->options.interpmode = nearest ? OIIO::TextureOpt::InterpClosest : OIIO::TextureOpt::InterpBilinear;
        if (nearest) texture->options.mipmode = OIIO::TextureOpt::MipModeNoMIP;
        {
            const std::lock_guard lock(g_reading_mutex);
            g_reading[name] = image;
        }
        system_->imagecache()->add_file(texture->name, LinearInput::create);
        texture->handle = system_->get_texture_handle(texture->name);
        if (!texture->handle || !system_->good(texture->handle)) fail(system_->geterror());
        return reinterpret_cast<uint64_t>(texture.release());
    }

    void close(uint64_t handle) override {
        const std::unique_ptr<OpenTexture> texture(reinterpret_cast<OpenTexture*>(handle));
        system_->invalidate(texture->name, true);
        const std::lock_guard lock(g_reading_mutex);
        g_reading.erase(texture->name.string());
    }

    void sample(uint64_t handle, size_t count, const TextureCoordinates& at, float* const rgba[4]) override {
        const auto& texture = *reinterpret_cast<const OpenTexture*>(handle);
        auto* thread = system_->get_perthread_info();
        OIIO::TextureOpt options = texture.options;
        for (size_t i = 0; i < count; ++i) {
            float value[4] = {0, 0, 0, 1};
            // The texture system has v down.
            system_->texture(texture.handle, thread, options, at.u[i], 1 - at.v[i], at.dudx[i], -at.dvdx[i], at.dudy[i],
                             -at.dvdy[i], texture.channels, value);
            if (texture.channels < 3) {  // grey, with or without alpha
                value[3] = texture.channels == 2 ? value[1] : 1;
                value[1] = value[2] = value[0];
            }
            for (int c = 0; c < 4; ++c) rgba[c][i] = value[c];
        }
    }

    void write_exr(const std::string& path, const Picture& picture) override {
        write(path, "a.exr", picture, OIIO::TypeDesc::FLOAT);
    }
    void write_png(const std::string& path, const Picture& picture) override {
        write(path, "a.png", picture, OIIO::TypeDesc::UINT8);
    }

  private:
    static void write(const std::string& path, const char* format, const Picture& picture, OIIO::TypeDesc type) {
        const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format);
        if (!output) fail(OIIO::geterror());
        const auto channels = static_cast<int>(picture.channels.size());
        OIIO::ImageSpec spec(static_cast<int>(picture.window_width), static_cast<int>(picture.window_height), channels,
                             type);
        spec.x = static_cast<int>(picture.window_x);
        spec.y = static_cast<int>(picture.window_y);
        spec.full_width = static_cast<int>(picture.width);
        spec.full_height = static_cast<int>(picture.height);
        spec.channelnames = picture.channels;
        spec.attribute("Software", "Triptych");
        if (type == OIIO::TypeDesc::UINT8) {
            spec.attribute("oiio:ColorSpace", "sRGB");
            spec.attribute("oiio:UnassociatedAlpha", 1);
        } else {
            spec.attribute("compression", "zip");
            spec.attribute("oiio:ColorSpace", "Linear");
        }
        // Encoded in memory and written here: the encoders do not notice a full disk.
        OIIO::Filesystem::IOVecOutput bytes;
        if (!output->set_ioproxy(&bytes) || !output->open(format, spec) ||
            !output->write_image(OIIO::TypeDesc::FLOAT, picture.values.data()) || !output->close())
            fail(output->geterror());
        std::ofstream file(path, std::ios::binary);
        file.write(reinterpret_cast<const char*>(bytes.buffer().data()),
                   static_cast<std::streamsize>(bytes.buffer().size()));
        file.close();
        if (!file) fail("the file could not be written whole");
    }

    OIIO::TextureSystem* system_;
    std::atomic<uint64_t> names_{0};
};

}  // namespace
}  // namespace trp

extern "C" __attribute__((visibility("default"))) trp::ImageModule* triptych_create_image_module() {
    return new trp::OiioModule;
}
