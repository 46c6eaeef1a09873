#include "host/scene/scene_claims.h"

#include <fmt/format.h>

#include <map>
#include <string>

namespace clshade {

namespace {

/// Floats hold every whole number up to here; ids are compared in single precision.
constexpr std::int64_t largest_id = std::int64_t{1} << 24;

std::vector<std::int64_t> read_ids(const TomlValue& value, const std::string& title) {
    const TomlArray* list = value.array();
    if (list == nullptr) {
        fail_type(value, "ids", "a list of whole numbers such as [3, 7]");
    }
    if (list->empty()) {
        fail(value.where, fmt::format("'ids' of {} is empty, so that it claims no pixel; list the values of the "
                                      "material_id plane",
                                      title));
    }
    std::vector<std::int64_t> ids;
    for (const TomlValue& element : *list) {
        const auto* id = std::get_if<std::int64_t>(&element.data);
        if (id == nullptr) {
            fail_type(element, "ids", "a list of whole numbers");
        }
        if (*id < -largest_id || *id > largest_id) {
            fail(element.where,
                 fmt::format("id {} of {} cannot be told apart in a plane of floats; write ids within +-{}", *id, title,
                             largest_id));
        }
        ids.push_back(*id);
    }
    return ids;
}

std::vector<std::string> read_names(const TomlValue& value, const std::string& title) {
    const TomlArray* list = value.array();
    if (list == nullptr) {
        fail_type(value, "names", "a list of Cryptomatte names such as [\"hat\"]");
    }
    if (list->empty()) {
        fail(value.where, fmt::format("'names' of {} is empty, so that it claims no pixel; list names of the "
                                      "Cryptomatte manifest",
                                      title));
    }
    std::vector<std::string> names;
    for (const TomlValue& element : *list) {
        names.push_back(as_text(element, "names"));
    }
    return names;
}

/// Throws at the second claim of a value. `key`: "ids" or "names".
template <typename Value>
void check_unique(const TomlTable& table, const std::vector<Material>& materials, std::string_view key,
                  std::vector<Value> Material::*claims) {
    std::map<Value, std::string> owners;
    for (const Material& material : materials) {
        for (const Value& claim : material.*claims) {
            const auto [owner, is_new] = owners.emplace(claim, material.name);
            if (is_new) {
                continue;
            }
            const TomlEntry* entry = table.find(material.name)->value.table()->find(key);
            const std::string_view kind = key == "ids" ? "id" : "Cryptomatte name";
            if (owner->second == material.name) {
                fail(entry->value.where,
                     fmt::format("{} {} is claimed twice by material '{}'; keep one", kind, claim, material.name));
            }
            fail(entry->value.where, fmt::format("{} {} is claimed twice, by material '{}' and material '{}'; keep one",
                                                 kind, claim, owner->second, material.name));
        }
    }
}

} // namespace

void read_claims(const TableReader& table, Material& material) {
    const TomlEntry* ids = table.find("ids");
    const TomlEntry* names = table.find("names");
    if (material.name == "default") {
        if (ids != nullptr || names != nullptr) {
            const TomlEntry* entry = ids != nullptr ? ids : names;
            fail(entry->where, fmt::format("material 'default' takes every pixel that no other material claims; remove "
                                           "'{}'",
                                           entry->key));
        }
        return;
    }
    if (ids == nullptr && names == nullptr) {
        fail(table.where(), fmt::format("{} lacks 'ids' or 'names', so that it claims no pixel; write for instance "
                                        "ids = [3, 7] or names = [\"hat\"], or call it 'default'",
                                        table.title()));
    }
    if (ids != nullptr) {
        material.ids = read_ids(ids->value, table.title());
    }
    if (names != nullptr) {
        material.names = read_names(names->value, table.title());
        material.names_where = names->value.where;
    }
}

void check_claims(const TomlTable& table, const std::vector<Material>& materials) {
    check_unique(table, materials, "ids", &Material::ids);
    check_unique(table, materials, "names", &Material::names);
}

} // namespace clshade
