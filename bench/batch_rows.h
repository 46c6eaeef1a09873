// Rows of whole runs, from files to files: which sequences, and which outputs.
#pragma once

#include "bench/benchmark.h"

#include <string>
#include <vector>

namespace clshade {

enum class BatchKind {
    run,    ///< decode, shade and encode a sequence
    encode, ///< write one shaded picture
};

struct BatchRow {
    BatchKind kind = BatchKind::run;
    bool half = true;
    std::string compression; ///< run: of the sequence and of what is written; encode: "zip:4"
    int width = 0;
    int height = 0;

    /// "batch.half.zip.1920x1080", "batch.encode.zip:4.1920x1080"
    [[nodiscard]] std::string key() const;
};

/// All rows that the options choose, sizes replaced as the options say. They take minutes and write gigabytes, so there
/// are none unless the filter has the word "batch". Throws UsageError as select_rows does.
[[nodiscard]] std::vector<BatchRow> select_batch_rows(const BenchOptions& options);

} // namespace clshade
