#include "bench/prefilter_rows.h"

#include "bench/key_filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>

namespace clshade {

std::string PrefilterRow::key() const {
    return fmt::format("prefilter.{}x{}{}", width, height, cached ? ".cached" : "");
}

std::vector<PrefilterRow> select_prefilter_rows(const BenchOptions& options) {
    const std::vector<PrefilterRow> full = {{1024, 512, false}, {4096, 2048, false}, {1024, 512, true}};
    const std::vector<PrefilterRow> quick = {{128, 64, false}, {256, 128, false}, {128, 64, true}};
    const std::regex filter = compiled_filter(options.filter);
    std::vector<PrefilterRow> chosen;
    const std::vector<PrefilterRow>& all = options.quick ? quick : full;
    std::copy_if(all.begin(), all.end(), std::back_inserter(chosen),
                 [&filter](const PrefilterRow& row) { return std::regex_search(row.key(), filter); });
    return chosen;
}

} // namespace clshade
