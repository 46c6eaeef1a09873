#include "host/cli/lane_store.h"

#include "host/base/error.h"
#include "host/cli/signals.h"
#include "host/device/program.h"

#include <nlohmann/json.hpp>

#include <fstream>

namespace clshade::cli {

namespace {

std::string key_of(const DeviceInfo& device) {
    return device.platform + "/" + device.name + "/" + device.driver;
}

nlohmann::json load(const std::filesystem::path& file) {
    std::ifstream stream(file);
    nlohmann::json document = nlohmann::json::parse(stream, nullptr, false);
    return document.is_object() ? document : nlohmann::json::object();
}

} // namespace

std::filesystem::path lane_store_file() {
    const std::filesystem::path folder = ProgramCache::standard().folder();
    return folder.empty() ? folder : folder / "lanes.json";
}

std::optional<int> stored_lanes(const DeviceInfo& device) {
    const std::filesystem::path file = lane_store_file();
    std::error_code ignored;
    if (file.empty() || !std::filesystem::exists(file, ignored)) {
        return std::nullopt;
    }
    const nlohmann::json document = load(file);
    const auto entry = document.find(key_of(device));
    if (entry == document.end() || !entry->is_number_integer()) {
        return std::nullopt;
    }
    const int lanes = entry->get<int>();
    const bool known = lanes == 1 || lanes == 4 || lanes == 8 || lanes == 16;
    return known ? std::optional(lanes) : std::nullopt;
}

void store_lanes(const DeviceInfo& device, int lanes) {
    const std::filesystem::path file = lane_store_file();
    if (file.empty()) {
        throw RuntimeFailure("no cache folder to store the vector width in; set XDG_CACHE_HOME");
    }
    nlohmann::json document = load(file);
    document[key_of(device)] = lanes;
    write_text_file(file, document.dump(2) + "\n");
}

} // namespace clshade::cli
