// What each compression of the outputs costs: time and bytes of one shaded picture.
#pragma once

#include "bench/batch_ours.h"
#include "bench/batch_rows.h"
#include "bench/benchmark.h"

namespace clshade {

/// Shades a frame of the batch rows' sequence and writes its R, G, B, A again and again, forced to the disk as always.
/// The picture is half already, so that only encoding and storing count. Throws RuntimeFailure.
[[nodiscard]] BenchResult time_encoding(BatchContestant& ours, const BatchRow& row, const BenchOptions& options);

} // namespace clshade
