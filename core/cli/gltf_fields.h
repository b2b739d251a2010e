// Typed reading of an object in glTF's extensions and extras: a wrong type is an error that names the place, a key that
// nobody asked for a warning. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "error.h"
#include "tinygltf_model.h"

namespace triptych::cli {

class Fields {
  public:
    // `object` may be of any type: all but an object has no keys.
    Fields(const tinygltf::Value& object, std::string where) : object_(&object), where_(std::move(where)) {}

    bool has(const char* key) const { return find(key) != nullptr; }
    const std::string& where() const { return where_; }
    std::string place(const char* key) const { return where_ + "." + key; }

    // Each writes `out` and says true where the key is there.
    bool read(const char* key, double& out) const;
    bool read(const char* key, float& out) const;
    bool read(const char* key, int32_t& out) const;   // an integer, or true and false as 1 and 0
    bool read(const char* key, uint32_t& out) const;  // an integer from 0
    bool read(const char* key, std::string& out) const;
    // From least to most numbers; a single number stands for one of them. Gives how many; 0: the key is missing.
    int read(const char* key, float* out, int least, int most) const;
    // The index of an item in an array of `size` items; `none` allows -1.
    bool read_index(const char* key, int& out, size_t size, bool none = false) const;
    std::vector<int> read_indices(const char* key, size_t size, bool none = false) const;
    bool read_enum(const char* key, int32_t& out, std::initializer_list<std::pair<const char*, int32_t>> names) const;

    // An object or array within; a null value where it is missing.
    Fields object(const char* key) const;
    std::vector<Fields> objects(const char* key) const;
    const tinygltf::Value* value(const char* key) const { return find(key); }

    // Warns of the keys that were never read.
    void warn_unknown(Warnings& warnings) const;

  private:
    const tinygltf::Value* find(const char* key) const;
    double number(const tinygltf::Value& value, const std::string& place) const;
    int index(const tinygltf::Value& value, const std::string& place, size_t size, bool none) const;

    const tinygltf::Value* object_;
    std::string where_;
    mutable std::set<std::string> known_;
};

// `extras.triptych` of an item, and an extension of it.
Fields triptych_extras(const tinygltf::Value& extras, const std::string& where);
Fields extension(const tinygltf::ExtensionMap& extensions, const char* name, const std::string& where);
bool has_extension(const tinygltf::ExtensionMap& extensions, const char* name);

}  // namespace triptych::cli
