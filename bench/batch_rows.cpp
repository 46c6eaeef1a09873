#include "bench/batch_rows.h"

#include "bench/key_filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <regex>

namespace clshade {

namespace {

std::vector<BatchRow> all_rows(int width, int height) {
    std::vector<BatchRow> rows;
    for (const bool half : {true, false}) {
        for (const char* compression : {"none", "zip", "piz", "dwaa"}) {
            rows.push_back({BatchKind::run, half, compression, width, height});
        }
    }
    for (const char* compression : {"none", "rle", "zips", "zip:1", "zip:2", "zip:3", "zip:4", "zip:5", "zip:6",
                                    "zip:7", "zip:8", "zip:9", "piz", "pxr24", "dwaa", "dwab"}) {
        rows.push_back({BatchKind::encode, true, compression, width, height});
    }
    return rows;
}

} // namespace

std::string BatchRow::key() const {
    const char* const type = half ? "half" : "float";
    return fmt::format("batch.{}.{}.{}x{}", kind == BatchKind::run ? type : "encode", compression, width, height);
}

std::vector<BatchRow> select_batch_rows(const BenchOptions& options) {
    const std::regex filter = compiled_filter(options.filter);
    std::vector<BatchRow> chosen;
    if (options.filter.find("batch") == std::string::npos) {
        return chosen;
    }
    const int width = options.width > 0 ? options.width : (options.quick ? 256 : 1920);
    const int height = options.height > 0 ? options.height : (options.quick ? 144 : 1080);
    const std::vector<BatchRow> rows = all_rows(width, height);
    std::copy_if(rows.begin(), rows.end(), std::back_inserter(chosen),
                 [&filter](const BatchRow& row) { return std::regex_search(row.key(), filter); });
    return chosen;
}

} // namespace clshade
