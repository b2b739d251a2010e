// The editable scene: tables of immutable items by id. An edit exchanges an item; whoever holds the old one keeps it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>

#include "base/error.h"
#include "scene/items.h"
#include "scene/mesh.h"

namespace trp {

// Items by id, in the order of their making. Ids come from the scene's one counter and are never used again.
template <class Item>
class Table {
  public:
    explicit Table(const char* kind) : kind_(kind) {}

    void add(uint32_t id, Item item) { items_.emplace(id, std::make_shared<const Item>(std::move(item))); }
    void replace(uint32_t id, Item item) { at(id) = std::make_shared<const Item>(std::move(item)); }
    void remove(uint32_t id) {
        at(id);
        items_.erase(id);
    }
    const Item& get(uint32_t id) { return *at(id); }
    // Throws where the scene has no such item: for calls that name one.
    void require(uint32_t id) { at(id); }
    // Null where there is none: for references between items, which are checked at commit.
    std::shared_ptr<const Item> find(uint32_t id) const {
        const auto it = items_.find(id);
        return it == items_.end() ? nullptr : it->second;
    }
    size_t size() const { return items_.size(); }
    auto begin() const { return items_.begin(); }
    auto end() const { return items_.end(); }

  private:
    std::shared_ptr<const Item>& at(uint32_t id) {
        const auto it = items_.find(id);
        if (it == items_.end()) fail(TRP_ERROR_ID, "the scene has no {} {}", kind_, id);
        return it->second;
    }

    const char* kind_;
    std::map<uint32_t, std::shared_ptr<const Item>> items_;
};

struct Scene {
    Table<Mesh> meshes{"mesh"};
    Table<Instance> instances{"instance"};
    Table<Material> materials{"material"};
    Table<Texture> textures{"texture"};
    Table<Light> lights{"light"};
    Table<Camera> cameras{"camera"};
    World world;
    uint32_t camera = TRP_NO_ID;
    uint32_t next_id = 1;
};

}  // namespace trp
