// Where the time of a frame or a run went.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace clshade {

/// Times in milliseconds, by stage in the order in which stages were first met.
class StageTimes {
  public:
    void add(const std::string& stage, double milliseconds);
    void add(const StageTimes& other);
    [[nodiscard]] double total() const;
    /// 0 for a stage never met.
    [[nodiscard]] double of(const std::string& stage) const;
    [[nodiscard]] const std::vector<std::pair<std::string, double>>& stages() const { return stages_; }

  private:
    std::vector<std::pair<std::string, double>> stages_;
};

} // namespace clshade
