// Typed reading of extensions and extras. SPDX-License-Identifier: Apache-2.0
#include "gltf_fields.h"

#include <fmt/format.h>

#include <cmath>

namespace triptych::cli {
namespace {
const tinygltf::Value nothing;
}

const tinygltf::Value* Fields::find(const char* key) const {
    known_.insert(key);
    if (!object_->IsObject() || !object_->Has(key)) return nullptr;
    return &object_->Get(key);
}

double Fields::number(const tinygltf::Value& value, const std::string& place) const {
    if (!value.IsNumber()) throw Error(place + ": expected a number");
    return value.GetNumberAsDouble();
}

bool Fields::read(const char* key, double& out) const {
    const tinygltf::Value* value = find(key);
    if (value == nullptr) return false;
    out = number(*value, place(key));
    return true;
}

bool Fields::read(const char* key, float& out) const {
    double value = 0.0;
    if (!read(key, value)) return false;
    out = static_cast<float>(value);
    return true;
}

bool Fields::read(const char* key, int32_t& out) const {
    const tinygltf::Value* value = find(key);
    if (value == nullptr) return false;
    if (value->IsBool()) {
        out = value->Get<bool>() ? 1 : 0;
        return true;
    }
    const double real = number(*value, place(key));
    if (real != std::floor(real) || std::fabs(real) > 2147483647.0) throw Error(place(key) + ": expected an integer");
    out = static_cast<int32_t>(real);
    return true;
}

bool Fields::read(const char* key, uint32_t& out) const {
    int32_t value = 0;
    if (!read(key, value)) return false;
    if (value < 0) throw Error(fmt::format("{}: {} is below 0", place(key), value));
    out = static_cast<uint32_t>(value);
    return true;
}

bool Fields::read(const char* key, std::string& out) const {
    const tinygltf::Value* value = find(key);
    if (value == nullptr) return false;
    if (!value->IsString()) throw Error(place(key) + ": expected a string");
    out = value->Get<std::string>();
    return true;
}

int Fields::read(const char* key, float* out, int least, int most) const {
    const tinygltf::Value* value = find(key);
    if (value == nullptr) return 0;
    const std::string range = least == most ? fmt::format("{}", least) : fmt::format("{} to {}", least, most);
    if (value->IsNumber() && least <= 1) {
        out[0] = static_cast<float>(value->GetNumberAsDouble());
        return 1;
    }
    const int count = static_cast<int>(value->ArrayLen());
    if (!value->IsArray() || count < least || count > most) {
        throw Error(fmt::format("{}: expected an array of {} numbers", place(key), range));
    }
    for (int i = 0; i < count; ++i) {
        out[i] = static_cast<float>(number(value->Get(i), fmt::format("{}[{}]", place(key), i)));
    }
    return count;
}

int Fields::index(const tinygltf::Value& value, const std::string& place, size_t size, bool none) const {
    const double real = number(value, place);
    if (none && real == -1.0) return -1;
    if (real != std::floor(real) || real < 0.0 || real >= static_cast<double>(size)) {
        throw Error(fmt::format("{}: {} is not an index below {}", place, real, size));
    }
    return static_cast<int>(real);
}

bool Fields::read_index(const char* key, int& out, size_t size, bool none) const {
    const tinygltf::Value* value = find(key);
    if (value == nullptr) return false;
    out = index(*value, place(key), size, none);
    return true;
}

std::vector<int> Fields::read_indices(const char* key, size_t size, bool none) const {
    std::vector<int> indices;
    const tinygltf::Value* value = find(key);
    if (value == nullptr) return indices;
    if (!value->IsArray()) throw Error(place(key) + ": expected an array of indices");
    for (size_t i = 0; i < value->ArrayLen(); ++i) {
        indices.push_back(index(value->Get(static_cast<int>(i)), fmt::format("{}[{}]", place(key), i), size, none));
    }
    return indices;
}

bool Fields::read_enum(const char* key, int32_t& out,
                       std::initializer_list<std::pair<const char*, int32_t>> names) const {
    std::string text;
    if (!read(key, text)) return false;
    std::string choices;
    for (const auto& [name, number] : names) {
        if (text == name) {
            out = number;
            return true;
        }
        choices += fmt::format("{}{}", choices.empty() ? "" : ", ", name);
    }
    throw Error(fmt::format("{}: '{}' is not one of {}", place(key), one_line(text), choices));
}

Fields Fields::object(const char* key) const {
    const tinygltf::Value* value = find(key);
    if (value != nullptr && !value->IsObject()) throw Error(place(key) + ": expected an object");
    return Fields(value != nullptr ? *value : nothing, place(key));
}

std::vector<Fields> Fields::objects(const char* key) const {
    std::vector<Fields> list;
    const tinygltf::Value* value = find(key);
    if (value == nullptr) return list;
    if (!value->IsArray()) throw Error(place(key) + ": expected an array");
    for (size_t i = 0; i < value->ArrayLen(); ++i) {
        const tinygltf::Value& entry = value->Get(static_cast<int>(i));
        const std::string where = fmt::format("{}[{}]", place(key), i);
        if (!entry.IsObject()) throw Error(where + ": expected an object");
        list.emplace_back(entry, where);
    }
    return list;
}

void Fields::warn_unknown(Warnings& warnings) const {
    for (const std::string& key : object_->Keys()) {
        if (known_.count(key) == 0)
            warnings.add(fmt::format("{}: unknown key '{}' is left out", where_, one_line(key)));
    }
}

Fields triptych_extras(const tinygltf::Value& extras, const std::string& where) {
    const bool there = extras.IsObject() && extras.Has("triptych") && extras.Get("triptych").IsObject();
    return Fields(there ? extras.Get("triptych") : nothing, where + ".extras.triptych");
}

bool has_extension(const tinygltf::ExtensionMap& extensions, const char* name) {
    return extensions.count(name) > 0;
}

Fields extension(const tinygltf::ExtensionMap& extensions, const char* name, const std::string& where) {
    const auto found = extensions.find(name);
    return Fields(found != extensions.end() ? found->second : nothing, where + ".extensions." + name);
}

}  // namespace triptych::cli
