#include "bench/key_filter.h"

#include "host/base/error.h"

#include <fmt/format.h>

namespace clshade {

std::regex compiled_filter(const std::string& filter) {
    try {
        return std::regex(filter, std::regex::ECMAScript);
    } catch (const std::regex_error& error) {
        throw UsageError(fmt::format("--filter '{}' is not a regular expression ({}); try a part of a key, such as "
                                     "oren_nayar",
                                     filter, error.what()));
    }
}

} // namespace clshade
