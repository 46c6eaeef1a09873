// Where the time of a run went (--runstats, -v, JSON).
#pragma once

#include "host/shading/shader.h"

#include <nlohmann/json.hpp>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace clshade::cli {

/// Times of one frame or of a whole run in milliseconds, by stage in the order in which stages were first met.
class StageTimes {
  public:
    void add(const std::string& stage, double milliseconds);
    void add(const StageTimes& other);
    [[nodiscard]] double total() const;
    [[nodiscard]] const std::vector<std::pair<std::string, double>>& stages() const { return stages_; }
    [[nodiscard]] nlohmann::json json() const; ///< {"read": 1.5, ..., "total": 20.0}

  private:
    std::vector<std::pair<std::string, double>> stages_;
};

/// Sums of a whole run.
class RunStats {
  public:
    void add(const StageTimes& stages);
    void add(const std::vector<KernelTime>& kernels);
    /// Tables of stages and kernels, and the peak memory of the process.
    [[nodiscard]] std::string text() const;

  private:
    struct KernelSum {
        int launches = 0;
        double milliseconds = 0.0;
        double bytes = 0.0;
    };
    StageTimes stages_;
    int frames_ = 0;
    std::map<std::string, KernelSum> kernels_;
};

/// Largest resident memory of this process so far, in bytes.
[[nodiscard]] double peak_memory();

} // namespace clshade::cli
