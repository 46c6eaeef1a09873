// Builds without image files have no rows of whole runs.
#include "bench/batch_bench.h"
#include "bench/batch_rows.h"

namespace clshade {

std::string BatchRow::key() const {
    return {}; // there is none
}

std::vector<BatchRow> select_batch_rows(const BenchOptions& /*options*/) {
    return {};
}

std::vector<BenchResult> run_batch_rows(Device& /*device*/, const BenchOptions& /*options*/,
                                        const std::vector<BatchRow>& /*rows*/,
                                        const std::function<void(const std::string&)>& /*tell*/) {
    return {};
}

std::vector<SpeedLimit> batch_limits(const std::vector<BenchResult>& /*results*/) {
    return {};
}

} // namespace clshade
