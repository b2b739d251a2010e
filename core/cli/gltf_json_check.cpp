// Types and indices of a glTF file's JSON. SPDX-License-Identifier: Apache-2.0
#include "gltf_json_check.h"

#include <fmt/format.h>

#include <cmath>
#include <initializer_list>
#include <string>

#include "error.h"

namespace triptych::cli {
namespace {

using nlohmann::json;

enum class Kind {
    index,    // of an item in the array `of`
    indices,  // an array of such
    count,    // an integer from 0
    integer,  // from -2^31 to 2^31 - 1
    number,
    numbers,  // an array of `size` numbers (0: any)
    text,
    boolean,
    object,
    attributes  // an object whose values are indices of accessors
};

struct Rule {
    const char* key;
    Kind kind;
    const char* of = "";
    size_t size = 0;
    bool required = false;
};

class Checker {
  public:
    explicit Checker(json& root) : root_(root) {}

    size_t count_of(const char* section) const {
        const auto found = root_.find(section);
        return found == root_.end() ? 0 : found->size();
    }

    // Checks every item of a top-level array; calls `more` with each and its name.
    template <typename More>
    void section(const char* name, std::initializer_list<Rule> rules, More more) {
        const auto found = root_.find(name);
        if (found == root_.end()) return;
        if (!found->is_array()) throw Error(fmt::format("{}: expected an array", name));
        for (size_t i = 0; i < found->size(); ++i) {
            const std::string where = fmt::format("{}[{}]", name, i);
            item((*found)[i], where, rules);
            more((*found)[i], where);
        }
    }
    void section(const char* name, std::initializer_list<Rule> rules) {
        section(name, rules, [](json&, const std::string&) {});
    }

    void item(json& value, const std::string& where, std::initializer_list<Rule> rules) {
        if (!value.is_object()) throw Error(where + ": expected an object");
        for (const Rule& rule : rules) {
            const auto found = value.find(rule.key);
            if (found != value.end()) {
                property(*found, where + "." + rule.key, rule);
            } else if (rule.required) {
                throw Error(fmt::format("{}: '{}' is missing", where, rule.key));
            }
        }
    }

    // An object within an item, if it is there.
    void nested(json& value, const std::string& where, const char* key, std::initializer_list<Rule> rules) {
        const auto found = value.find(key);
        if (found != value.end()) item(*found, where + "." + key, rules);
    }

    void property(json& value, const std::string& where, const Rule& rule) {
        switch (rule.kind) {
            case Kind::index:
                index(value, where, rule.of);
                break;
            case Kind::indices:
                if (!value.is_array()) throw Error(where + ": expected an array");
                for (size_t i = 0; i < value.size(); ++i) index(value[i], fmt::format("{}[{}]", where, i), rule.of);
                break;
            case Kind::count:
                whole(value, where, 0.0, 9e15);
                break;
            case Kind::integer:
                whole(value, where, -2147483648.0, 2147483647.0);
                break;
            case Kind::number:
                number(value, where);
                break;
            case Kind::numbers:
                if (!value.is_array() || (rule.size > 0 && value.size() != rule.size)) {
                    throw Error(rule.size > 0 ? fmt::format("{}: expected an array of {} numbers", where, rule.size)
                                              : where + ": expected an array of numbers");
                }
                for (size_t i = 0; i < value.size(); ++i) number(value[i], fmt::format("{}[{}]", where, i));
                break;
            case Kind::text:
                if (!value.is_string()) throw Error(where + ": expected a string");
                break;
            case Kind::boolean:
                if (!value.is_boolean()) throw Error(where + ": expected true or false");
                break;
            case Kind::object:
                if (!value.is_object()) throw Error(where + ": expected an object");
                break;
            case Kind::attributes:
                if (!value.is_object()) throw Error(where + ": expected an object");
                for (auto& [name, accessor] : value.items()) index(accessor, where + "." + one_line(name), "accessors");
                break;
        }
    }

  private:
    static void number(const json& value, const std::string& where) {
        if (!value.is_number()) throw Error(where + ": expected a number");
    }

    static double whole(json& value, const std::string& where, double least, double greatest) {
        if (!value.is_number()) throw Error(where + ": expected an integer");
        const double number = value.get<double>();
        if (number != std::floor(number) || number < least || number > greatest) {
            throw Error(
                fmt::format("{}: {} is not an integer from {:.0f} to {:.0f}", where, value.dump(), least, greatest));
        }
        if (value.is_number_float()) value = static_cast<int64_t>(number);
        // Counts are read later as unsigned numbers only.
        if (least >= 0.0 && !value.is_number_unsigned()) value = static_cast<uint64_t>(number);
        return number;
    }

