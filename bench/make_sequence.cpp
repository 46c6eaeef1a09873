// make_sequence WxH FRAMES half|float COMPRESSION OUT.%04d.exr: the sequence of the batch rows, for scripts.
#include "bench/batch_sequence.h"
#include "host/base/error.h"
#include "host/base/frame_range.h"
#include "host/images/image_writer.h"

#include <charconv>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace clshade {

namespace {

int whole(std::string_view what, std::string_view text) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 1 || value > 1000000) {
        throw UsageError(std::string(what) + " '" + std::string(text) + "' is not a whole number from 1 to 1000000");
    }
    return value;
}

void make_sequence(const std::vector<std::string>& arguments) {
    if (arguments.size() != 5) {
        throw UsageError("usage: make_sequence WxH FRAMES half|float COMPRESSION OUT.%04d.exr");
    }
    const std::size_t cross = arguments[0].find('x');
    if (cross == std::string::npos) {
        throw UsageError("size '" + arguments[0] + "' is not WxH");
    }
    const std::string_view size = arguments[0];
    if (arguments[2] != "half" && arguments[2] != "float") {
        throw UsageError("type '" + arguments[2] + "' is neither half nor float");
    }
    SequenceFormat format;
    format.width = whole("width", size.substr(0, cross));
    format.height = whole("height", size.substr(cross + 1));
    format.half = arguments[2] == "half";
    format.compression = arguments[3];
    const std::optional<SequencePath> output = SequencePath::parse(arguments[4]);
    if (!output) {
        throw UsageError("output '" + arguments[4] + "' has no place for the frame number; write #### or %04d");
    }
    const int frames = whole("number of frames", arguments[1]);
    for (int frame = 1; frame <= frames; ++frame) {
        write_sequence_frame(output->at(frame), format, frame - 1);
    }
}

} // namespace

} // namespace clshade

int main(int argc, char** argv) {
    try {
        clshade::make_sequence({argv + 1, argv + argc});
        return 0;
    } catch (const clshade::Error& error) {
        std::fprintf(stderr, "make_sequence: %s\n", error.what());
        return static_cast<int>(error.exit_code());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "make_sequence: %s\n", error.what());
        return 1;
    }
}
