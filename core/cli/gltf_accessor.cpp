// Accessors of a glTF file. SPDX-License-Identifier: Apache-2.0
#include "gltf_accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace triptych::cli {
namespace {

// Numbers as they lie in a buffer.
struct RawArray {
    const unsigned char* data = nullptr;  // null: all zero
    uint64_t count = 0;
    uint64_t stride = 0;
    int component_type = 0;
    int components = 0;
};

template <typename T>
T load(const unsigned char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

float real_of(const unsigned char* bytes, int component_type, bool normalized) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE: {
            const float value = load<int8_t>(bytes);
            return normalized ? std::max(value / 127.0f, -1.0f) : value;
        }
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return normalized ? load<uint8_t>(bytes) / 255.0f : load<uint8_t>(bytes);
        case TINYGLTF_COMPONENT_TYPE_SHORT: {
            const float value = load<int16_t>(bytes);
            return normalized ? std::max(value / 32767.0f, -1.0f) : value;
        }
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return normalized ? load<uint16_t>(bytes) / 65535.0f : load<uint16_t>(bytes);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: {
            const double value = load<uint32_t>(bytes);
            return static_cast<float>(normalized ? value / 4294967295.0 : value);
        }
        default:
            return load<float>(bytes);
    }
}

uint32_t integer_of(const unsigned char* bytes, int component_type) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return load<uint8_t>(bytes);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return load<uint16_t>(bytes);
        default:
            return load<uint32_t>(bytes);
    }
}

int32_t integer_format(int component_type) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return TRP_FORMAT_UINT8;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return TRP_FORMAT_UINT16;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return TRP_FORMAT_UINT32;
        default:
            return -1;
    }
}

uint64_t component_size(int component_type) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return 4;
        default:
            return 0;
    }
}

int component_count(int type) {
    switch (type) {
        case TINYGLTF_TYPE_SCALAR:
            return 1;
        case TINYGLTF_TYPE_VEC2:
            return 2;
        case TINYGLTF_TYPE_VEC3:
            return 3;
        case TINYGLTF_TYPE_VEC4:
            return 4;
        default:
            return 0;  // matrices: no attribute has them
    }
}

// `count` elements of `element_size` bytes in a buffer view, from `offset` in it.
const unsigned char* locate(const GltfFile& file, int buffer_view, uint64_t offset, uint64_t count, uint64_t stride,
                            uint64_t element_size, const std::string& where) {
    const tinygltf::BufferView& view = file.model.bufferViews[static_cast<size_t>(buffer_view)];
    const ByteSpan buffer = file.buffers[static_cast<size_t>(view.buffer)];
    if (view.byteOffset > buffer.size || view.byteLength > buffer.size - view.byteOffset) {
        throw Error(fmt::format("{}: bufferViews[{}] reaches beyond the end of buffers[{}] ({} bytes)", where,
                                buffer_view, view.buffer, buffer.size));
    }
    const uint64_t size = view.byteLength;
    if (count == 0) return buffer.data + view.byteOffset;
    if (offset > size || element_size > size - offset || (count - 1) > (size - offset - element_size) / stride) {
        throw Error(fmt::format("{}: {} elements reach beyond the end of bufferViews[{}] ({} bytes)", where, count,
                                buffer_view, size));
    }
    return buffer.data + view.byteOffset + offset;
}

RawArray find_array(const GltfFile& file, const tinygltf::Accessor& accessor, const std::string& where) {
    RawArray raw;
    raw.count = accessor.count;
    raw.component_type = accessor.componentType;
    raw.components = component_count(accessor.type);
    const uint64_t element_size = component_size(raw.component_type) * static_cast<uint64_t>(raw.components);
    if (component_size(raw.component_type) == 0) {
        throw Error(fmt::format("{}: component type {} is not one of glTF's", where, raw.component_type));
    }
    if (raw.components == 0) throw Error(where + ": a matrix cannot stand here");
    raw.stride = element_size;
    if (accessor.bufferView >= 0) {
        const tinygltf::BufferView& view = file.model.bufferViews[static_cast<size_t>(accessor.bufferView)];
        if (view.byteStride > 0) raw.stride = view.byteStride;
        if (raw.stride < element_size) {
            throw Error(fmt::format("{}: its elements of {} bytes overlap at a byteStride of {}", where, element_size,
                                    raw.stride));
        }
        raw.data = locate(file, accessor.bufferView, accessor.byteOffset, raw.count, raw.stride, element_size, where);
    } else if (raw.count > std::max<uint64_t>(uint64_t{1} << 20, file.total_bytes)) {
        // Nothing in the file backs this count, so that a slip could ask for any amount of memory.
        throw Error(fmt::format("{}: {} elements without a bufferView", where, raw.count));
    }
    return raw;
}