    void index(json& value, const std::string& where, const char* of) const {
        const double number = whole(value, where, 0.0, 2147483647.0);
        if (number >= static_cast<double>(count_of(of))) {
            throw Error(fmt::format("{}: there is no {}[{:.0f}]; the file has {}", where, of, number, count_of(of)));
        }
    }

    json& root_;
};

const Rule texture_index{"index", Kind::index, "textures", 0, true};
const Rule texture_coordinates{"texCoord", Kind::count};

void check_mesh(Checker& checker, json& mesh, const std::string& where) {
    const auto found = mesh.find("primitives");
    if (found == mesh.end()) return;
    if (!found->is_array()) throw Error(where + ".primitives: expected an array");
    for (size_t i = 0; i < found->size(); ++i) {
        const std::string name = fmt::format("{}.primitives[{}]", where, i);
        json& primitive = (*found)[i];
        checker.item(primitive, name,
                     {{"attributes", Kind::attributes, "", 0, true},
                      {"indices", Kind::index, "accessors"},
                      {"material", Kind::index, "materials"},
                      {"mode", Kind::count}});
        const auto targets = primitive.find("targets");
        if (targets == primitive.end()) continue;
        if (!targets->is_array()) throw Error(name + ".targets: expected an array");
        for (size_t k = 0; k < targets->size(); ++k) {
            checker.property((*targets)[k], fmt::format("{}.targets[{}]", name, k), {"", Kind::attributes});
        }
    }
}

void check_material(Checker& checker, json& material, const std::string& where) {
    checker.nested(material, where, "normalTexture", {texture_index, texture_coordinates, {"scale", Kind::number}});
    checker.nested(material, where, "occlusionTexture",
                   {texture_index, texture_coordinates, {"strength", Kind::number}});
    checker.nested(material, where, "emissiveTexture", {texture_index, texture_coordinates});
    const auto found = material.find("pbrMetallicRoughness");
    if (found == material.end()) return;
    const std::string name = where + ".pbrMetallicRoughness";
    checker.item(*found, name,
                 {{"baseColorFactor", Kind::numbers, "", 4},
                  {"metallicFactor", Kind::number},
                  {"roughnessFactor", Kind::number}});
    checker.nested(*found, name, "baseColorTexture", {texture_index, texture_coordinates});
    checker.nested(*found, name, "metallicRoughnessTexture", {texture_index, texture_coordinates});
}

void check_accessor(Checker& checker, json& accessor, const std::string& where) {
    const auto sparse = accessor.find("sparse");
    if (sparse == accessor.end()) return;
    const std::string name = where + ".sparse";
    checker.item(*sparse, name,
                 {{"count", Kind::integer, "", 0, true},
                  {"indices", Kind::object, "", 0, true},
                  {"values", Kind::object, "", 0, true}});
    checker.nested(*sparse, name, "indices",
                   {{"bufferView", Kind::index, "bufferViews", 0, true},
                    {"byteOffset", Kind::integer},
                    {"componentType", Kind::count, "", 0, true}});
    checker.nested(*sparse, name, "values",
                   {{"bufferView", Kind::index, "bufferViews", 0, true}, {"byteOffset", Kind::integer}});
}

void check_camera(Checker& checker, json& camera, const std::string& where) {
    const std::string type = camera["type"];
    if (type == "perspective") {
        checker.property(camera["perspective"], where + ".perspective", {"", Kind::object});
        checker.nested(camera, where, "perspective",
                       {{"yfov", Kind::number, "", 0, true},
                        {"znear", Kind::number, "", 0, true},
                        {"zfar", Kind::number},
                        {"aspectRatio", Kind::number}});
    } else if (type == "orthographic") {
        checker.property(camera["orthographic"], where + ".orthographic", {"", Kind::object});
        checker.nested(camera, where, "orthographic",
                       {{"xmag", Kind::number, "", 0, true},
                        {"ymag", Kind::number, "", 0, true},
                        {"zfar", Kind::number, "", 0, true},
                        {"znear", Kind::number, "", 0, true}});
    } else {
        throw Error(fmt::format("{}.type: '{}' is not perspective or orthographic", where, one_line(type)));
    }
}

void check_lights(Checker& checker, json& root) {
    const auto extensions = root.find("extensions");
    if (extensions == root.end()) return;
    if (!extensions->is_object()) throw Error("extensions: expected an object");
    const auto punctual = extensions->find("KHR_lights_punctual");
    if (punctual == extensions->end()) return;
    const std::string name = "extensions.KHR_lights_punctual";
    if (!punctual->is_object()) throw Error(name + ": expected an object");
    const auto lights = punctual->find("lights");
    if (lights == punctual->end()) return;
    if (!lights->is_array()) throw Error(name + ".lights: expected an array");
    for (size_t i = 0; i < lights->size(); ++i) {
        const std::string where = fmt::format("{}.lights[{}]", name, i);
        json& light = (*lights)[i];
        checker.item(light, where,
                     {{"type", Kind::text, "", 0, true},
                      {"name", Kind::text},
                      {"color", Kind::numbers, "", 3},
                      {"intensity", Kind::number},
                      {"range", Kind::number}});
        if (light["type"] == "spot" && !light.contains("spot")) light["spot"] = json::object();
        checker.nested(light, where, "spot", {{"innerConeAngle", Kind::number}, {"outerConeAngle", Kind::number}});
    }
}

}  // namespace

void check_gltf_json(json& root) {
    Checker checker(root);
    checker.nested(root, "", "asset", {{"version", Kind::text, "", 0, true}, {"generator", Kind::text}});
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
        const auto found = root.find(list);
        if (found == root.end()) continue;
        if (!found->is_array()) throw Error(fmt::format("{}: expected an array of strings", list));
        for (json& name : *found) checker.property(name, list, {"", Kind::text});
    }
    const Rule name{"name", Kind::text};
    // Sections whose length others refer to come first: they must be arrays before their length is asked.
    for (const char* section : {"buffers", "bufferViews", "accessors", "images", "samplers", "textures", "materials",
                                "cameras", "meshes", "skins", "nodes", "scenes", "animations"}) {
        const auto found = root.find(section);
        if (found != root.end() && !found->is_array()) throw Error(fmt::format("{}: expected an array", section));
    }
    checker.section("buffers", {{"byteLength", Kind::count, "", 0, true}, {"uri", Kind::text}, name});
    checker.section("bufferViews", {{"buffer", Kind::index, "buffers", 0, true},
                                    {"byteOffset", Kind::count},
                                    {"byteLength", Kind::count, "", 0, true},
                                    {"byteStride", Kind::count},
                                    name});
    checker.section("accessors",
                    {{"bufferView", Kind::index, "bufferViews"},
                     {"byteOffset", Kind::count},
                     {"componentType", Kind::count, "", 0, true},
                     {"count", Kind::count, "", 0, true},
                     {"type", Kind::text, "", 0, true},
                     {"normalized", Kind::boolean},
                     name},
                    [&](json& accessor, const std::string& where) { check_accessor(checker, accessor, where); });
    checker.section("images", {{"uri", Kind::text}, {"bufferView", Kind::index, "bufferViews"}, name});
    checker.section("samplers", {{"wrapS", Kind::count}, {"wrapT", Kind::count}, {"magFilter", Kind::count}, name});
    checker.section("textures", {{"source", Kind::index, "images"}, {"sampler", Kind::index, "samplers"}, name});
    checker.section("materials",
                    {{"emissiveFactor", Kind::numbers, "", 3},
                     {"alphaMode", Kind::text},
                     {"alphaCutoff", Kind::number},
                     {"doubleSided", Kind::boolean},
                     {"extensions", Kind::object},
                     name},
                    [&](json& material, const std::string& where) { check_material(checker, material, where); });
    checker.section("cameras", {{"type", Kind::text, "", 0, true}, name},
                    [&](json& camera, const std::string& where) { check_camera(checker, camera, where); });
    checker.section("meshes", {{"weights", Kind::numbers}, name},
                    [&](json& mesh, const std::string& where) { check_mesh(checker, mesh, where); });
    checker.section("nodes", {{"mesh", Kind::index, "meshes"},
                              {"camera", Kind::index, "cameras"},
                              {"skin", Kind::index, "skins"},
                              {"children", Kind::indices, "nodes"},
                              {"matrix", Kind::numbers, "", 16},
                              {"translation", Kind::numbers, "", 3},
                              {"rotation", Kind::numbers, "", 4},
                              {"scale", Kind::numbers, "", 3},
                              {"extensions", Kind::object},
                              name});
    checker.section("scenes", {{"nodes", Kind::indices, "nodes"}, name});
    const auto scene = root.find("scene");
    if (scene != root.end()) checker.property(*scene, "scene", {"", Kind::index, "scenes"});
    check_lights(checker, root);
}

}  // namespace triptych::cli
