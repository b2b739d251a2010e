// The image module on OpenImageIO: its readers and writers.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "textures/image_module.h"

namespace trp {
namespace {

[[noreturn]] void fail(const std::string& text) {
    throw std::runtime_error(text);
}

// Readers are chosen by name; each that can read from memory is tried until one knows these bytes.
std::unique_ptr<OIIO::ImageInput> open_memory(OIIO::Filesystem::IOMemReader& memory, const OIIO::ImageSpec& config) {
    for (const char* name : {"a.png", "a.jpg", "a.exr", "a.tif", "a.hdr", "a.webp", "a.tga", "a.bmp", "a.gif"}) {
        memory.seek(0);
        auto input = OIIO::ImageInput::create(name, false, nullptr, &memory);
        OIIO::ImageSpec spec;
        if (input && input->set_ioproxy(&memory) && input->open(name, spec, config)) return input;
        if (input) input->geterror();
    }
    OIIO::geterror();
    return nullptr;
}

bool has_integers(const OIIO::TypeDesc& type) {
    return type.basetype >= OIIO::TypeDesc::UINT8 && type.basetype <= OIIO::TypeDesc::INT64;
}

class OiioModule final : public ImageModule {
  public:
    OiioModule() { OIIO::attribute("threads", 1); }

    PixelArray read(const ImageSource& source, uint64_t most_pixels) override {
        OIIO::ImageSpec config;
        config.attribute("oiio:UnassociatedAlpha", 1);
        OIIO::Filesystem::IOMemReader memory(const_cast<unsigned char*>(source.file), source.file_size);
        const std::unique_ptr<OIIO::ImageInput> input =
            source.file ? open_memory(memory, config) : OIIO::ImageInput::open(source.path, &config);
        if (!input) fail(source.file ? "no known picture format" : OIIO::geterror());
        const OIIO::ImageSpec& spec = input->spec();
        const std::string size = std::to_string(spec.width) + " x " + std::to_string(spec.height) + " pixels";
        if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1) fail("a picture of " + size);
        if (static_cast<uint64_t>(spec.width) * static_cast<uint64_t>(spec.height) > most_pixels)
            fail("a picture of " + size + "; at most " + std::to_string(most_pixels) + " pixels can be held");

        PixelArray out;
        out.width = static_cast<uint32_t>(spec.width);
        out.height = static_cast<uint32_t>(spec.height);
        out.channels = static_cast<uint32_t>(std::min(spec.nchannels, 4));
        out.srgb =
            spec.format.basetype == OIIO::TypeDesc::UINT8 || spec.get_string_attribute("oiio:ColorSpace") == "sRGB";
        const size_t row = size_t{out.width} * out.channels;
        const bool integers = has_integers(spec.format);
        if (integers)
            out.integers.resize(row * out.height);
        else
            out.floats.resize(row * out.height);
        char* const values =
            integers ? reinterpret_cast<char*>(out.integers.data()) : reinterpret_cast<char*>(out.floats.data());
        const auto stride = static_cast<OIIO::stride_t>(row * (integers ? sizeof(uint16_t) : sizeof(float)));
        // Upwards from the last row, which the file has first.
        if (!input->read_image(0, 0, 0, static_cast<int>(out.channels),
                               integers ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::FLOAT,
                               values + stride * (spec.height - 1), OIIO::AutoStride, -stride))
            fail(input->geterror());
        return out;
    }

    void write_exr(const std::string& path, const Picture& picture) override {
        write(path, "a.exr", picture, OIIO::TypeDesc::FLOAT);
    }
    void write_png(const std::string& path, const Picture& picture) override {
        write(path, "a.png", picture, OIIO::TypeDesc::UINT8);
    }

  private:
    static void write(const std::string& path, const char* format, const Picture& picture, const OIIO::TypeDesc& type) {
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
};

}  // namespace
}  // namespace trp

extern "C" __attribute__((visibility("default"))) trp::ImageModule* triptych_create_image_module() {
    return new trp::OiioModule;
}