// Writes a sparse accessor's substitutes through `put(element, bytes of the value)`.
template <typename Put>
void apply_sparse(const GltfFile& file, const tinygltf::Accessor& accessor, const RawArray& raw,
                  const std::string& where, Put put) {
    const auto& sparse = accessor.sparse;
    const int index_type = sparse.indices.componentType;
    if (integer_format(index_type) < 0)
        throw Error(where + ".sparse.indices: component type is not an unsigned integer");
    if (sparse.count < 0 || static_cast<uint64_t>(sparse.count) > raw.count || sparse.indices.byteOffset < 0 ||
        sparse.values.byteOffset < 0) {
        throw Error(where + ".sparse: its count or an offset is out of range");
    }
    const uint64_t count = static_cast<uint64_t>(sparse.count);
    const uint64_t index_size = component_size(index_type);
    const uint64_t value_size = component_size(raw.component_type) * static_cast<uint64_t>(raw.components);
    const unsigned char* indices =
        locate(file, sparse.indices.bufferView, static_cast<uint64_t>(sparse.indices.byteOffset), count, index_size,
               index_size, where + ".sparse.indices");
    const unsigned char* values =
        locate(file, sparse.values.bufferView, static_cast<uint64_t>(sparse.values.byteOffset), count, value_size,
               value_size, where + ".sparse.values");
    for (uint64_t i = 0; i < count; ++i) {
        const uint64_t element = integer_of(indices + i * index_size, index_type);
        if (element >= raw.count) {
            throw Error(fmt::format("{}.sparse.indices[{}]: {} is not below {}", where, i, element, raw.count));
        }
        put(element, values + i * value_size);
    }
}

bool aligned(const RawArray& raw) {
    const uint64_t size = component_size(raw.component_type);
    return reinterpret_cast<uintptr_t>(raw.data) % size == 0 && raw.stride % size == 0;
}

}  // namespace

float NumberArray::real(uint64_t element, int component) const {
    return load<float>(static_cast<const unsigned char*>(data) + element * stride + static_cast<size_t>(component) * 4);
}

uint32_t NumberArray::integer(uint64_t element) const {
    const unsigned char* bytes = static_cast<const unsigned char*>(data) + element * stride;
    switch (format) {
        case TRP_FORMAT_UINT8:
            return load<uint8_t>(bytes);
        case TRP_FORMAT_UINT16:
            return load<uint16_t>(bytes);
        default:
            return load<uint32_t>(bytes);
    }
}

NumberArray NumberArray::of(std::vector<float> values, int components) {
    NumberArray array;
    array.floats = std::move(values);
    array.data = array.floats.data();
    array.components = components;
    array.count = array.floats.size() / static_cast<size_t>(components);
    array.stride = static_cast<uint32_t>(components) * 4;
    return array;
}

NumberArray NumberArray::of(std::vector<uint32_t> values, int components) {
    NumberArray array;
    array.integers = std::move(values);
    array.data = array.integers.data();
    array.format = TRP_FORMAT_UINT32;
    array.components = components;
    array.count = array.integers.size() / static_cast<size_t>(components);
    array.stride = static_cast<uint32_t>(components) * 4;
    return array;
}

NumberArray read_floats(const GltfFile& file, int index, int least, int most, const std::string& where) {
    const tinygltf::Accessor& accessor = file.model.accessors[static_cast<size_t>(index)];
    const std::string item = fmt::format("{} (accessors[{}])", where, index);
    const RawArray raw = find_array(file, accessor, item);
    if (raw.components < least || raw.components > most) {
        throw Error(fmt::format("{}: {} numbers to an element, expected {}{}", item, raw.components, least,
                                least == most ? "" : fmt::format(" to {}", most)));
    }
    if (raw.component_type == TINYGLTF_COMPONENT_TYPE_FLOAT && !accessor.sparse.isSparse && raw.data != nullptr &&
        aligned(raw)) {
        NumberArray array;
        array.data = raw.data;
        array.count = raw.count;
        array.stride = static_cast<uint32_t>(raw.stride);
        array.components = raw.components;
        return array;
    }
    const size_t components = static_cast<size_t>(raw.components);
    const uint64_t size = component_size(raw.component_type);
    std::vector<float> values(raw.count * components, 0.0f);
    const auto put = [&](uint64_t element, const unsigned char* bytes) {
        for (size_t k = 0; k < components; ++k) {
            values[element * components + k] = real_of(bytes + k * size, raw.component_type, accessor.normalized);
        }
    };
    if (raw.data != nullptr) {
        for (uint64_t i = 0; i < raw.count; ++i) put(i, raw.data + i * raw.stride);
    }
    if (accessor.sparse.isSparse) apply_sparse(file, accessor, raw, item, put);
    return NumberArray::of(std::move(values), raw.components);
}

NumberArray read_integers(const GltfFile& file, int index, const std::string& where) {
    const tinygltf::Accessor& accessor = file.model.accessors[static_cast<size_t>(index)];
    const std::string item = fmt::format("{} (accessors[{}])", where, index);
    const RawArray raw = find_array(file, accessor, item);
    const int32_t format = integer_format(raw.component_type);
    if (format < 0 || raw.components != 1) throw Error(item + ": expected SCALAR unsigned integers");
    if (!accessor.sparse.isSparse && raw.data != nullptr && aligned(raw)) {
        NumberArray array;
        array.data = raw.data;
        array.count = raw.count;
        array.stride = static_cast<uint32_t>(raw.stride);
        array.format = format;
        array.components = 1;
        return array;
    }
    std::vector<uint32_t> values(raw.count, 0);
    const auto put = [&](uint64_t element, const unsigned char* bytes) {
        values[element] = integer_of(bytes, raw.component_type);
    };
    if (raw.data != nullptr) {
        for (uint64_t i = 0; i < raw.count; ++i) put(i, raw.data + i * raw.stride);
    }
    if (accessor.sparse.isSparse) apply_sparse(file, accessor, raw, item, put);
    return NumberArray::of(std::move(values));
}

}  // namespace triptych::cli
