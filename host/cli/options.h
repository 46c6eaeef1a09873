// Flags as types: what every verb understands, and how text becomes numbers.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace CLI { // NOLINT(readability-identifier-naming): the name is CLI11's
class App;
}

namespace clshade::cli {

enum class ProgressMode { automatic, bar, plain, openjd, alf, none };

/// The flags that all verbs share (interface: "Common flags").
struct CommonOptions {
    std::string device;           ///< selector; empty: the only device, or the only GPU
    int threads = 0;              ///< 0: as many as the machine has
    std::uint64_t max_memory = 0; ///< bytes; 0: what the device has
    int verbosity = 0;            ///< number of -v
    bool quiet = false;
    std::string json_file; ///< empty: no report
    bool run_stats = false;
    ProgressMode progress = ProgressMode::automatic;
    std::uint64_t seed = 1;
    int lanes = 0; ///< 0: automatic
    std::string kernel_dir;

    /// Threads for host work: at least 1.
    [[nodiscard]] int host_threads() const;
};

/// Width and height in pixels.
struct Size {
    int width = 0;
    int height = 0;
};

/// How the scene is chosen and overridden; shared by shade, check and inspect.
struct SceneOptions {
    std::string file;
    std::vector<std::string> overrides; ///< --set, in order
    std::string model;
    std::string view; ///< of a stereo file
};

/// Which groups of common flags `help` shows for a verb. All are accepted everywhere, so that farm wrappers may pass
/// them blindly; those without effect on a verb are only hidden.
enum class CommonGroup { reporting, running };

/// Declares the common flags on `app`; `options` must outlive the parse.
void add_common_options(CLI::App& app, CommonOptions& options, CommonGroup shown);
/// Declares --scene, --set, --model and --view.
void add_scene_options(CLI::App& app, SceneOptions& options);

/// Position of `value` among `choices`. Throws UsageError "FLAG: 'x' is not one of a, b, c; did you mean 'a'?".
[[nodiscard]] std::size_t parse_choice(std::string_view flag, std::string_view value,
                                       std::span<const std::string_view> choices);
/// "1280x720". Throws UsageError unless both sides are whole numbers from 1 to 65536.
[[nodiscard]] Size parse_size(std::string_view flag, std::string_view value);
/// "a,b,c" without empty entries.
[[nodiscard]] std::vector<std::string> split_list(std::string_view text);
/// A finite number that is at least `minimum`. Throws UsageError.
[[nodiscard]] double parse_number(std::string_view flag, std::string_view value, double minimum);
/// A whole number from `minimum` to `maximum`. Throws UsageError.
[[nodiscard]] std::int64_t parse_whole(std::string_view flag, std::string_view value, std::int64_t minimum,
                                       std::int64_t maximum);

} // namespace clshade::cli
